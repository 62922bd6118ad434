//! [`GeometryReport`]: numbers about the geometry of a mesh.

use hexfill_embed::EmbedReport;
use serde::Serialize;

/// Numbers about the geometry of a mesh, for people and for JSON.
#[derive(Clone, Debug, Serialize)]
pub struct GeometryReport {
    /// Hexes with det J > 0 certified everywhere.
    pub certified: usize,
    /// Hexes judged: all of them, or none where only start positions were asked for.
    pub hexes: usize,
    /// Least scaled Jacobian at the corners of any hex.
    pub corner_scaled_jacobian: Option<f64>,
    /// Certified lower bound of the least scaled Jacobian over whole hexes; -1 if a hex is not certified.
    pub certified_scaled_jacobian: Option<f64>,
    /// Mean of the certified scaled Jacobians; hexes that are not certified count as 0.
    pub mean_scaled_jacobian: Option<f64>,
    /// Hexes by certified scaled Jacobian, rounded to six digits, in ten steps of 0.1 from 0; hexes that are not certified are in none of them.
    pub histogram: Option<[usize; 10]>,
    /// The largest volume of a hex divided by the smallest; absent if one is not positive, or too large for a double.
    pub volume_ratio: Option<f64>,
    /// The largest ratio of the longest to the shortest edge of a hex.
    pub edge_ratio: Option<f64>,
    /// What the embedding reports.
    pub embedding: Option<EmbedReport>,
    /// Why the boundary's positions cannot be used.
    pub refused: Option<String>,
    /// In how many ways the mesh lies on the surface, up to congruence; the best of them was kept.
    pub ways: usize,
}

impl GeometryReport {
    /// A line about all hexes, not only the worst; `None` if nothing was judged.
    pub fn distribution(&self) -> Option<String> {
        let (mean, steps) = (self.mean_scaled_jacobian?, self.histogram?);
        let shown: Vec<String> =
            steps.iter().enumerate().filter(|(_, n)| **n > 0).map(|(i, n)| format!("{n} from 0.{i}")).collect();
        let digits = usize::from(self.volume_ratio.is_some_and(|r| r < 100.0));
        let volumes =
            self.volume_ratio.map_or(String::new(), |r| format!("; volumes differ by a factor of {r:.digits$}"));
        Some(format!("mean {mean:.3}; {}{volumes}", shown.join(", ")))
    }
}

impl std::fmt::Display for GeometryReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (Some(certified), Some(corner)) = (self.certified_scaled_jacobian, self.corner_scaled_jacobian) else {
            return match &self.refused {
                Some(why) => write!(f, "no positions were made: {why}"),
                None => write!(f, "start positions, neither embedded nor judged"),
            };
        };
        if self.certified == self.hexes {
            return write!(
                f,
                "det J > 0 certified in {}, scaled Jacobian at least {certified:.6} (corners {corner:.6})",
                if self.hexes == 1 { "the hex".to_owned() } else { format!("all {} hexes", self.hexes) }
            );
        }
        write!(f, "det J > 0 certified in {} of {} hexes only", self.certified, self.hexes)?;
        if let Some(why) = &self.refused {
            return write!(f, "; no positions were made: {why}");
        }
        let Some(e) = &self.embedding else { return write!(f, " (start positions, not embedded)") };
        write!(f, "; {} starts, {} valid", e.starts, e.valid_starts)?;
        let worst: Vec<String> = e.worst_cells.iter().take(5).map(|c| c.hex.to_string()).collect();
        write!(f, ", worst cells {}", worst.join(" "))?;
        if e.is_impossible() {
            let vertex = e.star_bounds.first().map_or(String::new(), |b| format!(" at {}", b.vertex));
            write!(
                f,
                "; with this connectivity and boundary no placement is valid (star bound {:.4}{vertex})",
                e.upper_bound
            )?;
        } else if e.upper_bound <= 1e-12 {
            let vertex = e.star_bounds.first().map_or(String::new(), |b| format!(" at {}", b.vertex));
            write!(f, "; the boundary leaves no room{vertex} (star bound 0 up to rounding)")?;
        }
        Ok(())
    }
}

//! [`fill_regions`]: each region by itself, and all put together.
//!
//! Source: ours.

use crate::best::{PlaceOptions, PlacedFill, fill_placed};
use crate::fill::filled::{ENGINE, LAYER};
use crate::fill::maker::Maker;
use crate::fill::options::{FillOptions, Strategy};
use crate::place::placed::{Placed, shown};
use crate::regions::Region;
use crate::regions::error::RegionsError;
use hexfill_check::{CellQuality, Judged, Level, cell_quality, judge};
use hexfill_io::MeshData;
use hexfill_mesh::{Context, StopReason};

/// All regions filled.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct FilledRegions {
    /// The file with the hexes of all regions behind its own, and their points behind its own. Hexes carry the number of their region as tag, from 1, where
    /// there are several regions; those of the file keep theirs. Fields per hex: as of [`Filled::flag`](crate::Filled::flag), with 0 for hexes of the file, and of
    /// [`Placed::flag`].
    pub data: MeshData,
    /// What was made for each region; empty where nothing was found.
    pub fills: Vec<PlacedFill>,
    /// Hexes of the file itself in which det J > 0 is not certified.
    pub given_invalid: usize,
    /// Why the work ended.
    pub stop: StopReason,
}

impl FilledRegions {
    /// Whether every region has a mesh.
    pub fn is_complete(&self) -> bool {
        self.fills.iter().all(|fill| !fill.meshes.is_empty())
    }

    /// Whether det J > 0 is certified in every hex, those of the file included.
    pub fn is_certified(&self) -> bool {
        let placed =
            |fill: &PlacedFill| fill.meshes.first().is_some_and(|(_, p)| p.as_ref().is_some_and(Placed::is_certified));
        self.given_invalid == 0 && self.fills.iter().all(placed)
    }

    /// The least certified scaled Jacobian; -1 if a hex is not certified.
    pub fn worst(&self) -> f64 {
        let of = |fill: &PlacedFill| fill.meshes.first().and_then(|(_, p)| p.as_ref()).map_or(-1.0, Placed::worst);
        self.fills.iter().map(of).fold(f64::INFINITY, f64::min)
    }
}

/// Fills each region and puts all together. If hexes on two sides of a wall then share more than a vertex, edge or facet, all are filled once more behind
/// pillows, where every wall quad has a hex of its own.
///
/// ```
/// use hexfill::io::MeshData;
/// use hexfill::{Context, FillOptions, PlaceOptions, fill_regions, regions};
///
/// // Two cubes with a wall between them: 12 points, 11 quads.
/// let points = (0..12).map(|v| [v % 3, v / 3 % 2, v / 6].map(f64::from)).collect();
/// let mut quads = vec![[0, 3, 9, 6], [1, 4, 10, 7], [2, 5, 11, 8]];
/// for x in 0..2 {
///     let [a, b] = [x, x + 1];
///     quads.extend([[a, b, b + 3, a + 3], [a + 6, b + 6, b + 9, a + 9], [a, b, b + 6, a + 6], [a + 3, b + 3, b + 9, a + 9]]);
/// }
/// let data = MeshData::from_quads(points, quads);
/// let found = regions("two cubes", &data)?;
/// assert_eq!(found.len(), 2);
/// let whole = fill_regions(&data, &found, &FillOptions::default(), &PlaceOptions::default(), &Context::default())?;
/// assert!(whole.is_certified() && whole.data.hex_tags == Some(vec![1, 2]));
/// # Ok::<(), hexfill::RegionsError>(())
/// ```
///
/// # Errors
/// [`RegionsError::Fill`] with the region that has no mesh or could not be tried; [`RegionsError::DoNotFit`] if hexes on two sides of a wall still share too much.
pub fn fill_regions(
    data: &MeshData,
    regions: &[Region],
    options: &FillOptions,
    how: &PlaceOptions,
    ctx: &Context<'_>,
) -> Result<FilledRegions, RegionsError> {
    let filled = fill_once(data, regions, options, how, ctx)?;
    // Each region is proper by itself. What may clash are hexes of two regions at one wall, which share its vertices;
    // no region knows of the other.
    let Err(rules) = fits(&filled.data) else { return Ok(filled) };
    if ctx.stop().is_some() {
        return Err(RegionsError::DoNotFit { rules });
    }
    let mut pillowed = options.clone();
    // Behind a pillow every wall quad has a hex of its own, so two regions share a quad, an edge or a vertex of the
    // wall and no more.
    pillowed.shell = pillowed.shell.with_pillows(vec![1]);
    pillowed.strategy = Strategy::Shell;
    let filled = fill_once(data, regions, &pillowed, how, ctx)?;
    fits(&filled.data).map_err(|rules| RegionsError::DoNotFit { rules })?;
    Ok(filled)
}

fn fill_once(
    data: &MeshData,
    regions: &[Region],
    options: &FillOptions,
    how: &PlaceOptions,
    ctx: &Context<'_>,
) -> Result<FilledRegions, RegionsError> {
    let mut all = data.clone();
    let mut tags = data.hex_tags.clone().unwrap_or_else(|| vec![0; data.hexes.len()]);
    let (mut fills, mut stop) = (Vec::new(), StopReason::Finished);
    let (mut engines, mut layers) =
        (vec![f64::from(Maker::Given.number()); data.hexes.len()], vec![0.0; data.hexes.len()]);
    let given = Judged::connectivity(data.points.len(), &data.hexes).with_points(&data.points);
    let given = cell_quality(&given);
    let given_invalid = given.iter().filter(|c| c.as_ref().is_none_or(|c| !c.valid)).count();
    let is_certified = |c: &Option<CellQuality>| c.as_ref().map_or(0.0, |c| f64::from(u8::from(c.valid)));
    let mut certified: Vec<f64> = given.iter().map(is_certified).collect();
    let mut quality: Vec<f64> = given.iter().map(|c| c.as_ref().map_or(f64::NAN, shown)).collect();
    for (i, region) in regions.iter().enumerate() {
        let fill = fill_placed(&region.problem, options, how, ctx)
            .map_err(|source| RegionsError::Fill { region: i + 1, source })?;
        if fill.stop != StopReason::Finished {
            stop = fill.stop;
        }
        if let Some((filled, placed)) = fill.meshes.first() {
            let own = region.points.len();
            let first = all.points.len() as u32;
            // The region's own points are the file's, so neighbouring regions share them and fit without being glued.
            let number = |v: u32| region.points.get(v as usize).copied().unwrap_or_else(|| first + v - own as u32);
            all.hexes.extend(filled.mesh.hexes_raw().into_iter().map(|hex| hex.map(number)));
            tags.resize(all.hexes.len(), i as i64 + 1);
            engines.extend(filled.makers.iter().map(|maker| f64::from(maker.number())));
            layers.extend(filled.layers().into_iter().map(f64::from));
            if let Some(placed) = placed {
                all.points.extend(&placed.points[own..]);
                certified.extend(placed.cells.iter().map(|c| f64::from(u8::from(c.valid))));
                quality.extend(placed.scaled_jacobians());
            }
        }
        // Where nothing was judged there are no numbers.
        certified.resize(all.hexes.len(), f64::NAN);
        quality.resize(all.hexes.len(), f64::NAN);
        fills.push(fill);
    }
    let n = all.points.len();
    all.hex_tags = (regions.len() > 1 || data.hex_tags.is_some()).then_some(tags);
    if let Some(tags) = &mut all.point_tags {
        tags.resize(n, 0);
    }
    all.point_data.iter_mut().for_each(|(_, values)| values.resize(n, f64::NAN));
    all.hex_data.retain(|(name, _)| ![ENGINE, LAYER, "certified_positive", "scaled_jacobian"].contains(&name.as_str()));
    all.hex_data.iter_mut().for_each(|(_, values)| values.resize(all.hexes.len(), f64::NAN));
    if how.embed.is_some() {
        all.hex_data.push(("certified_positive".to_owned(), certified));
        all.hex_data.push(("scaled_jacobian".to_owned(), quality));
    }
    all.hex_data.push((ENGINE.to_owned(), engines));
    all.hex_data.push((LAYER.to_owned(), layers));
    Ok(FilledRegions { data: all, fills, given_invalid, stop })
}

/// Levels 1 and 2 of the judge on the whole; the rules that fail.
fn fits(data: &MeshData) -> Result<(), String> {
    let judged = Judged::connectivity(data.points.len(), &data.hexes);
    let options = hexfill_check::Options::default().with_up_to(Level::L2).with_betti(false).with_quality(false);
    let report = judge(&judged, &options, &Context::default());
    if report.passed(Level::L2) { Ok(()) } else { Err(report.broken_rules().join(", ")) }
}

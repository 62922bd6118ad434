//! Good directions for a star: linear programs in trust regions from some starts.
//!
//! What is returned is attained; that nothing is better is for [`super::star_search`] to say.
//!
//! Source: Madsen 1975 (a max-min problem by linear programs in a trust region).

use super::sphere_piece::Piece;
use super::star_directions::Directions;
use super::star_program::{Order, solve};
use hexfill_geometry::{Ray, Vector, add, unit};
use hexfill_mesh::Random;

/// Climbs from `hint` and some other directions until `enough` is reached or nothing gets better. Returns the best.
pub(super) fn climb(star: &Directions, hint: &[Vector], enough: f64) -> (f64, Vec<Vector>) {
    let mut random = Random::of_task(17, star.corners.len() as u64);
    let mut best = (f64::NEG_INFINITY, hint.to_vec());
    for attempt in 0..6 {
        let mut u = match attempt {
            0 => hint.to_vec(),
            1 => relaxed(star),
            _ => (0..star.n_free)
                .map(|_| unit([random.signed(), random.signed(), random.signed()]).unwrap_or([1.0, 0.0, 0.0]))
                .collect(),
        };
        let mut value = star.worst(&u);
        let mut radius: f64 = 0.5;
        for _ in 0..60 {
            if value >= enough || radius < 1e-8 {
                break;
            }
            let cells: Vec<Piece> = u.iter().map(|&centre| Piece::around(centre, radius)).collect();
            // Of first order only: the true value judges the step, so a poor model costs an iteration and nothing
            // else.
            let Some(step) = solve(star, &cells, Order::First) else { break };
            let reached = star.worst(&step.directions);
            if reached > value {
                if reached - value < 1e-9 {
                    radius *= 0.1;
                }
                (value, u) = (reached, step.directions);
                radius = (1.5 * radius).min(0.7);
            } else {
                radius *= 0.3;
            }
        }
        if value > best.0 {
            best = (value, u);
        }
        if best.0 >= enough {
            break;
        }
    }
    best
}

/// Every free direction at the mean of the directions it shares corners with.
pub(super) fn relaxed(star: &Directions) -> Vec<Vector> {
    let mut u = vec![[0.0; 3]; star.n_free];
    for _ in 0..20 {
        let mut sums = vec![[0.0; 3]; star.n_free];
        for corner in 0..star.corners.len() {
            let columns = star.columns(corner, &u);
            for (k, ray) in star.corners[corner].iter().enumerate() {
                if let Ray::Free(j) = *ray {
                    sums[j] = add(sums[j], add(columns[(k + 1) % 3], columns[(k + 2) % 3]));
                }
            }
        }
        u = sums.into_iter().map(|s| unit(s).unwrap_or([0.0; 3])).collect();
    }
    u.into_iter().map(|d| unit(d).unwrap_or([0.0, 0.0, 1.0])).collect()
}

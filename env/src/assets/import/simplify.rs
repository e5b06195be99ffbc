//! Simplifies a surface and measures the error. Runs only on import, and the result is stored: the simplifier's arithmetic
//! depends on its C++ compiler, so nothing that must be the same on every machine may call it.

use meshopt::SimplifyOptions;
use rapier3d::math::Vector;

use super::deviation::{Deviation, TestBudget, point, used};
use crate::assets::library::{Detail, MAX_MODEL_LEVELS};

/// Minimum number of triangles worth simplifying: a few blocks of the renderer.
const MIN_TRIANGLES: usize = 96;

/// Each level aims at the number of triangles of the previous level divided by this.
const REDUCTION: usize = 4;

/// Maximum error of a level, as a fraction of the surface's size.
const MAX_ERROR: f32 = 0.2;

/// Maximum number of corners of the whole surface that are measured per level. If there are more, evenly spread ones represent
/// the rest.
const MAX_MEASURED_CORNERS: usize = 20_000;

/// Maximum number of pairs of triangles that share a corner, summed over all corners: the simplifier visits every pair.
/// One corner shared by 63,000 triangles has about that many.
const MAX_PAIRS: u64 = 4_000_000_000;

/// Up to three coarser levels of a surface with triangles grouped by colour; groups share no corners. Each level has at most
/// two thirds of the triangles of the previous one. Empty if so many triangles meet in one corner that simplifying would take
/// minutes.
pub(super) fn levels(corners: &[[f32; 3]], groups: &[Vec<[u32; 3]>]) -> Vec<Detail> {
    let mut group_of = vec![0_usize; corners.len()];
    for (group, triangles) in groups.iter().enumerate() {
        triangles
            .iter()
            .flatten()
            .for_each(|corner| group_of[*corner as usize] = group);
    }
    let whole: Vec<u32> = groups.iter().flatten().flatten().copied().collect();
    if pairs(&whole, corners.len()) > MAX_PAIRS {
        return Vec::new();
    }
    let max_error = MAX_ERROR * size(|| corners.iter());
    let mut levels: Vec<Detail> = Vec::new();
    let mut previous = whole.len() / 3;
    for _ in 1..MAX_MODEL_LEVELS {
        if previous < MIN_TRIANGLES {
            break;
        }
        let indices = simplified(&whole, corners, previous / REDUCTION * 3, max_error);
        let mut by_group = vec![Vec::new(); groups.len()];
        for three in indices.chunks_exact(3) {
            by_group[group_of[three[0] as usize]].push([three[0], three[1], three[2]]);
        }
        // Checked before measuring, because surfaces that cannot be simplified take longest to measure.
        if indices.len() > previous * 2 {
            break;
        }
        let Some(error) = error(corners, groups, &by_group, max_error) else {
            break;
        };
        previous = indices.len() / 3;
        let last = levels.last().map_or(0.0, |level: &Detail| level.error);
        levels.push(Detail {
            error: error.max(last),
            triangles: by_group,
        });
    }
    levels
}

/// Number of pairs of triangles that share a corner, summed over all corners; each triangle is also paired with itself.
fn pairs(whole: &[u32], corners: usize) -> u64 {
    let mut triangles_at = vec![0_u64; corners];
    for corner in whole {
        triangles_at[*corner as usize] += 1;
    }
    triangles_at.iter().map(|triangles| triangles * triangles).sum()
}

fn simplified(whole: &[u32], corners: &[[f32; 3]], wanted: usize, max_error: f32) -> Vec<u32> {
    // Where two colours meet, each has its own corner at the same position; the simplifier treats that as a seam and keeps it.
    let options = SimplifyOptions::ErrorAbsolute | SimplifyOptions::Prune;
    meshopt::simplify_decoder(whole, corners, wanted, max_error, options, None)
}

/// The largest extent of the points along any axis.
fn size<'a, I: Iterator<Item = &'a [f32; 3]>>(points: impl Fn() -> I) -> f32 {
    let along = |axis: usize| {
        let values = || points().map(|point| point[axis]);
        values().fold(f32::NEG_INFINITY, f32::max) - values().fold(f32::INFINITY, f32::min)
    };
    along(0).max(along(1)).max(along(2)).max(0.0)
}

/// Largest distance of the groups' corners from the coarser groups; for a group with no triangles left, the group's size.
/// `None` as soon as it exceeds `most`. Measures fewer corners where thousands of triangles intersect each other.
fn error(corners: &[[f32; 3]], fine: &[Vec<[u32; 3]>], coarse: &[Vec<[u32; 3]>], most: f32) -> Option<f32> {
    let used: Vec<Vec<u32>> = fine.iter().map(|triangles| used(triangles)).collect();
    // At least one corner of each group is measured, so rounding up may exceed the limit.
    let (total, at_most) = (
        used.iter().map(Vec::len).sum(),
        MAX_MEASURED_CORNERS.saturating_sub(used.len()).max(1),
    );
    let stride = usize::max(1, usize::div_ceil(total, at_most));
    let mut error = 0.0_f32;
    let mut budget = TestBudget::new();
    for (used, coarse) in used.iter().zip(coarse) {
        let Some(surface) = Deviation::new(corners, coarse) else {
            error = error.max(size(|| used.iter().map(|corner| &corners[*corner as usize])));
            continue;
        };
        let measured: Vec<Vector> = used
            .iter()
            .step_by(stride)
            .map(|corner| point(corners, *corner))
            .collect();
        error = surface.farthest(&measured, error, most, &mut budget)?;
    }
    (error <= most).then_some(error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Mesh;

    #[test]
    fn large_fan_around_one_corner_is_not_simplified() {
        let fan = |count: u32| {
            let mut corners = vec![[0.0, 0.0, 1.0]];
            corners.extend((0..count).map(|k| {
                let (sin, cos) = libm::sincosf(k as f32 / count as f32 * std::f32::consts::TAU);
                [sin, cos, 0.0]
            }));
            let triangles: Vec<[u32; 3]> = (0..count).map(|k| [0, 1 + k, 1 + (k + 1) % count]).collect();
            levels(&corners, &[triangles])
        };
        assert!(!fan(1_000).is_empty());
        assert!(fan(200_000).is_empty(), "simplifying would take about 15 seconds");
    }

    #[test]
    fn levels_of_a_ball_get_coarser_and_report_their_error() {
        let ball = Mesh::ball(1.0, 1.0, 48, 32);
        let levels = levels(&ball.corners, std::slice::from_ref(&ball.triangles));
        assert_eq!(levels.len(), 3);
        let (mut triangles, mut error) = (ball.triangles.len(), 0.0);
        for level in &levels {
            assert!(
                level.triangles[0].len() * 3 <= triangles * 2 && level.error > error,
                "{level:?}"
            );
            (triangles, error) = (level.triangles[0].len(), level.error);
        }
        assert!(error < MAX_ERROR * 2.0, "{error} m for a ball of 2 m");
    }

    #[test]
    fn groups_stay_separate_and_a_cube_is_not_simplified() {
        let (low, high) = (Mesh::ball(1.0, 1.0, 32, 24), Mesh::ball(0.5, 2.5, 32, 24));
        let both = low.clone().with(&high);
        let (first, second) = both.triangles.split_at(low.triangles.len());
        for level in levels(&both.corners, &[first.to_vec(), second.to_vec()]) {
            let is_high = |corner: &u32| *corner as usize >= low.corners.len();
            assert!(!level.triangles[0].iter().flatten().any(is_high));
            assert!(level.triangles[1].iter().flatten().all(is_high));
        }
        let cube = Mesh::cuboid([1.0; 3], 0.0);
        assert!(levels(&cube.corners, std::slice::from_ref(&cube.triangles)).is_empty());
    }

    #[test]
    fn level_beyond_the_error_limit_is_dropped() {
        let ball = Mesh::ball(1.0, 1.0, 48, 32);
        let fine = [ball.triangles.clone()];
        let some = [ball.triangles[..ball.triangles.len() / 2].to_vec()];
        assert_eq!(error(&ball.corners, &fine, &fine, 0.0), Some(0.0), "nothing is missing");
        assert!(
            error(&ball.corners, &fine, &some, 0.4).is_none(),
            "half of it is missing"
        );
        assert!(error(&ball.corners, &fine, &some, 4.0).is_some());
        let nothing = error(&ball.corners, &fine, &[Vec::new()], 4.0);
        assert!(nothing.is_some_and(|error| (error - 2.0).abs() < 0.01), "{nothing:?}");
    }

    #[test]
    fn sampling_corners_hardly_changes_the_measured_error() {
        let ball = Mesh::ball(1.0, 1.0, 256, 256);
        assert!(
            ball.corners.len() > 3 * MAX_MEASURED_CORNERS,
            "{} corners",
            ball.corners.len()
        );
        let coarse = Mesh::ball(1.0, 1.0, 16, 12);
        let both = ball.clone().with(&coarse);
        let coarse = [both.triangles[ball.triangles.len()..].to_vec()];
        let surface = Deviation::new(&both.corners, &coarse[0]).expect("the coarse ball has triangles");
        let distances = (0..ball.corners.len() as u32).map(|corner| surface.distance(point(&both.corners, corner)));
        let exact = distances.fold(0.0, f32::max);
        let found = error(&both.corners, &[ball.triangles], &coarse, 1.0);
        assert!(
            found.is_some_and(|found| found <= exact && found > 0.95 * exact),
            "{found:?} m of {exact} m"
        );
    }
}

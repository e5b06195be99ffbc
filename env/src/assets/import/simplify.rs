//! Coarser forms of a surface, with the distance by which each is off. Made once, when a model is imported, and stored: the
//! simplifier's arithmetic is its C++ compiler's, so nothing that must be the same on every machine may call it.

use meshopt::SimplifyOptions;
use rapier3d::math::Vector;
use rapier3d::parry::query::PointQuery;
use rapier3d::parry::shape::TriMesh;

use crate::assets::library::{Detail, MAX_MODEL_LEVELS};

/// Triangles below which a surface is not worth simplifying: a few blocks of the renderer.
const WORTH_IT: usize = 96;

/// The share of triangles that each level means to keep of the one before.
const KEPT: usize = 4;

/// The largest error of a level, as a share of the surface's size.
const MOST_ERROR: f32 = 0.2;

/// Up to three coarser levels of a surface, triangles in groups of one colour; each level with at most two thirds of the triangles
/// of the one before. Groups share no corners.
pub(super) fn levels(corners: &[[f32; 3]], groups: &[Vec<[u32; 3]>]) -> Vec<Detail> {
    let mut group_of = vec![0_usize; corners.len()];
    for (group, triangles) in groups.iter().enumerate() {
        triangles
            .iter()
            .flatten()
            .for_each(|corner| group_of[*corner as usize] = group);
    }
    let whole: Vec<u32> = groups.iter().flatten().flatten().copied().collect();
    let most_error = MOST_ERROR * size(|| corners.iter());
    let mut levels: Vec<Detail> = Vec::new();
    let mut before = whole.len() / 3;
    for _ in 1..MAX_MODEL_LEVELS {
        if before < WORTH_IT {
            break;
        }
        let indices = simplified(&whole, corners, before / KEPT * 3, most_error);
        let mut by_group = vec![Vec::new(); groups.len()];
        for three in indices.chunks_exact(3) {
            by_group[group_of[three[0] as usize]].push([three[0], three[1], three[2]]);
        }
        let pairs = groups.iter().zip(&by_group);
        let error = pairs
            .map(|(fine, coarse)| distance(corners, fine, coarse))
            .fold(0.0, f32::max);
        if indices.len() > before * 2 || error > most_error {
            break;
        }
        before = indices.len() / 3;
        let last = levels.last().map_or(0.0, |level: &Detail| level.error);
        levels.push(Detail {
            error: error.max(last),
            triangles: by_group,
        });
    }
    levels
}

fn simplified(whole: &[u32], corners: &[[f32; 3]], wanted: usize, most_error: f32) -> Vec<u32> {
    // Where two colours meet, each has its own corner in the same place: the simplifier takes that for a seam, and keeps it.
    let options = SimplifyOptions::ErrorAbsolute | SimplifyOptions::Prune;
    meshopt::simplify_decoder(whole, corners, wanted, most_error, options, None)
}

/// The largest extent of points along an axis.
fn size<'a, I: Iterator<Item = &'a [f32; 3]>>(points: impl Fn() -> I) -> f32 {
    let along = |axis: usize| {
        let values = || points().map(|point| point[axis]);
        values().fold(f32::NEG_INFINITY, f32::max) - values().fold(f32::INFINITY, f32::min)
    };
    along(0).max(along(1)).max(along(2)).max(0.0)
}

/// How far the corners of a group lie from its coarser form at most; its size if nothing is left of it.
fn distance(corners: &[[f32; 3]], fine: &[[u32; 3]], coarse: &[[u32; 3]]) -> f32 {
    let used = |triangles: &[[u32; 3]]| {
        let mut used = triangles.as_flattened().to_vec();
        used.sort_unstable();
        used.dedup();
        used
    };
    let at = |corner: &u32| &corners[*corner as usize];
    let (all, left) = (used(fine), used(coarse));
    let point = |corner: &u32| {
        let [x, y, z] = *at(corner);
        Vector::new(x, y, z)
    };
    let place = |corner: u32| left.binary_search(&corner).map_or(0, |place| place as u32);
    let triangles = coarse.iter().map(|triangle| triangle.map(place)).collect();
    let Ok(mesh) = TriMesh::new(left.iter().map(point).collect(), triangles) else {
        return size(|| all.iter().map(at));
    };
    let far = all
        .iter()
        .map(|corner| mesh.distance_to_local_point(point(corner), false));
    far.fold(0.0, f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::Mesh;

    #[test]
    fn a_ball_gets_coarser_level_by_level_and_says_by_how_much() {
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
        assert!(error < MOST_ERROR * 2.0, "{error} m for a ball of 2 m");
    }

    #[test]
    fn groups_keep_their_triangles_and_a_cube_is_left_alone() {
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
}

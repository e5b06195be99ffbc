//! Adds tops to walls: to all walls in images from above, and to walls below the agent's eyes in its view in the natural style.

use crate::assets::Mesh;
use crate::ground::triangles;
use crate::scene::{ARENA_WALLS, PanelGroup, WallPanel};

/// The tops of regions and walls as faces that point up, each in its wall's colour, for walls whose edges satisfy
/// `is_visible`. The arena's own walls have no thickness, and walls without height have no top.
pub(crate) fn tops(walls: &[WallPanel], is_visible: impl Fn(&[WallPanel]) -> bool) -> impl Iterator<Item = PanelGroup> {
    let mut remaining = walls.get(ARENA_WALLS..).unwrap_or_default();
    std::iter::from_fn(move || {
        let first = remaining.first()?;
        // The edges of a wall are consecutive, and the last one ends where the first begins.
        let closes = remaining.iter().position(|edge| edge.to == first.from);
        let (ring, rest) = remaining.split_at(closes.map_or(remaining.len(), |last| last + 1));
        remaining = rest;
        Some(ring)
    })
    .filter(move |ring| ring[0].height > 0.0 && is_visible(ring))
    .map(|ring| PanelGroup {
        height: ring[0].height,
        ..PanelGroup::of(top(ring), ring[0].color)
    })
}

fn top(ring: &[WallPanel]) -> Mesh {
    let corners: Vec<[f64; 2]> = ring.iter().map(|edge| edge.from.map(f64::from)).collect();
    Mesh {
        triangles: triangles(&corners),
        corners: ring
            .iter()
            .map(|edge| [edge.from[0], edge.from[1], edge.height])
            .collect(),
    }
}

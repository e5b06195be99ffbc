//! The tops of walls, for pictures from above. The agent's own pictures have none: it looks from below them.

use crate::assets::Mesh;
use crate::ground::triangles;
use crate::scene::{ARENA_WALLS, PanelGroup, WallPanel};

/// The tops of regions and walls as faces seen from above, each in its wall's colour. The arena's own walls have no
/// thickness, and walls without height no top.
pub(crate) fn tops(walls: &[WallPanel]) -> impl Iterator<Item = PanelGroup> {
    let mut left = walls.get(ARENA_WALLS..).unwrap_or_default();
    std::iter::from_fn(move || {
        let first = left.first()?;
        // The edges of one wall follow each other, and the last one ends where the first begins.
        let closes = left.iter().position(|edge| edge.to == first.from);
        let (ring, rest) = left.split_at(closes.map_or(left.len(), |last| last + 1));
        left = rest;
        Some(ring)
    })
    .filter(|ring| ring[0].height > 0.0)
    .map(|ring| PanelGroup::of(top(ring), ring[0].color))
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

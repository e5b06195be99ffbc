//! Geometry of zones on the ground as flat coloured polygons, for both renderers.

use driftworld_spec::{World, Zone};

use crate::assets::{Material, Mesh, Paint, Part};
use crate::scene::PanelGroup;

/// Number of corners of the polygon that approximates a disc.
const CORNERS: u32 = 64;

/// Height of a patch above the ground, as a fraction of the camera's height: too small to affect depth images, large enough to
/// lie on top.
const LIFT: f32 = 1e-4;

/// Additional height of each patch over the one before, as a fraction of the lift, and the maximum number of such steps.
const STEP: (f32, usize) = (0.1, 100);

/// Distances in metres from the arena to the edges of the two bands of ground around it. A single band would be
/// inaccurate nearby, because its outer corners are so distant.
const BAND_EDGES: [f32; 3] = [0.0, 500.0, 50_000.0];

/// Height of that ground in metres.
const SURROUNDING_HEIGHT: f32 = 0.01;

/// Flat ground outside an arena of this size.
pub(crate) fn around(size: [f32; 2], color: [f32; 3]) -> PanelGroup {
    let ring = |more: f32| {
        let [x, y] = size.map(|side| side / 2.0 + more);
        [[-x, -y], [x, -y], [x, y], [-x, y]].map(|[x, y]| [x, y, SURROUNDING_HEIGHT])
    };
    let quads = [0, 4].into_iter().flat_map(|inner| {
        let outer = inner + 4;
        (0..4).map(move |k| [outer + k, outer + (k + 1) % 4, inner + (k + 1) % 4, inner + k])
    });
    let mesh = Mesh {
        corners: BAND_EDGES.map(ring).concat(),
        triangles: quads.flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
    };
    PanelGroup::of(mesh, color.map(|channel| 0.5 + 0.15 * channel))
}

/// The visible zones of a world in its order; where they overlap, later ones lie on top.
pub(crate) fn patches(world: &World) -> impl Iterator<Item = PanelGroup> {
    let zones = world.environment_params.zones.iter().filter(|zone| zone.visible);
    zones.enumerate().map(|(index, zone)| {
        let mut group = PanelGroup::of(mesh(zone), zone.ground_color().to_f32());
        let (step, max_steps) = STEP;
        group.lift = LIFT * (1.0 + step * index.min(max_steps) as f32);
        group
    })
}

/// A zone's ground as triangles that face up.
fn mesh(zone: &Zone) -> Mesh {
    let corners = corners(zone);
    Mesh {
        triangles: triangles(&corners),
        corners: corners.into_iter().map(|[x, y]| [x as f32, y as f32, 0.0]).collect(),
    }
}

/// A point well inside a zone: the centre of a disc, or of a polygon's largest triangle.
pub(crate) fn middle(zone: &Zone) -> Option<[f64; 2]> {
    if let Some(disc) = &zone.disc {
        return Some(disc.center);
    }
    let corners = corners(zone);
    let triangles = triangles(&corners);
    let triangles = triangles
        .iter()
        .map(|triangle| triangle.map(|index| corners[index as usize]));
    let largest = triangles.max_by(|a, b| turn(a[0], a[1], a[2]).total_cmp(&turn(b[0], b[1], b[2])))?;
    Some([0, 1].map(|axis| largest.iter().map(|corner| corner[axis]).sum::<f64>() / 3.0))
}

/// A zone's corners counter-clockwise; for a disc, the corners of the polygon that approximates it.
pub(crate) fn corners(zone: &Zone) -> Vec<[f64; 2]> {
    if let Some(disc) = &zone.disc {
        let corner = |k: u32| {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(CORNERS);
            let [x, y] = disc.center;
            [x + disc.radius * libm::cos(angle), y + disc.radius * libm::sin(angle)]
        };
        return (0..CORNERS).map(corner).collect();
    }
    let mut corners = zone.polygon.clone().unwrap_or_default();
    let next = corners.iter().cycle().skip(1);
    let twice_area: f64 = corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum();
    if twice_area < 0.0 {
        corners.reverse();
    }
    corners
}

/// Triangulates a polygon by ear clipping. A self-intersecting polygon is filled as far as possible.
pub(crate) fn triangles(corners: &[[f64; 2]]) -> Vec<[u32; 3]> {
    let mut remaining: Vec<u32> = (0..corners.len() as u32).collect();
    let mut triangles = Vec::with_capacity(corners.len().saturating_sub(2));
    let at = |index: u32| corners[index as usize];
    while remaining.len() > 3 {
        let count = remaining.len();
        let around = |k: usize| {
            [
                remaining[(k + count - 1) % count],
                remaining[k],
                remaining[(k + 1) % count],
            ]
        };
        let is_ear = |k: &usize| {
            let [a, b, c] = around(*k);
            let inside =
                |other: &u32| ![a, b, c].map(at).contains(&at(*other)) && is_within([a, b, c].map(at), at(*other));
            turn(at(a), at(b), at(c)) >= 0.0 && !remaining.iter().any(inside)
        };
        let Some(ear) = (0..count).find(is_ear) else { break };
        triangles.push(around(ear));
        remaining.remove(ear);
    }
    if let [a, b, c] = remaining[..] {
        triangles.push([a, b, c]);
    }
    triangles.retain(|triangle| {
        let [a, b, c] = triangle.map(at);
        turn(a, b, c) > 0.0
    });
    triangles
}

/// Positive if the path over three points turns left.
fn turn(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn is_within([a, b, c]: [[f64; 2]; 3], point: [f64; 2]) -> bool {
    turn(a, b, point) >= 0.0 && turn(b, c, point) >= 0.0 && turn(c, a, point) >= 0.0
}

impl PanelGroup {
    /// A group of faces of one colour.
    pub(crate) fn of(mesh: Mesh, color: [f32; 3]) -> Self {
        let part = Part::new(mesh, Paint::Fixed(color));
        let mut sides = [[f32::INFINITY, f32::NEG_INFINITY]; 3];
        for corner in &part.mesh.corners {
            for ([low, high], value) in sides.iter_mut().zip(*corner) {
                *low = low.min(value);
                *high = high.max(value);
            }
        }
        let halves = sides.map(|[low, high]| ((high - low) / 2.0).max(0.0));
        Self {
            middle: sides.map(|[low, high]| if low <= high { f32::midpoint(low, high) } else { 0.0 }),
            radius: halves.iter().map(|half| half * half).sum::<f32>().sqrt(),
            color,
            lift: 0.0,
            edges: Vec::new(),
            height: 0.0,
            blocks: Material::new(&part).blocks,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// The triangles of a simple polygon cover exactly its interior.
        #[test]
        fn triangles_cover_the_zone(
            radii in prop::collection::vec(0.5..5.0f64, 3..12),
            is_clockwise in any::<bool>(),
            point in prop::array::uniform2(-5.0..5.0f64),
        ) {
            let count = radii.len() as f64;
            let mut star: Vec<[f64; 2]> = radii.iter().enumerate().map(|(k, radius)| {
                let angle = std::f64::consts::TAU * k as f64 / count;
                [radius * libm::cos(angle), radius * libm::sin(angle)]
            }).collect();
            if is_clockwise {
                star.reverse();
            }
            let zone = Zone::polygon(star);
            let corners = corners(&zone);
            let triangles = triangles(&corners);
            prop_assert_eq!(triangles.len(), corners.len() - 2);
            let holds = triangles.iter().filter(|triangle| is_within(triangle.map(|k| corners[k as usize]), point));
            prop_assert_eq!(holds.count(), usize::from(zone.contains(point)));
        }
    }
}

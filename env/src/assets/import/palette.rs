//! Reduces a model to a few colours: triangles of similar colours become one part.

use std::collections::{BTreeMap, HashMap};

use super::color::srgb;
use super::surface::Surface;
use crate::assets::Paint;

/// Maximum number of fixed colours of a model.
const MAX_COLORS: usize = 64;

/// Number of quantisation steps per channel; colours that round to the same steps are merged.
const COLOR_STEPS: f32 = 31.0;

/// Triangles of one colour.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub(super) paint: Paint,
    pub(super) two_sided: bool,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Triangles that may become a group, with the sum of their linear colours weighted by area, and their total area.
#[derive(Default)]
struct ColorBin {
    light: [f64; 3],
    area: f64,
    triangles: Vec<[u32; 3]>,
}

/// Key of a bin: whether it has the main colour, whether it is two-sided, and its quantised colour.
type Kind = (bool, bool, [u8; 3]);

/// Groups the surface's triangles by colour; those of the material `main` take the object's colour.
pub(super) fn groups(surface: &Surface, main: Option<usize>) -> Vec<Group> {
    let mut bins: BTreeMap<Kind, ColorBin> = BTreeMap::new();
    for face in &surface.faces {
        let is_main = main.is_some() && face.material == main;
        let quantised = face.color.map(|light| (srgb(light) * COLOR_STEPS + 0.5) as u8);
        let kind = (is_main, face.two_sided, if is_main { [0; 3] } else { quantised });
        let (bin, area) = (bins.entry(kind).or_default(), surface.area(face.corners));
        bin.area += area;
        for (sum, light) in bin.light.iter_mut().zip(face.color) {
            *sum += area * f64::from(light);
        }
        bin.triangles.push(face.corners);
    }
    reduce(&mut bins);
    let group = |((is_main, two_sided, _), bin): (Kind, ColorBin)| {
        let color = bin.color();
        Group {
            paint: if is_main {
                Paint::Main(color)
            } else {
                Paint::Fixed(color)
            },
            two_sided,
            triangles: bin.triangles,
        }
    };
    bins.into_iter().map(group).collect()
}

/// Merges the smallest bins into those of the nearest colour, until few enough are left.
fn reduce(bins: &mut BTreeMap<Kind, ColorBin>) {
    let fixed = bins.iter().filter(|((is_main, ..), _)| !is_main);
    let mut by_area: Vec<(f64, Kind)> = fixed.map(|(kind, bin)| (bin.area, *kind)).collect();
    by_area.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    // One-sided and two-sided bins are never merged, because a two-sided sheet must keep its back.
    let (mut kept, mut merged): (Vec<Kind>, Vec<Kind>) = (Vec::new(), Vec::new());
    for (_, kind) in by_area {
        let num_same_sided = kept.iter().filter(|other| other.1 == kind.1).count();
        if num_same_sided < MAX_COLORS / 2 || kept.len() < MAX_COLORS && num_same_sided == kept.len() {
            kept.push(kind);
        } else {
            merged.push(kind);
        }
    }
    for kind in merged {
        let squared_distance = |other: &Kind| -> i32 {
            let differences = kind.2.iter().zip(other.2).map(|(a, b)| i32::from(*a) - i32::from(b));
            differences.map(|step| step * step).sum()
        };
        let nearest = kept
            .iter()
            .filter(|other| other.1 == kind.1)
            .min_by_key(|other| squared_distance(other));
        let (Some(&nearest), Some(bin)) = (nearest, bins.remove(&kind)) else {
            continue;
        };
        let target = bins.entry(nearest).or_default();
        target.area += bin.area;
        (0..3).for_each(|k| target.light[k] += bin.light[k]);
        target.triangles.extend(bin.triangles);
    }
}

impl ColorBin {
    fn color(&self) -> [f32; 3] {
        self.light
            .map(|light| srgb((light / self.area.max(f64::MIN_POSITIVE)) as f32))
    }
}

/// The corners that groups use, with coincident corners of a group merged, and the groups with their new indices.
pub(super) fn welded(corners: &[[f32; 3]], mut groups: Vec<Group>) -> (Vec<[f32; 3]>, Vec<Group>) {
    let mut welded = Vec::new();
    for group in &mut groups {
        // Used for lookups only: the order of corners follows the triangles, not the map.
        let mut known: HashMap<[u32; 3], u32> = HashMap::new();
        for corner in group.triangles.as_flattened_mut() {
            // Adding 0 turns -0 into 0, which is the same position.
            let at = corners[*corner as usize].map(|metres| metres + 0.0);
            *corner = *known.entry(at.map(f32::to_bits)).or_insert_with(|| {
                welded.push(at);
                welded.len() as u32 - 1
            });
        }
        // Drops triangles whose corners became equal in 32 bits.
        group.triangles.retain(|[a, b, c]| a != b && b != c && c != a);
    }
    groups.retain(|group| !group.triangles.is_empty());
    (welded, groups)
}

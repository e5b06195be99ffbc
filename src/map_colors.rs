//! Finds the colours of a group of objects on a map, as they appear from above.

use driftworld_env::{Image, Scene, top_down, top_down_scale};
use driftworld_report::picture::Rgb;

use crate::map_drawing::map_size;

/// Height in pixels of the pictures in which pixels are counted.
const HEIGHT: u32 = 192;
/// Colours closer than this, in levels of 0 to 255, count as one.
const NEAR: i32 = 48;
/// Squared distance by which light and shadow may change the colour of a paint.
const SHADE: i32 = 96 * 96;
/// Maximum number of colours in a swatch.
const MAX_COLORS: usize = 3;
/// Colour of the rims of doors and keys.
const RIM: Rgb = [20, 24, 30];

/// Renders groups of a scene's objects from above, each group alone.
pub(crate) struct MapColors {
    /// The scene with its objects hidden, except for a speck that fixes the scale.
    scene: Scene,
    bare: Image,
}

impl MapColors {
    pub(crate) fn of(scene: &Scene) -> Self {
        let mut scene = scene.clone().in_neutral_light();
        let mut far = [0.0_f32; 2];
        for item in &mut scene.items {
            if item.visible {
                let radius = item.asset.radius * item.scale;
                far = [0, 1].map(|axis| far[axis].max(item.position[axis].abs() + radius));
            }
            item.visible = false;
        }
        // A map also covers objects outside the arena: a speck as far out as they are gives all pictures the same scale.
        if let Some(mut speck) = scene.items.first().cloned() {
            speck.scale = 1e-3;
            (speck.visible, speck.position) = (true, far);
            scene.items.push(speck);
        }
        let [width, height] = map_size(&scene, HEIGHT);
        Self {
            bare: top_down(&scene, width, height, None),
            scene,
        }
    }

    /// The colours of these items, the most visible first: one if they look alike, at most three. Empty if none of them
    /// is visible.
    pub(crate) fn of_group(&self, members: &[usize]) -> Vec<Rgb> {
        let mut groups: Vec<(Rgb, usize)> = Vec::new();
        for (color, pixels) in self.of_members(members) {
            match groups.iter_mut().find(|(other, _)| is_near(*other, color)) {
                Some((_, sum)) => *sum += pixels,
                None => groups.push((color, pixels)),
            }
        }
        groups.sort_by_key(|(_, pixels)| std::cmp::Reverse(*pixels));
        groups.into_iter().take(MAX_COLORS).map(|(color, _)| color).collect()
    }

    /// The visible colour of each of these items, and its number of pixels: the median of the pixels nearest to the item.
    fn of_members(&self, members: &[usize]) -> Vec<(Rgb, usize)> {
        let mut scene = self.scene.clone();
        for index in members {
            scene.items[*index].visible = true;
        }
        let (width, height) = (self.bare.width, self.bare.height);
        let image = top_down(&scene, width, height, None);
        let scale = top_down_scale(&scene, width, height);
        let middles: Vec<[f32; 2]> = (members.iter())
            .map(|index| {
                let [x, y] = scene.items[*index].position;
                [width as f32 / 2.0 + x * scale, height as f32 / 2.0 - y * scale]
            })
            .collect();
        let mut pixels: Vec<Vec<Rgb>> = vec![Vec::new(); members.len()];
        let nearest = Nearest::of(&middles, [width, height]);
        let pairs = image.rgb.chunks_exact(3).zip(self.bare.rgb.chunks_exact(3));
        for (index, (shown, bare)) in pairs.enumerate() {
            if shown == bare || shown == RIM {
                continue;
            }
            let at = [index as u32 % width, index as u32 / width].map(|pixel| pixel as f32 + 0.5);
            if let Some(own) = nearest.to(at) {
                pixels[own].push([shown[0], shown[1], shown[2]]);
            }
        }
        let with_color = |(index, pixels): (&usize, &Vec<Rgb>)| {
            let shaded = median(pixels)?;
            // Use the object's own paint if that is the visible colour; the paint of a trunk below leaves is not.
            let paint = scene.items[*index]
                .color
                .map(|paint| paint.map(|share| (share * 255.0) as u8));
            let paint = paint.filter(|paint| distance(*paint, shaded) < SHADE);
            Some((paint.unwrap_or(shaded), pixels.len()))
        };
        members.iter().zip(&pixels).filter_map(with_color).collect()
    }
}

/// Positions in a picture, indexed by square cells.
struct Nearest<'a> {
    points: &'a [[f32; 2]],
    columns: usize,
    cells: Vec<Vec<usize>>,
}

impl<'a> Nearest<'a> {
    /// Pixels per cell side.
    const CELL: usize = 4;

    /// Positions outside the picture go to the nearest cell at its edge.
    fn of(points: &'a [[f32; 2]], size: [u32; 2]) -> Self {
        let [columns, rows] = size.map(|pixels| (pixels as usize).div_ceil(Self::CELL).max(1));
        let mut cells = vec![Vec::new(); columns * rows];
        for (index, [x, y]) in points.iter().enumerate() {
            let cell = |at: f32, count: usize| (at.max(0.0) as usize / Self::CELL).min(count - 1);
            cells[cell(*y, rows) * columns + cell(*x, columns)].push(index);
        }
        Self { points, columns, cells }
    }

    /// The position nearest to a point of the picture; the first of equally near ones.
    fn to(&self, at: [f32; 2]) -> Option<usize> {
        let rows = self.cells.len() / self.columns;
        let [column, row] = at.map(|pixel| pixel as usize / Self::CELL);
        let mut best: Option<(f32, usize)> = None;
        for ring in 0..self.columns.max(rows) {
            // No point in this ring is nearer.
            let min_distance = (ring.saturating_sub(1) * Self::CELL) as f32;
            if best.is_some_and(|(square, _)| square < min_distance * min_distance) {
                break;
            }
            for y in row.saturating_sub(ring)..(row + ring + 1).min(rows) {
                let is_edge = row.abs_diff(y) == ring;
                for x in column.saturating_sub(ring)..(column + ring + 1).min(self.columns) {
                    if !is_edge && column.abs_diff(x) != ring {
                        continue;
                    }
                    for &index in &self.cells[y * self.columns + x] {
                        let [across, down] = [0, 1].map(|axis| self.points[index][axis] - at[axis]);
                        let found = (across * across + down * down, index);
                        if best.is_none_or(|best| found < best) {
                            best = Some(found);
                        }
                    }
                }
            }
        }
        best.map(|(_, index)| index)
    }
}

/// The median of pixels in each channel: the middle of their shades.
fn median(pixels: &[Rgb]) -> Option<Rgb> {
    let half = pixels.len() / 2;
    let channel = |channel: usize| {
        let mut levels: Vec<u8> = pixels.iter().map(|pixel| pixel[channel]).collect();
        levels.sort_unstable();
        levels.get(half).copied()
    };
    Some([channel(0)?, channel(1)?, channel(2)?])
}

/// The squared distance of colours, in levels.
fn distance(one: Rgb, other: Rgb) -> i32 {
    let channels = one.iter().zip(other);
    channels.map(|(a, b)| (i32::from(*a) - i32::from(b)).pow(2)).sum()
}

fn is_near(one: Rgb, other: Rgb) -> bool {
    distance(one, other) < NEAR * NEAR
}

#[cfg(test)]
mod tests {
    use driftworld_generator::Sampler;
    use driftworld_spec::{Color, Object, WorldDraft};
    use proptest::prelude::*;

    use super::*;
    use crate::tasks;

    const PAINTS: [[f64; 3]; 5] = [
        [1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [1.0, 1.0, 0.0],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, 1.0],
    ];

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        /// In an arena of any size, the colours of a group of cubes are its most frequent paints, up to three.
        #[test]
        fn group_has_its_most_frequent_colours(
            paints in prop::collection::vec(0_usize..5, 1..8),
            side in 20.0..80.0_f64,
        ) {
            let mut draft = WorldDraft::default();
            draft.environment_params.map_size = [side, side];
            for (number, paint) in paints.iter().enumerate() {
                let coordinate = |k: usize| (k as f64 - 1.0) * side / 4.0;
                let mut object = Object::new("geometric", [coordinate(number % 3), coordinate(number / 3)]);
                object.color = Some(Color(PAINTS[*paint]));
                draft.objects.push(object);
            }
            let world = draft.check().expect("the world is valid");
            let members: Vec<usize> = (0..paints.len()).collect();
            let found = MapColors::of(&Scene::from_world(&world)).of_group(&members);
            let count = |paint: usize| paints.iter().filter(|other| **other == paint).count();
            let painted = |color: &Rgb| -> Option<usize> {
                let near = |paint: &usize| is_near(*color, PAINTS[*paint].map(|share| (share * 255.0) as u8));
                (0..5).find(near)
            };
            let found: Vec<usize> = found.iter().filter_map(painted).collect();
            let different = (0..5).filter(|paint| count(*paint) > 0).count();
            prop_assert_eq!(found.len(), different.min(MAX_COLORS), "{:?} of {:?}", found, paints);
            for (paint, other) in (0..5).flat_map(|paint| found.iter().map(move |other| (paint, *other))) {
                prop_assert!(found.contains(&paint) || count(paint) <= count(other), "{:?} of {:?}", found, paints);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn nearest_position_matches_brute_force(
            points in prop::collection::vec(prop::array::uniform2(-9.0..60.0_f32), 0..40),
            at in (0_u32..50, 0_u32..37),
        ) {
            let at = [at.0 as f32 + 0.5, at.1 as f32 + 0.5];
            let square = |point: &[f32; 2]| (point[0] - at[0]).powi(2) + (point[1] - at[1]).powi(2);
            let expected = (0..points.len()).min_by(|a, b| square(&points[*a]).total_cmp(&square(&points[*b])));
            prop_assert_eq!(Nearest::of(&points, [50, 37]).to(at), expected);
        }
    }

    /// Trees are green, not brown like their trunks. Doors in three colours have three colours.
    #[test]
    fn issue_24_groups_of_several_colors() {
        let of_class = |name: &str, class: &str| {
            let variant = tasks::variant(name).expect("it is built in");
            let world = Sampler::new(&variant, 0).world(0).expect("the world can be sampled");
            let objects = world.objects.iter().enumerate();
            let members: Vec<usize> = objects
                .filter(|(_, object)| object.class == class)
                .map(|(index, _)| index)
                .collect();
            MapColors::of(&Scene::from_world(&world)).of_group(&members)
        };
        let worlds = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/worlds");
        for name in ["find_objects", &format!("{worlds}/foraging.json")] {
            let trees = of_class(name, "tree");
            assert!(!trees.is_empty(), "{name}");
            for [red, green, blue] in trees {
                assert!(
                    green > blue && green.max(red) - blue > 5,
                    "{name}: {red} {green} {blue}"
                );
            }
        }
        assert_eq!(of_class(&format!("{worlds}/locked_rooms.json#keyed"), "door").len(), 3);
        assert_eq!(of_class(&format!("{worlds}/locked_rooms.json#open"), "door").len(), 1);
    }
}

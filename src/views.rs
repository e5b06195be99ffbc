//! [`Views`]: draws pictures of one world: the agent's view, the map, the overview, and close-ups.

#![expect(clippy::disallowed_methods, reason = "only camera positions for pictures")]

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::rc::Rc;

use driftworld_env::{
    CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE, CATEGORY_SKY, Camera,
    Catalogue, Environment, Frame, Renderer, Scene, category_color, depth_to_gray,
};
use driftworld_report::picture::{Drawing, Level, Picture, Side, TextLine, text_width};
use driftworld_spec::{Modality, World};

use crate::Failure;
use crate::map_drawing::{self, Moves};
use crate::map_legend;
use crate::modality::{gray_rgb, number_color, to_rgb};
use crate::subject::sight;

/// The pictures of one world.
pub(crate) struct Views<'a> {
    world: &'a World,
    scene: Scene,
    size: u32,
    turn: f32,
    renderer: Rc<RefCell<Renderer>>,
}

/// The three modalities of one view.
pub(crate) struct FirstPerson {
    pub(crate) rgb: Picture,
    pub(crate) depth: Picture,
    pub(crate) segmentation: Picture,
    /// The distance in metres at each pixel, row by row; larger than `farthest` in the sky.
    distances: Vec<f32>,
    /// The distance in metres to the farthest visible point that is not sky.
    farthest: f32,
    /// The visible reward categories.
    categories: BTreeSet<u8>,
}

impl FirstPerson {
    /// The depth picture with a scale of its greys below it. White is one of a few distances, so that indoor pictures have
    /// contrast.
    pub(crate) fn depth_with_legend(&self) -> Drawing {
        let (width, height) = (self.depth.width, self.depth.height);
        let white = white_at(self.farthest);
        let stretched: Vec<f32> = (self.distances.iter())
            .map(|metres| metres * DEPTH_METRES / white)
            .collect();
        let picture = Picture::new(width, height, gray_rgb(&stretched));
        let font_size = font_size(width);
        let bar = (font_size * 0.9).round();
        let mut drawing = Drawing::blank(width, height + (font_size * 1.4 + bar + 12.0) as u32);
        drawing.put(picture, [0, 0]);
        let (left, top) = (font_size, height as f32 + 5.0);
        let long = (width as f32 - 2.0 * font_size).max(10.0);
        let mut greys = Picture::blank(long as u32, bar as u32);
        for (index, pixel) in greys.rgb.chunks_exact_mut(3).enumerate() {
            let share = (index as u32 % greys.width) as f32 / (greys.width - 1).max(1) as f32;
            pixel.fill(depth_to_gray(&[share * DEPTH_METRES])[0]);
        }
        let right = left + long.floor();
        drawing.put(greys, [left as u32, top as u32]);
        let rim = [
            [left, top],
            [right, top],
            [right, top + bar],
            [left, top + bar],
            [left, top],
        ];
        drawing.line(rim, 1.0, INK);
        let is_beyond = self.distances.iter().any(|metres| *metres > white);
        let mut label_extents: Vec<[f32; 2]> = Vec::new();
        // Place the labels of the ends first: the labels between them use the remaining room.
        for quarter in [4_u8, 0, 2, 1, 3] {
            let share = f32::from(quarter) / 4.0;
            let (side, words) = match quarter {
                0 => (Side::Left, "0".to_owned()),
                4 if is_beyond => (Side::Right, format!("{white} m and more")),
                4 => (Side::Right, format!("{white} m")),
                _ => (Side::Middle, format!("{}", share * white)),
            };
            let x = left + share * (right - left);
            let wide = text_width(&words, font_size);
            let from = match side {
                Side::Left => x,
                Side::Middle => x - wide / 2.0,
                Side::Right => x - wide,
            };
            let gap = font_size * 0.6;
            if label_extents
                .iter()
                .all(|[start, end]| from > end + gap || from + wide + gap < *start)
            {
                label_extents.push([from, from + wide]);
                let line = TextLine::new(words, [x, top + bar + 4.0], font_size, INK);
                drawing.write(line.anchored(side, Level::Top));
            }
        }
        drawing
    }

    /// The picture of reward categories with the names of the visible ones below.
    pub(crate) fn segmentation_with_legend(&self) -> Drawing {
        let (width, height) = (self.segmentation.width, self.segmentation.height);
        let font_size = font_size(width);
        let line = (font_size * 1.5).round();
        let wide = |name: &str| text_width(name, font_size) + font_size * 2.6;
        let (mut entries, mut x, mut row) = (Vec::new(), 0.0, 0.0);
        for category in &self.categories {
            let name = category_name(*category);
            if x > 0.0 && x + wide(name) > width as f32 {
                (x, row) = (0.0, row + 1.0);
            }
            entries.push((*category, name, [x, row]));
            x += wide(name);
        }
        let mut drawing = Drawing::blank(width, height + (line * (row + 1.0) + 8.0) as u32);
        drawing.put(self.segmentation.clone(), [0, 0]);
        for (category, name, [x, row]) in entries {
            let middle = height as f32 + 4.0 + line * (row + 0.5);
            let half = font_size * 0.45;
            drawing.rectangle([x + 5.0, middle - half - 1.0, 2.0 * half + 2.0, 2.0 * half + 2.0], INK);
            drawing.rectangle(
                [x + 6.0, middle - half, 2.0 * half, 2.0 * half],
                category_color(category),
            );
            let words = TextLine::new(name, [x + font_size * 1.1 + 10.0, middle], font_size, INK);
            drawing.write(words.anchored(Side::Left, Level::Middle));
        }
        drawing
    }
}

const INK: [u8; 3] = [38, 42, 48];

/// Distance in metres that is white in depth pictures for agents.
const DEPTH_METRES: f32 = 100.0;

/// Distances in metres that may be white in depth pictures for people.
const SCALES: [f32; 4] = [10.0, 20.0, 40.0, DEPTH_METRES];

/// The first scale on which only the sky is white.
fn white_at(farthest: f32) -> f32 {
    let scale = SCALES.into_iter().find(|most| *most >= farthest);
    scale.unwrap_or(DEPTH_METRES)
}

/// Font size of a legend below a picture of this width.
fn font_size(width: u32) -> f32 {
    (width as f32 / 28.0).clamp(8.0, 15.0)
}

/// Free margin along each edge of the overview, as a share of half its width or height.
const OVERVIEW_MARGIN: f32 = 0.04;

/// Tangent of half the field of view of a close-up from its default distance: the field of view is 42°.
const CLOSE_UP_TANGENT: f32 = 0.384;

/// An object is shown in a close-up only if clearly more pixels than this show it, out of 4,096.
const MIN_CLOSE_UP_PIXELS: u32 = 80;

/// Camera rotations that are tried, in degrees clockwise.
pub(crate) const TURNS: [f32; 12] = [
    0.0, 30.0, -30.0, 60.0, -60.0, 90.0, -90.0, 120.0, -120.0, 150.0, -150.0, 180.0,
];

/// The name of a reward category.
fn category_name(category: u8) -> &'static str {
    match category {
        CATEGORY_SKY => "sky",
        CATEGORY_MAP => "ground and walls",
        CATEGORY_BUILDING => "building",
        CATEGORY_POSITIVE => "pays",
        CATEGORY_NEUTRAL => "worth nothing",
        CATEGORY_NEGATIVE => "costs",
        _ => "other",
    }
}

/// The camera of a world's agent at its start, rotated clockwise.
pub(crate) fn agent_camera(world: &World, turn: f32) -> Camera {
    let agent = &world.agent_params;
    Camera::first_person(
        agent.coordinates.map(|metres| metres as f32),
        agent.heading as f32 + turn,
        agent.agent_height as f32,
        agent.field_of_view as f32,
    )
}

impl<'a> Views<'a> {
    pub(crate) fn new(world: &'a World, size: u32, turn: f32) -> Self {
        Self::with_catalogue(world, &Catalogue::default(), size, turn)
    }

    /// With assets from a catalogue.
    pub(crate) fn with_catalogue(world: &'a World, catalogue: &Catalogue, size: u32, turn: f32) -> Self {
        Self {
            world,
            // The environment's scene, in which doors that start open are open.
            scene: Environment::with_catalogue(world.clone(), catalogue.clone())
                .scene()
                .clone(),
            size,
            turn,
            renderer: Rc::default(),
        }
    }

    /// Uses a renderer other than the CPU's.
    pub(crate) fn with_renderer(self, renderer: Renderer) -> Self {
        Self {
            renderer: Rc::new(RefCell::new(renderer)),
            ..self
        }
    }

    /// With a different size.
    pub(crate) fn with_size(&self, size: u32) -> Self {
        Self {
            size,
            renderer: Rc::clone(&self.renderer),
            ..Self::with_catalogue(self.world, self.scene.catalogue(), size, self.turn)
        }
    }

    /// The world from outside, above a corner of the arena.
    pub(crate) fn overview(&self, width: u32) -> Result<Picture, Failure> {
        let scene = self.scene.clone().with_wall_tops().with_surroundings();
        let camera = self.overview_direction(&scene);
        self.smooth(&scene, &self.fit_all(&scene, camera, width), width)
    }

    /// Moves the camera without rotating it, so that a picture of this width contains the whole arena with all its objects.
    fn fit_all(&self, scene: &Scene, camera: Camera, width: u32) -> Camera {
        let [wide, deep] = scene.arena_size().map(|side| side / 2.0);
        let wall = self.highest_wall();
        let mut points: Vec<[f32; 3]> = Vec::new();
        for (x, y) in [(-wide, -deep), (-wide, deep), (wide, -deep), (wide, deep)] {
            points.extend([[x, y, 0.0], [x, y, wall]]);
        }
        for item in scene.items.iter().filter(|item| item.visible) {
            let [radius, height] = [item.asset.radius, item.asset.height].map(|metres| metres * item.scale);
            let [x, y] = item.position;
            points.extend([[x - radius, y, height], [x + radius, y, height]]);
        }
        let [heading, pitch] = [camera.heading_deg, camera.pitch_deg].map(f32::to_radians);
        let (right, forward, up) = (
            [heading.cos(), -heading.sin(), 0.0],
            [heading.sin() * pitch.cos(), heading.cos() * pitch.cos(), pitch.sin()],
            [-heading.sin() * pitch.sin(), -heading.cos() * pitch.sin(), pitch.cos()],
        );
        let along = |of: [f32; 3], axis: [f32; 3]| of[0] * axis[0] + of[1] * axis[1] + of[2] * axis[2];
        // Each point's coordinates on the camera's axes: right, up and forward.
        let seen: Vec<[f32; 3]> = points
            .into_iter()
            .map(|point| [along(point, right), along(point, up), along(point, forward)])
            .collect();
        let tangent = (camera.field_of_view_deg / 2.0).to_radians().tan() * (1.0 - OVERVIEW_MARGIN);
        let edges = [tangent * width as f32 / self.size as f32, tangent];
        // The camera's position on these axes. The plane through the picture's left edge must not cut off the leftmost point, and
        // likewise for the other edges: the camera is where the planes of opposite edges meet, and behind both meeting points.
        let bound = |axis: usize, sign: f32| {
            let reach = |point: &[f32; 3]| sign * point[axis] - edges[axis] * point[2];
            seen.iter().map(reach).fold(f32::MIN, f32::max)
        };
        let (mut sideways, mut back) = ([0.0; 2], f32::MAX);
        for axis in [0, 1] {
            let (more, less) = (bound(axis, 1.0), bound(axis, -1.0));
            sideways[axis] = (more - less) / 2.0;
            back = back.min(-(more + less) / (2.0 * edges[axis]));
        }
        let position = [0, 1, 2].map(|axis| sideways[0] * right[axis] + sideways[1] * up[axis] + back * forward[axis]);
        Camera { position, ..camera }
    }

    /// Metres to the top of the highest wall.
    fn highest_wall(&self) -> f32 {
        let layout = self.world.plan().into_iter().flat_map(|plan| &plan.walls);
        layout
            .filter_map(|wall| wall.height)
            .fold(self.world.environment_params.wall_height, f64::max) as f32
    }

    /// The overview's camera before [`Self::fit_all`]: steep if walls would hide what is between them.
    fn overview_direction(&self, scene: &Scene) -> Camera {
        let is_divided = self.world.plan().is_some_and(|plan| !plan.walls.is_empty());
        let span = scene.arena_size().into_iter().fold(4.0, f32::max);
        let hides = is_divided || self.highest_wall() > span / 12.0;
        Camera {
            pitch_deg: if hides { -45.0 } else { -23.0 },
            ..Camera::overview(scene)
        }
    }

    /// The agent's view at the start.
    pub(crate) fn first_person(&self) -> Result<FirstPerson, Failure> {
        let camera = agent_camera(self.world, self.turn);
        let frame = self.frame(&self.scene, &camera, self.size, self.size)?;
        let picture = |kind| Picture::new(self.size, self.size, to_rgb(kind, &frame, number_color));
        Ok(FirstPerson {
            rgb: self.smooth(&self.scene, &camera, self.size)?,
            depth: picture(Modality::Depth),
            segmentation: picture(Modality::Segmentation),
            farthest: (frame.depth.iter().zip(&frame.category))
                .filter(|(_, category)| **category != CATEGORY_SKY)
                .fold(0.0, |most, (metres, _)| metres.max(most)),
            distances: frame.depth,
            categories: frame.category.into_iter().collect(),
        })
    }

    /// The agent's view at the start as one kind of image: classes and objects each have a colour.
    pub(crate) fn seen_in(&self, modality: Modality) -> Result<Picture, Failure> {
        let camera = agent_camera(self.world, self.turn);
        if modality == Modality::Rgb {
            return self.smooth(&self.scene, &camera, self.size);
        }
        let frame = self.frame(&self.scene, &camera, self.size, self.size)?;
        let rgb = to_rgb(modality, &frame, number_color);
        Ok(Picture::new(self.size, self.size, rgb))
    }

    /// The agent's view at the start in colour, at a learner's resolution.
    pub(crate) fn as_learners_see(&self, side: u32) -> Result<Picture, Failure> {
        let frame = self.frame(&self.scene, &agent_camera(self.world, self.turn), side, side)?;
        Ok(Picture::new(side, side, frame.rgb))
    }

    /// The agent's view at the start in colour, with smooth edges.
    pub(crate) fn smoothly(&self, size: [u32; 2]) -> Result<Picture, Failure> {
        let camera = agent_camera(self.world, self.turn);
        Picture::smooth(size, |[width, height]| {
            Ok(self.frame(&self.scene, &camera, width, height)?.rgb)
        })
    }

    /// The agent's views ahead, to its right, behind and to its left.
    pub(crate) fn all_around(&self) -> Result<Vec<Picture>, Failure> {
        let look = |turn: f32| {
            let camera = Camera {
                field_of_view_deg: 90.0,
                ..agent_camera(self.world, self.turn + turn)
            };
            self.smooth(&self.scene, &camera, self.size)
        };
        [0.0, 90.0, 180.0, 270.0].into_iter().map(look).collect()
    }

    /// For each object name, the name and a close-up of the object nearest to the agent, preferring rewarding objects.
    /// Objects that are not visible from nearby are left out.
    pub(crate) fn close_ups(&self, most: usize) -> Result<Vec<(String, Picture)>, Failure> {
        let start = self.world.agent_params.coordinates;
        let distance = |index: &usize| {
            let [x, y] = self.world.objects[*index].coordinates;
            (x - start[0]).hypot(y - start[1])
        };
        let mut indices: Vec<usize> = (0..self.world.objects.len()).collect();
        // Rewarding objects first, then by distance.
        indices.sort_by(|a, b| {
            let pays = |index: &usize| self.world.objects[*index].is_target();
            pays(b).cmp(&pays(a)).then(distance(a).total_cmp(&distance(b)))
        });
        let mut shown: Vec<(String, Picture)> = Vec::new();
        for index in indices {
            let name = map_legend::named(&self.world.objects[index]);
            if shown.len() < most
                && !shown.iter().any(|(other, _)| *other == name)
                && let Some(camera) = self.near(index)?
            {
                shown.push((name, self.smooth(&self.scene, &camera, self.size)?));
            }
        }
        Ok(shown)
    }

    /// A camera that sees an object, if possible from the agent's side; `None` if walls or other objects hide it from all sides.
    fn near(&self, index: usize) -> Result<Option<Camera>, Failure> {
        let mut best: (u32, Option<Camera>) = (MIN_CLOSE_UP_PIXELS, None);
        // Tries the agent's side first, then views from closer, at shares of the default distance.
        let candidates = [1.0, 0.6]
            .into_iter()
            .flat_map(|closeness| TURNS.map(|turn| (turn, closeness)));
        for (turn, closeness) in candidates {
            let camera = self.close_to(index, turn, closeness);
            let pixels = sight(&mut self.renderer.borrow_mut(), &self.scene, &camera, &[index])?.pixels;
            // Prefer earlier candidates unless a later one shows clearly more.
            if pixels > best.0 + best.0 / 4 {
                best = (pixels, Some(camera));
            }
        }
        Ok(best.1)
    }

    /// A camera that looks at an object from the agent's side, rotated around it, at a distance where the object fills the
    /// picture; closer with a wider angle.
    fn close_to(&self, index: usize, turn: f32, closeness: f32) -> Camera {
        let item = &self.scene.items[index];
        let start = self.world.agent_params.coordinates.map(|metres| metres as f32);
        let dir = [item.position[0] - start[0], item.position[1] - start[1]];
        let heading = if dir == [0.0; 2] { 0.0_f32 } else { dir[0].atan2(dir[1]) } + turn.to_radians();
        let size = item.asset.height.max(item.asset.radius * 1.6) * item.scale;
        let back = (1.9 * size + item.asset.radius * item.scale) * closeness;
        let height = size * 0.75 + 0.3;
        Camera {
            position: [
                item.position[0] - heading.sin() * back,
                item.position[1] - heading.cos() * back,
                height,
            ],
            heading_deg: heading.to_degrees(),
            pitch_deg: -((height - item.asset.height * item.scale * 0.5) / back)
                .atan()
                .to_degrees(),
            field_of_view_deg: 2.0 * (CLOSE_UP_TANGENT / closeness).atan().to_degrees(),
        }
    }

    /// The map with the agent's start, in even light.
    pub(crate) fn top_down(&self) -> Picture {
        map_drawing::map(self.world, &self.scene, &Moves::none(self.world), self.size).to_picture()
    }

    /// The map with triggers, signs of rewards and paths, and a legend to its right with scale and north.
    pub(crate) fn map_with_legend(&self, moves: &Moves) -> Drawing {
        map_legend::map_with_legend(self.world, &self.scene, moves, self.size)
    }

    /// A colour picture with smooth edges: rendered at twice the size unless it is very large.
    fn smooth(&self, scene: &Scene, camera: &Camera, width: u32) -> Result<Picture, Failure> {
        Picture::smooth([width, self.size], |[width, height]| {
            Ok(self.frame(scene, camera, width, height)?.rgb)
        })
    }

    fn frame(&self, scene: &Scene, camera: &Camera, width: u32, height: u32) -> Result<Frame, Failure> {
        let mut frame = Frame::new(width, height);
        self.renderer.borrow_mut().render(scene, camera, &mut frame)?;
        Ok(frame)
    }
}

#[cfg(test)]
mod tests {
    use driftworld_env::Target;
    use driftworld_report::picture::Shape;
    use driftworld_spec::{Object, WorldDraft};
    use proptest::prelude::*;

    use super::*;
    use crate::tasks;

    fn seen(size: u32, farthest: f32, sky: bool) -> FirstPerson {
        let pixels = (size * size) as usize;
        let mut distances = vec![farthest; pixels];
        distances[0] = if sky { 1000.0 } else { farthest };
        FirstPerson {
            rgb: Picture::blank(size, size),
            depth: Picture::blank(size, size),
            segmentation: Picture::blank(size, size),
            distances,
            farthest,
            categories: [CATEGORY_SKY].into(),
        }
    }

    /// The texts of a drawing with their horizontal extents.
    fn words(drawing: &Drawing) -> Vec<(String, [f32; 2])> {
        let lines = drawing.shapes.iter().filter_map(|shape| match shape {
            Shape::Text(line) => Some(line),
            _ => None,
        });
        let place = |line: &TextLine| {
            let share = match line.side {
                Side::Left => 0.0,
                Side::Middle => 0.5,
                Side::Right => 1.0,
            };
            let from = line.at[0] - share * line.width();
            (line.text.clone(), [from, from + line.width()])
        };
        lines.map(place).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 40)))]

        /// The labels of a depth scale never overlap or leave the picture, at any size, and the scale's end is always labelled.
        #[test]
        fn depth_scale_labels_do_not_overlap(size in 84_u32..700, farthest in 0.5..150.0_f32, sky in any::<bool>()) {
            let drawing = seen(size, farthest, sky).depth_with_legend();
            let mut words = words(&drawing);
            words.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
            for pair in words.windows(2) {
                prop_assert!(pair[0].1[1] + 2.0 < pair[1].1[0], "{words:?}");
            }
            prop_assert!(words.iter().all(|(_, [from, to])| *from >= 0.0 && *to <= size as f32), "{words:?}");
            let last = &words.last().expect("the scale has words").0;
            prop_assert!(last.contains(" m"), "{last}");
            prop_assert_eq!(last.ends_with("and more"), sky || farthest > 100.0);
        }

        /// Objects in all four corners of an arena of any shape are visible in the overview.
        #[test]
        fn overview_contains_every_corner(wide in 20.0..60.0_f64, deep in 20.0..60.0_f64, wall in 0.0..1.5_f64) {
            let side = wide.min(deep);
            let mut draft = WorldDraft::default();
            draft.environment_params.map_size = [wide, deep];
            draft.environment_params.wall_height = wall;
            let thing = side / 10.0;
            for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
                let mut object = Object::new("geometric", [x * (wide - thing) / 2.0, y * (deep - thing) / 2.0]);
                object.scale = thing;
                draft.objects.push(object);
            }
            let world = draft.check().expect("the world is valid");
            let views = Views::new(&world, 180, 0.0);
            let scene = views.scene.clone().with_wall_tops();
            let camera = views.fit_all(&scene, views.overview_direction(&scene), 320);
            let mut instances = vec![0_u32; 180 * 320];
            let mut target = Target { width: 320, height: 180, instance: Some(&mut instances), ..Target::default() };
            Renderer::default().draw(&scene, &camera, &mut target).expect("it renders");
            for number in 1..=4_u32 {
                let pixels: Vec<usize> = (0..instances.len()).filter(|at| instances[*at] == number).collect();
                prop_assert!(pixels.len() >= 4, "{number}: {} pixels", pixels.len());
                let on_the_edge = pixels.iter().any(|at| at % 320 == 0 || at % 320 == 319 || at / 320 == 0 || at / 320 == 179);
                prop_assert!(!on_the_edge, "{number} is cut off");
            }
        }
    }

    /// A close-up shows its object even if walls stand between it and the agent.
    #[test]
    fn close_ups_show_their_objects() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/worlds");
        for name in ["maze", "t_maze", "key_corridor", "locked_rooms"] {
            let variants = tasks::variants_of(&[folder.join(format!("{name}.json")).display().to_string()]);
            let (_, variant) = variants.expect("it is a task").swap_remove(0);
            let world = driftworld_generator::Sampler::new(&variant, 0)
                .world(0)
                .expect("it renders");
            let views = Views::new(&world, 64, 0.0);
            let things: std::collections::BTreeSet<String> = world.objects.iter().map(map_legend::named).collect();
            let close_ups = views.close_ups(5).expect("they render");
            assert_eq!(close_ups.len(), things.len().min(5), "{name}");
            let mut shown = 0;
            for index in 0..world.objects.len() {
                let Some(camera) = views.near(index).expect("it renders") else {
                    continue;
                };
                let seen = sight(&mut Renderer::default(), &views.scene, &camera, &[index]).expect("it renders");
                assert!(seen.pixels > MIN_CLOSE_UP_PIXELS, "{name}: {index}");
                shown += 1;
            }
            assert!(
                shown + 1 >= world.objects.len(),
                "{name}: {shown} of {}",
                world.objects.len()
            );
        }
    }
}

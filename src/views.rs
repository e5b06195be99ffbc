//! [`Views`]: the pictures of one world, as the agent sees it, from above and from near by.

#![expect(clippy::disallowed_methods, reason = "where a camera stands for a picture")]

use std::cell::RefCell;
use std::rc::Rc;

use driftworld_env::{
    CATEGORY_BUILDING, CATEGORY_MAP, CATEGORY_NEGATIVE, CATEGORY_NEUTRAL, CATEGORY_POSITIVE, CATEGORY_SKY, Camera,
    Catalogue, Environment, Frame, Renderer, Scene, category_color, depth_to_gray,
};
use driftworld_report::picture::{Drawing, Level, Picture, Side, TextLine, text_width};
use driftworld_spec::World;

use crate::Failure;
use crate::map_drawing::{self, Moves};

/// The pictures of one world.
pub(crate) struct Views<'a> {
    world: &'a World,
    scene: Scene,
    size: u32,
    turn: f32,
    renderer: Rc<RefCell<Renderer>>,
}

/// The three modalities of one view.
pub(crate) struct Seen {
    pub(crate) rgb: Picture,
    pub(crate) depth: Picture,
    pub(crate) segmentation: Picture,
    /// The reward categories that are in it.
    categories: Vec<u8>,
}

impl Seen {
    /// The picture of distances with what its greys mean below it.
    pub(crate) fn depth_with_legend(&self) -> Drawing {
        let (width, height) = (self.depth.width, self.depth.height);
        let letters = letters(width);
        let bar = (letters * 0.9).round();
        let mut drawing = Drawing::blank(width, height + (letters * 1.4 + bar + 12.0) as u32);
        drawing.put(self.depth.clone(), [0, 0]);
        let (left, top) = (letters, height as f32 + 5.0);
        let long = (width as f32 - 2.0 * letters).max(10.0);
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
        for quarter in 0..=4_u8 {
            let share = f32::from(quarter) / 4.0;
            let x = left + share * (right - left);
            let end = if quarter == 4 { " m and more" } else { "" };
            let side = match quarter {
                0 => Side::Left,
                4 => Side::Right,
                _ => Side::Middle,
            };
            let words = TextLine::new(
                format!("{}{end}", share * DEPTH_METRES),
                [x, top + bar + 4.0],
                letters,
                INK,
            );
            if quarter % 2 == 0 || text_width("100 m and more", letters) * 3.0 < long {
                drawing.write(words.anchored(side, Level::Top));
            }
        }
        drawing
    }

    /// The picture of reward categories with the names of those in it below.
    pub(crate) fn segmentation_with_legend(&self) -> Drawing {
        let (width, height) = (self.segmentation.width, self.segmentation.height);
        let letters = letters(width);
        let line = (letters * 1.5).round();
        let wide = |name: &str| text_width(name, letters) + letters * 2.6;
        let (mut places, mut x, mut row) = (Vec::new(), 0.0, 0.0);
        for category in &self.categories {
            let name = category_name(*category);
            if x > 0.0 && x + wide(name) > width as f32 {
                (x, row) = (0.0, row + 1.0);
            }
            places.push((*category, name, [x, row]));
            x += wide(name);
        }
        let mut drawing = Drawing::blank(width, height + (line * (row + 1.0) + 8.0) as u32);
        drawing.put(self.segmentation.clone(), [0, 0]);
        for (category, name, [x, row]) in places {
            let middle = height as f32 + 4.0 + line * (row + 0.5);
            let half = letters * 0.45;
            drawing.rectangle([x + 5.0, middle - half - 1.0, 2.0 * half + 2.0, 2.0 * half + 2.0], INK);
            drawing.rectangle(
                [x + 6.0, middle - half, 2.0 * half, 2.0 * half],
                category_color(category),
            );
            let words = TextLine::new(name, [x + letters * 1.1 + 10.0, middle], letters, INK);
            drawing.write(words.anchored(Side::Left, Level::Middle));
        }
        drawing
    }
}

const INK: [u8; 3] = [38, 42, 48];

/// Metres at which pictures of distances are white.
const DEPTH_METRES: f32 = 100.0;

/// The size of a legend's letters below a picture of this width.
fn letters(width: u32) -> f32 {
    (width as f32 / 28.0).clamp(8.0, 15.0)
}

/// What a reward category is.
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

/// The camera of the agent of a world at its start, turned clockwise.
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

    /// The same with assets from a catalogue.
    pub(crate) fn with_catalogue(world: &'a World, catalogue: &Catalogue, size: u32, turn: f32) -> Self {
        Self {
            world,
            // With doors open that are.
            scene: Environment::with_catalogue(world.clone(), catalogue.clone())
                .scene()
                .clone(),
            size,
            turn,
            renderer: Rc::default(),
        }
    }

    /// The same, drawn by another renderer than the processor's.
    pub(crate) fn drawn_by(self, renderer: Renderer) -> Self {
        Self {
            renderer: Rc::new(RefCell::new(renderer)),
            ..self
        }
    }

    /// The same in another size.
    pub(crate) fn of_size(&self, size: u32) -> Self {
        Self {
            size,
            renderer: Rc::clone(&self.renderer),
            ..Self::with_catalogue(self.world, self.scene.catalogue(), size, self.turn)
        }
    }

    /// From outside, above a corner of the arena.
    pub(crate) fn overview(&self, width: u32) -> Result<Picture, Failure> {
        let scene = self.scene.clone().with_wall_tops();
        self.smooth(&scene, &self.above(&scene), width)
    }

    /// The camera of the overview: higher, and looking down at the same ground, where walls would hide a small arena.
    fn above(&self, scene: &Scene) -> Camera {
        let camera = Camera::overview(scene);
        let layout = self.world.plan().into_iter().flat_map(|plan| &plan.walls);
        let wall = layout
            .filter_map(|wall| wall.height)
            .fold(self.world.environment_params.wall_height, f64::max) as f32;
        let span = scene.arena_size().into_iter().fold(4.0, f32::max);
        let hidden = wall - span / 12.0;
        if hidden <= 0.0 {
            return camera;
        }
        let [x, y, z] = camera.position;
        let height = z + (2.0 * hidden).min(span);
        let ahead = z / -camera.pitch_deg.to_radians().tan();
        Camera {
            position: [x, y, height],
            pitch_deg: -(height / ahead).atan().to_degrees(),
            ..camera
        }
    }

    /// What the agent sees at the start.
    pub(crate) fn first_person(&self) -> Result<Seen, Failure> {
        let camera = self.agent_camera(self.turn);
        let frame = self.frame(&self.scene, &camera, self.size, self.size)?;
        let picture = |rgb| Picture {
            width: self.size,
            height: self.size,
            rgb,
        };
        Ok(Seen {
            rgb: self.smooth(&self.scene, &camera, self.size)?,
            depth: picture(
                depth_to_gray(&frame.depth)
                    .into_iter()
                    .flat_map(|gray| [gray; 3])
                    .collect(),
            ),
            segmentation: picture(
                frame
                    .category
                    .iter()
                    .flat_map(|category| category_color(*category))
                    .collect(),
            ),
            categories: {
                let mut categories = frame.category;
                categories.sort_unstable();
                categories.dedup();
                categories
            },
        })
    }

    /// What the agent sees ahead, to its right, behind and to its left.
    pub(crate) fn all_around(&self) -> Result<Vec<Picture>, Failure> {
        let look = |turn: f32| {
            let camera = Camera {
                field_of_view_deg: 90.0,
                ..self.agent_camera(self.turn + turn)
            };
            self.smooth(&self.scene, &camera, self.size)
        };
        [0.0, 90.0, 180.0, 270.0].into_iter().map(look).collect()
    }

    /// The first object of each class that is nearest to the agent, from near by, with the name of its class.
    pub(crate) fn close_ups(&self, most: usize) -> Result<Vec<(String, Picture)>, Failure> {
        let start = self.world.agent_params.coordinates;
        let far = |index: &usize| {
            let [x, y] = self.world.objects[*index].coordinates;
            (x - start[0]).hypot(y - start[1])
        };
        let mut indices: Vec<usize> = (0..self.world.objects.len()).collect();
        // What pays first, then by distance.
        indices.sort_by(|a, b| {
            let pays = |index: &usize| self.world.objects[*index].is_target();
            pays(b).cmp(&pays(a)).then(far(a).total_cmp(&far(b)))
        });
        let mut shown: Vec<(String, Picture)> = Vec::new();
        for index in indices {
            let class = self.world.objects[index].class.to_lowercase();
            if shown.len() < most && !shown.iter().any(|(other, _)| *other == class) {
                shown.push((class, self.smooth(&self.scene, &self.close_to(index), self.size)?));
            }
        }
        Ok(shown)
    }

    /// A camera that looks at an object from where the agent is, so near that the object fills the picture.
    fn close_to(&self, index: usize) -> Camera {
        let item = &self.scene.items[index];
        let start = self.world.agent_params.coordinates.map(|metres| metres as f32);
        let way = [item.position[0] - start[0], item.position[1] - start[1]];
        let heading = if way == [0.0; 2] { 0.0_f32 } else { way[0].atan2(way[1]) };
        let size = item.asset.height.max(item.asset.radius * 1.6) * item.scale;
        let back = 1.9 * size + item.asset.radius * item.scale;
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
            field_of_view_deg: 42.0,
        }
    }

    /// The map with the agent's start on it, in even light.
    pub(crate) fn top_down(&self) -> Picture {
        self.map(&Moves::none(self.world)).to_picture()
    }

    /// The map with scale, north, triggers, what pays and what costs, and ways.
    pub(crate) fn map(&self, moves: &Moves) -> Drawing {
        map_drawing::map(self.world, &self.scene, moves, self.size)
    }

    /// The same with a legend to its right.
    pub(crate) fn map_with_legend(&self, moves: &Moves) -> Drawing {
        map_drawing::map_with_legend(self.world, &self.scene, moves, self.size)
    }

    fn agent_camera(&self, turn: f32) -> Camera {
        agent_camera(self.world, turn)
    }

    /// A colour picture with smooth edges: drawn at twice the size where that is allowed.
    fn smooth(&self, scene: &Scene, camera: &Camera, width: u32) -> Result<Picture, Failure> {
        let twice = if self.size.max(width) <= 2048 { 2 } else { 1 };
        let frame = self.frame(scene, camera, width * twice, self.size * twice)?;
        let picture = Picture {
            width: frame.width,
            height: frame.height,
            rgb: frame.rgb,
        };
        Ok(if twice == 2 { picture.halved() } else { picture })
    }

    fn frame(&self, scene: &Scene, camera: &Camera, width: u32, height: u32) -> Result<Frame, Failure> {
        let mut frame = Frame::new(width, height);
        self.renderer.borrow_mut().render(scene, camera, &mut frame)?;
        Ok(frame)
    }
}

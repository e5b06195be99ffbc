//! [`Scene`]: the visible state of a world, which consists of the arena, its light, and an item for each object.

use std::sync::Arc;

use driftworld_spec::{Object, Style, Surface, World};

use crate::assets::{Asset, Block, Catalogue, ColliderShape, Mesh, lowercase};
use crate::ground;
use crate::looks::{Finish, NaturalLooks};
use crate::polygon::to_f32;
use crate::wall_tops::tops;

/// Everything on which an image of a world depends, except the camera.
#[derive(Clone, Debug)]
pub struct Scene {
    /// One item per object of the world, in its order.
    pub items: Vec<Item>,
    /// The light.
    pub light: Light,
    /// The natural style; `None` in the plain style.
    pub(crate) natural: Option<NaturalLooks>,
    /// Colour of the ground, sRGB.
    pub ground_color: [f32; 3],
    /// Panels of all walls: the arena's own, regions that cannot be entered, the world's walls, and those of its layout.
    pub walls: Vec<WallPanel>,
    arena_size: [f32; 2],
    /// Geometry: the arena's four walls, then one group per region or wall, then the zones on the ground.
    pub(crate) panels: Vec<PanelGroup>,
    /// The highest class number among its items; 0 without items.
    pub(crate) highest_class: u16,
    catalogue: Catalogue,
    /// The style of its objects.
    style: Style,
}

/// The first walls of a scene are the arena's own: west, north, east, south.
pub(crate) const ARENA_WALLS: usize = 4;

/// Maximum number of corners of walls that get tops in the agent's view, because triangulating more takes long.
const MAX_TOP_CORNERS: usize = 64;

/// Panels that are drawn together: one wall of the arena, a whole region, or a zone on the ground.
#[derive(Clone, Debug)]
pub(crate) struct PanelGroup {
    /// Centre of the bounding ball, in metres.
    pub(crate) middle: [f32; 3],
    /// Its radius.
    pub(crate) radius: f32,
    /// The panels' colour, sRGB.
    pub(crate) color: [f32; 3],
    /// Extra height at which flat panels are drawn, as a fraction of the camera's height; 0 for upright panels.
    pub(crate) lift: f32,
    /// Base edges of upright panels on the ground, each as its two ends; empty for flat panels.
    pub(crate) edges: Vec<[[f32; 2]; 2]>,
    /// Height in metres of upright panels, or of the tops of walls; 0 for panels on the ground.
    pub(crate) height: f32,
    pub(crate) blocks: Vec<Block>,
}

/// One object in the scene.
#[derive(Clone, Debug)]
pub struct Item {
    /// Its look.
    pub asset: Arc<Asset>,
    /// The asset that provides the collider; nearly always the same as `asset`.
    pub body: Arc<Asset>,
    /// Its position, in metres.
    pub position: [f32; 2],
    /// Its heading, in degrees clockwise from +y.
    pub heading_deg: f32,
    /// Factor on the asset's size.
    pub scale: f32,
    /// Its main colour, sRGB; by default the asset's own.
    pub color: Option<[f32; 3]>,
    /// Its covering in the natural style.
    pub surface: Surface,
    /// Its finish in the natural style if it has no covering.
    pub(crate) finish: Option<Finish>,
    /// Whether its class is `building`, which has its own category.
    pub building: bool,
    /// Its current reward, which decides its category.
    pub reward: f32,
    /// Its class number, the same in every world: [`Catalogue::class_number`].
    pub class_id: u16,
    /// Whether it is present.
    pub visible: bool,
}

impl Item {
    /// Shows a closed door as open: rotates it by 90 degrees around its left end, or hides it if its collider is not a box.
    pub(crate) fn open_door(&mut self) {
        let ColliderShape::Box { half: [half_width, ..] } = self.body.collider else {
            self.visible = false;
            return;
        };
        let by = half_width * self.scale;
        let heading = self.heading_deg.to_radians();
        let (sine, cosine) = (libm::sinf(heading), libm::cosf(heading));
        // Moves from the centre to the left end, and from there along the open door.
        self.position[0] -= by * (cosine + sine);
        self.position[1] -= by * (cosine - sine);
        self.heading_deg = (self.heading_deg + 90.0).rem_euclid(360.0);
    }
}

/// The light of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Towards the sun, length 1.
    pub direction: [f32; 3],
    /// Colour of the sun, sRGB.
    pub color: [f32; 3],
    /// Brightness: 1 at full daylight.
    pub exposure: f32,
    /// Share of ambient light.
    pub ambient: f32,
    /// Colour of the sky at the zenith, sRGB.
    pub sky_color: [f32; 3],
    /// Distance in metres at which fog has half its effect; `None` for no fog.
    pub fog_distance: Option<f32>,
    /// Whether depth images include the fog.
    pub fog_in_depth: bool,
}

/// An upright rectangle on the ground, visible from its right-hand side when walking from `from` to `to`.
#[derive(Clone, Copy, Debug)]
pub struct WallPanel {
    /// One end on the ground, in metres.
    pub from: [f32; 2],
    /// The other end.
    pub to: [f32; 2],
    /// Height in metres.
    pub height: f32,
    /// Colour, sRGB.
    pub color: [f32; 3],
}

impl Scene {
    /// The scene of a world at its start, with built-in assets.
    pub fn from_world(world: &World) -> Self {
        let mut scene = Self::from_world_with(world, &Catalogue::default());
        for (item, object) in scene.items.iter_mut().zip(&world.objects) {
            if object.door.as_ref().is_some_and(|door| door.open) {
                item.open_door();
            }
        }
        scene
    }

    /// The scene of a world at its start, with assets from a catalogue. All doors are drawn closed; an environment opens them.
    pub fn from_world_with(world: &World, catalogue: &Catalogue) -> Self {
        let environment = &world.environment_params;
        let mut scene = Self {
            items: Vec::with_capacity(world.objects.len()),
            light: light(world),
            natural: NaturalLooks::of(world),
            ground_color: environment.ground_color.to_f32(),
            walls: Vec::with_capacity(ARENA_WALLS),
            arena_size: environment.arena_size().map(|side| side as f32),
            panels: Vec::with_capacity(ARENA_WALLS),
            highest_class: 0,
            catalogue: catalogue.clone(),
            style: environment.looks.style,
        };
        scene.add_walls(world);
        scene.panels.extend(ground::patches(world));
        if scene.natural.is_some() {
            // The walls whose tops the agent can see.
            let eye = world.agent_params.agent_height as f32;
            let is_seen = |ring: &[WallPanel]| ring[0].height < eye && ring.len() <= MAX_TOP_CORNERS;
            scene.panels.extend(tops(&scene.walls, is_seen));
        }
        for object in &world.objects {
            scene.add(object);
        }
        scene
    }

    /// Adds an object to the scene, in its initial state.
    pub(crate) fn add(&mut self, object: &Object) {
        let class = lowercase(&object.class);
        let class_id = self.catalogue.class_number(&class);
        self.highest_class = self.highest_class.max(class_id);
        let color = object.color.map(driftworld_spec::Color::to_f32);
        let body = object.body_model.as_ref().unwrap_or(&object.model);
        let body = self.catalogue.asset(&class, body);
        let asset = match &object.text {
            Some(text) => self.catalogue.asset_with_text(&class, &object.model, text, color),
            None if self.style == Style::Plain && object.body_model.is_none() => Arc::clone(&body),
            None => self.catalogue.asset_in(self.style, &class, &object.model),
        };
        self.items.push(Item {
            finish: Finish::of(&class, &asset.collider),
            body,
            asset,
            position: object.coordinates.map(|metres| metres as f32),
            heading_deg: object.heading as f32,
            scale: object.scale as f32,
            color,
            surface: object.surface,
            building: class == "building",
            reward: object.reward as f32,
            class_id,
            visible: true,
        });
    }

    /// Adds tops to all walls, for images from above.
    #[must_use]
    pub fn with_wall_tops(mut self) -> Self {
        self.panels.extend(tops(&self.walls, |_| true));
        self
    }

    /// In the natural style, adds different ground around the arena, for images from outside.
    #[must_use]
    pub fn with_surroundings(mut self) -> Self {
        if self.natural.is_some() {
            self.panels.push(ground::around(self.arena_size, self.ground_color));
        }
        self
    }

    /// Replaces the world's light with even white daylight without fog, for readable maps.
    #[must_use]
    pub fn in_neutral_light(mut self) -> Self {
        self.light.direction = [0.0, 0.0, 1.0];
        self.light.color = [1.0; 3];
        self.light.exposure = 1.0;
        self.light.ambient = 0.35;
        self.light.fog_distance = None;
        self
    }

    /// The catalogue of its objects' assets.
    pub fn catalogue(&self) -> &Catalogue {
        &self.catalogue
    }

    /// Side lengths of the arena along x and y in metres.
    pub fn arena_size(&self) -> [f32; 2] {
        self.arena_size
    }

    fn add_walls(&mut self, world: &World) {
        let environment = &world.environment_params;
        let color = environment.bounding_wall_color.to_f32();
        let height = environment.wall_height as f32;
        let [x, y] = self.arena_size.map(|side| side / 2.0);
        // Clockwise, so that the inside is on the right.
        let corners = [[-x, -y], [-x, y], [x, y], [x, -y]];
        for (k, from) in corners.into_iter().enumerate() {
            self.add_panels(&[(from, corners[(k + 1) % 4])], height, color);
        }
        for region in environment.regions() {
            self.add_region(region, height, color);
        }
        let walls = environment.walls.iter();
        let walls = walls.map(|wall| (&wall.polygon, wall.height, wall.color));
        let layout_walls = world.plan().into_iter().flat_map(|plan| &plan.walls);
        let layout_walls = layout_walls.map(|wall| (&wall.polygon, wall.height, wall.color));
        for (polygon, own_height, own_color) in walls.chain(layout_walls) {
            let height = own_height.map_or(height, |metres| metres as f32);
            let color = own_color.map_or(color, driftworld_spec::Color::to_f32);
            self.add_region(polygon, height, color);
        }
    }

    /// Adds a region that is seen from outside, with its corners in counter-clockwise order.
    fn add_region(&mut self, corners: &[[f64; 2]], height: f32, color: [f32; 3]) {
        let mut corners = to_f32(corners);
        let next = corners.iter().cycle().skip(1);
        let twice_area: f32 = corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum();
        if twice_area < 0.0 {
            corners.reverse();
        }
        let next = corners.iter().cycle().skip(1);
        let edges: Vec<_> = corners.iter().copied().zip(next.copied()).collect();
        self.add_panels(&edges, height, color);
    }

    /// Adds panels on these edges, all with the same height and colour.
    fn add_panels(&mut self, edges: &[([f32; 2], [f32; 2])], height: f32, color: [f32; 3]) {
        let mut mesh = Mesh::default();
        mesh.corners.reserve(4 * edges.len());
        mesh.triangles.reserve(2 * edges.len());
        for &(from, to) in edges {
            self.walls.push(WallPanel {
                from,
                to,
                height,
                color,
            });
            if from != to && height > 0.0 {
                let first = mesh.corners.len() as u32;
                let [[ax, ay], [bx, by]] = [from, to];
                mesh.corners
                    .extend([[ax, ay, 0.0], [bx, by, 0.0], [bx, by, height], [ax, ay, height]]);
                mesh.triangles
                    .extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            }
        }
        let mut group = PanelGroup::of(mesh, color);
        group.edges.extend(edges.iter().map(|(from, to)| [*from, *to]));
        group.height = height;
        self.panels.push(group);
    }
}

/// The limit of the exposure as the light gets stronger, and the intensity that gives half of it. Daylight has an intensity of
/// 2.3 and an exposure of 1. Below that, brightness falls with the intensity; above it, brightness rises ever more slowly.
const MAX_EXPOSURE: f32 = 1.72;
const HALF_INTENSITY: f32 = 1.65;

fn light(world: &World) -> Light {
    let environment = &world.environment_params;
    let direction = environment.sun_direction.map(|part| part as f32);
    let length = direction.iter().map(|part| part * part).sum::<f32>().sqrt().max(1e-6);
    let intensity = environment.light_intensity as f32;
    Light {
        direction: direction.map(|part| part / length),
        color: environment.light_color.to_f32(),
        exposure: MAX_EXPOSURE * intensity / (intensity + HALF_INTENSITY),
        ambient: environment.ambient_light as f32,
        sky_color: environment.sky_color.to_f32(),
        fog_distance: environment.fog_distance.map(|metres| metres as f32),
        fog_in_depth: environment.looks.fog_in_depth,
    }
}

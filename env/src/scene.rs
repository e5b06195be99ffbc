//! What there is to see: the arena, its light, and an item for each object. How it is drawn is the renderer's.

use std::sync::Arc;

use driftworld_spec::World;

use crate::assets::{Asset, asset};

/// Everything that a picture of a world depends on, but for the camera.
#[derive(Clone, Debug)]
pub struct Scene {
    /// One for each object of the world, in its order.
    pub items: Vec<Item>,
    /// The light.
    pub light: Light,
    /// Colour of the ground, sRGB.
    pub ground_color: [f32; 3],
    /// Walls: the arena's own and regions that cannot be entered.
    pub walls: Vec<WallPanel>,
    arena_size: [f32; 2],
}

/// One object in the scene.
#[derive(Clone, Debug)]
pub struct Item {
    /// What it looks like.
    pub asset: Arc<Asset>,
    /// Where it stands, in metres.
    pub position: [f32; 2],
    /// Where it faces, in degrees clockwise from +y.
    pub heading_deg: f32,
    /// Factor on the asset's size.
    pub scale: f32,
    /// Its main colour, sRGB; the asset's own if absent.
    pub color: Option<[f32; 3]>,
    /// Whether its class is `building`, which has a category of its own.
    pub building: bool,
    /// What it is worth now: decides its category.
    pub reward: f32,
    /// Number of its class in the scene, from 1, in order of first appearance.
    pub class_id: u16,
    /// Whether it is there at all.
    pub visible: bool,
}

/// The light of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Light {
    /// Towards the sun, length 1.
    pub direction: [f32; 3],
    /// Colour of the sun, sRGB.
    pub color: [f32; 3],
    /// How bright all is: 1 at full daylight.
    pub exposure: f32,
    /// Share of the light that comes from everywhere.
    pub ambient: f32,
    /// Colour of the sky at the zenith, sRGB.
    pub sky_color: [f32; 3],
}

/// An upright rectangle on the ground, seen from its right-hand side when walking from `from` to `to`.
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
    /// The scene of a world at its start.
    pub fn from_world(world: &World) -> Self {
        let environment = &world.environment_params;
        let mut scene = Self {
            items: Vec::with_capacity(world.objects.len()),
            light: light(world),
            ground_color: environment.ground_color.to_f32(),
            walls: Vec::new(),
            arena_size: environment.arena_size().map(|side| side as f32),
        };
        scene.add_walls(world);
        let mut classes: Vec<String> = Vec::new();
        for object in &world.objects {
            let class = object.class.to_lowercase();
            let known = classes.iter().position(|other| *other == class);
            let class_id = known.unwrap_or_else(|| {
                classes.push(class.clone());
                classes.len() - 1
            });
            scene.items.push(Item {
                asset: asset(&class, &object.model),
                position: object.coordinates.map(|metres| metres as f32),
                heading_deg: object.heading as f32,
                scale: object.scale as f32,
                color: object.color.map(driftworld_spec::Color::to_f32),
                building: class == "building",
                reward: object.reward as f32,
                class_id: u16::try_from(class_id + 1).unwrap_or(u16::MAX),
                visible: true,
            });
        }
        scene
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
        self.add_polygon(&[[-x, -y], [-x, y], [x, y], [x, -y]], height, color);
        for region in environment.regions() {
            self.add_region(region, height, color);
        }
        for wall in &environment.walls {
            let height = wall.height.map_or(height, |metres| metres as f32);
            self.add_region(
                &wall.polygon,
                height,
                wall.color.map_or(color, driftworld_spec::Color::to_f32),
            );
        }
    }

    /// A region is seen from outside: its corners are put counter-clockwise.
    fn add_region(&mut self, corners: &[[f64; 2]], height: f32, color: [f32; 3]) {
        let mut corners: Vec<[f32; 2]> = corners
            .iter()
            .map(|corner| corner.map(|metres| metres as f32))
            .collect();
        let next = corners.iter().cycle().skip(1);
        let twice_area: f32 = corners.iter().zip(next).map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum();
        if twice_area < 0.0 {
            corners.reverse();
        }
        self.add_polygon(&corners, height, color);
    }

    fn add_polygon(&mut self, corners: &[[f32; 2]], height: f32, color: [f32; 3]) {
        let next = corners.iter().cycle().skip(1);
        self.walls
            .extend(corners.iter().zip(next).map(|(&from, &to)| WallPanel {
                from,
                to,
                height,
                color,
            }));
    }
}

fn light(world: &World) -> Light {
    let environment = &world.environment_params;
    let direction = environment.sun_direction.map(|part| part as f32);
    let length = direction.iter().map(|part| part * part).sum::<f32>().sqrt().max(1e-6);
    let intensity = environment.light_intensity as f32;
    Light {
        direction: direction.map(|part| part / length),
        color: environment.light_color.to_f32(),
        // 2.3 is day; below, brightness falls with the intensity; above, it rises ever more slowly.
        exposure: 1.72 * intensity / (intensity + 1.65),
        ambient: environment.ambient_light as f32,
        sky_color: environment.sky_color.to_f32(),
    }
}

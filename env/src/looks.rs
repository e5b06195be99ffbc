//! [`NaturalLooks`]: the natural style of one scene, with all defaults resolved.

use driftworld_spec::{Covering, Style, World};

use crate::assets::ColliderShape;

/// The natural style of one scene, with all defaults resolved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NaturalLooks {
    /// Covering of the ground.
    pub(crate) ground: Covering,
    /// Covering of walls.
    pub(crate) walls: Covering,
    pub(crate) ceiling: Option<Ceiling>,
    /// Whether shadows fall on the ground.
    pub(crate) has_shadows: bool,
    pub(crate) has_clouds: bool,
}

/// Surface finish of objects without a covering, by class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Finish {
    /// A wooden door: a frame around panels.
    Door,
    /// A wooden crate: boards with edges.
    Crate,
    /// Brushed metal.
    Metal,
}

impl Finish {
    /// The finish of a class, for a collider of this shape.
    pub(crate) fn of(class: &str, body: &ColliderShape) -> Option<Self> {
        match (class, body) {
            ("door", _) => Some(Self::Door),
            ("key" | "switch", _) => Some(Self::Metal),
            ("cube" | "geometric", ColliderShape::Box { .. }) => Some(Self::Crate),
            _ => None,
        }
    }
}

/// A ceiling over the whole arena.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ceiling {
    /// Height above the ground in metres.
    pub(crate) height: f32,
    /// Its colour, sRGB.
    pub(crate) color: [f32; 3],
    /// Whether every wall reaches it.
    pub(crate) meets_walls: bool,
}

impl NaturalLooks {
    /// The looks of a world; `None` in the plain style.
    pub(crate) fn of(world: &World) -> Option<Self> {
        let environment = &world.environment_params;
        let looks = &environment.looks;
        if looks.style == Style::Plain {
            return None;
        }
        let has_ceiling = looks.has_ceiling(environment.layout.as_ref());
        let layout_walls = world.plan().into_iter().flat_map(|plan| &plan.walls);
        let heights = layout_walls.map(|wall| wall.height.unwrap_or(environment.wall_height));
        let height = heights.clone().fold(0.0, f64::max);
        let height = if height > 0.0 { height } else { environment.wall_height };
        Some(Self {
            ground: looks.ground(has_ceiling),
            walls: looks.walls(),
            ceiling: (has_ceiling && height > 0.0).then(|| Ceiling {
                height: height as f32,
                color: looks.ceiling_color.to_f32(),
                meets_walls: {
                    let others = environment.walls.iter().filter_map(|wall| wall.height);
                    let mut heights = heights.chain(others).chain([environment.wall_height]);
                    heights.all(|wall| wall >= height)
                },
            }),
            has_shadows: looks.has_shadows(),
            has_clouds: looks.has_clouds(),
        })
    }
}

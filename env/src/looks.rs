//! [`NaturalLooks`]: what the natural style comes to in one scene. How it is drawn is in `render/`; the plain style has none.

use driftworld_spec::{Covering, Style, World};

/// The natural style, every part decided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NaturalLooks {
    /// What covers the ground.
    pub(crate) ground: Covering,
    /// What covers walls.
    pub(crate) walls: Covering,
    pub(crate) ceiling: Option<Ceiling>,
    /// Whether shadows fall on the ground.
    pub(crate) has_shadows: bool,
    pub(crate) has_clouds: bool,
}

/// A ceiling over the whole arena.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ceiling {
    /// Metres above the ground.
    pub(crate) height: f32,
    /// Its colour, sRGB.
    pub(crate) color: [f32; 3],
}

impl NaturalLooks {
    /// The looks of a world; `None` if they are plain.
    pub(crate) fn of(world: &World) -> Option<Self> {
        let environment = &world.environment_params;
        let looks = &environment.looks;
        if looks.style == Style::Plain {
            return None;
        }
        let has_ceiling = looks.has_ceiling(environment.layout.as_ref());
        let planned = world.plan().into_iter().flat_map(|plan| &plan.walls);
        let heights = planned.map(|wall| wall.height.unwrap_or(environment.wall_height));
        let height = heights.fold(0.0, f64::max);
        let height = if height > 0.0 { height } else { environment.wall_height };
        Some(Self {
            ground: looks.ground(has_ceiling),
            walls: looks.walls(),
            ceiling: (has_ceiling && height > 0.0).then(|| Ceiling {
                height: height as f32,
                color: looks.ceiling_color.to_f32(),
            }),
            has_shadows: looks.has_shadows(),
            has_clouds: looks.has_clouds(),
        })
    }
}

//! Checks whether a body fits between walls and solid objects.

use driftworld_spec::World;

use super::obstacle::Obstacle;
use super::sim_ref::SimRef;
use crate::polygon::is_near_or_inside;

/// The obstacle to a round body with this radius in metres: the arena's boundary or a wall.
pub(super) fn obstacle(world: &World, position: [f64; 2], radius: f64) -> Option<Obstacle> {
    let environment = &world.environment_params;
    if !position.iter().all(|metres| metres.is_finite()) || !environment.contains(position) {
        return Some(Obstacle::Outside);
    }
    let arena = environment.arena_size();
    let beyond = (0..2).any(|axis| position[axis].abs() > arena[axis] / 2.0 - radius);
    let inside = |corners: &[[f64; 2]]| is_near_or_inside(corners.iter().copied(), position, radius);
    (beyond || world.obstacles().any(inside)).then_some(Obstacle::Wall)
}

/// The obstacle to the agent's body at a position: the arena's boundary, a wall, or a solid object.
pub(super) fn agent_obstacle(sim: SimRef, position: [f64; 2]) -> Option<Obstacle> {
    let radius = sim.world.agent_params.agent_width / 2.0;
    obstacle(sim.world, position, radius).or_else(|| {
        let mut blocked = Vec::new();
        let at = position.map(|metres| metres as f32);
        sim.views.bodies.blocking(at, &mut blocked);
        blocked.first().map(|index| Obstacle::Object { index: *index as usize })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::{Wall, WorldDraft};

    fn check(position: [f64; 2], expected: Option<Obstacle>) {
        let mut world = WorldDraft::default();
        world.environment_params.map_size = [20.0, 20.0];
        let polygon = vec![[2.0, 2.0], [6.0, 2.0], [6.0, 6.0], [4.0, 4.0], [2.0, 6.0]];
        world.environment_params.walls = vec![Wall {
            polygon,
            height: None,
            color: None,
        }];
        let world = world.check().expect("the world is valid");
        assert_eq!(obstacle(&world, position, 0.5), expected, "{position:?}");
    }

    #[test]
    fn body_fits_if_no_wall_is_within_its_radius() {
        check([0.0, 0.0], None);
        check([9.6, 0.0], Some(Obstacle::Wall));
        check([10.1, 0.0], Some(Obstacle::Outside));
        check([f64::NAN, 0.0], Some(Obstacle::Outside));
        check([3.0, 3.0], Some(Obstacle::Wall));
        check([1.6, 3.0], Some(Obstacle::Wall));
        check([1.4, 3.0], None);
        // The notch at the top is free ground where it is wide enough.
        check([4.0, 5.8], None);
        check([4.0, 4.2], Some(Obstacle::Wall));
    }
}

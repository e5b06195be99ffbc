//! The map in letters: walls `#`, objects by the first letter of their class, the agent an arrow. The map in colours is
//! drawn by `env`.

use crate::env::Environment;

/// The world from above, north on top: capital letters are objects that pay.
pub(super) fn letters(environment: &Environment, columns: u32) -> String {
    let scene = environment.scene();
    let [width, depth] = scene.arena_size();
    let span = [width.max(1.0), depth.max(1.0)];
    let columns = columns as usize;
    let lines = ((columns as f32 * span[1] / span[0] / 2.0).round() as usize).clamp(1, 400);
    let mut grid = vec![vec![' '; columns]; lines];
    let cell = |[x, y]: [f32; 2]| {
        let column = (x / span[0] + 0.5) * columns as f32;
        let line = (0.5 - y / span[1]) * lines as f32;
        // What stands on the edge, or outside, is put into the nearest cell.
        let at = |value: f32, count: usize| (value.max(0.0) as usize).min(count - 1);
        (at(line, lines), at(column, columns))
    };
    for wall in scene.walls.iter().filter(|wall| wall.height > 0.0) {
        let along = [wall.to[0] - wall.from[0], wall.to[1] - wall.from[1]];
        let cells = (along[0].abs() / span[0]).max(along[1].abs() / span[1]) * columns.max(lines) as f32;
        let steps = (2.0 * cells).ceil().clamp(1.0, 2000.0);
        for k in 0..=steps as u32 {
            let share = k as f32 / steps;
            let (line, column) = cell([wall.from[0] + along[0] * share, wall.from[1] + along[1] * share]);
            grid[line][column] = '#';
        }
    }
    let world = environment.world();
    for ((object, state), item) in world.objects.iter().zip(environment.objects()).zip(&scene.items) {
        if state.present {
            let first = object
                .class
                .chars()
                .next()
                .filter(char::is_ascii_graphic)
                .unwrap_or('?');
            let pays = object.is_target() && state.reward > 0.0;
            let (line, column) = cell(item.position);
            grid[line][column] = if pays {
                first.to_ascii_uppercase()
            } else {
                first.to_ascii_lowercase()
            };
        }
    }
    let agent = environment.agent();
    let (line, column) = cell(agent.position);
    let quarter = ((agent.heading_deg + 45.0) / 90.0) as usize % 4;
    grid[line][column] = ['^', '>', 'v', '<'][quarter];
    let rows = grid
        .into_iter()
        .map(|row| row.into_iter().collect::<String>().trim_end().to_owned() + "\n");
    rows.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{Object, Stimulus, WorldDraft};

    #[test]
    fn what_pays_is_a_capital_and_the_agent_looks_its_way() {
        let mut coin = Object::new("barrel", [2.8, 2.8]);
        coin.reward = 1.0;
        coin.reward_stimulus = vec![Stimulus::AgentCollide];
        let mut world = WorldDraft {
            objects: vec![
                coin,
                Object::new("tree", [-2.8, -2.8]),
                Object::new("rock", [300.0, 0.0]),
            ],
            ..WorldDraft::default()
        };
        world.environment_params.map_size = [10.0, 10.0];
        world.agent_params.heading = 90.0;
        let environment = Environment::new(world.check().expect("the world is sound"));
        let expected = [
            "####################",
            "#                  #",
            "#              B   #",
            "#                  #",
            "#                  #",
            "#         >        r",
            "#                  #",
            "#   t              #",
            "#                  #",
            "####################\n",
        ];
        assert_eq!(letters(&environment, 20), expected.join("\n"));
    }
}

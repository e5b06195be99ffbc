//! Draws the map as text: walls are `#`, a zone is a sign for its effect, an object the first letter of its class, and the agent
//! an arrow.

use crate::env::Environment;
use crate::spec::Zone;

/// The sign of an open door; a closed door has a letter like other objects.
const OPEN_DOOR: (char, &str) = ('\'', "an open door");

/// The sign of a zone on the map, with its meaning.
fn sign(zone: &Zone) -> (char, &'static str) {
    if zone.is_costly() {
        ('!', "costs or fails")
    } else if zone.is_wanted() {
        ('+', "pays or succeeds")
    } else if zone.teleport.is_some() {
        ('%', "a teleport")
    } else if zone.speed_factor < 1.0 {
        ('~', "slows")
    } else if zone.speed_factor > 1.0 {
        ('=', "speeds up")
    } else {
        (':', "a zone")
    }
}

/// The world from above, north at the top, with capital letters for rewarding objects. Below it, a legend of the zones and open
/// doors on the map, if any.
pub(super) fn ascii_map(environment: &Environment, columns: u32) -> String {
    let scene = environment.scene();
    let [width, depth] = scene.arena_size();
    let span = [width.max(1.0), depth.max(1.0)];
    let columns = columns as usize;
    let lines = ((columns as f32 * span[1] / span[0] / 2.0).round() as usize).clamp(1, 400);
    let mut grid = vec![vec![' '; columns]; lines];
    let cell = |[x, y]: [f32; 2]| {
        let column = (x / span[0] + 0.5) * columns as f32;
        let line = (0.5 - y / span[1]) * lines as f32;
        // Objects on or beyond the edge are drawn in the nearest cell.
        let clamped = |value: f32, count: usize| (value.max(0.0) as usize).min(count - 1);
        (clamped(line, lines), clamped(column, columns))
    };
    let middle = |line: usize, column: usize| {
        let share = |at: usize, count: usize| (at as f64 + 0.5) / count as f64 - 0.5;
        [
            share(column, columns) * f64::from(span[0]),
            -share(line, lines) * f64::from(span[1]),
        ]
    };
    // Fill the cells whose centre lies in an area, testing only within its bounds.
    let mut fill = |area: &Zone, symbol: char| {
        let Some([low, high]) = area.bounds() else { return };
        let [low, high] = [low, high].map(|corner| cell(corner.map(|metres| metres as f32)));
        for (line, row) in grid.iter_mut().enumerate().take(low.0 + 1).skip(high.0) {
            for (column, sign) in row.iter_mut().enumerate().take(high.1 + 1).skip(low.1) {
                if area.contains(middle(line, column)) {
                    *sign = symbol;
                }
            }
        }
    };
    let mut signs = Vec::new();
    for zone in &environment.world().environment_params.zones {
        fill(zone, sign(zone).0);
        signs.push(sign(zone));
    }
    let sides = [span[0] / columns as f32, span[1] / lines as f32].map(f64::from);
    let mut edges: Vec<[[f32; 2]; 2]> = Vec::new();
    if scene.walls.iter().any(|wall| wall.height > 0.0) {
        edges.extend(scene.walls.iter().take(4).map(|wall| [wall.from, wall.to]));
        for wall in environment.world().obstacles() {
            let area = Zone::polygon(wall.to_vec());
            fill(&area, '#');
            let is_thin = |[low, high]: [[f64; 2]; 2]| (0..2).any(|axis| high[axis] - low[axis] < 1.5 * sides[axis]);
            if area.bounds().is_some_and(is_thin) {
                let next = wall.iter().cycle().skip(1);
                let ends = wall.iter().zip(next);
                edges.extend(ends.map(|(from, to)| [*from, *to].map(|corner| corner.map(|metres| metres as f32))));
            }
        }
    }
    for [from, to] in edges {
        let along = [to[0] - from[0], to[1] - from[1]];
        let cells = (along[0].abs() / span[0]).max(along[1].abs() / span[1]) * columns.max(lines) as f32;
        let steps = (2.0 * cells).ceil().clamp(1.0, 2000.0);
        for k in 0..=steps as u32 {
            let share = k as f32 / steps;
            let (line, column) = cell([from[0] + along[0] * share, from[1] + along[1] * share]);
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
            // Draw an open door at its doorway, not at its leaf.
            let (line, column) = cell(if state.open { state.position } else { item.position });
            grid[line][column] = if state.open {
                signs.push(OPEN_DOOR);
                OPEN_DOOR.0
            } else if pays {
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
    let mut map: String = rows.collect();
    signs.sort_unstable();
    signs.dedup();
    if !signs.is_empty() {
        let listed: Vec<String> = signs
            .iter()
            .map(|(symbol, meaning)| format!("{symbol} {meaning}"))
            .collect();
        map += &listed.join(", ");
        map.push('\n');
    }
    map
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spec::{Door, Layout, Object, Stimulus, WorldDraft, ZoneEnd};

    #[test]
    fn paying_objects_are_capitals_and_the_agent_shows_its_heading() {
        let mut coin = Object::new("barrel", [2.8, 2.8]);
        coin.reward = 1.0;
        coin.reward_stimulus = vec![Stimulus::AgentCollide];
        let mut world = WorldDraft::with_objects(vec![
            coin,
            Object::new("tree", [-2.8, -2.8]),
            Object::new("rock", [300.0, 0.0]),
        ]);
        world.environment_params.map_size = [10.0, 10.0];
        world.agent_params.heading = 90.0;
        let environment = Environment::new(world.check().expect("the world is valid"));
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
        assert_eq!(ascii_map(&environment, 20), expected.join("\n"));
    }

    #[test]
    fn walls_are_filled_and_zones_and_open_doors_have_signs() {
        let mut lava = Zone::polygon(vec![[-4.0, -1.0], [4.0, -1.0], [4.0, 1.0], [-4.0, 1.0]]);
        lava.ends = Some(ZoneEnd::Failure);
        let mut mud = Zone::disc([-3.0, -4.0], 1.2);
        mud.speed_factor = 0.5;
        let gate = |east: f64, open: bool| {
            let mut gate = Object::new("door", [east, 2.0]);
            gate.scale = 2.0;
            gate.door = Some(Door {
                open,
                ..Door::default()
            });
            gate
        };
        let mut world = WorldDraft::with_objects(vec![gate(-2.0, false), gate(2.0, true)]);
        world.environment_params.layout = Some(Layout {
            text: Some(
                [
                    "#######", "#.....#", "##D#D##", "#.....#", "#.....#", "#A....#", "#######",
                ]
                .map(str::to_owned)
                .to_vec(),
            ),
            ..Layout::default()
        });
        world.environment_params.zones = vec![lava, mud];
        world.agent_params.coordinates = [4.5, -4.5];
        let environment = Environment::new(world.check().expect("the world is valid"));
        let expected = [
            "############################",
            "############################",
            "####                    ####",
            "####                    ####",
            "########    ####    ########",
            "########  d ####  ' ########",
            "####  !!!!!!!!!!!!!!!!  ####",
            "####  !!!!!!!!!!!!!!!!  ####",
            "####                    ####",
            "####                    ####",
            "####  ~~~~              ####",
            "####  ~~~~             ^####",
            "############################",
            "############################",
            "! costs or fails, ' an open door, ~ slows\n",
        ];
        assert_eq!(ascii_map(&environment, 28), expected.join("\n"));
    }
}

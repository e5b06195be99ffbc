//! MiniGrid's grids as text: two characters for each cell, what is there and its colour, as `env.unwrapped.pprint_grid()`
//! gives them.

use super::{FLOOR, Reader, pays, thing};
use crate::layout::Legend;
use crate::warning::Warning;
use crate::world::{Door, Object, Portable, Stimulus};
use crate::{SpecError, World};

/// What stands for a cell of lava: floor, under a zone.
const LAVA: char = 'V';

/// Side of a cell in metres.
const CELL: f64 = 2.0;

impl World {
    /// Reads a grid of MiniGrid as `env.unwrapped.pprint_grid()` gives it; `name` is what warnings call it.
    ///
    /// Each cell has two characters. `W` is a wall, `F` and two spaces are floor, `G` a goal of 1 point that ends the episode,
    /// `V` lava, a zone that ends it as a failure, `K` a key, `A` a ball, `B` a box. The agent carries one of these at a time. The
    /// second character is the colour. `D` is a closed door, `L` one that a key of its colour unlocks, `__` an open one.
    /// `>>`, `VV`, `<<` and `^^` is the agent. Cells are 2 m wide.
    /// What is not known is floor; a warning says what was left out, changed or chosen. A line with the environment's name is
    /// skipped.
    ///
    /// # Errors
    /// [`SpecError::Document`] for a text that makes no world: without a free cell, too large, or more of it unknown than known.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::World;
    /// let grid = "WGWGWGWG\nWG>>  WG\nWG  GGWG\nWGWGWGWG\n";
    /// let (world, warnings) = World::from_minigrid_text("grid.txt", grid)?;
    /// assert_eq!((world.agent_params.coordinates, world.agent_params.heading), ([-1.0, 1.0], 90.0));
    /// assert_eq!((world.objects[0].coordinates, warnings.len()), ([1.0, -1.0], 0));
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn from_minigrid_text(name: &str, text: &str) -> Result<(Self, Vec<Warning>), SpecError> {
        let mut reader = Reader::new(name, CELL);
        // What an environment is called may stand above its grid, which has no small letters.
        let is_name = |line: &str| {
            let has_small = line.chars().any(char::is_lowercase);
            line.starts_with('<') && line.ends_with('>') && has_small
        };
        let lines = text.lines().enumerate();
        for (number, line) in lines.filter(|(_, line)| !line.is_empty() && !is_name(line.trim())) {
            let characters: Vec<char> = line.chars().collect();
            let row = reader.rows.len();
            let mut letters = Vec::with_capacity(characters.len() / 2);
            for (column, pair) in characters.chunks(2).enumerate() {
                // Spaces at the end of a line get lost.
                let pair = [pair[0], pair.get(1).copied().unwrap_or(' ')];
                letters.push(reader.pair(pair, [column, row], [number + 1, 2 * column + 1]));
            }
            reader.rows.push(letters);
        }
        reader.expect_map(
            "a grid of MiniGrid: two signs for each cell, such as WG for a wall, >> for the agent, GG for a goal, as env.unwrapped.pprint_grid() \
             gives it",
        )?;
        reader.world()
    }
}

/// The colour that a letter stands for; `G` is green but for walls, which are all grey.
fn color(letter: char) -> Option<&'static str> {
    Some(match letter {
        'R' => "red",
        'G' => "green",
        'B' => "blue",
        'P' => "purple",
        'Y' => "yellow",
        _ => return None,
    })
}

/// The same, which an interaction picks up.
fn carried(object: Object) -> Object {
    Object {
        portable: Some(Portable::default()),
        ..object
    }
}

impl Reader<'_> {
    /// The letter of the layout for a pair of characters, with what stands there.
    fn pair(&mut self, pair: [char; 2], at: [usize; 2], place: [usize; 2]) -> char {
        let heading = match pair {
            ['>', '>'] => Some(90.0),
            ['V', 'V'] => Some(180.0),
            ['<', '<'] => Some(270.0),
            ['^', '^'] => Some(0.0),
            _ => None,
        };
        if let Some(heading) = heading {
            self.starts.push((at, heading));
            return 'A';
        }
        let ([' ', ' '] | ['_', '_'] | ['W' | 'F', _]) = pair else {
            return self.colored(pair, at, place);
        };
        match pair[0] {
            'W' => '#',
            '_' => self.toggled(
                Door {
                    open: true,
                    ..Door::default()
                },
                None,
                at,
            ),
            _ => FLOOR,
        }
    }

    /// A door that is opened and closed in turn.
    fn toggled(&mut self, door: Door, color: Option<&str>, at: [usize; 2]) -> char {
        let closes_on = vec![Stimulus::AgentInteract];
        self.put_door('D', Door { closes_on, ..door }, color, at);
        'D'
    }

    /// What has a colour that matters.
    fn colored(&mut self, [what, letter]: [char; 2], at: [usize; 2], place: [usize; 2]) -> char {
        let Some(color) = color(letter) else {
            self.do_not_know(format!("\"{what}{letter}\""), place);
            return FLOOR;
        };
        let object = match what {
            'V' => {
                self.lava.push(at);
                self.legend.insert(LAVA.to_string(), Legend::Floor);
                return LAVA;
            }
            'D' => return self.toggled(Door::default(), Some(color), at),
            'L' => {
                let key = Some(format!("{color}_key"));
                return self.toggled(Door { key, ..Door::default() }, Some(color), at);
            }
            'G' => pays(thing("geometric", color, "goal"), 1.0),
            'K' => carried(thing("key", color, &format!("{color}_key"))),
            'A' => carried(thing("icosphere", color, "ball")),
            'B' => carried(thing("cube", color, "box")),
            _ => {
                self.do_not_know(format!("\"{what}{letter}\""), place);
                return FLOOR;
            }
        };
        let own = match what {
            // `A` is the agent in a layout.
            'A' => 'O',
            other => other,
        };
        self.put(own, object, at)
    }
}

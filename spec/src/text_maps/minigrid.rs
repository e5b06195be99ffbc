//! MiniGrid's grids as text: two characters for each cell, what is there and its colour, as `str(env)` prints them.

use super::{FLOOR, Reader, pays, thing};
use crate::layout::Legend;
use crate::warning::Warning;
use crate::{SpecError, World};

/// Side of a cell in metres.
const CELL: f64 = 2.0;

impl World {
    /// Reads a grid of MiniGrid as `str(env)` prints it; `name` is what warnings call it.
    ///
    /// Each cell has two characters. `W` is a wall, `F` and two spaces are floor, `G` a goal of 1 point that ends the episode,
    /// `V` lava, which ends it as a failure, `K` a key, `A` a ball, `B` a box; the second character is the colour. `D`, `L` and
    /// `__` are doors, which are doorways without doors here. `>>`, `VV`, `<<` and `^^` is the agent. Cells are 2 m wide.
    /// What is not known is floor; a warning says what was left out, changed or chosen.
    ///
    /// # Errors
    /// [`SpecError::Document`] for a text that makes no world: without a free cell, or too large.
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
        for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.is_empty()) {
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
            '_' => self.doorway(place, "an open door"),
            _ => FLOOR,
        }
    }

    fn doorway(&mut self, place: [usize; 2], what: &str) -> char {
        self.legend.insert("D".to_owned(), Legend::Doorway);
        self.warn(place, format!("{what} is a doorway without a door"));
        'D'
    }

    /// What has a colour that matters.
    fn colored(&mut self, [what, letter]: [char; 2], at: [usize; 2], place: [usize; 2]) -> char {
        let Some(color) = color(letter) else {
            self.warn(place, format!("\"{what}{letter}\" is not known; it is read as floor"));
            return FLOOR;
        };
        let object = match what {
            'D' => return self.doorway(place, &format!("a closed {color} door")),
            'L' => return self.doorway(place, &format!("a locked {color} door")),
            'G' => pays(thing("geometric", color, "goal"), 1.0),
            'V' => thing("cube", "orangered", "lava"),
            'K' => thing("geometric", color, "key"),
            'A' => thing("icosphere", color, "ball"),
            'B' => thing("cube", color, "box"),
            _ => {
                self.warn(place, format!("\"{what}{letter}\" is not known; it is read as floor"));
                return FLOOR;
            }
        };
        let own = match what {
            // `A` is the agent in a layout.
            'A' => 'O',
            other => other,
        };
        self.put(own, object, at);
        own
    }
}

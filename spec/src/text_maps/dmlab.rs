//! DeepMind Lab's text levels: an entity layer of letters, and behind an empty line, if there is one, a variations layer, which
//! says how rooms look.

use super::{FLOOR, Reader, pays, thing};
use crate::warning::Warning;
use crate::world::{Door, Stimulus};
use crate::{SpecError, World};

/// Side of a cell in metres: 100 of the original's units, of which 32 are a metre.
const CELL: f64 = 3.125;

impl World {
    /// Reads the entity layer of a text level of DeepMind Lab; `name` is what warnings call it.
    ///
    /// `*` is a wall, `P` where an agent may start, `G` a goal of 10 points that ends the episode, `A` an apple of 1 point,
    /// `I` and `H` doors, which open when the agent comes to them. Cells are 3.125 m wide, as they are there. A letter that is
    /// not known is floor. Behind an empty line a variations layer may follow, as many lines of capital letters, points and spaces,
    /// which is left out. A warning says what was left out, changed or chosen.
    ///
    /// # Errors
    /// [`SpecError::Document`] for a text that makes no world: without a free cell, too large, or more of it unknown than known.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::World;
    /// let (world, warnings) = World::from_dmlab_text("level.txt", "*****\n*P G*\n*****\n")?;
    /// assert_eq!((world.objects.len(), warnings.len()), (1, 0));
    /// assert_eq!(world.agent_params.coordinates, [-3.125, 0.0]);
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn from_dmlab_text(name: &str, text: &str) -> Result<(Self, Vec<Warning>), SpecError> {
        let mut reader = Reader::new(name, CELL);
        let lines: Vec<&str> = text.lines().collect();
        let variations = variations(&lines);
        if let Some(first) = variations {
            reader.warn(
                [first + 1, 1],
                "the variations layer is left out: it says how rooms look",
            );
        }
        for (number, line) in lines.iter().enumerate().take(variations.unwrap_or(lines.len())) {
            if line.is_empty() {
                continue;
            }
            let row = reader.rows.len();
            let mut letters = Vec::with_capacity(line.len());
            for (column, letter) in line.chars().enumerate() {
                let known = reader.entity(letter, [column, row], [number + 1, column + 1]);
                letters.push(if known { letter } else { FLOOR });
            }
            reader.rows.push(letters);
        }
        reader.expect_map(
            "the entity layer of a level of DeepMind Lab: a letter for each cell, such as * for a wall, P for the start, G for a goal",
        )?;
        reader.world()
    }
}

/// The number of the line in which a variations layer begins: behind an empty line, as many lines as before it without walls.
fn variations(lines: &[&str]) -> Option<usize> {
    let is_text = |line: &&str| !line.is_empty();
    let first = lines.iter().position(is_text)?;
    let empty = first + lines[first..].iter().position(|line| line.is_empty())?;
    let second = empty + lines[empty..].iter().position(is_text)?;
    let rest: Vec<&&str> = lines[second..].iter().filter(|line| is_text(line)).collect();
    let is_variation = |line: &&&str| {
        line.chars()
            .all(|letter| letter.is_ascii_uppercase() || ". ".contains(letter))
    };
    (rest.len() == empty - first && rest.iter().all(is_variation)).then_some(second)
}

impl Reader<'_> {
    /// What a letter of the entity layer stands for; `false` for one that is not known.
    fn entity(&mut self, letter: char, at: [usize; 2], place: [usize; 2]) -> bool {
        match letter {
            '*' | ' ' => {}
            'P' => self.starts.push((at, 0.0)),
            'G' => {
                self.put(letter, pays(thing("geometric", "gold", "goal"), 10.0), at);
            }
            'A' => {
                let mut apple = pays(thing("icosphere", "limegreen", "apple"), 1.0);
                apple.scale = 0.5;
                self.put(letter, apple, at);
            }
            'I' | 'H' => {
                let opens_on = vec![Stimulus::AgentCollide];
                self.put_door(
                    letter,
                    Door {
                        opens_on,
                        ..Door::default()
                    },
                    None,
                    at,
                );
            }
            _ => {
                self.do_not_know(format!("the letter {letter:?}"), place);
                return false;
            }
        }
        true
    }
}

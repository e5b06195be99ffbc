//! Checks a layout beyond its schema, and reports oddities.

use super::kind::Kind;
use super::walls::present;
use super::{Layout, LayoutWall, MAX_CELLS, MAX_LAYOUT_SIDE, Plan};
use crate::error::Problem;

/// Pointer to a world's layout.
pub(crate) const POINTER: &str = "/environment_params/layout";

impl Layout {
    /// All problems, with pointers that start at the world. A layout without problems can be planned.
    pub(crate) fn problems(&self) -> Vec<Problem> {
        let kinds = self.kinds();
        let [kind] = kinds.as_slice() else {
            let found = if kinds.is_empty() {
                "none of them".to_owned()
            } else {
                format!("{} at once", kinds.join(" and "))
            };
            let expected = "exactly one of maze, rooms, text, predefined, walls";
            return vec![Problem::new("spec/layout-kind", POINTER, found, expected)];
        };
        let mut problems = Vec::new();
        let keys = [
            ("size", "predefined", self.size.is_some()),
            ("cell", "text", self.cell.is_some()),
            ("height", "text", self.height.is_some()),
            ("legend", "text", !self.legend.is_empty()),
        ];
        for (key, ..) in keys.into_iter().filter(|(_, owner, is_here)| *is_here && owner != kind) {
            let expected = "no such key with ".to_owned() + kind;
            let problem = Problem::new(
                "spec/layout-kind",
                format!("{POINTER}/{key}"),
                format!("{key:?}"),
                expected,
            );
            problems.push(problem.advise(match *kind {
                "maze" | "rooms" if key != "legend" => format!("write it into {kind:?}"),
                "walls" if key == "height" => "write it into each wall".to_owned(),
                _ => "remove it".to_owned(),
            }));
        }
        match self.kind() {
            Some(Kind::Maze(maze)) => {
                let cells = maze.cells.map(|count| count as usize);
                problems.extend(too_many("maze/cells", cells));
                if maze.wall >= maze.cell {
                    let found = format!("walls of {} m between cells of {} m", maze.wall, maze.cell);
                    problems.push(problem(
                        "spec/no-corridor",
                        "maze/wall",
                        found,
                        "less than the side of a cell",
                    ));
                }
                problems.extend(self.too_large("maze/cells"));
            }
            Some(Kind::Rooms(rooms)) => {
                problems.extend(too_many("rooms/grid", rooms.lattice()));
                let shorter = rooms.room[0].min(rooms.room[1]);
                // A doorway and wall that fill the side exactly may exceed it by rounding.
                if rooms.doorway + rooms.wall > shorter * (1.0 + 1e-12) {
                    let found = format!(
                        "doorways of {} m and walls of {} m in rooms of {shorter} m",
                        rooms.doorway, rooms.wall
                    );
                    let expected = "a sum of at most the side of a room";
                    problems.push(problem("spec/no-corridor", "rooms/doorway", found, expected));
                }
                problems.extend(self.too_large("rooms/grid"));
            }
            Some(Kind::Text(text)) => {
                problems.extend(too_many("text", text.lattice()));
                problems.extend(self.text_problems());
                problems.extend(self.too_large("text"));
            }
            Some(Kind::Walls(walls)) => problems.extend(walls.iter().enumerate().filter_map(wall_problem)),
            Some(Kind::Predefined) | None => {}
        }
        problems
    }

    /// The keys of the kinds that are present.
    fn kinds(&self) -> Vec<&'static str> {
        present([
            ("maze", self.maze.is_some()),
            ("rooms", self.rooms.is_some()),
            ("text", self.text.is_some()),
            ("predefined", self.predefined.is_some()),
            ("walls", self.walls.is_some()),
        ])
    }

    fn too_large(&self, key: &str) -> Option<Problem> {
        let [width, depth] = self.size()?;
        (width.max(depth) > MAX_LAYOUT_SIDE).then(|| {
            let expected = format!("sides of at most {MAX_LAYOUT_SIDE} m");
            problem(
                "spec/layout-size",
                key,
                format!("an arena of {width} × {depth} m"),
                expected,
            )
        })
    }

    fn text_problems(&self) -> Vec<Problem> {
        let mut problems = Vec::new();
        for key in self.legend.keys().filter(|key| key.chars().count() != 1) {
            let place = format!("legend/{}", crate::describe::escape(key));
            problems.push(problem("spec/legend-letter", &place, format!("{key:?}"), "one letter"));
        }
        let rows = self.text.iter().flatten();
        let columns = rows.clone().next().map_or(0, |row| row.chars().count());
        let mut free = 0;
        for (number, row) in rows.enumerate() {
            let place = format!("text/{number}");
            let letters = row.chars().count();
            if letters != columns {
                let expected = format!("{columns}, as in the first line");
                let text = problem("spec/ragged-text", &place, format!("{letters} letters"), expected);
                problems.push(text.advise("pad the line with \"#\" or \" \""));
            }
            let unknown = row.chars().find(|letter| self.meaning(*letter).is_none());
            if let Some(letter) = unknown {
                let expected = "a letter of the legend, or one of # * . _ A P D and space";
                let text = problem(
                    "spec/unknown-letter",
                    &place,
                    format!("the letter {letter:?}"),
                    expected,
                );
                problems.push(text.advise(format!("add {letter:?} to \"legend\"")));
            }
            free += row
                .chars()
                .filter(|letter| {
                    self.meaning(*letter)
                        .is_some_and(|meaning| meaning != super::Legend::Wall)
                })
                .count();
        }
        if free == 0 && problems.is_empty() {
            problems.push(problem(
                "spec/no-corridor",
                "text",
                "only walls",
                "at least one letter for floor",
            ));
        }
        problems
    }

    /// An oddity of the layout, as one sentence without a pointer; `plan` is the layout's plan.
    pub(crate) fn remark(plan: &Plan) -> Option<String> {
        let cut_off = plan.num_cut_off_cells();
        (cut_off > 0).then(|| {
            let all = plan.cells.len();
            format!(
                "{cut_off} of {all} free cells cannot be reached from the others; open a way to them, or turn them into walls"
            )
        })
    }
}

fn problem(code: &'static str, key: &str, found: impl Into<String>, expected: impl Into<String>) -> Problem {
    Problem::new(code, format!("{POINTER}/{key}"), found, expected)
}

fn too_many(key: &str, [columns, rows]: [usize; 2]) -> Option<Problem> {
    let cells = columns.saturating_mul(rows);
    (cells > MAX_CELLS).then(|| {
        let found = format!("{cells} cells ({columns} × {rows})");
        problem("spec/too-many-cells", key, found, format!("at most {MAX_CELLS}"))
    })
}

fn wall_problem((index, wall): (usize, &LayoutWall)) -> Option<Problem> {
    let place = format!("walls/{index}");
    let expected = "exactly one of from and to, circle, polygon";
    match wall.forms().as_slice() {
        ["from"] => match (wall.from, wall.to) {
            (Some(from), Some(to)) if from == to => {
                let found = format!("a segment from {from:?} to itself");
                Some(problem("spec/value", &place, found, "two different points"))
            }
            (Some(_), Some(_)) => None,
            (None, _) => Some(problem("spec/missing-key", &place, "nothing", "the key \"from\"")),
            (_, None) => Some(problem("spec/missing-key", &place, "nothing", "the key \"to\"")),
        },
        [form] if wall.thickness.is_some() => {
            let found = format!("\"thickness\" with {form:?}");
            Some(problem(
                "spec/layout-kind",
                &format!("{place}/thickness"),
                found,
                "it only with from and to",
            ))
        }
        [_] => None,
        [] => Some(problem("spec/layout-kind", &place, "none of them", expected)),
        forms => Some(problem(
            "spec/layout-kind",
            &place,
            format!("{} at once", forms.join(" and ")),
            expected,
        )),
    }
}

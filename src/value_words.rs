//! Writes values in a short form for captions.

use driftworld_spec::{Layout, RoomDoors, Value};
use driftworld_text::counted;

/// Maximum length, in characters, of values other than numbers and layouts; longer ones are cut.
const MAX_LENGTH: usize = 40;

/// A short form of a value: numbers with four significant digits, layouts by their parts.
pub(crate) fn short(value: &Value) -> String {
    match value {
        Value::Number(number) => rounded(*number),
        Value::Layout(layout) => layout_words(layout),
        Value::Point(place) => bracketed(place),
        Value::Vector(numbers) => bracketed(numbers),
        Value::Json(json) => json_words(json),
        other => cut(&other.to_string()),
    }
}

/// The numbers of a point or a vector, in brackets.
fn bracketed(numbers: &[f64]) -> String {
    let numbers: Vec<String> = numbers.iter().map(|number| rounded(*number)).collect();
    cut(&format!("[{}]", numbers.join(", ")))
}

/// Strings and lists of strings without JSON syntax, `null` as `none`; anything else as JSON.
fn json_words(json: &serde_json::Value) -> String {
    match json {
        serde_json::Value::Null => "none".to_owned(),
        serde_json::Value::String(text) => cut(text),
        serde_json::Value::Array(items) if items.iter().all(serde_json::Value::is_string) => {
            let words = items.iter().filter_map(|item| item.as_str());
            cut(&words.collect::<Vec<_>>().join(", "))
        }
        other => cut(&other.to_string()),
    }
}

fn rounded(number: f64) -> String {
    let digits = format!("{number:.3e}").parse::<f64>();
    digits.map_or_else(|_| number.to_string(), |number| number.to_string())
}

fn cut(text: &str) -> String {
    let plain: String = text.chars().filter(|c| *c != '"').collect();
    if plain.chars().count() <= MAX_LENGTH {
        return plain;
    }
    plain.chars().take(MAX_LENGTH - 1).chain(['…']).collect()
}

/// The parts of a layout; defaults are omitted.
fn layout_words(layout: &Layout) -> String {
    let mut words = Vec::new();
    let mut seed = None;
    if let Some(maze) = &layout.maze {
        let default = driftworld_spec::Maze::default();
        words.push(format!("maze {} × {}", maze.cells[0], maze.cells[1]));
        if maze.cell != default.cell {
            words.push(format!("cells of {} m", rounded(maze.cell)));
        }
        if maze.braid != default.braid {
            words.push(format!("{} % of dead ends open", rounded(100.0 * maze.braid)));
        }
        seed = maze.seed;
    } else if let Some(rooms) = &layout.rooms {
        let default = driftworld_spec::Rooms::default();
        let [width, depth] = rooms.room.map(rounded);
        words.push(format!(
            "{} × {} rooms of {width} × {depth} m",
            rooms.grid[0], rooms.grid[1]
        ));
        if rooms.doorway != default.doorway {
            words.push(format!("doorways of {} m", rounded(rooms.doorway)));
        }
        if rooms.loops != default.loops {
            words.push(format!("{} % of loops", rounded(100.0 * rooms.loops)));
        }
        match rooms.doors {
            RoomDoors::None => {}
            RoomDoors::Open => words.push("open doors".to_owned()),
            RoomDoors::Closed => words.push("closed doors".to_owned()),
            RoomDoors::Keyed => words.push("doors with keys".to_owned()),
        }
        seed = rooms.seed;
    } else if let Some(lines) = &layout.text {
        let width = lines.first().map_or(0, |line| line.chars().count());
        words.push(format!("map of {width} × {} letters", lines.len()));
        if let Some(cell) = layout.cell {
            words.push(format!("cells of {} m", rounded(cell)));
        }
    } else if let Some(map) = layout.predefined {
        words.push(format!("map {map}"));
        if let Some([width, depth]) = layout.size.map(|size| size.map(rounded)) {
            words.push(format!("{width} × {depth} m"));
        }
    } else {
        match layout.walls.as_ref().map_or(0, Vec::len) {
            0 => words.push("no walls".to_owned()),
            number => words.push(counted(number, "wall")),
        }
    }
    if layout.standing < 1.0 {
        words.push(format!("{} % of walls", rounded(100.0 * layout.standing)));
    }
    if let Some(seed) = seed {
        words.push(format!("seed {seed}"));
    }
    words.join(", ")
}

#[cfg(test)]
mod tests {
    use driftworld_spec::{ParameterType, Value};

    use super::*;

    #[test]
    fn numbers_have_four_digits() {
        let shown =
            [21.899_414, 0.642_968_750_000_000_1, -100.0, 12_346.0, 0.0].map(|number| short(&Value::Number(number)));
        assert_eq!(shown, ["21.9", "0.643", "-100", "12350", "0"]);
        assert_eq!(short(&Value::Text("red".to_owned())), "red");
        assert_eq!(short(&Value::Text("x".repeat(60))).chars().count(), MAX_LENGTH);
    }

    #[test]
    fn lists_and_points_are_shown_in_short() {
        let json = |text: &str| Value::Json(Box::new(serde_json::from_str(text).expect("it is JSON")));
        for (value, words) in [
            (json(r#"["rgb", "depth"]"#), "rgb, depth"),
            (json("null"), "none"),
            (json(r#"{ "a": [1, 2] }"#), "{a:[1,2]}"),
            (Value::Point([-5.0, -12.5]), "[-5, -12.5]"),
            (Value::Vector(vec![1.0, 2.0, 3.0]), "[1, 2, 3]"),
        ] {
            assert_eq!(short(&value), words);
        }
    }

    #[test]
    fn layouts_are_words_and_not_cut_json() {
        let cases = [
            (r#"{ "maze": {} }"#, "maze 8 × 8"),
            (
                r#"{ "maze": { "cells": [12, 5], "cell": 2, "braid": 0.5, "seed": 7 } }"#,
                "maze 12 × 5, cells of 2 m, 50 % of dead ends open, seed 7",
            ),
            (r#"{ "maze": {}, "standing": 0.33 }"#, "maze 8 × 8, 33 % of walls"),
            (
                r#"{ "rooms": { "grid": [3, 2], "room": [6, 8.5], "doorway": 2, "loops": 0, "doors": "keyed" } }"#,
                "3 × 2 rooms of 6 × 8.5 m, doorways of 2 m, 0 % of loops, doors with keys",
            ),
            (r#"{ "text": ["*****", "*A..*", "*****"] }"#, "map of 5 × 3 letters"),
            (r#"{ "predefined": 3, "size": [50, 50] }"#, "map 3, 50 × 50 m"),
            (r#"{ "walls": [] }"#, "no walls"),
            (r#"{ "walls": [{ "from": [0, 0], "to": [5, 0] }] }"#, "1 wall"),
        ];
        for (json, words) in cases {
            let value: Value = serde_json::from_str(json).expect("it is a value");
            let value = value.cast(ParameterType::Layout).expect("it is a layout");
            assert_eq!(short(&value), words, "{json}");
        }
    }
}

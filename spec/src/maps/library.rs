//! [`MapLibrary`]: layouts read from files, replacing the built-in ones.

use std::sync::LazyLock;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::Document;
use crate::error::{Problem, SpecError};
use crate::limits::MAX_VALUES;
use crate::schema::document::DocumentSchema;
use crate::world::Region;

/// The document of a maps file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "unit": "metre", "maps": [{ "id": 2, "name": "yard", "excluded_regions": [[[-5, -5], [5, -5], [5, 5], [-5, 5]]] }] },
]))]
pub(crate) struct MapsDocument {
    /// The address of this document's JSON Schema, for editors.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    schema: Option<String>,
    /// The unit of all coordinates.
    #[serde(default)]
    unit: Unit,
    /// Where the origin lies, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    origin: Option<String>,
    /// Where the axes point, in words.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    axes: Option<String>,
    /// The layouts.
    #[schemars(length(min = 1, max = 100))]
    pub(super) maps: Vec<MapLayout>,
}

impl MapsDocument {
    /// The schema of a maps file.
    pub(crate) fn schema() -> &'static DocumentSchema {
        static SCHEMA: LazyLock<DocumentSchema> =
            LazyLock::new(|| DocumentSchema::of::<MapsDocument>("maps", "Driftworld maps file"));
        &SCHEMA
    }
}

/// The unit of a maps file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
enum Unit {
    /// Metres.
    #[default]
    Metre,
}

/// One layout: its map number, and the regions that cannot be entered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "id": 2, "name": "yard", "excluded_regions": [[[-5, -5], [5, -5], [5, 5], [-5, 5]]] },
]))]
pub struct MapLayout {
    /// The `predefined_map` number of this layout.
    #[schemars(range(min = 0, max = 4))]
    pub id: u8,
    /// Its name.
    #[schemars(length(min = 1, max = 100))]
    pub name: String,
    /// West and east end of the arena in metres; the arena of a predefined map is 200 × 200 m, so −100 and 100.
    #[serde(default = "whole_arena")]
    pub x_limits: [f64; 2],
    /// South and north end of the arena in metres; −100 and 100.
    #[serde(default = "whole_arena")]
    pub y_limits: [f64; 2],
    /// The regions: polygons in metres, with corners in order; the last corner connects to the first. They may touch themselves
    /// and each other.
    #[schemars(length(max = 1000))]
    pub excluded_regions: Vec<Region>,
}

fn whole_arena() -> [f64; 2] {
    [-100.0, 100.0]
}

/// Layouts by number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapLibrary {
    maps: BTreeMap<u8, MapLayout>,
}

impl MapLibrary {
    /// Reads a maps file strictly. `name` is the document's name in messages, usually its path.
    ///
    /// # Errors
    /// [`SpecError::Document`] with all problems of the text, sorted by position.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{World, maps::MapLibrary};
    /// let text = r#"{ "maps": [{ "id": 2, "name": "yard", "excluded_regions": [[[0, 0], [9, 0], [9, 9]]] }] }"#;
    /// let library = MapLibrary::from_json("maps.json", text)?;
    /// let world = World::from_json("w", r#"{ "environment_params": { "predefined_map": 2 } }"#)?;
    /// assert_eq!(world.with_maps(&library).environment_params.regions().len(), 1);
    /// # Ok::<(), driftworld_spec::SpecError>(())
    /// ```
    pub fn from_json(name: &str, text: &str) -> Result<Self, SpecError> {
        let document = Document::parse(name, text, MAX_VALUES)?;
        document.fail_on(MapsDocument::schema().problems(&document.value))?;
        let file: MapsDocument = document.deserialize()?;
        document.fail_on(problems(&file.maps))?;
        Ok(Self {
            maps: file.maps.into_iter().map(|map| (map.id, map)).collect(),
        })
    }

    /// Adds the layouts of another library; they replace layouts with the same number.
    pub fn extend(&mut self, other: Self) {
        self.maps.extend(other.maps);
    }

    /// The layout of a map, if there is one.
    pub(crate) fn layout(&self, map: u8) -> Option<&MapLayout> {
        self.maps.get(&map)
    }

    /// The layouts ordered by number.
    pub fn layouts(&self) -> impl Iterator<Item = &MapLayout> {
        self.maps.values()
    }
}

/// Checks beyond the schema: repeated numbers, arenas of a different size, corners far outside the arena.
fn problems(maps: &[MapLayout]) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (index, map) in maps.iter().enumerate() {
        let problem = |code, at: &str, found: String, expected: &str| {
            Problem::new(code, format!("/maps/{index}/{at}"), found, expected)
        };
        if let Some(first) = maps[..index].iter().position(|other| other.id == map.id) {
            let found = format!("{}, which map {first} has too", map.id);
            problems.push(problem("spec/duplicate-name", "id", found, "a number of its own"));
        }
        for (key, limits) in [("x_limits", map.x_limits), ("y_limits", map.y_limits)] {
            if limits != whole_arena() {
                let expected = "[-100, 100]: a predefined map is 200 m wide";
                problems.push(problem("spec/value", key, format!("{limits:?}"), expected));
            }
        }
        if map.id == 0 && !map.excluded_regions.is_empty() {
            let found = format!("{} regions in map 0", map.excluded_regions.len());
            let expected = "none: map 0 is the empty arena";
            let problem = problem("spec/value", "excluded_regions", found, expected);
            problems.push(problem.advise("give the layout a number from 1 to 4"));
        }
        for (region, polygon) in map.excluded_regions.iter().enumerate() {
            let is_outside = |corner: &[f64; 2]| corner.iter().any(|metres| metres.abs() > 150.0);
            if let Some(corner) = polygon.0.iter().position(is_outside) {
                let at = format!("excluded_regions/{region}/{corner}");
                let expected = "a corner at most 50 m outside the arena";
                problems.push(problem("spec/range", &at, format!("{:?}", polygon.0[corner]), expected));
            }
        }
    }
    problems
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(maps: &str, expected: &str) {
        let error = MapLibrary::from_json("maps.json", &format!("{{ \"maps\": {maps} }}")).unwrap_err();
        assert_eq!(error.to_string(), expected);
    }

    #[test]
    fn invalid_layouts_are_rejected() {
        check(
            r#"[{ "id": 1, "name": "a", "excluded_regions": [] }, { "id": 1, "name": "b", "excluded_regions": [] }]"#,
            "maps.json:1:70 (/maps/1/id): found 1, which map 0 has too, expected a number of its own",
        );
        check(
            r#"[{ "id": 1, "name": "a", "x_limits": [-50, 50], "excluded_regions": [] }]"#,
            "maps.json:1:48 (/maps/0/x_limits): found [-50.0, 50.0], expected [-100, 100]: a predefined map is 200 m wide",
        );
        check(
            r#"[{ "id": 1, "name": "a", "excluded_regions": [[[0, 0], [900, 0], [0, 9]]] }]"#,
            "maps.json:1:66 (/maps/0/excluded_regions/0/1): found [900.0, 0.0], expected a corner at most 50 m outside the arena",
        );
    }
}

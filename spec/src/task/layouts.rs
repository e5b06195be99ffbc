//! Layouts as values of parameters: checks and interpolation.

use std::sync::LazyLock;

use serde_json::{Map, Value as Json};

use crate::error::Problem;
use crate::layout::POINTER;
use crate::schema::document::DocumentSchema;
use crate::{Layout, SpecError};

/// The problems of JSON that should be a layout, with pointers into it.
pub(super) fn problems(json: &Json) -> Vec<Problem> {
    static SCHEMA: LazyLock<DocumentSchema> = LazyLock::new(|| DocumentSchema::of::<Layout>("layout", "Layout"));
    let schema_problems = SCHEMA.problems(json).problems;
    if !schema_problems.is_empty() {
        return schema_problems;
    }
    serde_json::from_value::<Layout>(json.clone()).map_or_else(|_| Vec::new(), |layout| beyond_schema(&layout))
}

/// The problems of a layout beyond its schema, with pointers into it.
pub(super) fn beyond_schema(layout: &Layout) -> Vec<Problem> {
    let mut problems = layout.problems();
    for problem in &mut problems {
        problem.pointer = problem.pointer.trim_start_matches(POINTER).to_owned();
    }
    problems
}

impl Layout {
    /// Checks a layout built in code against the rules for layouts in documents.
    ///
    /// # Errors
    /// [`SpecError::Document`] under the name `layout`, with all problems.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{Layout, Maze};
    /// let maze = |wall| Layout { maze: Some(Maze { wall, ..Maze::default() }), ..Layout::default() };
    /// assert!(maze(0.5).check().is_ok());
    /// assert!(maze(5.0).check().is_err(), "walls are thicker than the cells");
    /// ```
    pub fn check(&self) -> Result<(), SpecError> {
        let json = serde_json::to_value(self).expect("a layout serialises");
        match problems(&json) {
            found if found.is_empty() => Ok(()),
            found => Err(SpecError::of_document("layout", found)),
        }
    }

    /// The layout at fraction `t`, 0..=1, of the way to another.
    ///
    /// Two layouts of one kind that differ only in numbers are interpolated linearly, with integers rounded. Otherwise the
    /// walls of the first are removed one by one up to the halfway point, and then the walls of the second are added, so that
    /// every place stays reachable.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::{Layout, Maze};
    /// let maze = |count| Layout { maze: Some(Maze { cells: [count, 4], ..Maze::default() }), ..Layout::default() };
    /// assert_eq!(maze(4).toward(&maze(9), 0.5), maze(7));
    /// let open = Layout { walls: Some(Vec::new()), ..Layout::default() };
    /// assert_eq!(open.toward(&maze(4), 0.75), Layout { standing: 0.5, ..maze(4) });
    /// ```
    #[must_use]
    pub fn toward(&self, other: &Self, t: f64) -> Self {
        let [own, theirs] = [self, other].map(|layout| serde_json::to_value(layout).expect("a layout serialises"));
        let interpolated = between(&own, &theirs, t).and_then(|json| serde_json::from_value::<Self>(json).ok());
        // Two numbers that are valid at both ends can be too large together in between.
        if let Some(interpolated) = interpolated.filter(|layout| layout.problems().is_empty()) {
            return interpolated;
        }
        let (near, share) = if t < 0.5 {
            (self, 1.0 - 2.0 * t)
        } else {
            (other, 2.0 * t - 1.0)
        };
        Self {
            standing: near.standing * share,
            ..near.clone()
        }
    }
}

/// Interpolates JSON that differs only in numbers, except seeds and map numbers.
fn between(from: &Json, to: &Json, t: f64) -> Option<Json> {
    match (from, to) {
        (Json::Object(from), Json::Object(to)) if from.len() == to.len() => {
            let entries = from.iter().map(|(key, child)| {
                let other = to.get(key)?;
                let is_name = ["seed", "predefined"].contains(&key.as_str());
                let child = if is_name {
                    (child == other).then(|| child.clone())
                } else {
                    between(child, other, t)
                };
                Some((key.clone(), child?))
            });
            entries.collect::<Option<Map<String, Json>>>().map(Json::Object)
        }
        (Json::Array(from), Json::Array(to)) if from.len() == to.len() => {
            let items = from.iter().zip(to).map(|(from, to)| between(from, to, t));
            items.collect::<Option<Vec<Json>>>().map(Json::Array)
        }
        (Json::Number(from), Json::Number(to)) => {
            let is_whole = from.is_u64() && to.is_u64();
            let (from, to) = (from.as_f64()?, to.as_f64()?);
            let number = from + (to - from) * t;
            Some(if is_whole {
                Json::from(number.round() as u64)
            } else {
                Json::from(number)
            })
        }
        _ => (from == to).then(|| from.clone()),
    }
}

//! [`Arena`]: the surroundings in which a task's layouts are compared as parameter values, before any world is drawn.

use std::sync::Arc;

use driftworld_spec::{DEFAULT_VARIANT, EnvironmentParams, Resolved, Source, TaskSpec, Value, Variant, WorldDraft};

/// The arena around a layout that gives neither its size nor its walls' height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arena {
    /// Its sides in metres.
    pub(super) size: [f64; 2],
    /// Height, in metres, of walls without their own.
    pub(super) wall_height: f64,
}

impl Arena {
    /// The arena of a task. A parameter for its size or wall height is taken at its default, a drawn value at its mean, so
    /// the arena depends on the task alone, not on the values compared.
    pub(super) fn of(task: &Arc<TaskSpec>) -> Self {
        let world = task.world();
        let mut draft = WorldDraft {
            environment_params: EnvironmentParams {
                layout: None,
                ..world.base.environment_params.clone()
            },
            ..WorldDraft::default()
        };
        let default = task
            .variant(DEFAULT_VARIANT)
            .ok()
            .or_else(|| task.all_variants().into_iter().next());
        let is_relevant = |pointer: &str| {
            ["map_size", "wall_height", "predefined_map"].iter().any(|key| {
                pointer
                    .strip_prefix("/environment_params/")
                    .is_some_and(|rest| rest.starts_with(key))
            })
        };
        for hole in world.holes.iter().filter(|hole| is_relevant(&hole.pointer)) {
            let value = default.as_ref().and_then(|variant| typical(variant, &hole.source));
            if let Some(value) = value {
                // Values that do not fit leave the template's example in place.
                let _ = hole.fill(&mut draft, &value);
            }
        }
        Self {
            size: draft.environment_params.arena_size(),
            wall_height: draft.environment_params.wall_height,
        }
    }
}

/// A source's value in a variant, or the mean of its distribution.
fn typical(variant: &Variant, source: &Source) -> Option<Value> {
    match variant.resolve(source) {
        Resolved::Value(value) => Some(value),
        Resolved::Draw(distribution) => distribution.mean().map(Value::Number),
        Resolved::Randomized(reference) => variant.distribution(&reference.param)?.mean().map(Value::Number),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LayoutShape, VariantMeasure, Weights};

    /// A task with these environment parameters, and a parameter `map`: an empty layout, a text layout of 18 × 18 m, or two
    /// walls.
    fn task(around: &str) -> Arc<TaskSpec> {
        let text = format!(
            r#"{{ "name": "t", "parameters": {{
                "map": {{ "role": "variant", "type": "layout", "affects": ["S"], "choices": [
                    {{ "walls": [] }}, {{ "text": ["...", "...", "..."], "cell": 6 }},
                    {{ "walls": [{{ "from": [-4, 0], "to": [4, 0] }}, {{ "from": [0, 4], "to": [4, 4], "height": 3 }}] }}], "default": {{ "walls": [] }} }},
                "side": {{ "role": "variant", "type": "point", "affects": ["S"], "choices": [[18, 24], [40, 40]], "default": [18, 24] }},
                "high": {{ "role": "randomized", "type": "number", "affects": ["O"], "distribution": {{ "uniform": {{ "low": 1, "high": 3 }} }} }} }},
              "world": {{ "environment_params": {{ "layout": {{ "param": "map" }}{around} }} }},
              "variants": {{ "open": {{}}, "text": {{ "map": {{ "text": ["...", "...", "..."], "cell": 6 }} }}, "wide": {{ "side": [40, 40] }},
                "walls": {{ "map": {{ "walls": [{{ "from": [-4, 0], "to": [4, 0] }}, {{ "from": [0, 4], "to": [4, 4], "height": 3 }}] }} }} }} }}"#
        );
        TaskSpec::from_json("t.json", &text).unwrap()
    }

    fn assert_arena(around: &str, size: [f64; 2], wall_height: f64) {
        assert_eq!(Arena::of(&task(around)), Arena { size, wall_height }, "{around}");
    }

    #[test]
    fn arena_is_taken_from_the_task() {
        assert_arena("", [100.0; 2], 4.0);
        assert_arena(r#", "map_size": [18, 18], "wall_height": 2"#, [18.0; 2], 2.0);
        assert_arena(r#", "map_size": { "param": "side" }"#, [18.0, 24.0], 4.0);
        assert_arena(r#", "wall_height": { "param": "high" }"#, [100.0; 2], 2.0);
        assert_arena(
            r#", "wall_height": { "uniform": { "low": 2, "high": 8 } }"#,
            [100.0; 2],
            5.0,
        );
    }

    #[test]
    fn layouts_are_compared_within_the_arena() {
        let around = r#", "map_size": [18, 18], "wall_height": 2"#;
        let task = task(around);
        let measure = VariantMeasure::new(&task, Weights::default());
        let [open, text, walls] = ["open", "text", "walls"].map(|name| task.variant(name).unwrap());
        let raw = |a: &Variant, b: &Variant| {
            let distance = measure.between(a, b).unwrap();
            distance.parts.iter().find(|part| part.name == "map").unwrap().raw
        };
        assert_eq!(
            raw(&open, &text),
            0.0,
            "an empty text layout as large as the arena equals the empty arena"
        );
        let Some(Value::Layout(layout)) = walls.value("map") else {
            panic!("a layout")
        };
        let shape = LayoutShape::of(&layout.plan(0), [18.0; 2], 2.0);
        assert_eq!(raw(&open, &walls), LayoutShape::open().distance(&shape));
        // Walls of 8 m block a smaller share of a 100 m arena.
        let large = LayoutShape::of(&layout.plan(0), [100.0; 2], 2.0);
        assert!(LayoutShape::open().distance(&large) < raw(&open, &walls));
    }
}

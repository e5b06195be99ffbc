//! Fuzz target for task specs, their variants, and the worlds sampled from the variants.

use std::sync::OnceLock;

use driftworld_generator::sample;
use driftworld_spec::TaskSpec;

use crate::edited::Known;
use crate::{refusal, world};

/// The built-in tasks.
pub(crate) const EXAMPLES: [&str; 7] = [
    include_str!("../../examples/tasks/find_objects.json"),
    include_str!("../../examples/tasks/get_to_goal.json"),
    include_str!("../../examples/tasks/select_object.json"),
    include_str!("../../examples/tasks/moving_object.json"),
    include_str!("../../examples/tasks/scavenger_hunt.json"),
    include_str!("../../examples/tasks/blue_red_green.json"),
    include_str!("../../examples/tasks/settlement.json"),
];

/// Maximum number of variants per task from which worlds are sampled.
const MAX_VARIANTS: usize = 2;

fn known() -> &'static Known {
    static KNOWN: OnceLock<Known> = OnceLock::new();
    KNOWN.get_or_init(|| {
        let documents = EXAMPLES.iter().map(|text| world::json(text)).collect();
        Known::new(documents, include_str!("../../schemas/task.schema.json"))
    })
}

/// A task that can be read can be written, and reads back the same. Its worlds are valid, and sampling again gives the same
/// worlds.
pub(crate) fn check(bytes: &[u8]) {
    let text = known().text(bytes);
    let task = match TaskSpec::from_json("t.json", &text) {
        Ok(task) => task,
        Err(error) => return refusal::check(&error, &text),
    };
    let written = task.to_json();
    let reread = TaskSpec::from_json("again", &written)
        .unwrap_or_else(|error| panic!("our own output is valid: {error}\n{written}\nread from {text}"));
    assert!(task.is_same_as(&reread), "{written}");
    for variant in task.all_variants().iter().take(MAX_VARIANTS) {
        match sample(variant, 7, 1) {
            Ok(world) => {
                world::check_round_trip(&world);
                assert_eq!(sample(variant, 7, 1).map(|world| world.hash()).ok(), Some(world.hash()));
            }
            Err(error) => refusal::message(&error.to_string()),
        }
    }
}

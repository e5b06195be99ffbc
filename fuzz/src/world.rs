//! Fuzz target for worlds, in Driftworld's format and L2Explorer's.

use std::sync::OnceLock;

use driftworld_spec::World;
use serde_json::Value;

use crate::edited::Known;
use crate::{refusal, task};

/// Seed worlds: up to two of each example task, and one written by hand.
pub(crate) fn known() -> &'static Known {
    static KNOWN: OnceLock<Known> = OnceLock::new();
    KNOWN.get_or_init(|| {
        let mut documents = vec![json(include_str!("../../examples/assets/harbour.json"))];
        for text in task::EXAMPLES {
            let task = driftworld_spec::TaskSpec::from_json("example", text).expect("the example is valid");
            for variant in task.all_variants().iter().take(2) {
                let world = driftworld_generator::sample(variant, 1, 0).expect("the example can be sampled");
                documents.push(json(&world.to_json()));
            }
        }
        // Small documents come first, because the first is chosen most often.
        documents.sort_by_key(|document| document.to_string().len());
        Known::new(documents, include_str!("../../schemas/world.schema.json"))
    })
}

pub(crate) fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("our documents are valid JSON")
}

/// A world that can be read can be written, and reads back the same, even if it was converted from L2Explorer's format.
pub(crate) fn check(bytes: &[u8]) {
    let text = known().text(bytes);
    match World::from_json("w.json", &text) {
        Ok(world) => check_round_trip(&world),
        Err(error) => refusal::check(&error, &text),
    }
    match World::from_l2explorer("w.json", &text) {
        Ok((world, warnings)) => {
            refusal::messages(warnings);
            check_round_trip(&world);
        }
        Err(error) => refusal::check(&error, &text),
    }
}

/// A world round-trips through its own JSON.
pub(crate) fn check_round_trip(world: &World) {
    let text = world.to_json();
    let reread =
        World::from_json("again", &text).unwrap_or_else(|error| panic!("our own output is valid: {error}\n{text}"));
    assert_eq!(reread.to_json(), text);
    assert_eq!(reread.hash(), world.hash());
}

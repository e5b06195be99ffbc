//! Fuzz target for maps files.

use std::sync::OnceLock;

use driftworld_spec::World;
use driftworld_spec::maps::MapLibrary;

use crate::edited::Known;
use crate::{refusal, world};

fn known() -> &'static Known {
    static KNOWN: OnceLock<Known> = OnceLock::new();
    KNOWN.get_or_init(|| {
        let documents = vec![
            world::json(r#"{ "maps": [{ "id": 2, "name": "yard", "excluded_regions": [[[0, 0], [9, 0], [9, 9]]] }] }"#),
            world::json(
                r#"{ "maps": [{ "id": 1, "name": "a", "size": [20, 20], "excluded_regions": [] },
                              { "id": 3, "excluded_regions": [[[1, 1], [2, 1], [2, 2], [1, 2]], [[-1, -1], [-2, -1], [-2, -2]]] }] }"#,
            ),
        ];
        Known::new(documents, include_str!("../../schemas/maps.schema.json"))
    })
}

/// Every accepted layout gives a valid world.
pub(crate) fn check(bytes: &[u8]) {
    let text = known().text(bytes);
    let library = match MapLibrary::from_json("m.json", &text) {
        Ok(library) => library,
        Err(error) => return refusal::check(&error, &text),
    };
    for layout in library.layouts() {
        let world = World::default().edit(|world| world.environment_params.predefined_map = layout.id);
        let world = world.expect("worlds accept the id of every layout");
        world::check_round_trip(&world.with_maps(&library));
    }
}

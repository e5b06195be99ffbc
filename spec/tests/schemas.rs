//! The schemas themselves: valid as schemas, equal to the committed files, and in agreement with the types.

use driftworld_spec::{Object, World, schema};

#[test]
fn every_schema_is_a_valid_schema() {
    for (name, schema) in schema::all() {
        jsonschema::meta::validate(schema.json()).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

#[test]
fn the_committed_schemas_are_those_of_the_code() {
    for (name, schema) in schema::all() {
        let path = format!("{}/../schemas/{name}", env!("CARGO_MANIFEST_DIR"));
        let committed = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let current = serde_json::to_string_pretty(schema.json()).expect("a schema serialises") + "\n";
        assert!(committed == current, "{path} is stale; run: cargo xtask schemas");
    }
}

#[test]
fn what_the_types_write_the_schema_accepts() {
    let mut world = World::default();
    world.objects.push(Object::new("tree", [1.0, 2.0]));
    let again = World::from_json("written", &world.to_json()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(again, world);
}

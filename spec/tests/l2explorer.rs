//! The original's own map files read without an error. They stay where they are: the test is skipped, visibly, without them.

use driftworld_spec::World;

#[test]
fn every_map_of_the_original_reads() {
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/reference");
    let root = std::env::var("DRIFTWORLD_REFERENCE").unwrap_or_else(|_| default.to_owned());
    for (file, objects, warnings) in [
        ("map_findobjects_0", 8, 7),
        ("map_simple", 3, 1),
        ("map_spawning", 3, 1),
    ] {
        let path = format!("{root}/l2explorer/{file}.json");
        let Ok(text) = std::fs::read_to_string(&path) else {
            println!("skipped: {path} is not there; set DRIFTWORLD_REFERENCE");
            return;
        };
        let (world, found) = World::from_l2explorer(file, &text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(world.objects.len(), objects, "{file}");
        assert_eq!(found.len(), warnings, "{file}: {found:#?}");
        let again = World::from_json(file, &world.to_json()).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(again, world, "{file} survives writing and strict reading");
    }
}

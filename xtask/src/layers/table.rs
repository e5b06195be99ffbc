//! The house as data: which floor a crate stands on, what it may import, and which third-party crates are fenced into
//! which room. A new crate gets its line here; nothing is checked in this file.

/// A crate of ours.
pub(super) struct Room {
    /// The package's name in its `Cargo.toml`.
    pub(super) package: &'static str,
    /// 1 is the lowest; a room imports only from lower floors.
    pub(super) floor: u8,
    /// The crates of ours it may import, as normal, dev or build dependency alike.
    pub(super) may_import: &'static [&'static str],
}

/// Third-party crates that only some rooms may use, so that their weight and their types stay there.
pub(super) struct Fence {
    pub(super) crates: &'static [&'static str],
    /// The rooms inside the fence.
    pub(super) rooms: &'static [&'static str],
    /// Rooms that may use them in tests only.
    pub(super) test_rooms: &'static [&'static str],
    /// Why, as the end of "expected it only in …, where …".
    pub(super) purpose: &'static str,
}

/// Names crates that no room imports, so their versions stand nowhere else.
pub(super) const FEATURES: &str = "driftworld-features";
const ATOMIC_FILES: &str = "driftworld-atomic-files";
const TEXT: &str = "driftworld-text";
const FILES: &str = "driftworld-files";
const SPEC: &str = "driftworld-spec";
const GENERATOR: &str = "driftworld-generator";
const SIMILARITY: &str = "driftworld-similarity";
const ENV: &str = "driftworld-env";
const METRICS: &str = "driftworld-metrics";
const CURRICULUM: &str = "driftworld-curriculum";
const REPORT: &str = "driftworld-report";
const FACADE: &str = "driftworld";
const PYTHON: &str = "driftworld-python";
const UNITY: &str = "driftworld-unity";
const FUZZ: &str = "driftworld-fuzz";

/// Floor by floor, from the ground up.
pub(super) const ROOMS: &[Room] = &[
    // No code, so no room: the ground on which the house and its tools stand.
    Room {
        package: FEATURES,
        floor: 0,
        may_import: &[],
    },
    // Below every room: what text of others becomes on its way out.
    Room {
        package: TEXT,
        floor: 0,
        may_import: &[],
    },
    Room {
        package: ATOMIC_FILES,
        floor: 1,
        may_import: &[],
    },
    Room {
        package: FILES,
        floor: 1,
        may_import: &[TEXT],
    },
    Room {
        package: SPEC,
        floor: 1,
        may_import: &[FEATURES, TEXT],
    },
    Room {
        package: GENERATOR,
        floor: 2,
        may_import: &[FEATURES, TEXT, SPEC],
    },
    Room {
        package: SIMILARITY,
        floor: 2,
        may_import: &[FEATURES, TEXT, SPEC],
    },
    Room {
        package: ENV,
        floor: 2,
        may_import: &[FEATURES, TEXT, SPEC],
    },
    Room {
        package: METRICS,
        floor: 2,
        may_import: &[TEXT, ATOMIC_FILES, FILES],
    },
    Room {
        package: CURRICULUM,
        floor: 3,
        may_import: &[
            FEATURES,
            TEXT,
            ATOMIC_FILES,
            FILES,
            SPEC,
            GENERATOR,
            SIMILARITY,
            ENV,
            METRICS,
        ],
    },
    Room {
        package: REPORT,
        floor: 3,
        may_import: &[FEATURES, TEXT, ATOMIC_FILES, FILES, SPEC, SIMILARITY, METRICS],
    },
    Room {
        package: FACADE,
        floor: 4,
        may_import: &[
            FEATURES,
            TEXT,
            ATOMIC_FILES,
            FILES,
            SPEC,
            GENERATOR,
            SIMILARITY,
            ENV,
            METRICS,
            CURRICULUM,
            REPORT,
        ],
    },
    Room {
        package: PYTHON,
        floor: 5,
        may_import: &[
            FEATURES,
            TEXT,
            ATOMIC_FILES,
            FILES,
            SPEC,
            GENERATOR,
            SIMILARITY,
            ENV,
            METRICS,
            CURRICULUM,
            REPORT,
            FACADE,
        ],
    },
    Room {
        package: UNITY,
        floor: 4,
        may_import: &[FEATURES, TEXT, ATOMIC_FILES, FILES, SPEC, ENV],
    },
    Room {
        package: FUZZ,
        floor: 5,
        may_import: &[
            FEATURES,
            TEXT,
            ATOMIC_FILES,
            FILES,
            SPEC,
            GENERATOR,
            SIMILARITY,
            ENV,
            METRICS,
            CURRICULUM,
            UNITY,
        ],
    },
    // Beside the house: builds in seconds because it imports none of it.
    Room {
        package: "xtask",
        floor: 4,
        may_import: &[FEATURES],
    },
];

pub(super) const FENCES: &[Fence] = &[
    Fence {
        crates: &["schemars", "jsonschema"],
        rooms: &[SPEC],
        test_rooms: &[FACADE],
        purpose: "documents and their schemas are defined",
    },
    Fence {
        crates: &["rand", "rand_chacha", "rand_distr"],
        rooms: &[GENERATOR, ENV, METRICS],
        test_rooms: &[],
        purpose: "every draw is keyed or seeded, so that worlds, episodes and intervals repeat",
    },
    Fence {
        crates: &["rapier3d", "parry3d", "wgpu", "gltf", "gltf-json", "meshopt", "image"],
        rooms: &[ENV],
        test_rooms: &[],
        purpose: "worlds are simulated and drawn",
    },
    Fence {
        crates: &["csv"],
        rooms: &[METRICS],
        test_rooms: &[],
        purpose: "logs are read and written",
    },
    Fence {
        crates: &["maud"],
        rooms: &[REPORT],
        test_rooms: &[],
        purpose: "pages are written",
    },
    Fence {
        crates: &["clap", "indicatif"],
        rooms: &[FACADE],
        test_rooms: &[],
        purpose: "the command line talks to its user",
    },
    Fence {
        crates: &["pyo3", "numpy"],
        rooms: &[PYTHON],
        test_rooms: &[],
        purpose: "Python is spoken",
    },
    Fence {
        crates: &["tonic", "prost"],
        rooms: &[UNITY, FUZZ],
        test_rooms: &[],
        purpose: "the ML-Agents protocol is spoken",
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    fn room(package: &str) -> &'static Room {
        ROOMS
            .iter()
            .find(|room| room.package == package)
            .expect("the table names only rooms of its own")
    }

    #[test]
    fn a_room_imports_only_from_lower_floors() {
        for room_above in ROOMS {
            for package in room_above.may_import {
                assert!(
                    room(package).floor < room_above.floor,
                    "{} imports {package}",
                    room_above.package
                );
            }
        }
    }

    /// So that checking each crate's own imports also checks every path through the house.
    #[test]
    fn what_an_import_may_import_is_allowed_too() {
        for room_above in ROOMS {
            for package in room_above.may_import {
                for below in room(package).may_import {
                    assert!(
                        room_above.may_import.contains(below),
                        "{} → {package} → {below}",
                        room_above.package
                    );
                }
            }
        }
    }

    #[test]
    fn fences_stand_around_rooms_that_exist() {
        for fence in FENCES {
            assert!(!fence.rooms.is_empty(), "{:?}", fence.crates);
            for package in fence.rooms.iter().chain(fence.test_rooms) {
                assert_eq!(room(package).package, *package);
            }
        }
    }
}

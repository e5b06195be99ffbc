//! The four built-in layouts: regions of a 200 × 200 m arena that cannot be entered. The layouts are ours, in `builtin.json`;
//! only their names and numbers come from L2Explorer. L2Explorer's own layouts, used for worlds in its dialect, are in
//! `l2explorer.json`, under the licence next to it.

mod library;

use std::sync::LazyLock;

pub(crate) use library::MapsDocument;
pub use library::{MapLayout, MapLibrary};

use crate::world::Region;

/// A built-in layout. 1 backslash: a broken ridge from the north-west corner to the south-east one, with two passes; 2 village:
/// twelve houses around a square and two lanes; 3 craters: six round pits; 4 bisected: a wall from west to east with a gate at
/// each third.
fn built_in(predefined_map: u8) -> Option<&'static MapLayout> {
    static MAPS: LazyLock<MapsDocument> =
        LazyLock::new(|| serde_json::from_str(include_str!("builtin.json")).expect("the built-in layouts are valid"));
    MAPS.maps.iter().find(|map| map.id == predefined_map)
}

/// L2Explorer's layouts of its maps 1 to 4, used for worlds in its dialect.
pub fn of_l2explorer() -> &'static MapLibrary {
    static MAPS: LazyLock<MapLibrary> = LazyLock::new(|| {
        MapLibrary::from_json("l2explorer.json", include_str!("l2explorer.json")).expect("the layouts are valid")
    });
    &MAPS
}

/// Regions of a predefined map that cannot be entered; empty for 0 and any number without a layout.
pub fn excluded_regions(predefined_map: u8) -> &'static [Region] {
    built_in(predefined_map).map_or(&[], |map| &map.excluded_regions)
}

/// The name of a predefined map.
pub fn name(predefined_map: u8) -> &'static str {
    built_in(predefined_map).map_or("empty", |map| &map.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn built_in_layouts_have_regions_inside_the_arena() {
        for map in 1..=4 {
            assert!(!excluded_regions(map).is_empty(), "{}", name(map));
            for corner in excluded_regions(map).iter().flat_map(|region| &region.0) {
                assert!(corner.iter().all(|c| c.abs() <= 100.0), "{}: {corner:?}", name(map));
            }
        }
    }

    #[test]
    fn unknown_map_number_has_no_regions() {
        assert!(excluded_regions(0).is_empty() && excluded_regions(9).is_empty());
    }
}

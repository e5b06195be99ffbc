//! The four built-in layouts: regions of a 200 × 200 m arena that cannot be entered. They are ours; only names and numbers are
//! the original's. Layouts from files are read in `library.rs`.

mod library;

pub(crate) use library::MapsDocument;
pub use library::{MapLayout, MapLibrary};

/// Regions of a predefined map that cannot be entered: polygons in metres, corners in order, the last joins the first.
///
/// 0 (and any number without a layout) has none; 1 backslash, 2 village, 3 craters, 4 bisected.
pub fn excluded_regions(predefined_map: u8) -> &'static [&'static [[f64; 2]]] {
    match predefined_map {
        1 => BACKSLASH,
        2 => VILLAGE,
        3 => CRATERS,
        4 => BISECTED,
        _ => &[],
    }
}

/// The name of a predefined map.
pub fn name(predefined_map: u8) -> &'static str {
    match predefined_map {
        1 => "backslash",
        2 => "village",
        3 => "craters",
        4 => "bisected",
        _ => "empty",
    }
}

/// A broken ridge from the north-west corner to the south-east one, with two passes.
const BACKSLASH: &[&[[f64; 2]]] = &[
    &[
        [-88.0, 92.0],
        [-72.0, 94.0],
        [-40.0, 56.0],
        [-34.0, 40.0],
        [-46.0, 34.0],
        [-60.0, 52.0],
        [-84.0, 78.0],
    ],
    &[
        [-24.0, 32.0],
        [-10.0, 26.0],
        [4.0, 6.0],
        [22.0, -8.0],
        [20.0, -22.0],
        [6.0, -20.0],
        [-14.0, 4.0],
        [-28.0, 20.0],
    ],
    &[
        [34.0, -28.0],
        [46.0, -32.0],
        [62.0, -54.0],
        [90.0, -76.0],
        [92.0, -90.0],
        [78.0, -92.0],
        [50.0, -66.0],
        [32.0, -42.0],
    ],
    &[[40.0, 46.0], [58.0, 52.0], [62.0, 38.0], [48.0, 30.0]],
    &[
        [-58.0, -40.0],
        [-42.0, -36.0],
        [-38.0, -52.0],
        [-52.0, -60.0],
        [-64.0, -52.0],
    ],
];

/// Twelve houses around a square and two lanes.
const VILLAGE: &[&[[f64; 2]]] = &[
    &[[-80.0, 50.0], [-56.0, 50.0], [-56.0, 74.0], [-80.0, 74.0]],
    &[[-42.0, 54.0], [-22.0, 54.0], [-22.0, 78.0], [-42.0, 78.0]],
    &[
        [16.0, 52.0],
        [48.0, 52.0],
        [48.0, 70.0],
        [30.0, 70.0],
        [30.0, 80.0],
        [16.0, 80.0],
    ],
    &[[62.0, 48.0], [82.0, 48.0], [82.0, 76.0], [62.0, 76.0]],
    &[[-84.0, 8.0], [-60.0, 8.0], [-60.0, 30.0], [-84.0, 30.0]],
    &[
        [60.0, 6.0],
        [84.0, 6.0],
        [84.0, 28.0],
        [72.0, 28.0],
        [72.0, 18.0],
        [60.0, 18.0],
    ],
    &[[-84.0, -34.0], [-58.0, -34.0], [-58.0, -12.0], [-84.0, -12.0]],
    &[[58.0, -36.0], [84.0, -36.0], [84.0, -14.0], [58.0, -14.0]],
    &[[-78.0, -78.0], [-52.0, -78.0], [-52.0, -54.0], [-78.0, -54.0]],
    &[[-38.0, -80.0], [-18.0, -80.0], [-18.0, -52.0], [-38.0, -52.0]],
    &[[14.0, -76.0], [42.0, -76.0], [42.0, -56.0], [14.0, -56.0]],
    &[[58.0, -82.0], [80.0, -82.0], [80.0, -54.0], [58.0, -54.0]],
];

/// Six round pits.
const CRATERS: &[&[[f64; 2]]] = &[
    &[
        [-40.0, 52.0],
        [-46.0, 66.0],
        [-60.0, 72.0],
        [-74.0, 66.0],
        [-80.0, 52.0],
        [-74.0, 38.0],
        [-60.0, 32.0],
        [-46.0, 38.0],
    ],
    &[
        [34.0, 68.0],
        [30.0, 78.0],
        [20.0, 82.0],
        [10.0, 78.0],
        [6.0, 68.0],
        [10.0, 58.0],
        [20.0, 54.0],
        [30.0, 58.0],
    ],
    &[
        [86.0, 24.0],
        [80.0, 38.0],
        [66.0, 44.0],
        [52.0, 38.0],
        [46.0, 24.0],
        [52.0, 10.0],
        [66.0, 4.0],
        [80.0, 10.0],
    ],
    &[
        [-14.0, -26.0],
        [-18.0, -16.0],
        [-28.0, -12.0],
        [-38.0, -16.0],
        [-42.0, -26.0],
        [-38.0, -36.0],
        [-28.0, -40.0],
        [-18.0, -36.0],
    ],
    &[
        [54.0, -58.0],
        [48.0, -42.0],
        [32.0, -36.0],
        [16.0, -42.0],
        [10.0, -58.0],
        [16.0, -74.0],
        [32.0, -80.0],
        [48.0, -74.0],
    ],
    &[
        [-58.0, -70.0],
        [-62.0, -60.0],
        [-72.0, -56.0],
        [-82.0, -60.0],
        [-86.0, -70.0],
        [-82.0, -80.0],
        [-72.0, -84.0],
        [-62.0, -80.0],
    ],
];

/// A wall from west to east with a gate at either third.
const BISECTED: &[&[[f64; 2]]] = &[
    &[[-100.0, -5.0], [-46.0, -5.0], [-46.0, 5.0], [-100.0, 5.0]],
    &[[-28.0, -5.0], [28.0, -5.0], [28.0, 5.0], [-28.0, 5.0]],
    &[[46.0, -5.0], [100.0, -5.0], [100.0, 5.0], [46.0, 5.0]],
    &[[-8.0, 34.0], [8.0, 34.0], [8.0, 62.0], [-8.0, 62.0]],
    &[[-8.0, -62.0], [8.0, -62.0], [8.0, -34.0], [-8.0, -34.0]],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_layout_lies_in_its_arena_and_leaves_the_middle_of_each_side_reachable() {
        for map in 1..=4 {
            assert!(!excluded_regions(map).is_empty(), "{}", name(map));
            for corner in excluded_regions(map).iter().copied().flatten() {
                assert!(corner.iter().all(|c| c.abs() <= 100.0), "{}: {corner:?}", name(map));
            }
        }
    }

    #[test]
    fn a_number_without_a_layout_is_empty() {
        assert!(excluded_regions(0).is_empty() && excluded_regions(9).is_empty());
    }
}

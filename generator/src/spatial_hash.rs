//! [`SpatialHash`]: taken places, and the distance to the nearest of them.

/// Up to this many places are searched one by one; more are sorted into cells.
const FEW: usize = 48;

/// Side of the cells in metres.
const CELL: f64 = 4.0;

/// Cells per side: they cover a square of 300 m around the origin; border cells also hold everything beyond.
const SIDE: i32 = 75;

/// Marks the end of a list.
const NONE: u32 = u32::MAX;

/// Places on the ground.
#[derive(Default)]
pub(crate) struct SpatialHash {
    places: Vec<[f64; 2]>,
    /// Linked lists: for each cell its last place, for each place the previous one in the same cell.
    cells: Option<(Vec<u32>, Vec<u32>)>,
}

impl SpatialHash {
    pub(crate) fn push(&mut self, place: [f64; 2]) {
        self.places.push(place);
        if self.cells.is_some() {
            self.file(self.places.len() - 1);
        } else if self.places.len() > FEW {
            self.cells = Some((vec![NONE; (SIDE * SIDE) as usize], Vec::new()));
            (0..self.places.len()).for_each(|number| self.file(number));
        }
    }

    fn file(&mut self, number: usize) {
        let [x, y] = cell(self.places[number]);
        let Some((cells, before)) = &mut self.cells else { return };
        let head = &mut cells[(y * SIDE + x) as usize];
        before.push(*head);
        *head = number as u32;
    }

    /// Distance to the nearest place, if one is nearer than `reach`.
    pub(crate) fn within(&self, place: [f64; 2], reach: f64) -> Option<f64> {
        self.nearest_within(place, reach).map(|(metres, _)| metres)
    }

    /// The nearest place, if there is one.
    pub(crate) fn nearest(&self, place: [f64; 2]) -> Option<[f64; 2]> {
        let mut reach = CELL;
        while reach < 2000.0 {
            if let Some((_, nearest)) = self.nearest_within(place, reach) {
                return Some(nearest);
            }
            reach *= 2.0;
        }
        None
    }

    fn nearest_within(&self, place: [f64; 2], reach: f64) -> Option<(f64, [f64; 2])> {
        if reach <= 0.0 || self.places.is_empty() {
            return None;
        }
        let mut least = (reach * reach, None);
        let mut look = |other: [f64; 2]| {
            let (dx, dy) = (place[0] - other[0], place[1] - other[1]);
            let squared = dx * dx + dy * dy;
            if squared < least.0 {
                least = (squared, Some(other));
            }
        };
        // No two places of a world are this far apart.
        let span = (reach.min(1000.0) / CELL).ceil() as i32;
        match &self.cells {
            Some((cells, before)) if (2 * i64::from(span) + 1).pow(2) < self.places.len() as i64 * 4 => {
                let [cx, cy] = cell(place);
                for y in (cy - span).max(0)..=(cy + span).min(SIDE - 1) {
                    for x in (cx - span).max(0)..=(cx + span).min(SIDE - 1) {
                        let mut number = cells[(y * SIDE + x) as usize];
                        while number != NONE {
                            look(self.places[number as usize]);
                            number = before[number as usize];
                        }
                    }
                }
            }
            _ => self.places.iter().copied().for_each(look),
        }
        least.1.map(|other| (least.0.sqrt(), other))
    }
}

/// The cell of a place. Border cells also hold everything beyond them: clamping never increases the distance between two cells.
fn cell(place: [f64; 2]) -> [i32; 2] {
    place.map(|metres| ((metres / CELL).floor() as i32 + SIDE / 2).clamp(0, SIDE - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn nearest_agrees_with_linear_search(
            places in prop::collection::vec([-200.0..200.0_f64, -200.0..200.0_f64], 0..200),
            at in [-200.0..200.0_f64, -200.0..200.0_f64],
            reach in 0.0..40.0_f64,
        ) {
            let mut hash = SpatialHash::default();
            for place in &places {
                hash.push(*place);
            }
            let distance = |other: &[f64; 2]| {
                let (dx, dy) = (at[0] - other[0], at[1] - other[1]);
                (dx * dx + dy * dy).sqrt()
            };
            let least = places.iter().map(distance).min_by(f64::total_cmp);
            prop_assert_eq!(hash.within(at, reach), least.filter(|metres| *metres < reach));
            prop_assert_eq!(hash.nearest(at).map(|other| distance(&other)), least);
        }
    }
}

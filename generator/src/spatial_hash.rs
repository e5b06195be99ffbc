//! [`SpatialHash`]: occupied positions, and the distance to the nearest of them.

/// Maximum number of positions that are searched one by one; more are sorted into cells.
const MAX_UNSORTED: usize = 48;

/// Side of the cells in metres.
const CELL: f64 = 4.0;

/// Cells per side: they cover a square of 300 m around the origin; border cells also hold everything beyond.
const SIDE: i32 = 75;

/// Marks the end of a list.
const NONE: u32 = u32::MAX;

/// Positions on the ground.
#[derive(Default)]
pub(crate) struct SpatialHash {
    positions: Vec<[f64; 2]>,
    /// Linked lists: for each cell its last position, for each position the previous one in the same cell.
    cells: Option<(Vec<u32>, Vec<u32>)>,
}

impl SpatialHash {
    pub(crate) fn push(&mut self, position: [f64; 2]) {
        self.positions.push(position);
        if self.cells.is_some() {
            self.add_to_cell(self.positions.len() - 1);
        } else if self.positions.len() > MAX_UNSORTED {
            self.cells = Some((vec![NONE; (SIDE * SIDE) as usize], Vec::new()));
            (0..self.positions.len()).for_each(|number| self.add_to_cell(number));
        }
    }

    fn add_to_cell(&mut self, number: usize) {
        let [x, y] = cell(self.positions[number]);
        let Some((cells, before)) = &mut self.cells else { return };
        let head = &mut cells[(y * SIDE + x) as usize];
        before.push(*head);
        *head = number as u32;
    }

    /// Distance to the nearest position, if one is nearer than `reach`.
    pub(crate) fn within(&self, position: [f64; 2], reach: f64) -> Option<f64> {
        self.nearest_within(position, reach).map(|(metres, _)| metres)
    }

    /// The nearest position, if there is one.
    pub(crate) fn nearest(&self, position: [f64; 2]) -> Option<[f64; 2]> {
        let mut reach = CELL;
        while reach < 2000.0 {
            if let Some((_, nearest)) = self.nearest_within(position, reach) {
                return Some(nearest);
            }
            reach *= 2.0;
        }
        None
    }

    fn nearest_within(&self, position: [f64; 2], reach: f64) -> Option<(f64, [f64; 2])> {
        if reach <= 0.0 || self.positions.is_empty() {
            return None;
        }
        let mut nearest = (reach * reach, None);
        let mut check = |other: [f64; 2]| {
            let (dx, dy) = (position[0] - other[0], position[1] - other[1]);
            let squared = dx * dx + dy * dy;
            if squared < nearest.0 {
                nearest = (squared, Some(other));
            }
        };
        // No two positions in a world are this far apart.
        let span = (reach.min(1000.0) / CELL).ceil() as i32;
        match &self.cells {
            Some((cells, before)) if (2 * i64::from(span) + 1).pow(2) < self.positions.len() as i64 * 4 => {
                let [cx, cy] = cell(position);
                for y in (cy - span).max(0)..=(cy + span).min(SIDE - 1) {
                    for x in (cx - span).max(0)..=(cx + span).min(SIDE - 1) {
                        let mut number = cells[(y * SIDE + x) as usize];
                        while number != NONE {
                            check(self.positions[number as usize]);
                            number = before[number as usize];
                        }
                    }
                }
            }
            _ => self.positions.iter().copied().for_each(check),
        }
        nearest.1.map(|other| (nearest.0.sqrt(), other))
    }
}

/// The cell of a position. Border cells also hold everything beyond them: clamping never increases the distance between two
/// cells.
fn cell(position: [f64; 2]) -> [i32; 2] {
    position.map(|metres| ((metres / CELL).floor() as i32 + SIDE / 2).clamp(0, SIDE - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn nearest_agrees_with_linear_search(
            positions in prop::collection::vec([-200.0..200.0_f64, -200.0..200.0_f64], 0..200),
            at in [-200.0..200.0_f64, -200.0..200.0_f64],
            reach in 0.0..40.0_f64,
        ) {
            let mut hash = SpatialHash::default();
            for position in &positions {
                hash.push(*position);
            }
            let distance = |other: &[f64; 2]| {
                let (dx, dy) = (at[0] - other[0], at[1] - other[1]);
                (dx * dx + dy * dy).sqrt()
            };
            let nearest = positions.iter().map(distance).min_by(f64::total_cmp);
            prop_assert_eq!(hash.within(at, reach), nearest.filter(|metres| *metres < reach));
            prop_assert_eq!(hash.nearest(at).map(|other| distance(&other)), nearest);
        }
    }
}

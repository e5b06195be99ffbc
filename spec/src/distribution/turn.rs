//! Points that a group takes in turn: which one an object takes if its own is not free, and whether there are enough.

use std::collections::HashMap;

use super::{Distribution, Order};

/// Maximum number of places to try for one object.
const MAX_TRIES: usize = 1000;

/// Maximum number of tries when checking whether a group fits; beyond that, only sampling decides.
const MAX_CHECKED: usize = 200_000;

/// Tracks the places that the objects of one group around one anchor have taken, for a `points` or `grid` taken in turn.
///
/// Object number `n` of a group has place `n` of the list, starting over after the last. If it is not free, the object takes
/// the next free one, in the order of the list and wrapping around; a place that another object has taken in this round is not
/// free. At most 1,000 places are tried per object.
///
/// # Example
/// ```
/// use driftworld_spec::Turns;
/// let mut turns = Turns::new(3);
/// let first = turns.candidates(0).find(|place| *place != 0).unwrap();
/// turns.take(0, first);
/// assert_eq!(turns.candidates(1).collect::<Vec<_>>(), [2, 0], "place 1 is taken");
/// ```
#[derive(Clone, Debug)]
pub struct Turns {
    places: usize,
    /// Number of objects at each place; `None` as long as every object has taken its own place.
    taken: Option<Vec<u32>>,
}

impl Turns {
    /// Starts with this number of free places, at least 1.
    pub fn new(places: usize) -> Self {
        Self {
            places: places.max(1),
            taken: None,
        }
    }

    /// The places to try for an object, in order.
    pub fn candidates(&self, number: u64) -> impl Iterator<Item = usize> + '_ {
        let places = self.places as u64;
        let (own, round) = ((number % places) as usize, number / places);
        let free = move |place: &usize| match &self.taken {
            // All earlier objects took their own places: in this round, those before this object's.
            None => *place >= own,
            Some(taken) => u64::from(taken[*place]) <= round,
        };
        (own..self.places).chain(0..own).filter(free).take(MAX_TRIES)
    }

    /// Records that object `number` takes a place; all earlier objects must have taken theirs.
    pub fn take(&mut self, number: u64, place: usize) {
        let places = self.places as u64;
        if self.taken.is_none() && place as u64 == number % places {
            return;
        }
        let taken = self.taken.get_or_insert_with(|| {
            let before = |place: u64| (number / places + u64::from(place < number % places)) as u32;
            (0..places).map(before).collect()
        });
        taken[place] += 1;
    }
}

impl Distribution {
    /// The number of places, if they are taken in turn; `None` for every other distribution.
    pub fn num_turns(&self) -> Option<usize> {
        match self {
            Self::Points {
                values,
                order: Order::Turn,
            } => Some(values.len()),
            Self::Grid {
                columns,
                rows,
                order: Order::Turn,
                ..
            } => Some(*columns as usize * *rows as usize),
            _ => None,
        }
    }

    /// Place `number` of a `points` or `grid`, in metres; `None` if places are random.
    fn fixed_place(&self, number: usize) -> Option<[f64; 2]> {
        match self {
            Self::Points { values, .. } => values.get(number).copied(),
            Self::Grid {
                low,
                high,
                columns,
                rows,
                jitter,
                ..
            } if jitter.unwrap_or(0.0) == 0.0 => {
                let (column, row) = (number as u64 % *columns as u64, number as u64 / *columns as u64);
                let axis = |k: usize, cell: u64, count: f64| low[k] + (high[k] - low[k]) * (cell as f64 + 0.5) / count;
                Some([axis(0, column, *columns), axis(1, row, *rows)])
            }
            _ => None,
        }
    }

    /// How many of `count` objects find a place in turn in an empty arena, at least `separation` metres apart; `None` if that
    /// is random, or takes too long to compute.
    pub(crate) fn room_in_turn(&self, count: u64, separation: f64) -> Option<u64> {
        let places = self.num_turns()?;
        self.fixed_place(0)?;
        if separation <= 0.0 {
            return Some(count);
        }
        let (mut turns, mut field) = (Turns::new(places), Field::new(separation));
        let mut checked = 0;
        for number in 0..count {
            let candidates = turns.candidates(number).inspect(|_| checked += 1);
            let free = candidates
                .filter_map(|place| Some((place, self.fixed_place(place)?)))
                .find(|(_, at)| !field.is_near(*at));
            let Some((place, at)) = free else { return Some(number) };
            if checked > MAX_CHECKED {
                return None;
            }
            field.push(at);
            turns.take(number, place);
        }
        Some(count)
    }
}

/// Points sorted into square cells with the required distance as their side.
struct Field {
    separation: f64,
    cells: HashMap<[i64; 2], Vec<[f64; 2]>>,
}

impl Field {
    fn new(separation: f64) -> Self {
        Self {
            separation,
            cells: HashMap::new(),
        }
    }

    fn cell(&self, at: [f64; 2]) -> [i64; 2] {
        at.map(|metres| (metres / self.separation).floor() as i64)
    }

    fn push(&mut self, at: [f64; 2]) {
        self.cells.entry(self.cell(at)).or_default().push(at);
    }

    /// Whether another point is nearer than the required distance.
    fn is_near(&self, [x, y]: [f64; 2]) -> bool {
        let [column, row] = self.cell([x, y]);
        let around = (-1..=1).flat_map(|a| (-1..=1).map(move |b| [column.saturating_add(a), row.saturating_add(b)]));
        let near = |[a, b]: &[f64; 2]| ((a - x) * (a - x) + (b - y) * (b - y)).sqrt() < self.separation;
        around.filter_map(|cell| self.cells.get(&cell)).flatten().any(near)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The rule in its simplest form: the number of objects at each place.
    struct Plain(Vec<u64>);

    impl Plain {
        fn take(&mut self, number: u64, blocked: &[bool]) -> Option<usize> {
            let places = self.0.len();
            let own = number as usize % places;
            let candidates = (0..places).map(|step| (own + step) % places);
            let place = candidates
                .filter(|place| self.0[*place] <= number / places as u64)
                .find(|place| !blocked[*place])?;
            self.0[place] += 1;
            Some(place)
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn objects_take_their_own_place_or_the_next_free_one(
            blocked in prop::collection::vec(any::<bool>(), 1..30), count in 0_u64..70,
        ) {
            let (mut turns, mut plain) = (Turns::new(blocked.len()), Plain(vec![0; blocked.len()]));
            for number in 0..count {
                let place = turns.candidates(number).find(|place| !blocked[*place]);
                prop_assert_eq!(place, plain.take(number, &blocked));
                let Some(place) = place else { break };
                turns.take(number, place);
            }
        }

        #[test]
        fn room_agrees_with_a_plain_search(
            points in prop::collection::vec([-4_i32..4, -4..4], 1..12), count in 0_u64..16, separation in 0.0_f64..3.0,
        ) {
            let values: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::from)).collect();
            let far = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]) >= separation;
            let (mut taken, mut places): (Vec<[f64; 2]>, _) = (Vec::new(), Plain(vec![0; values.len()]));
            let mut room = 0;
            for number in 0..count {
                let blocked: Vec<bool> =
                    values.iter().map(|at| separation > 0.0 && !taken.iter().all(|other| far(*at, *other))).collect();
                let Some(place) = places.take(number, &blocked) else { break };
                taken.push(values[place]);
                room += 1;
            }
            let list = Distribution::Points { values, order: Order::Turn };
            prop_assert_eq!(list.room_in_turn(count, separation), Some(room));
        }
    }

    #[test]
    fn grid_has_room_for_its_cells_and_no_more() {
        let grid = |jitter| Distribution::Grid {
            low: [-6.0, -4.0],
            high: [6.0, 4.0],
            columns: 3.0,
            rows: 2.0,
            jitter,
            order: Order::Turn,
        };
        assert_eq!(grid(None).room_in_turn(6, 4.0), Some(6));
        assert_eq!(grid(None).room_in_turn(7, 4.0), Some(6));
        assert_eq!(grid(None).room_in_turn(6, 4.5), Some(3), "every other cell");
        assert_eq!(grid(None).room_in_turn(60, 0.0), Some(60), "objects may overlap");
        assert_eq!(
            grid(Some(0.5)).room_in_turn(7, 4.0),
            None,
            "jitter makes positions random"
        );
    }
}

//! [`Tour`]: a round of items in an array, changed by reversing stretches, with undo.

/// A closed round. Every change is a series of reversed stretches, logged for undo until [`Tour::keep`].
pub(super) struct Tour {
    items: Vec<u32>,
    places: Vec<u32>,
    turned: Vec<(usize, usize)>,
}

impl Tour {
    /// The round through the items in this order, each of `0..items.len()` once.
    pub(super) fn new(items: impl Iterator<Item = usize>) -> Self {
        let items: Vec<u32> = items.map(|item| item as u32).collect();
        let mut places = vec![0; items.len()];
        for (place, item) in items.iter().enumerate() {
            places[*item as usize] = place as u32;
        }
        let turned = Vec::new();
        Self { items, places, turned }
    }

    pub(super) fn len(&self) -> usize {
        self.items.len()
    }

    /// The place of an item.
    pub(super) fn place(&self, item: usize) -> usize {
        self.places[item] as usize
    }

    /// The item at a place; places beyond the last wrap around.
    pub(super) fn at(&self, place: usize) -> usize {
        self.items[self.wrapped(place)] as usize
    }

    pub(super) fn next(&self, item: usize) -> usize {
        self.at(self.place(item) + 1)
    }

    pub(super) fn before(&self, item: usize) -> usize {
        self.at(self.place(item) + self.len() - 1)
    }

    /// Number of items from one to another, both included, going forwards.
    pub(super) fn span(&self, from: usize, to: usize) -> usize {
        self.wrapped(self.place(to) + self.len() - self.place(from)) + 1
    }

    /// Reverses the stretch from one item forwards to another, or the rest of the round, which is equivalent and may be
    /// shorter.
    pub(super) fn turn_between(&mut self, from: usize, to: usize) {
        let inside = self.span(from, to);
        if 2 * inside <= self.len() {
            self.turn(self.place(from), inside);
        } else {
            self.turn(self.place(to) + 1, self.len() - inside);
        }
    }

    /// Moves the `length` items from `start` forwards to between `x` and the item after it, reversed if `turned`.
    pub(super) fn move_stretch(&mut self, start: usize, length: usize, x: usize, turned: bool) {
        let (n, start) = (self.len(), self.place(start));
        let over = self.wrapped(self.place(x) + 2 * n - (start + length) % n) + 1;
        let others = n - length - over;
        // Forwards over one side, or backwards over the other: the round is the same.
        let (begin, now_at) = if over <= others {
            self.turn(start, length + over);
            self.turn(start, over);
            (start + over, length)
        } else {
            let begin = start + n - others;
            self.turn(begin, others + length);
            self.turn(begin + length, others);
            (begin, length)
        };
        if !turned {
            self.turn(begin, now_at);
        }
    }

    /// Swaps two adjacent stretches.
    pub(super) fn swap_stretches(&mut self, start: usize, first: usize, second: usize) {
        self.turn(start, first + second);
        self.turn(start, second);
        self.turn(start + second, first);
    }

    /// Keeps all changes.
    pub(super) fn keep(&mut self) {
        self.turned.clear();
    }

    /// Undoes all changes since the last [`Tour::keep`].
    pub(super) fn take_back(&mut self) {
        while let Some((start, length)) = self.turned.pop() {
            self.turn_in_place(start, length);
        }
    }

    fn turn(&mut self, start: usize, length: usize) {
        let start = self.wrapped(start);
        self.turned.push((start, length));
        self.turn_in_place(start, length);
    }

    fn turn_in_place(&mut self, start: usize, length: usize) {
        let n = self.len();
        let (mut low, mut high) = (start, self.wrapped(start + length + n - 1));
        for _ in 0..length / 2 {
            let (a, b) = (self.items[low], self.items[high]);
            (self.items[low], self.items[high]) = (b, a);
            (self.places[a as usize], self.places[b as usize]) = (high as u32, low as u32);
            low = if low + 1 == n { 0 } else { low + 1 };
            high = if high == 0 { n - 1 } else { high - 1 };
        }
    }

    fn wrapped(&self, place: usize) -> usize {
        let n = self.len();
        let mut place = place;
        while place >= n {
            place -= n;
        }
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The round from item 0 on, in the direction of its lower neighbour.
    fn round(tour: &Tour) -> Vec<usize> {
        let mut items = vec![0];
        let forwards = tour.next(0) < tour.before(0);
        while items.len() < tour.len() {
            let here = items[items.len() - 1];
            items.push(if forwards { tour.next(here) } else { tour.before(here) });
        }
        items
    }

    fn check(expected: &[usize], change: impl Fn(&mut Tour)) {
        // The start of the array does not affect the round.
        for shift in 0..8 {
            let mut tour = Tour::new((0..8).map(|k| (k + shift) % 8));
            change(&mut tour);
            assert_eq!(round(&tour), expected, "begun at {shift}");
            tour.take_back();
            assert_eq!(round(&tour), [0, 1, 2, 3, 4, 5, 6, 7], "taken back, begun at {shift}");
        }
    }

    #[test]
    fn stretches_are_reversed_on_either_side() {
        check(&[0, 1, 4, 3, 2, 5, 6, 7], |tour| tour.turn_between(2, 4));
        check(&[0, 1, 4, 3, 2, 5, 6, 7], |tour| tour.turn_between(5, 1));
        check(&[0, 1, 7, 6, 5, 4, 3, 2], |tour| tour.turn_between(2, 7));
    }

    #[test]
    fn stretches_move_over_either_side() {
        check(&[0, 3, 4, 1, 2, 5, 6, 7], |tour| tour.move_stretch(1, 2, 4, false));
        check(&[0, 3, 4, 2, 1, 5, 6, 7], |tour| tour.move_stretch(1, 2, 4, true));
        check(&[0, 3, 4, 5, 6, 1, 2, 7], |tour| tour.move_stretch(1, 2, 6, false));
        check(&[0, 2, 1, 3, 4, 5, 6, 7], |tour| tour.move_stretch(2, 1, 0, false));
        check(&[0, 3, 2, 1, 4, 5, 6, 7], |tour| tour.move_stretch(2, 2, 0, true));
    }

    #[test]
    fn adjacent_stretches_swap() {
        check(&[0, 3, 4, 1, 2, 5, 6, 7], |tour| {
            tour.swap_stretches(tour.place(1), 2, 2);
        });
        check(&[0, 2, 3, 4, 1, 5, 6, 7], |tour| {
            tour.swap_stretches(tour.place(1), 1, 3);
        });
    }
}

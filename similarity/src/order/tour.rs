//! [`Tour`]: a closed tour of items in an array, changed by reversing stretches, with undo.

/// A closed tour. Every change is a series of reversed stretches, logged for undo until [`Tour::commit`].
pub(super) struct Tour {
    items: Vec<u32>,
    index_of: Vec<u32>,
    log: Vec<(usize, usize)>,
}

impl Tour {
    /// The tour through the items in this order, each of `0..items.len()` once.
    pub(super) fn new(items: impl Iterator<Item = usize>) -> Self {
        let items: Vec<u32> = items.map(|item| item as u32).collect();
        let mut index_of = vec![0; items.len()];
        for (position, item) in items.iter().enumerate() {
            index_of[*item as usize] = position as u32;
        }
        let log = Vec::new();
        Self { items, index_of, log }
    }

    pub(super) fn len(&self) -> usize {
        self.items.len()
    }

    /// The position of an item.
    pub(super) fn position(&self, item: usize) -> usize {
        self.index_of[item] as usize
    }

    /// The item at a position; positions beyond the last wrap around.
    pub(super) fn at(&self, position: usize) -> usize {
        self.items[self.wrapped(position)] as usize
    }

    pub(super) fn next(&self, item: usize) -> usize {
        self.at(self.position(item) + 1)
    }

    pub(super) fn before(&self, item: usize) -> usize {
        self.at(self.position(item) + self.len() - 1)
    }

    /// Number of items from one to another, both included, going forwards.
    pub(super) fn span(&self, from: usize, to: usize) -> usize {
        self.wrapped(self.position(to) + self.len() - self.position(from)) + 1
    }

    /// Reverses the stretch from one item forwards to another, or the rest of the round, which is equivalent and may be
    /// shorter.
    pub(super) fn reverse_between(&mut self, from: usize, to: usize) {
        let inside = self.span(from, to);
        if 2 * inside <= self.len() {
            self.reverse(self.position(from), inside);
        } else {
            self.reverse(self.position(to) + 1, self.len() - inside);
        }
    }

    /// Moves the `length` items from `start` forwards to between `x` and the item after it, reversed if `turned`.
    pub(super) fn move_stretch(&mut self, start: usize, length: usize, x: usize, turned: bool) {
        let (n, start) = (self.len(), self.position(start));
        let over = self.wrapped(self.position(x) + 2 * n - (start + length) % n) + 1;
        let others = n - length - over;
        // Forwards over one side, or backwards over the other: the round is the same.
        let (begin, now_at) = if over <= others {
            self.reverse(start, length + over);
            self.reverse(start, over);
            (start + over, length)
        } else {
            let begin = start + n - others;
            self.reverse(begin, others + length);
            self.reverse(begin + length, others);
            (begin, length)
        };
        if !turned {
            self.reverse(begin, now_at);
        }
    }

    /// Swaps two adjacent stretches.
    pub(super) fn swap_stretches(&mut self, start: usize, first: usize, second: usize) {
        self.reverse(start, first + second);
        self.reverse(start, second);
        self.reverse(start + second, first);
    }

    /// Keeps all changes.
    pub(super) fn commit(&mut self) {
        self.log.clear();
    }

    /// Undoes all changes since the last [`Tour::commit`].
    pub(super) fn undo(&mut self) {
        while let Some((start, length)) = self.log.pop() {
            self.reverse_in_place(start, length);
        }
    }

    fn reverse(&mut self, start: usize, length: usize) {
        let start = self.wrapped(start);
        self.log.push((start, length));
        self.reverse_in_place(start, length);
    }

    fn reverse_in_place(&mut self, start: usize, length: usize) {
        let n = self.len();
        let (mut low, mut high) = (start, self.wrapped(start + length + n - 1));
        for _ in 0..length / 2 {
            let (a, b) = (self.items[low], self.items[high]);
            (self.items[low], self.items[high]) = (b, a);
            (self.index_of[a as usize], self.index_of[b as usize]) = (high as u32, low as u32);
            low = if low + 1 == n { 0 } else { low + 1 };
            high = if high == 0 { n - 1 } else { high - 1 };
        }
    }

    fn wrapped(&self, position: usize) -> usize {
        let n = self.len();
        let mut position = position;
        while position >= n {
            position -= n;
        }
        position
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The round starting at item 0, in the direction of its lower neighbour.
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
            assert_eq!(round(&tour), expected, "starting at {shift}");
            tour.undo();
            assert_eq!(round(&tour), [0, 1, 2, 3, 4, 5, 6, 7], "undone, starting at {shift}");
        }
    }

    #[test]
    fn stretches_are_reversed_on_either_side() {
        check(&[0, 1, 4, 3, 2, 5, 6, 7], |tour| tour.reverse_between(2, 4));
        check(&[0, 1, 4, 3, 2, 5, 6, 7], |tour| tour.reverse_between(5, 1));
        check(&[0, 1, 7, 6, 5, 4, 3, 2], |tour| tour.reverse_between(2, 7));
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
            tour.swap_stretches(tour.position(1), 2, 2);
        });
        check(&[0, 2, 3, 4, 1, 5, 6, 7], |tour| {
            tour.swap_stretches(tour.position(1), 1, 3);
        });
    }
}

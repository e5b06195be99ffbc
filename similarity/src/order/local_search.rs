//! Local search for a cheap path: small improvements until none helps, then random shakes. The caller passes in the costs of
//! steps, so the same search finds short, long and even paths.
//!
//! The moves are 2-opt (reverse a stretch) and Or-opt (move up to three items in a row), tried only towards near items (Bentley
//! 1992), and only from items near a recent change (don't-look bits). A shake swaps two short stretches, and is undone unless
//! the search then finds a cheaper path.

use rayon::prelude::*;

use super::items::Ends;
use super::tour::Tour;
use crate::split_mix::SplitMix64;

/// Number of nearest items towards which a move is tried.
const NEIGHBOURS: usize = 10;
/// Maximum length of a stretch that a shake moves.
const MAX_SHAKEN_LENGTH: usize = 50;

/// A path no costlier than `path`, with the same fixed ends. Costs must not be negative.
///
/// Time about `O(n² + shakes · √n)`, memory `O(n)`.
pub(super) fn improve(
    path: Vec<usize>,
    cost: &(impl Fn(usize, usize) -> f64 + Sync),
    ends: Ends,
    shakes: usize,
) -> Vec<usize> {
    if path.len() < 3 {
        return path;
    }
    let mut search = Search::new(path, cost, ends);
    search.settle();
    search.tour.commit();
    search.shake(shakes);
    search.path(ends)
}

struct Search<'a, C> {
    tour: Tour,
    cost: &'a C,
    /// The cost of ending the path at an item: the tour is closed by a gap, which is item number `n`.
    gap: Vec<f64>,
    neighbours: Vec<Vec<u32>>,
    waiting: Vec<usize>,
    is_waiting: Vec<bool>,
    /// The smallest gain that is not a rounding error.
    least_gain: f64,
}

impl<'a, C: Fn(usize, usize) -> f64 + Sync> Search<'a, C> {
    fn new(path: Vec<usize>, cost: &'a C, ends: Ends) -> Self {
        let n = path.len();
        let nearest: Vec<(f64, Vec<u32>)> = (0..n).into_par_iter().map(|item| nearest(n, item, cost)).collect();
        let largest = nearest.iter().map(|(largest, _)| *largest).fold(0.0, f64::max);
        let mut gap = vec![0.0; n + 1];
        // Moving a fixed end costs more than any move can gain, so fixed ends stay in place.
        for end in [ends.first, ends.last].into_iter().flatten() {
            gap[end] = -4.0 * largest - 1.0;
        }
        let waiting: Vec<usize> = path.iter().rev().copied().collect();
        Self {
            tour: Tour::new(path.into_iter().chain([n])),
            cost,
            gap,
            neighbours: nearest.into_iter().map(|(_, list)| list).collect(),
            waiting,
            is_waiting: vec![true; n + 1],
            least_gain: 1e-11 * largest,
        }
    }

    fn cost(&self, a: usize, b: usize) -> f64 {
        let n = self.gap.len() - 1;
        if a == n {
            self.gap[b]
        } else if b == n {
            self.gap[a]
        } else {
            (self.cost)(a, b)
        }
    }

    fn wake(&mut self, items: &[usize]) {
        for item in items {
            if !self.is_waiting[*item] {
                self.is_waiting[*item] = true;
                self.waiting.push(*item);
            }
        }
    }

    /// Makes improving moves until there are none. Returns the total gain.
    fn settle(&mut self) -> f64 {
        let mut gained = 0.0;
        while let Some(item) = self.waiting.pop() {
            self.is_waiting[item] = false;
            while let Some(gain) = self.change_at(item) {
                gained += gain;
            }
        }
        gained
    }

    /// Makes one improving move that brings `a` next to a nearer item, if there is one; returns its gain.
    fn change_at(&mut self, a: usize) -> Option<f64> {
        // Moves at the gap are found from the items.
        if a + 1 == self.gap.len() {
            return None;
        }
        for forwards in [true, false] {
            let b = self.neighbour(a, forwards);
            let now = self.cost(a, b);
            for k in 0..self.neighbours[a].len() {
                let c = self.neighbours[a][k] as usize;
                let then = self.cost(a, c);
                if then >= now {
                    break;
                }
                let change = self.turn(a, b, c, forwards).or_else(|| self.move_to(a, b, c, forwards));
                if change.is_some() {
                    return change;
                }
            }
        }
        None
    }

    fn neighbour(&self, item: usize, forwards: bool) -> usize {
        if forwards {
            self.tour.next(item)
        } else {
            self.tour.before(item)
        }
    }

    /// 2-opt: `a b … c d` becomes `a c … b d`.
    fn turn(&mut self, a: usize, b: usize, c: usize, forwards: bool) -> Option<f64> {
        let d = self.neighbour(c, forwards);
        let gain = self.cost(a, b) + self.cost(c, d) - self.cost(a, c) - self.cost(b, d);
        if gain <= self.least_gain {
            return None;
        }
        if forwards {
            self.tour.reverse_between(b, c);
        } else {
            self.tour.reverse_between(a, d);
        }
        self.wake(&[a, b, c, d]);
        Some(gain)
    }

    /// Or-opt: `b a … s p` becomes `b p`, and the stretch from `a` to `s` goes between `c` and an item `e` beside it.
    fn move_to(&mut self, a: usize, b: usize, c: usize, forwards: bool) -> Option<f64> {
        let mut s = a;
        for length in 1..=3 {
            let p = self.neighbour(s, !forwards);
            if p == b || s == c {
                return None;
            }
            let freed = self.cost(a, b) + self.cost(s, p) - self.cost(p, b) - self.cost(a, c);
            for after in [true, false] {
                let e = self.neighbour(c, after);
                let inside = |item: usize| self.distance_back(a, item, forwards) < length;
                if inside(c) || inside(e) {
                    continue;
                }
                let gain = freed + self.cost(c, e) - self.cost(s, e);
                if gain > self.least_gain {
                    let (start, x) = (if forwards { s } else { a }, if after { c } else { e });
                    // The stretch begins at `start` in the tour; it must begin with `a` if `c` comes before it.
                    self.tour.move_stretch(start, length, x, (start == a) != after);
                    self.wake(&[a, b, c, e, s, p]);
                    return Some(gain);
                }
            }
            s = p;
        }
        None
    }

    /// Number of steps from `a` back to `item`, on the side opposite to `b`.
    fn distance_back(&self, a: usize, item: usize, forwards: bool) -> usize {
        let span = if forwards {
            self.tour.span(item, a)
        } else {
            self.tour.span(a, item)
        };
        span - 1
    }

    /// Swaps random short stretches, and keeps those swaps after which the search finds a cheaper path.
    fn shake(&mut self, shakes: usize) {
        let round = self.tour.len();
        if round < 8 {
            return;
        }
        let max_length = MAX_SHAKEN_LENGTH.min((round - 2) / 2) as u64;
        let mut rng = SplitMix64(0);
        for _ in 0..shakes {
            let start = rng.below(round as u64) as usize;
            let (first, second) = (1 + rng.below(max_length) as usize, 1 + rng.below(max_length) as usize);
            let [a, b, c, d, e, f] =
                [0, 1, first, first + 1, first + second, first + second + 1].map(|step| self.tour.at(start + step));
            let lost = self.cost(a, d) + self.cost(e, b) + self.cost(c, f)
                - self.cost(a, b)
                - self.cost(c, d)
                - self.cost(e, f);
            self.tour.swap_stretches(start + 1, first, second);
            self.wake(&[a, b, c, d, e, f]);
            if self.settle() - lost > self.least_gain {
                self.tour.commit();
            } else {
                self.tour.undo();
            }
        }
    }

    /// The items of the closed tour after its gap, in the direction required by the fixed ends.
    fn path(&self, ends: Ends) -> Vec<usize> {
        let n = self.gap.len() - 1;
        let begin = self.tour.position(n) + 1;
        let mut path: Vec<usize> = (0..n).map(|step| self.tour.at(begin + step)).collect();
        if ends.first.is_some_and(|first| path[0] != first) || ends.last.is_some_and(|last| path[n - 1] != last) {
            path.reverse();
        }
        path
    }
}

/// The largest cost at an item, and its neighbours, nearest first: the gap, then items.
fn nearest(n: usize, item: usize, cost: &impl Fn(usize, usize) -> f64) -> (f64, Vec<u32>) {
    let mut all: Vec<(f64, u32)> = (0..n)
        .filter(|other| *other != item)
        .map(|other| (cost(item, other), other as u32))
        .collect();
    let largest = all.iter().map(|(cost, _)| *cost).fold(0.0, f64::max);
    let order = |a: &(f64, u32), b: &(f64, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    if all.len() > NEIGHBOURS {
        all.select_nth_unstable_by(NEIGHBOURS, order);
        all.truncate(NEIGHBOURS);
    }
    all.sort_unstable_by(order);
    let list = [n as u32].into_iter().chain(all.into_iter().map(|(_, other)| other));
    (largest, list.collect())
}

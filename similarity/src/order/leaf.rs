//! Optimal leaf ordering: a clustering's leaves in that order, of all that its tree allows, whose neighbours are nearest. The
//! clustering itself is in `linkage.rs`.

use std::ops::Range;

use rayon::prelude::*;

use super::items::Items;
use super::linkage::{Join, average};
use super::two_opt::from_the_lower_end;
use crate::SimilarityError;

/// The most items whose leaves are ordered; it takes `O(n³)` time, and memory for three more matrices.
pub const MAX_LEAVES: usize = 3_000;

/// Source: Bar-Joseph, Gifford and Jaakkola 2001; same lengths as `scipy.cluster.hierarchy.optimal_leaf_ordering` within 1e-9.
pub(super) fn order(items: &Items) -> Result<Vec<usize>, SimilarityError> {
    let n = items.len();
    if n > MAX_LEAVES {
        return Err(SimilarityError::TooManyForMethod {
            method: "leaf",
            found: n,
            limit: MAX_LEAVES,
        });
    }
    if n == 1 {
        return Ok(vec![0]);
    }
    let tree = Tree::new(&average(items), items);
    let best = tree.best_lengths();
    let place = |rank: usize| tree.items.iter().position(|item| *item == rank);
    let (first, last) = (items.ends.first.and_then(place), items.ends.last.and_then(place));
    let may = |fixed: Option<usize>, leaf: usize| fixed.is_none_or(|fixed| fixed == leaf);
    let (left, right) = tree.halves(tree.root());
    let mut ends: Option<(f64, usize, usize)> = None;
    for (a, b) in [(left.clone(), right.clone()), (right, left)] {
        for start in a.filter(|leaf| may(first, *leaf)) {
            for end in b.clone().filter(|leaf| may(last, *leaf)) {
                let found = best[start * n + end];
                if ends.is_none_or(|(least, ..)| found < least) {
                    ends = Some((found, start, end));
                }
            }
        }
    }
    let Some((_, start, end)) = ends else {
        // Every leaf can be turned to one end, but two of one half of the tree not to both.
        return Err(SimilarityError::CannotFixEnds {
            method: "leaf",
            end: "last",
            label: items.label(items.ends.last.unwrap_or(0)).to_owned(),
        });
    };
    let path = tree.path(&best, start, end).into_iter().map(|leaf| tree.items[leaf]);
    Ok(from_the_lower_end(path.collect(), items))
}

/// A clustering whose leaves are numbered from left to right, so that every group is a range of them.
struct Tree {
    /// The item at each leaf.
    items: Vec<usize>,
    /// Each group's first leaf, that of its right half, and the one after its last; leaves, which have no halves, come first.
    groups: Vec<[usize; 3]>,
    /// The two parts of each group, by number.
    parts: Vec<[usize; 2]>,
    /// Distances between leaves, `(n, n)`.
    gaps: Vec<f64>,
}

impl Tree {
    fn new(joins: &[Join], items: &Items) -> Self {
        let n = items.len();
        let mut groups = vec![[0; 3]; 2 * n - 1];
        let mut sizes = vec![1; 2 * n - 1];
        let mut parts = vec![[0; 2]; 2 * n - 1];
        for (index, join) in joins.iter().enumerate() {
            sizes[n + index] = sizes[join.left] + sizes[join.right];
            parts[n + index] = [join.left, join.right];
        }
        let mut leaf_items = vec![0; n];
        for group in (0..2 * n - 1).rev() {
            let begin = groups[group][0];
            groups[group][2] = begin + sizes[group];
            if group < n {
                leaf_items[begin] = group;
                continue;
            }
            let [left, right] = parts[group];
            let middle = begin + sizes[left];
            groups[group][1] = middle;
            (groups[left][0], groups[right][0]) = (begin, middle);
        }
        let gaps = (0..n * n)
            .map(|k| items.gap(leaf_items[k / n], leaf_items[k % n]))
            .collect();
        Self {
            items: leaf_items,
            groups,
            parts,
            gaps,
        }
    }

    fn len(&self) -> usize {
        self.items.len()
    }

    fn root(&self) -> usize {
        self.groups.len() - 1
    }

    fn halves(&self, group: usize) -> (Range<usize>, Range<usize>) {
        let [begin, middle, end] = self.groups[group];
        (begin..middle, middle..end)
    }

    /// The leaves that can stand at the far end of a group's order when `leaf` stands at its near one.
    fn opposite(&self, group: usize, leaf: usize) -> Range<usize> {
        if group < self.len() {
            return leaf..leaf + 1;
        }
        let (left, right) = self.halves(group);
        if left.contains(&leaf) { right } else { left }
    }

    /// For each two leaves the least length of their smallest common group with them at its ends, `(n, n)`.
    fn best_lengths(&self) -> Vec<f64> {
        let n = self.len();
        let mut best = vec![0.0; n * n];
        for group in n..self.groups.len() {
            let [left, right] = self.parts[group];
            let (starts, ends) = self.halves(group);
            let rows: Vec<Vec<f64>> = starts
                .clone()
                .into_par_iter()
                .map(|start| {
                    let mut reached = vec![f64::INFINITY; ends.len()];
                    for k in ends.clone() {
                        let over = self.over(&best, left, start, k).0;
                        for end in self.opposite(right, k) {
                            let length = over + best[k * n + end];
                            reached[end - ends.start] = reached[end - ends.start].min(length);
                        }
                    }
                    reached
                })
                .collect();
            for (start, row) in starts.zip(rows) {
                for (end, length) in ends.clone().zip(row) {
                    (best[start * n + end], best[end * n + start]) = (length, length);
                }
            }
        }
        best
    }

    /// The least length from `start` through its group and over to `k`, and the leaf of the group before `k`.
    fn over(&self, best: &[f64], group: usize, start: usize, k: usize) -> (f64, usize) {
        let n = self.len();
        let mut least = (f64::INFINITY, start);
        for m in self.opposite(group, start) {
            let length = best[start * n + m] + self.gaps[k * n + m];
            if length < least.0 {
                least = (length, m);
            }
        }
        least
    }

    /// All leaves in the best order with these ends.
    fn path(&self, best: &[f64], start: usize, end: usize) -> Vec<usize> {
        let n = self.len();
        let mut path = Vec::with_capacity(n);
        let mut stack = vec![(self.root(), start, end)];
        while let Some((group, start, end)) = stack.pop() {
            if group < n {
                path.push(start);
                continue;
            }
            let [left, right] = self.parts[group];
            let (a, b) = if self.halves(group).0.contains(&start) {
                (left, right)
            } else {
                (right, left)
            };
            let mut joint = (f64::INFINITY, start, end);
            for k in self.opposite(b, end) {
                let (length, m) = self.over(best, a, start, k);
                if length + best[k * n + end] < joint.0 {
                    joint = (length + best[k * n + end], m, k);
                }
            }
            stack.push((b, joint.2, end));
            stack.push((a, start, joint.1));
        }
        path
    }
}

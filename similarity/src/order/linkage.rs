//! Clustering by average linkage: which items and groups join, one pair after the other. Turning the tree is in `leaf.rs`.

use super::items::Items;

/// Two groups that became one. Numbers below `n` are items; `n + k` is the group that the `k`-th join made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Join {
    pub(super) left: usize,
    pub(super) right: usize,
    pub(super) distance: f64,
}

/// All `n - 1` joins, the nearest first; the distance of two groups is the mean over their pairs. Time and memory `O(n²)`, by
/// chains of nearest neighbours (Murtagh 1983). Of equal distances the groups with the first names join.
pub(super) fn average(items: &Items) -> Vec<Join> {
    let n = items.len();
    let mut distances: Vec<f64> = (0..n * n).map(|k| items.gap(k / n, k % n)).collect();
    let mut sizes = vec![1.0; n];
    let mut alive: Vec<usize> = (0..n).collect();
    let mut chain: Vec<usize> = Vec::new();
    // Each pair by the slots of its groups; the numbers come when all are sorted.
    let mut pairs: Vec<(f64, usize, usize)> = Vec::with_capacity(n.saturating_sub(1));
    while alive.len() > 1 {
        if chain.is_empty() {
            chain.push(alive[0]);
        }
        let here = chain[chain.len() - 1];
        let before = chain.len().checked_sub(2).map(|place| chain[place]);
        let mut nearest = before.unwrap_or(usize::MAX);
        let mut least = before.map_or(f64::INFINITY, |before| distances[here * n + before]);
        for other in alive.iter().filter(|other| **other != here) {
            if distances[here * n + other] < least {
                (nearest, least) = (*other, distances[here * n + other]);
            }
        }
        if before != Some(nearest) {
            chain.push(nearest);
            continue;
        }
        chain.truncate(chain.len() - 2);
        let (keep, gone) = (here.min(nearest), here.max(nearest));
        pairs.push((least, keep, gone));
        for other in alive.iter().filter(|other| **other != keep && **other != gone) {
            let mean = (sizes[keep] * distances[keep * n + other] + sizes[gone] * distances[gone * n + other])
                / (sizes[keep] + sizes[gone]);
            (distances[keep * n + other], distances[other * n + keep]) = (mean, mean);
        }
        sizes[keep] += sizes[gone];
        alive.retain(|slot| *slot != gone);
    }
    numbered(pairs, n)
}

/// Sorts the pairs by distance and gives their groups numbers.
fn numbered(mut pairs: Vec<(f64, usize, usize)>, n: usize) -> Vec<Join> {
    // Stable: a group is made before it is joined, even where both happen at one distance.
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut number: Vec<usize> = (0..n).collect();
    let mut joins = Vec::with_capacity(pairs.len());
    for (index, (distance, keep, gone)) in pairs.into_iter().enumerate() {
        let (left, right) = (number[keep], number[gone]);
        joins.push(Join { left, right, distance });
        number[keep] = n + index;
    }
    joins
}

//! A walk round the minimum spanning tree, at most twice as long as the shortest path: for true metrics only.

use super::items::{Ends, Items};
use crate::SimilarityError;

/// The most items for which a matrix that does not say so is checked for being a metric.
const MAX_CHECKED: usize = 2_000;

/// The shortest of the walks from the fixed first item, or from every item, that go down the tree and take the nearest branch
/// first. A fixed last item is left out on the way and met at the end. Time `O(n²)`.
///
/// Source: Rosenkrantz, Stearns and Lewis 1977; with both ends fixed, Hoogeveen 1991.
pub(super) fn order(items: &Items) -> Result<Vec<usize>, SimilarityError> {
    require_metric(items)?;
    let branches = branches(&parents(items), items);
    let starts = match items.ends.first {
        Some(first) => first..first + 1,
        None => 0..items.len(),
    };
    let length = |path: &[usize]| -> f64 { path.windows(2).map(|pair| items.gap(pair[0], pair[1])).sum() };
    let mut best: Option<(f64, Vec<usize>)> = None;
    for start in starts.filter(|start| Some(*start) != items.ends.last) {
        let path = walk(&branches, start, items.ends);
        let found = length(&path);
        if best.as_ref().is_none_or(|(least, _)| found < least * (1.0 - 1e-12)) {
            best = Some((found, path));
        }
    }
    Ok(best.map(|(_, path)| path).unwrap_or_default())
}

/// The largest distance in the minimum spanning tree; 0 for a single item.
pub(super) fn largest_branch(items: &Items) -> f64 {
    let parents = parents(items);
    (1..items.len())
        .map(|item| items.gap(parents[item], item))
        .fold(0.0, f64::max)
}

fn require_metric(items: &Items) -> Result<(), SimilarityError> {
    let matrix = items.matrix;
    if matrix.properties().keeps_triangles() {
        return Ok(());
    }
    if matrix.len() > MAX_CHECKED {
        return Err(SimilarityError::NotCheckedAsMetric {
            method: "tree",
            found: matrix.len(),
            limit: MAX_CHECKED,
        });
    }
    match matrix.triangle_violations().worst {
        None => Ok(()),
        Some(worst) => {
            let label = |index: usize| matrix.labels()[index].clone();
            Err(SimilarityError::NotAMetric {
                method: "tree",
                a: label(worst.a),
                b: label(worst.b),
                by: label(worst.by),
                straight: worst.straight,
                detour: worst.detour,
            })
        }
    }
}

/// Prim's algorithm from item 0: for each item the one that it hangs from. Of equal branches the lower numbers are taken.
fn parents(items: &Items) -> Vec<usize> {
    let n = items.len();
    let mut parents = vec![0; n];
    let mut reach: Vec<f64> = (0..n).map(|item| items.gap(0, item)).collect();
    let mut left: Vec<usize> = (1..n).collect();
    while !left.is_empty() {
        let mut best = 0;
        for place in 1..left.len() {
            if reach[left[place]] < reach[left[best]] {
                best = place;
            }
        }
        let here = left.remove(best);
        for item in &left {
            let gap = items.gap(here, *item);
            if gap < reach[*item] {
                (reach[*item], parents[*item]) = (gap, here);
            }
        }
    }
    parents
}

/// For each item those that it is joined to, the nearest first.
fn branches(parents: &[usize], items: &Items) -> Vec<Vec<usize>> {
    let mut branches = vec![Vec::new(); parents.len()];
    for (item, parent) in parents.iter().enumerate().skip(1) {
        branches[item].push(*parent);
        branches[*parent].push(item);
    }
    for (item, list) in branches.iter_mut().enumerate() {
        list.sort_by(|a, b| items.gap(item, *a).total_cmp(&items.gap(item, *b)).then(a.cmp(b)));
    }
    branches
}

/// Every item when it is first met, but for the fixed last; the branch that holds that one is entered last.
fn walk(branches: &[Vec<usize>], start: usize, ends: Ends) -> Vec<usize> {
    let towards = ends.last.map(|last| way(branches, start, last)).unwrap_or_default();
    let mut path = Vec::with_capacity(branches.len());
    let mut stack = vec![(start, start)];
    while let Some((item, from)) = stack.pop() {
        if Some(item) != ends.last {
            path.push(item);
        }
        let others = branches[item].iter().filter(|next| **next != from);
        let (held, free): (Vec<usize>, Vec<usize>) = others.partition(|next| towards.contains(next));
        stack.extend(held.into_iter().chain(free.into_iter().rev()).map(|next| (next, item)));
    }
    path.extend(ends.last);
    path
}

/// The items on the way through the tree from one to another.
fn way(branches: &[Vec<usize>], start: usize, goal: usize) -> Vec<usize> {
    let mut came_from = vec![usize::MAX; branches.len()];
    let mut stack = vec![start];
    came_from[start] = start;
    while let Some(item) = stack.pop() {
        for next in &branches[item] {
            if came_from[*next] == usize::MAX {
                came_from[*next] = item;
                stack.push(*next);
            }
        }
    }
    let mut way = vec![goal];
    while way[way.len() - 1] != start {
        way.push(came_from[way[way.len() - 1]]);
    }
    way
}

//! Orders of items by their distances: paths that are short, and one that is long on purpose.

use std::str::FromStr;

use serde::Serialize;

use crate::{DistanceMatrix, SimilarityError};

/// The most items for which the shortest path is searched exactly.
pub const MAX_EXACT: usize = 13;

/// How items are put into an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Each time the nearest that is left. Simple, and often far from the shortest.
    Nearest,
    /// The shortest path, by dynamic programming (Held and Karp 1962). For up to 13 items.
    Exact,
    /// Nearest, then stretches are turned round as long as that shortens the path (2-opt).
    TwoOpt,
    /// Each time the farthest that is left: neighbours unlike each other.
    Contrast,
}

impl Method {
    /// Exact where that is possible, 2-opt beyond.
    pub fn default_for(items: usize) -> Self {
        if items <= MAX_EXACT { Self::Exact } else { Self::TwoOpt }
    }

    /// The word by which the command line calls it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::Exact => "exact",
            Self::TwoOpt => "two-opt",
            Self::Contrast => "contrast",
        }
    }
}

impl FromStr for Method {
    type Err = SimilarityError;

    fn from_str(word: &str) -> Result<Self, SimilarityError> {
        let all = [Self::Nearest, Self::Exact, Self::TwoOpt, Self::Contrast];
        let found = all.into_iter().find(|method| method.name() == word);
        found.ok_or_else(|| SimilarityError::UnknownMethod { found: word.to_owned() })
    }
}

/// Items in an order, and how far each step goes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ordering {
    /// The items, by their index in the matrix.
    pub indices: Vec<usize>,
    /// The distance from each item to the next: one fewer than items.
    pub steps: Vec<f64>,
    /// The sum of the steps.
    pub length: f64,
}

impl Ordering {
    /// The items in this order, measured.
    pub fn given(matrix: &DistanceMatrix, indices: Vec<usize>) -> Self {
        let steps: Vec<f64> = indices.windows(2).map(|pair| matrix.get(pair[0], pair[1])).collect();
        Self {
            length: steps.iter().sum(),
            indices,
            steps,
        }
    }

    /// The largest step; 0 if there is none.
    pub fn largest_step(&self) -> f64 {
        self.steps.iter().copied().fold(0.0, f64::max)
    }

    /// The mean step; 0 if there is none.
    pub fn mean_step(&self) -> f64 {
        if self.steps.is_empty() {
            0.0
        } else {
            self.length / self.steps.len() as f64
        }
    }
}

/// Puts items into an order. With a `start` the path begins there, otherwise wherever it turns out best; of equal paths the
/// one whose labels come first is taken, so the same matrix always gives the same order.
///
/// # Errors
/// [`SimilarityError::Empty`], [`SimilarityError::NoSuchStart`], [`SimilarityError::TooManyForExact`].
///
/// # Example
/// ```
/// use driftworld_similarity::{DistanceMatrix, Method, SimilarityError, order};
/// let at = [0.0_f64, 5.0, 1.0];
/// let names = ["a", "b", "c"].map(String::from).to_vec();
/// let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, SimilarityError>((at[a] - at[b]).abs()))?;
/// assert_eq!(order(&matrix, Method::Exact, Some(0))?.indices, [0, 2, 1]);
/// # Ok::<(), SimilarityError>(())
/// ```
pub fn order(matrix: &DistanceMatrix, method: Method, start: Option<usize>) -> Result<Ordering, SimilarityError> {
    let n = matrix.len();
    if n == 0 {
        return Err(SimilarityError::Empty);
    }
    if let Some(found) = start.filter(|start| *start >= n) {
        return Err(SimilarityError::NoSuchStart { found, last: n - 1 });
    }
    if method == Method::Exact {
        return if n <= MAX_EXACT {
            Ok(exact(matrix, start))
        } else {
            Err(SimilarityError::TooManyForExact {
                found: n,
                limit: MAX_EXACT,
            })
        };
    }
    // From each start in the order of labels, so that ties fall to the label that comes first.
    let mut starts: Vec<usize> = start.map_or_else(|| (0..n).collect(), |start| vec![start]);
    starts.sort_by(|a, b| matrix.labels()[*a].cmp(&matrix.labels()[*b]));
    let paths = starts.into_iter().map(|first| {
        let walk = Ordering::given(matrix, greedy(matrix, first, method == Method::Contrast));
        if method == Method::TwoOpt {
            two_opt(matrix, walk, start.is_some())
        } else {
            walk
        }
    });
    let better = |best: &Ordering, next: &Ordering| match method {
        Method::Contrast => next.length > best.length,
        _ => next.length < best.length,
    };
    Ok(paths
        .reduce(|best, next| if better(&best, &next) { next } else { best })
        .expect("there is at least one start"))
}

fn greedy(matrix: &DistanceMatrix, first: usize, farthest: bool) -> Vec<usize> {
    let mut left: Vec<usize> = (0..matrix.len()).filter(|item| *item != first).collect();
    left.sort_by(|a, b| matrix.labels()[*a].cmp(&matrix.labels()[*b]));
    let mut path = vec![first];
    let mut here = first;
    while !left.is_empty() {
        let rank = |item: &usize| {
            if farthest {
                -matrix.get(here, *item)
            } else {
                matrix.get(here, *item)
            }
        };
        let next = (0..left.len())
            .min_by(|a, b| rank(&left[*a]).total_cmp(&rank(&left[*b])))
            .expect("some item is left");
        here = left.remove(next);
        path.push(here);
    }
    path
}

/// Turns stretches round while that shortens the path. With `anchored` the first item stays first.
fn two_opt(matrix: &DistanceMatrix, path: Ordering, anchored: bool) -> Ordering {
    let mut indices = path.indices;
    let n = indices.len();
    let gap = |a: Option<&usize>, b: Option<&usize>| a.zip(b).map_or(0.0, |(a, b)| matrix.get(*a, *b));
    let mut shorter = true;
    while shorter {
        shorter = false;
        for i in usize::from(anchored)..n {
            for j in i + 1..n {
                let before = i.checked_sub(1).and_then(|k| indices.get(k));
                let after = indices.get(j + 1);
                let now = gap(before, indices.get(i)) + gap(indices.get(j), after);
                let turned = gap(before, indices.get(j)) + gap(indices.get(i), after);
                if turned < now - 1e-12 {
                    indices[i..=j].reverse();
                    shorter = true;
                }
            }
        }
    }
    Ordering::given(matrix, indices)
}

/// Held and Karp: the shortest path through every set of items that ends at each of them.
fn exact(matrix: &DistanceMatrix, start: Option<usize>) -> Ordering {
    let n = matrix.len();
    // Items by label: of equal paths that with the lower numbers is kept.
    let mut items: Vec<usize> = (0..n).collect();
    items.sort_by(|a, b| matrix.labels()[*a].cmp(&matrix.labels()[*b]));
    let gap = |a: usize, b: usize| matrix.get(items[a], items[b]);
    let mut best = vec![(f64::INFINITY, usize::MAX); (1 << n) * n];
    for last in 0..n {
        if start.is_none_or(|start| items[last] == start) {
            best[(1 << last) * n + last] = (0.0, usize::MAX);
        }
    }
    for set in 1..1_usize << n {
        for last in (0..n).filter(|last| set >> last & 1 == 1) {
            let (length, _) = best[set * n + last];
            if length == f64::INFINITY {
                continue;
            }
            for next in (0..n).filter(|next| set >> next & 1 == 0) {
                let to = &mut best[(set | 1 << next) * n + next];
                if length + gap(last, next) < to.0 {
                    *to = (length + gap(last, next), last);
                }
            }
        }
    }
    let full = (1 << n) - 1;
    let end = (0..n)
        .min_by(|a, b| best[full * n + a].0.total_cmp(&best[full * n + b].0))
        .expect("there is at least one item");
    let (mut set, mut last) = (full, end);
    let mut path = Vec::with_capacity(n);
    loop {
        path.push(items[last]);
        let before = best[set * n + last].1;
        set &= !(1 << last);
        if before == usize::MAX {
            break;
        }
        last = before;
    }
    path.reverse();
    // A path is as long backwards: let it begin with the label that comes first.
    if start.is_none() && matrix.labels()[path[n - 1]] < matrix.labels()[path[0]] {
        path.reverse();
    }
    Ordering::given(matrix, path)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn matrix(points: &[[f64; 2]]) -> DistanceMatrix {
        let labels = (0..points.len()).map(|k| format!("{k:03}")).collect();
        let distance = |a: usize, b: usize| (points[a][0] - points[b][0]).hypot(points[a][1] - points[b][1]);
        DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>(distance(a, b))).unwrap()
    }

    fn points(most: usize) -> impl Strategy<Value = Vec<[f64; 2]>> {
        prop::collection::vec(prop::array::uniform2(0.0..10.0), 1..most)
    }

    /// Length of the shortest path, by trying all.
    fn brute_force(matrix: &DistanceMatrix, path: &mut Vec<usize>, start: Option<usize>) -> f64 {
        if path.len() == matrix.len() {
            return Ordering::given(matrix, path.clone()).length;
        }
        let mut least = f64::INFINITY;
        for item in 0..matrix.len() {
            if !path.contains(&item) && (!path.is_empty() || start.is_none_or(|start| start == item)) {
                path.push(item);
                least = least.min(brute_force(matrix, path, start));
                path.pop();
            }
        }
        least
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        #[test]
        fn exact_is_as_short_as_any(points in points(7), anchored in any::<bool>()) {
            let matrix = matrix(&points);
            let start = anchored.then_some(points.len() - 1);
            let found = order(&matrix, Method::Exact, start).unwrap();
            prop_assert!((found.length - brute_force(&matrix, &mut Vec::new(), start)).abs() < 1e-9);
            prop_assert!(start.is_none_or(|start| found.indices[0] == start));
        }

        #[test]
        fn every_method_visits_each_item_once(points in points(12), anchored in any::<bool>()) {
            let matrix = matrix(&points);
            let start = anchored.then_some(0);
            let length = |method| order(&matrix, method, start).unwrap().length;
            for method in [Method::Nearest, Method::Exact, Method::TwoOpt, Method::Contrast] {
                let found = order(&matrix, method, start).unwrap();
                let mut sorted = found.indices.clone();
                sorted.sort_unstable();
                prop_assert_eq!(sorted, (0..points.len()).collect::<Vec<_>>());
                prop_assert_eq!(&found, &order(&matrix, method, start).unwrap());
            }
            prop_assert!(length(Method::Exact) <= length(Method::TwoOpt) + 1e-9);
            prop_assert!(length(Method::TwoOpt) <= length(Method::Nearest) + 1e-9);
            prop_assert!(length(Method::Exact) <= length(Method::Contrast) + 1e-9);
        }
    }

    #[test]
    fn what_cannot_be_ordered_says_why() {
        let matrix = matrix(&[[0.0, 0.0]; 14]);
        let said = |found: Result<Ordering, SimilarityError>| found.unwrap_err().to_string();
        assert_eq!(
            said(order(&matrix, Method::Exact, None)),
            "exact order: found 14 items, expected at most 13; use the method two-opt"
        );
        assert_eq!(
            said(order(&matrix, Method::Nearest, Some(14))),
            "order: found start 14, expected one of 0 to 13"
        );
        assert_eq!(
            said(order(&super::tests::matrix(&[]), Method::Nearest, None)),
            "order: found no items, expected at least 1"
        );
        assert!("farthest".parse::<Method>().is_err());
    }
}

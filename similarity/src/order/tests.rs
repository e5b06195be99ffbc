//! Properties of all methods, and comparisons with brute force.

use super::*;
use crate::split_mix::SplitMix64;
use proptest::prelude::*;

fn matrix(points: &[[f64; 2]]) -> DistanceMatrix {
    let labels = (0..points.len()).map(|k| format!("{k:03}")).collect();
    let distance = |a: usize, b: usize| libm::hypot(points[a][0] - points[b][0], points[a][1] - points[b][1]);
    DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>(distance(a, b))).unwrap()
}

fn points(max_count: usize) -> impl Strategy<Value = Vec<[f64; 2]>> {
    prop::collection::vec(prop::array::uniform2(0.0..10.0), 1..max_count)
}

fn options(points: &[[f64; 2]], fixed: [bool; 2]) -> OrderOptions {
    OrderOptions {
        first: fixed[0].then_some(points.len() - 1),
        last: (fixed[1] && points.len() > 1).then_some(0),
        seed: 3,
        target_step: Some(2.0),
    }
}

fn with_last(options: OrderOptions, last: usize) -> OrderOptions {
    OrderOptions {
        last: Some(last),
        ..options
    }
}

/// The minimum value over all paths with the fixed ends, by brute force.
fn least(matrix: &DistanceMatrix, options: &OrderOptions, value: &impl Fn(&Ordering) -> f64) -> f64 {
    fn extend(
        matrix: &DistanceMatrix,
        options: &OrderOptions,
        value: &impl Fn(&Ordering) -> f64,
        path: &mut Vec<usize>,
    ) -> f64 {
        let n = matrix.len();
        if path.len() == n {
            let keeps = options.first.is_none_or(|first| path[0] == first)
                && options.last.is_none_or(|last| path[n - 1] == last);
            return if keeps {
                value(&Ordering::given(matrix, path.clone()))
            } else {
                f64::INFINITY
            };
        }
        let mut least = f64::INFINITY;
        for item in 0..n {
            if !path.contains(&item) {
                path.push(item);
                least = least.min(extend(matrix, options, value, path));
                path.pop();
            }
        }
        least
    }
    extend(matrix, options, value, &mut Vec::new())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(8, 48)))]

    #[test]
    fn exact_methods_match_brute_force(points in points(7), fixed in any::<[bool; 2]>()) {
        let matrix = matrix(&points);
        let options = options(&points, fixed);
        let found = |method| order(&matrix, method, &options).unwrap();
        let near = |found: f64, least: f64| (found - least).abs() < 1e-9;
        let deviation = |path: &Ordering| path.steps.iter().map(|step| (step - 2.0).abs()).sum::<f64>();
        prop_assert!(near(found(Method::Exact).length, least(&matrix, &options, &|path| path.length)));
        prop_assert!(near(-found(Method::Abrupt).length, least(&matrix, &options, &|path| -path.length)));
        prop_assert!(near(deviation(&found(Method::TargetStep)), least(&matrix, &options, &deviation)));
        let gradual = found(Method::Gradual);
        let shortest = least(&matrix, &options, &|path| path.length);
        prop_assert!(near(gradual.length, shortest));
        let short = |path: &Ordering| if path.length <= shortest + 1e-9 { path.largest_step() } else { f64::INFINITY };
        prop_assert!(near(gradual.largest_step(), least(&matrix, &options, &short)));
    }

    #[test]
    fn every_method_visits_each_item_once_and_keeps_the_ends(points in points(24), fixed in any::<[bool; 2]>()) {
        let matrix = matrix(&points);
        let options = options(&points, fixed);
        for &method in Method::ALL {
            let found = match order(&matrix, method, &options) {
                Ok(found) => found,
                Err(SimilarityError::TooManyForMethod { .. }) => {
                    prop_assert!(method == Method::Exact && points.len() > MAX_EXACT);
                    continue;
                }
                Err(error) => return Err(TestCaseError::fail(error.to_string())),
            };
            let mut sorted = found.indices.clone();
            sorted.sort_unstable();
            prop_assert_eq!(sorted, (0..points.len()).collect::<Vec<_>>(), "{:?}", method);
            prop_assert!(options.first.is_none_or(|first| found.indices[0] == first), "{:?}", method);
            prop_assert!(options.last.is_none_or(|last| found.indices[points.len() - 1] == last), "{:?}", method);
            prop_assert_eq!(&found, &order(&matrix, method, &options).unwrap());
        }
    }

    #[test]
    fn lengths_compare_as_the_methods_promise(points in points(MAX_EXACT + 1), fixed in any::<[bool; 2]>()) {
        let matrix = matrix(&points);
        let options = options(&points, fixed);
        let length = |method| order(&matrix, method, &options).unwrap().length;
        let exact = length(Method::Exact);
        prop_assert!(exact <= length(Method::TwoOpt) + 1e-9);
        prop_assert!(length(Method::TwoOpt) <= length(Method::Nearest) + 1e-9);
        prop_assert!(length(Method::Nearest) <= length(Method::Abrupt) + 1e-9);
    }

    /// The order of items in the matrix does not matter: only names and distances do.
    #[test]
    fn reordered_matrix_gives_the_same_order(points in points(20), shift in 0_usize..20) {
        let n = points.len();
        let moved: Vec<usize> = (0..n).map(|k| (k + shift) % n).collect();
        let matrix = matrix(&points);
        let labels = moved.iter().map(|index| matrix.labels()[*index].clone()).collect();
        let other = DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>(matrix.get(moved[a], moved[b]))).unwrap();
        let options = OrderOptions { target_step: Some(2.0), ..OrderOptions::default() };
        for &method in Method::ALL.iter().filter(|method| **method != Method::Given) {
            if method == Method::Exact && n > MAX_EXACT {
                continue;
            }
            let here = order(&matrix, method, &options).unwrap();
            let there = order(&other, method, &options).unwrap();
            let there: Vec<usize> = there.indices.iter().map(|index| moved[*index]).collect();
            prop_assert_eq!(here.indices, there, "{:?}", method);
        }
    }
}

/// Items on a line: only one order makes all similar items neighbours.
#[test]
fn methods_for_similar_neighbours_find_the_line() {
    let at = [3.0, 9.0, 0.0, 5.5, 1.0, 7.0, 2.2, 14.0];
    let line: Vec<[f64; 2]> = at.iter().map(|x| [*x, 0.0]).collect();
    let matrix = matrix(&line);
    let expected = [2, 4, 6, 0, 3, 5, 1, 7];
    for method in [Method::Nearest, Method::Exact, Method::TwoOpt, Method::Gradual] {
        let found = order(&matrix, method, &OrderOptions::default()).unwrap();
        let backwards: Vec<usize> = found.indices.iter().rev().copied().collect();
        assert!(
            found.indices == expected || backwards == expected,
            "{method:?}: {found:?}"
        );
        assert_eq!(found.length, 14.0);
    }
}

#[test]
fn farthest_always_takes_the_farthest_remaining_item() {
    let line: Vec<[f64; 2]> = [0.0, 1.0, 4.0, 10.0].iter().map(|x| [*x, 0.0]).collect();
    let found = |options: OrderOptions| order(&matrix(&line), Method::Farthest, &options).unwrap().indices;
    assert_eq!(found(OrderOptions::default()), [0, 3, 2, 1]);
    assert_eq!(found(OrderOptions::default().with_first(1)), [1, 3, 2, 0]);
    assert_eq!(found(with_last(OrderOptions::default(), 3)), [0, 2, 1, 3]);
}

#[test]
fn random_orders_depend_on_the_seed_and_given_keeps_the_order() {
    let matrix = matrix(&[[0.0, 0.0]; 9]);
    let random = |seed| {
        let options = OrderOptions {
            seed,
            ..OrderOptions::default()
        };
        order(&matrix, Method::Random, &options).unwrap().indices
    };
    assert_eq!(random(7), random(7));
    assert_ne!(random(7), random(8));
    let given = |options: OrderOptions| order(&matrix, Method::Given, &options).unwrap().indices;
    assert_eq!(given(OrderOptions::default()), [0, 1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(
        given(with_last(OrderOptions::default().with_first(4), 0)),
        [4, 1, 2, 3, 5, 6, 7, 8, 0]
    );
}

/// Between equal items all paths are equal: then the names decide.
#[test]
fn ties_go_to_the_first_names() {
    let matrix = matrix(&[[0.0, 0.0]; 9]);
    let options = OrderOptions {
        target_step: Some(1.0),
        ..OrderOptions::default()
    };
    for &method in Method::ALL.iter().filter(|method| **method != Method::Random) {
        let found = order(&matrix, method, &options).unwrap();
        assert_eq!(found.indices, [0, 1, 2, 3, 4, 5, 6, 7, 8], "{method:?}");
    }
}

#[test]
fn impossible_orders_are_refused_with_a_reason() {
    let message = |matrix: &DistanceMatrix, method, options: &OrderOptions| {
        order(matrix, method, options).unwrap_err().to_string()
    };
    let many = matrix(&[[0.0, 0.0]; 16]);
    let free = OrderOptions::default();
    assert_eq!(
        message(&many, Method::Exact, &free),
        "method exact: found 16 items, expected at most 15; use the method two-opt"
    );
    assert_eq!(
        message(&many, Method::Nearest, &free.with_first(16)),
        "order: found 16 as the first item, expected one of 0 to 15"
    );
    assert_eq!(
        message(&many, Method::Nearest, &with_last(free.with_first(2), 2)),
        "order: found \"002\" as the first item and as the last, expected two different ones"
    );
    assert_eq!(
        message(&matrix(&[]), Method::Nearest, &free),
        "order: found no items, expected at least 1"
    );
    assert_eq!(
        message(&many, Method::TargetStep, &free),
        "method target-step: found none as the target step, expected a finite number of at least 0"
    );
}

/// Random points in the unit square, the same as in `tests/oracle/make_orders.py`.
fn drawn(seed: u64, count: usize) -> DistanceMatrix {
    let mut rng = SplitMix64(seed);
    let points: Vec<[f64; 2]> = (0..count).map(|_| [rng.unit(), rng.unit()]).collect();
    matrix(&points)
}

fn golden() -> serde_json::Value {
    serde_json::from_str(include_str!("../../tests/oracle/orders.json")).unwrap()
}

/// OR-Tools' routing, run for at least half a minute, is the reference; the search must come within 6 % of it.
#[test]
fn thousand_items_come_within_six_percent_of_a_routing_library() {
    let golden = golden()["routing"]["length"].as_f64().unwrap();
    let found = order(&drawn(1, 1000), Method::TwoOpt, &OrderOptions::default()).unwrap();
    assert!(found.length <= 1.06 * golden, "{} for {golden}", found.length);
}

#[test]
fn every_method_orders_the_largest_possible_distances() {
    for n in [3, 4, 40] {
        let labels = (0..n).map(|k| format!("{k:03}")).collect();
        let far = |_, _| Ok::<_, SimilarityError>(crate::MAX_DISTANCE);
        let matrix = DistanceMatrix::measure(labels, far).unwrap();
        for &method in Method::ALL {
            let options = OrderOptions {
                target_step: Some(2.0),
                ..OrderOptions::default()
            };
            match order(&matrix, method, &options) {
                Ok(found) => assert!(
                    (found.length / ((n - 1) as f64 * crate::MAX_DISTANCE) - 1.0).abs() < 1e-9,
                    "{method:?}"
                ),
                Err(error) => assert!(n > MAX_EXACT && method == Method::Exact, "{method:?}: {error}"),
            }
        }
    }
}

#[test]
fn single_item_has_length_0_not_minus_0() {
    let matrix = matrix(&[[1.0, 1.0]]);
    let found = order(&matrix, Method::Exact, &OrderOptions::default()).unwrap();
    assert_eq!(found.length.to_string(), "0");
}

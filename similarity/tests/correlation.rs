//! Compares correlations and the Mantel test with scipy, scikit-bio and a full enumeration; the expected
//! numbers come from `oracle/make_correlation.py`.

use driftworld_similarity::{
    Correlation, DistanceMatrix, MantelTest, PairValue, SimilarityError, mantel, pearson, spearman,
};
use serde_json::Value;

fn golden() -> Value {
    serde_json::from_str(include_str!("oracle/correlation.json")).expect("the golden file is JSON")
}

fn cases<'a>(golden: &'a Value, topic: &str) -> &'a [Value] {
    golden[topic].as_array().expect("each topic is a list")
}

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

fn matrix(value: &Value) -> DistanceMatrix {
    let rows: Vec<Vec<f64>> = value.as_array().expect("rows").iter().map(numbers).collect();
    let labels = (0..rows.len()).map(|k| format!("item {k}")).collect();
    DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>(rows[a][b])).expect("the distances are valid")
}

fn method(case: &Value) -> Correlation {
    case["method"].as_str().expect("a word").parse().expect("a correlation")
}

#[test]
fn correlations_match_scipy() {
    for case in cases(&golden(), "correlations") {
        let (a, b) = (numbers(&case["a"]), numbers(&case["b"]));
        let near = |found: f64, name: &str| {
            let expected = number(&case[name]);
            assert!((found - expected).abs() < 1e-12, "{name}: {found}, expected {expected}");
        };
        near(spearman(&a, &b).expect("the lists are valid"), "spearman");
        near(pearson(&a, &b).expect("the lists are valid"), "pearson");
    }
}

/// The shares equal those of a full enumeration exactly, also with missing and one-way pairs.
#[test]
fn exact_shares_match_an_enumeration() {
    for case in cases(&golden(), "enumerated") {
        let pairs = case["pairs"].as_array().expect("pairs").iter().map(|pair| PairValue {
            from: number(&pair[0]) as usize,
            to: number(&pair[1]) as usize,
            value: number(&pair[2]),
        });
        let pairs: Vec<PairValue> = pairs.collect();
        let found = mantel(&matrix(&case["distances"]), &pairs, method(case), 720, 0).expect("the pairs are valid");
        let name = format!("{} {}", case["description"], case["method"]);
        assert!(
            (found.correlation - number(&case["correlation"])).abs() < 1e-12,
            "{name}"
        );
        assert!(found.exact, "{name}");
        let count = number(&case["count"]);
        for (share, key) in [
            (found.p_two_sided, "far"),
            (found.p_less, "low"),
            (found.p_greater, "high"),
        ] {
            assert_eq!(share, number(&case[key]) / count, "{name}: {key}");
        }
    }
}

/// Random shares vary: two shares of 19,999 draws are within 0.02 of each other in all but one case of 10,000.
#[test]
fn drawn_shares_approximate_scikit_bio() {
    for case in cases(&golden(), "drawn") {
        let other = matrix(&case["b"]);
        let all = (0..other.len()).flat_map(|from| (from + 1..other.len()).map(move |to| (from, to)));
        let pairs = all.map(|(from, to)| PairValue {
            from,
            to,
            value: other.get(from, to),
        });
        let pairs: Vec<PairValue> = pairs.collect();
        let found: MantelTest =
            mantel(&matrix(&case["a"]), &pairs, method(case), 19_999, 5).expect("the pairs are valid");
        assert!((found.correlation - number(&case["correlation"])).abs() < 1e-12);
        assert!(!found.exact);
        for (share, key) in [
            (found.p_two_sided, "p_two_sided"),
            (found.p_less, "p_less"),
            (found.p_greater, "p_greater"),
        ] {
            assert!(
                (share - number(&case[key])).abs() < 0.02,
                "{key}: {share}, expected {}",
                case[key]
            );
        }
    }
}

//! Distances between placements: where each object may be placed, the minimum distance between objects, and whether a list
//! of points is used in turn.

use driftworld_spec::{Distribution, Order};

use super::measured::Measured;
use super::planar_transport::{planar_wasserstein_1, planar_wasserstein_2};
use super::values::grid_centres;

/// Maximum number of objects compared one by one if points are used in turn.
const MAX_IN_TURN: usize = 10_000;

/// Wasserstein-1 between the positions of objects; otherwise as [`placement_wasserstein_2`].
pub fn placement_wasserstein_1(a: &Distribution, b: &Distribution) -> Option<Measured> {
    placement_distance(a, b, planar_wasserstein_1)
}

/// The distance between two placements of a group, in metres: how far each object has to move (root mean
/// square), plus the difference between the minimum distances that objects keep.
///
/// If both draw each object's position independently, this is [`planar_wasserstein_2`] plus the difference of the distances
/// that `poisson_disc` keeps. If one uses its points in turn, the first object is compared with the first, the second with the
/// second and so on, by the mean and the spread of where each may be placed; so a list of points used in turn differs from the
/// same list used at random. A pseudometric in `0..`, whose first part is a metric. `None` if either draws no points.
///
/// # Example
/// ```
/// use driftworld_similarity::distribution::placement_wasserstein_2;
/// use driftworld_spec::Distribution::PoissonDisc;
/// let kept = |distance: f64| PoissonDisc { low: [0.0; 2], high: [40.0; 2], distance };
/// assert_eq!(placement_wasserstein_2(&kept(1.0), &kept(10.0)).unwrap().value, 9.0);
/// ```
pub fn placement_wasserstein_2(a: &Distribution, b: &Distribution) -> Option<Measured> {
    placement_distance(a, b, planar_wasserstein_2)
}

fn placement_distance(
    a: &Distribution,
    b: &Distribution,
    independent: impl Fn(&Distribution, &Distribution) -> Option<Measured>,
) -> Option<Measured> {
    let in_turn = [a, b].map(places_in_turn);
    let places = match (&in_turn[0], &in_turn[1]) {
        (None, None) => independent(a, b)?,
        (Some(x), Some(y)) => {
            let objects = common_round(x.len(), y.len());
            let pairs = (0..objects).map(|k| (x[k % x.len()], y[k % y.len()]));
            Measured::closed(root_mean(pairs.map(|(x, y)| squared(x, y)), objects))
        }
        (Some(x), None) => one_in_turn(x, b)?,
        (None, Some(y)) => one_in_turn(y, a)?,
    };
    Some(Measured {
        value: places.value + (min_distance(a) - min_distance(b)).abs(),
        ..places
    })
}

/// The distance between a list of points and one distribution: exact, because each point is compared alone.
fn one_in_turn(places: &[[f64; 2]], drawn: &Distribution) -> Option<Measured> {
    let moments = drawn.planar_moments()?;
    let spread = moments.covariance[0][0] + moments.covariance[1][1];
    let all = places.iter().map(|place| squared(*place, moments.mean) + spread);
    Some(Measured::closed(root_mean(all, places.len())))
}

fn root_mean(all: impl Iterator<Item = f64>, count: usize) -> f64 {
    (all.sum::<f64>() / count as f64).sqrt()
}

fn squared(a: [f64; 2], b: [f64; 2]) -> f64 {
    let [x, y] = [a[0] - b[0], a[1] - b[1]];
    x * x + y * y
}

/// The number of objects after which both lists start again together, at most [`MAX_IN_TURN`].
fn common_round(a: usize, b: usize) -> usize {
    let (mut divisor, mut rest) = (a, b);
    while rest > 0 {
        (divisor, rest) = (rest, divisor % rest);
    }
    (a / divisor).saturating_mul(b).min(MAX_IN_TURN)
}

/// The points that objects use in turn, cells by their centres; `None` if each object draws its own.
fn places_in_turn(distribution: &Distribution) -> Option<Vec<[f64; 2]>> {
    match distribution {
        Distribution::Points {
            values,
            order: Order::Turn,
        } => Some(values.clone()),
        Distribution::Grid {
            low,
            high,
            columns,
            rows,
            order: Order::Turn,
            ..
        } => Some(grid_centres(*low, *high, [*columns, *rows]).collect()),
        _ => None,
    }
}

/// The minimum distance, in metres, that the distribution keeps between objects; for a mixture, the mean.
fn min_distance(distribution: &Distribution) -> f64 {
    match distribution {
        Distribution::PoissonDisc { distance, .. } => *distance,
        Distribution::Mixture { parts, weights } => {
            let weight = |part: usize| weights.as_ref().map_or(1.0, |weights| weights[part]);
            let all: f64 = (0..parts.len()).map(weight).sum();
            let kept = parts
                .iter()
                .enumerate()
                .map(|(part, own)| weight(part) * min_distance(own));
            kept.sum::<f64>() / all
        }
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(values: Vec<[f64; 2]>, order: Order) -> Distribution {
        Distribution::Points { values, order }
    }

    #[test]
    fn places_in_turn_differ_from_the_same_places_at_random() {
        let values = vec![[0.0, 0.0], [6.0, 8.0]];
        let (turn, random) = (
            points(values.clone(), Order::Turn),
            points(values.clone(), Order::Random),
        );
        // Each of the two is 0 or 10 m off with equal probability.
        let found = placement_wasserstein_2(&turn, &random).unwrap().value;
        assert!((found - 50.0_f64.sqrt()).abs() < 1e-9, "{found}");
        let reversed = points(values.into_iter().rev().collect(), Order::Turn);
        assert_eq!(placement_wasserstein_2(&turn, &reversed).unwrap().value, 10.0);
        let grid = |order| Distribution::Grid {
            low: [0.0; 2],
            high: [2.0, 1.0],
            columns: 2.0,
            rows: 1.0,
            jitter: None,
            order,
        };
        let cells = points(vec![[0.5, 0.5], [1.5, 0.5]], Order::Turn);
        assert_eq!(placement_wasserstein_2(&grid(Order::Turn), &cells).unwrap().value, 0.0);
        assert!(placement_wasserstein_2(&grid(Order::Random), &cells).unwrap().value > 0.1);
    }

    fn placements() -> impl Strategy<Value = Distribution> {
        let list = prop::collection::vec(prop::array::uniform2(-9.0..9.0_f64), 1..4);
        prop_oneof![
            (list.clone(), any::<bool>())
                .prop_map(|(values, turn)| points(values, if turn { Order::Turn } else { Order::Random })),
            (0.1..5.0_f64).prop_map(|distance| Distribution::PoissonDisc {
                low: [-9.0; 2],
                high: [9.0; 2],
                distance
            }),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn placement_distance_is_symmetric_and_zero_on_itself(a in placements(), b in placements()) {
            let d = |a: &Distribution, b: &Distribution| placement_wasserstein_2(a, b).unwrap().value;
            prop_assert!(d(&a, &a) < 1e-9);
            prop_assert!((d(&a, &b) - d(&b, &a)).abs() < 1e-9);
        }

        #[test]
        fn lists_in_turn_satisfy_the_triangle_inequality(
            a in prop::collection::vec(prop::array::uniform2(-9.0..9.0_f64), 3),
            b in prop::collection::vec(prop::array::uniform2(-9.0..9.0_f64), 2),
            c in prop::collection::vec(prop::array::uniform2(-9.0..9.0_f64), 6),
        ) {
            let [a, b, c] = [a, b, c].map(|values| points(values, Order::Turn));
            let d = |a: &Distribution, b: &Distribution| placement_wasserstein_2(a, b).unwrap().value;
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-9);
        }
    }
}

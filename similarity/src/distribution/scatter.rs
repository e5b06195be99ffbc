//! Points that represent a distribution in the plane: evenly spread and deterministic.

use driftworld_spec::{Distribution, Value};

/// `count` points of equal weight; `None` if the distribution draws no points.
///
/// All distributions use the same random numbers, so equal ones get equal points.
pub(super) fn scatter(distribution: &Distribution, count: usize) -> Option<Vec<[f64; 2]>> {
    // Hammersley's points: even along one axis, bit-reversed along the other.
    let units = (0..count as u32).map(|k| {
        let u = (f64::from(k) + 0.5) / count as f64;
        let v = f64::from(k.reverse_bits()) / (f64::from(u32::MAX) + 1.0) + 0.5 / count as f64;
        [u, v]
    });
    units.map(|unit| point(distribution, unit)).collect()
}

/// The point for two random numbers. Ignores the minimum distance of `poisson_disc`.
fn point(distribution: &Distribution, [u, v]: [f64; 2]) -> Option<[f64; 2]> {
    let among = |count: usize| {
        let at = u * count as f64;
        let index = (at as usize).min(count - 1);
        (index, at - index as f64)
    };
    Some(match distribution {
        Distribution::Points { values, .. } => values[among(values.len()).0],
        Distribution::Grid {
            low,
            high,
            columns,
            rows,
            jitter,
            ..
        } => {
            let (columns, rows) = (*columns as usize, *rows as usize);
            let (cell, within) = among(columns * rows);
            let jitter = jitter.unwrap_or(0.0);
            let along = |axis: usize, cell: usize, count: usize, unit: f64| {
                let place = cell as f64 + 0.5 + jitter * (unit - 0.5);
                low[axis] + (high[axis] - low[axis]) * place / count as f64
            };
            [
                along(0, cell % columns, columns, within),
                along(1, cell / columns, rows, v),
            ]
        }
        Distribution::Constant {
            value: Value::Point(point),
        } => *point,
        Distribution::Choice { values, weights } => {
            let (index, _) = choose(values.len(), weights.as_deref(), u);
            if let Value::Point(point) = values[index] {
                point
            } else {
                return None;
            }
        }
        Distribution::Mixture { parts, weights } => {
            let (index, within) = choose(parts.len(), weights.as_deref(), u);
            return point(&parts[index], [within, v]);
        }
        other => return other.point_at([u, v]),
    })
}

/// The entry that a random number chooses among `count`, and the remainder of that number, rescaled to 0..1.
pub(super) fn choose(count: usize, weights: Option<&[f64]>, u: f64) -> (usize, f64) {
    let weight = |k: usize| weights.map_or(1.0, |weights| weights[k]);
    let mut left = u * (0..count).map(weight).sum::<f64>();
    for k in 0..count {
        if left < weight(k) {
            return (k, left / weight(k));
        }
        left -= weight(k);
    }
    // Rounding can leave a remainder: it belongs to the last entry with a positive weight.
    ((0..count).rev().find(|k| weight(*k) > 0.0).unwrap_or(0), 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Distribution::{Annulus, Box, Disc, Gaussian, Grid, Mixture};

    /// Checks that the points have the moments of their distribution.
    #[track_caller]
    fn check(distribution: &Distribution) {
        let points = scatter(distribution, 1024).unwrap();
        let moments = distribution.planar_moments().unwrap();
        for axis in 0..2 {
            let mean = points.iter().map(|point| point[axis]).sum::<f64>() / 1024.0;
            let square = points.iter().map(|point| (point[axis] - mean).powi(2)).sum::<f64>() / 1024.0;
            assert!(
                (mean - moments.mean[axis]).abs() < 0.02,
                "{distribution:?}: mean {mean}"
            );
            let expected = moments.covariance[axis][axis];
            assert!(
                (square / expected - 1.0).abs() < 0.03,
                "{distribution:?}: {square}, expected {expected}"
            );
        }
    }

    #[test]
    fn points_have_the_moments_of_their_distribution() {
        let (low, high) = ([0.0, 1.0], [2.0, 4.0]);
        check(&Box { low, high });
        check(&Disc {
            center: low,
            radius: 2.0,
        });
        check(&Annulus {
            center: low,
            inner: 1.0,
            outer: 2.0,
        });
        check(&Gaussian {
            mean: low,
            std: None,
            correlation: None,
            covariance: Some([[2.0, -0.5], [-0.5, 1.0]]),
        });
        let grid = Grid {
            low,
            high,
            columns: 8.0,
            rows: 4.0,
            jitter: Some(0.5),
            order: driftworld_spec::Order::Turn,
        };
        check(&grid);
        check(&Mixture {
            parts: vec![
                grid,
                Box {
                    low: high,
                    high: [5.0, 9.0],
                },
            ],
            weights: Some(vec![1.0, 3.0]),
        });
    }
}

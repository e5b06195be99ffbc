//! Draws values and positions from the declared distributions.
//!
//! Numbers are drawn by inversion: the quantile function maps one random number to the value. Two variants under one seed share
//! random numbers, so that a high draw in one is a high draw in the other. Points of discs and rings come from `rand_distr`,
//! whose rejection sampling needs no transcendental functions; everything else uses `libm`, so that results are identical on
//! every platform.

use std::borrow::Cow;

use driftworld_spec::{Distribution, Order, Value};
use rand_distr::{Distribution as _, UnitCircle, UnitDisc};

use crate::stream::Rng;

/// Draws a value.
pub(crate) fn draw<'a>(distribution: &'a Distribution, rng: &mut Rng) -> Cow<'a, Value> {
    match distribution {
        Distribution::Constant { value } => Cow::Borrowed(value),
        Distribution::Choice { values, .. } => Cow::Borrowed(&values[distribution.chosen_at(rng.unit())]),
        Distribution::Mixture { parts, .. } => draw(&parts[distribution.chosen_at(rng.unit())], rng),
        Distribution::Dirichlet { alpha } => {
            let units: Vec<f64> = alpha[1..].iter().map(|_| rng.unit()).collect();
            Cow::Owned(Value::Vector(shares(alpha, &units)))
        }
        colors if colors.draws_colors() => {
            // Always draws three numbers, so that variants whose channels vary together share the first number with the others.
            let units = [rng.unit(), rng.unit(), rng.unit()];
            Cow::Owned(Value::Color(
                colors.color_at(units).expect("three random numbers determine a colour"),
            ))
        }
        planar if planar.is_planar() => Cow::Owned(Value::Point(place(planar, 0, rng).at)),
        other => Cow::Owned(
            other
                .value_at(rng.unit())
                .expect("one random number determines a draw from every other distribution"),
        ),
    }
}

/// Shares that sum to 1: each takes a part of what the earlier ones left (stick-breaking).
fn shares(alpha: &[f64], units: &[f64]) -> Vec<f64> {
    let mut rest: f64 = alpha.iter().sum();
    let mut left = 1.0;
    let mut shares = Vec::with_capacity(alpha.len());
    for (shape, unit) in alpha.iter().zip(units) {
        rest -= shape;
        let part = Distribution::Beta {
            alpha: *shape,
            beta: rest.max(1e-3),
            low: None,
            high: None,
        };
        let share = left * part.quantile(*unit).expect("a beta draws numbers");
        shares.push(share);
        left -= share;
    }
    shares.push(left.max(0.0));
    shares
}

/// A position on the ground, with the spacing that its distribution requires.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) at: [f64; 2],
    /// Minimum distance to objects of the same group; above 0 only for Poisson-disc sampling.
    pub(crate) own_distance: f64,
}

/// Draws a position from a planar distribution. `number` is the object's index, which selects from lists that are taken in
/// turn.
pub(crate) fn place(distribution: &Distribution, number: u64, rng: &mut Rng) -> Place {
    let mut own_distance = 0.0;
    let at = match distribution {
        Distribution::Disc { center: [x, y], radius } => {
            let [u, v]: [f64; 2] = UnitDisc.sample(rng);
            [x + radius * u, y + radius * v]
        }
        Distribution::Annulus {
            center: [x, y],
            inner,
            outer,
        } => {
            let [u, v]: [f64; 2] = UnitCircle.sample(rng);
            let radius = (inner * inner + (outer * outer - inner * inner) * rng.unit()).sqrt();
            [x + radius * u, y + radius * v]
        }
        Distribution::Points { values, order } => values[turn(*order, values.len() as u64, number, rng)],
        Distribution::Grid {
            low,
            high,
            columns,
            rows,
            jitter,
            order,
        } => {
            let (columns, rows) = (*columns as u64, *rows as u64);
            let cell = turn(*order, columns * rows, number, rng) as u64;
            let jitter = jitter.unwrap_or(0.0);
            let mut axis = |k: usize, cell: u64, count: u64| {
                let offset = if jitter > 0.0 { jitter * (rng.unit() - 0.5) } else { 0.0 };
                low[k] + (high[k] - low[k]) * (cell as f64 + 0.5 + offset) / count as f64
            };
            [axis(0, cell % columns, columns), axis(1, cell / columns, rows)]
        }
        Distribution::PoissonDisc { distance, .. } => {
            own_distance = *distance;
            point_at(distribution, rng)
        }
        Distribution::Mixture { parts, .. } => {
            return place(&parts[distribution.chosen_at(rng.unit())], number, rng);
        }
        Distribution::Constant {
            value: Value::Point(point),
        } => *point,
        Distribution::Choice { values, .. } => match values[distribution.chosen_at(rng.unit())] {
            Value::Point(point) => point,
            _ => [0.0, 0.0],
        },
        other => point_at(other, rng),
    };
    Place { at, own_distance }
}

fn point_at(distribution: &Distribution, rng: &mut Rng) -> [f64; 2] {
    distribution.point_at([rng.unit(), rng.unit()]).unwrap_or([0.0, 0.0])
}

fn turn(order: Order, count: u64, number: u64, rng: &mut Rng) -> usize {
    match order {
        Order::Turn => (number % count) as usize,
        Order::Random => ((rng.unit() * count as f64) as u64).min(count - 1) as usize,
    }
}

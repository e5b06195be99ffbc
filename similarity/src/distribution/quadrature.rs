//! Integrates functions that are smooth between two ends but may be steep at them.
//!
//! Implemented here because available libraries pass a plain number to the function, which loses the digits that an
//! unbounded density needs next to an end other than 0.

use std::f64::consts::FRAC_PI_2;
use std::sync::OnceLock;

/// A point on the line as a base and an offset, so that its distance from a nearby end keeps full precision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    base: f64,
    offset: f64,
}

impl Node {
    /// The node of a plain number.
    pub(crate) fn at(x: f64) -> Self {
        Self { base: x, offset: 0.0 }
    }

    /// The point as a number.
    pub(crate) fn x(self) -> f64 {
        self.base + self.offset
    }

    /// Its distance above `from`.
    pub(crate) fn above(self, from: f64) -> f64 {
        (self.base - from) + self.offset
    }

    /// The node, relative to an origin `by` higher.
    pub(crate) fn lowered(self, by: f64) -> Self {
        Self {
            base: self.base - by,
            offset: self.offset,
        }
    }
}

/// Steps per unit at the finest level.
const FINEST: usize = 64;

/// Stride of the first level, in finest steps.
const COARSE: usize = 32;

/// Nodes of the finest level on one side: distance from the end and weight, both as shares of the interval.
fn nodes() -> &'static [(f64, f64)] {
    static NODES: OnceLock<Vec<(f64, f64)>> = OnceLock::new();
    NODES.get_or_init(|| {
        let node = |k: usize| {
            let t = k as f64 / FINEST as f64;
            let q = libm::exp(-2.0 * FRAC_PI_2 * libm::sinh(t));
            let weight = FRAC_PI_2 * libm::cosh(t) * 2.0 * q / ((1.0 + q) * (1.0 + q));
            (q / (1.0 + q), weight)
        };
        (0..=6 * FINEST).map(node).collect()
    })
}

/// Computes several integrals from `low` to `high` at once, each with an estimate of its error.
///
/// The double exponential rule of Takahasi and Mori 1974: tolerates steep ends, but not kinks inside. Halves its step until the
/// first integral changes by at most `tolerance`, or by a share of 1e-10, at most five times: 13 to 700 calls.
pub(crate) fn integrate<const N: usize>(
    [low, high]: [f64; 2],
    tolerance: f64,
    mut f: impl FnMut(Node) -> [f64; N],
) -> ([f64; N], [f64; N]) {
    let width = high - low;
    let mut sums = [0.0; N];
    let (mut before, mut value, mut error) = ([f64::INFINITY; N], [0.0; N], [f64::INFINITY; N]);
    let mut stride = COARSE;
    while stride >= 1 {
        let first = stride == COARSE;
        // Later levels add nodes between the nodes of earlier levels.
        let (from, step) = if first { (0, stride) } else { (stride, 2 * stride) };
        for (k, (share, weight)) in nodes().iter().enumerate().skip(from).step_by(step) {
            let offset = width * share;
            let mut small = *share < 1e-9;
            let ends: &[Node] = &[
                Node { base: low, offset },
                Node {
                    base: high,
                    offset: -offset,
                },
            ];
            for node in &ends[usize::from(k == 0)..] {
                let values = f(*node);
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += weight * value;
                    small &= (weight * value).abs() <= 1e-17 * sum.abs();
                }
            }
            if small {
                break;
            }
        }
        let scale = width * stride as f64 / FINEST as f64;
        for k in 0..N {
            value[k] = sums[k] * scale;
            error[k] = (value[k] - before[k]).abs();
        }
        if error[0] <= tolerance.max(1e-10 * value[0].abs()) {
            break;
        }
        before = value;
        stride /= 2;
    }
    (value, error)
}

/// Positions in a stretch, as shares of its length, sampled to find sign changes: denser near the ends.
const SAMPLE_POSITIONS: [f64; 13] = [
    1e-7,
    1e-3,
    0.02,
    0.1,
    0.22,
    0.36,
    0.5,
    0.64,
    0.78,
    0.9,
    0.98,
    0.999,
    1.0 - 1e-7,
];

/// The knots, with the sign changes of a function between them that thirteen samples per stretch reveal.
pub(crate) fn split_at_signs(knots: &[f64], f: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut found = Vec::with_capacity(2 * knots.len());
    found.extend(knots.first());
    for ends in knots.windows(2) {
        let mut before = (ends[0], 0.0);
        for share in SAMPLE_POSITIONS {
            let x = ends[0] + (ends[1] - ends[0]) * share;
            let here = (x, f(x));
            if before.1 * here.1 < 0.0 {
                found.push(root(before, here, &f));
            } else if here.1 == 0.0 && before.1 != 0.0 {
                found.push(x);
            }
            before = here;
        }
        found.push(ends[1]);
    }
    found
}

/// The sign change between two points of different sign, by the Illinois method.
fn root(mut a: (f64, f64), mut b: (f64, f64), f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..100 {
        let x = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
        let x = if x > a.0 && x < b.0 { x } else { f64::midpoint(a.0, b.0) };
        let y = f(x);
        if y == 0.0 || b.0 - a.0 <= 1e-13 * (a.0.abs() + b.0.abs()) {
            return x;
        }
        if y * a.1 < 0.0 {
            b = (x, y);
            a.1 /= 2.0;
        } else {
            a = (x, y);
            b.1 /= 2.0;
        }
    }
    f64::midpoint(a.0, b.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(ends: [f64; 2], f: impl Fn(Node) -> f64, expected: f64) {
        let ([value], [error]) = integrate(ends, 1e-10, |node| [f(node)]);
        assert!(
            (value - expected).abs() <= 1e-12 * expected.abs(),
            "{value}, expected {expected}"
        );
        assert!(error < 1e-8, "{error}");
    }

    #[test]
    fn smooth_functions_and_steep_ends_are_integrated() {
        check([0.0, 1.0], |node| libm::exp(node.x()), libm::exp(1.0_f64) - 1.0);
        check([3.0, 4.0], |node| libm::pow(node.above(3.0), -0.9), 10.0);
        check(
            [0.0, 2.0],
            |node| libm::pow(-node.above(2.0), -0.5),
            2.0 * 2.0_f64.sqrt(),
        );
        check(
            [-9.0, 9.0],
            |node| libm::exp(-node.x() * node.x() / 2.0),
            std::f64::consts::TAU.sqrt(),
        );
    }

    #[test]
    fn sign_change_becomes_a_knot() {
        let split = split_at_signs(&[0.0, 1.0, 3.0], |x| x * x - 2.0);
        assert_eq!(split.len(), 4);
        assert!((split[2] - 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(split_at_signs(&[0.0, 1.0], |x| x - 0.5), [0.0, 0.5, 1.0]);
    }
}

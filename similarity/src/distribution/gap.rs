//! Integrals of the difference between two cumulative functions.

use super::law::{self, Law, ascending};
use super::measured::Measured;
use super::quadrature::{Node, integrate, split_at_signs};

/// The integrand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Power {
    /// ∫ |F − G|.
    Absolute,
    /// ∫ (F − G)².
    Square,
}

impl Power {
    fn of(self, gap: f64) -> f64 {
        match self {
            Self::Absolute => gap.abs(),
            Self::Square => gap * gap,
        }
    }

    /// The mean of the integrand along a straight line from one gap to another.
    pub(super) fn along(self, from: f64, to: f64) -> f64 {
        match self {
            Self::Absolute if from * to >= 0.0 => f64::midpoint(from.abs(), to.abs()),
            // The functions cross: two triangles.
            Self::Absolute => (from * from + to * to) / (2.0 * (from.abs() + to.abs())),
            Self::Square => (from * from + from * to + to * to) / 3.0,
        }
    }
}

/// The integral of |F − G| or (F − G)² over the line: exact if both are piecewise linear with steps, else by
/// quadrature.
pub(super) fn integral(a: &Law, b: &Law, power: Power) -> Measured {
    let knots = ascending(a.knots_and_atoms().chain(b.knots_and_atoms()).collect());
    let (mut steps_a, mut steps_b) = (Steps::new(a), Steps::new(b));
    let flat = a.is_flat() && b.is_flat();
    let (mut sum, mut tolerance) = (0.0, 0.0);
    for ends in knots.windows(2) {
        let [low, high] = [ends[0], ends[1]];
        let (a_steps, b_steps) = (steps_a.up_to(low), steps_b.up_to(low));
        let gap = |x: f64| {
            let from_below = a_steps[0] + a.cumulative_of_parts(x) - (b_steps[0] + b.cumulative_of_parts(x));
            let from_above = b_steps[1] + b.remaining_of_parts(x) - (a_steps[1] + a.remaining_of_parts(x));
            // Both give the same number; smaller sums have smaller errors.
            if a_steps[0] + a.cumulative_of_parts(x) > 0.5 {
                from_above
            } else {
                from_below
            }
        };
        if flat {
            sum += (high - low) * power.along(gap(low), gap(high));
            continue;
        }
        for ends in split_at_signs(&[low, high], gap).windows(2) {
            let width = ends[1] - ends[0];
            let ([value], [error]) =
                integrate(
                    [ends[0], ends[1]],
                    1e-13 * width,
                    |node: Node| [power.of(gap(node.x()))],
                );
            sum += value;
            tolerance += error;
        }
    }
    if flat {
        law::exact(a, b, sum)
    } else {
        Measured::quadrature(sum, tolerance.max(1e-12 * sum))
    }
}

/// Iterates upwards over the atoms of a law.
struct Steps<'a> {
    atoms: &'a [(f64, f64)],
    next: usize,
    below: f64,
    above: f64,
}

impl<'a> Steps<'a> {
    fn new(law: &'a Law) -> Self {
        Self {
            atoms: &law.atoms,
            next: 0,
            below: 0.0,
            above: law.atoms.iter().map(|atom| atom.1).sum(),
        }
    }

    /// Probability of the atoms up to `x`, and of those above.
    fn up_to(&mut self, x: f64) -> [f64; 2] {
        while let Some(atom) = self.atoms.get(self.next).filter(|atom| atom.0 <= x) {
            self.below += atom.1;
            self.next += 1;
            self.above -= atom.1;
        }
        if self.next == self.atoms.len() {
            self.above = 0.0;
        }
        [self.below, self.above]
    }
}

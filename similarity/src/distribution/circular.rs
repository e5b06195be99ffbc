//! Wasserstein-1 between distributions of headings, around the circle.

use driftworld_spec::Distribution;

use super::gap::Power;
use super::law::{self, Law, ascending};
use super::measured::Measured;

/// Widest stretch, in degrees, over which the first pass treats a curved cumulative function as linear; the second pass
/// uses half of it.
const COARSE: f64 = 0.5;

/// Wasserstein-1 between two distributions of headings, with each heading moved the shorter way round.
///
/// min over c of ∫ |F − G − c| over one turn; the best c is the median of F − G. A metric in `0..=180` degrees. Numbers are
/// taken as headings in degrees, reduced to one turn. `None` if either draws no numbers, or spreads them over more than 200
/// turns. Exact for constants, choices and uniform headings; otherwise by the trapezium rule at two widths, mostly within 1e-3
/// degrees, at about two thousand points.
///
/// Source: Rabin, Delon & Gousseau 2011, "Transportation distances on the circle"; the same numbers as
/// `ot.wasserstein_circle`, which measures in turns.
///
/// # Example
/// ```
/// use driftworld_similarity::distribution::circular_wasserstein_1;
/// use driftworld_spec::Distribution::Uniform;
/// let (a, b) = (Uniform { low: 340.0, high: 350.0 }, Uniform { low: 0.0, high: 10.0 });
/// assert!((circular_wasserstein_1(&a, &b).unwrap().value - 20.0).abs() < 1e-9);
/// ```
pub fn circular_wasserstein_1(a: &Distribution, b: &Distribution) -> Option<Measured> {
    let (p, q) = (Law::of_headings(a)?, Law::of_headings(b)?);
    if a == b {
        return Some(Measured::closed(0.0));
    }
    if p.is_flat() && q.is_flat() {
        return Some(law::exact(&p, &q, area_around_median(&stretches(&p, &q, None))));
    }
    let [coarse, fine] = [COARSE, COARSE / 2.0].map(|widest| area_around_median(&stretches(&p, &q, Some(widest))));
    // Half the width leaves a quarter of the error, so a third of the difference remains.
    let left = (fine - coarse) / 3.0;
    Some(Measured::quadrature((fine + left).max(0.0), left.abs().max(1e-9)))
}

/// A stretch of the circle: its width, and the difference of the cumulative functions at its ends.
type Stretch = (f64, f64, f64);

/// The difference along the circle in stretches: from knot to knot, or at most `widest` degrees wide.
fn stretches(a: &Law, b: &Law, widest: Option<f64>) -> Vec<Stretch> {
    let mut knots: Vec<f64> = a.knots().into_iter().chain(b.knots()).collect();
    for x in &mut knots {
        *x = x.rem_euclid(360.0);
    }
    knots.extend(a.atoms.iter().chain(&b.atoms).map(|atom| atom.0));
    knots.extend([0.0, 360.0]);
    let knots = ascending(knots);
    let steps = |law: &Law, x: f64| -> f64 {
        let up_to = law.atoms.partition_point(|atom| atom.0 <= x);
        law.atoms[..up_to].iter().map(|atom| atom.1).sum()
    };
    let gap = |x: f64| a.cumulative_of_parts(x) - b.cumulative_of_parts(x);
    let mut found = Vec::new();
    for ends in knots.windows(2) {
        let step = steps(a, ends[0]) - steps(b, ends[0]);
        // At least eight pieces between the knots of curves, and twice as many at half the width.
        let count = widest.map_or(1.0, |widest| {
            ((ends[1] - ends[0]) / COARSE).ceil().max(8.0) * (COARSE / widest)
        });
        let width = (ends[1] - ends[0]) / count;
        let mut before = gap(ends[0]);
        for k in 1..=count as u32 {
            let after = gap(ends[0] + width * f64::from(k));
            found.push((width, step + before, step + after));
            before = after;
        }
    }
    found
}

/// The area between the stretches and their median.
fn area_around_median(stretches: &[Stretch]) -> f64 {
    let all = || stretches.iter().flat_map(|(_, from, to)| [*from, *to]);
    let mut low = all().fold(f64::INFINITY, f64::min);
    let mut high = all().fold(f64::NEG_INFINITY, f64::max);
    let whole: f64 = stretches.iter().map(|stretch| stretch.0).sum();
    let below = |c: f64| -> f64 {
        let each = stretches.iter().map(|(width, from, to)| {
            let (least, most) = (from.min(*to), from.max(*to));
            if most <= c {
                *width
            } else if least >= c {
                0.0
            } else {
                width * (c - least) / (most - least)
            }
        });
        each.sum()
    };
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            break;
        }
        if below(middle) * 2.0 < whole {
            low = middle;
        } else {
            high = middle;
        }
    }
    // The median lies between the two; at a jump either end is as good.
    let area = |c: f64| -> f64 {
        let each = stretches.iter();
        each.map(|(width, from, to)| width * Power::Absolute.along(from - c, to - c))
            .sum()
    };
    area(high).min(area(low))
}

#[cfg(test)]
mod tests {
    use super::*;
    use Distribution::{Choice, Normal, Uniform, VonMises};
    use driftworld_spec::Value;

    #[track_caller]
    fn check(a: &Distribution, b: &Distribution, expected: f64, within: f64) {
        for found in [circular_wasserstein_1(a, b), circular_wasserstein_1(b, a)] {
            let found = found.unwrap();
            assert!(
                (found.value - expected).abs() <= within,
                "{found:?}, expected {expected}"
            );
        }
    }

    fn headings(degrees: &[f64]) -> Distribution {
        Choice {
            values: degrees.iter().map(|x| Value::Number(*x)).collect(),
            weights: None,
        }
    }

    #[test]
    fn shorter_way_round_counts() {
        check(&headings(&[350.0]), &headings(&[10.0]), 20.0, 1e-9);
        check(&headings(&[0.0]), &headings(&[180.0]), 180.0, 1e-9);
        check(&headings(&[0.0, 90.0]), &headings(&[350.0, 100.0]), 10.0, 1e-9);
        check(&headings(&[-10.0]), &headings(&[710.0]), 0.0, 1e-9);
        // The uniform distribution is a quarter turn from any heading on average.
        check(&headings(&[123.0]), &Uniform { low: 0.0, high: 360.0 }, 90.0, 1e-9);
    }

    #[test]
    fn narrow_distributions_are_as_far_apart_as_on_the_line() {
        let at = |mean: f64| VonMises { mean, kappa: 500.0 };
        check(&at(350.0), &at(15.0), 25.0, 1e-3);
        let normal = |mean: f64, std: f64| Normal { mean, std };
        check(&normal(355.0, 5.0), &normal(20.0, 5.0), 25.0, 1e-3);
        check(
            &VonMises { mean: 5.0, kappa: 0.0 },
            &Uniform { low: 0.0, high: 360.0 },
            0.0,
            1e-9,
        );
    }
}

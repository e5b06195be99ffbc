//! Sums a term of the two probabilities over everything that two distributions can draw.

use driftworld_spec::Distribution;

use super::law::{self, Law, Run, ascending, draws_headings};
use super::measured::Measured;
use super::quadrature::{Node, integrate, split_at_signs};
use super::values;

/// Σ term(ln p, ln q) over single values and ∫ term(ln f, ln g) dx over densities, on the circle if either draws headings.
///
/// The term must be homogeneous (multiplying both probabilities by c multiplies it by c), and 0 where the two are equal. `None`
/// if the two cannot be compared, such as words and numbers, or points with a density.
pub(super) fn sum(a: &Distribution, b: &Distribution, term: impl Fn(f64, f64) -> f64) -> Option<Measured> {
    let equal = (a == b).then(|| Measured::closed(0.0));
    if let Some((p, q)) = law::both(a, b) {
        let circle = draws_headings(a) || draws_headings(b);
        return equal.or_else(|| Some(over_numbers(&p, &q, circle, term)));
    }
    let (p, q) = (values::probabilities(a)?, values::probabilities(b)?);
    if equal.is_some() {
        return equal;
    }
    let pairs = values::aligned(&p, &q);
    Some(Measured::atoms(
        pairs.into_iter().map(|[p, q]| term(libm::log(p), libm::log(q))).sum(),
    ))
}

fn over_numbers(a: &Law, b: &Law, circle: bool, term: impl Fn(f64, f64) -> f64) -> Measured {
    let mut sum = over_atoms(a, b, &term) + over_runs(a, b, &term);
    let mut knots = a.knots();
    knots.extend(b.knots());
    if circle {
        knots = knots.into_iter().filter_map(onto_the_circle).collect();
        knots.extend([0.0, 360.0]);
    }
    let mut tolerance = 0.0;
    for ends in ascending(knots).windows(2) {
        let (value, error) = over_stretch(a, b, [ends[0], ends[1]], &term);
        sum += value;
        tolerance += error;
    }
    if tolerance == 0.0 {
        law::exact(a, b, sum)
    } else {
        Measured::quadrature(sum, f64::max(tolerance, 1e-12))
    }
}

/// Maps a finite knot to 0..360; drops infinite ones.
fn onto_the_circle(knot: f64) -> Option<f64> {
    knot.is_finite().then(|| knot.rem_euclid(360.0))
}

/// The integral between two neighbouring knots, with its error, which is 0 if the masses alone decide it.
fn over_stretch(a: &Law, b: &Law, [low, high]: [f64; 2], term: &impl Fn(f64, f64) -> f64) -> (f64, f64) {
    let mass = |law: &Law| {
        let below = law.cumulative_of_parts(high) - law.cumulative_of_parts(low);
        let above = law.remaining_of_parts(low) - law.remaining_of_parts(high);
        below.min(above).max(0.0)
    };
    let term_of_masses = |p: f64, q: f64| {
        if p <= 0.0 && q <= 0.0 {
            0.0
        } else {
            term(libm::log(p), libm::log(q))
        }
    };
    match (a.reaches(low, high), b.reaches(low, high)) {
        (false, false) => (0.0, 0.0),
        (true, false) => (term_of_masses(mass(a), 0.0), 0.0),
        (false, true) => (term_of_masses(0.0, mass(b)), 0.0),
        (true, true) if a.is_flat() && b.is_flat() => (term_of_masses(mass(a), mass(b)), 0.0),
        (true, true) => {
            let (mut sum, mut error) = (0.0, 0.0);
            let (mut of_a, mut of_b) = (mass(a), mass(b));
            if of_a + of_b < 1e-17 {
                // Far out in the tails, every term is negligible unless one of the probabilities is 0.
                return (0.0, 1e-17);
            }
            let crossings = split_at_signs(&[low, high], |x| {
                a.log_density(Node::at(x)) - b.log_density(Node::at(x))
            });
            for ends in crossings.windows(2) {
                let ([value, p, q], [miss, ..]) = integrate([ends[0], ends[1]], 1e-11, |node| {
                    let (p, q) = (a.log_density(node), b.log_density(node));
                    if p == f64::NEG_INFINITY && q == f64::NEG_INFINITY {
                        return [0.0; 3];
                    }
                    let found = [term(p, q), libm::exp(p), libm::exp(q)];
                    // Skips points so near to a steep end that the density overflows; their mass is added below.
                    if found.iter().all(|x| x.is_finite()) {
                        found
                    } else {
                        [0.0; 3]
                    }
                });
                sum += value;
                error += miss;
                of_a -= p;
                of_b -= q;
            }
            // Near a steep end only the total mass is known, because positions cannot be resolved.
            let left = [of_a, of_b].map(|left| if left > 1e-12 { left } else { 0.0 });
            (sum + term_of_masses(left[0], left[1]), error + of_a.abs() + of_b.abs())
        }
    }
}

fn in_runs(runs: &[Run], x: f64) -> f64 {
    let inside = runs
        .iter()
        .filter(|run| x.fract() == 0.0 && run.low <= x && x <= run.high);
    inside.map(|run| run.each).sum()
}

fn over_atoms(a: &Law, b: &Law, term: &impl Fn(f64, f64) -> f64) -> f64 {
    let (mut i, mut j, mut sum) = (0, 0, 0.0);
    while i < a.atoms.len() || j < b.atoms.len() {
        let x = match (a.atoms.get(i), b.atoms.get(j)) {
            (Some(a), Some(b)) => a.0.min(b.0),
            (Some(only), None) | (None, Some(only)) => only.0,
            (None, None) => break,
        };
        let next_mass = |law: &Law, next: &mut usize| {
            let mut mass = in_runs(&law.runs, x);
            if let Some(atom) = law.atoms.get(*next).filter(|atom| atom.0 == x) {
                mass += atom.1;
                *next += 1;
            }
            mass
        };
        let (p, q) = (next_mass(a, &mut i), next_mass(b, &mut j));
        sum += term(libm::log(p), libm::log(q));
    }
    sum
}

/// Sums the term over runs of whole numbers, except numbers that are also atoms of either law.
fn over_runs(a: &Law, b: &Law, term: &impl Fn(f64, f64) -> f64) -> f64 {
    let ends = a.runs.iter().chain(&b.runs).flat_map(|run| [run.low, run.high + 1.0]);
    let mut singles: Vec<f64> = a.atoms.iter().chain(&b.atoms).map(|atom| atom.0).collect();
    singles.retain(|x| x.fract() == 0.0);
    let singles = ascending(singles);
    let mut sum = 0.0;
    for ends in ascending(ends.collect()).windows(2) {
        let (p, q) = (in_runs(&a.runs, ends[0]), in_runs(&b.runs, ends[0]));
        if p + q > 0.0 {
            let num_singles = singles.partition_point(|x| *x < ends[1]) - singles.partition_point(|x| *x < ends[0]);
            sum += (ends[1] - ends[0] - num_singles as f64) * term(libm::log(p), libm::log(q));
        }
    }
    sum
}

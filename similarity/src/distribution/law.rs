//! [`Law`]: any distribution of numbers or headings, split into single numbers (atoms), runs and densities.

use driftworld_spec::Distribution;

use super::measured::Measured;
use super::part::Part;
use super::quadrature::Node;
use super::values::share;

/// Maximum number of single numbers of a distribution of counts; with more, it is not split.
const MAX_ATOMS: usize = 65_536;

/// Maximum length of a run of whole numbers that is split into single numbers.
const MAX_RUN_LENGTH: f64 = 4096.0;

/// Maximum number of turns over which a distribution of headings may spread.
const MAX_TURNS: f64 = 200.0;

/// Equally likely whole numbers: those from `low` to `high`, each with the same probability.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) each: f64,
}

/// A distribution of numbers, split into its parts.
#[derive(Clone, Debug, Default)]
pub(super) struct Law {
    /// Single numbers with their probabilities, each once, in ascending order.
    pub(super) atoms: Vec<(f64, f64)>,
    pub(super) runs: Vec<Run>,
    pub(super) parts: Vec<Part>,
}

/// Whether it draws headings; for a mixture, whether any of its parts does.
pub(crate) fn draws_headings(distribution: &Distribution) -> bool {
    match distribution {
        Distribution::VonMises { .. } => true,
        Distribution::Mixture { parts, .. } => parts.iter().any(draws_headings),
        _ => false,
    }
}

/// Splits both: as headings if either draws headings, else as numbers. `None` if either draws no numbers, or too many different
/// counts.
pub(super) fn both(a: &Distribution, b: &Distribution) -> Option<(Law, Law)> {
    if draws_headings(a) || draws_headings(b) {
        Some((Law::of_headings(a)?, Law::of_headings(b)?))
    } else {
        Some((Law::of(a)?, Law::of(b)?))
    }
}

/// An exact result for two laws: a sum over single values if neither has densities, else a closed form.
pub(super) fn exact(a: &Law, b: &Law, value: f64) -> Measured {
    if a.parts.is_empty() && b.parts.is_empty() {
        Measured::atoms(value)
    } else {
        Measured::closed(value)
    }
}

impl Law {
    /// Splits a distribution of numbers; a Bernoulli counts as 0 and 1.
    pub(super) fn of(distribution: &Distribution) -> Option<Self> {
        if draws_headings(distribution) {
            return None;
        }
        let mut law = Self::default();
        law.add(1.0, distribution)?;
        law.merge();
        Some(law)
    }

    /// Splits a distribution of numbers taken as headings in degrees, from 0 to 360.
    pub(super) fn of_headings(distribution: &Distribution) -> Option<Self> {
        let mut open = Self::default();
        open.add(1.0, distribution)?;
        let mut law = Self::default();
        for run in open.runs {
            if run.high - run.low > 360.0 * MAX_TURNS {
                return None;
            }
            let count = (run.high - run.low) as u32;
            open.atoms
                .extend((0..=count).map(|k| (run.low + f64::from(k), run.each)));
        }
        law.atoms
            .extend(open.atoms.into_iter().map(|(x, mass)| (turned(x), mass)));
        for part in open.parts {
            law.turn(part)?;
        }
        law.merge();
        Some(law)
    }

    /// Adds copies of a part, shifted by full turns so that they cover 0 to 360.
    fn turn(&mut self, part: Part) -> Option<()> {
        if part.draws_headings() {
            self.parts.push(part);
            return Some(());
        }
        let knots = part.knots();
        let low = knots.iter().copied().fold(f64::INFINITY, f64::min);
        let high = knots.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (first, last) = ((low / 360.0).floor(), (high / 360.0).ceil());
        if last - first > MAX_TURNS {
            return None;
        }
        self.parts
            .extend((first as i32..last as i32).map(|turn| part.moved(-360.0 * f64::from(turn))));
        Some(())
    }

    fn add(&mut self, scale: f64, distribution: &Distribution) -> Option<()> {
        match distribution {
            Distribution::Constant { value } => self.atoms.push((value.as_number()?, scale)),
            Distribution::Choice { values, weights } => {
                let weight = |k: usize| weights.as_ref().map_or(1.0, |weights| weights[k]);
                let total: f64 = (0..values.len()).map(weight).sum();
                for (k, value) in values.iter().enumerate() {
                    self.atoms.push((value.as_number()?, scale * weight(k) / total));
                }
            }
            Distribution::Bernoulli { p } => self.atoms.extend([(0.0, scale * (1.0 - p)), (1.0, scale * p)]),
            Distribution::Normal { mean, std } if *std == 0.0 => self.atoms.push((*mean, scale)),
            Distribution::LogNormal { mu, sigma } if *sigma == 0.0 => self.atoms.push((libm::exp(*mu), scale)),
            Distribution::Perturb {
                value,
                noise,
                low,
                high,
            } => self.add_perturbed(scale, *value, *noise, [*low, *high]),
            Distribution::IntegerUniform { low, high } => {
                let count = high - low + 1.0;
                let each = scale / count;
                if count > MAX_RUN_LENGTH {
                    let (low, high) = (*low, *high);
                    self.runs.push(Run { low, high, each });
                } else {
                    self.atoms.extend((0..count as u32).map(|k| (low + f64::from(k), each)));
                }
            }
            Distribution::Binomial { .. } | Distribution::Poisson { .. } | Distribution::Geometric { .. } => {
                let counts = super::counts::probabilities(distribution, MAX_ATOMS)?;
                self.atoms.extend(counts.into_iter().map(|(x, mass)| (x, scale * mass)));
            }
            Distribution::Mixture { parts, weights } => {
                for (k, part) in parts.iter().enumerate() {
                    self.add(scale * share(k, parts.len(), weights.as_deref()), part)?;
                }
            }
            Distribution::Uniform { .. }
            | Distribution::Normal { .. }
            | Distribution::TruncatedNormal { .. }
            | Distribution::LogNormal { .. }
            | Distribution::Exponential { .. }
            | Distribution::Beta { .. }
            | Distribution::Triangular { .. }
            | Distribution::VonMises { .. } => self.parts.push(Part::new(scale, distribution.clone(), 0.0)),
            _ => return None,
        }
        Some(())
    }

    /// Adds the distribution of a value with uniform noise, clipped at both ends: a flat part between two single numbers.
    fn add_perturbed(&mut self, scale: f64, value: f64, noise: f64, [low, high]: [Option<f64>; 2]) {
        let cut = |x: f64| {
            x.max(low.unwrap_or(f64::NEG_INFINITY))
                .min(high.unwrap_or(f64::INFINITY))
        };
        let (from, to) = (value - noise, value + noise);
        let (left, right) = (cut(from), cut(to));
        if left >= right || noise == 0.0 {
            self.atoms.push((cut(value), scale));
            return;
        }
        let width = to - from;
        self.atoms.extend([
            (left, scale * (left - from) / width),
            (right, scale * (to - right) / width),
        ]);
        let flat = Distribution::Uniform { low: left, high: right };
        self.parts.push(Part::new(scale * (right - left) / width, flat, 0.0));
    }

    fn merge(&mut self) {
        self.atoms.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.atoms.dedup_by(|next, kept| {
            // −0 equals 0.
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        self.atoms.retain(|atom| atom.1 > 0.0);
        self.parts.retain(|part| part.share > 0.0);
        self.runs.retain(|run| run.each > 0.0);
    }

    /// Whether every density is flat, so that the cumulative function is piecewise linear with steps.
    pub(super) fn is_flat(&self) -> bool {
        self.parts.iter().all(Part::is_uniform)
    }

    /// Replaces long runs of whole numbers by flat densities, and bounds the error that this causes in a Wasserstein-1
    /// distance.
    pub(super) fn smoothed(mut self) -> (Self, f64) {
        let mut error = 0.0;
        for run in std::mem::take(&mut self.runs) {
            let count = run.high - run.low + 1.0;
            let (low, high) = (run.low - 0.5, run.high + 0.5);
            self.parts
                .push(Part::new(run.each * count, Distribution::Uniform { low, high }, 0.0));
            error += 0.25 * run.each * count;
        }
        (self, error)
    }

    /// Logarithm of the density.
    pub(super) fn log_density(&self, node: Node) -> f64 {
        let log = |part: &Part| libm::log(part.share) + part.log_density(node);
        if let [part] = &self.parts[..] {
            return log(part);
        }
        let greatest = self.parts.iter().map(log).fold(f64::NEG_INFINITY, f64::max);
        if greatest == f64::NEG_INFINITY {
            return greatest;
        }
        let sum: f64 = self.parts.iter().map(|part| libm::exp(log(part) - greatest)).sum();
        greatest + libm::log(sum)
    }

    /// Probability of a number up to `x`, without single numbers and runs.
    pub(super) fn cumulative_of_parts(&self, x: f64) -> f64 {
        self.parts.iter().map(|part| part.share * part.cumulative(x)).sum()
    }

    /// Probability of a number above `x`, without single numbers and runs.
    pub(super) fn remaining_of_parts(&self, x: f64) -> f64 {
        self.parts.iter().map(|part| part.share * part.remaining(x)).sum()
    }

    /// The ends of its support; infinite if unbounded.
    pub(super) fn ends(&self) -> [f64; 2] {
        let atoms = self.atoms.iter().map(|atom| [atom.0; 2]);
        let runs = self.runs.iter().map(|run| [run.low, run.high]);
        let all = atoms.chain(runs).chain(self.parts.iter().map(Part::ends));
        all.fold([f64::INFINITY, f64::NEG_INFINITY], |hull, ends| {
            [hull[0].min(ends[0]), hull[1].max(ends[1])]
        })
    }

    /// Whether some density is above 0 between the two.
    pub(super) fn reaches(&self, low: f64, high: f64) -> bool {
        self.parts.iter().any(|part| {
            let ends = part.ends();
            ends[0] < high && ends[1] > low
        })
    }

    /// The points at which densities and cumulative functions change their form, unsorted.
    pub(super) fn knots(&self) -> Vec<f64> {
        self.parts.iter().flat_map(Part::knots).collect()
    }

    /// The knots and the single numbers, unsorted.
    pub(super) fn knots_and_atoms(&self) -> impl Iterator<Item = f64> {
        self.knots().into_iter().chain(self.atoms.iter().map(|atom| atom.0))
    }
}

/// A heading in 0..360.
fn turned(degrees: f64) -> f64 {
    let turned = degrees.rem_euclid(360.0);
    if turned >= 360.0 { 0.0 } else { turned }
}

/// Sorts numbers, and removes duplicates and numbers that are not finite.
pub(super) fn ascending(mut numbers: Vec<f64>) -> Vec<f64> {
    numbers.retain(|x| x.is_finite());
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;
    use Distribution::{IntegerUniform, Mixture, Perturb, Uniform, VonMises};

    #[test]
    fn clipped_number_is_a_flat_part_between_two_single_numbers() {
        let cut = Perturb {
            value: 1.0,
            noise: 2.0,
            low: Some(0.0),
            high: Some(2.5),
        };
        let law = Law::of(&cut).unwrap();
        assert_eq!(law.atoms, [(0.0, 0.25), (2.5, 0.125)]);
        assert_eq!(law.parts[0].share, 0.625);
        assert_eq!(law.parts[0].ends(), [0.0, 2.5]);
    }

    #[test]
    fn equal_numbers_in_a_mixture_are_merged() {
        let dice = IntegerUniform { low: 1.0, high: 2.0 };
        let mixture = Mixture {
            parts: vec![
                dice,
                IntegerUniform { low: 2.0, high: 3.0 },
                Uniform { low: 0.0, high: 1.0 },
            ],
            weights: Some(vec![1.0, 1.0, 2.0]),
        };
        let law = Law::of(&mixture).unwrap();
        assert_eq!(law.atoms, [(1.0, 0.125), (2.0, 0.25), (3.0, 0.125)]);
        assert_eq!(law.cumulative_of_parts(0.5), 0.25);
    }

    #[test]
    fn uniform_over_more_than_a_turn_wraps_around_the_circle() {
        let law = Law::of_headings(&Uniform {
            low: -90.0,
            high: 630.0,
        })
        .unwrap();
        let mass = |low: f64, high: f64| law.cumulative_of_parts(high) - law.cumulative_of_parts(low);
        assert!((mass(0.0, 360.0) - 1.0).abs() < 1e-12);
        assert!((mass(0.0, 90.0) - 0.25).abs() < 1e-12);
        assert!(Law::of(&VonMises { mean: 0.0, kappa: 1.0 }).is_none());
    }
}

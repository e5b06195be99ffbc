//! Draws from the declared distributions. Numbers come from `stream.rs`; transcendental functions from `libm`.

use std::f64::consts::TAU;

use driftworld_spec::{Distribution, Value};

use crate::stream::Chance;

/// Draws a value. `number` is the object's number: points are taken in turn.
pub(crate) fn draw(distribution: &Distribution, number: u32, chance: &mut Chance) -> Value {
    match distribution {
        Distribution::Uniform { low, high } => Value::Number(low + (high - low) * chance.unit()),
        Distribution::IntegerUniform { low, high } => {
            let (low, high) = (*low as i64, *high as i64);
            Value::Integer(low + chance.below((high - low) as u64 + 1) as i64)
        }
        Distribution::Normal { mean, std } => Value::Number(mean + std * normal(chance)),
        Distribution::TruncatedNormal { mean, std, low, high } => {
            Value::Number(truncated_normal(*mean, *std, *low, *high, chance))
        }
        Distribution::Choice { values, weights } => values[choose(values.len(), weights.as_deref(), chance)].clone(),
        Distribution::Bernoulli { p } => Value::Boolean(chance.unit() < *p),
        Distribution::Binomial { n, p } => Value::Integer((0..*n as u64).filter(|_| chance.unit() < *p).count() as i64),
        planar => Value::Point(point(planar, number, chance)),
    }
}

/// Draws a point of the plane; the distribution is a planar one.
pub(crate) fn point(distribution: &Distribution, number: u32, chance: &mut Chance) -> [f64; 2] {
    match distribution {
        Distribution::Box { low, high } => [
            low[0] + (high[0] - low[0]) * chance.unit(),
            low[1] + (high[1] - low[1]) * chance.unit(),
        ],
        Distribution::Disc { center, radius } => ring(*center, 0.0, *radius, chance),
        Distribution::Annulus { center, inner, outer } => ring(*center, *inner, *outer, chance),
        Distribution::Gaussian { mean, std } => {
            let [a, b] = normal_pair(chance);
            [mean[0] + std * a, mean[1] + std * b]
        }
        Distribution::Points { values } => values[number as usize % values.len()],
        _ => [0.0, 0.0],
    }
}

fn ring([x, y]: [f64; 2], inner: f64, outer: f64, chance: &mut Chance) -> [f64; 2] {
    let radius = (inner * inner + (outer * outer - inner * inner) * chance.unit()).sqrt();
    let angle = TAU * chance.unit();
    [x + radius * libm::cos(angle), y + radius * libm::sin(angle)]
}

fn normal_pair(chance: &mut Chance) -> [f64; 2] {
    // 1 − u lies in (0, 1], so that its logarithm is finite.
    let radius = (-2.0 * libm::log(1.0 - chance.unit())).sqrt();
    let angle = TAU * chance.unit();
    [radius * libm::cos(angle), radius * libm::sin(angle)]
}

fn normal(chance: &mut Chance) -> f64 {
    normal_pair(chance)[0]
}

/// A normal number within bounds: by rejection, from the normal where the bounds hold much of it, else from a flat one.
fn truncated_normal(mean: f64, std: f64, low: f64, high: f64, chance: &mut Chance) -> f64 {
    let (a, b) = ((low - mean) / std, (high - mean) / std);
    if a <= 1.0 && b >= -1.0 && b - a > 1.0 {
        loop {
            let z = normal(chance);
            if (a..=b).contains(&z) {
                return (mean + std * z).clamp(low, high);
            }
        }
    }
    // Far tails are cut where less than 2^-53 of them is left, so that a far bound costs no tries.
    let peak = 0.0_f64.clamp(a, b);
    let reach = 40.0 / peak.abs().max(1.0);
    let (a, b) = (a.max(peak - reach), b.min(peak + reach));
    loop {
        let z = a + (b - a) * chance.unit();
        if chance.unit() < libm::exp((peak * peak - z * z) / 2.0) {
            return (mean + std * z).clamp(low, high);
        }
    }
}

fn choose(count: usize, weights: Option<&[f64]>, chance: &mut Chance) -> usize {
    let Some(weights) = weights else {
        return chance.below(count as u64) as usize;
    };
    let mut left = weights.iter().sum::<f64>() * chance.unit();
    for (index, weight) in weights.iter().enumerate() {
        if left < *weight {
            return index;
        }
        left -= weight;
    }
    // Rounding can leave a sliver: it belongs to the last value that can occur.
    weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(0)
}

//! Statistical power of Welch's test: the chance of detecting a difference between agents, the number of lifetimes needed, and
//! the smallest effect that can be shown.

use super::student::student_reach;

/// The significance level of a two-sided test: the chance of calling equal agents different.
pub const POWER_LEVEL: f64 = 0.05;

/// The power that [`lifetimes_for`] and [`smallest_effect`] aim for.
pub const POWER_WANTED: f64 = 0.8;

/// Maximum number of lifetimes per agent that the search considers.
pub const MAX_POWER_LIFETIMES: usize = 100_000;

/// Integration points per variance; the integrand is smooth, and vanishes at its ends.
const NUM_POINTS: usize = 48;

/// Number of intervals in which quantiles of Student's t are interpolated, linearly in one over the degrees of freedom.
const NUM_QUANTILES: usize = 64;

/// The chance, 0..=1, that a two-sided Welch's t test at 5 % calls two agents different, if their lifetimes are independent and
/// normally distributed with these standard deviations and with means that differ by `effect`. `lifetimes` are the numbers of
/// lifetimes of the agents. `None` for fewer than two lifetimes of either agent, or if both deviations are 0.
///
/// The difference of means is normal and independent of the two sample variances; given these, the chance follows from a normal
/// distribution, and is integrated over their chi-squared distributions.
pub fn welch_power(lifetimes: [usize; 2], deviations: [f64; 2], effect: f64) -> Option<f64> {
    let variances = deviations.map(|deviation| deviation * deviation);
    if lifetimes.iter().any(|num| *num < 2) || variances.iter().all(|variance| *variance == 0.0) {
        return None;
    }
    let nums = lifetimes.map(|num| num as f64);
    let of_mean = [variances[0] / nums[0], variances[1] / nums[1]];
    let deviation = (of_mean[0] + of_mean[1]).sqrt();
    let points = nums.map(|num| chi_squared(num - 1.0));
    let quantiles = Quantiles::new(nums);
    let mut power = 0.0;
    for (a, weight_a) in &points[0] {
        for (b, weight_b) in &points[1] {
            let (a, b) = (a * of_mean[0], b * of_mean[1]);
            let freedom = (a + b) * (a + b) / (a * a / (nums[0] - 1.0) + b * b / (nums[1] - 1.0));
            let limit = quantiles.at(freedom) * (a + b).sqrt();
            let beyond = normal((effect - limit) / deviation) + normal((-effect - limit) / deviation);
            power += weight_a * weight_b * beyond;
        }
    }
    Some(power.clamp(0.0, 1.0))
}

/// The fewest lifetimes per agent for a power of 80 %; `None` if that takes more than [`MAX_POWER_LIFETIMES`], or the power is
/// undefined.
pub fn lifetimes_for(deviations: [f64; 2], effect: f64) -> Option<usize> {
    let enough = |num: usize| Some(welch_power([num; 2], deviations, effect)? >= POWER_WANTED);
    let mut high = 2;
    while !enough(high)? {
        if high >= MAX_POWER_LIFETIMES {
            return None;
        }
        high = (high * 2).min(MAX_POWER_LIFETIMES);
    }
    let mut low = high / 2;
    while low + 1 < high {
        let middle = usize::midpoint(low, high);
        if enough(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(high)
}

/// The smallest difference of means that this number of lifetimes of each agent shows with a power of 80 %; `None` as in
/// [`welch_power`].
pub fn smallest_effect(lifetimes: [usize; 2], deviations: [f64; 2]) -> Option<f64> {
    let scale = libm::hypot(deviations[0], deviations[1]);
    let (mut low, mut high) = (0.0, scale);
    while welch_power(lifetimes, deviations, high)? < POWER_WANTED {
        (low, high) = (high, 2.0 * high);
    }
    for _ in 0..30 {
        let middle = f64::midpoint(low, high);
        if welch_power(lifetimes, deviations, middle)? < POWER_WANTED {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(high)
}

/// The standard normal cumulative distribution function.
fn normal(value: f64) -> f64 {
    0.5 * libm::erfc(-value / std::f64::consts::SQRT_2)
}

/// Values of a chi-squared variable over its degrees of freedom, evenly spaced in its logarithm, with weights that add up to 1.
fn chi_squared(freedom: f64) -> Vec<(f64, f64)> {
    // The logarithm of the density of ln(x / freedom), up to a constant: 0 at its maximum.
    let log_density = |u: f64| freedom / 2.0 * (u - (libm::exp(u) - 1.0));
    let end = |direction: f64| {
        let step = direction * 0.05 / freedom.sqrt();
        (1..100_000)
            .map(|num| f64::from(num) * step)
            .find(|u| log_density(*u) < -30.0)
    };
    let (low, high) = (end(-1.0).unwrap_or(-1.0), end(1.0).unwrap_or(1.0));
    let at = |point: usize| low + (high - low) * point as f64 / (NUM_POINTS - 1) as f64;
    let weights: Vec<f64> = (0..NUM_POINTS).map(|point| libm::exp(log_density(at(point)))).collect();
    let sum: f64 = weights.iter().sum();
    (0..NUM_POINTS)
        .map(|point| (libm::exp(at(point)), weights[point] / sum))
        .collect()
}

/// Quantiles of Student's t for all degrees of freedom that Welch's test can have.
struct Quantiles {
    /// One over the largest degrees of freedom.
    first: f64,
    /// The step from one point to the next.
    step: f64,
    values: Vec<f64>,
}

impl Quantiles {
    fn new(nums: [f64; 2]) -> Self {
        let (most, least) = (nums[0] + nums[1] - 2.0, nums[0].min(nums[1]) - 1.0);
        let (first, last) = (1.0 / most, 1.0 / least);
        let step = (last - first) / NUM_QUANTILES as f64;
        let values =
            (0..=NUM_QUANTILES).map(|index| student_reach(1.0 - POWER_LEVEL, 1.0 / (first + step * index as f64)));
        Self {
            first,
            step,
            values: values.collect(),
        }
    }

    fn at(&self, freedom: f64) -> f64 {
        let index = ((1.0 / freedom - self.first) / self.step).clamp(0.0, NUM_QUANTILES as f64);
        let below = (index.floor() as usize).min(NUM_QUANTILES - 1);
        let share = index - below as f64;
        self.values[below] + (self.values[below + 1] - self.values[below]) * share
    }
}

//! How fast this build is on this machine, one core at a time: the figures of `driftworld bench`. The benches of single
//! functions are criterion's, beside each crate.

pub(crate) mod environment;
pub(crate) mod generator;
pub(crate) mod metrics;
pub(crate) mod similarity;

use std::time::{Duration, Instant};

use serde_json::{Map, Value, json};

use crate::Failure;

/// Figures under their names.
pub(crate) type Figures = Map<String, Value>;

/// How many rounds the median is taken of.
const ROUNDS: usize = 5;

/// How often a job is done each second: the median of several rounds, after one to warm up.
fn rate<E>(round: Duration, mut job: impl FnMut(u64) -> Result<(), E>) -> Result<f64, E> {
    let mut rates = Vec::with_capacity(ROUNDS);
    let mut index = 0;
    for number in 0..=ROUNDS {
        let start = Instant::now();
        let first = index;
        while start.elapsed() < round {
            // The clock is read once for several jobs, which may be short.
            for _ in 0..16 {
                job(index)?;
                index += 1;
            }
        }
        if number > 0 {
            rates.push((index - first) as f64 / start.elapsed().as_secs_f64());
        }
    }
    rates.sort_by(f64::total_cmp);
    Ok(rates[rates.len() / 2])
}

/// Figures that are rates, whole.
fn rates<const N: usize>(figures: [(&str, f64); N]) -> Figures {
    let named = figures.into_iter();
    named
        .map(|(name, rate)| (name.to_owned(), json!(rate.round())))
        .collect()
}

/// The least seconds that a job takes in three times.
fn best_of_three<E: Into<Failure>>(mut job: impl FnMut() -> Result<(), E>) -> Result<f64, Failure> {
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let start = Instant::now();
        job().map_err(Into::into)?;
        best = best.min(start.elapsed().as_secs_f64());
    }
    Ok(best)
}

//! Measures the speed of environments on this machine, for `driftworld bench env`.

pub(crate) mod environment;

use std::time::{Duration, Instant};

use serde_json::{Map, Value, json};

/// Figures by name.
pub(crate) type Figures = Map<String, Value>;

/// Number of rounds for the median.
const ROUNDS: usize = 5;

/// Number of jobs run per second: the median of several rounds, after a warm-up round.
fn rate<E>(round: Duration, mut job: impl FnMut(u64) -> Result<(), E>) -> Result<f64, E> {
    let mut rates = Vec::with_capacity(ROUNDS);
    let mut index = 0;
    for number in 0..=ROUNDS {
        let start = Instant::now();
        let first = index;
        while start.elapsed() < round {
            // Jobs may be short, so read the clock only once for several.
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

/// Rates as whole numbers.
fn rates<const N: usize>(figures: [(&str, f64); N]) -> Figures {
    let named = figures.into_iter();
    named
        .map(|(name, rate)| (name.to_owned(), json!(rate.round())))
        .collect()
}

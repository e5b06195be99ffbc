//! `driftworld bench`: how fast this build is on this machine, one core at a time. The benches of single functions are criterion's, beside each crate.

use std::time::{Duration, Instant};

use clap::{Args, Subcommand};
use driftworld::generator::Sampler;
use driftworld::spec::{TaskSpec, World};
use driftworld::tasks;
use serde_json::{Map, json};

use super::{Failure, output};

/// The scene of about 86 objects on the backslash map.
const SETTLEMENT: &str = include_str!("../../examples/tasks/settlement.json");

/// How many rounds the median is taken of.
const ROUNDS: usize = 5;

/// Measure how fast this build is on this machine, on one core.
#[derive(Args)]
#[command(after_help = "Example:\n  driftworld bench generator --json")]
pub(crate) struct Bench {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Worlds drawn and documents checked, each second on one core.
    #[command(after_help = "Example:\n  driftworld bench generator --json")]
    Generator {
        /// Print the figures as JSON.
        #[arg(long)]
        json: bool,
        /// Seconds for each of five rounds of each figure; the median is reported.
        #[arg(long, default_value_t = 0.4, value_parser = seconds)]
        seconds: f64,
    },
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.001..=60.0).contains(&seconds) => Ok(seconds),
        _ => Err("expected seconds in 0.001..60".to_owned()),
    }
}

impl Bench {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let What::Generator { json, seconds } = self.what;
        let figures = generator(Duration::from_secs_f64(seconds))?;
        if json {
            return output::json(&figures);
        }
        for (name, value) in &figures {
            output::line(format!("{name:<42} {value:>10}"))?;
        }
        Ok(())
    }
}

fn generator(round: Duration) -> Result<Map<String, serde_json::Value>, Failure> {
    let settlement = TaskSpec::from_json("settlement.json", SETTLEMENT)?.variant("near")?;
    let of_86 = Sampler::new(&settlement, 7);
    let find_objects = Sampler::new(&tasks::variant("find_objects#red")?, 7);
    let mut small = of_86.world(0)?;
    small.objects.truncate(30);
    let text = small.to_json();
    let figures = [
        (
            "worlds_per_second_per_core_map_86",
            rate(round, |index| of_86.world(index).map(drop))?,
        ),
        (
            "worlds_per_second_per_core_find_objects",
            rate(round, |index| find_objects.world(index).map(drop))?,
        ),
        (
            "validations_per_second_per_core",
            rate(round, |_| World::from_json("world.json", &text).map(drop))?,
        ),
    ];
    Ok(figures
        .into_iter()
        .map(|(name, rate)| (name.to_owned(), json!(rate.round())))
        .collect())
}

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

//! `driftworld bench`: how fast this build is on this machine, one core at a time. What is measured is the library's.

use std::time::Duration;

use crate::Failure;
use crate::env::RendererKind;
use crate::throughput::{environment, generator, metrics, similarity};
use clap::{Args, Subcommand};

use super::output;

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
    Generator(Options),
    /// Pairs of colours, grids, points and samples measured each second on one core; seconds for the distances among 1,000
    /// worlds and for an order of 1,000 items.
    #[command(after_help = "Example:\n  driftworld bench similarity --json")]
    Similarity(Options),
    /// Steps with pictures, and resets, each second on one core; what a second core adds; memory.
    #[command(after_help = "Example:\n  driftworld bench env --json")]
    Env(EnvOptions),
    /// Writing, reading and scoring the log of a lifetime of 1,000,000 experiences, on one core.
    #[command(after_help = "Example:\n  driftworld bench metrics --quick --json")]
    Metrics(MetricsOptions),
}

#[derive(Args)]
struct MetricsOptions {
    /// Print the figures as JSON.
    #[arg(long)]
    json: bool,
    /// Take a lifetime of 20,000 experiences.
    #[arg(long)]
    quick: bool,
}

#[derive(Args)]
struct Options {
    /// Print the figures as JSON.
    #[arg(long)]
    json: bool,
    /// Seconds for each of five rounds of each figure; the median is reported.
    #[arg(long, default_value_t = 0.4, value_parser = seconds)]
    seconds: f64,
}

#[derive(Args)]
struct EnvOptions {
    #[command(flatten)]
    options: Options,
    /// What draws (cpu, gpu, auto). A graphics card is measured on whole batches, with all cores beside it.
    #[arg(long, default_value_t, value_name = "RENDERER")]
    renderer: RendererKind,
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.001..=60.0).contains(&seconds) => Ok(seconds),
        _ => Err("expected seconds in 0.001..60".to_owned()),
    }
}

impl Bench {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let round = |options: &Options| Duration::from_secs_f64(options.seconds);
        let (json, figures) = match self.what {
            What::Generator(options) => (options.json, generator::measure(round(&options))?),
            What::Similarity(options) => (options.json, similarity::measure(round(&options))?),
            What::Env(EnvOptions { options, renderer }) => {
                (options.json, environment::measure(round(&options), renderer)?)
            }
            What::Metrics(options) => (options.json, metrics::measure(options.quick)?),
        };
        if json {
            return output::json(&figures);
        }
        for (name, value) in &figures {
            output::line(format!("{name:<42} {value:>10}"))?;
        }
        Ok(())
    }
}

//! `driftworld bench`: how fast this build is on this machine, one core at a time. What is measured is the library's.

use std::time::Duration;

use crate::Failure;
use crate::env::RendererKind;
use crate::throughput::{environment, generator, metrics, similarity};
use clap::{Args, Subcommand};

use super::output;

/// Measure the speed of this build on this machine.
///
/// On one core, unless a benchmark says otherwise.
#[derive(Args)]
#[command(after_help = "Example:\n  driftworld bench generator --json")]
pub(crate) struct Bench {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Worlds drawn and documents checked per second, on one core.
    #[command(after_help = "Example:\n  driftworld bench generator --json")]
    Generator(Options),
    /// Colours, grids, point sets and samples compared per second, on one core.
    ///
    /// Also times the distances among 1,000 worlds and an ordering of 1,000 items.
    #[command(after_help = "Example:\n  driftworld bench similarity --json")]
    Similarity(Options),
    /// Steps with rendering and resets per second on one core, scaling, and memory.
    #[command(after_help = "Example:\n  driftworld bench env --json")]
    Env(EnvOptions),
    /// Time to write, read and score a lifetime of 1,000,000 experiences, on one core.
    #[command(after_help = "Example:\n  driftworld bench metrics --quick --json")]
    Metrics(MetricsOptions),
}

#[derive(Args)]
struct MetricsOptions {
    /// Print the figures as JSON.
    #[arg(long)]
    json: bool,
    /// Use a lifetime of 20,000 experiences.
    #[arg(long)]
    quick: bool,
}

#[derive(Args)]
struct Options {
    /// Print the figures as JSON.
    #[arg(long)]
    json: bool,
    /// Seconds per round. Each figure is the median of five rounds.
    #[arg(long, default_value_t = 0.4, value_parser = seconds)]
    seconds: f64,
}

#[derive(Args)]
struct EnvOptions {
    #[command(flatten)]
    options: Options,
    /// Where to render: cpu, gpu or auto.
    ///
    /// A GPU is measured on whole batches, with all CPU cores in use.
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

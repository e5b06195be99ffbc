//! `driftworld bench`: measures the speed of this build on this machine.

use std::time::Duration;

use crate::Failure;
use crate::env::RendererKind;
use crate::numbers::within;
use crate::throughput::environment;
use clap::{Args, Subcommand};

use super::output;

/// Measure the speed of this build on this machine.
///
/// On one core, unless a benchmark says otherwise.
#[derive(Args)]
#[command(after_help = "Example:\n  driftworld bench env --json")]
pub(crate) struct Bench {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    /// Steps with rendering and resets per second on one core, scaling, and memory.
    #[command(after_help = "Example:\n  driftworld bench env --json")]
    Env(EnvOptions),
}

#[derive(Args)]
struct EnvOptions {
    /// Print the figures as JSON.
    #[arg(long)]
    json: bool,
    /// Seconds per round. Each figure is the median of five rounds.
    #[arg(long, default_value_t = 0.4, value_parser = seconds)]
    seconds: f64,
    /// Where to render: cpu, gpu or auto.
    ///
    /// A GPU is measured on whole batches, with all CPU cores in use.
    #[arg(long, default_value_t, value_name = "RENDERER")]
    renderer: RendererKind,
}

fn seconds(text: &str) -> Result<f64, String> {
    within(
        text,
        |seconds| (0.001..=60.0).contains(&seconds),
        "seconds in 0.001..60",
    )
}

impl Bench {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let What::Env(options) = self.what;
        let figures = environment::measure(Duration::from_secs_f64(options.seconds), options.renderer)?;
        if options.json {
            return output::json(&figures);
        }
        for (name, value) in &figures {
            output::line(format!("{name:<42} {value:>10}"))?;
        }
        Ok(())
    }
}

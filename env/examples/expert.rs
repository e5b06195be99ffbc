//! Success rate of the expert, and its steps per second on one core, for files with one world per line, as written by
//! `driftworld sample TASK#VARIANT --count 1000 --jsonl -o FILE`. `driftworld render --view episode` shows a single world.
//!
//! ```sh
//! driftworld sample examples/worlds/maze.json#tiny --seed 77 --count 1000 --jsonl -o tiny.jsonl
//! cargo run --release -p driftworld-env --example expert -- tiny.jsonl
//! ```

use std::collections::BTreeMap;
use std::error::Error;
use std::time::{Duration, Instant};

use driftworld_env::{Agent, Environment, OnRailsAgent};
use driftworld_spec::World;

#[expect(clippy::print_stdout, reason = "an example shows what it finds")]
fn main() -> Result<(), Box<dyn Error>> {
    for path in std::env::args().skip(1) {
        let text = std::fs::read_to_string(&path)?;
        let (mut num_worlds, mut num_steps, mut spent) = (0_u32, 0_u64, Duration::ZERO);
        let mut failed: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        let mut agent = OnRailsAgent::new();
        for (number, line) in text.lines().enumerate() {
            let mut environment = Environment::new(World::from_json(&path, line)?);
            let begun = Instant::now();
            agent.begin(0);
            let last = loop {
                let action = agent.act(&environment);
                let step = environment.step(action)?;
                if step.ended() {
                    break step;
                }
            };
            spent += begun.elapsed();
            (num_worlds, num_steps) = (num_worlds + 1, num_steps + u64::from(environment.num_steps()));
            if !last.success {
                failed.entry(format!("{:?}", last.ended_by)).or_default().push(number);
            }
        }
        let num_failed: usize = failed.values().map(Vec::len).sum();
        println!(
            "{path}: success in {} of {num_worlds} worlds, {:.0} steps a world, {:.0} steps/s",
            num_worlds as usize - num_failed,
            num_steps as f64 / f64::from(num_worlds),
            num_steps as f64 / spent.as_secs_f64()
        );
        for (reason, worlds) in failed {
            println!("    {reason}: worlds {worlds:?}");
        }
    }
    Ok(())
}

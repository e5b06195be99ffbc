//! Score a lifetime with a custom metric alongside the built-in ones: the largest loss in any task.
#![expect(clippy::print_stdout, reason = "an example prints its results")]

use driftworld::metrics::{
    Assessment, BlockType, Direction, Headline, LogWriter, LoggerInfo, Metric, MetricsError, Options, Record,
    ScenarioInfo, Scorer, Timestamp, read_log,
};

/// The largest drop of a task's performance below its best earlier evaluation.
struct WorstForgetting;

impl Metric for WorstForgetting {
    fn headlines(&self, _: &Options) -> Vec<Headline> {
        vec![Headline::new(
            "worst_forgetting",
            "how much was lost at worst? points below the best earlier evaluation",
            Direction::Lower,
        )]
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        for task in assessment.lifetime().tasks() {
            let (mut best, mut worst) = (f64::NEG_INFINITY, None);
            for regime in assessment.lifetime().regimes_of(task) {
                let evaluated = assessment.term_perf(regime.regime_num);
                let (BlockType::Test, Some(performance)) = (regime.block_type, evaluated) else {
                    continue;
                };
                best = best.max(performance);
                worst = Some(f64::max(worst.unwrap_or(0.0), best - performance));
            }
            // A task without evaluations gets no value; the value of the lifetime is the mean over its tasks.
            assessment.set_task(task, "worst_forgetting", worst);
        }
        Ok(())
    }
}

/// Writes the log of a learner that forgets its first task while it learns the second.
fn write_log(log: &mut LogWriter) -> Result<(), MetricsError> {
    let (mut skill, mut exp_num) = ([0.0, 0.0], 0);
    for block in 0..5 {
        let experiences = if block % 2 == 0 { 10 } else { 40 };
        for experience in 0..experiences {
            let (kind, task) = match block {
                1 => (BlockType::Train, 0),
                3 => (BlockType::Train, 1),
                _ => (BlockType::Test, usize::from(experience >= 5)),
            };
            if kind == BlockType::Train {
                skill[task] += 0.1 * (1.0 - skill[task]);
                skill[1 - task] *= 0.99;
            }
            let name = ["find_red", "find_blue"][task];
            let when = Timestamp::from_unix_micros(1_600_000_000_000_000 + exp_num)?;
            log.write(&Record::new(block, exp_num as u64, kind, name, when).with_metric("reward", skill[task]))?;
            exp_num += 1;
        }
    }
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = tempfile::tempdir()?;
    let logs = folder.path().join("forgetful");
    let mut log = LogWriter::create(&logs, &LoggerInfo::new(["reward"])?, &ScenarioInfo::default())?;
    write_log(&mut log)?;
    log.finish()?;

    let scorer = Scorer::new().with(WorstForgetting)?;
    let scores = scorer.score(&read_log(&logs)?, &[], &Options::default())?;
    for row in scores.summary() {
        if let Some(value) = row.value {
            println!("{:24} {value:8.3}  {}", row.name, row.explanation);
        }
    }
    Ok(())
}

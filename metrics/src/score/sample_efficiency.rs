//! Sample efficiency: how good the agent gets and how fast, both compared with a single-task expert.

use super::assessment::Assessment;
use super::metric::Metric;
use super::saturation::{Peak, peak};
use super::ste_relative_performance::{expert_runs, with_gaps};
use crate::lifetime::{SteRun, mean_per_experience};
use crate::results::{Direction, Headline};
use crate::statistics::{mean_of_known, trend_falls};
use crate::{Definitions, MetricsError, Options, SteAveragingMethod};

/// An agent below this share of the expert's saturation has not learned the task: its efficiency is 0.
const MIN_SATURATION_SHARE: f64 = 0.2;

/// `sample_efficiency` of every task, the mean of its `sample_efficiency_vals`, and the numbers behind these.
pub(super) struct SampleEfficiency;

const NAME: &str = "sample_efficiency";

impl Metric for SampleEfficiency {
    fn headlines(&self, _: &Options) -> Vec<Headline> {
        vec![Headline::new(
            NAME,
            "how good and how quickly, over an expert trained on the task alone",
            Direction::HigherThan(1.0),
        )]
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        let mut of_tasks = Vec::new();
        let is_left_out = is_left_out(assessment);
        for task in assessment.lifetime().tasks() {
            let found = if is_left_out {
                Efficiency::default()
            } else {
                of_task(assessment, task)
            };
            let whole = mean_of_known(&found.sample_efficiency_vals);
            of_tasks.extend(whole);
            assessment.set_task(task, NAME, whole);
            assessment.set_task(task, "ste_saturation_vals", Some(found.ste_saturation_vals));
            assessment.set_task(task, "ste_exp_to_sat_vals", Some(found.ste_exp_to_sat_vals));
            assessment.set_task(task, "se_saturation_vals", Some(with_gaps(&found.se_saturation_vals)));
            assessment.set_task(task, "se_exp_to_sat_vals", Some(found.se_exp_to_sat_vals));
            assessment.set_task(
                task,
                "sample_efficiency_vals",
                Some(with_gaps(&found.sample_efficiency_vals)),
            );
            assessment.set_task(task, "se_task_saturation", found.task_saturation);
            assessment.set_task(task, "se_task_exp_to_sat", found.task_exp_to_sat);
        }
        assessment.set_lifetime_of(NAME, of_tasks);
        Ok(())
    }
}

/// QUIRK: if a task was learned in experience 0 alone, the reference cannot fit a line to its performances and leaves the
/// metric out for all tasks of the lifetime. Under the published definitions, it is computed.
fn is_left_out(assessment: &Assessment<'_>) -> bool {
    let lifetime = assessment.lifetime();
    let without_line = |task: &String| {
        let (exp_nums, _) = lifetime.training_of(task);
        !exp_nums.is_empty() && exp_nums.iter().all(|exp_num| *exp_num == 0)
    };
    assessment.options().definitions == Definitions::Reference && lifetime.tasks().iter().any(without_line)
}

/// Sample efficiency of one task and the numbers behind it; one entry per run of the expert.
#[derive(Debug, Clone, PartialEq, Default)]
struct Efficiency {
    task_saturation: Option<f64>,
    task_exp_to_sat: Option<f64>,
    ste_saturation_vals: Vec<f64>,
    ste_exp_to_sat_vals: Vec<u64>,
    se_saturation_vals: Vec<f64>,
    se_exp_to_sat_vals: Vec<f64>,
    sample_efficiency_vals: Vec<f64>,
}

/// (task saturation / expert saturation) · (expert's experiences to it / task's experiences to it).
///
/// 0 if the task's saturation is below a fifth of the expert's, or its least-squares line falls. `None` without experts or
/// learning, and if the task, or for one run the expert, is at its best from the start.
fn of_task(assessment: &Assessment<'_>, task: &str) -> Efficiency {
    let (lifetime, options) = (assessment.lifetime(), assessment.options());
    let (exp_nums, learning) = lifetime.training_of(task);
    let experts = lifetime.experts_of(task);
    let peak_of = |values: &[f64]| peak(values, assessment);
    let saturated = peak_of(&mean_per_experience(&exp_nums, &learning));
    if experts.is_empty() || saturated.experiences == 0 {
        return Efficiency::default();
    }
    let x: Vec<f64> = exp_nums.iter().map(|exp_num| *exp_num as f64).collect();
    let falls = trend_falls(&x, &learning, assessment.slack(&learning));
    let mut efficiency = Efficiency {
        task_saturation: Some(saturated.value),
        task_exp_to_sat: Some(saturated.experiences as f64),
        ..Efficiency::default()
    };
    for performances in expert_runs(experts, options.ste_averaging_method, per_experience) {
        let expert = peak_of(&performances);
        let threshold = expert.value * MIN_SATURATION_SHARE - assessment.slack(&[expert.value]);
        efficiency.compare(saturated, expert, falls || saturated.value < threshold);
    }
    // QUIRK: with one incomparable run, the task's own saturation is still listed; with an incomparable average, it is not.
    if options.ste_averaging_method == SteAveragingMethod::Time && efficiency.sample_efficiency_vals.is_empty() {
        return Efficiency::default();
    }
    efficiency
}

/// The performance of each experience of an expert's training.
fn per_experience(run: &SteRun) -> Vec<f64> {
    let (exp_nums, performance): (Vec<u64>, Vec<f64>) = run.training().unzip();
    mean_per_experience(&exp_nums, &performance)
}

impl Efficiency {
    fn compare(&mut self, task: Peak, expert: Peak, is_unlearned: bool) {
        let height = task.value / expert.value;
        if expert.experiences == 0 {
            return;
        }
        let speed = expert.experiences as f64 / task.experiences as f64;
        self.ste_saturation_vals.push(expert.value);
        self.ste_exp_to_sat_vals.push(expert.experiences as u64);
        self.se_saturation_vals.push(height);
        self.se_exp_to_sat_vals.push(speed);
        self.sample_efficiency_vals
            .push(if is_unlearned { 0.0 } else { height * speed });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn saturation_and_speed_multiply_unless_nothing_was_learned() {
        let check = |task: (f64, usize), expert: (f64, usize), is_unlearned: bool, expected: &[f64]| {
            let mut efficiency = Efficiency::default();
            let peak = |(value, experiences)| Peak { value, experiences };
            efficiency.compare(peak(task), peak(expert), is_unlearned);
            assert_eq!(efficiency.sample_efficiency_vals, expected);
        };
        check((50.0, 20), (100.0, 10), false, &[0.25]);
        check((50.0, 20), (100.0, 10), true, &[0.0]);
        check((20.0, 5), (100.0, 10), false, &[0.4]);
        check((50.0, 20), (100.0, 0), false, &[]);
        // Dividing by 0 gives no number.
        check((50.0, 20), (0.0, 10), false, &[f64::INFINITY]);
        check((50.0, 20), (0.0, 10), true, &[0.0]);
    }
}

//! Sample efficiency: how good the agent gets and how fast, both against a single-task expert.
//!
//! Not here: the sum of what it gathers on the way, see `ste_relative_performance`.

use super::saturation::{self, Saturation};
use super::ste_relative_performance::average_over_time;
use crate::SteAveragingMethod;
use crate::lifetime::{Lifetime, SteRun, mean_per_experience};
use crate::statistics::trend_falls;

/// An agent that does not reach this part of the expert's saturation has not learnt the task: its efficiency is 0.
const LEAST_SATURATION: f64 = 0.2;

/// Sample efficiency of one task and what it was made of; one entry per run of the expert.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Efficiency {
    pub(super) task_saturation: Option<f64>,
    pub(super) task_exp_to_sat: Option<f64>,
    pub(super) ste_saturation_vals: Vec<f64>,
    pub(super) ste_exp_to_sat_vals: Vec<usize>,
    pub(super) se_saturation_vals: Vec<f64>,
    pub(super) se_exp_to_sat_vals: Vec<f64>,
    pub(super) sample_efficiency_vals: Vec<f64>,
}

/// (task saturation / expert saturation) · (expert's experiences to it / task's experiences to it).
///
/// 0 where the task's saturation is below a fifth of the expert's, or its least-squares line falls. Nothing without
/// experts or learning, and where the task, or for one run the expert, is at its best from the start.
pub(super) fn of_task(lifetime: &Lifetime, task: &str, averaging: SteAveragingMethod) -> Efficiency {
    let (exp_nums, learning) = lifetime.training_of(task);
    let experts = lifetime.experts_of(task);
    let saturated = saturation::of(&mean_per_experience(&exp_nums, &learning));
    if experts.is_empty() || saturated.experiences == 0 {
        return Efficiency::default();
    }
    let x: Vec<f64> = exp_nums.iter().map(|exp_num| *exp_num as f64).collect();
    let falls = trend_falls(&x, &learning);
    let mut efficiency = Efficiency {
        task_saturation: Some(saturated.value),
        task_exp_to_sat: Some(saturated.experiences as f64),
        ..Efficiency::default()
    };
    for expert in expert_saturations(experts, averaging) {
        efficiency.compare(saturated, expert, falls);
    }
    efficiency
}

fn expert_saturations(experts: &[SteRun], averaging: SteAveragingMethod) -> Vec<Saturation> {
    match averaging {
        SteAveragingMethod::Time => average_over_time(experts)
            .iter()
            .map(|run| saturation::of(run))
            .collect(),
        SteAveragingMethod::Metrics => {
            let per_experience = |run: &SteRun| {
                let (exp_nums, performance): (Vec<u64>, Vec<f64>) = run.training().unzip();
                saturation::of(&mean_per_experience(&exp_nums, &performance))
            };
            experts.iter().map(per_experience).collect()
        }
    }
}

impl Efficiency {
    fn compare(&mut self, task: Saturation, expert: Saturation, falls: bool) {
        let height = task.value / expert.value;
        if expert.experiences == 0 || !height.is_finite() {
            return;
        }
        let speed = expert.experiences as f64 / task.experiences as f64;
        let unlearnt = falls || task.value < expert.value * LEAST_SATURATION;
        self.ste_saturation_vals.push(expert.value);
        self.ste_exp_to_sat_vals.push(expert.experiences);
        self.se_saturation_vals.push(height);
        self.se_exp_to_sat_vals.push(speed);
        self.sample_efficiency_vals
            .push(if unlearnt { 0.0 } else { height * speed });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn height_and_speed_multiply_unless_nothing_was_learnt() {
        let check = |task: (f64, usize), expert: (f64, usize), falls: bool, expected: &[f64]| {
            let mut efficiency = Efficiency::default();
            let saturation = |(value, experiences)| Saturation { value, experiences };
            efficiency.compare(saturation(task), saturation(expert), falls);
            assert_eq!(efficiency.sample_efficiency_vals, expected);
        };
        check((50.0, 20), (100.0, 10), false, &[0.25]);
        check((50.0, 20), (100.0, 10), true, &[0.0]);
        check((19.0, 5), (100.0, 10), false, &[0.0]);
        check((20.0, 5), (100.0, 10), false, &[0.4]);
        check((50.0, 20), (100.0, 0), false, &[]);
        check((50.0, 20), (0.0, 10), false, &[]);
    }
}

//! Judges a lifetime: one file per metric, and here the order in which they are computed.
//!
//! Not here: reading and preprocessing (`log`, `lifetime`, `preprocess`), and files of results (`report`).

mod aggregation;
mod average_performance;
mod performance_maintenance;
mod performance_recovery;
mod recovery_time;
mod sample_efficiency;
mod saturation;
mod ste_relative_performance;
mod terminal_performance;
mod transfer;

use indexmap::IndexMap;

use crate::lifetime::{Lifetime, Regime, SteLog};
use crate::report::{LifetimeMetrics, RegimeMetrics, TaskMetrics};
use crate::{BlockType, Log, MetricsError, Options};
use transfer::Transfers;

/// Scores a lifetime, compared with the single-task experts there are.
///
/// A value that cannot be computed, for want of experts, of evaluations between learning blocks, of a second learning
/// block, is `None` and never NaN.
///
/// # Errors
/// Those of [`Lifetime::prepare`].
pub fn score(log: &Log, experts: &[SteLog], options: &Options) -> Result<LifetimeMetrics, MetricsError> {
    let lifetime = Lifetime::prepare(log, experts, options)?;
    let regimes: Vec<RegimeMetrics> = lifetime
        .regimes()
        .iter()
        .map(|regime| judge_regime(&lifetime, regime))
        .collect();
    let transfers = transfer::transfers(&lifetime, &regimes, options.transfer_method);
    let tasks = lifetime.tasks().iter();
    let task_metrics: IndexMap<String, TaskMetrics> = tasks
        .map(|task| (task.clone(), judge_task(&lifetime, &regimes, &transfers, task, options)))
        .collect();
    let all = || {
        lifetime
            .regimes()
            .iter()
            .flat_map(|regime| regime.performance.iter().copied())
    };
    let info = &log.scenario_info;
    Ok(LifetimeMetrics {
        lifetime: aggregation::over_tasks(&task_metrics, &transfers, options.aggregation_method),
        run_id: lifetime.run_id().to_owned(),
        complexity: info.complexity.map(|word| word.to_string()).unwrap_or_default(),
        difficulty: info.difficulty.map(|word| word.to_string()).unwrap_or_default(),
        scenario_type: info.scenario_type.map(|word| word.to_string()).unwrap_or_default(),
        metrics_column: options.perf_measure.clone(),
        min: all().fold(f64::INFINITY, f64::min),
        max: all().fold(f64::NEG_INFINITY, f64::max),
        num_lx: num_rows(lifetime.regimes().iter(), BlockType::Train),
        num_ex: num_rows(lifetime.regimes().iter(), BlockType::Test),
        runtime: lifetime.runtime_secs(),
        normalization_data_range: lifetime.normalization_data_range().cloned(),
        task_metrics,
        regimes,
    })
}

fn num_rows<'a>(regimes: impl Iterator<Item = &'a Regime>, block_type: BlockType) -> usize {
    regimes
        .filter(|regime| regime.block_type == block_type)
        .map(Regime::len)
        .sum()
}

fn judge_regime(lifetime: &Lifetime, regime: &Regime) -> RegimeMetrics {
    let per_experience = regime.per_experience();
    let saturation = saturation::of(&per_experience);
    let terminal = terminal_performance::of(&per_experience, regime.block_type);
    RegimeMetrics {
        block_num: regime.block_num,
        block_type: regime.block_type,
        block_subtype: regime.block_subtype,
        task_name: regime.task_name.clone(),
        regime_num: regime.regime_num,
        task_params: crate::log::spaced_json(&regime.task_params),
        saturation: saturation.value,
        exp_to_sat: saturation.experiences,
        term_perf: terminal.value,
        exp_to_term_perf: terminal.experiences,
        avg_perf: average_performance::of(lifetime, regime),
    }
}

fn judge_task(
    lifetime: &Lifetime,
    regimes: &[RegimeMetrics],
    transfers: &Transfers,
    task: &str,
    options: &Options,
) -> TaskMetrics {
    let averages = average_performance::of_task(lifetime, task);
    let recovery_times = recovery_time::of_task(lifetime, regimes, task);
    let maintenance = performance_maintenance::of_task(lifetime, regimes, task);
    let mrlep = options.maintenance_method.has_mrlep().then_some(maintenance.mrlep);
    let mrtlp = options.maintenance_method.has_mrtlp().then_some(maintenance.mrtlp);
    let relative = ste_relative_performance::of_task(lifetime, task, options.ste_averaging_method);
    let efficiency = sample_efficiency::of_task(lifetime, task, options.ste_averaging_method);
    let performances = || {
        lifetime
            .regimes_of(task)
            .flat_map(|regime| regime.performance.iter().copied())
    };
    TaskMetrics {
        perf_recovery: performance_recovery::of(&recovery_times),
        avg_train_perf: average_performance::mean_of_regimes(&averages.train),
        avg_eval_perf: average_performance::mean_of_regimes(&averages.eval),
        perf_maintenance_mrlep: mrlep.as_deref().and_then(performance_maintenance::mean_of_runs),
        perf_maintenance_mrtlp: mrtlp.as_deref().and_then(performance_maintenance::mean_of_runs),
        forward_transfer_ratio: transfers.forward_ratio.as_ref().map(|pairs| pairs.of_trained(task)),
        backward_transfer_ratio: transfers.backward_ratio.as_ref().map(|pairs| pairs.of_trained(task)),
        forward_transfer_contrast: transfers.forward_contrast.as_ref().map(|pairs| pairs.of_trained(task)),
        backward_transfer_contrast: transfers.backward_contrast.as_ref().map(|pairs| pairs.of_trained(task)),
        ste_rel_perf: crate::statistics::mean(&relative),
        sample_efficiency: crate::statistics::mean(&efficiency.sample_efficiency_vals),
        recovery_times,
        avg_train_perf_vals: averages.train,
        avg_eval_perf_vals: averages.eval,
        maintenance_val_mrlep: mrlep,
        maintenance_val_mrtlp: mrtlp,
        ste_rel_perf_vals: relative,
        ste_saturation_vals: efficiency.ste_saturation_vals,
        ste_exp_to_sat_vals: efficiency.ste_exp_to_sat_vals,
        se_saturation_vals: efficiency.se_saturation_vals,
        se_exp_to_sat_vals: efficiency.se_exp_to_sat_vals,
        sample_efficiency_vals: efficiency.sample_efficiency_vals,
        se_task_saturation: efficiency.task_saturation,
        se_task_exp_to_sat: efficiency.task_exp_to_sat,
        min: performances().fold(f64::INFINITY, f64::min),
        max: performances().fold(f64::NEG_INFINITY, f64::max),
        num_lx: num_rows(lifetime.regimes_of(task), BlockType::Train),
        num_ex: num_rows(lifetime.regimes_of(task), BlockType::Test),
    }
}

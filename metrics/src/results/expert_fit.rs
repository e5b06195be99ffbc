//! Checks whether experts are comparable with the lifetime: the agent, the training budget, and the worlds.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::lifetime::{Budget, Lifetime, SteRun, budgets};
use crate::{Log, Options, VariantMode};

/// The same quantity for a lifetime and for an expert.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct BesideExpert<T> {
    /// The lifetime's value.
    pub lifetime: T,
    /// The expert's value.
    pub expert: T,
}

/// An expert's training compared with the lifetime's.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ExpertFit {
    /// The expert's log.
    pub run: String,
    /// The agents, from `agent` in `scenario_info.json`; `None` if either is not logged.
    pub agent: Option<BesideExpert<String>>,
    /// Learning experiences of the task, including those of a drift that are nearer to it.
    pub learned: BesideExpert<usize>,
    /// Learning experiences before deployment, of any task: a lifetime and its experts should share them.
    pub before_deployment: BesideExpert<usize>,
    /// Distinct worlds of the learning experiences, by seed and index; `None` if either log does not give them.
    pub worlds: Option<BesideExpert<usize>>,
    /// Worlds that both learned in.
    pub shared_worlds: Option<usize>,
    /// Differences as text; empty if the logs show none.
    pub differences: Vec<String>,
}

/// The experts that each task is compared with. Empty if variants do not count: an expert then covers one variant, but a task all
/// of them.
pub(crate) fn expert_fits(log: &Log, lifetime: &Lifetime, options: &Options) -> IndexMap<String, Vec<ExpertFit>> {
    if options.variant_mode == VariantMode::Agnostic {
        return IndexMap::new();
    }
    let budgets = budgets(log, lifetime.regimes(), options);
    let no_budget = Budget::default();
    let before = budgets.values().map(|own| own.before).sum();
    let agent = log.scenario_info.agent();
    let of_task = |task: &String| {
        let own = budgets.get(task).unwrap_or(&no_budget);
        let runs = lifetime.experts_of(task).iter();
        let fits: Vec<ExpertFit> = runs.map(|run| fit(run, agent.as_ref(), own, before)).collect();
        // A task that is only evaluated is not learned in the lifetime, so there is nothing to compare.
        (!fits.is_empty() && own.learned > 0).then(|| (task.clone(), fits))
    };
    lifetime.tasks().iter().filter_map(of_task).collect()
}

fn fit(run: &SteRun, agent: Option<&String>, own: &Budget, before: usize) -> ExpertFit {
    let expert = &run.budget;
    let worlds = own.worlds.as_ref().zip(expert.worlds.as_ref());
    let shared = worlds.map(|(own, expert)| own.intersection(expert).count());
    let found = ExpertFit {
        run: run.name.clone(),
        agent: (agent.cloned().zip(run.agent.clone())).map(|(own, expert)| pair(own, expert)),
        learned: pair(own.learned, expert.learned),
        before_deployment: pair(before, expert.before),
        worlds: worlds.map(|(own, expert)| pair(own.len(), expert.len())),
        shared_worlds: shared,
        differences: Vec::new(),
    };
    ExpertFit {
        differences: differences(&found),
        ..found
    }
}

fn pair<T>(lifetime: T, expert: T) -> BesideExpert<T> {
    BesideExpert { lifetime, expert }
}

fn differences(fit: &ExpertFit) -> Vec<String> {
    let mut found = Vec::new();
    let counts = [
        ("learning experiences", fit.learned),
        ("learning experiences before deployment", fit.before_deployment),
    ];
    for (what, counts) in counts {
        if counts.lifetime != counts.expert {
            found.push(format!(
                "it had {} {what}, the lifetime {}",
                counts.expert, counts.lifetime
            ));
        }
    }
    if let (Some(worlds), Some(shared)) = (fit.worlds, fit.shared_worlds)
        && (shared != worlds.lifetime || shared != worlds.expert)
    {
        found.push(format!(
            "{shared} of its {} worlds are among the lifetime's {}",
            worlds.expert, worlds.lifetime
        ));
    }
    if let Some(agents) = &fit.agent
        && agents.lifetime != agents.expert
    {
        found.push(format!(
            "its agent is {:?}, the lifetime's {:?}",
            agents.expert, agents.lifetime
        ));
    }
    found
}

/// A sentence for each expert that is not comparable with the lifetime.
pub(crate) fn incomparable_experts(fits: &IndexMap<String, Vec<ExpertFit>>) -> Vec<String> {
    let mut found = Vec::new();
    for (task, fits) in fits {
        for ExpertFit { run, differences, .. } in fits.iter().filter(|fit| !fit.differences.is_empty()) {
            let differences = differences.join("; ");
            found.push(format!(
                "the expert {run} of {task} is not like for like: {differences}"
            ));
        }
    }
    found
}

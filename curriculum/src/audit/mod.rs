//! [`audit`]: checks a scenario's scores with agents of known behaviour.
//!
//! The agents are simulated, so no world is run. Experts and metrics work as for any other lifetime.

mod agents;
mod simulation;

use std::path::Path;

use driftworld_metrics::{
    LifetimeMetrics, Log, MaintenanceMethod, Options, Reading, SteLog, TransferMethod, score, student_reach,
};
use driftworld_spec::Scenario;
use serde::Serialize;

use agents::{by_number, forgets, learns_while_frozen, never_learns, own_expert};
use simulation::{Simulated, simulate};

use crate::{CurriculumError, Plan, experts_of};

/// The result for one agent.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AuditRow {
    /// The agent.
    pub agent: &'static str,
    /// The result that a trustworthy protocol gives.
    pub expected: &'static str,
    /// The result that this protocol gives.
    pub found: String,
    /// Whether the result is as expected; `None` if this scenario cannot test it.
    pub passed: Option<bool>,
}

/// Options of an audit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AuditOptions {
    /// Lifetimes of the agent that never learns; default 100, at least 1.
    pub lifetimes: u32,
    /// Lifetimes of every other agent; default 20, at least 2.
    pub repeats: u32,
}

impl Default for AuditOptions {
    fn default() -> Self {
        Self {
            lifetimes: 100,
            repeats: 20,
        }
    }
}

/// Largest share of lifetimes that a metric may call "good" if the agent never learns.
const FALSE_POSITIVES: f64 = 0.05;

/// The audit fails if the number of good verdicts is less probable than this; small because each audit tests several metrics.
const SURPRISE: f64 = 0.001;

/// The confidence at which an audit rejects a mean ratio: three standard errors with many lifetimes, more with few, because the
/// standard error is then uncertain.
const CONFIDENCE: f64 = 0.9973;

/// Allowed error of a ratio whose true value is 1, beyond its standard error.
const RATIO_SLACK: f64 = 0.02;

/// Runs a scenario with five simulated agents whose true scores are known, and checks the scores that its protocol gives them.
///
/// - *never learns*: its expected reward never changes. No metric may call more than 5 % of its lifetimes good.
/// - *learns while frozen*: improves by being evaluated. The check of [`run`](crate::run) must refuse it.
/// - *remembers by number*: repeats what paid best in the experience with the same number in an earlier block. It must not be
///   better than its experts.
/// - *its own expert*: learns every variant as if there were no others. Relative performance and sample efficiency must be 1.
/// - *forgets*: new learning replaces the old. Maintenance must be bad, and forward transfer not good.
///
/// Every reward is 100 times a skill in 0..=1, plus luck of the layout (standard deviation 10) and of the episode (20). `plan`
/// resolves the tasks and worlds that a scenario names; logs are written into `folder`, which must be empty, and can be removed
/// afterwards.
///
/// # Errors
/// [`CurriculumError`] if the scenario or its experts cannot be planned, or a log cannot be written or scored.
pub fn audit(
    scenario: &Scenario,
    plan: &mut dyn FnMut(&Scenario) -> Result<Plan, CurriculumError>,
    folder: &Path,
    options: AuditOptions,
) -> Result<Vec<AuditRow>, CurriculumError> {
    let lifetime = plan(scenario)?;
    let experts = experts_of(scenario)?;
    let experts = experts.iter().map(plan).collect::<Result<Vec<_>, _>>()?;
    let case = Case {
        lifetime: &lifetime,
        experts: &experts,
        folder,
        repeats: options.repeats.max(2),
    };
    let never = "each metric good in at most 5 % of lifetimes";
    let own = "ste_rel_perf and sample_efficiency 1";
    let rows = [
        ("never learns", never, case.never_learns(options.lifetimes.max(1))?),
        ("learns while frozen", "refused", case.learns_while_frozen()?),
        ("remembers by number", "ste_rel_perf not above 1", case.by_number()?),
        ("its own expert", own, case.own_expert()?),
        ("forgets", "maintenance bad, forward transfer not good", case.forgets()?),
    ];
    let row = |(agent, expected, (found, passed))| AuditRow {
        agent,
        expected,
        found,
        passed,
    };
    Ok(rows.map(row).into())
}

/// The result for an agent, and whether it is as expected.
type Found = (String, Option<bool>);

/// The plans of an audit, the folder of its logs, and the number of repeats.
struct Case<'a> {
    lifetime: &'a Plan,
    experts: &'a [Plan],
    folder: &'a Path,
    repeats: u32,
}

impl Case<'_> {
    fn never_learns(&self, lifetimes: u32) -> Result<Found, CurriculumError> {
        let mut good: Vec<(String, u32)> = Vec::new();
        for run in 0..lifetimes {
            let scores = scored(&self.log(self.lifetime, &mut never_learns(run), "still", run)?, &[])?;
            for (name, reading) in readings(&scores) {
                let is_good = u32::from(reading == Reading::Good);
                match good.iter_mut().find(|(known, _)| *known == name) {
                    Some((_, count)) => *count += is_good,
                    None => good.push((name, is_good)),
                }
            }
        }
        let max_good = (0..lifetimes).find(|count| tail(*count + 1, lifetimes, FALSE_POSITIVES) < SURPRISE);
        let max_good = max_good.unwrap_or(lifetimes);
        let worst = good.iter().max_by_key(|(_, count)| *count);
        let found = worst.map_or_else(
            || "no metric to calibrate: no variant is evaluated both before and after it is learned".to_owned(),
            |(name, count)| format!("at most {count} of {lifetimes} ({name}); up to {max_good} may be chance"),
        );
        Ok((found, worst.map(|(_, count)| *count <= max_good)))
    }

    fn learns_while_frozen(&self) -> Result<Found, CurriculumError> {
        let folder = self.folder.join("frozen");
        let found = match simulation::run(self.lifetime, &mut learns_while_frozen(), &folder) {
            Err(CurriculumError::NotFrozen { experience, .. }) => {
                (format!("refused at experience {experience}"), Some(true))
            }
            Err(error) => return Err(error),
            Ok(0) => ("nothing is evaluated".to_owned(), None),
            Ok(num_evaluated) => (format!("not noticed in {num_evaluated} evaluations"), Some(false)),
        };
        remove(&folder);
        Ok(found)
    }

    fn by_number(&self) -> Result<Found, CurriculumError> {
        let ratios = self.compare_with_experts("ste_rel_perf", |run, number| Box::new(by_number(run, number)))?;
        Ok(match Ratio::of(&ratios) {
            Some(ratio) => {
                let text = format!("{ratio} (standard error, {} lifetimes)", ratios.len());
                (text, Some(ratio.mean <= 1.0 + ratio.slack()))
            }
            None => (self.no_experts(), None),
        })
    }

    fn own_expert(&self) -> Result<Found, CurriculumError> {
        let pace = pace(self.lifetime);
        let mut found = Vec::new();
        let mut passed = None;
        for metric in ["ste_rel_perf", "sample_efficiency"] {
            let ratios = self.compare_with_experts(metric, |run, number| Box::new(own_expert(run, number, pace)))?;
            let Some(ratio) = Ratio::of(&ratios) else {
                continue;
            };
            found.push(format!("{metric} {ratio}"));
            passed = Some(passed.unwrap_or(true) && (ratio.mean - 1.0).abs() <= ratio.slack());
        }
        let found = if found.is_empty() {
            self.no_experts()
        } else {
            found.join(", ")
        };
        Ok((found, passed))
    }

    /// Why nothing is compared with experts.
    fn no_experts(&self) -> String {
        let regimes = self.lifetime.scenario().blocks.iter().flat_map(|block| &block.regimes);
        if regimes.into_iter().any(|regime| regime.drift.is_some()) {
            "a drift is learned under a name of its own, which no expert learns: no experts to compare with".to_owned()
        } else {
            "no experts to compare with".to_owned()
        }
    }

    fn forgets(&self) -> Result<Found, CurriculumError> {
        let pace = pace(self.lifetime);
        let (mut bad, mut good, mut maintained, mut transferred) = (0, 0, 0, 0);
        for run in 0..self.repeats {
            let scores = scored(&self.log(self.lifetime, &mut forgets(run, pace), "forgets", run)?, &[])?;
            for (name, reading) in readings(&scores) {
                match name.as_str() {
                    "perf_maintenance_mrlep" => {
                        maintained += 1;
                        bad += u32::from(reading == Reading::Bad);
                    }
                    "forward_transfer_contrast" => {
                        transferred += 1;
                        good += u32::from(reading == Reading::Good);
                    }
                    _ => {}
                }
            }
        }
        let is_rare = transferred == 0 || tail(good, transferred, FALSE_POSITIVES) >= SURPRISE;
        let found = if maintained == 0 {
            "nothing is evaluated after something else was learned".to_owned()
        } else {
            format!("maintenance bad in {bad} of {maintained}, forward transfer good in {good} of {transferred}")
        };
        Ok((found, (maintained > 0).then_some(5 * bad >= 4 * maintained && is_rare)))
    }

    /// The values of a metric that compares with experts, one for each repeat in which the lifetime has the metric. `agent`
    /// gets the numbers of the repeat and of the log: 0 for the lifetime, then the experts.
    fn compare_with_experts(
        &self,
        metric: &str,
        agent: impl Fn(u32, u32) -> Box<Simulated<'static>>,
    ) -> Result<Vec<f64>, CurriculumError> {
        let mut values = Vec::new();
        for run in 0..self.repeats {
            let log = self.log(self.lifetime, agent(run, 0).as_mut(), "lifetime", run)?;
            let mut experts = Vec::new();
            for (number, expert) in (1..).zip(self.experts) {
                let log = self.log(expert, agent(run, number).as_mut(), &format!("expert{number}"), run)?;
                experts.push(SteLog::new(log)?);
            }
            values.extend(scored(&log, &experts)?.lifetime.number(metric));
        }
        Ok(values)
    }

    fn log(&self, plan: &Plan, agent: &mut Simulated<'_>, name: &str, run: u32) -> Result<Log, CurriculumError> {
        let folder = self.folder.join(format!("{name}-{run}"));
        let log = simulate(plan, agent, &folder)?;
        remove(&folder);
        Ok(log)
    }
}

/// Number of experiences of a variant after which an agent has learned about two thirds: a third of the first learning
/// block.
fn pace(plan: &Plan) -> f64 {
    let is_learning = |block: &&driftworld_spec::Block| block.kind == driftworld_spec::BlockKind::Learning;
    let first = plan.scenario().blocks.iter().find(is_learning);
    first.map_or(1.0, |block| block.num_experiences() as f64 / 3.0).max(1.0)
}

fn scored(log: &Log, experts: &[SteLog]) -> Result<LifetimeMetrics, CurriculumError> {
    let options = Options {
        maintenance_method: MaintenanceMethod::Both,
        transfer_method: TransferMethod::Both,
        ..Options::default()
    };
    Ok(score(log, experts, &options)?)
}

/// The reading of each metric that depends on evaluations alone.
fn readings(scores: &LifetimeMetrics) -> Vec<(String, Reading)> {
    let reading = |name: &String| Some((name.clone(), *scores.readings.get(name)?));
    scores.null_bands.keys().filter_map(reading).collect()
}

/// Statistics of a ratio over lifetimes.
struct Ratio {
    mean: f64,
    error: f64,
    /// Degrees of freedom of the error.
    dof: f64,
}

impl Ratio {
    fn of(values: &[f64]) -> Option<Self> {
        if values.len() < 2 {
            return None;
        }
        let count = values.len() as f64;
        let dof = count - 1.0;
        let mean = values.iter().sum::<f64>() / count;
        let squares = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
        let error = (squares / dof / count).sqrt();
        Some(Self { mean, error, dof })
    }

    /// Allowed distance of the mean from the true value.
    fn slack(&self) -> f64 {
        student_reach(CONFIDENCE, self.dof) * self.error + RATIO_SLACK
    }
}

impl std::fmt::Display for Ratio {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:.3} ± {:.3}", self.mean, self.error)
    }
}

/// The probability of at least `least` hits in `tries` trials with hit probability `probability`.
fn tail(least: u32, tries: u32, probability: f64) -> f64 {
    // Starts with no hit; each further term follows from the one before.
    let mut mass = (1.0 - probability).powi(tries.cast_signed());
    let mut below = 0.0;
    for hits in 0..least.min(tries + 1) {
        below += mass;
        mass *= f64::from(tries - hits) / f64::from(hits + 1) * probability / (1.0 - probability);
    }
    1.0 - below
}

/// Removes a log that has been read. A failure is harmless: the whole folder is removed later.
fn remove(folder: &Path) {
    std::fs::remove_dir_all(folder).ok();
}

#[cfg(test)]
mod tests {
    use super::agents::normal;
    use super::*;

    #[test]
    fn correct_ratios_are_rejected_at_the_nominal_rate_for_few_lifetimes() {
        const TRIES: u64 = 10_000;
        for lifetimes in [2, 3, 5, 20] {
            // Lifetimes vary so much that the slack for small differences hardly matters.
            let drawn = |id| (0..lifetimes).map(move |index| 1.0 + 10.0 * normal("ratio", &[lifetimes, id, index]));
            // The allowed distance is the same in all tries, so it is computed once.
            let unit = Ratio {
                mean: 1.0,
                error: 1.0,
                dof: (lifetimes - 1) as f64,
            };
            let reach = unit.slack() - RATIO_SLACK;
            let is_off = |id: &u64| {
                let ratio = Ratio::of(&drawn(*id).collect::<Vec<_>>()).unwrap();
                (ratio.mean - 1.0).abs() > reach * ratio.error + RATIO_SLACK
            };
            let off = (0..TRIES).filter(is_off).count();
            // Four standard errors of a share of 0.0027 on either side: this also detects bounds that are too wide.
            assert!((7..48).contains(&off), "{lifetimes} lifetimes: {off}");
        }
        // With 20 lifetimes, an error of twice their standard deviation is detected.
        let off: Vec<f64> = (0..20).map(|index| 3.0 + normal("off", &[index])).collect();
        let ratio = Ratio::of(&off).unwrap();
        assert!((ratio.dof - 19.0).abs() < 1e-9, "{}", ratio.dof);
        assert!(ratio.mean - 1.0 > ratio.slack(), "{ratio}");
    }

    #[test]
    fn tails_match_the_binomial() {
        assert!((tail(0, 10, 0.3) - 1.0).abs() < 1e-12);
        assert!((tail(1, 10, 0.05) - (1.0 - 0.95_f64.powi(10))).abs() < 1e-12);
        // All 8 outcomes of three tries, one by one.
        let (probability, mut two) = (0.3_f64, 0.0);
        for outcome in 0..8_u32 {
            let hits = outcome.count_ones();
            if hits >= 2 {
                two += probability.powi(hits.cast_signed()) * (1.0 - probability).powi(3 - hits.cast_signed());
            }
        }
        assert!((tail(2, 3, probability) - two).abs() < 1e-12);
    }
}

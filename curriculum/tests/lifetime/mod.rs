//! Runs small scenarios: their logs are complete, repeatable, scorable, and can be resumed.

mod frozen;
mod learners;
mod resume;
mod rollout;

use std::path::Path;
use std::sync::{Arc, Mutex};

use driftworld_curriculum::{
    Choice, CurriculumError, Design, Drifting, FoundWorld, Journal, Plan, Sources, Summary, design, relearn,
};
use driftworld_env::{Action, Agent, Environment, Label, OnRailsAgent, RandomAgent, SarsaAgent, Step};
use driftworld_metrics::{MaintenanceMethod, Options, Record, Row, read_log, score};
use driftworld_similarity::{Weights, variant_distance};
use driftworld_spec::{
    Block, BlockKind, BlockMix, Element, Phase, Regime, RegimeDrift, Scenario, ScenarioForm, TaskLabel, TaskSpec,
    Value, World,
};

use crate::files_below::files_below;
use crate::run_settings::RunSettings;

fn task() -> Arc<TaskSpec> {
    let path = format!("{}/../examples/tasks/find_objects.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the example tasks ship with the project");
    TaskSpec::from_json("find_objects.json", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn scenario(variants: &[&str]) -> Scenario {
    let choices: Vec<Choice> = variants.iter().map(|name| Choice::new("find_objects", *name)).collect();
    let options = Design {
        name: "small".to_owned(),
        learn: 3,
        evaluate: 2,
        seed: 5,
        ..Design::default()
    };
    design(&choices, &options).expect("the design is valid")
}

fn plan(scenario: &Scenario) -> Result<Plan, CurriculumError> {
    let task = task();
    let mut sources = Sources {
        task: &mut |name| match name {
            "find_objects" => Ok(Arc::clone(&task)),
            _ => Err("no such task".to_owned()),
        },
        world: &mut |path| match path {
            "yard.json" => Ok(FoundWorld {
                world: yard(),
                note: Some("made up".to_owned()),
            }),
            "hill.json" | "behind.json" => Ok(FoundWorld {
                world: frozen::hill(if path == "hill.json" { 20 } else { -20 }),
                note: None,
            }),
            _ => Err(format!("{path}: not there")),
        },
    };
    Plan::new(scenario, &mut sources)
}

/// A world in which only the step limit ends an episode.
fn yard() -> World {
    let text = r#"{ "max_steps": 40, "objects": [{ "class": "tree", "coordinates": [3, 4] }] }"#;
    World::from_json("yard.json", text).unwrap_or_else(|error| panic!("{error}"))
}

/// Runs a scenario.
fn run_with(
    scenario: &Scenario,
    agent: &mut dyn Agent,
    folder: &Path,
    settings: &RunSettings,
) -> Result<Summary, CurriculumError> {
    settings.run(&plan(scenario)?, agent, folder)
}

fn run_scenario(
    scenario: &Scenario,
    agent: &mut dyn Agent,
    folder: &Path,
    max_experiences: u64,
) -> Result<Summary, CurriculumError> {
    run_with(
        scenario,
        agent,
        folder,
        &RunSettings {
            max_experiences,
            ..RunSettings::default()
        },
    )
}

fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder can be created")
}

/// All files of a log, as one string.
fn log_text(folder: &Path) -> String {
    assert!(folder.is_dir(), "{}: there is no log", folder.display());
    let files = files_below(folder).into_values();
    let texts = files.map(|bytes| String::from_utf8(bytes).expect("logs are text"));
    texts.collect::<Vec<_>>().join("\n")
}

#[test]
fn lifetime_is_logged_and_can_be_scored() {
    let (folder, scenario) = (scratch(), scenario(&["blue", "red"]));
    let log = folder.path().join("log");
    let summary =
        run_scenario(&scenario, &mut OnRailsAgent::new(), &log, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    assert!(summary.finished);
    assert_eq!((summary.experiences, scenario.num_experiences()), (18, 18));
    assert!(
        summary
            .regimes
            .iter()
            .all(|regime| regime.success_rate == 1.0 && regime.mean_reward > 400.0)
    );
    let read = read_log(&log).unwrap_or_else(|error| panic!("{error}"));
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    let options = Options {
        maintenance_method: MaintenanceMethod::Both,
        ..Options::default()
    };
    let scores = score(&read, &[], &options).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((scores.num_lx, scores.num_ex), (6, 12));
    assert_eq!(
        scores.lifetime.number("perf_maintenance_mrlep"),
        Some(0.0),
        "the same worlds, an agent that does not learn"
    );
    assert_eq!(scores.lifetime.number("forward_transfer_ratio"), Some(1.0));
    assert_eq!(scores.lifetime.number("backward_transfer_ratio"), Some(1.0));
}

#[test]
fn lifetime_is_repeatable_byte_for_byte_and_agents_differ() {
    let folder = scratch();
    let run_log = |name: &str, agent: &mut dyn Agent| {
        let log = folder.path().join(name);
        run_scenario(&scenario(&["red", "dusk"]), agent, &log, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
        log_text(&log)
    };
    let first = run_log("first", &mut RandomAgent::new(0));
    assert_eq!(
        first,
        run_log("second", &mut RandomAgent::new(99)),
        "the agent's random numbers come from the scenario"
    );
    assert_ne!(first, run_log("third", &mut OnRailsAgent::new()));
}

#[test]
fn run_seed_repeats_the_same_worlds_and_is_logged() {
    let plan = |seed| {
        let mut plan = plan(&scenario(&["red", "dusk"])).unwrap_or_else(|error| panic!("{error}"));
        plan.set_run_seed(seed);
        plan
    };
    let (own, again, other) = (plan(0), plan(5), plan(6));
    let seeds = |plan: &Plan| {
        let seed = |number| {
            plan.experience_spec(number)
                .unwrap_or_else(|error| panic!("{error}"))
                .agent_seed
        };
        (0..plan.num_experiences()).map(seed).collect::<Vec<_>>()
    };
    assert_eq!(seeds(&again), seeds(&plan(5)));
    for (a, b) in [(&own, &again), (&again, &other)] {
        assert!(seeds(a).iter().zip(seeds(b)).all(|(a, b)| *a != b));
        let world = |plan: &Plan, number| plan.world(number).unwrap_or_else(|error| panic!("{error}"));
        assert!((0..own.num_experiences()).all(|number| world(a, number) == world(b, number)));
    }
}

#[test]
fn joint_block_interleaves_every_world_once_as_one_regime_per_task() {
    let choices = ["red", "dusk"].map(|name| Choice::new("find_objects", name));
    let options = Design {
        name: "joint".to_owned(),
        form: Some(ScenarioForm::Joint),
        learn: 8,
        evaluate: 2,
        seed: 5,
        ..Design::default()
    };
    let scenario = design(&choices, &options).expect("the design is valid");
    let shuffled = plan(&scenario).unwrap_or_else(|error| panic!("{error}"));
    let mut in_order = scenario.clone();
    for block in &mut in_order.blocks {
        block.mix = BlockMix::InOrder;
    }
    let in_order = plan(&in_order).unwrap_or_else(|error| panic!("{error}"));
    let specs = |plan: &Plan| {
        let spec = |number| {
            let spec = plan.experience_spec(number).unwrap_or_else(|error| panic!("{error}"));
            (spec.block, spec.variant.to_owned(), spec.seed, spec.index)
        };
        (0..plan.num_experiences()).map(spec).collect::<Vec<_>>()
    };
    let (mut found, mut expected) = (specs(&shuffled), specs(&in_order));
    assert_ne!(found, expected);
    let learned: Vec<&str> = found[4..20].iter().map(|spec| spec.1.as_str()).collect();
    assert!(learned.chunk_by(|a, b| a == b).count() > 4, "{learned:?}");
    found.sort();
    expected.sort();
    assert_eq!(found, expected);

    let (whole, cut) = (scratch(), scratch());
    let (whole, cut) = (whole.path().join("log"), cut.path().join("log"));
    run_scenario(&scenario, &mut RandomAgent::new(0), &whole, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    run_scenario(&scenario, &mut RandomAgent::new(0), &cut, 11).unwrap_or_else(|error| panic!("{error}"));
    let settings = RunSettings {
        resume: true,
        ..RunSettings::default()
    };
    let summary =
        run_with(&scenario, &mut RandomAgent::new(0), &cut, &settings).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(log_text(&whole), log_text(&cut));
    assert_eq!(summary.regimes.len(), 6);
    assert!(summary.regimes[2..4].iter().all(|regime| regime.experiences == 8));
    let log = read_log(&whole).unwrap_or_else(|error| panic!("{error}"));
    let scores = score(&log, &[], &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(scores.regimes.len(), 6);
}

/// `DRIFTWORLD_UPDATE_GOLDEN=1` rewrites the file.
#[test]
fn golden_log_is_unchanged() {
    let folder = scratch();
    let log = folder.path().join("log");
    run_scenario(&scenario(&["huddle"]), &mut OnRailsAgent::new(), &log, u64::MAX)
        .unwrap_or_else(|error| panic!("{error}"));
    let found = log_text(&log);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/log.txt");
    if std::env::var_os("DRIFTWORLD_UPDATE_GOLDEN").is_some() {
        std::fs::write(path, &found).expect("the golden file can be written");
    }
    assert_eq!(
        found,
        std::fs::read_to_string(path).expect("the golden file is committed")
    );
}

#[test]
fn unplayable_scenarios_are_refused_with_block_and_regime() {
    let folder = scratch();
    let mut misspelled = scenario(&["blue"]);
    misspelled.blocks[1].regimes[0].variant = "bleu".to_owned();
    let error = run_scenario(
        &misspelled,
        &mut RandomAgent::new(0),
        &folder.path().join("a"),
        u64::MAX,
    )
    .expect_err("no such variant");
    assert_eq!(
        error.to_string(),
        "block 1, regime 0: find_objects#bleu: find_objects: found variant \"bleu\", expected one of blue, red, green, \
         dusk, huddle, penalty, spheres, clearing, wide, modest, poor, half, turned, interact, near, held, long_held, slim, slow, \
         stiff and 17 more; did you mean \"blue\"?"
    );
    let log = folder.path().join("b");
    run_scenario(&scenario(&["blue"]), &mut RandomAgent::new(0), &log, 1).unwrap_or_else(|error| panic!("{error}"));
    let error =
        run_scenario(&scenario(&["blue"]), &mut RandomAgent::new(0), &log, 1).expect_err("a log is never overwritten");
    assert_eq!(error.code(), "curriculum/log");
}

/// A lifetime with every kind of regime: before deployment, drawn, drifting, from a world file, cut short, with a budget.
fn varied() -> Scenario {
    let drawn = |variant: &str, count| Regime {
        seed: 3,
        ..Regime::new("find_objects", variant, count)
    };
    let short = |regime: Regime| Regime {
        max_steps: Some(60),
        ..regime
    };
    let drift = Regime {
        drift: Some(RegimeDrift::to("dusk")),
        ..drawn("red", 3)
    };
    let world = Regime {
        world: Some("yard.json".to_owned()),
        ..Regime::new("Task 1", "yard", 2)
    };
    // Two experiences of 60 steps use up the budget.
    let budgeted = Regime {
        steps: Some(61),
        ..drawn("blue", 9)
    };
    let mut before = Block::new(BlockKind::Learning, vec![short(budgeted)]);
    before.phase = Phase::PreDeployment;
    let evaluation = || Block::new(BlockKind::Evaluation, vec![short(drawn("blue", 2)), world.clone()]);
    let learning = Block::new(BlockKind::Learning, vec![short(drawn("red", 2)), short(drift)]);
    Scenario::new("varied", vec![before, evaluation(), learning, evaluation()])
}

fn rows(folder: &Path) -> Vec<Record> {
    let log = driftworld_metrics::read_log_with_texts(folder).unwrap_or_else(|error| panic!("{error}"));
    let with_texts = |row: Row| {
        let record = row.to_record();
        row.texts()
            .fold(record, |record, (name, text)| record.with_text(name, text))
    };
    log.rows.iter().map(with_texts).collect()
}

#[test]
fn log_is_the_same_for_any_number_of_jobs() {
    let folder = scratch();
    let run_log = |jobs: usize, agent: &mut dyn Agent| {
        let log = folder.path().join(format!("{jobs}"));
        let summary = run_with(
            &varied(),
            agent,
            &log,
            &RunSettings {
                jobs,
                ..RunSettings::default()
            },
        );
        (log_text(&log), summary.unwrap_or_else(|error| panic!("{error}")))
    };
    let one = run_log(1, &mut RandomAgent::new(0));
    assert!(one.1.finished && one.1.experiences == 15, "{:?}", one.1);
    for jobs in [2, 5, 32] {
        assert_eq!(one, run_log(jobs, &mut RandomAgent::new(1)), "{jobs} at a time");
    }
}

#[test]
fn every_row_has_the_distance_to_the_last_learned_variant() {
    let folder = scratch();
    let log = folder.path().join("log");
    run_scenario(&varied(), &mut RandomAgent::new(0), &log, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    let rows = rows(&log);
    let distance = |row: usize, element: &str| rows[row].metrics[&format!("distance{element}")];
    // Experiences: 0-1 blue before deployment, 2-3 blue, 4-5 yard, 6-7 red, 8-10 red to dusk, 11-12 blue, 13-14 yard.
    assert!(
        (0..2).all(|row| distance(row, "").is_nan()),
        "nothing has been learned yet"
    );
    assert!((2..4).all(|row| distance(row, "") == 0.0), "the same variant");
    assert!(
        (4..6).all(|row| distance(row, "") > 0.0 && distance(row, "_reward") > 0.0),
        "another world"
    );
    for row in 6..8 {
        assert!(distance(row, "_observation") > 0.0, "red is not blue");
        assert_eq!([distance(row, "_reward"), distance(row, "_action")], [0.0, 0.0]);
    }
    assert_eq!(distance(8, ""), 0.0, "the drift begins at the variant learned last");
    assert!(distance(8, "") < distance(9, "") && distance(9, "") < distance(10, ""));
    assert!(
        distance(11, "_observation") > 0.0,
        "from dusk, the end of the drift, to blue"
    );
    let names: Vec<&str> = [0, 4, 6, 8].map(|row| rows[row].task_name.as_str()).to_vec();
    assert_eq!(
        names,
        [
            "findobjects_blue",
            "task1_yard",
            "findobjects_red",
            "findobjects_redtodusk"
        ]
    );
    assert_eq!(rows[9].metrics["progress"], 0.5);
    assert_eq!(rows[0].task_params["phase"], "pre_deployment");
    let read = read_log(&log).unwrap_or_else(|error| panic!("{error}"));
    let scores = score(&read, &[], &Options::default()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(
        (scores.num_lx, scores.num_ex),
        (5, 8),
        "pre-deployment experiences are not scored"
    );
}

#[test]
fn drift_to_a_generated_variant_logs_the_distances_of_its_end() {
    let bright = Choice {
        values: [("light".to_owned(), Value::Number(4.0))].into_iter().collect(),
        name: Some("bright".to_owned()),
        ..Choice::new("find_objects", "blue")
    };
    let options = Design {
        learn: 3,
        evaluate: 1,
        drifting: Some(Drifting::default()),
        task_label: TaskLabel::Info,
        ..Design::default()
    };
    let scenario = design(&[Choice::new("find_objects", "blue"), bright], &options).expect("the design is valid");
    Scenario::from_json("designed", &scenario.to_json_pretty()).expect("a design is a valid document");
    let folder = scratch();
    let log = folder.path().join("log");
    run_scenario(&scenario, &mut RandomAgent::new(0), &log, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    let read = read_log(&log).unwrap_or_else(|error| panic!("{error}"));
    let task = task();
    let blue = task.variant("blue").expect("the task declares it");
    let end = blue
        .with("bright", [("light".to_owned(), Value::Number(4.0))])
        .expect("the light goes to 4");
    let distance_to_end = variant_distance(&blue, &end, &Weights::of_task(&task)).expect("both belong to one task");
    assert!(distance_to_end.total > 0.0);
    // 0-1 blue and bright, 2-4 blue to bright, 5-6 blue and bright: from bright, the end of the drift.
    let logged = |row: usize| {
        let metric = |name: &str| read.rows.metric(name).expect("the column exists")[row];
        (metric("distance"), metric("distance_observation"))
    };
    let expected = (
        distance_to_end.total,
        distance_to_end.element(Element::O).expect("it has a light"),
    );
    assert_eq!(logged(5), expected, "blue is the start of the drift");
    assert_eq!(logged(6), (0.0, 0.0), "bright is the end of the drift");
    let made_from = &read.scenario_info.extra["made_from"];
    assert!(
        ["blue", "bright"]
            .iter()
            .all(|name| made_from[format!("find_objects#{name}")]["variant"].is_string())
    );
    assert_ne!(made_from["find_objects#blue"], made_from["find_objects#bright"]);
    assert_eq!(
        read.rows.get(2).expect("the log has seven rows").task_params()["to"],
        "bright"
    );
}

#[test]
fn step_limit_truncates_and_end_of_block_does_not() {
    /// The results of the last step of each experience.
    struct Witness(Vec<Step>);
    impl Agent for Witness {
        fn act(&mut self, _: &Environment) -> Action {
            Action::Continuous([0.0; 3])
        }
        fn learn(&mut self, _: &Environment, step: &Step) {
            if step.ended() {
                self.0.push(step.clone());
            }
        }
    }
    let folder = scratch();
    let log = folder.path().join("log");
    let regime = |max_steps| Regime {
        max_steps: Some(max_steps),
        ..Regime::new("find_objects", "blue", 1)
    };
    let learning = Block::new(BlockKind::Learning, vec![regime(7), regime(9)]);
    let mut witness = Witness(Vec::new());
    let scenario = Scenario::new("cut", vec![learning.clone(), learning]);
    run_scenario(&scenario, &mut witness, &log, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(witness.0.len(), 4);
    assert!(witness.0.iter().all(|step| step.truncated && !step.terminated));
    let rows = rows(&log);
    let steps: Vec<f64> = rows.iter().map(|row| row.metrics["episode_step_count"]).collect();
    assert_eq!(steps, [7.0, 9.0, 7.0, 9.0]);
    assert!(rows.iter().all(|row| row.metrics["truncated"] == 1.0));
    let log = folder.path().join("ended");
    run_scenario(&self::scenario(&["blue"]), &mut OnRailsAgent::new(), &log, u64::MAX)
        .unwrap_or_else(|error| panic!("{error}"));
    assert!(
        self::rows(&log)
            .iter()
            .all(|row| row.metrics["truncated"] == 0.0 && row.metrics["success"] == 1.0)
    );
}

/// The seed and the label of each experience, in order.
type Inputs = Vec<(u64, Option<Label>)>;

#[test]
fn missing_world_file_is_reported_before_anything_is_run() {
    let mut scenario = varied();
    scenario.blocks[1].regimes[1].world = Some("gone.json".to_owned());
    let error = plan(&scenario).err().expect("the world file does not exist");
    assert_eq!(error.to_string(), "block 1, regime 1: gone.json: not there");
    let folder = scratch();
    let log = folder.path().join("log");
    run_scenario(&varied(), &mut RandomAgent::new(0), &log, 1).unwrap_or_else(|error| panic!("{error}"));
    let info = read_log(&log)
        .unwrap_or_else(|error| panic!("{error}"))
        .scenario_info
        .extra;
    assert_eq!(info["notes"]["yard.json"], "made up");
    assert_eq!(info["made_from"]["Task 1#yard"], yard().hash());
}

//! Learning agents: order, labels, random numbers, and evaluations by copies.

use super::*;

/// Records its inputs; learns, and can be copied.
#[derive(Clone, Default)]
struct Pupil {
    inputs: Arc<Mutex<Inputs>>,
    label: Option<Label>,
    learned: u64,
}

impl Agent for Pupil {
    fn act(&mut self, _: &Environment) -> Action {
        // Moves faster the more it has learned.
        Action::Continuous([self.learned as f64 / 100.0, 0.0, 0.0])
    }
    fn begin(&mut self, seed: u64) {
        let label = self.label.take();
        self.inputs
            .lock()
            .expect("no test panics while holding it")
            .push((seed, label));
    }
    fn set_task_label(&mut self, label: &Label) {
        self.label = Some(label.clone());
    }
    fn learn(&mut self, _: &Environment, _: &Step) {
        self.learned += 1;
    }
    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(self.clone()))
    }
}

#[test]
fn learner_learns_in_order_and_is_evaluated_by_several_copies() {
    let folder = scratch();
    let run_pupil = |jobs: usize| {
        let (log, mut pupil) = (folder.path().join(format!("{jobs}")), Pupil::default());
        run_with(
            &varied(),
            &mut pupil,
            &log,
            &RunSettings {
                jobs,
                ..RunSettings::default()
            },
        )
        .unwrap_or_else(|error| panic!("{error}"));
        (log_text(&log), pupil.learned)
    };
    let (log, learned) = run_pupil(1);
    assert_eq!((log, learned), run_pupil(4));
    assert_eq!(
        learned,
        7 * 60,
        "seven learning experiences, each cut off after 60 steps"
    );
}

#[test]
fn label_is_passed_only_if_the_scenario_has_labels() {
    let folder = scratch();
    let inputs = |label: TaskLabel| {
        let (mut pupil, mut scenario) = (Pupil::default(), varied());
        scenario.task_label = label;
        let log = folder.path().join(format!("{label:?}"));
        run_scenario(&scenario, &mut pupil, &log, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
        let inputs = pupil.inputs.lock().expect("no test panics while holding it").clone();
        assert_eq!(inputs.len(), 15);
        inputs
    };
    assert!(inputs(TaskLabel::None).iter().all(|(_, label)| label.is_none()));
    for wanted in [TaskLabel::Info, TaskLabel::Observation] {
        let inputs: Vec<Label> = inputs(wanted).into_iter().filter_map(|(_, label)| label).collect();
        assert_eq!(
            (inputs.len(), inputs[8].name.as_str(), inputs[8].number),
            (15, "find_objects#red", 2),
            "a drift has the label of its nearer end"
        );
        assert_eq!((inputs[10].name.as_str(), inputs[10].number), ("find_objects#dusk", 3));
        assert!(
            inputs
                .iter()
                .all(|label| label.of == 4 && label.observed == (wanted == TaskLabel::Observation))
        );
    }
}

#[test]
fn evaluations_repeat_their_random_numbers_and_learning_does_not() {
    let (folder, scenario) = (scratch(), scenario(&["blue", "red"]));
    for jobs in [1, 3] {
        let log = folder.path().join(format!("{jobs}"));
        let settings = RunSettings {
            jobs,
            ..RunSettings::default()
        };
        run_with(&scenario, &mut RandomAgent::new(0), &log, &settings).unwrap_or_else(|error| panic!("{error}"));
        let rows = rows(&log);
        for name in ["findobjects_blue", "findobjects_red"] {
            let tests = rows
                .iter()
                .filter(|row| row.task_name == name && row.block_num % 2 == 0);
            let earned: Vec<f64> = tests.map(|row| row.metrics["reward"]).collect();
            assert_eq!(earned.len(), 6, "three evaluations of two worlds each");
            assert!(earned.chunks(2).all(|pair| pair == &earned[..2]), "{name}: {earned:?}");
        }
    }
    let mut pupil = Pupil::default();
    run_scenario(&varied(), &mut pupil, &folder.path().join("seeds"), u64::MAX)
        .unwrap_or_else(|error| panic!("{error}"));
    let inputs = pupil.inputs.lock().expect("no test panics while holding it");
    let mut seeds: Vec<u64> = inputs.iter().map(|(seed, _)| *seed).collect();
    assert_eq!(
        seeds[..2],
        seeds[6..8],
        "two variants share agent seeds under one scenario seed"
    );
    assert_eq!(
        seeds[2..6],
        seeds[11..],
        "evaluations use the same random numbers each time"
    );
    seeds.sort_unstable();
    seeds.dedup();
    // Two learning worlds, three more in a drift to another variant, and four evaluation worlds.
    assert_eq!(seeds.len(), 9, "{seeds:?}");
}

#[test]
fn relearning_the_log_continues_an_uninterrupted_run() {
    let folder = scratch();
    // Moving straight ahead loses reward there, so any learning shows.
    let scenario = super::frozen::shaped("behind.json");
    let whole = folder.path().join("whole");
    run_scenario(&scenario, &mut SarsaAgent::new(), &whole, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    // Stopped in the learning block, then in the evaluation after it; each time resumed by a new process that has learned
    // nothing.
    let resumed_log = |relearns: bool| {
        let log = folder.path().join(format!("{relearns}"));
        for (max_experiences, resume) in [(8, false), (12, true), (u64::MAX, true)] {
            let (mut agent, settings) = (
                SarsaAgent::new(),
                RunSettings {
                    max_experiences,
                    resume,
                    ..RunSettings::default()
                },
            );
            if resume && relearns {
                let plan = plan(&scenario).unwrap_or_else(|error| panic!("{error}"));
                let done = Journal::resume(&log, &plan, "test").unwrap_or_else(|error| panic!("{error}"));
                let flow = settings.context(&mut |context| relearn(&plan, &mut agent, done.num_experiences(), context));
                assert!(flow.unwrap_or_else(|error| panic!("{error}")).is_continue());
            }
            run_with(&scenario, &mut agent, &log, &settings).unwrap_or_else(|error| panic!("{error}"));
        }
        log_text(&log)
    };
    assert_eq!(resumed_log(true), log_text(&whole));
    assert_ne!(resumed_log(false), log_text(&whole), "learning changes the log");
}

//! Learning agents: order, labels, random numbers, and evaluations by copies.

use super::*;

/// Records its inputs; learns, and can be copied.
#[derive(Clone, Default)]
struct Pupil {
    told: Arc<Mutex<Told>>,
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
        self.told.lock().expect("no test panics with it").push((seed, label));
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
    let lived = |jobs: usize| {
        let (log, mut pupil) = (folder.path().join(format!("{jobs}")), Pupil::default());
        live_by(
            &varied(),
            &mut pupil,
            &log,
            &Living {
                jobs,
                ..Living::default()
            },
        )
        .unwrap_or_else(|error| panic!("{error}"));
        (everything(&log), pupil.learned)
    };
    let (log, learned) = lived(1);
    assert_eq!((log, learned), lived(4));
    assert_eq!(
        learned,
        7 * 60,
        "seven experiences of learning, each cut off after 60 steps"
    );
}

#[test]
fn label_is_passed_only_if_the_scenario_says_so() {
    let folder = scratch();
    let told = |label: TaskLabel| {
        let (mut pupil, mut scenario) = (Pupil::default(), varied());
        scenario.task_label = label;
        let log = folder.path().join(format!("{label:?}"));
        live(&scenario, &mut pupil, &log, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
        let told = pupil.told.lock().expect("no test panics with it").clone();
        assert_eq!(told.len(), 15);
        told
    };
    assert!(told(TaskLabel::None).iter().all(|(_, label)| label.is_none()));
    for wanted in [TaskLabel::Info, TaskLabel::Observation] {
        let told: Vec<Label> = told(wanted).into_iter().filter_map(|(_, label)| label).collect();
        assert_eq!(
            (told.len(), told[8].name.as_str(), told[8].number),
            (15, "find_objects#red", 2),
            "a drift has the label of its nearer end"
        );
        assert_eq!((told[10].name.as_str(), told[10].number), ("find_objects#dusk", 3));
        assert!(
            told.iter()
                .all(|label| label.of == 4 && label.observed == (wanted == TaskLabel::Observation))
        );
    }
}

#[test]
fn evaluations_repeat_their_random_numbers_and_learning_does_not() {
    let (folder, scenario) = (scratch(), scenario(&["blue", "red"]));
    for jobs in [1, 3] {
        let log = folder.path().join(format!("{jobs}"));
        let living = Living {
            jobs,
            ..Living::default()
        };
        live_by(&scenario, &mut RandomAgent::new(0), &log, &living).unwrap_or_else(|error| panic!("{error}"));
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
    live(&varied(), &mut pupil, &folder.path().join("seeds"), u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    let told = pupil.told.lock().expect("no test panics with it");
    let mut seeds: Vec<u64> = told.iter().map(|(seed, _)| *seed).collect();
    assert_eq!(
        seeds[..2],
        seeds[6..8],
        "two variants share the numbers of worlds under one seed"
    );
    assert_eq!(
        seeds[2..6],
        seeds[11..],
        "evaluations come with the same numbers each time"
    );
    seeds.sort_unstable();
    seeds.dedup();
    // Two worlds of learning, three that are learned again in a drift to another variant, four of evaluation.
    assert_eq!(seeds.len(), 9, "{seeds:?}");
}

#[test]
fn relearning_the_log_continues_as_if_never_stopped() {
    let folder = scratch();
    // Moving straight ahead loses reward there, so any learning shows.
    let scenario = super::frozen::shaped("behind.json");
    let whole = folder.path().join("whole");
    live(&scenario, &mut SarsaAgent::new(), &whole, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    // Stopped in the learning block, then in the evaluation after it; each time resumed by a new process that has learned
    // nothing.
    let gone_on = |relearns: bool| {
        let log = folder.path().join(format!("{relearns}"));
        for (most, resume) in [(8, false), (12, true), (u64::MAX, true)] {
            let (mut agent, living) = (
                SarsaAgent::new(),
                Living {
                    most,
                    resume,
                    ..Living::default()
                },
            );
            if resume && relearns {
                let plan = plan(&scenario).unwrap_or_else(|error| panic!("{error}"));
                let done = Journal::resume(&log, &plan, "test").unwrap_or_else(|error| panic!("{error}"));
                let flow = living.context(&mut |context| relearn(&plan, &mut agent, done.num_experiences(), context));
                assert!(flow.unwrap_or_else(|error| panic!("{error}")).is_continue());
            }
            live_by(&scenario, &mut agent, &log, &living).unwrap_or_else(|error| panic!("{error}"));
        }
        everything(&log)
    };
    assert_eq!(gone_on(true), everything(&whole));
    assert_ne!(
        gone_on(false),
        everything(&whole),
        "what was learned makes a difference"
    );
}

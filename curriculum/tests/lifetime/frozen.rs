//! Agents that evaluations change, though they promise to be frozen there.

use driftworld_curriculum::REPEATED_EVALUATIONS;

use super::*;

/// Goes the further the more episodes it has begun, evaluations among them.
#[derive(Clone, Default)]
struct Restless {
    episodes: u32,
    /// Whether evaluations are run by copies of it.
    is_copied: bool,
    /// Whether only learning counts.
    is_honest: bool,
    learned: u32,
}

impl Agent for Restless {
    fn act(&mut self, environment: &Environment) -> Action {
        let steps = if self.is_honest { self.learned } else { self.episodes };
        // The farther it goes, the sooner it is where something pays.
        let share = f64::from(steps % 7) / 7.0;
        Action::Continuous([
            share * environment.world().agent_params.max_linear_speed,
            f64::from(steps % 5) * 10.0,
            1.0,
        ])
    }
    fn begin(&mut self, _: u64) {
        self.episodes += 1;
    }
    fn learn(&mut self, _: &Environment, _: &Step) {
        self.learned += 1;
    }
    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        self.is_copied.then(|| Box::new(self.clone()) as _)
    }
}

/// A world in which each step pays by how much nearer the goal it leads, so that all that an agent does shows.
pub(crate) fn hill() -> World {
    let text = r#"{ "max_steps": 30,
        "objects": [{ "class": "geometric", "coordinates": [0, 20], "tag": "goal" }],
        "rules": { "shaping": { "toward": "goal", "scale": 1 } } }"#;
    World::from_json("hill.json", text).unwrap_or_else(|error| panic!("{error}"))
}

fn shaped() -> Scenario {
    let regime = |count: u32| Regime {
        world: Some("hill.json".to_owned()),
        ..Regime::new("Task 2", "hill", count)
    };
    let evaluation = || Block::new(BlockKind::Evaluation, vec![regime(6)]);
    let learning = Block::new(BlockKind::Learning, vec![regime(3)]);
    Scenario::new("shaped", vec![evaluation(), learning, evaluation()])
}

#[test]
fn an_agent_that_evaluations_change_is_refused_by_one_or_several_at_a_time() {
    let folder = scratch();
    for (name, is_copied, jobs) in [("self", false, 1), ("copy", true, 1), ("copies", true, 3)] {
        let mut agent = Restless {
            is_copied,
            ..Restless::default()
        };
        let living = Living {
            jobs,
            repeated: REPEATED_EVALUATIONS,
            ..WHOLE
        };
        let refused = live_by(&shaped(), &mut agent, &folder.path().join(name), &living).expect_err("it changes");
        assert_eq!(refused.code(), "curriculum/not-frozen", "{name}: {refused}");
        let said = refused.to_string();
        assert!(said.contains("block 0") && said.contains("Task 2#hill"), "{said}");
    }
}

#[test]
fn one_that_only_learning_changes_leaves_the_same_log_checked_or_not() {
    let folder = scratch();
    let mut logs = Vec::new();
    for (name, is_copied, jobs, repeated) in [
        ("unchecked", false, 1, 0),
        ("self", false, 1, REPEATED_EVALUATIONS),
        ("copy", true, 1, REPEATED_EVALUATIONS),
        ("copies", true, 4, REPEATED_EVALUATIONS),
    ] {
        let mut agent = Restless {
            is_copied,
            is_honest: true,
            ..Restless::default()
        };
        let (log, living) = (
            folder.path().join(name),
            Living {
                jobs,
                repeated,
                ..WHOLE
            },
        );
        let summary = live_by(&shaped(), &mut agent, &log, &living).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert!(summary.finished && summary.experiences == 15, "{name}: {summary:?}");
        logs.push(everything(&log));
    }
    assert!(logs.windows(2).all(|pair| pair[0] == pair[1]));
}

//! Whole designs. Forms, drifts and orders have their tests beside them.

use super::*;

fn choices(count: usize) -> Vec<Choice> {
    (0..count).map(|k| Choice::new("t", format!("v{k}"))).collect()
}

/// One letter for each block: Pre-deployment, Learning, Evaluation.
fn kinds(scenario: &Scenario) -> String {
    let letter = |block: &Block| match (block.phase, block.kind) {
        (Phase::PreDeployment, _) => 'P',
        (_, BlockKind::Learning) => 'L',
        (_, BlockKind::Evaluation) => 'E',
    };
    scenario.blocks.iter().map(letter).collect()
}

#[track_caller]
fn check_kinds(options: &Design, expected: &str) {
    assert_eq!(kinds(&design(&choices(3), options).unwrap()), expected);
}

fn learned(scenario: &Scenario) -> Vec<&Regime> {
    let learning = scenario.blocks.iter().filter(|block| block.kind == BlockKind::Learning);
    learning.flat_map(|block| &block.regimes).collect()
}

#[test]
fn every_variant_is_learned_once_in_order_and_evaluated_in_every_evaluation() {
    let scenario = design(&choices(3), &Design::default()).unwrap();
    assert_eq!(kinds(&scenario), "ELELELE");
    let names: Vec<&str> = learned(&scenario)
        .iter()
        .map(|regime| regime.variant.as_str())
        .collect();
    assert_eq!(names, ["v0", "v1", "v2"]);
    let mut evaluations = scenario.blocks.iter().filter(|b| b.kind == BlockKind::Evaluation);
    assert!(evaluations.all(|block| block.regimes.len() == 3));
}

#[test]
fn evaluations_stand_where_they_are_wanted() {
    let with = |evaluation| Design {
        evaluation,
        ..Design::default()
    };
    check_kinds(&with(Evaluate::Ends), "ELLLE");
    check_kinds(&with(Evaluate::After(vec![2, 0])), "ELLEL");
    check_kinds(&with(Evaluate::After(vec![3])), "LLLE");
    let before = Design {
        pre_deployment: 10,
        ..with(Evaluate::Ends)
    };
    check_kinds(&before, "PELLLE");
    let error = design(&choices(3), &with(Evaluate::After(vec![4]))).unwrap_err();
    assert_eq!(
        error.to_string(),
        "design: found an evaluation after learning block 4, expected 0 to 3; 0 is before the first"
    );
}

#[test]
fn learning_and_evaluation_never_share_a_seed() {
    for seed in [0, 1, 2, MAX_SEED] {
        let options = Design {
            seed,
            pre_deployment: 3,
            ..Design::default()
        };
        let scenario = design(&choices(2), &options).unwrap();
        let odd = |block: &Block| block.regimes.iter().all(|regime| regime.seed % 2 == 1);
        assert!(
            scenario
                .blocks
                .iter()
                .all(|block| odd(block) == (block.kind == BlockKind::Evaluation))
        );
    }
}

#[test]
fn no_world_is_learned_twice_and_the_order_does_not_decide_which_worlds_there_are() {
    let options = Design {
        form: Some(ScenarioForm::Dispersed),
        pre_deployment: 7,
        ..Design::default()
    };
    let worlds = |variants: &[Choice]| {
        let scenario = design(variants, &options).unwrap();
        let mut worlds = Vec::new();
        for regime in learned(&scenario) {
            worlds.extend((0..u64::from(regime.count)).map(|k| (regime.variant.clone(), regime.first_index + k)));
        }
        worlds.sort();
        let all = worlds.len();
        worlds.dedup();
        assert_eq!((all, worlds.len()), (7 + 9 * 20, all), "no world comes twice");
        worlds.retain(|(_, index)| *index < BEFORE_DEPLOYMENT);
        worlds
    };
    let mut reversed = choices(3);
    reversed.reverse();
    assert_eq!(worlds(&choices(3)), worlds(&reversed));
}

#[test]
fn an_expert_learns_one_variant_and_is_named_after_it() {
    let options = Design {
        blocks: Some(2),
        ..Design::default()
    };
    let experts = experts(&choices(3), &options).unwrap();
    let names: Vec<&str> = experts.iter().map(|scenario| scenario.name.as_str()).collect();
    assert_eq!(names, ["curriculum-v0", "curriculum-v1", "curriculum-v2"]);
    assert!(experts.iter().all(|scenario| kinds(scenario) == "ELELE"));
    assert!(learned(&experts[1]).iter().all(|regime| regime.variant == "v1"));
    assert_eq!(experts[2].form, Some(ScenarioForm::Expert));
}

#[test]
fn experts_of_several_tasks_have_names_of_their_own() {
    let names = |choices: &[Choice]| {
        let experts = experts(choices, &Design::default());
        experts.map(|experts| experts.into_iter().map(|scenario| scenario.name).collect::<Vec<_>>())
    };
    let found = names(&[Choice::new("t", "dusk"), Choice::new("tasks/u.json", "dusk")]).unwrap();
    assert_eq!(found, ["curriculum-t-dusk", "curriculum-u-dusk"]);
    let error = names(&[Choice::new("t", "a b"), Choice::new("t", "a-b")]).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("t#a b and t#a-b, which would both be named curriculum-a-b"),
        "{error}"
    );
}

#[test]
fn a_control_learns_the_same_worlds_after_the_same_pre_deployment() {
    let options = Design {
        blocks: Some(5),
        pre_deployment: 4,
        ..Design::default()
    };
    let variants = choices(3);
    let worlds = |scenario: &Scenario| {
        let of = |regime: &&Regime| (regime.variant.clone(), regime.seed, regime.first_index, regime.count);
        let mut worlds: Vec<_> = learned(scenario).iter().map(of).collect();
        worlds.sort();
        worlds
    };
    let main = design(&variants, &options).unwrap();
    for order in [[2, 1, 0], [1, 2, 0], [2, 0, 1]] {
        let control = design_control(&variants, &order, &options).unwrap();
        assert_eq!(worlds(&control), worlds(&main), "{order:?}");
        assert_eq!((kinds(&control), &control.blocks[0]), (kinds(&main), &main.blocks[0]));
        assert_ne!(control.blocks, main.blocks);
    }
}

#[test]
fn what_is_designed_is_a_valid_scenario_that_reads_back_the_same() {
    let options = Design {
        form: Some(ScenarioForm::Alternating),
        task_label: TaskLabel::Observation,
        drifting: Some(Drifting::default()),
        blocks: Some(4),
        pre_deployment: 2,
        ..Design::default()
    };
    let scenario = design(&choices(2), &options).unwrap();
    let read = Scenario::from_json("s", &scenario.to_json_pretty()).unwrap();
    assert_eq!(read, scenario);
    assert_eq!(kinds(&read), "PELELELELE");
}

#[test]
fn a_design_that_cannot_be_says_why() {
    let said = |count: usize, options: Design| design(&choices(count), &options).unwrap_err().to_string();
    assert_eq!(
        said(0, Design::default()),
        "design: found no variants, expected at least 1"
    );
    let none = Design {
        learn: 0,
        ..Design::default()
    };
    assert_eq!(
        said(1, none),
        "design: found 0 learning experiences per regime, expected 1 to 10000000"
    );
    let large = Design {
        seed: u64::MAX,
        ..Design::default()
    };
    assert!(said(1, large).starts_with("design: found seed"));
    let still = Design {
        drifting: Some(Drifting::default()),
        ..Design::default()
    };
    assert!(said(1, still).contains("expected at least 2"));
}

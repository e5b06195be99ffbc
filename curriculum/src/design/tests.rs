//! Tests of whole designs. Forms, drifts and orders are tested in their own files.

use super::*;
use proptest::prelude::*;
use std::collections::BTreeSet;

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
fn default_design_learns_each_variant_once_and_evaluates_all_in_every_block() {
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
fn evaluation_option_places_evaluation_blocks() {
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

/// Variant, seed and index of every world in these regimes, sorted.
fn worlds<'a>(regimes: impl IntoIterator<Item = &'a Regime>) -> Vec<(String, u64, u64)> {
    let of = |regime: &Regime| {
        let (variant, seed, first) = (regime.variant.clone(), regime.seed, regime.first_index);
        (0..u64::from(regime.count)).map(move |k| (variant.clone(), seed, first + k))
    };
    let mut worlds: Vec<_> = regimes.into_iter().flat_map(of).collect();
    worlds.sort();
    worlds
}

fn evaluated(scenario: &Scenario) -> Vec<&Regime> {
    let blocks = scenario
        .blocks
        .iter()
        .filter(|block| block.kind == BlockKind::Evaluation);
    blocks.flat_map(|block| &block.regimes).collect()
}

/// The layouts: pairs of seed and index, which variants of one task share.
fn layouts(worlds: &[(String, u64, u64)]) -> BTreeSet<(u64, u64)> {
    worlds.iter().map(|(_, seed, index)| (*seed, *index)).collect()
}

/// Random valid designs of `variants` variants, without held-out ones.
fn any_design(variants: usize) -> impl Strategy<Value = Design> {
    let all = variants as u32;
    let form = prop_oneof![
        Just((None, None)),
        (1..12_u32).prop_map(|blocks| (None, Some(blocks))),
        Just((Some(ScenarioForm::Condensed), None)),
        Just((Some(ScenarioForm::Permuted), None)),
        (2 * all..4 * all).prop_map(|blocks| (Some(ScenarioForm::Dispersed), Some(blocks))),
    ];
    let counts = (1..30_u32, 1..9_u32, 0..4_u32);
    let flags = (any::<bool>(), any::<bool>(), 0..3_u64);
    (form, counts, flags, 0..MAX_SEED).prop_map(|((form, blocks), (learn, evaluate, before), flags, seed)| Design {
        form,
        blocks,
        learn,
        evaluate,
        pre_deployment: before,
        evaluation: if flags.0 { Evaluate::Every } else { Evaluate::Ends },
        split: if flags.1 { Split::Test } else { Split::Validation },
        lifetime: flags.2,
        seed,
        ..Design::default()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    #[test]
    fn layouts_are_disjoint_between_variants_lifetimes_seeds_and_splits(
        options in any_design(4), other in 3..9_u64,
    ) {
        let of = |options: &Design| design(&choices(4), options).unwrap();
        let scenario = of(&options);
        let learned_worlds = worlds(learned(&scenario));
        prop_assert_eq!(layouts(&learned_worlds).len(), learned_worlds.len());
        let tested = layouts(&worlds(evaluated(&scenario)));
        prop_assert_eq!(tested.len(), options.evaluate as usize, "all variants share the evaluation worlds");
        prop_assert!(layouts(&learned_worlds).is_disjoint(&tested));
        let later = of(&Design { lifetime: other, ..options.clone() });
        prop_assert!(layouts(&learned_worlds).is_disjoint(&layouts(&worlds(learned(&later)))));
        prop_assert!(tested.is_disjoint(&layouts(&worlds(evaluated(&later)))));
        let neighbour = of(&Design { seed: options.seed + 1, ..options.clone() });
        prop_assert!(layouts(&learned_worlds).is_disjoint(&layouts(&worlds(learned(&neighbour)))));
        let other_split = if options.split == Split::Test { Split::Validation } else { Split::Test };
        let with_other_split = of(&Design { split: other_split, ..options.clone() });
        prop_assert_eq!(&learned_worlds, &worlds(learned(&with_other_split)));
        prop_assert!(tested.is_disjoint(&layouts(&worlds(evaluated(&with_other_split)))));
        let fixed = |lifetime| of(&Design { fixed_evaluation: true, lifetime, ..options.clone() });
        prop_assert_eq!(worlds(evaluated(&fixed(other))), worlds(evaluated(&fixed(other + 1))));
    }

    #[test]
    fn reordering_variants_keeps_the_worlds(seed in 0..MAX_SEED, before in 0..3_u32) {
        let options = Design { form: Some(ScenarioForm::Dispersed), learn: 20, seed, ..Design::default() };
        let mut reversed = choices(3);
        reversed.reverse();
        let of = |variants: &[Choice]| worlds(learned(&design(variants, &options).unwrap()));
        prop_assert_eq!(of(&choices(3)), of(&reversed));
        let paired = Design { paired_learning: true, pre_deployment: before, ..options };
        let learned_worlds = worlds(learned(&design(&choices(3), &paired).unwrap()));
        prop_assert_eq!(layouts(&learned_worlds).len(), 60 + before as usize);
    }

    #[test]
    fn experts_get_their_variants_share_of_the_lifetime(options in any_design(4)) {
        let scenario = design(&choices(4), &options).unwrap();
        let before = |scenario: &Scenario| {
            let block = scenario.blocks.iter().find(|block| block.phase == Phase::PreDeployment);
            block.cloned()
        };
        let deployed = |scenario: &Scenario| {
            let blocks = scenario.blocks.iter().filter(|block| block.phase == Phase::Deployment);
            Scenario { blocks: blocks.cloned().collect(), ..scenario.clone() }
        };
        let mut together = Vec::new();
        for expert in experts(&choices(4), &options).unwrap() {
            prop_assert_eq!(before(&expert), before(&scenario));
            let expert = deployed(&expert);
            let variant = learned(&expert)[0].variant.clone();
            let is_own = |regime: &&Regime| regime.variant == variant;
            prop_assert!(learned(&expert).iter().all(is_own) && evaluated(&expert).iter().all(is_own));
            let tested: BTreeSet<_> = worlds(evaluated(&expert)).into_iter().collect();
            let all: BTreeSet<_> = worlds(evaluated(&scenario).into_iter().filter(is_own)).into_iter().collect();
            prop_assert_eq!(tested, all);
            let starts: Vec<_> = learned(&expert).iter().map(|regime| regime.first_index).collect();
            let deployed = deployed(&scenario);
            let own: Vec<_> = learned(&deployed).into_iter().filter(is_own).map(|regime| regime.first_index).collect();
            prop_assert_eq!(starts, own);
            together.extend(worlds(learned(&expert)));
        }
        together.sort();
        prop_assert_eq!(together, worlds(learned(&deployed(&scenario))));
    }

    #[test]
    fn experts_of_a_drift_have_as_many_experiences_as_the_drift(learn in 1..60_u32, blocks in 1..6_u32) {
        let options = Design {
            learn,
            blocks: Some(blocks),
            drifting: Some(Drifting::default()),
            ..Design::default()
        };
        let count = |scenario: &Scenario| learned(scenario).iter().map(|regime| regime.count).sum::<u32>();
        let experts: Vec<u32> = experts(&choices(3), &options).unwrap().iter().map(count).collect();
        prop_assert_eq!(experts.iter().sum::<u32>(), count(&design(&choices(3), &options).unwrap()));
    }
}

#[test]
fn held_out_variant_is_evaluated_and_never_learned() {
    let options = Design {
        held_out: vec![Choice::new("t", "new")],
        ..Design::default()
    };
    let scenario = design(&choices(2), &options).unwrap();
    let is_new = |regime: &&Regime| regime.variant == "new";
    assert!(!learned(&scenario).iter().any(is_new));
    let evaluations = scenario
        .blocks
        .iter()
        .filter(|block| block.kind == BlockKind::Evaluation);
    assert!(
        evaluations
            .into_iter()
            .all(|block| block.regimes.iter().filter(is_new).count() == 1)
    );
    assert_eq!(experts(&choices(2), &options).unwrap().len(), 2);
    let both = Design {
        held_out: vec![Choice::new("t", "v1")],
        ..Design::default()
    };
    let error = design(&choices(2), &both).unwrap_err();
    assert!(error.to_string().contains("t#v1"), "{error}");
}

#[test]
fn expert_learns_one_variant_and_is_named_after_it() {
    let options = Design {
        form: Some(ScenarioForm::Expert),
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
fn experts_of_several_tasks_have_different_names() {
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
fn control_learns_the_same_worlds_after_the_same_pre_deployment() {
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
fn design_round_trips_through_json() {
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
fn invalid_designs_are_refused_with_a_reason() {
    let message = |count: usize, options: Design| design(&choices(count), &options).unwrap_err().to_string();
    assert_eq!(
        message(0, Design::default()),
        "design: found no variants, expected at least 1"
    );
    let none = Design {
        learn: 0,
        ..Design::default()
    };
    assert_eq!(
        message(1, none),
        "design: found 0 learning experiences per regime, expected 1 to 10000000"
    );
    let large = Design {
        seed: u64::MAX,
        ..Design::default()
    };
    assert!(message(1, large).starts_with("design: found seed"));
    let still = Design {
        drifting: Some(Drifting::default()),
        ..Design::default()
    };
    assert!(message(1, still).contains("expected at least 2"));
    assert!(message(700, Design::default()).contains("at most 400000 regimes, not 491400"));
}

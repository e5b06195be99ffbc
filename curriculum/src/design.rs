//! From variants in an order to learning and evaluation blocks. What the order is, is `similarity`'s; living it is in `run.rs`.

use driftworld_spec::{Block, BlockKind, MAX_EXPERIENCES, Regime, Scenario};

use crate::CurriculumError;

/// The largest seed of a design: two others are derived from it.
pub const MAX_SEED: u64 = 1 << 52;

/// A variant as a scenario names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The task: a built-in name, or the path of a task spec.
    pub task: String,
    /// The variant of the task.
    pub variant: String,
}

/// When the agent is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evaluate {
    /// Before the first learning block and after each.
    Every,
    /// Before the first and after the last.
    Ends,
}

/// How blocks are made of variants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Design {
    /// The scenario's name.
    pub name: String,
    /// Experiences of each learning block; default 20.
    pub learn: u32,
    /// Experiences of each variant in each evaluation block; default 5.
    pub evaluate: u32,
    /// When the agent is evaluated; default every time.
    pub evaluation: Evaluate,
    /// What all seeds of the scenario follow from, at most [`MAX_SEED`]; default 0.
    pub seed: u64,
}

impl Default for Design {
    fn default() -> Self {
        Self {
            name: "curriculum".to_owned(),
            learn: 20,
            evaluate: 5,
            evaluation: Evaluate::Every,
            seed: 0,
        }
    }
}

/// Learning blocks in the order given, one variant each; evaluation blocks of all variants, seen and to come, between them.
///
/// Learning draws from seed `2 × seed`, evaluation from `2 × seed + 1`, so no world is in both. Every evaluation of a variant
/// draws the same worlds, so that before and after are told apart by the agent alone.
///
/// # Errors
/// [`CurriculumError`] without variants, for counts out of 1..=10,000,000, for a seed above [`MAX_SEED`].
///
/// # Example
/// ```
/// use driftworld_curriculum::{Choice, Design, design};
/// let choice = |variant: &str| Choice { task: "find_objects".into(), variant: variant.into() };
/// let scenario = design(&[choice("blue"), choice("red")], &Design::default())?;
/// assert_eq!(scenario.blocks.len(), 5, "evaluate, blue, evaluate, red, evaluate");
/// # Ok::<(), driftworld_curriculum::CurriculumError>(())
/// ```
pub fn design(variants: &[Choice], options: &Design) -> Result<Scenario, CurriculumError> {
    if variants.is_empty() {
        return Err(CurriculumError::NoVariants);
    }
    for (kind, found) in [("learning", options.learn), ("evaluation", options.evaluate)] {
        if !(1..=MAX_EXPERIENCES).contains(&found) {
            return Err(CurriculumError::BadCount {
                kind,
                found,
                limit: MAX_EXPERIENCES,
            });
        }
    }
    if options.seed > MAX_SEED {
        return Err(CurriculumError::BadSeed {
            found: options.seed,
            limit: MAX_SEED,
        });
    }
    let regime = |choice: &Choice, count, seed| Regime {
        seed,
        ..Regime::new(&choice.task, &choice.variant, count)
    };
    let evaluation = || {
        let all = variants
            .iter()
            .map(|choice| regime(choice, options.evaluate, options.seed * 2 + 1));
        Block::new(BlockKind::Evaluation, all.collect())
    };
    let mut blocks = vec![evaluation()];
    for (index, choice) in variants.iter().enumerate() {
        blocks.push(Block::new(
            BlockKind::Learning,
            vec![regime(choice, options.learn, options.seed * 2)],
        ));
        if options.evaluation == Evaluate::Every || index + 1 == variants.len() {
            blocks.push(evaluation());
        }
    }
    Ok(Scenario::new(&options.name, blocks))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn choices(count: usize) -> Vec<Choice> {
        (0..count)
            .map(|k| Choice {
                task: "t".into(),
                variant: format!("v{k}"),
            })
            .collect()
    }

    fn kinds(scenario: &Scenario) -> String {
        scenario
            .blocks
            .iter()
            .map(|block| if block.kind == BlockKind::Learning { 'L' } else { 'E' })
            .collect()
    }

    #[test]
    fn every_variant_is_learned_once_in_order_and_evaluated_in_every_evaluation() {
        let scenario = design(&choices(3), &Design::default()).unwrap();
        assert_eq!(kinds(&scenario), "ELELELE");
        let learned: Vec<&str> = scenario
            .blocks
            .iter()
            .filter(|block| block.kind == BlockKind::Learning)
            .flat_map(|block| block.regimes.iter().map(|regime| regime.variant.as_str()))
            .collect();
        assert_eq!(learned, ["v0", "v1", "v2"]);
        assert!(
            scenario
                .blocks
                .iter()
                .filter(|b| b.kind == BlockKind::Evaluation)
                .all(|b| b.regimes.len() == 3)
        );
        let ends = design(
            &choices(3),
            &Design {
                evaluation: Evaluate::Ends,
                ..Design::default()
            },
        )
        .unwrap();
        assert_eq!(kinds(&ends), "ELLLE");
    }

    #[test]
    fn learning_and_evaluation_never_share_a_seed() {
        for seed in [0, 1, 2, MAX_SEED] {
            let scenario = design(
                &choices(2),
                &Design {
                    seed,
                    ..Design::default()
                },
            )
            .unwrap();
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
    fn a_design_that_cannot_be_says_why() {
        let said = |variants: &[Choice], options: Design| design(variants, &options).unwrap_err().to_string();
        assert_eq!(
            said(&[], Design::default()),
            "design: found no variants, expected at least 1"
        );
        assert_eq!(
            said(
                &choices(1),
                Design {
                    learn: 0,
                    ..Design::default()
                }
            ),
            "design: found 0 learning experiences a regime, expected 1 to 10000000"
        );
        assert!(
            said(
                &choices(1),
                Design {
                    seed: u64::MAX,
                    ..Design::default()
                }
            )
            .starts_with("design: found seed")
        );
    }
}

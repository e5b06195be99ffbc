//! The forms of lifelong learning: determines which variant each learning block learns.

use driftworld_spec::ScenarioForm;

use super::balanced::balanced_order;
use super::wanted::MAX_BLOCKS;
use crate::CurriculumError;

/// Default number of rounds in the forms with recurring tasks.
const ROUNDS: u32 = 3;

/// The index of each learning block's variant among the `count` variants.
pub(super) fn sequence(
    form: Option<ScenarioForm>,
    count: usize,
    blocks: Option<u32>,
    (seed, lifetime): (u64, u64),
) -> Result<Vec<usize>, CurriculumError> {
    let num_variants = u32::try_from(count).unwrap_or(u32::MAX);
    let bad_form = |form, expected: String| CurriculumError::bad_form(form, count, blocks, expected);
    let one_block_each = |form| {
        if blocks.is_none_or(|blocks| blocks == num_variants) {
            Ok(num_variants)
        } else {
            Err(bad_form(
                form,
                format!("one learning block for each variant, {num_variants} in all"),
            ))
        }
    };
    let num_blocks = match form {
        None | Some(ScenarioForm::Custom) => blocks.unwrap_or(num_variants),
        Some(ScenarioForm::Condensed) => one_block_each("condensed")?,
        Some(ScenarioForm::Permuted) => one_block_each("permuted")?,
        Some(ScenarioForm::Dispersed) => {
            let blocks = blocks.unwrap_or(num_variants.saturating_mul(ROUNDS));
            if blocks < num_variants.saturating_mul(2) {
                let expected = format!(
                    "at least 2 learning blocks for each variant, {} in all",
                    num_variants.saturating_mul(2)
                );
                return Err(bad_form("dispersed", expected));
            }
            blocks
        }
        Some(ScenarioForm::Alternating) => {
            if count != 2 {
                return Err(bad_form("alternating", "2 variants".to_owned()));
            }
            let blocks = blocks.unwrap_or(2 * ROUNDS);
            if blocks < 3 {
                return Err(bad_form("alternating", "at least 3 learning blocks".to_owned()));
            }
            blocks
        }
        Some(ScenarioForm::Joint) => {
            if let Some(blocks) = blocks {
                let expected = "no number of blocks: one block has all variants".to_owned();
                return Err(CurriculumError::bad_form("joint", count, Some(blocks), expected));
            }
            num_variants
        }
        Some(ScenarioForm::Expert) => {
            if count != 1 {
                return Err(bad_form(
                    "expert",
                    "1 variant; experts() makes a scenario for each".to_owned(),
                ));
            }
            blocks.unwrap_or(1)
        }
    };
    if !(1..=MAX_BLOCKS).contains(&num_blocks) {
        return Err(CurriculumError::BadBlocks(num_blocks));
    }
    let order = if form == Some(ScenarioForm::Permuted) {
        balanced_order(count, seed, lifetime)?
    } else {
        (0..count).collect()
    };
    Ok(order.iter().copied().cycle().take(num_blocks as usize).collect())
}

/// The learning blocks of a control: each variant as often as in `path`, in rounds of `order`.
pub(super) fn reordered(
    form: Option<ScenarioForm>,
    path: &[usize],
    order: &[usize],
    count: usize,
) -> Result<Vec<usize>, CurriculumError> {
    let bad_form = |form, expected: &str| CurriculumError::bad_form(form, count, None, expected);
    if form == Some(ScenarioForm::Permuted) {
        let expected = "a form with a fixed order; the lifetimes of this one are controls for each other";
        return Err(bad_form("permuted", expected));
    }
    let mut sorted = order.to_vec();
    sorted.sort_unstable();
    if !sorted.into_iter().eq(0..count) {
        return Err(bad_form("of a control", "an order with each variant once"));
    }
    // All forms without a random order cycle through the variants.
    let (rounds, rest) = (path.len() / count, &path[path.len() / count * count..]);
    let rest: Vec<usize> = order.iter().copied().filter(|variant| rest.contains(variant)).collect();
    let round = order.iter().copied().cycle().take(rounds * count);
    let first: Vec<usize> = rest.iter().copied().chain(round.clone()).collect();
    let last: Vec<usize> = round.chain(rest).collect();
    let twice_in_a_row = |path: &[usize]| path.windows(2).any(|pair| pair[0] == pair[1]);
    // If the rest comes first, a rotated order may equal the design itself.
    let valid = |found: &Vec<usize>| !twice_in_a_row(found) && *found != path;
    Ok(if valid(&first) || (twice_in_a_row(&last) && !twice_in_a_row(&first)) {
        first
    } else {
        last
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(form: Option<ScenarioForm>, count: usize, blocks: Option<u32>, expected: &[usize]) {
        assert_eq!(sequence(form, count, blocks, (0, 0)).unwrap(), expected);
    }

    #[test]
    fn each_form_gives_its_sequence() {
        check(None, 3, None, &[0, 1, 2]);
        check(None, 3, Some(5), &[0, 1, 2, 0, 1]);
        check(None, 3, Some(2), &[0, 1]);
        check(Some(ScenarioForm::Condensed), 3, None, &[0, 1, 2]);
        check(Some(ScenarioForm::Dispersed), 2, None, &[0, 1, 0, 1, 0, 1]);
        check(Some(ScenarioForm::Dispersed), 2, Some(5), &[0, 1, 0, 1, 0]);
        check(Some(ScenarioForm::Alternating), 2, Some(3), &[0, 1, 0]);
        check(Some(ScenarioForm::Expert), 1, Some(2), &[0, 0]);
    }

    #[test]
    fn permuted_lifetimes_learn_all_variants_in_different_orders() {
        let of = |seed, lifetime| sequence(Some(ScenarioForm::Permuted), 6, None, (seed, lifetime)).unwrap();
        assert_eq!(of(3, 1), of(3, 1));
        assert!((0..8).any(|lifetime| of(3, lifetime) != of(3, 0)));
        for lifetime in 0..8 {
            let mut sorted = of(3, lifetime);
            sorted.sort_unstable();
            assert_eq!(sorted, [0, 1, 2, 3, 4, 5]);
        }
    }

    #[test]
    fn control_has_every_variant_as_often_as_the_design() {
        let check = |path: &[usize], order: &[usize], expected: &[usize]| {
            assert_eq!(reordered(None, path, order, order.len()).unwrap(), expected);
        };
        check(&[0, 1, 2], &[2, 0, 1], &[2, 0, 1]);
        check(&[0, 1, 2, 0, 1], &[2, 1, 0], &[1, 0, 2, 1, 0]);
        check(&[0, 1, 2, 0], &[0, 2, 1], &[0, 2, 1, 0]);
        check(&[0, 1, 2, 0, 1], &[2, 0, 1], &[2, 0, 1, 0, 1]);
        // No other order avoids learning a variant twice in a row.
        check(&[0, 1, 0], &[1, 0], &[0, 1, 0]);
        check(&[0, 1], &[2, 1, 0], &[1, 0]);
        for order in [[0, 1], [0, 0], [1, 2]] {
            let message = reordered(None, &[0, 1, 2], &order, 3).unwrap_err().to_string();
            assert!(message.ends_with("an order with each variant once"), "{message}");
        }
        let message = reordered(Some(ScenarioForm::Permuted), &[1, 0], &[0, 1], 2)
            .unwrap_err()
            .to_string();
        assert!(message.contains("the form permuted"), "{message}");
    }

    #[test]
    fn impossible_forms_are_refused() {
        let message = |form, count, blocks| sequence(Some(form), count, blocks, (0, 0)).unwrap_err().to_string();
        assert_eq!(
            message(ScenarioForm::Alternating, 3, None),
            "the form alternating: found 3 variants, expected 2 variants"
        );
        assert_eq!(
            message(ScenarioForm::Dispersed, 3, Some(5)),
            "the form dispersed: found 3 variants and 5 learning blocks, expected at least 2 learning blocks for each variant, 6 in all"
        );
        assert!(message(ScenarioForm::Condensed, 3, Some(5)).ends_with("3 in all"));
        assert!(message(ScenarioForm::Custom, 3, Some(10_001)).contains("10000"));
    }
}

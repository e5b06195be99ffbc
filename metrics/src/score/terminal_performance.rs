//! Terminal performance: what a regime ends with.
//!
//! Not here: the best it reached, see `saturation`.

use crate::BlockType;
use crate::statistics::mean;

/// Part of a learning regime that counts as its end.
const TAIL: f64 = 0.1;

/// Performance at the end of a regime.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Terminal {
    /// Mean over the end: the last tenth of a learning regime, the whole of an evaluation.
    pub(super) value: f64,
    /// Experiences before the middle of the end.
    pub(super) experiences: usize,
}

/// Terminal performance of one performance per experience, at least one.
///
/// QUIRK: the end begins at the whole part of `(1 − 0.1) · n` as floating point has it, so that up to nine tenths of
/// an experience more than a tenth belong to it.
pub(super) fn of(per_experience: &[f64], block_type: BlockType) -> Terminal {
    let tail = match block_type {
        BlockType::Train => TAIL,
        BlockType::Test => 1.0,
    };
    let num = per_experience.len() as f64;
    // Both products are below n and not negative.
    let begin = ((1.0 - tail) * num) as usize;
    let experiences = ((1.0 - tail / 2.0) * num) as usize;
    Terminal {
        value: mean(&per_experience[begin..]).unwrap_or(0.0),
        experiences,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn learning_ends_with_its_last_tenth_and_evaluation_is_all_end() {
        let check = |num: u32, block_type: BlockType, value: f64, experiences: usize| {
            let values: Vec<f64> = (0..num).map(f64::from).collect();
            assert_eq!(
                of(&values, block_type),
                Terminal { value, experiences },
                "{num} {block_type}"
            );
        };
        check(1, BlockType::Train, 0.0, 0);
        check(10, BlockType::Train, 9.0, 9);
        check(15, BlockType::Train, 13.5, 14);
        check(100, BlockType::Train, 94.5, 95);
        check(1, BlockType::Test, 0.0, 0);
        check(21, BlockType::Test, 10.0, 10);
    }
}

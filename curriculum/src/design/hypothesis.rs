//! Orders that a hypothesis is about, and the controls that it is held against. The paths themselves are `similarity`'s to find.

use driftworld_similarity::{DistanceMatrix, Method, OrderOptions, order};
use strum::VariantArray;

use crate::CurriculumError;

/// The order in which variants are met.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hypothesis {
    /// In small steps: the shortest path from the first through all, and of equally short ones that whose largest step is smallest.
    Gradual,
    /// By growing distance from the first: what is most like it comes next, what is least like it comes last.
    Outward,
    /// The longest path from the first: neighbours as unlike as can be.
    Abrupt,
    /// The shortest path from the first through all: neighbours as alike as can be.
    Path,
    /// Each time what is farthest from everything met so far: as new as can be.
    Farthest,
}

/// An order of the same variants that a hypothesis is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "lowercase")]
pub enum Control {
    /// The order, last first.
    Reversed,
    /// An order drawn by chance.
    Random,
    /// The longest path, wherever it begins: neighbours as unlike as can be.
    Contrast,
}

impl Control {
    /// All controls.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// The word that scenarios are named with.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The items of a matrix in the order of a hypothesis, beginning with `first`; ties go by name.
///
/// # Errors
/// [`CurriculumError::Similarity`] without items, or if there is no such first.
///
/// # Example
/// ```
/// use driftworld_curriculum::{CurriculumError, Hypothesis, arrange};
/// use driftworld_similarity::DistanceMatrix;
/// let light = [0.0_f64, 4.0, 1.0, 3.0];
/// let names = ["night", "noon", "dusk", "day"].map(String::from).to_vec();
/// let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, CurriculumError>((light[a] - light[b]).abs()))?;
/// assert_eq!(arrange(&matrix, Hypothesis::Outward, 0)?, [0, 2, 3, 1]);
/// assert_eq!(arrange(&matrix, Hypothesis::Abrupt, 0)?, [0, 1, 2, 3]);
/// # Ok::<(), CurriculumError>(())
/// ```
pub fn arrange(matrix: &DistanceMatrix, hypothesis: Hypothesis, first: usize) -> Result<Vec<usize>, CurriculumError> {
    let method = match hypothesis {
        Hypothesis::Gradual => Method::Gradual,
        Hypothesis::Outward => Method::Outward,
        Hypothesis::Abrupt => Method::Abrupt,
        Hypothesis::Path => Method::default_for(matrix.len()),
        Hypothesis::Farthest => Method::Farthest,
    };
    Ok(order(matrix, method, &OrderOptions::default().with_first(first))?.indices)
}

/// The same items in the order of a control. `seed` is what chance draws from.
///
/// # Errors
/// [`CurriculumError::Similarity`] without items.
pub fn control(
    matrix: &DistanceMatrix,
    arranged: &[usize],
    control: Control,
    seed: u64,
) -> Result<Vec<usize>, CurriculumError> {
    let options = OrderOptions {
        seed,
        ..OrderOptions::default()
    };
    Ok(match control {
        Control::Reversed => arranged.iter().rev().copied().collect(),
        Control::Random => order(matrix, Method::Random, &options)?.indices,
        Control::Contrast => order(matrix, Method::Abrupt, &options)?.indices,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(at: &[f64]) -> DistanceMatrix {
        let names = (0..at.len()).map(|k| format!("v{k}")).collect();
        DistanceMatrix::measure(names, |a, b| Ok::<_, CurriculumError>((at[a] - at[b]).abs())).unwrap()
    }

    #[test]
    fn the_hypotheses_are_different_orders_from_the_same_first() {
        // The first stands in the middle: growing distance jumps from side to side, the shortest path does not. Of two
        // equally short ones (10), gradual takes that with steps up to 3, not 5.
        let matrix = line(&[0.0, 1.0, -2.0, 3.0, -4.0]);
        assert_eq!(arrange(&matrix, Hypothesis::Outward, 0).unwrap(), [0, 1, 2, 3, 4]);
        assert_eq!(arrange(&matrix, Hypothesis::Path, 0).unwrap(), [0, 1, 3, 2, 4]);
        assert_eq!(arrange(&matrix, Hypothesis::Gradual, 0).unwrap(), [0, 3, 1, 2, 4]);
        assert_eq!(arrange(&matrix, Hypothesis::Farthest, 0).unwrap()[..3], [0, 4, 3]);
        let length = |order: &[usize]| order.windows(2).map(|pair| matrix.get(pair[0], pair[1])).sum::<f64>();
        let abrupt = arrange(&matrix, Hypothesis::Abrupt, 0).unwrap();
        assert_eq!((abrupt[0], length(&abrupt)), (0, 4.0 + 7.0 + 5.0 + 3.0));
    }

    #[test]
    fn controls_are_the_same_items() {
        let matrix = line(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        let arranged = arrange(&matrix, Hypothesis::Path, 0).unwrap();
        assert_eq!(
            control(&matrix, &arranged, Control::Reversed, 0).unwrap(),
            [5, 4, 3, 2, 1, 0]
        );
        for &kind in Control::ALL {
            let mut items = control(&matrix, &arranged, kind, 7).unwrap();
            assert_ne!(items, arranged, "{kind:?}");
            items.sort_unstable();
            assert_eq!(items, [0, 1, 2, 3, 4, 5], "{kind:?}");
        }
    }
}

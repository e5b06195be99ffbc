//! Orders of variants for testing a hypothesis, and control orders to compare them with.

use driftworld_similarity::{DistanceMatrix, Method, OrderOptions, order};
use strum::VariantArray;

use crate::CurriculumError;

/// A control: a different order of the same variants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "lowercase")]
pub enum Control {
    /// The order reversed.
    Reversed,
    /// A random order.
    Random,
    /// The longest path from any start: neighbours are as different as possible.
    Contrast,
}

impl Control {
    /// All controls.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// The word used in scenario names.
    pub fn name(self) -> &'static str {
        self.into()
    }
}

/// The items of a matrix in the order of a hypothesis, beginning with `first`; ties are broken by name. Without a method, the
/// shortest path.
///
/// # Errors
/// [`CurriculumError::Similarity`] if there are no items, or `first` is out of range.
///
/// # Example
/// ```
/// use driftworld_curriculum::{CurriculumError, arrange};
/// use driftworld_similarity::{DistanceMatrix, Method};
/// let light = [0.0_f64, 4.0, 1.0, 3.0];
/// let names = ["night", "noon", "dusk", "day"].map(String::from).to_vec();
/// let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, CurriculumError>((light[a] - light[b]).abs()))?;
/// assert_eq!(arrange(&matrix, Some(Method::Outward), 0)?, [0, 2, 3, 1]);
/// assert_eq!(arrange(&matrix, Some(Method::Abrupt), 0)?, [0, 1, 2, 3]);
/// # Ok::<(), CurriculumError>(())
/// ```
pub fn arrange(matrix: &DistanceMatrix, method: Option<Method>, first: usize) -> Result<Vec<usize>, CurriculumError> {
    let method = method.unwrap_or_else(|| Method::default_for(matrix.len()));
    Ok(order(matrix, method, &OrderOptions::default().with_first(first))?.indices)
}

/// The same items in the order of a control. `seed` is used by [`Control::Random`].
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
    fn methods_give_different_orders_from_the_same_start() {
        // The first variant is in the middle: `Outward` jumps from side to side, the shortest path does not. Of two paths of
        // the minimum length 10, `Gradual` takes the one with steps of up to 3, not 5.
        let matrix = line(&[0.0, 1.0, -2.0, 3.0, -4.0]);
        assert_eq!(arrange(&matrix, Some(Method::Outward), 0).unwrap(), [0, 1, 2, 3, 4]);
        assert_eq!(arrange(&matrix, None, 0).unwrap(), [0, 1, 3, 2, 4]);
        assert_eq!(arrange(&matrix, Some(Method::Gradual), 0).unwrap(), [0, 3, 1, 2, 4]);
        assert_eq!(arrange(&matrix, Some(Method::Farthest), 0).unwrap()[..3], [0, 4, 3]);
        let length = |order: &[usize]| order.windows(2).map(|pair| matrix.get(pair[0], pair[1])).sum::<f64>();
        let abrupt = arrange(&matrix, Some(Method::Abrupt), 0).unwrap();
        assert_eq!((abrupt[0], length(&abrupt)), (0, 4.0 + 7.0 + 5.0 + 3.0));
    }

    #[test]
    fn controls_permute_the_same_items() {
        let matrix = line(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
        let arranged = arrange(&matrix, None, 0).unwrap();
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

//! Orders of items by their distances: short, even, deliberately long, or random paths. One method per file.

mod abrupt;
mod exact;
mod farthest;
mod gradual;
mod items;
mod local_search;
mod methods;
mod nearest;
mod options;
mod ordering;
mod outward;
mod random;
mod random_orders;
mod small_steps;
mod target_step;
mod tour;
mod two_opt;

pub use exact::MAX_EXACT;
pub use methods::Method;
pub use options::OrderOptions;
pub use ordering::Ordering;
pub use random_orders::{NUM_RANDOM_ORDERS, share_of_shorter_orders};

use crate::{DistanceMatrix, SimilarityError};
use items::Items;

/// Puts items into an order. Ties go to the labels that come first, so equal distances always give the same order, however the
/// matrix is sorted.
///
/// # Errors
/// [`SimilarityError::Empty`] without items; [`SimilarityError::NoSuchEnd`] and [`SimilarityError::EqualEnds`] for invalid
/// ends; [`SimilarityError::TooManyForMethod`] from [`Method::Exact`]; [`SimilarityError::BadTargetStep`] from
/// [`Method::TargetStep`].
///
/// # Example
/// ```
/// use driftworld_similarity::{DistanceMatrix, Method, OrderOptions, SimilarityError, order};
/// let at = [0.0_f64, 5.0, 1.0];
/// let names = ["a", "b", "c"].map(String::from).to_vec();
/// let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, SimilarityError>((at[a] - at[b]).abs()))?;
/// let path = order(&matrix, Method::Exact, &OrderOptions::default().with_first(0))?;
/// assert_eq!(path.indices, [0, 2, 1]);
/// assert_eq!((path.length, path.largest_step()), (5.0, 4.0));
/// # Ok::<(), SimilarityError>(())
/// ```
pub fn order(matrix: &DistanceMatrix, method: Method, options: &OrderOptions) -> Result<Ordering, SimilarityError> {
    let items = Items::new(matrix, options)?;
    let ranks = match method {
        Method::Nearest => nearest::order(&items),
        Method::Exact => exact::order(&items)?,
        Method::TwoOpt => two_opt::order(&items),
        Method::Abrupt => abrupt::order(&items),
        Method::Farthest => farthest::order(&items),
        Method::Random => random::order(&items, options.seed),
        Method::TargetStep => target_step::order(&items, options.target_step)?,
        Method::Gradual => gradual::order(&items),
        Method::Outward => outward::order(&items),
        Method::Given => items.with_fixed_ends(items.as_given()),
    };
    Ok(Ordering::given(matrix, items.indices(&ranks)))
}

#[cfg(test)]
mod tests;

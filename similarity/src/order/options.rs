//! [`OrderOptions`]: constraints on an order, and the methods' own options.

/// Options of an order, besides its method.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OrderOptions {
    /// The item that comes first, by its index in the matrix; whichever is best if none is given.
    pub first: Option<usize>,
    /// The item that comes last, by its index in the matrix; whichever is best if none is given.
    pub last: Option<usize>,
    /// Seed of [`Method::Random`](super::Method::Random), 0 by default; the other methods ignore it.
    pub seed: u64,
    /// Step length for [`Method::TargetStep`](super::Method::TargetStep), in the distances' unit; the other methods ignore it.
    pub target_step: Option<f64>,
}

impl OrderOptions {
    /// These options with a given first item.
    #[must_use]
    pub fn with_first(self, first: usize) -> Self {
        Self {
            first: Some(first),
            ..self
        }
    }
}

//! [`OrderOptions`]: what an order has to keep to. The methods are in their files.

/// What an order has to keep to, besides its method.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct OrderOptions {
    /// The item that comes first, by its index in the matrix; whichever is best if none is given.
    pub first: Option<usize>,
    /// The item that comes last, by its index in the matrix; whichever is best if none is given.
    pub last: Option<usize>,
    /// What [`Method::Random`](super::Method::Random) draws from; 0 by default. The other methods draw nothing.
    pub seed: u64,
    /// The step that [`Method::TargetStep`](super::Method::TargetStep) wants, in the distances' own unit; the other methods want none.
    pub target_step: Option<f64>,
}

impl OrderOptions {
    /// With an item that comes first.
    #[must_use]
    pub fn with_first(self, first: usize) -> Self {
        Self {
            first: Some(first),
            ..self
        }
    }
}

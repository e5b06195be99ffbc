//! A value of a lifetime as a function of its regimes' terminal performances, to be computed many times over.
//!
//! Not here: which values there are; a metric that looks at evaluations alone says its own.

/// A value of the lifetime, of terminal performances by regime number.
type Compute<'a> = dyn Fn(&[f64]) -> Option<f64> + 'a;

/// A headline that terminal performances alone decide.
pub(super) struct Statistic<'a> {
    pub(super) name: &'static str,
    compute: Box<Compute<'a>>,
}

impl<'a> Statistic<'a> {
    pub(super) fn new(name: &'static str, compute: impl Fn(&[f64]) -> Option<f64> + 'a) -> Self {
        Self {
            name,
            compute: Box::new(compute),
        }
    }

    /// The value of the lifetime for the terminal performance of each regime, by its number; `None` where it cannot be computed.
    pub(super) fn of(&self, term_perfs: &[f64]) -> Option<f64> {
        (self.compute)(term_perfs).filter(|value| value.is_finite())
    }
}

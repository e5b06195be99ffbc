//! [`Mix`]: what `--mix` switches at random in a drift. The drift itself is `generator`'s.

use clap::ValueEnum;

/// How values or variants switch in a drift.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Mix {
    /// Each parameter that cannot be interpolated by itself.
    Parameter,
    /// The whole variant: each world is of one of the two.
    Task,
}

//! [`score`]: scores the logs in folders by what agents retained and transferred.

mod comparison;
mod experts;
mod request;
mod scales_fit;
mod scored_log;
mod scores;
mod settings;
mod setup;
mod varied;

pub use comparison::Comparison;
pub use request::{Intervals, ScalesChoice, ScoringRequest, ScoringSettings};
pub use scores::{Scores, score};
pub use varied::Varied;

pub(crate) use experts::Experts;
pub(crate) use scored_log::{ScoredLog, score_logs};
pub(crate) use scores::score_looking;
pub(crate) use setup::{Setup, own_scale};

//! Results: the values, the files they are saved in, and the summary table.

mod as_logged;
mod curves;
mod expert_fit;
mod files;
mod headline;
mod lifetime_metrics;
mod null_band;
mod power;
mod reached;
mod reading;
mod regime_table;
mod repeats;
mod rounding;
mod values;

pub use as_logged::AsLogged;
pub(crate) use as_logged::as_logged;
pub(crate) use curves::curves;
pub use curves::{CurvePoint, EvaluationCurve};
pub use expert_fit::{BesideExpert, ExpertFit};
pub(crate) use expert_fit::{expert_fits, incomparable_experts};
pub use files::{Settings, save_all};
pub use headline::{Direction, Headline};
pub(crate) use lifetime_metrics::parts;
pub use lifetime_metrics::{LifetimeMetrics, Part, SummaryRow, WholeLifetime};
pub use null_band::{Exchanged, NullBand};
pub use power::{MetricPower, metric_power};
pub use reached::{EvaluationCell, LEARNED_SHARE, Reached, ScaledBy};
pub(crate) use reached::{performance_error, reached};
pub(crate) use reading::disagreements;
pub use reading::{MAX_P_VALUE, MIN_AGREEING_SHARE, Reading};
pub(crate) use regime_table::is_regime_column;
pub use regime_table::{RegimeMetrics, regimes_tsv};
pub use repeats::{ComparedMetric, RepeatedMetric, compare_agents, over_repeats};
pub use values::{PairValues, Value, Values};

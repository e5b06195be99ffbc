//! Fuzz target for metrics settings.

use std::sync::OnceLock;

use driftworld_metrics::{Log, Options, read_log, score};
use driftworld_text::printable;
use serde_json::Value;

use crate::edited::Known;
use crate::{log, refusal, world};

fn known() -> &'static Known {
    static KNOWN: OnceLock<Known> = OnceLock::new();
    KNOWN.get_or_init(|| {
        let whole = world::json(
            r#"{ "perf_measure": "reward", "variant_mode": "aware", "ste_averaging_method": "time", "aggregation_method": "median",
                 "maintenance_method": "both", "transfer_method": "both", "normalization_method": "run",
                 "smoothing_method": "hanning", "smooth_eval_data": true, "window_length": 3, "clamp_outliers": true,
                 "data_range": { "a_1": { "min": 0, "max": 10 } }, "noise": { "mean": 0, "std": 1, "seed": 3 } }"#,
        );
        let default = serde_json::to_value(Options::default()).expect("options serialise");
        Known::new(vec![default, whole], "{}")
    })
}

/// A small log of two tasks.
fn lifetime() -> &'static Log {
    static LIFETIME: OnceLock<Log> = OnceLock::new();
    LIFETIME.get_or_init(|| {
        let base = tempfile::tempdir().expect("a temporary folder can be created");
        let dir = base.path().join("log");
        log::write_files(&dir, include_bytes!("../seeds/log/two_workers"));
        read_log(&dir).expect("the seed is valid")
    })
}

/// Accepted settings round-trip, and scores computed with them serialise to a JSON object.
pub(crate) fn check(bytes: &[u8]) {
    let text = known().text(bytes);
    let options: Options = match serde_json::from_str(&text) {
        Ok(options) => options,
        // serde's message quotes the text unescaped; the caller that prints it escapes it.
        Err(error) => return refusal::message(&printable(&error.to_string())),
    };
    let written = serde_json::to_value(&options).expect("options serialise");
    let reread: Options = serde_json::from_value(written.clone()).expect("our own output is valid");
    assert_eq!(serde_json::to_value(reread).ok(), Some(written));
    match score(lifetime(), &[], &options) {
        Ok(metrics) => {
            let metrics: Value = serde_json::to_value(&metrics).expect("metrics serialise");
            assert!(metrics.is_object());
        }
        Err(error) => refusal::message(&error.to_string()),
    }
}

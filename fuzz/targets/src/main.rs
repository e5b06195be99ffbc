//! Passes libFuzzer's bytes to the check of the target that the environment variable `DRIFTWORLD_FUZZ_TARGET` names.

#![no_main]

use std::sync::OnceLock;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| law()(bytes));

fn law() -> fn(&[u8]) {
    static LAW: OnceLock<fn(&[u8])> = OnceLock::new();
    *LAW.get_or_init(|| {
        let name = std::env::var("DRIFTWORLD_FUZZ_TARGET").unwrap_or_default();
        let target = driftworld_fuzz::TARGETS.iter().find(|target| target.name == name);
        let names: Vec<&str> = driftworld_fuzz::TARGETS.iter().map(|target| target.name).collect();
        target
            .unwrap_or_else(|| panic!("DRIFTWORLD_FUZZ_TARGET: found {name:?}, expected one of {}", names.join(", ")))
            .law
    })
}

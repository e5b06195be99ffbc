//! Reads a small log that is made of the fuzzer's bytes.
//!
//! Not here: what must hold of it, see `laws.rs`, which a test on the stable compiler takes, too.

#![no_main]

#[path = "../laws.rs"]
mod laws;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| laws::check(bytes));

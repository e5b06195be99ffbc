//! Reads the recorded conversations in `golden/`: the encoded messages of published clients.

use serde_json::Value;

/// The releases of mlagents-envs whose clients were recorded.
pub(crate) const RELEASES: [&str; 3] = ["0.16", "0.28", "1.1"];

/// The messages of a release's client, each with a description and its bytes.
pub(crate) fn messages(release: &str) -> Vec<(String, Vec<u8>)> {
    let path = format!("{}/tests/golden/client_{release}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("the conversation is committed");
    let document: Value = serde_json::from_str(&text).expect("the conversation is JSON");
    let list = document["messages"].as_array().expect("the conversation has messages");
    list.iter()
        .map(|message| {
            let about = message["about"].as_str().expect("each message has a description");
            let digits = message["hex"].as_str().expect("each message has its bytes");
            (about.to_owned(), bytes(digits))
        })
        .collect()
}

fn bytes(digits: &str) -> Vec<u8> {
    let byte = |pair: &[u8]| {
        let pair = std::str::from_utf8(pair).expect("digits are ASCII");
        u8::from_str_radix(pair, 16).expect("digits are hexadecimal")
    };
    digits.as_bytes().chunks(2).map(byte).collect()
}

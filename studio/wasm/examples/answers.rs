//! Runs a script of calls natively, and prints for each group a hash of all answers, with which the tests in
//! `studio/test` compare a browser's answers. `cargo run -p driftworld-wasm --example answers -- SCRIPT`.

#![expect(clippy::print_stdout, reason = "a program for a test")]

use std::error::Error;
use std::fs;
use std::path::Path;
use std::time::Instant;

use driftworld_wasm::Session;
use serde_json::{Value, json};

/// A hash of two numbers; `hash` in `studio/test/script.mjs` computes the same.
struct Hash([u32; 2]);

impl Hash {
    fn add(&mut self, bytes: &[u8]) {
        let mut word = |word: u32| {
            let [a, b] = &mut self.0;
            *a = (*a ^ word).wrapping_mul(0x0100_0193);
            *b = b.wrapping_add(word).wrapping_mul(0x9e37_79b1);
            *b ^= *b >> 15;
        };
        let (words, rest) = bytes.as_chunks::<4>();
        for bytes in words {
            word(u32::from_le_bytes(*bytes));
        }
        for byte in rest {
            word(u32::from(*byte));
        }
        word(bytes.len() as u32);
    }
}

struct Player<'s> {
    session: &'s mut Session,
    hash: Hash,
    answers: u64,
    frames: u64,
}

impl Player<'_> {
    fn call(&mut self, call: &Value, bytes: &[u8]) -> Result<Value, Box<dyn Error>> {
        let (json, bytes) = self.session.call(&call.to_string(), bytes);
        self.hash.add(json.as_bytes());
        self.hash.add(&bytes);
        self.answers += 1;
        self.frames += u64::from(!bytes.is_empty());
        Ok(serde_json::from_str(&json)?)
    }

    /// Plays the requested number of steps, world after world, and draws a frame after each if requested.
    fn play(&mut self, play: &Value) -> Result<(), Box<dyn Error>> {
        let mut left = play["steps"].as_u64().ok_or("a play has steps")?;
        let mut index = 0;
        while left > 0 {
            let mut open = play["open"].clone();
            open["call"] = json!("open");
            open["request"]["index"] = json!(index);
            let opened = self.call(&open, &[])?;
            let episode = opened["ok"]["id"].as_u64().ok_or_else(|| format!("{open}: {opened}"))?;
            let mut is_over = false;
            while left > 0 && !is_over {
                let step = self.call(
                    &json!({ "call": "act", "episode": episode, "agent": play["agent"] }),
                    &[],
                )?;
                let step = step.get("ok").ok_or_else(|| format!("{open}: {step}"))?;
                is_over = step["terminated"] == true || step["truncated"] == true;
                if play["frames"] == true {
                    let mut frame = json!({ "call": "frame", "episode": episode, "view": "agent", "modality": "rgb" });
                    if let Some(size) = play.get("size") {
                        frame["size"] = size.clone();
                    }
                    self.call(&frame, &[])?;
                }
                left -= 1;
            }
            self.call(&json!({ "call": "map", "episode": episode }), &[])?;
            self.call(&json!({ "call": "close", "episode": episode }), &[])?;
            index += 1;
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let script = std::env::args().nth(1).ok_or("found no script, expected its path")?;
    let networks = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/networks");
    let groups: Vec<Value> = serde_json::from_str(&fs::read_to_string(script)?)?;
    let mut found = Vec::new();
    // As in a page, one session answers all groups, so episodes and networks are numbered across groups.
    let mut session = Session::default();
    for group in groups {
        let start = Instant::now();
        let mut player = Player {
            session: &mut session,
            hash: Hash([0x811c_9dc5, 0x1234_5678]),
            answers: 0,
            frames: 0,
        };
        for item in group["items"].as_array().into_iter().flatten() {
            if let Some(call) = item.get("call") {
                player.call(call, &[])?;
            } else if let Some(name) = item["network"].as_str() {
                let bytes = fs::read(networks.join(format!("{name}.safetensors")))?;
                player.call(&json!({ "call": "network" }), &bytes)?;
            } else {
                player.play(&item["play"])?;
            }
        }
        let [a, b] = player.hash.0;
        found.push(json!({
            "name": group["name"], "hash": format!("{a:08x}{b:08x}"), "answers": player.answers, "frames": player.frames,
            "seconds": start.elapsed().as_secs_f64(),
        }));
    }
    println!("{}", serde_json::to_string_pretty(&found)?);
    Ok(())
}

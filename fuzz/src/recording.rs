//! Fuzz target for recordings files. Input: raw bytes, or edits to the lines of a known file. Edited lines get valid checksums,
//! because random bytes rarely have them.

use std::fs;
use std::io::Write;
use std::sync::OnceLock;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use driftworld_curriculum::{RECORDINGS_FILE, Recordings, RecordingsFile};
use driftworld_env::{
    Action, Catalogue, Environment, Recorder, Recording, RecordingLines, RecordingReader, Replay, Step,
};
use driftworld_metrics::BlockType;
use driftworld_spec::World;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use serde_json::{Value, json};

use crate::edited::Known;
use crate::{refusal, world};

/// Maximum number of objects in a world that is run.
const MAX_OBJECTS: usize = 32;
/// Maximum number of steps of a recording that is run.
const MAX_STEPS: usize = 16;

/// Maximum number of bytes packed per value of an edited file, because repeated copies grow quickly.
const MAX_PACKED_BYTES: usize = 1 << 20;

/// Known files, each as a list of lines. Packed parts are unpacked: a world is JSON, and actions are lists of bytes.
fn known() -> &'static Known {
    static KNOWN: OnceLock<Known> = OnceLock::new();
    KNOWN.get_or_init(|| {
        let world = World::default();
        let (start, hash) = (world::json(&world.to_json()), world.hash());
        let header = json!({ "recording_format": 1, "driftworld": env!("CARGO_PKG_VERSION") });
        let of_world = json!({ "world_hash": hash, "world": start });
        let episode = |actions: Value, steps: u32, reward: f64| {
            json!({
                "experience": 0, "block": 0, "task": "t", "variant": "v", "seed": 3, "index": 0, "world_hash": hash,
                "time_step": world.agent_params.time_step, "frame_skip": 1, "steps": steps, "reward": reward,
                "ended_by": null, "driftworld": "0.2.0", "edits": [[1, hash]], "actions": actions,
            })
        };
        let rows: Vec<u8> = [1_u16, 0].iter().flat_map(|row| row.to_le_bytes()).collect();
        let f32s: Vec<u8> = [1.0_f32, 30.0, 0.0]
            .iter()
            .flat_map(|number| number.to_le_bytes())
            .collect();
        let f64s: Vec<u8> = [0.1, 30.0, 1.0]
            .iter()
            .flat_map(|number: &f64| number.to_le_bytes())
            .collect();
        let documents = vec![
            json!([header, of_world, episode(json!({ "f32": f32s }), 1, 0.0)]),
            json!([header, of_world, episode(json!({ "f64": f64s }), 1, 0.0)]),
            json!([header, of_world, episode(json!({ "rows": rows }), 2, 0.0)]),
            json!([header]),
        ];
        Known::new(documents, include_str!("../../schemas/world.schema.json"))
    })
}

/// Deflates an object's JSON text or a list of bytes, and encodes the result in base64. Other values stay unchanged.
fn pack(value: Value) -> Value {
    let bytes = match &value {
        Value::Object(_) => value.to_string().into_bytes(),
        Value::Array(items) => items.iter().map(|item| item.as_u64().unwrap_or(0) as u8).collect(),
        _ => return value,
    };
    let mut deflater = ZlibEncoder::new(Vec::new(), Compression::fast());
    let kept = &bytes[..bytes.len().min(MAX_PACKED_BYTES)];
    let deflated = deflater.write_all(kept).and_then(|()| deflater.finish());
    Value::from(STANDARD.encode(deflated.expect("writing into memory cannot fail")))
}

/// A line in the file's format, with its checksum.
fn sealed_line(mut line: Value) -> String {
    if let Some(world) = line.get_mut("world") {
        *world = pack(world.take());
    }
    if let Some(actions) = line.get_mut("actions").and_then(Value::as_object_mut) {
        actions.values_mut().for_each(|bytes| *bytes = pack(bytes.take()));
    }
    let mut text = line.to_string();
    if text.pop() != Some('}') {
        return text + "\n";
    }
    let sum = crc32fast::hash(text.as_bytes());
    format!("{text},\"crc32\":\"{sum:08x}\"}}\n")
}

fn file(bytes: &[u8]) -> Vec<u8> {
    match bytes.split_first() {
        Some((&crate::edited::MARK, rest)) => {
            let edited = known().edited(&mut arbitrary::Unstructured::new(rest));
            let lines = match edited {
                Value::Array(lines) => lines,
                other => vec![other],
            };
            lines.into_iter().map(sealed_line).collect::<String>().into_bytes()
        }
        _ => bytes.to_vec(),
    }
}

/// Any file is read to its end. Each recording in it can be written, reads back the same, and replays without an error. A log
/// appends to the file, or refuses it and leaves it unchanged.
pub(crate) fn check(bytes: &[u8]) {
    let file = file(bytes);
    let recordings = read(&file);
    for recording in &recordings {
        check_round_trip(recording);
        check_replay(recording);
    }
    check_in_log(&file);
}

/// All episodes that can be recovered.
fn read(file: &[u8]) -> Vec<Recording> {
    let mut reader = match RecordingReader::new(file) {
        Ok(reader) => reader,
        Err(error) => {
            refusal::message(&error.to_string());
            return Vec::new();
        }
    };
    let lines = file.split(|byte| *byte == b'\n').count();
    let mut recordings = Vec::new();
    for _ in 0..=lines {
        match reader.next_episode() {
            Ok(Some(episode)) => match reader.recording(&episode) {
                Ok(recording) => {
                    assert_eq!(recording.origin, episode.origin);
                    assert_eq!(recording.actions.len(), episode.steps as usize);
                    recordings.push(recording);
                }
                Err(error) => refusal::message(&error.to_string()),
            },
            Ok(None) => return recordings,
            Err(error) => refusal::message(&error.to_string()),
        }
    }
    panic!("found more episodes and errors than the {lines} lines of the file");
}

fn check_round_trip(recording: &Recording) {
    let text = RecordingLines::header() + &RecordingLines::default().lines(recording);
    let [reread] = &read(text.as_bytes())[..] else {
        panic!("our own output has one episode:\n{text}")
    };
    assert_eq!(format!("{reread:?}"), format!("{recording:?}"));
}

/// Runs the recording twice and compares the results.
fn check_replay(recording: &Recording) {
    let worlds = recording.edits.iter().map(|edit| &edit.world);
    if worlds
        .chain([&recording.world])
        .any(|world| world.objects.len() > MAX_OBJECTS)
    {
        return;
    }
    let mut small = recording.clone();
    small.actions.truncate(MAX_STEPS);
    let end = || {
        let mut replay = Replay::new(&small, &Catalogue::default());
        loop {
            match replay.step() {
                Ok(Some(Step { reward, .. })) => assert!(reward.is_finite()),
                Ok(None) => {
                    let difference = replay.check().err().map(|error| error.to_string());
                    refusal::messages(&difference);
                    return format!("{difference:?} {:?}", replay.environment().agent());
                }
                Err(error) => {
                    refusal::message(&error.to_string());
                    return error.to_string();
                }
            }
        }
    };
    assert_eq!(end(), end(), "replays of the same recording end in the same way");
}

/// Reads and appends to the file in a log's folder.
fn check_in_log(file: &[u8]) {
    const WORKER: &str = "w";
    let log = tempfile::tempdir().expect("a temporary folder can be created");
    let path = log.path().join(WORKER).join("0-train").join(RECORDINGS_FILE);
    fs::create_dir_all(path.parent().expect("the path has a parent folder")).expect("the folder can be created");
    fs::write(&path, file).expect("the file can be written");
    let numbers = |file: &RecordingsFile| {
        file.episodes()
            .iter()
            .map(|origin| origin.experience)
            .collect::<Vec<u64>>()
    };
    let before: Vec<u64> = match RecordingsFile::open(&path) {
        Ok(file) => {
            let file = file.expect("the file exists");
            refusal::messages(file.damage());
            numbers(&file)
        }
        Err(error) => {
            refusal::message(&error.to_string());
            Vec::new()
        }
    };
    let next = before.iter().max().map_or(0, |last| last.saturating_add(1));
    let added = small(next);
    match Recordings::new(log.path()).append(WORKER, (0, BlockType::Train), &added) {
        Ok(()) => {
            let file = RecordingsFile::open(&path).expect("the file is a valid recordings file");
            let mut file = file.expect("the file exists");
            let reread_recording = file.recording(next).expect("the appended recording can be read");
            assert_eq!(reread_recording.as_ref(), Some(&added));
            let numbers_after = numbers(&file);
            assert!(numbers_after.contains(&next));
            assert!(
                numbers_after.starts_with(&before) || before.is_empty(),
                "found {numbers_after:?} after {before:?}"
            );
        }
        Err(error) => {
            refusal::message(&error.to_string());
            // Read directly, not through driftworld-files: the test itself created the file.
            let left = fs::read(&path).expect("the file exists");
            assert_eq!(left, file, "a refused file stays unchanged");
        }
    }
}

/// A recording of one step.
fn small(experience: u64) -> Recording {
    let world = World::default();
    let (mut environment, mut recorder) = (Environment::new(world.clone()), Recorder::default());
    recorder.begin(world);
    let action = Action::Continuous([1.0, 0.0, 0.0]);
    environment
        .step(action)
        .expect("the action is valid in the default world");
    recorder.step(action);
    let mut recording = recorder.recording(&environment, None);
    recording.origin.experience = experience;
    recording
}

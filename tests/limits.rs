//! Tests the memory needed to check a document: at most 40 times its size plus a constant, whatever its contents.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use driftworld::documents::{Checked, Kind, check};
use driftworld::spec::{Classes, MAX_PROBLEMS};
use driftworld::tasks;

use crate::is_turn;

/// The system's allocator, which also counts the current and the peak memory of each thread.
struct Counting;

thread_local! {
    static CURRENT: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

fn add(bytes: usize) {
    let current = CURRENT.get() + bytes as isize;
    CURRENT.set(current);
    PEAK.set(PEAK.get().max(current));
}

fn subtract(bytes: usize) {
    CURRENT.set(CURRENT.get() - bytes as isize);
}

#[expect(
    unsafe_code,
    reason = "an allocator needs unsafe code; this one only counts and calls the system's"
)]
// SAFETY: every call is passed unchanged to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        add(layout.size());
        // SAFETY: the caller upholds the system allocator's contract.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        subtract(layout.size());
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Large blocks are moved without being copied: the old and the new one never coexist.
        subtract(layout.size());
        add(size);
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Bytes that a check may use per byte of its document.
const FACTOR: usize = 40;

/// Additional bytes for any document, however small: lists of problems and their texts.
const BASE: usize = 8 << 20;

/// Templates of documents of each kind: a filling replaces `@`.
const TEMPLATES: [&str; 27] = [
    r#"{"name":"t","variants":{"a":{"a":@}}}"#,
    r#"{"name":"t","variants":{"a":@}}"#,
    r#"{"name":"t","variants":@}"#,
    r#"{"name":"t","parameters":@}"#,
    r#"{"name":"t","parameters":{"p":@}}"#,
    r#"{"name":"t","parameters":{"p":{"role":"variant","type":"number","affects":["S"],"choices":@,"default":0}}}"#,
    r#"{"name":"t","parameters":{"p":{"role":"fixed","type":"vector","value":@}}}"#,
    r#"{"name":"t","parameters":{"p":{"role":"randomized","type":"number","affects":["S"],"distribution":{"choice":{"values":@}}}}}"#,
    r#"{"name":"t","parameters":{"p":{"role":"randomized","type":"number","affects":["S"],"distribution":{"mixture":{"parts":@}}}}}"#,
    r#"{"name":"t","world":@}"#,
    r#"{"name":"t","world":{"objects":@}}"#,
    r#"{"name":"t","world":{"environment_params":{"walls":@}}}"#,
    r#"{"name":"t","groups":@}"#,
    r#"{"name":"t","require":@}"#,
    r#"{"name":@,"groups":[]}"#,
    r#"{"objects":@}"#,
    r#"{"objects":[{"class":"car","coordinates":@}]}"#,
    r#"{"objects":[{"class":"car","coordinates":[0,0],"waypoints":@}]}"#,
    r#"{"objects":[],"environment_params":{"walls":@}}"#,
    r#"{"objects":[],"rules":{"success":@}}"#,
    r#"{"objects":[],"more":@}"#,
    r#"{"name":"s","blocks":@}"#,
    r#"{"name":"s","blocks":[{"type":"learning","regimes":@}]}"#,
    r#"{"name":"s","blocks":[{"type":"learning","regimes":[{"task":"find_objects","variant":"red","count":1,"values":@}]}]}"#,
    r#"{"maps":@}"#,
    r#"{"maps":[{"id":2,"name":"m","excluded_regions":@}]}"#,
    r#"{"scenario":@}"#,
];

/// Fillings for a template: the opening, the repeated part and the closing of a list or an object.
const FILLINGS: [(&str, &str, &str); 24] = [
    ("[", "0", "]"),
    ("[", "[]", "]"),
    ("[", "{}", "]"),
    ("[", "{\"a\":0}", "]"),
    ("[", "{\"\":{}}", "]"),
    ("[", "\"\"", "]"),
    ("[", "\"red\"", "]"),
    ("[", "[0,0]", "]"),
    ("[", "[[0,0],[1,0],[0,1]]", "]"),
    ("[", "{\"polygon\":[[0,0],[1,0],[0,1]]}", "]"),
    ("[", "{\"polygon\":[[0,0],[1,0],[0,1]],\"height\":-1}", "]"),
    ("[", "{\"class\":\"car\",\"coordinates\":[0,0]}", "]"),
    ("[", "{\"class\":\"cra\",\"coordinates\":[900,900]}", "]"),
    ("[", "{\"class\":1,\"coordinates\":[0],\"colr\":\"rde\"}", "]"),
    ("[", "{\"task\":\"find_objects\",\"variant\":\"rde\",\"count\":1}", "]"),
    (
        "[",
        "{\"type\":\"learning\",\"regimes\":[{\"task\":\"t\",\"variant\":\"v\",\"count\":1}]}",
        "]",
    ),
    ("[", "{\"id\":2,\"name\":\"m\",\"excluded_regions\":[]}", "]"),
    ("[", "{\"uniform\":{\"low\":1,\"high\":0}}", "]"),
    (
        "[",
        "{\"name\":\"g\",\"count\":1,\"object\":{\"class\":\"car\"},\"placement\":{\"disc\":{\"center\":[0,0],\"radius\":1}}}",
        "]",
    ),
    ("{", "\"#\":0", "}"),
    ("{", "\"#\":{}", "}"),
    ("{", "\"a\":0", "}"),
    ("{", "\"#\":{\"extends\":\"#\"}", "}"),
    ("{", "\"#\":{\"role\":\"fixed\",\"type\":\"number\",\"value\":1}", "}"),
];

/// A filling of about `bytes` bytes; `#` becomes a number.
fn filled((open, part, close): (&str, &str, &str), bytes: usize) -> String {
    let mut text = open.to_owned();
    let mut number = 0;
    while text.len() < bytes {
        if number > 0 {
            text.push(',');
        }
        if part.contains('#') {
            text.push_str(
                &part
                    .replacen('#', &format!("k{number}"), 1)
                    .replace('#', &format!("k{}", number + 1)),
            );
        } else {
            text.push_str(part);
        }
        number += 1;
    }
    text + close
}

/// Further fillings: deep nesting, long strings and keys, and blanks.
fn others(bytes: usize) -> Vec<String> {
    let deep = |open: &str, inner: &str, close: &str| open.repeat(100) + inner + &close.repeat(100);
    let many = |part: &str| format!("[{}0]", format!("{part},").repeat(bytes / part.len()));
    vec![
        many(&deep("[", "", "]")),
        many(&deep("{\"a\":", "0", "}")),
        deep("[", &filled(("[", "0", "]"), bytes), "]"),
        format!("\"{}\"", "x".repeat(bytes)),
        format!("\"{}\"", "\\u0001".repeat(bytes / 6)),
        format!("[{}]", " ".repeat(bytes)),
        format!("{{\"{}\":0}}", "k".repeat(bytes)),
        format!("[\"{}\"", "x".repeat(bytes)),
        many(&format!("{{\"{}\":[0]}}", "k".repeat(390))),
    ]
}

/// The kinds that a text is checked as: a world may also be one of L2Explorer's.
fn kinds(text: &str) -> Vec<Kind> {
    match Kind::of(text) {
        Kind::World => vec![Kind::World, Kind::L2ExplorerWorld],
        kind => vec![kind],
    }
}

/// Peak memory of a check in bytes, and its result.
fn measured(text: &str, kind: Kind, classes: &Classes) -> (usize, Checked) {
    let before = CURRENT.get();
    PEAK.set(before);
    let checked = check("d.json", text, kind, &mut tasks::task, classes);
    // Formatting the error is part of the check.
    drop(checked.error.as_ref().map(ToString::to_string));
    ((PEAK.get() - before).unsigned_abs(), checked)
}

/// Checks the memory limit for every filling of these templates.
fn check_limit(templates: &[&str]) {
    let classes = tasks::classes(&driftworld::env::Catalogue::default());
    // Set this to test larger documents by hand, which takes minutes.
    let bytes = std::env::var("DRIFTWORLD_LIMITS_BYTES");
    let bytes = bytes.ok().and_then(|bytes| bytes.parse().ok()).unwrap_or(60_000);
    let mut wrong = Vec::new();
    for (number, template) in templates.iter().enumerate() {
        let repeated = FILLINGS.iter().map(|filling| filled(*filling, bytes));
        let fillings = repeated.chain(others(bytes)).enumerate();
        for (_, filling) in fillings.filter(|(turn, _)| is_turn(turn + number, 4)) {
            let text = template.replace('@', &filling);
            for kind in kinds(&text) {
                // Schemas are built on first use.
                drop(measured(&template.replace('@', "0"), kind, &classes));
                let (peak, checked) = measured(&text, kind, &classes);
                let problems = checked.error.as_ref().map_or(0, |error| error.problems().len());
                assert!(problems <= MAX_PROBLEMS, "{template}: {problems} problems");
                let warnings = checked.warnings.len();
                assert!(warnings <= MAX_PROBLEMS + 1, "{template}: {warnings} warnings");
                if peak > FACTOR * text.len() + BASE {
                    let (start, times) = (filling.chars().take(60).collect::<String>(), peak / text.len());
                    wrong.push(format!(
                        "{kind:?} {template} with {start}: {times} times, {peak} bytes; {problems} problems"
                    ));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn checking_a_task_takes_bounded_memory() {
    check_limit(&TEMPLATES[..8]);
}

#[test]
fn checking_placements_of_a_task_takes_bounded_memory() {
    check_limit(&TEMPLATES[8..15]);
}

#[test]
fn checking_a_world_takes_bounded_memory() {
    check_limit(&TEMPLATES[15..21]);
}

#[test]
fn checking_scenarios_and_maps_takes_bounded_memory() {
    check_limit(&TEMPLATES[21..]);
}

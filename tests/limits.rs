//! What checking a document takes of memory, whatever stands in it: at most 40 times its size and a little. A test of its own, because
//! it counts for the whole process.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use driftworld::documents::{Checked, Kind, check};
use driftworld::spec::Classes;
use driftworld::tasks;

/// The system's allocator, counting what is taken of it at a time.
struct Counting;

static TAKEN: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

fn take(bytes: usize) {
    let taken = TAKEN.fetch_add(bytes, Relaxed) + bytes;
    MOST.fetch_max(taken, Relaxed);
}

#[expect(
    unsafe_code,
    reason = "an allocator cannot be written without; this one adds to numbers and asks the system"
)]
// SAFETY: every call goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        take(layout.size());
        // SAFETY: the caller's promise is the system's.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        TAKEN.fetch_sub(layout.size(), Relaxed);
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // Large blocks are moved without being copied: the old and the new one are never there together.
        TAKEN.fetch_sub(layout.size(), Relaxed);
        take(size);
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Bytes that a check may take for each byte of its document.
const FACTOR: usize = 40;

/// Bytes that it may take beside, however small the document: lists of problems and their words.
const BASE: usize = 16 << 20;

/// Places of documents of each kind: what goes in for `@` is drawn.
const PLACES: [&str; 27] = [
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

/// What fills a place: the parts of a list or an object, over and over.
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

/// A filling of about so many bytes; `#` becomes a number.
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

/// Fillings that are no repetition.
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

/// What a check takes at most, in bytes, and what came of it.
fn measured(text: &str, classes: &Classes) -> (usize, Checked) {
    let before = TAKEN.load(Relaxed);
    MOST.store(before, Relaxed);
    let checked = check("d.json", text, Kind::of(text), &mut tasks::task, classes);
    // Saying it is part of it.
    drop(checked.error.as_ref().map(ToString::to_string));
    (MOST.load(Relaxed) - before, checked)
}

#[test]
fn a_check_takes_at_most_forty_times_its_document() {
    let classes = tasks::classes(&driftworld::env::Catalogue::default());
    let mut wrong = Vec::new();
    for bytes in [2_000, 400_000] {
        for place in PLACES {
            let repeated = FILLINGS.iter().map(|filling| filled(*filling, bytes));
            for filling in repeated.chain(others(bytes)) {
                let text = place.replace('@', &filling);
                let begun = std::time::Instant::now();
                let (most, checked) = measured(&text, &classes);
                let (problems, warnings) = (
                    checked.error.as_ref().map_or(0, |error| error.problems().len()),
                    checked.warnings.len(),
                );
                if most > FACTOR * text.len() + BASE || begun.elapsed().as_millis() > 3000 {
                    let start: String = filling.chars().take(60).collect();
                    wrong.push(format!(
                        "{place} with {start} of {bytes}: {} MB, {} times; {problems} problems, {warnings} warnings, {:?}",
                        most >> 20,
                        most / text.len(),
                        begun.elapsed()
                    ));
                    eprintln!("{}", wrong.last().unwrap());
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
}

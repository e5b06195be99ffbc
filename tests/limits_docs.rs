//! Tests that `docs/limits.md` matches the code: each limit in a table equals the constant or the schema's key named beside it.

use std::fs;
use std::path::Path;

use serde_json::Value;

/// A documented limit, and its source.
struct Row {
    line: String,
    value: f64,
    file: String,
    name: String,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &str) -> String {
    fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The rows whose last cell names a file and an item in it.
fn rows(page: &str) -> Vec<Row> {
    let row = |line: &str| {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [_, value, origin] = cells[..] else { return None };
        let mut origin = origin.split('`').skip(1).step_by(2);
        let (file, name) = (origin.next()?, origin.next()?);
        Some(Row {
            line: line.to_owned(),
            value: number(value),
            file: file.to_owned(),
            name: name.to_owned(),
        })
    };
    page.lines()
        .filter(|line| line.starts_with('|'))
        .filter_map(row)
        .collect()
}

/// Parses texts such as `64 MiB`, `4,000,000`, `400 bytes`, `4096 × 4096 pixels`.
fn number(value: &str) -> f64 {
    let words: Vec<&str> = value.split_whitespace().collect();
    words.iter().fold(1.0, |product, word| match *word {
        "KiB" => product * 1024.0,
        "MiB" => product * 1_048_576.0,
        "GiB" => product * 1_073_741_824.0,
        word => word
            .replace(',', "")
            .parse()
            .map_or(product, |number: f64| product * number),
    })
}

/// A constant's value in the code: numbers joined by `*` and `<<`.
fn constant(text: &str, name: &str) -> Option<f64> {
    let start = text.find(&format!("const {name}: "))?;
    let value = text[start..].split_once('=')?.1.split_once(';')?.0.trim();
    let plain = |text: &str| text.trim().replace('_', "").parse::<f64>().ok();
    value.split('*').try_fold(1.0, |product, factor| {
        let factor = match factor.split_once("<<") {
            Some((number, bits)) => plain(number)? * (1_u64 << plain(bits)? as u32) as f64,
            None => plain(factor)?,
        };
        Some(product * factor)
    })
}

#[test]
fn limits_match_the_code() {
    let rows = rows(&read("docs/limits.md"));
    assert!(rows.len() > 50, "{} rows", rows.len());
    for row in rows {
        let text = read(&row.file);
        let found = if row.name.starts_with('/') {
            let schema: Value = serde_json::from_str(&text).expect("a schema is JSON");
            schema.pointer(&row.name).and_then(Value::as_f64)
        } else {
            constant(&text, &row.name)
        };
        assert_eq!(found, Some(row.value), "{}", row.line);
    }
}

/// New limits of user input must be documented.
#[test]
fn limits_of_user_input_are_on_the_page() {
    let page = read("docs/limits.md");
    for file in "spec/src/limits.rs spec/src/error.rs spec/src/task/family.rs metrics/src/log/json_file.rs \
         metrics/src/log/data_file.rs metrics/src/log/table.rs env/src/agents/network/file.rs \
         env/src/assets/library/mod.rs env/src/assets/import/limits.rs src/matrix_file.rs src/libraries.rs"
        .split(' ')
    {
        let text = read(file);
        for line in text.lines() {
            let Some((_, rest)) = line.split_once("const MAX_") else {
                continue;
            };
            let name = format!("`MAX_{}`", rest.split(':').next().unwrap_or_default());
            assert!(page.contains(&format!("`{file}` {name}")), "{file}: {name}");
        }
    }
}

#[test]
fn numbers_are_parsed_as_people_write_them() {
    assert_eq!(number("64 MiB"), 67_108_864.0);
    assert_eq!(number("4,000,000 values"), 4e6);
    assert_eq!(number("4096 × 4096 × 2 pixels"), 33_554_432.0);
    assert_eq!(
        constant("pub const A: usize = 2 * 4096 * 4096;", "A"),
        Some(33_554_432.0)
    );
    assert_eq!(constant("const A: u64 = (1 << 53) - 1;", "A"), None);
}

//! Lays out plain-text tables that fit the terminal and stay readable when pasted or piped.

use driftworld_text::{Cells, printable};

use crate::style::Style;
use crate::wrap::{columns_of, columns_of_stdout, longest_piece, wrap};

/// Spaces between two columns.
const GAP: usize = 2;

/// Minimum width of a column of sentences, in terminal columns; if there is less room, the table becomes a list.
const NARROW: usize = 12;

/// How texts in a table are escaped for spreadsheets, by the option `--raw-cells`.
pub(crate) fn cells(raw: bool) -> Cells {
    if raw { Cells::Raw } else { Cells::Guarded }
}

/// A table with these headings; the columns in `numbers` are right-aligned.
pub(crate) fn table<H: Into<String>, R: Into<Vec<String>>>(
    headings: impl IntoIterator<Item = H>,
    rows: impl IntoIterator<Item = R>,
    numbers: &[usize],
) -> String {
    let headings = headings.into_iter().map(Into::into).collect();
    let rows = rows.into_iter().map(Into::into).collect();
    layout(headings, rows, numbers, columns_of_stdout())
}

/// Like [`table`], without empty columns.
pub(crate) fn without_empty(headings: &[&str], rows: &[Vec<String>], numbers: &[usize]) -> String {
    let has_text = |column: &usize| rows.is_empty() || rows.iter().any(|row| !row[*column].is_empty());
    let kept: Vec<usize> = (0..headings.len()).filter(has_text).collect();
    let (headings, rows, numbers) = only(&kept, headings, rows, numbers);
    table(headings, rows, &numbers)
}

/// Selects columns of a table: headings, rows, and which columns are right-aligned.
fn only<H: Clone>(
    kept: &[usize],
    headings: &[H],
    rows: &[Vec<String>],
    numbers: &[usize],
) -> (Vec<H>, Vec<Vec<String>>, Vec<usize>) {
    let headings = kept.iter().map(|column| headings[*column].clone()).collect();
    let of = |row: &Vec<String>| kept.iter().map(|column| row[*column].clone()).collect();
    let numbers = (0..kept.len()).filter(|column| numbers.contains(&kept[*column]));
    (headings, rows.iter().map(of).collect(), numbers.collect())
}

/// A table of at most `width` terminal columns. Cells wrap between words if necessary; if even that does not fit, each row
/// becomes a list.
fn layout(headings: Vec<String>, rows: Vec<Vec<String>>, numbers: &[usize], width: Option<usize>) -> String {
    // Escape line breaks: a cell is one line.
    let shown = |cells: Vec<String>| -> Vec<String> {
        let cells = cells.into_iter();
        cells.map(|cell| printable(&cell).into_owned()).collect()
    };
    let headings = shown(headings);
    let rows: Vec<Vec<String>> = rows.into_iter().map(shown).collect();
    let Some(widths) = widths(&headings, &rows, width) else {
        return fit_narrow(&headings, &rows, numbers, width.unwrap_or(usize::MAX));
    };
    let mut lines: Vec<String> = lines(&headings, &widths, numbers)
        .iter()
        .map(|line| Style::Strong.on(line))
        .collect();
    for row in &rows {
        lines.extend(self::lines(row, &widths, numbers));
    }
    lines.join("\n")
}

/// Lays out a table that is too wide: drops empty columns if there are any, else moves the last column below each row, else
/// turns each row into a list.
fn fit_narrow(headings: &[String], rows: &[Vec<String>], numbers: &[usize], width: usize) -> String {
    let has_text = |column: &usize| rows.iter().any(|row| !matches!(row[*column].as_str(), "" | "-"));
    let kept: Vec<usize> = (0..headings.len()).filter(has_text).collect();
    if kept.len() < headings.len() {
        let (headings, rows, numbers) = only(&kept, headings, rows, numbers);
        return layout(headings, rows, &numbers, Some(width));
    }
    let last = headings.len() - 1;
    let leading: Vec<Vec<String>> = rows.iter().map(|row| row[..last].to_vec()).collect();
    let is_text = !numbers.contains(&last);
    let Some(widths) = widths(&headings[..last], &leading, Some(width)).filter(|_| is_text && last > 1) else {
        return as_list(headings, rows, width);
    };
    let mut shown: Vec<String> = lines(&headings[..last], &widths, numbers)
        .iter()
        .map(|line| Style::Strong.on(line))
        .collect();
    for (row, first) in rows.iter().zip(&leading) {
        shown.extend(lines(first, &widths, numbers));
        let below = wrap(&row[last], width.saturating_sub(2 * GAP));
        shown.extend(
            below
                .iter()
                .filter(|line| !line.is_empty())
                .map(|line| format!("    {line}")),
        );
    }
    shown.join("\n")
}

/// The width of each column; `None` if they do not fit side by side.
fn widths(headings: &[String], rows: &[Vec<String>], width: Option<usize>) -> Option<Vec<usize>> {
    let all_rows = || std::iter::once(headings).chain(rows.iter().map(Vec::as_slice));
    let widest = |column: usize, of: fn(&str) -> usize| {
        let cells = all_rows().filter_map(|row| row.get(column));
        cells.map(|cell| of(cell)).max().unwrap_or(0)
    };
    let natural: Vec<usize> = (0..headings.len()).map(|column| widest(column, columns_of)).collect();
    let least = |column: usize| widest(column, longest_piece).max(natural[column].min(NARROW));
    let least: Vec<usize> = (0..headings.len()).map(least).collect();
    let gaps = GAP * headings.len().saturating_sub(1);
    let Some(room) = width.map(|width| width.saturating_sub(gaps)) else {
        return Some(natural);
    };
    if least.iter().sum::<usize>() > room {
        return None;
    }
    // Shrink the widest columns first, all to the same width.
    let capped = |cap: usize| -> Vec<usize> {
        let pairs = natural.iter().zip(&least);
        pairs.map(|(natural, least)| (*natural).min(cap.max(*least))).collect()
    };
    let fits = |cap: &usize| capped(*cap).iter().sum::<usize>() <= room;
    let cap = (0..=natural.iter().copied().max().unwrap_or(0)).rev().find(fits)?;
    Some(capped(cap))
}

/// A row in as many lines as its tallest cell needs.
fn lines(row: &[String], widths: &[usize], numbers: &[usize]) -> Vec<String> {
    let cells: Vec<Vec<String>> = row
        .iter()
        .zip(widths)
        .map(|(cell, width)| wrap(cell, (*width).max(1)))
        .collect();
    let height = cells.iter().map(Vec::len).max().unwrap_or(0);
    let line = |number: usize| {
        let mut line = String::new();
        for (column, (cell, width)) in cells.iter().zip(widths).enumerate() {
            let text = cell.get(number).map_or("", String::as_str);
            let blanks = " ".repeat(width.saturating_sub(columns_of(text)));
            let gap = if column == 0 { "" } else { "  " };
            let text = match Style::of_verdict(text) {
                Some(style) => style.on(text),
                None => text.to_owned(),
            };
            line += gap;
            line += &if numbers.contains(&column) {
                blanks + &text
            } else {
                text + &blanks
            };
        }
        line.trim_end().to_owned()
    };
    (0..height).map(line).collect()
}

/// Each row as a list: its first cell, and below it the other headings and cells.
fn as_list(headings: &[String], rows: &[Vec<String>], width: usize) -> String {
    let name = headings
        .iter()
        .skip(1)
        .map(|heading| columns_of(heading))
        .max()
        .unwrap_or(0)
        .min(width / 2);
    let mut lines = Vec::new();
    for row in rows {
        lines.push(Style::Strong.on(row.first().map_or("", String::as_str)));
        for (heading, cell) in headings.iter().zip(row).skip(1).filter(|(_, cell)| !cell.is_empty()) {
            let room = width.saturating_sub(name + 2 * GAP).max(1);
            for (number, text) in wrap(cell, room).into_iter().enumerate() {
                let heading = if number == 0 { heading.as_str() } else { "" };
                let blanks = " ".repeat(name.saturating_sub(columns_of(heading)));
                lines.push(format!("  {heading}{blanks}  {text}").trim_end().to_owned());
            }
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_text::whole;
    use proptest::prelude::*;

    fn example(width: Option<usize>) -> String {
        let row = |cells: [&str; 3]| cells.map(str::to_owned).to_vec();
        layout(
            row(["variant", "reward", "what it is"]),
            vec![
                row(["find_objects#red", "3.5", "red cubes pay, and nothing else does"]),
                row(["find_objects#blue", "12", "blue"]),
            ],
            &[1],
            width,
        )
    }

    #[test]
    fn without_a_width_every_row_is_a_line() {
        assert_eq!(
            example(None),
            "variant            reward  what it is\n\
             find_objects#red      3.5  red cubes pay, and nothing else does\n\
             find_objects#blue      12  blue"
        );
    }

    #[test]
    fn cells_wrap_between_words() {
        assert_eq!(
            example(Some(44)),
            "variant            reward  what it is\n\
             find_objects#red      3.5  red cubes pay,\n\
             \x20                          and nothing else\n\
             \x20                          does\n\
             find_objects#blue      12  blue"
        );
    }

    #[test]
    fn last_column_moves_below_if_space_is_short() {
        assert_eq!(
            example(Some(30)),
            "variant            reward\n\
             find_objects#red      3.5\n    red cubes pay, and nothing\n    else does\n\
             find_objects#blue      12\n    blue"
        );
    }

    #[test]
    fn rows_become_lists_if_columns_do_not_fit() {
        let row = |cells: [&str; 3]| cells.map(str::to_owned).to_vec();
        let shown = layout(
            row(["variant", "second of the columns", ""]),
            vec![row(["find_objects#red", "incomprehensibilities", "-"])],
            &[],
            Some(30),
        );
        assert_eq!(
            shown,
            "find_objects#red\n  second of the columns  incomprehensibilities"
        );
    }

    #[test]
    fn empty_columns_are_left_out() {
        let row = |cells: [&str; 3]| cells.map(str::to_owned).to_vec();
        let rows = vec![row(["a", "", "1"]), row(["b", "", "22"])];
        assert_eq!(
            without_empty(&["name", "nothing", "number"], &rows, &[2]),
            "name  number\na          1\nb         22"
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn unbreakable_text_stays_on_one_line(
            facts in proptest::collection::vec("[0-9]{1,6} ± [0-9]{1,6}", 1..5),
            words in "([a-z]{1,8} ){0,12}",
            width in 40_usize..90,
        ) {
            let headings = ["metric", "value", "what it says"].map(str::to_owned).to_vec();
            let row = |fact: &String| vec!["some_metric".to_owned(), whole(fact), words.clone()];
            let shown = layout(headings, facts.iter().map(row).collect(), &[1], Some(width));
            for fact in &facts {
                prop_assert!(shown.lines().any(|line| line.contains(fact.as_str())), "{shown}");
            }
        }

        #[test]
        fn no_line_is_too_wide_and_every_word_is_whole(
            rows in proptest::collection::vec(proptest::collection::vec("([a-z#_]{1,8} ){0,6}", 4), 1..6),
            width in 40_usize..130,
        ) {
            let headings = ["a", "some heading", "c", "d"].map(str::to_owned).to_vec();
            let shown = layout(headings, rows.clone(), &[1], Some(width));
            for line in shown.lines() {
                prop_assert!(columns_of(line) <= width, "{line:?}");
            }
            let words: Vec<&str> = shown.split_whitespace().collect();
            for word in rows.iter().flatten().flat_map(|cell| cell.split_whitespace()) {
                prop_assert!(words.contains(&word), "{word}");
            }
        }
    }
}

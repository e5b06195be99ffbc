//! Tables for people: plain columns that stay readable when they are pasted or piped. The JSON beside them is the commands' own.

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use driftworld_text::{Cells, printable};

/// How texts stand in a table for spreadsheets, by the option `--raw-cells`.
pub(crate) fn cells(raw: bool) -> Cells {
    if raw { Cells::Raw } else { Cells::Guarded }
}

/// A table with these headings; `numbers` are the columns that are set to the right.
pub(crate) fn table<const N: usize>(headings: [&str; N], rows: Vec<[String; N]>, numbers: &[usize]) -> String {
    wide_table(
        headings.map(str::to_owned).to_vec(),
        rows.into_iter().map(Vec::from).collect(),
        numbers,
    )
}

/// The same for a number of columns that is not known beforehand.
pub(crate) fn wide_table(headings: Vec<String>, rows: Vec<Vec<String>>, numbers: &[usize]) -> String {
    let mut table = Table::new();
    table
        .load_style(presets::NOTHING)
        .set_content_arrangement(ContentArrangement::Disabled);
    // A cell is one line, whatever it says.
    let shown = |cells: Vec<String>| cells.into_iter().map(|cell| printable(&cell).into_owned());
    table.set_header(shown(headings));
    for row in rows {
        table.add_row(shown(row));
    }
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if numbers.contains(&index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let lines: Vec<String> = table.lines().map(|line| line.trim_end().to_owned()).collect();
    lines.join("\n")
}

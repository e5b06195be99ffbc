//! Tables for people: plain columns that stay readable when they are pasted or piped. The JSON beside them is the commands' own.

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};

/// A table with these headings; `numbers` are the columns that are set to the right.
pub(crate) fn table<const N: usize>(headings: [&str; N], rows: Vec<[String; N]>, numbers: &[usize]) -> String {
    let mut table = Table::new();
    table
        .load_style(presets::NOTHING)
        .set_content_arrangement(ContentArrangement::Disabled);
    table.set_header(headings);
    rows.into_iter().for_each(|row| {
        table.add_row(row);
    });
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((0, 2));
        if numbers.contains(&index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    let lines: Vec<String> = table.lines().map(|line| line.trim_end().to_owned()).collect();
    lines.join("\n")
}

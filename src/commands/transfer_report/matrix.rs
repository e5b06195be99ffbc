//! A distance matrix from the CSV file that `driftworld order --matrix` writes. What a matrix is, is `similarity`'s.

use std::path::Path;

use driftworld::similarity::{DistanceMatrix, SimilarityError};

use super::super::input;
use super::Failure;

/// Reads a matrix: a line of labels behind an empty cell, then a line for each item, its label first.
pub(super) fn read(path: &Path) -> Result<DistanceMatrix, Failure> {
    let wrong = |line: usize, what: String| Failure::input(format!("{}:{line}: {what}", path.display()));
    let rows =
        rows(&input::text(path)?).map_err(|line| wrong(line, "found a quote that is never closed".to_owned()))?;
    let Some((head, body)) = rows
        .split_first()
        .filter(|(head, _)| head.len() > 1 && head[0].is_empty())
    else {
        return Err(wrong(
            1,
            "found no line of labels behind an empty cell, expected a matrix as `driftworld order --matrix` writes it"
                .to_owned(),
        ));
    };
    let labels = &head[1..];
    if body.len() != labels.len() {
        return Err(wrong(
            rows.len(),
            format!(
                "found {} rows, expected {}: one for each label",
                body.len(),
                labels.len()
            ),
        ));
    }
    let mut numbers = Vec::with_capacity(body.len());
    for (index, row) in body.iter().enumerate() {
        let line = index + 2;
        if row.len() != head.len() || row[0] != labels[index] {
            return Err(wrong(
                line,
                format!(
                    "found {} cells that begin with {:?}, expected {} that begin with {:?}",
                    row.len(),
                    row[0],
                    head.len(),
                    labels[index]
                ),
            ));
        }
        let number = |cell: &String| {
            let number = cell.trim().parse::<f64>().ok();
            number.ok_or_else(|| wrong(line, format!("found {cell:?}, expected a number")))
        };
        numbers.push(row[1..].iter().map(number).collect::<Result<Vec<f64>, _>>()?);
    }
    for (a, b) in (0..labels.len()).flat_map(|a| (0..=a).map(move |b| (a, b))) {
        let (here, there) = (numbers[a][b], numbers[b][a]);
        let expected = if a == b { 0.0 } else { there };
        if here != expected {
            let (a_label, b_label) = (&labels[a], &labels[b]);
            return Err(wrong(
                a + 2,
                format!("{a_label} to {b_label}: found {here}, expected {expected}: as far as back, and 0 to itself"),
            ));
        }
    }
    let measured = DistanceMatrix::measure(labels.to_vec(), |a, b| Ok::<_, SimilarityError>(numbers[a][b]));
    measured.map_err(|error| Failure::input(format!("{}: {error}", path.display())))
}

/// The cells of CSV text; the line on which a quote is opened and never closed.
fn rows(text: &str) -> Result<Vec<Vec<String>>, usize> {
    let (mut rows, mut row, mut cell) = (Vec::new(), Vec::new(), String::new());
    let mut letters = text.trim_start_matches('\u{feff}').chars().peekable();
    let mut quoted = None;
    while let Some(letter) = letters.next() {
        match (letter, quoted) {
            ('"', Some(_)) if letters.peek() == Some(&'"') => cell.extend(letters.next()),
            ('"', Some(_)) => quoted = None,
            ('"', None) if cell.is_empty() => quoted = Some(rows.len() + 1),
            (',', None) => row.push(std::mem::take(&mut cell)),
            ('\r', None) => {}
            ('\n', None) => {
                row.push(std::mem::take(&mut cell));
                rows.push(std::mem::take(&mut row));
            }
            (letter, _) => cell.push(letter),
        }
    }
    if let Some(line) = quoted {
        return Err(line);
    }
    if !row.is_empty() || !cell.is_empty() {
        row.push(cell);
        rows.push(row);
    }
    rows.retain(|row| row.len() > 1 || !row[0].is_empty());
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read_text(text: &str) -> Result<DistanceMatrix, String> {
        let file = tempfile::NamedTempFile::new().expect("the machine has a folder for temporary files");
        std::fs::write(file.path(), text).expect("it can be written");
        read(file.path()).map_err(|failure| match failure {
            Failure::Input(text) | Failure::Usage(text) => text,
        })
    }

    #[test]
    fn what_a_matrix_writes_is_read_back() {
        let labels = ["t#a", "a,b", "say \"x\""].map(str::to_owned).to_vec();
        let matrix = DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>(0.1 * (a + b) as f64))
            .expect("these are distances");
        assert_eq!(read_text(&matrix.to_csv()), Ok(matrix.clone()));
        assert_eq!(read_text(&matrix.to_csv().replace('\n', "\r\n")), Ok(matrix));
    }

    #[test]
    fn what_is_no_matrix_says_where() {
        let check = |text: &str, expected: &str| {
            let said = read_text(text).expect_err("it is no matrix");
            assert!(said.contains(expected), "{said}");
        };
        check("", ":1: found no line of labels");
        check("distance\n0.5\n", ":1: found no line of labels");
        check(",a,b\na,0,1\n", ":2: found 1 rows, expected 2");
        check(",a,b\na,0,1\nc,1,0\n", ":3: found 3 cells that begin with \"c\"");
        check(",a,b\na,0,1\nb,x,0\n", ":3: found \"x\", expected a number");
        check(",a,b\na,0,1\nb,2,0\n", ":3: b to a: found 2, expected 1");
        check(",a,b\na,0.5,1\nb,1,0\n", ":2: a to a: found 0.5, expected 0");
        check(",a,b\na,0,-1\nb,-1,0\n", "found -1, expected a finite number");
        check(",\"a,b\n", ":1: found a quote that is never closed");
    }
}

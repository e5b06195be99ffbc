//! Text as geometry: a block font of five by seven squares per character, merged into a few rectangles.

use super::Mesh;

/// Number of squares of a character, across and down.
pub(crate) const CHARACTER_SIZE: [u32; 2] = [5, 7];

/// Each character as seven rows from the top; the highest of five bits is the left square.
const FONT: &[(char, [u8; 7])] = &[
    (' ', [0; 7]),
    ('!', [0x04, 0x04, 0x04, 0x04, 0x04, 0x00, 0x04]),
    ('+', [0x00, 0x04, 0x04, 0x1F, 0x04, 0x04, 0x00]),
    ('-', [0x00, 0x00, 0x00, 0x1F, 0x00, 0x00, 0x00]),
    ('0', [0x0E, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0E]),
    ('1', [0x04, 0x0C, 0x04, 0x04, 0x04, 0x04, 0x0E]),
    ('2', [0x0E, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1F]),
    ('3', [0x1F, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0E]),
    ('4', [0x02, 0x06, 0x0A, 0x12, 0x1F, 0x02, 0x02]),
    ('5', [0x1F, 0x10, 0x1E, 0x01, 0x01, 0x11, 0x0E]),
    ('6', [0x06, 0x08, 0x10, 0x1E, 0x11, 0x11, 0x0E]),
    ('7', [0x1F, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08]),
    ('8', [0x0E, 0x11, 0x11, 0x0E, 0x11, 0x11, 0x0E]),
    ('9', [0x0E, 0x11, 0x11, 0x0F, 0x01, 0x02, 0x0C]),
    ('<', [0x02, 0x04, 0x08, 0x10, 0x08, 0x04, 0x02]),
    ('>', [0x08, 0x04, 0x02, 0x01, 0x02, 0x04, 0x08]),
    ('?', [0x0E, 0x11, 0x01, 0x02, 0x04, 0x00, 0x04]),
    ('A', [0x0E, 0x11, 0x11, 0x1F, 0x11, 0x11, 0x11]),
    ('B', [0x1E, 0x11, 0x11, 0x1E, 0x11, 0x11, 0x1E]),
    ('C', [0x0E, 0x11, 0x10, 0x10, 0x10, 0x11, 0x0E]),
    ('D', [0x1C, 0x12, 0x11, 0x11, 0x11, 0x12, 0x1C]),
    ('E', [0x1F, 0x10, 0x10, 0x1E, 0x10, 0x10, 0x1F]),
    ('F', [0x1F, 0x10, 0x10, 0x1E, 0x10, 0x10, 0x10]),
    ('G', [0x0E, 0x11, 0x10, 0x17, 0x11, 0x11, 0x0F]),
    ('H', [0x11, 0x11, 0x11, 0x1F, 0x11, 0x11, 0x11]),
    ('I', [0x0E, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0E]),
    ('J', [0x07, 0x02, 0x02, 0x02, 0x02, 0x12, 0x0C]),
    ('K', [0x11, 0x12, 0x14, 0x18, 0x14, 0x12, 0x11]),
    ('L', [0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1F]),
    ('M', [0x11, 0x1B, 0x15, 0x15, 0x11, 0x11, 0x11]),
    ('N', [0x11, 0x11, 0x19, 0x15, 0x13, 0x11, 0x11]),
    ('O', [0x0E, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0E]),
    ('P', [0x1E, 0x11, 0x11, 0x1E, 0x10, 0x10, 0x10]),
    ('Q', [0x0E, 0x11, 0x11, 0x11, 0x15, 0x12, 0x0D]),
    ('R', [0x1E, 0x11, 0x11, 0x1E, 0x14, 0x12, 0x11]),
    ('S', [0x0F, 0x10, 0x10, 0x0E, 0x01, 0x01, 0x1E]),
    ('T', [0x1F, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04]),
    ('U', [0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0E]),
    ('V', [0x11, 0x11, 0x11, 0x11, 0x11, 0x0A, 0x04]),
    ('W', [0x11, 0x11, 0x11, 0x15, 0x15, 0x15, 0x0A]),
    ('X', [0x11, 0x11, 0x0A, 0x04, 0x0A, 0x11, 0x11]),
    ('Y', [0x11, 0x11, 0x11, 0x0A, 0x04, 0x04, 0x04]),
    ('Z', [0x1F, 0x01, 0x02, 0x04, 0x08, 0x10, 0x1F]),
];

/// Whether a square of a character, counted from the left and the top, is filled; characters missing from the font are blank.
pub(crate) fn is_filled(character: char, column: u32, row: u32) -> bool {
    let found = FONT.binary_search_by_key(&character, |(character, _)| *character);
    found.is_ok_and(|index| FONT[index].1[row as usize] >> (CHARACTER_SIZE[0] - 1 - column) & 1 == 1)
}

/// A character as disjoint rectangles: left, top, width and height in squares. Identical runs in successive rows are one
/// rectangle.
fn rectangles(character: char) -> Vec<[u32; 4]> {
    let [columns, rows] = CHARACTER_SIZE;
    let mut found: Vec<[u32; 4]> = Vec::new();
    for row in 0..rows {
        let mut column = 0;
        while column < columns {
            let run = (column..columns)
                .take_while(|column| is_filled(character, *column, row))
                .count() as u32;
            if run == 0 {
                column += 1;
                continue;
            }
            let is_above = |[left, top, wide, high]: &&mut [u32; 4]| (*left, *wide, top + high) == (column, run, row);
            if let Some([.., high]) = found.iter_mut().find(is_above) {
                *high += 1;
            } else {
                found.push([column, row, run, 1]);
            }
            column += run;
        }
    }
    found
}

/// Text in the plane y = `front`, centred at x = 0 and z = `middle`, readable when looking along −y; `square` is the size of a
/// square in metres.
pub(crate) fn text_mesh(text: &str, square: f32, front: f32, middle: f32) -> Mesh {
    let [columns, rows] = CHARACTER_SIZE.map(|count| count as f32);
    let count = text.chars().count() as f32;
    let left = square * ((columns + 1.0) * count - 1.0) / 2.0;
    let top = middle + square * rows / 2.0;
    let mut mesh = Mesh::default();
    for (k, character) in text.chars().enumerate() {
        let start = left - square * (columns + 1.0) * k as f32;
        for rectangle in rectangles(character) {
            let [column, row, wide, high] = rectangle.map(|count| square * count as f32);
            let ([x0, x1], [z0, z1]) = ([start - column, start - column - wide], [top - row, top - row - high]);
            let first = mesh.corners.len() as u32;
            mesh.corners
                .extend([[x0, front, z0], [x0, front, z1], [x1, front, z1], [x1, front, z0]]);
            mesh.triangles
                .extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn font_is_sorted_and_its_characters_are_distinct() {
        assert!(
            FONT.windows(2).all(|pair| pair[0].0 < pair[1].0),
            "binary search needs a sorted font"
        );
        for (k, (character, rows)) in FONT.iter().enumerate() {
            assert!(FONT[..k].iter().all(|(_, other)| other != rows), "{character}");
        }
        assert_eq!(FONT.len(), 26 + 10 + 6 + 1);
    }

    #[test]
    fn rectangles_cover_exactly_the_filled_squares_once() {
        for (character, _) in FONT {
            let rectangles = rectangles(*character);
            for (row, column) in
                (0..CHARACTER_SIZE[1]).flat_map(|row| (0..CHARACTER_SIZE[0]).map(move |column| (row, column)))
            {
                let covers = |[left, top, wide, high]: &&[u32; 4]| {
                    (*left..left + wide).contains(&column) && (*top..top + high).contains(&row)
                };
                let num_covers = rectangles.iter().filter(covers).count();
                assert_eq!(
                    num_covers,
                    usize::from(is_filled(*character, column, row)),
                    "{character}: {column}, {row}"
                );
            }
            assert!(rectangles.len() <= 11, "{character}: {} rectangles", rectangles.len());
        }
        assert_eq!(rectangles('I'), [[1, 0, 3, 1], [2, 1, 1, 5], [1, 6, 3, 1]]);
    }
}

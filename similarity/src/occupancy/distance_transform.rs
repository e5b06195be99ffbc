//! Distance transform: from each cell of a plane to the nearest taken one.

use super::bit_grid::BitGrid;

/// Squared distances, in cells, from each taken cell of a plane of `a` to the nearest taken cell of the same plane of `b`.
/// `None` if the plane of `b` is empty.
///
/// Exact, in time linear in the number of cells (Meijster, Roerdink and Hesselink 2000).
pub(super) fn nearest_squared(a: &BitGrid, b: &BitGrid, plane: usize) -> Option<Vec<u64>> {
    let shape = b.shape();
    let (columns, rows) = (shape.columns(), shape.rows());
    let first = plane * columns * rows;
    let far = columns + rows;
    // Along each column first: cells to the nearest taken one to the south or north.
    let mut along = vec![far; columns * rows];
    let mut any = false;
    for column in 0..columns {
        let mut distance = far;
        for row in 0..rows {
            let cell = row * columns + column;
            let taken = b.is_taken(first + cell);
            any |= taken;
            distance = if taken { 0 } else { (distance + 1).min(far) };
            along[cell] = distance;
        }
        for row in (0..rows).rev() {
            let cell = row * columns + column;
            distance = (distance + 1).min(along[cell]);
            along[cell] = distance;
        }
    }
    if !any {
        return None;
    }
    let mut found = Vec::with_capacity(a.count());
    let mut parabolas = Vec::with_capacity(columns);
    for (row, heights) in along.chunks_exact(columns).enumerate() {
        lower_envelope(heights, &mut parabolas);
        let mut next = 0;
        for column in 0..columns {
            while next + 1 < parabolas.len() && parabolas[next + 1].1 <= column {
                next += 1;
            }
            if a.is_taken(first + row * columns + column) {
                let centre: usize = parabolas[next].0;
                found.push((column.abs_diff(centre).pow(2) + heights[centre].pow(2)) as u64);
            }
        }
    }
    Some(found)
}

/// The parabolas (x − centre)² + height² on the lower envelope, from west to east, each with the first column where it is
/// lowest.
fn lower_envelope(heights: &[usize], parabolas: &mut Vec<(usize, usize)>) {
    let at = |centre: usize, x: usize| x.abs_diff(centre).pow(2) + heights[centre].pow(2);
    parabolas.clear();
    for centre in 0..heights.len() {
        while parabolas
            .last()
            .is_some_and(|&(last, from)| at(last, from) > at(centre, from))
        {
            parabolas.pop();
        }
        let from = match parabolas.last() {
            None => 0,
            // The first whole column at which the new one is lower: right of the intersection.
            Some(&(last, _)) => {
                let (new, old) = (
                    centre.pow(2) + heights[centre].pow(2),
                    last.pow(2) + heights[last].pow(2),
                );
                (new as i64 - old as i64).div_euclid(2 * (centre - last) as i64) + 1
            }
        };
        if from < heights.len() as i64 {
            parabolas.push((centre, from as usize));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GridShape;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn distances_match_brute_force(
            columns in 1usize..12,
            rows in 1usize..12,
            cells in prop::collection::vec((any::<bool>(), prop::bool::weighted(0.15)), 288),
        ) {
            let shape = GridShape::new(columns, rows, 2, 1.0).unwrap();
            let (a, b): (Vec<bool>, Vec<bool>) = cells.into_iter().unzip();
            let (a, b) = (BitGrid::new(shape, a), BitGrid::new(shape, b));
            for plane in 0..2 {
                let positions = |grid: &BitGrid| -> Vec<(usize, usize)> {
                    let cells = 0..columns * rows;
                    cells.filter(|cell| grid.is_taken(plane * columns * rows + cell)).map(|cell| (cell % columns, cell / columns)).collect()
                };
                let squared = |p: (usize, usize), q: &(usize, usize)| (p.0.abs_diff(q.0).pow(2) + p.1.abs_diff(q.1).pow(2)) as u64;
                let targets = positions(&b);
                let expected: Option<Vec<u64>> = positions(&a).into_iter().map(|p| targets.iter().map(|q| squared(p, q)).min()).collect();
                let expected = if targets.is_empty() { None } else { expected };
                prop_assert_eq!(nearest_squared(&a, &b, plane), expected);
            }
        }
    }
}

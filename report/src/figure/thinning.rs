//! Reduces lines and point clouds to at most four points per pixel column.

use crate::extent;

/// The first, lowest, highest and last point of each column, in order. A line through them looks like the original line.
pub(super) fn line(points: &[(f64, f64)], column: impl Fn(f64) -> i64) -> Vec<(f64, f64)> {
    let mut thinned = Vec::new();
    for group in points.chunk_by(|a, b| column(a.0) == column(b.0)) {
        let by_height = |a: &usize, b: &usize| group[*a].1.total_cmp(&group[*b].1).then(a.cmp(b));
        let ends = [0, group.len() - 1];
        let heights = [(0..group.len()).min_by(by_height), (0..group.len()).max_by(by_height)];
        let mut kept: Vec<usize> = ends.into_iter().chain(heights.into_iter().flatten()).collect();
        kept.sort_unstable();
        kept.dedup();
        thinned.extend(kept.into_iter().map(|index| group[index]));
    }
    thinned
}

/// The outline of a point cloud: along the highest point of each column, and back along the lowest. It has at least the given
/// width and height, so that a single column becomes a vertical stroke.
pub(super) fn outline(
    points: &[(f64, f64)],
    column: impl Fn(f64) -> i64,
    (min_width, min_height): (f64, f64),
) -> Vec<(f64, f64)> {
    let mut upper = Vec::new();
    let mut lower = Vec::new();
    for group in points.chunk_by(|a, b| column(a.0) == column(b.0)) {
        let (low, high) = extent(group.iter().map(|point| point.1));
        let padding = ((min_height - (high - low)) / 2.0).max(0.0);
        upper.push((group[0].0, high + padding));
        lower.push((group[0].0, low - padding));
    }
    if let ([(first, _), ..], [.., (last, high)], [.., (_, low)]) = (points, &upper[..], &lower[..])
        && last - first < min_width
    {
        let (end, high, low) = (first + min_width, *high, *low);
        upper.push((end, high));
        lower.push((end, low));
    }
    upper.extend(lower.into_iter().rev());
    upper
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn column_keeps_its_first_lowest_highest_and_last_point() {
        let check = |heights: &[f64], expected: &[f64]| {
            let points: Vec<(f64, f64)> = heights.iter().enumerate().map(|(x, y)| (x as f64, *y)).collect();
            let found: Vec<f64> = line(&points, |_| 0).into_iter().map(|point| point.1).collect();
            assert_eq!(found, expected);
        };
        check(&[3.0, 9.0, 4.0, 1.0, 5.0], &[3.0, 9.0, 1.0, 5.0]);
        check(&[3.0], &[3.0]);
        check(&[2.0, 2.0, 2.0], &[2.0, 2.0]);
        check(&[], &[]);
    }

    #[test]
    fn outline_has_an_area_even_if_short_or_flat() {
        let check = |points: &[(f64, f64)], expected: &[(f64, f64)]| {
            assert_eq!(outline(points, |x| x as i64, (1.5, 2.0)), expected);
        };
        check(&[], &[]);
        check(&[(3.0, 5.0)], &[(3.0, 6.0), (4.5, 6.0), (4.5, 4.0), (3.0, 4.0)]);
        check(
            &[(3.0, 5.0), (3.5, 9.0)],
            &[(3.0, 9.0), (4.5, 9.0), (4.5, 5.0), (3.0, 5.0)],
        );
        check(
            &[(0.0, 1.0), (4.0, 1.0)],
            &[(0.0, 2.0), (4.0, 2.0), (4.0, 0.0), (0.0, 0.0)],
        );
    }

    #[test]
    fn million_points_become_four_per_column() {
        let points: Vec<(f64, f64)> = (0..1_000_000)
            .map(|x| (f64::from(x), f64::from(x % 1009 * 7 % 1000)))
            .collect();
        let thinned = line(&points, |x| (x / 10_000.0) as i64);
        assert!(thinned.len() <= 400, "{}", thinned.len());
        assert!(
            thinned.windows(2).all(|pair| pair[0].0 < pair[1].0),
            "points stay in order"
        );
        assert_eq!(outline(&points, |x| (x / 10_000.0) as i64, (1.0, 1.0)).len(), 200);
    }
}

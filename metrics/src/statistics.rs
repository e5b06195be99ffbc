//! Basic statistics for the metrics: mean, variance, quantile, median, Theil–Sen slope, and whether a least-squares line falls.

/// Arithmetic mean; `None` if there are no values.
pub(crate) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| sum(values) / values.len() as f64)
}

/// The sum in `NumPy`'s order, so that means match the reference bit for bit: eight parallel sums; more than 128 values are
/// split into two halves, which are summed separately.
pub(crate) fn sum(values: &[f64]) -> f64 {
    let num = values.len();
    if num < 8 {
        return values.iter().sum();
    }
    if num > 128 {
        let half = num / 2 - (num / 2) % 8;
        return sum(&values[..half]) + sum(&values[half..]);
    }
    let (chunks, rest) = values.as_chunks::<8>();
    let mut lanes = [0.0; 8];
    for (index, chunk) in chunks.iter().enumerate() {
        for (sum, value) in lanes.iter_mut().zip(chunk) {
            *sum = if index == 0 { *value } else { *sum + value };
        }
    }
    let [a, b, c, d, e, f, g, h] = lanes;
    rest.iter()
        .fold(((a + b) + (c + d)) + ((e + f) + (g + h)), |sum, value| sum + value)
}

/// The sample variance; `None` for fewer than two values.
pub(crate) fn variance(values: &[f64]) -> Option<f64> {
    let center = mean(values)?;
    let squares: f64 = values.iter().map(|value| (value - center) * (value - center)).sum();
    (values.len() > 1).then(|| squares / (values.len() - 1) as f64)
}

/// The mean of the values that are not NaN; infinite if one of them is infinite, `None` if there are none.
pub(crate) fn mean_of_known(values: &[f64]) -> Option<f64> {
    let known: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    mean(&known)
}

/// Quantile with linear interpolation between the two nearest values; `q` in `0..=1`. `None` if there are no values.
pub(crate) fn quantile(values: &[f64], q: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    let position = q * last as f64;
    let below = position.floor() as usize;
    let above = (below + 1).min(last);
    let (low, high, share) = (sorted[below], sorted[above], position - below as f64);
    // From the nearer end, as in NumPy.
    Some(if share < 0.5 {
        low + (high - low) * share
    } else {
        high - (high - low) * (1.0 - share)
    })
}

/// Middle value, or the mean of the two middle ones; `None` if there are no values. Takes a `Vec` to sort it in place, because a
/// long lifetime has many slopes.
pub(crate) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        n if n % 2 == 1 => Some(values[middle]),
        _ => Some(f64::midpoint(values[middle - 1], values[middle])),
    }
}

/// Median slope over all pairs of points `(0, y[0]), (1, y[1]), …`; `None` for fewer than two points. `O(n² log n)`.
pub(crate) fn theil_sen_slope(y: &[f64]) -> Option<f64> {
    let slopes: Vec<f64> = (0..y.len())
        .flat_map(|first| (first + 1..y.len()).map(move |second| (first, second)))
        .map(|(first, second)| (y[second] - y[first]) / (second - first) as f64)
        .collect();
    median(slopes)
}

/// Whether the least-squares line through the points falls by more than errors of up to `slack` in each `y` could explain. A
/// constant or a single point does not fall.
pub(crate) fn trend_falls(x: &[f64], y: &[f64], slack: f64) -> bool {
    let (Some(mean_x), Some(mean_y)) = (mean(x), mean(y)) else {
        return false;
    };
    let explained = slack * x.iter().map(|x| (x - mean_x).abs()).sum::<f64>();
    x.iter().zip(y).map(|(x, y)| (x - mean_x) * (y - mean_y)).sum::<f64>() < -explained
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_interpolate_between_neighbours() {
        let check = |values: &[f64], q: f64, expected: Option<f64>| assert_eq!(quantile(values, q), expected);
        check(&[], 0.5, None);
        check(&[7.0], 0.9, Some(7.0));
        check(&[3.0, 1.0, 2.0], 0.5, Some(2.0));
        check(&[1.0, 2.0, 3.0, 4.0, 5.0], 0.125, Some(1.5));
        check(&[1.0, 2.0], 1.0, Some(2.0));
    }

    #[test]
    fn median_is_the_middle() {
        let check = |values: &[f64], expected: Option<f64>| assert_eq!(median(values.to_vec()), expected);
        check(&[], None);
        check(&[5.0, 1.0, 3.0], Some(3.0));
        check(&[4.0, 1.0, 3.0, 2.0], Some(2.5));
    }

    #[test]
    fn theil_sen_slope_ignores_one_outlier() {
        let check = |y: &[f64], expected: Option<f64>| assert_eq!(theil_sen_slope(y), expected);
        check(&[1.0], None);
        check(&[1.0, 4.0], Some(3.0));
        // Slopes 18, 6, -6: the middle one.
        check(&[0.0, 18.0, 12.0], Some(6.0));
        // Ten of the fifteen slopes are 1, the five to the outlier are not.
        check(&[0.0, 1.0, 2.0, 3.0, 4.0, 500.0], Some(1.0));
    }

    #[test]
    fn trend_falls_only_if_the_line_does() {
        let check = |y: &[f64], expected: bool| {
            let x: Vec<f64> = (0..y.len()).map(|i| i as f64).collect();
            assert_eq!(trend_falls(&x, y, 0.0), expected, "{y:?}");
        };
        check(&[], false);
        check(&[3.0], false);
        check(&[3.0, 3.0, 3.0], false);
        check(&[1.0, 2.0, 1.5], false);
        check(&[3.0, 5.0, 1.0], true);
        assert!(!trend_falls(&[0.0, 1.0], &[1.0, 1.0 - 1e-12], 1e-9));
    }
}

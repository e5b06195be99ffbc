//! QUIRK: the reference's file has its lifetime values rounded to ten decimals. Values in memory are not rounded.

/// Rounds through decimal text, because a product with 1e10 would lose the last digits of large values.
pub(super) fn ten_decimals(value: f64) -> f64 {
    format!("{value:.10}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_decimals_are_kept() {
        let check = |value: f64, expected: f64| assert_eq!(ten_decimals(value).to_bits(), expected.to_bits());
        check(0.123_456_789_012_3, 0.123_456_789_0);
        check(-2.0, -2.0);
        check(1e90, 1e90);
        check(123_456_789.123_456_78, 123_456_789.123_456_78);
    }
}

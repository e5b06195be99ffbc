//! Formats numbers for people, without digits that are rounding noise. Files keep every digit.

/// Maximum number of decimal places.
const MAX_PLACES: usize = 6;

/// Maximum number of significant digits of a number with decimals, so that long sums show no rounding noise.
const MAX_DIGITS: usize = 13;

/// A number without rounding noise: at most six decimal places and, if it has any, at most thirteen significant digits; no
/// trailing zeros, and no sign before zero. Numbers of 1e12 or more have no decimals, and keep all other digits.
///
/// ```
/// # use driftworld_text::amount;
/// assert_eq!(amount(100.729_999_999_999_99), "100.73");
/// assert_eq!(amount(0.1 + 0.2 - 0.3), "0");
/// ```
pub fn amount(number: f64) -> String {
    if !number.is_finite() {
        return number.to_string();
    }
    let size = number.abs();
    let places = (0..=MAX_PLACES)
        .rev()
        .find(|places| size < 10_f64.powi((MAX_DIGITS - places) as i32));
    short(number, places.unwrap_or(0))
}

/// A number with at most `places` decimals, without trailing zeros and without a sign before zero.
pub fn short(number: f64, places: usize) -> String {
    let text = format!("{number:.places$}");
    let text = match text.split_once('.') {
        Some(_) => text.trim_end_matches('0').trim_end_matches('.'),
        None => &text,
    };
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// A number with `places` decimals, without a sign if it rounds to zero.
pub fn rounded(number: f64, places: usize) -> String {
    let text = format!("{number:.places$}");
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    text[usize::from(is_zero && text.starts_with('-'))..].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn rounding_noise_is_removed() {
        for (number, expected) in [
            (100.729_999_999_999_99, "100.73"),
            (0.1 + 0.2, "0.3"),
            (0.1 + 0.2 - 0.3, "0"),
            (-1e-12, "0"),
            (-0.0, "0"),
            (-42.100_000_000_000_05, "-42.1"),
            (1000.0, "1000"),
            (2e15, "2000000000000000"),
            (123_456_789.123_456_7, "123456789.1235"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-inf"),
        ] {
            assert_eq!(amount(number), expected);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// Sums of tenths, hundredths and so on are shown as their exact value, however many terms they have.
        #[test]
        fn sums_are_shown_as_their_exact_value(
            parts in prop::collection::vec(-100_000i64..100_000, 1..400),
            places in 0u32..=4,
        ) {
            let unit = 10_i64.pow(places);
            let sum: f64 = parts.iter().map(|part| *part as f64 / unit as f64).sum();
            let exact = parts.iter().sum::<i64>();
            let (whole, rest) = (exact.abs() / unit, exact.abs() % unit);
            let rest = if places == 0 { String::new() } else { format!(".{rest:0>width$}", width = places as usize) };
            let digits = format!("{}{whole}{rest}", if exact < 0 { "-" } else { "" });
            let expected = if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { &digits };
            prop_assert_eq!(amount(sum), if exact == 0 { "0" } else { expected });
        }

        /// The text is the number rounded to six decimals or thirteen digits, and formatting it again changes nothing.
        #[test]
        fn only_rounding_noise_is_dropped(number in prop::num::f64::NORMAL | prop::num::f64::ZERO) {
            let text = amount(number);
            let read: f64 = text.parse().unwrap();
            prop_assert!((read - number).abs() <= 0.5e-6_f64.max(number.abs() * 1e-12), "{} reads as {}", number, text);
            prop_assert_eq!(amount(read), text);
        }
    }
}

//! Whether two choices differ.

/// 0 for equal choices, 1 for different ones.
///
/// A metric (the discrete one), 0 or 1, no unit. The term for categories in Gower's coefficient.
///
/// # Example
/// ```
/// use driftworld_similarity::scalar::choice_mismatch;
/// assert_eq!(choice_mismatch("tree", "rock"), 1.0);
/// assert_eq!(choice_mismatch("tree", "tree"), 0.0);
/// ```
pub fn choice_mismatch<T: PartialEq + ?Sized>(a: &T, b: &T) -> f64 {
    if a == b { 0.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn choice_mismatch_is_a_metric() {
        for a in 0..3 {
            for b in 0..3 {
                assert_eq!(choice_mismatch(&a, &b), choice_mismatch(&b, &a));
                assert_eq!(choice_mismatch(&a, &b) == 0.0, a == b);
                for c in 0..3 {
                    assert!(choice_mismatch(&a, &c) <= choice_mismatch(&a, &b) + choice_mismatch(&b, &c));
                }
            }
        }
    }
}

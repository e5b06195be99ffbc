//! Student's t: the half-width of an interval for few runs, in standard errors.

/// The number of standard errors, on either side, within which Student's t lies with this confidence. `confidence` is between 0 and
/// 1; `freedom`, the degrees of freedom, is above 0 and need not be whole.
#[must_use]
pub fn student_reach(confidence: f64, freedom: f64) -> f64 {
    let outside = |t: f64| incomplete_beta(freedom / (freedom + t * t), freedom / 2.0);
    let wanted = 1.0 - confidence;
    let (mut low, mut high) = (0.0, 1.0);
    while outside(high) > wanted && high < 1e150 {
        (low, high) = (high, high * 2.0);
    }
    // Bisects until there is no number between the two.
    loop {
        let middle = f64::midpoint(low, high);
        if middle <= low || middle >= high {
            return middle;
        }
        if outside(middle) > wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
}

/// The regularised incomplete beta function of `x`, `a` and 1/2.
fn incomplete_beta(x: f64, a: f64) -> f64 {
    const B: f64 = 0.5;
    if x <= 0.0 || x >= 1.0 {
        return x.clamp(0.0, 1.0);
    }
    let log_front = libm::lgamma(a + B) - libm::lgamma(a) - libm::lgamma(B) + a * libm::log(x) + B * libm::log1p(-x);
    let front = libm::exp(log_front);
    // The fraction converges quickly on this side of the mean.
    if x < (a + 1.0) / (a + B + 2.0) {
        front * fraction(x, a, B) / a
    } else {
        1.0 - front * fraction(1.0 - x, B, a) / B
    }
}

/// The continued fraction of the incomplete beta function, by Lentz's method.
fn fraction(x: f64, a: f64, b: f64) -> f64 {
    let nonzero = |value: f64| if value.abs() < 1e-300 { 1e-300 } else { value };
    let (mut c, mut d) = (1.0, 1.0 / nonzero(1.0 - (a + b) * x / (a + 1.0)));
    let mut value = d;
    for step in 1..500 {
        let m = f64::from(step);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        let mut change = 1.0;
        for part in [even, odd] {
            d = 1.0 / nonzero(1.0 + part * d);
            c = nonzero(1.0 + part / c);
            change = c * d;
            value *= change;
        }
        if (change - 1.0).abs() < 1e-15 {
            break;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reach_matches_the_tables() {
        // scipy.stats.t.ppf((1 + confidence) / 2, freedom).
        let check = |confidence: f64, freedom: f64, expected: f64| {
            let found = student_reach(confidence, freedom);
            assert!((found / expected - 1.0).abs() < 1e-9, "{confidence} {freedom}: {found}");
        };
        check(0.95, 1.0, 12.706_204_736_174_694);
        check(0.95, 2.0, 4.302_652_729_749_464);
        check(0.95, 4.0, 2.776_445_105_197_793_4);
        check(0.95, 8.0, 2.306_004_135_204_166_3);
        check(0.99, 4.0, 4.604_094_871_349_993);
        check(0.5, 3.0, 0.764_892_328_404_345_3);
        check(0.95, 6.5, 2.402_002_007_910_276_4);
        check(0.95, 1000.0, 1.962_339_080_826_408_3);
    }
}

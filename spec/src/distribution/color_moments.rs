//! [`Moments`] of distributions of colours: mean and covariance.

use super::color::dip;
use super::{Distribution, Moments};
use crate::value::Value;

impl Distribution<f64> {
    /// Mean and covariance of red, green and blue, exact up to rounding; `None` if it draws anything but colours.
    pub fn color_moments(&self) -> Option<Moments<3>> {
        if self.has_independent_channels() {
            let laws = self.color_channels()?;
            let mut moments = Moments::point([0.0; 3]);
            for (k, law) in laws.iter().enumerate() {
                moments.mean[k] = law.mean()?;
                moments.covariance[k][k] = law.variance()?;
            }
            return Some(moments);
        }
        match self {
            Self::Choice { values, weights } => {
                let point = |value: &Value| value.as_color().map(|color| Moments::point(color.0));
                let parts = values.iter().map(point).collect::<Option<Vec<_>>>()?;
                Some(Moments::mixed(&parts, weights.as_deref()))
            }
            Self::Mixture { parts, weights } => {
                let parts = parts.iter().map(Self::color_moments).collect::<Option<Vec<_>>>()?;
                Some(Moments::mixed(&parts, weights.as_deref()))
            }
            Self::ColorHsv { .. } => self.hsv_moments(),
            // One random number drives all channels; each is piecewise linear between its knots.
            _ => {
                let knots = self.knots()?;
                let at = |u: f64| self.color_at([u; 3]).map_or([0.0; 3], |color| color.0);
                let mean = [0, 1, 2].map(|k| integral(&knots, |u| at(u)[k]));
                Some(Moments::of(mean, |i, j| {
                    integral(&knots, |u| at(u)[i] * at(u)[j]) - mean[i] * mean[j]
                }))
            }
        }
    }

    /// Values of the random number in `0..=1` between which all channels that vary together are linear.
    fn knots(&self) -> Option<Vec<f64>> {
        let mut knots = vec![0.0, 1.0];
        match self {
            Self::ColorUniform { .. } => {}
            Self::ColorPerturb {
                value,
                noise,
                low,
                high,
                ..
            } => {
                let noise = noise.to_array();
                for k in (0..3).filter(|k| noise[*k] > 0.0) {
                    let low = low.as_ref().map_or(0.0, |low| low.0[k]);
                    let high = high.as_ref().map_or(1.0, |high| high.0[k]);
                    knots.extend([low, high].map(|limit| 0.5 * ((limit - value.0[k]) / noise[k] + 1.0)));
                }
            }
            _ => return None,
        }
        knots.retain(|knot| (0.0..=1.0).contains(knot));
        knots.sort_by(f64::total_cmp);
        Some(knots)
    }

    /// Each channel is `v − v s d`, where the dip `d` depends on the hue; hue, saturation and value are independent.
    fn hsv_moments(&self) -> Option<Moments<3>> {
        let [hue, saturation, value] = self.hsv_ends()?;
        let mean_of = |[low, high]: [f64; 2]| f64::midpoint(low, high);
        let square_of = |[low, high]: [f64; 2]| (low * low + low * high + high * high) / 3.0;
        // The dips are linear between multiples of 60 degrees.
        let mut knots = vec![hue[0], hue[1]];
        let (first, last) = ((hue[0] / 60.0).ceil() as i32, (hue[1] / 60.0).floor() as i32);
        knots.extend((first..=last).map(|sixth| 60.0 * f64::from(sixth)));
        knots.sort_by(f64::total_cmp);
        let width = hue[1] - hue[0];
        let over_hues = |of: &dyn Fn(f64) -> f64| {
            if width > 0.0 {
                integral(&knots, of) / width
            } else {
                of(hue[0])
            }
        };
        let dips = [0, 1, 2].map(|k| over_hues(&|hue| dip(k, hue)));
        let mean = dips.map(|dip| mean_of(value) * (1.0 - mean_of(saturation) * dip));
        Some(Moments::of(mean, |i, j| {
            let both = over_hues(&|hue| dip(i, hue) * dip(j, hue));
            let product = 1.0 - mean_of(saturation) * (dips[i] + dips[j]) + square_of(saturation) * both;
            square_of(value) * product - mean[i] * mean[j]
        }))
    }
}

/// Integrates a function that is a polynomial of degree 3 or less between knots, by Simpson's rule.
fn integral(knots: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let piece = |low: f64, high: f64| (high - low) / 6.0 * (of(low) + 4.0 * of(f64::midpoint(low, high)) + of(high));
    knots.windows(2).map(|ends| piece(ends[0], ends[1])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::value::ParameterType;

    fn law(text: &str) -> Distribution {
        serde_json::from_str(text).unwrap_or_else(|error| panic!("{text}: {error}"))
    }

    /// Agrees with the moments over a fine grid of random numbers.
    #[test]
    fn color_moments_agree_with_a_grid_of_draws() {
        for text in [
            r#"{"color_uniform": {"from": "red", "to": [0.2, 0.4, 0.5]}}"#,
            r#"{"color_uniform": {"from": "red", "to": [0.2, 0.4, 0.5], "channels": "together"}}"#,
            r#"{"color_normal": {"mean": [0.5, 0.05, 1], "std": [0.1, 0.3, 0]}}"#,
            r#"{"color_perturb": {"value": [0.1, 0.5, 0.9], "noise": [0.3, 0, 0.2], "high": [1, 1, 0.95]}}"#,
            r#"{"color_perturb": {"value": [0.1, 0.5, 0.9], "noise": [0.3, 0.1, 0.2], "channels": "together"}}"#,
            r#"{"color_hsv": {"hue": [-50, 200], "saturation": [0.2, 0.9], "value": [0.5, 0.8]}}"#,
            r#"{"color_hsv": {}}"#,
        ] {
            let law = law(text);
            assert_eq!(law.fault(), None, "{text}");
            let moments = law.color_moments().expect("it draws colours");
            let steps = 60;
            let unit = |k: u32| (f64::from(k) + 0.5) / f64::from(steps);
            let mut colors = Vec::new();
            for a in 0..steps {
                for b in 0..steps {
                    let each = (0..steps).map(|c| law.color_at([unit(a), unit(b), unit(c)]));
                    colors.extend(each.map(|color| color.expect("it draws colours").0));
                }
            }
            let mean = |of: &dyn Fn(&[f64; 3]) -> f64| colors.iter().map(of).sum::<f64>() / colors.len() as f64;
            for i in 0..3 {
                assert!((mean(&|c| c[i]) - moments.mean[i]).abs() < 1e-3, "{text}: {moments:?}");
                for j in 0..3 {
                    let found = mean(&|c| (c[i] - moments.mean[i]) * (c[j] - moments.mean[j]));
                    assert!(
                        (found - moments.covariance[i][j]).abs() < 1e-3,
                        "{text}: {i} {j} {found} {moments:?}"
                    );
                }
            }
        }
    }

    #[test]
    fn mixture_mean_lies_between_its_parts() {
        let text = r#"{"mixture": {"parts": [{"constant": {"value": "red"}}, {"color_normal": {"mean": "blue", "std": 0}},
            {"choice": {"values": ["lime", "lime"]}}], "weights": [1, 1, 2]}}"#;
        let law = law(text);
        let moments = law.color_moments().expect("it draws colours");
        assert_eq!(moments.mean, [0.25, 0.5, 0.25]);
        assert_eq!(moments.covariance[0], [0.1875, -0.125, -0.0625]);
        let channels = law.color_channels().expect("no part is a `color_hsv`");
        assert_eq!(
            channels.map(|channel| channel.mean()),
            [Some(0.25), Some(0.5), Some(0.25)]
        );
        assert!(law.draws_colors() && law.yields(ParameterType::Color) && !law.yields(ParameterType::Vector));
    }
}

//! Compare two distributions of a parameter with every measure in the library: some see a shift, others only the overlap.
#![expect(clippy::print_stdout, reason = "an example prints its results")]

use driftworld::similarity::distribution::{
    Measured, energy, hellinger, jensen_shannon, kullback_leibler, total_variation, wasserstein_1, wasserstein_2,
};
use driftworld::spec::Distribution;

/// A measure of two distributions; `None` if it is undefined for them.
type Measure = fn(&Distribution, &Distribution) -> Option<Measured>;

fn main() {
    let normal = |mean| Distribution::Normal { mean, std: 1.0 };
    let (here, near, far) = (normal(0.0), normal(4.0), normal(40.0));
    let measures: [(&str, Measure); 7] = [
        ("Wasserstein 1", wasserstein_1),
        ("Wasserstein 2", wasserstein_2),
        ("energy distance", energy),
        ("Hellinger", hellinger),
        ("Jensen-Shannon", jensen_shannon),
        ("total variation", total_variation),
        ("Kullback-Leibler", kullback_leibler),
    ];
    println!("{:<18}{:>10}{:>10}", "normal shifted by", 4, 40);
    for (name, measure) in measures {
        let value = |other| measure(&here, other).map_or(f64::NAN, |found| found.value);
        println!("{name:<18}{:>10.4}{:>10.4}", value(&near), value(&far));
    }
}

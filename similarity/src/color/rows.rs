//! The loop of CIEDE2000 from one colour to many, with the widest vectors that the processor has. The formula is in `ciede2000.rs`.
#![expect(
    unsafe_code,
    reason = "code made for newer instructions may only run where they are; each call stands below the test that they are there"
)]

use crate::color::lab::LabTable;

use super::ciede2000::row;

/// The distances from a colour to each of a table, of which there are as many as places for distances.
///
/// The instructions change nothing but the time: each number comes from the same operations in the same order, and none of the
/// sets is allowed to fuse a multiplication with an addition.
pub(super) fn fill(from: [f64; 3], chroma: f64, to: &LabTable, distances: &mut [f64]) {
    #[cfg(target_arch = "x86_64")]
    {
        if std::arch::is_x86_feature_detected!("avx512f") && std::arch::is_x86_feature_detected!("avx512dq") {
            // SAFETY: the processor has AVX-512 F and DQ, which is all that the function asks for.
            return unsafe { fill_avx512(from, chroma, to, distances) };
        }
        if std::arch::is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, which is all that the function asks for.
            return unsafe { fill_avx2(from, chroma, to, distances) };
        }
    }
    row(from, chroma, to, distances);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn fill_avx2(from: [f64; 3], chroma: f64, to: &LabTable, distances: &mut [f64]) {
    row(from, chroma, to, distances);
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512dq")]
fn fill_avx512(from: [f64; 3], chroma: f64, to: &LabTable, distances: &mut [f64]) {
    row(from, chroma, to, distances);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Lab, ciede2000};

    #[test]
    fn every_set_of_instructions_gives_the_numbers_of_one_pair_alone() {
        let color = |k: usize| {
            let share = |step: f64| (k as f64 * step).fract();
            Lab([
                100.0 * share(0.618),
                200.0 * share(0.414) - 100.0,
                200.0 * share(0.303) - 100.0,
            ])
        };
        let colors: Vec<Lab> = (0..if cfg!(miri) { 14 } else { 203 })
            .map(color)
            .chain([Lab([50.0, 0.0, 0.0]); 2])
            .collect();
        let table: LabTable = colors.iter().copied().collect();
        let mut found = vec![0.0; colors.len()];
        for from in &colors {
            let expected: Vec<f64> = colors.iter().map(|to| ciede2000(*from, *to)).collect();
            fill(from.0, from.chroma(), &table, &mut found);
            assert_eq!(found, expected);
            row(from.0, from.chroma(), &table, &mut found);
            assert_eq!(found, expected);
            #[cfg(target_arch = "x86_64")]
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: the processor has AVX2.
                unsafe { fill_avx2(from.0, from.chroma(), &table, &mut found) };
                assert_eq!(found, expected);
            }
        }
    }
}

//! The largest eigenvalue of a symmetric matrix that is given by its product with a vector.
//!
//! Lanczos' method with full reorthogonalisation, using only plain sums and square roots: bit-identical on every machine, with
//! any number of threads in the caller's products.

use crate::split_mix::SplitMix64;

/// Maximum number of steps between two restarts.
const MAX_STEPS: usize = 160;
/// Maximum number of runs; each later one starts from the vector found by the previous one.
const MAX_RESTARTS: usize = 12;
/// Maximum error of `A v = λ v`, relative to the largest `λ`.
const PRECISION: f64 = 1e-12;

/// The largest eigenvalue of a symmetric matrix on the subspace orthogonal to some orthonormal vectors, with its eigenvector of
/// length 1, whose largest entry is positive. `multiply(x, y)` writes the matrix times `x` into `y`.
///
/// `None` if nothing is orthogonal to those vectors. For repeated eigenvalues, call it again with the vectors found so far.
pub(crate) fn largest(
    n: usize,
    multiply: &impl Fn(&[f64], &mut [f64]),
    excluded: &[Vec<f64>],
) -> Option<(f64, Vec<f64>)> {
    // Each eigenvector gets a new start: the old one has no component left in an eigenspace that it already led into.
    let mut rng = SplitMix64(excluded.len() as u64);
    let mut start: Vec<f64> = (0..n).map(|_| rng.unit() - 0.5).collect();
    let mut best = None;
    for _ in 0..MAX_RESTARTS {
        let Some(found) = run(n, multiply, excluded, start.clone()) else {
            break;
        };
        let done = found.error <= PRECISION * found.scale;
        start.clone_from(&found.vector);
        best = Some((found.value, found.vector));
        if done {
            break;
        }
    }
    let (value, vector) = best?;
    Some((value, with_fixed_sign(vector)))
}

struct Run {
    value: f64,
    vector: Vec<f64>,
    error: f64,
    scale: f64,
}

/// One series of steps from a start.
fn run(n: usize, multiply: &impl Fn(&[f64], &mut [f64]), excluded: &[Vec<f64>], mut start: Vec<f64>) -> Option<Run> {
    let max_steps = MAX_STEPS.min(n.saturating_sub(excluded.len()));
    remove(&mut start, excluded);
    remove(&mut start, excluded);
    let length = dot(&start, &start).sqrt();
    if max_steps == 0 || length < 1e-9 {
        return None;
    }
    let mut basis = vec![scaled(&start, 1.0 / length)];
    let (mut diagonal, mut off_diagonal) = (Vec::new(), Vec::new());
    let mut next = vec![0.0; n];
    loop {
        let here = &basis[basis.len() - 1];
        multiply(here, &mut next);
        diagonal.push(dot(here, &next));
        for _ in 0..2 {
            remove(&mut next, excluded);
            remove(&mut next, &basis);
        }
        let rest = dot(&next, &next).sqrt();
        let steps = basis.len();
        let scale = diagonal
            .iter()
            .chain(&off_diagonal)
            .fold(0.0_f64, |a, b: &f64| a.max(b.abs()));
        let ended = steps == max_steps || rest <= 1e-14 * scale;
        if ended || steps % 8 == 0 {
            // The error needs only the last entry of each eigenvector of the small matrix.
            let mut last = vec![vec![0.0; steps]];
            last[0][steps - 1] = 1.0;
            let values = tridiagonal(&diagonal, &off_diagonal, &mut last);
            let top = index_of_largest(&values);
            let error = (rest * last[0][top]).abs();
            if ended || error <= PRECISION * scale {
                let mut rows: Vec<Vec<f64>> = (0..steps).map(|row| unit(steps, row)).collect();
                let values = tridiagonal(&diagonal, &off_diagonal, &mut rows);
                let top = index_of_largest(&values);
                let mut vector = vec![0.0; n];
                for (direction, row) in basis.iter().zip(&rows) {
                    vector
                        .iter_mut()
                        .zip(direction)
                        .for_each(|(to, from)| *to += row[top] * from);
                }
                let length = dot(&vector, &vector).sqrt();
                return Some(Run {
                    value: values[top],
                    vector: scaled(&vector, 1.0 / length),
                    error: if rest <= 1e-14 * scale { 0.0 } else { error },
                    scale,
                });
            }
        }
        basis.push(scaled(&next, 1.0 / rest));
        off_diagonal.push(rest);
    }
}

/// The eigenvalues of a symmetric tridiagonal matrix by the implicit QL method; `rows` of the identity become rows of the
/// matrix of eigenvectors, which are its columns.
///
/// Source: Bowdler, Martin, Reinsch and Wilkinson 1968 (`tql2` of EISPACK).
fn tridiagonal(diagonal: &[f64], off_diagonal: &[f64], rows: &mut [Vec<f64>]) -> Vec<f64> {
    let n = diagonal.len();
    let mut d = diagonal.to_vec();
    let mut e = off_diagonal.to_vec();
    e.resize(n, 0.0);
    for low in 0..n {
        // About three iterations suffice for each; the bound ends the loop for matrices of NaN.
        for _ in 0..64 {
            let small = |k: usize| e[k].abs() <= f64::EPSILON * (d[k].abs() + d[k + 1].abs());
            let high = (low..n - 1).find(|k| small(*k)).unwrap_or(n - 1);
            if high == low {
                break;
            }
            sweep(&mut d, &mut e, rows, low, high);
        }
    }
    d
}

/// One QL step on the block from `low` to `high`.
fn sweep(d: &mut [f64], e: &mut [f64], rows: &mut [Vec<f64>], low: usize, high: usize) {
    let mut g = (d[low + 1] - d[low]) / (2.0 * e[low]);
    let mut r = libm::hypot(g, 1.0);
    g = d[high] - d[low] + e[low] / (g + r.copysign(g));
    let (mut s, mut c, mut p) = (1.0, 1.0, 0.0);
    for k in (low..high).rev() {
        let (f, b) = (s * e[k], c * e[k]);
        r = libm::hypot(f, g);
        e[k + 1] = r;
        if r == 0.0 {
            d[k + 1] -= p;
            e[high] = 0.0;
            return;
        }
        (s, c) = (f / r, g / r);
        g = d[k + 1] - p;
        r = (d[k] - g) * s + 2.0 * c * b;
        p = s * r;
        d[k + 1] = g + p;
        g = c * r - b;
        for row in rows.iter_mut() {
            let (left, right) = (row[k], row[k + 1]);
            row[k + 1] = s * left + c * right;
            row[k] = c * left - s * right;
        }
    }
    d[low] -= p;
    e[low] = g;
    e[high] = 0.0;
}

fn index_of_largest(values: &[f64]) -> usize {
    let mut top = 0;
    for (index, value) in values.iter().enumerate() {
        if *value > values[top] {
            top = index;
        }
    }
    top
}

fn unit(n: usize, index: usize) -> Vec<f64> {
    let mut vector = vec![0.0; n];
    vector[index] = 1.0;
    vector
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn scaled(vector: &[f64], by: f64) -> Vec<f64> {
    vector.iter().map(|value| value * by).collect()
}

/// Projects some orthonormal vectors out of a vector.
fn remove(vector: &mut [f64], directions: &[Vec<f64>]) {
    for direction in directions {
        let part = dot(vector, direction);
        vector
            .iter_mut()
            .zip(direction)
            .for_each(|(to, from)| *to -= part * from);
    }
}

/// The vector or its negative, so that the first entry with (up to rounding) the largest magnitude is positive.
fn with_fixed_sign(vector: Vec<f64>) -> Vec<f64> {
    let largest = vector.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let leads = vector.iter().find(|value| value.abs() >= largest * (1.0 - 1e-9));
    if leads.is_some_and(|value| *value < 0.0) {
        scaled(&vector, -1.0)
    } else {
        vector
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(matrix: &[&[f64]], expected: &[f64]) {
        let n = matrix.len();
        let multiply = |x: &[f64], y: &mut [f64]| {
            for (row, y) in matrix.iter().zip(y) {
                *y = dot(row, x);
            }
        };
        let mut found: Vec<Vec<f64>> = Vec::new();
        for value in expected {
            let (top, vector) = largest(n, &multiply, &found).unwrap();
            assert!((top - value).abs() < 1e-10, "{top} for {value}");
            let mut image = vec![0.0; n];
            multiply(&vector, &mut image);
            assert!(image.iter().zip(&vector).all(|(y, x)| (y - value * x).abs() < 1e-9));
            found.push(vector);
        }
        assert!(largest(n, &multiply, &found).is_none(), "there are no more than {n}");
    }

    #[test]
    fn eigenvalues_descend_and_repeat() {
        check(&[&[2.0, 0.0], &[0.0, 3.0]], &[3.0, 2.0]);
        check(
            &[&[0.0, 1.0, 1.0], &[1.0, 0.0, 1.0], &[1.0, 1.0, 0.0]],
            &[2.0, -1.0, -1.0],
        );
        check(
            &[&[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0], &[0.0, 0.0, 1.0]],
            &[1.0, 1.0, 1.0],
        );
        check(&[&[0.0, 0.0], &[0.0, 0.0]], &[0.0, 0.0]);
        check(&[&[-4.0]], &[-4.0]);
    }

    #[test]
    fn second_difference_matrix_has_known_eigenvalues() {
        // 2 - 2 cos(k π / (n + 1)): close together at the top, which makes the problem hard.
        let n = 400;
        let multiply = |x: &[f64], y: &mut [f64]| {
            for k in 0..n {
                let before = if k > 0 { x[k - 1] } else { 0.0 };
                y[k] = 2.0 * x[k] - before - x.get(k + 1).unwrap_or(&0.0);
            }
        };
        let (found, _) = largest(n, &multiply, &[]).unwrap();
        let expected = 2.0 + 2.0 * libm::cos(std::f64::consts::PI / (n + 1) as f64);
        assert!((found - expected).abs() < 1e-9, "{found} for {expected}");
    }
}

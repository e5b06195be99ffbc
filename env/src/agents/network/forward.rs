//! Forward pass of `PatchNetwork` from `driftworld.learners`: a layer over patches of 4 × 4 pixels, one over 2 × 2 patches, a
//! hidden layer, and the policy. Sums have a fixed order, so results are the same on every machine.

/// Side of a patch in pixels.
pub(super) const PATCH: usize = 4;

/// A matrix and biases.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    /// Row-major, `(inputs, outputs)`: transposed with respect to the file.
    weights: Vec<f32>,
    biases: Vec<f32>,
}

impl Layer {
    /// A layer from weights `(outputs, inputs)`, row-major, and one bias per output.
    pub(super) fn new(weights: &[f32], biases: Vec<f32>) -> Self {
        let outputs = biases.len();
        let inputs = weights.len() / outputs.max(1);
        let transposed = (0..inputs).flat_map(|input| (0..outputs).map(move |output| weights[output * inputs + input]));
        Self {
            weights: transposed.collect(),
            biases,
        }
    }

    pub(super) fn outputs(&self) -> usize {
        self.biases.len()
    }

    /// Appends the layer's outputs for one input vector.
    fn apply(&self, input: impl Iterator<Item = f32>, outputs: &mut Vec<f32>) {
        let first = outputs.len();
        outputs.extend_from_slice(&self.biases);
        let outputs = &mut outputs[first..];
        for (x, row) in input.zip(self.weights.chunks_exact(self.outputs())) {
            // About half of all activations are 0.
            if x != 0.0 {
                for (y, weight) in outputs.iter_mut().zip(row) {
                    *y += weight * x;
                }
            }
        }
    }
}

/// Rectified linear units: negative values become 0.
fn rectified(values: &[f32]) -> impl Iterator<Item = f32> {
    values.iter().map(|value| value.max(0.0))
}

/// The network without its value head.
#[derive(Clone, Debug)]
pub(super) struct PatchNetwork {
    /// Side of an image in pixels, a multiple of twice [`PATCH`].
    pub(super) side: usize,
    /// Maps a patch's pixels to features.
    pub(super) small: Layer,
    /// Maps the features of 2 × 2 patches, row by row, to features.
    pub(super) large: Layer,
    /// Maps the features of the whole image to hidden units.
    pub(super) image: Layer,
    /// Maps hidden units to actions.
    pub(super) policy: Layer,
}

impl PatchNetwork {
    /// Log-probabilities of the actions for an image `(side, side, 3)`, row 0 on top.
    pub(super) fn log_policy(&self, image: &[u8]) -> Vec<f64> {
        let (patches, line) = (self.side / PATCH, self.side * 3);
        let mut small = Vec::with_capacity(patches * patches * self.small.outputs());
        for (row, column) in (0..patches * patches).map(|patch| (patch / patches, patch % patches)) {
            let lines = image.chunks_exact(line).skip(row * PATCH).take(PATCH);
            let pixels = lines.flat_map(|line| &line[column * PATCH * 3..(column + 1) * PATCH * 3]);
            self.small
                .apply(pixels.map(|byte| f32::from(*byte) * (1.0 / 255.0)), &mut small);
        }
        let (half, pair) = (patches / 2, 2 * self.small.outputs());
        let mut large = Vec::with_capacity(half * half * self.large.outputs());
        for (row, column) in (0..half * half).map(|patch| (patch / half, patch % half)) {
            let pair_of = |row: usize| &small[(row * half + column) * pair..][..pair];
            let joined = rectified(pair_of(2 * row)).chain(rectified(pair_of(2 * row + 1)));
            self.large.apply(joined, &mut large);
        }
        let (mut hidden, mut scores) = (Vec::new(), Vec::new());
        self.image.apply(rectified(&large), &mut hidden);
        self.policy.apply(rectified(&hidden), &mut scores);
        let max = f64::from(scores.iter().copied().fold(f32::NEG_INFINITY, f32::max));
        let sum: f64 = scores.iter().map(|score| libm::exp(f64::from(*score) - max)).sum();
        scores
            .iter()
            .map(|score| f64::from(*score) - max - libm::log(sum))
            .collect()
    }
}

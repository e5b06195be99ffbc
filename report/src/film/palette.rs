//! [`Palette`]: reduces many colours to a few. The box of colours with the largest error is split in two, until there
//! are as many boxes as wanted.
//!
//! Source: Wan, Wong and Prusinkiewicz 1988, variance-based cuts, each at the mean.

/// A few colours, and a mapping from many colours to them.
#[derive(Debug, Default)]
pub(super) struct Palette {
    colors: Vec<[u8; 3]>,
    /// Every colour with its palette index, sorted.
    indices: Vec<([u8; 3], u8)>,
}

/// A range of a list of colours, which one palette colour will represent.
#[derive(Clone, Copy, Debug)]
struct Cell {
    start: usize,
    end: usize,
    /// The channel with the largest variation.
    channel: usize,
    /// The channel's mean, at which the cell is cut.
    mean: f64,
    /// The channel's sum of squared differences from the mean.
    error: f64,
}

/// A colour and its number of pixels.
type Counted = ([u8; 3], u32);

impl Palette {
    /// Chooses at most `limit` colours, 1 to 256, for these pixels: their exact colours if these are few enough.
    pub(super) fn new(pixels: impl Iterator<Item = [u8; 3]>, limit: usize) -> Self {
        let mut sorted: Vec<[u8; 3]> = pixels.collect();
        sorted.sort_unstable();
        let mut counted: Vec<Counted> = Vec::new();
        for color in sorted {
            match counted.last_mut() {
                Some((last, count)) if *last == color => *count += 1,
                _ => counted.push((color, 1)),
            }
        }
        if counted.is_empty() {
            return Self::default();
        }
        let mut cells = vec![Cell::of(&counted, 0, counted.len())];
        while cells.len() < limit {
            let worst = (0..cells.len()).max_by(|a, b| cells[*a].error.total_cmp(&cells[*b].error));
            // There is at least one cell.
            let Some(worst) = worst.filter(|worst| cells[*worst].error > 0.0) else {
                break;
            };
            let Cell {
                start,
                end,
                channel,
                mean,
                ..
            } = cells[worst];
            let colors_in_cell = &mut counted[start..end];
            colors_in_cell.sort_by_key(|(color, _)| (color[channel], *color));
            // The colours differ, so some lie above the mean and some below.
            let middle = start + colors_in_cell.partition_point(|(color, _)| f64::from(color[channel]) <= mean);
            cells[worst] = Cell::of(&counted, start, middle);
            cells.push(Cell::of(&counted, middle, end));
        }
        let colors: Vec<[u8; 3]> = cells.iter().map(|cell| mean(&counted[cell.start..cell.end])).collect();
        let mut indices: Vec<([u8; 3], u8)> = (0..=u8::MAX)
            .zip(&cells)
            .flat_map(|(index, cell)| {
                counted[cell.start..cell.end]
                    .iter()
                    .map(move |(color, _)| (*color, index))
            })
            .collect();
        indices.sort_unstable();
        Self { colors, indices }
    }

    pub(super) fn colors(&self) -> &[[u8; 3]] {
        &self.colors
    }

    /// The palette index of one of the original colours.
    pub(super) fn index_of(&self, color: [u8; 3]) -> u8 {
        let found = self.indices.binary_search_by_key(&color, |(known, _)| *known);
        found.map_or(0, |index| self.indices[index].1)
    }
}

impl Cell {
    fn of(counted: &[Counted], start: usize, end: usize) -> Self {
        let colors_in_cell = &counted[start..end];
        let weight: f64 = colors_in_cell.iter().map(|(_, count)| f64::from(*count)).sum();
        let mut cell = Self {
            start,
            end,
            channel: 0,
            mean: 0.0,
            error: 0.0,
        };
        for channel in 0..3 {
            let moment = |power: i32| -> f64 {
                let value = |(color, count): &Counted| f64::from(*count) * f64::from(color[channel]).powi(power);
                colors_in_cell.iter().map(value).sum()
            };
            let mean = moment(1) / weight;
            // If all values are equal, rounding may still leave a small remainder.
            let is_constant = colors_in_cell
                .iter()
                .all(|(color, _)| color[channel] == colors_in_cell[0].0[channel]);
            let error = if is_constant {
                0.0
            } else {
                moment(2) - mean * mean * weight
            };
            if error > cell.error {
                (cell.channel, cell.mean, cell.error) = (channel, mean, error);
            }
        }
        cell
    }
}

fn mean(colors_in_cell: &[Counted]) -> [u8; 3] {
    let weight: f64 = colors_in_cell.iter().map(|(_, count)| f64::from(*count)).sum();
    [0, 1, 2].map(|channel| {
        let sum: f64 = colors_in_cell
            .iter()
            .map(|(color, count)| f64::from(*count) * f64::from(color[channel]))
            .sum();
        (sum / weight).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// There are no more colours than the limit; they are exact if the limit allows; and in total, colours are closer to
        /// their palette colours than to the overall mean.
        #[test]
        fn few_colors_represent_many(
            pixels in prop::collection::vec(prop::array::uniform3(any::<u8>()), 0..300),
            limit in 1usize..256,
        ) {
            let palette = Palette::new(pixels.iter().copied(), limit);
            let mut distinct = pixels.clone();
            distinct.sort_unstable();
            distinct.dedup();
            prop_assert!(palette.colors().len() <= limit);
            let shown = |color: [u8; 3]| palette.colors()[usize::from(palette.index_of(color))];
            if distinct.len() <= limit {
                for color in distinct {
                    prop_assert_eq!(shown(color), color);
                }
            } else {
                let one_color = Palette::new(pixels.iter().copied(), 1);
                let squared_distance = |a: [u8; 3], b: [u8; 3]| (0..3).map(|k| f64::from(a[k].abs_diff(b[k])).powi(2)).sum::<f64>();
                let error: f64 = pixels.iter().map(|color| squared_distance(*color, shown(*color))).sum();
                let error_of_one: f64 = pixels.iter().map(|color| squared_distance(*color, one_color.colors()[0])).sum();
                // Rounding means to whole numbers costs at most a quarter in each channel.
                prop_assert!(error <= error_of_one + 0.75 * pixels.len() as f64, "{} > {}", error, error_of_one);
            }
        }
    }
}

//! The patterns of the natural style on the graphics card: one buffer with room for all, filled as they are needed. What they
//! are is in `surfaces.rs`.

use driftworld_spec::Surface;

use super::super::surfaces::{self, SIDE};
use super::device::Device;

/// Words of a tile, and how many tiles there are: one for each surface that is not plain, and clouds.
const LENGTH: u32 = (2 * SIDE * SIDE) as u32;
const SURFACES: [Surface; 6] = [
    Surface::Noise,
    Surface::Brick,
    Surface::Plank,
    Surface::Tile,
    Surface::Stripes,
    Surface::Checker,
];
pub(super) const CLOUDS: u32 = SURFACES.len() as u32;

/// The number of a surface's tile; none of a plain one.
pub(super) fn number(surface: Surface) -> Option<u32> {
    let place = SURFACES.iter().position(|other| *other == surface)?;
    Some(place as u32)
}

/// Where a tile begins, in words.
pub(super) fn start(number: u32) -> u32 {
    number * LENGTH
}

/// The buffer, and which tiles are in it: a bit for each.
#[derive(Debug, Default)]
pub(super) struct Texels {
    buffer: Option<wgpu::Buffer>,
    present: u32,
}

impl Texels {
    /// The buffer, with at least the tiles of these bits in it.
    pub(super) fn upload(&mut self, device: &Device, needed: u32) -> &wgpu::Buffer {
        let buffer = self.buffer.get_or_insert_with(|| {
            let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST;
            device.buffer("texels", u64::from(start(CLOUDS + 1)) * 4, usage)
        });
        for number in (0..=CLOUDS).filter(|number| needed & !self.present & 1 << number != 0) {
            let tile = SURFACES
                .get(number as usize)
                .map_or_else(|| Some(surfaces::clouds()), |surface| surfaces::tile(*surface));
            if let Some(tile) = tile {
                let offset = u64::from(start(number)) * 4;
                device
                    .queue
                    .write_buffer(buffer, offset, bytemuck::cast_slice(&tile.texels));
            }
        }
        self.present |= needed;
        buffer
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pattern_has_a_place_of_its_own() {
        for (k, surface) in (0..).zip(SURFACES) {
            let tile = surfaces::tile(surface).expect("it is not plain");
            assert_eq!((number(surface), tile.texels.len()), (Some(k), LENGTH as usize));
        }
        assert_eq!(number(Surface::Plain), None);
        assert_eq!(surfaces::clouds().texels.len(), LENGTH as usize);
    }
}

//! Samples: several for each pixel, whose mean light the pixel shows.
//!
//! The samples of a band are drawn like the pixels of a larger band, and then averaged. So every
//! edge is smooth: of walls and things, of tiles, masks and shapes.
//!
//! Nine samples have 0.28 to 0.41 times the error of one, on the twelve levels at 80×48 pixels.
//! Rejected: blending walls by the share of a pixel that they cover, and textures averaged over many
//! sizes of boxes. This took half the time, but 1,100 lines, and left 0.34 to 0.70 of the error,
//! because the edges of everything else stayed hard. Rejected: four samples, 0.43 to 0.59 of the
//! error; none of them is in the middle of the pixel. Rejected: sixteen, 0.22 to 0.32, for twice the
//! time.

use std::num::NonZeroU32;

use crate::color::Rgb;
use crate::color::srgb::{from_linear_16, linear_16};
use crate::raster::Band;

/// The most rows of pixels whose samples are in memory at once, for each thread.
pub(crate) const MAX_SAMPLED_ROWS: NonZeroU32 = NonZeroU32::new(64).unwrap();

/// The samples of a band, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampleMemory(Vec<Rgb>);

impl SampleMemory {
    /// Draws `samples` along both sides of each of `pixels` by `draw`, and writes their mean light.
    pub(crate) fn draw<T>(
        &mut self,
        samples: u32,
        pixels: &mut Band<'_>,
        draw: impl FnOnce(Band<'_>) -> T,
    ) -> T {
        let side = samples as usize;
        let (rows, width) = (pixels.rows(), pixels.width() * side);
        self.0.resize(rows.len() * side * width, Rgb::BLACK);
        let drawn = draw(Band::new(width, rows.start * samples, &mut self.0));
        for (row, lines) in rows.zip(self.0.chunks_exact(side * width)) {
            for (x, pixel) in pixels.row_mut(row).iter_mut().enumerate() {
                let lines = lines.chunks_exact(width);
                *pixel = mean(lines.flat_map(|line| &line[x * side..][..side]), samples * samples);
            }
        }
        drawn
    }
}

/// The mean light of `count` colours.
#[inline]
fn mean<'a>(colors: impl Iterator<Item = &'a Rgb>, count: u32) -> Rgb {
    let mut light = [0; 3];
    for color in colors {
        for (sum, channel) in light.iter_mut().zip(linear_16(*color)) {
            *sum += u32::from(channel);
        }
    }
    from_linear_16(light.map(|sum| ((sum + count / 2) / count) as u16))
}

/// Reduces `values`, one for each column of samples, to the value in the middle of each pixel.
pub(crate) fn keep_middles(values: &mut Vec<f64>, samples: u32) {
    let samples = samples as usize;
    let count = values.len() / samples;
    for pixel in 0..count {
        values[pixel] = values[pixel * samples + samples / 2];
    }
    values.truncate(count);
}

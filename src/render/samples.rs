//! Samples: several for each pixel, whose mean light the pixel shows.
//!
//! The samples of a band are drawn like the pixels of a larger band, and then averaged. So every
//! edge is smooth: of walls and things, of tiles, masks and shapes.
//!
//! Nine samples have 0.28 to 0.41 times the error of one, on the twelve levels at 80×48 pixels.
//! Rejected: blending walls by the share of a pixel that they cover, and textures averaged over many
//! sizes of boxes. This took an eighth of the instructions, but 900 lines, and left 0.34 to 0.70 of
//! the error, because the edges of everything else stayed hard. Rejected: four samples, 0.43 to 0.59 of the
//! error; none of them is in the middle of the pixel. Rejected: sixteen, 0.22 to 0.32, for twice the
//! time.

use std::num::NonZeroU32;

use crate::color::Rgb;
use crate::color::srgb::{from_linear_16, linear_16};
use crate::raster::Band;
use crate::visibility::Filter;

/// The number of samples along both sides of a pixel.
const SIDE: usize = Filter::AREA_SAMPLES.get() as usize;

/// The most rows of pixels whose samples are in memory at once, for each thread.
pub(crate) const MAX_SAMPLED_ROWS: NonZeroU32 = NonZeroU32::new(64).unwrap();

/// The samples of a band, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct SampleMemory(Vec<Rgb>);

impl SampleMemory {
    /// Draws [`SIDE`] samples along both sides of each of `pixels` by `draw`, and writes their mean
    /// light.
    pub(crate) fn draw<T>(&mut self, pixels: &mut Band<'_>, draw: impl FnOnce(Band<'_>) -> T) -> T {
        let (rows, width) = (pixels.rows(), pixels.width() * SIDE);
        let count = rows.len() * SIDE * width;
        if self.0.len() < count {
            self.0.resize(count, Rgb::BLACK);
        }
        let samples = &mut self.0[..count];
        let drawn = draw(Band::new(width, rows.start * SIDE as u32, samples));
        for (row, samples) in rows.zip(samples.chunks_exact(SIDE * width)) {
            let [first, second, third] =
                [0, 1, 2].map(|line| samples[line * width..][..width].as_chunks().0);
            let lines = first.iter().zip(second).zip(third);
            for (pixel, ((first, second), third)) in pixels.row_mut(row).iter_mut().zip(lines) {
                *pixel = mean([first, second, third]);
            }
        }
        drawn
    }
}

/// The mean light of the samples of a pixel.
#[inline(always)]
fn mean(lines: [&[Rgb; SIDE]; SIDE]) -> Rgb {
    const COUNT: u32 = (SIDE * SIDE) as u32;
    let any = lines[0][0];
    // Often, because the texels of a near wall are larger than a pixel.
    if lines == [&[any; SIDE]; SIDE] {
        return any;
    }
    let [mut red, mut green, mut blue] = [COUNT / 2; 3];
    for line in lines {
        for color in line {
            let light = linear_16(*color).map(u32::from);
            red += light[0];
            green += light[1];
            blue += light[2];
        }
    }
    from_linear_16([red, green, blue].map(|sum| (sum / COUNT) as u16))
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

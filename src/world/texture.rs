//! Textures: pictures on surfaces.
//!
//! Texels are stored column by column, from top to bottom, because walls are drawn column by column
//! and then read contiguous memory. A texture has mip levels (Williams, "Pyramidal Parametrics",
//! 1983), each half the size of the one before: distant surfaces use a level whose texels are about
//! as large as pixels.

pub mod builtin;
mod mip_level;

use std::num::NonZeroU32;

use crate::color::Rgb;
pub use mip_level::MipLevel;
pub(crate) use mip_level::MipLevelByShifts;

/// A picture, at least one texel wide and high.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// From the picture itself down to one texel.
    levels: Vec<MipLevel>,
    /// The number of texels.
    area: f64,
    mean: Rgb,
}

// The number of texels is no NaN.
impl Eq for Texture {}

impl Texture {
    /// An opaque texture with the texel `texel(x, y)` at `(x, y)`, `x` from the left and `y` from
    /// the top.
    pub fn from_fn(
        width: NonZeroU32,
        height: NonZeroU32,
        mut texel: impl FnMut(u32, u32) -> Rgb,
    ) -> Self {
        Self::from_fn_with_alpha(width, height, |x, y| (texel(x, y), u8::MAX))
    }

    /// A texture as [`Texture::from_fn`], in which each texel has an alpha: 0 is transparent, 255
    /// opaque.
    pub fn from_fn_with_alpha(
        width: NonZeroU32,
        height: NonZeroU32,
        mut texel: impl FnMut(u32, u32) -> (Rgb, u8),
    ) -> Self {
        let (texels, mut alpha): (Vec<Rgb>, Vec<u8>) = (0..width.get())
            .flat_map(|x| (0..height.get()).map(move |y| (x, y)))
            .map(|(x, y)| texel(x, y))
            .unzip();
        if alpha.iter().all(|&alpha| alpha == u8::MAX) {
            alpha = Vec::new();
        }
        let mean = mean(&texels);
        let area = f64::from(width.get()) * f64::from(height.get());
        Self { levels: mip_level::pyramid(width, height, texels, alpha), area, mean }
    }

    /// The width in texels.
    pub fn width(&self) -> u32 {
        self.levels[0].width()
    }

    /// The height in texels.
    pub fn height(&self) -> u32 {
        self.levels[0].height()
    }

    /// The column at `u`, from 0 at the left edge to 1 at the right one, from top to bottom. A `u`
    /// outside that range, or NaN, selects the nearest column.
    pub fn column(&self, u: f64) -> &[Rgb] {
        self.levels[0].column(u)
    }

    /// Whether any texel is not opaque.
    pub fn has_alpha(&self) -> bool {
        self.levels[0].has_alpha()
    }

    /// The colour of the texel at `(x, y)`, and its alpha: 0 is transparent, 255 opaque.
    ///
    /// # Panics
    /// If the texture has no such texel.
    pub fn texel(&self, x: u32, y: u32) -> (Rgb, u8) {
        assert!(x < self.width() && y < self.height(), "no texel at ({x}, {y})");
        self.levels[0].texel(x, y)
    }

    /// The part from `(left, top)` on, as a texture.
    ///
    /// # Panics
    /// If the part reaches beyond an edge.
    #[must_use]
    pub fn part(&self, left: u32, top: u32, width: NonZeroU32, height: NonZeroU32) -> Self {
        Self::from_fn_with_alpha(width, height, |x, y| self.texel(left + x, top + y))
    }

    /// The number of texels.
    pub(crate) fn area(&self) -> f64 {
        self.area
    }

    /// The mip level after `lod` halvings, at most the one with a single texel.
    pub fn level(&self, lod: usize) -> &MipLevel {
        &self.levels[lod.min(self.levels.len() - 1)]
    }

    /// All mip levels, from the texture itself to a single texel.
    pub fn levels(&self) -> &[MipLevel] {
        &self.levels
    }

    /// The mean colour of all texels, which represents the texture on the minimap.
    pub fn mean(&self) -> Rgb {
        self.mean
    }
}

fn mean(texels: &[Rgb]) -> Rgb {
    let mut sums = [0u64; 3];
    for texel in texels {
        for (sum, channel) in sums.iter_mut().zip(texel.channels()) {
            *sum += u64::from(channel);
        }
    }
    let count = texels.len() as u64;
    let [red, green, blue] = sums.map(|sum| ((sum + count / 2) / count) as u8);
    Rgb::new(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(side: u32) -> NonZeroU32 {
        NonZeroU32::new(side).unwrap()
    }

    #[test]
    fn columns_are_read_top_to_bottom() {
        let texture = Texture::from_fn(size(4), size(2), |x, y| Rgb::new(x as u8, y as u8, 0));
        assert_eq!(texture.column(0.0), [Rgb::new(0, 0, 0), Rgb::new(0, 1, 0)]);
        assert_eq!(texture.column(0.25), [Rgb::new(1, 0, 0), Rgb::new(1, 1, 0)]);
        for far in [0.999, 1.0, 2.0, f64::INFINITY] {
            assert_eq!(texture.column(far)[0].red(), 3, "{far}");
        }
        for near in [-0.0, -1.0, f64::NEG_INFINITY, f64::NAN] {
            assert_eq!(texture.column(near)[0].red(), 0, "{near}");
        }
    }

    #[test]
    fn mean_and_alpha() {
        let texture = Texture::from_fn_with_alpha(size(2), size(1), |x, _| {
            (Rgb::new(100 * x as u8, 0, 255), if x == 0 { 0 } else { 255 })
        });
        assert_eq!(texture.mean(), Rgb::new(50, 0, 255));
        assert_eq!((texture.texel(0, 0).1, texture.texel(1, 0).1), (0, 255));
        let opaque = Texture::from_fn(size(1), size(1), |_, _| Rgb::BLACK);
        assert_eq!(opaque.texel(0, 0).1, 255);
    }
}

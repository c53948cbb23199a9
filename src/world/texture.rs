//! Textures: pictures on surfaces.
//!
//! Texels are stored column by column, from top to bottom, because walls are drawn column by column
//! and then read contiguous memory. A texture has mip levels (Williams, "Pyramidal Parametrics",
//! 1983), each half the size of the level before: distant surfaces use a level whose texels are
//! about as large as pixels.
//!
//! A built-in texture is decoded when a texel is first read, and the mip levels are made when one
//! of them is first read. So a level starts without the textures that it does not show, and rays
//! without any. Rejected: making all of them with the world. That took nine tenths of the
//! instructions of a first frame.

pub mod builtin;
mod mip_level;

use std::fmt;
use std::num::NonZeroU32;
use std::sync::{Arc, OnceLock};

pub use mip_level::MipLevel;
pub(crate) use mip_level::MipLevelByShifts;

use crate::color::Rgb;

/// A picture, at least one texel wide and high.
#[derive(Clone)]
pub struct Texture {
    width: NonZeroU32,
    height: NonZeroU32,
    /// The number of texels.
    area: f64,
    has_alpha: bool,
    source: PictureSource,
    /// The mip levels after the picture itself, down to one texel.
    smaller: OnceLock<Vec<MipLevel>>,
}

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
        texel: impl FnMut(u32, u32) -> (Rgb, u8),
    ) -> Self {
        let picture = TexturePicture::from_fn(width, height, texel);
        let has_alpha = picture.level.has_alpha();
        Self::new(width, height, has_alpha, PictureSource::Made(picture))
    }

    /// A texture as [`Texture::from_fn_with_alpha`]. Its function of texels is requested when a
    /// texel is first read. `has_alpha` says whether any texel is not opaque.
    pub(crate) fn on_demand<T: FnMut(u32, u32) -> (Rgb, u8)>(
        width: NonZeroU32,
        height: NonZeroU32,
        has_alpha: bool,
        texels: impl Fn() -> T + Send + Sync + 'static,
    ) -> Self {
        let source =
            PictureSource::on_demand(move || TexturePicture::from_fn(width, height, texels()));
        Self::new(width, height, has_alpha, source)
    }

    fn new(width: NonZeroU32, height: NonZeroU32, has_alpha: bool, source: PictureSource) -> Self {
        let area = f64::from(width.get()) * f64::from(height.get());
        Self { width, height, area, has_alpha, source, smaller: OnceLock::new() }
    }

    /// The width in texels.
    pub fn width(&self) -> u32 {
        self.width.get()
    }

    /// The height in texels.
    pub fn height(&self) -> u32 {
        self.height.get()
    }

    /// The column at `u`, from 0 at the left edge to 1 at the right one, from top to bottom. A `u`
    /// outside that range, or NaN, selects the nearest column.
    pub fn column(&self, u: f64) -> &[Rgb] {
        self.level(0).column(u)
    }

    /// Returns whether any texel is not opaque.
    pub fn has_alpha(&self) -> bool {
        self.has_alpha
    }

    /// The colour of the texel at `(x, y)`, and its alpha: 0 is transparent, 255 opaque.
    ///
    /// # Panics
    /// If the texture has no such texel.
    pub fn texel(&self, x: u32, y: u32) -> (Rgb, u8) {
        assert!(x < self.width() && y < self.height(), "no texel at ({x}, {y})");
        self.level(0).texel(x, y)
    }

    /// The part with its top left corner at `(left, top)`, as a texture.
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

    /// The mip level after `lod` halvings, at most the level with a single texel.
    #[inline]
    pub fn level(&self, lod: usize) -> &MipLevel {
        let picture = &self.source.picture().level;
        if lod == 0 {
            return picture;
        }
        let smaller = self.smaller.get_or_init(|| mip_level::smaller(picture));
        smaller.get(lod - 1).or(smaller.last()).unwrap_or(picture)
    }

    /// The height of the mip level `lod` in texels, computed without making the level.
    pub(crate) fn height_of_level(&self, lod: usize) -> u32 {
        self.height.get().checked_shr(lod as u32).unwrap_or(0).max(1)
    }

    /// The number of mip levels that have been made, counting the picture itself.
    pub fn levels_made(&self) -> usize {
        usize::from(self.source.is_made()) + self.smaller.get().map_or(0, Vec::len)
    }

    /// The mean colour of all texels, which represents the texture on the minimap.
    pub fn mean(&self) -> Rgb {
        self.source.picture().mean
    }
}

/// Textures are equal if all of their texels are equal.
impl PartialEq for Texture {
    fn eq(&self, other: &Self) -> bool {
        self.source.is_same(&other.source) || self.level(0) == other.level(0)
    }
}

impl Eq for Texture {}

impl fmt::Debug for Texture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { width, height, .. } = self;
        f.debug_struct("Texture")
            .field("width", width)
            .field("height", height)
            .finish_non_exhaustive()
    }
}

/// The picture itself, and its mean colour.
#[derive(Clone)]
struct TexturePicture {
    level: MipLevel,
    mean: Rgb,
}

/// The source of a texture's picture.
#[derive(Clone)]
enum PictureSource {
    Made(TexturePicture),
    OnDemand { paint: Arc<PictureFunction>, made: OnceLock<TexturePicture> },
}

/// The function that makes a picture. It returns the same picture at every call.
type PictureFunction = dyn Fn() -> TexturePicture + Send + Sync;

impl TexturePicture {
    /// The picture with the texel `texel(x, y)`, a colour and an alpha, at `(x, y)`.
    fn from_fn(
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
        Self { level: MipLevel::new(width, height, texels, alpha), mean }
    }
}

impl PictureSource {
    /// The picture that `paint` makes when it is first read.
    fn on_demand(paint: impl Fn() -> TexturePicture + Send + Sync + 'static) -> Self {
        Self::OnDemand { paint: Arc::new(paint), made: OnceLock::new() }
    }

    #[inline]
    fn picture(&self) -> &TexturePicture {
        match self {
            Self::Made(picture) => picture,
            Self::OnDemand { paint, made } => made.get_or_init(&**paint),
        }
    }

    fn is_made(&self) -> bool {
        match self {
            Self::Made(_) => true,
            Self::OnDemand { made, .. } => made.get().is_some(),
        }
    }

    /// Returns whether the same function paints both.
    fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::OnDemand { paint: one, .. }, Self::OnDemand { paint: other, .. }) => {
                Arc::ptr_eq(one, other)
            }
            _ => false,
        }
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
    fn a_texture_reports_its_mean_and_alpha() {
        let texture = Texture::from_fn_with_alpha(size(2), size(1), |x, _| {
            (Rgb::new(100 * x as u8, 0, 255), if x == 0 { 0 } else { 255 })
        });
        assert_eq!(texture.mean(), Rgb::new(50, 0, 255));
        assert_eq!((texture.texel(0, 0).1, texture.texel(1, 0).1), (0, 255));
        let opaque = Texture::from_fn(size(1), size(1), |_, _| Rgb::BLACK);
        assert_eq!(opaque.texel(0, 0).1, 255);
    }

    #[test]
    fn only_levels_that_are_read_are_made() {
        let texture = Texture::on_demand(size(8), size(4), false, || {
            |x, y| (Rgb::new(x as u8, y as u8, 0), 255)
        });
        assert_eq!((texture.width(), texture.height_of_level(1), texture.levels_made()), (8, 2, 0));
        assert_eq!((texture.level(0).height(), texture.levels_made()), (4, 1));
        assert_eq!((texture.level(9).width(), texture.levels_made()), (1, 4));
        let heights =
            (0..70).map(|lod| texture.level(lod).height() == texture.height_of_level(lod));
        assert!(heights.into_iter().all(|is_equal| is_equal));
        let eager = Texture::from_fn(size(8), size(4), |x, y| Rgb::new(x as u8, y as u8, 0));
        assert_eq!(texture, eager);
    }
}

//! The built-in art: PNG sheets of `maps/art`, which are compiled in.
//!
//! A sheet has its frames from left to right and its facings from top to bottom, as the sheets of
//! maps do. It is decoded when one of its texels is first read, because most levels show only a few
//! sheets.

use std::io::Cursor;
use std::num::NonZeroU32;
use std::sync::{Arc, OnceLock};

use png::{ColorType, Decoder, DecodingError};

use super::Texture;
use crate::color::Rgb;

/// The art with this name.
macro_rules! art {
    ($name:literal) => {{
        let file = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/maps/art/", $name, ".png"));
        crate::world::art::Art { name: $name, file }
    }};
}
pub(crate) use art;

/// A compiled-in PNG file of 8-bit indices or 8-bit RGB.
#[derive(Clone, Copy)]
pub(crate) struct Art {
    pub(crate) name: &'static str,
    pub(crate) file: &'static [u8],
}

impl Art {
    /// The whole sheet as one texture. `has_alpha` says whether any texel is not opaque.
    pub(crate) fn texture(self, has_alpha: bool) -> Texture {
        let [width, height] = self.size();
        Texture::on_demand(width, height, has_alpha, move || {
            let sheet = self.decoded(|color| color);
            move |x, y| sheet.texel(x, y)
        })
    }

    /// The pictures of a sheet with a palette, frame by frame and within each frame facing by
    /// facing. All of them have holes. `recolored` returns the replacement for each colour.
    pub(crate) fn pictures(
        self,
        frames: u32,
        facings: u32,
        recolored: impl Fn(Rgb) -> Rgb + Copy + Send + Sync + 'static,
    ) -> Vec<Texture> {
        let [width, height] = self.size();
        let part = |side: NonZeroU32, count| NonZeroU32::new(side.get() / count).unwrap_or(side);
        let (width, height) = (part(width, frames), part(height, facings));
        let decoded = Arc::new(OnceLock::new());
        let picture = |frame, facing| {
            let decoded = Arc::clone(&decoded);
            let (left, top) = (frame * width.get(), facing * height.get());
            Texture::on_demand(width, height, true, move || {
                let decoded = Arc::clone(&decoded);
                move |x, y| decoded.get_or_init(|| self.decoded(recolored)).texel(left + x, top + y)
            })
        };
        (0..frames)
            .flat_map(|frame| (0..facings).map(move |facing| (frame, facing)))
            .map(|(frame, facing)| picture(frame, facing))
            .collect()
    }

    /// The width and height in texels, which are at a fixed place in every PNG file.
    fn size(self) -> [NonZeroU32; 2] {
        [16, 20].map(|start| {
            let bytes = self.file[start..start + 4].try_into().unwrap_or_default();
            NonZeroU32::new(u32::from_be_bytes(bytes)).unwrap_or(NonZeroU32::MIN)
        })
    }

    fn decoded(self, recolored: impl Fn(Rgb) -> Rgb) -> Sheet {
        let mut sheet = Sheet::decode(self.file).expect("a test decodes all files of the art");
        for (color, _) in sheet.palette.iter_mut().flatten() {
            *color = recolored(*color);
        }
        sheet
    }
}

/// A decoded PNG file.
struct Sheet {
    width: usize,
    samples: Vec<u8>,
    /// The colours and alphas of indices; `None` if each texel has samples of red, green and blue.
    palette: Option<Vec<(Rgb, u8)>>,
}

impl Sheet {
    fn decode(file: &[u8]) -> Result<Self, DecodingError> {
        let mut reader = Decoder::new(Cursor::new(file)).read_info()?;
        let mut samples = vec![0; reader.output_buffer_size().unwrap_or_default()];
        reader.next_frame(&mut samples)?;
        let info = reader.info();
        let palette = (info.color_type == ColorType::Indexed).then(|| {
            let colors = info.palette.as_deref().unwrap_or_default().as_chunks().0.iter();
            let alphas = info.trns.as_deref().unwrap_or_default().iter().copied();
            let alphas = alphas.chain(std::iter::repeat(u8::MAX));
            let colors = colors.map(|&[red, green, blue]| Rgb::new(red, green, blue));
            colors.zip(alphas).collect()
        });
        Ok(Self { width: info.width as usize, samples, palette })
    }

    /// The colour and alpha of a texel inside the sheet.
    fn texel(&self, x: u32, y: u32) -> (Rgb, u8) {
        let index = y as usize * self.width + x as usize;
        if let Some(palette) = &self.palette {
            return palette[usize::from(self.samples[index])];
        }
        let [red, green, blue] = [0, 1, 2].map(|channel| self.samples[3 * index + channel]);
        (Rgb::new(red, green, blue), u8::MAX)
    }
}

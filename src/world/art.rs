//! The built-in art: PNG sheets of `maps/art`, which are compiled in.
//!
//! A sheet has its frames from left to right and its facings from top to bottom, as the sheets of
//! maps do. It is decoded when one of its texels is first read, because most levels show only a few
//! sheets.
//!
//! A program can [replace](replace) sheets by others, once and for the whole process. Rejected: a field of each world.
//! Rules place sprites deep inside a game, and every function on the way would pass it on.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::iter;
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

/// The sheets that replace built-in ones, by name.
static REPLACEMENTS: OnceLock<BTreeMap<&'static str, Sheet>> = OnceLock::new();

/// Shows each of `sheets` in place of the built-in art with its name, in all worlds of this process that are read from
/// now on. Returns false, and replaces nothing, if art was replaced before.
pub(crate) fn replace(sheets: BTreeMap<&'static str, Sheet>) -> bool {
    REPLACEMENTS.set(sheets).is_ok()
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

    /// The sheet that replaces it.
    fn replacement(self) -> Option<&'static Sheet> {
        REPLACEMENTS.get()?.get(self.name)
    }

    /// The width and height of the sheet, in texels.
    fn size(self) -> [NonZeroU32; 2] {
        self.replacement().map_or_else(|| self.built_in_size(), |sheet| sheet.size)
    }

    /// The width and height of the built-in sheet in texels, which are at a fixed place in every PNG file.
    pub(crate) fn built_in_size(self) -> [NonZeroU32; 2] {
        [16, 20].map(|start| {
            let bytes = self.file[start..start + 4].try_into().unwrap_or_default();
            NonZeroU32::new(u32::from_be_bytes(bytes)).unwrap_or(NonZeroU32::MIN)
        })
    }

    fn decoded(self, recolored: impl Fn(Rgb) -> Rgb) -> Sheet {
        let mut sheet = match self.replacement() {
            Some(sheet) => sheet.clone(),
            None => self.decode().expect("a test decodes all files of the art"),
        };
        for (color, _) in &mut sheet.colors {
            *color = recolored(*color);
        }
        sheet
    }

    /// The built-in sheet.
    fn decode(self) -> Result<Sheet, DecodingError> {
        let mut reader = Decoder::new(Cursor::new(self.file)).read_info()?;
        let mut samples = vec![0; reader.output_buffer_size().unwrap_or_default()];
        reader.next_frame(&mut samples)?;
        let info = reader.info();
        let color = |&[red, green, blue]: &[u8; 3]| Rgb::new(red, green, blue);
        if info.color_type != ColorType::Indexed {
            let colors = samples.as_chunks().0.iter().map(|channels| (color(channels), u8::MAX));
            return Ok(Sheet::new(self.built_in_size(), colors.collect()));
        }
        let colors = info.palette.as_deref().unwrap_or_default().as_chunks().0.iter().map(color);
        let alphas = info.trns.as_deref().unwrap_or_default().iter().copied();
        let colors = colors.zip(alphas.chain(iter::repeat(u8::MAX))).collect();
        Ok(Sheet { size: self.built_in_size(), colors, indices: samples })
    }
}

/// A decoded sheet.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    size: [NonZeroU32; 2],
    /// Colours and alphas.
    colors: Vec<(Rgb, u8)>,
    /// The index of each texel's colour; empty if there is one colour for each texel.
    indices: Vec<u8>,
}

impl Sheet {
    /// A sheet of this width and height with these colours and alphas, row by row from the top.
    pub(crate) fn new(size: [NonZeroU32; 2], colors: Vec<(Rgb, u8)>) -> Self {
        Self { size, colors, indices: Vec::new() }
    }

    /// The colour and alpha of a texel inside the sheet.
    fn texel(&self, x: u32, y: u32) -> (Rgb, u8) {
        let index = y as usize * self.size[0].get() as usize + x as usize;
        let index = if self.indices.is_empty() { index } else { usize::from(self.indices[index]) };
        self.colors[index]
    }
}

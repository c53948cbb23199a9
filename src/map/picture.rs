//! PNG files as textures.
//!
//! A file of 200 bytes can have a million texels, so the texels of all files of a map are limited
//! together: see [`PictureBudget`].

use std::fmt;
use std::io::Cursor;
use std::num::NonZeroU32;

use png::{ColorType, Decoder, DecodingError, Info, Limits, Transformations};

use super::files::TextureFileError;
use crate::color::Rgb;
use crate::world::Texture;

/// The largest number of texels in a row or a column of a texture.
const MAX_SIDE: u32 = 1024;
/// Enough for two pictures of the largest size in 16-bit RGBA.
const DECODER_LIMITS: Limits = Limits { bytes: 2 * 8 * (MAX_SIDE * MAX_SIDE) as usize };

/// The largest number of texels of all pictures of a map: 16 of the largest size.
const MAX_TEXELS: u32 = 16 * MAX_SIDE * MAX_SIDE;
/// The largest number of bytes of all PNG files of a map.
const MAX_BYTES: usize = 64 << 20;

/// The texels that a map may still decode, and the bytes of files that it may still read.
///
/// A picture that is decoded takes its texels from the budget before memory is allocated for them.
pub(crate) struct PictureBudget {
    texels: u32,
    bytes: usize,
}

impl Default for PictureBudget {
    /// The budget of a whole map.
    fn default() -> Self {
        Self { texels: MAX_TEXELS, bytes: MAX_BYTES }
    }
}

impl PictureBudget {
    fn take(&mut self, texels: u32, bytes: usize) -> Result<(), PictureError> {
        let left = self.texels.checked_sub(texels).zip(self.bytes.checked_sub(bytes));
        let (texels, bytes) = left.ok_or(PictureError::OneTooMany)?;
        *self = Self { texels, bytes };
        Ok(())
    }
}

/// The reason why a file yields no picture.
#[derive(Debug)]
pub(crate) enum PictureError {
    Unreadable(TextureFileError),
    Broken(DecodingError),
    /// The palette ends within a colour.
    BrokenPalette,
    TooLarge {
        width: u32,
        height: u32,
    },
    /// The picture exceeds the [`PictureBudget`] of the map.
    OneTooMany,
}

impl fmt::Display for PictureError {
    /// Writes the reason, to follow the name of the file.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(error) => write!(f, "{error}"),
            Self::Broken(error) => {
                let error = error.to_string();
                write!(f, "is not a complete PNG image: {}", error.trim_end_matches('.'))
            }
            Self::BrokenPalette => {
                f.write_str("is not a complete PNG image: its palette is broken")
            }
            Self::TooLarge { width, height } => {
                write!(
                    f,
                    "is {width}×{height} texels, but at most {MAX_SIDE}×{MAX_SIDE} is allowed"
                )
            }
            Self::OneTooMany => {
                let megabytes = MAX_BYTES >> 20;
                write!(
                    f,
                    "is too much: the pictures of a map may have at most {MAX_TEXELS} texels and "
                )?;
                write!(f, "{megabytes} MiB")
            }
        }
    }
}

impl PictureError {
    /// The help text for the user. The map uses the picture as a `use_of_file`.
    pub(crate) fn help(&self, use_of_file: &str) -> String {
        let size = "64×64 texels are plenty in a terminal";
        match self {
            Self::Unreadable(_) => format!("a {use_of_file} is a PNG file beside the map"),
            Self::Broken(_) | Self::BrokenPalette => "save the picture again, as PNG".to_owned(),
            Self::TooLarge { .. } => format!("scale it down: {size}"),
            Self::OneTooMany => format!("scale them down: {size}"),
        }
    }
}

impl From<DecodingError> for PictureError {
    fn from(error: DecodingError) -> Self {
        Self::Broken(error)
    }
}

/// A decoded picture, which has no mip levels.
pub(crate) struct Picture {
    width: NonZeroU32,
    height: NonZeroU32,
    color_type: ColorType,
    samples: Vec<u8>,
    /// The number of samples in a row.
    row_size: usize,
}

impl Picture {
    pub(crate) fn width(&self) -> u32 {
        self.width.get()
    }

    pub(crate) fn height(&self) -> u32 {
        self.height.get()
    }

    /// The whole picture as a texture.
    pub(crate) fn texture(&self) -> Texture {
        self.part(0, 0, self.width, self.height)
    }

    /// The width and height in texels.
    pub(crate) fn size(&self) -> [NonZeroU32; 2] {
        [self.width, self.height]
    }

    /// The colour and alpha of each texel, row by row from the top.
    pub(crate) fn texels(&self) -> impl Iterator<Item = (Rgb, u8)> {
        let rows = self.samples.chunks_exact(self.row_size);
        let count = self.color_type.samples();
        rows.flat_map(move |row| row.chunks_exact(count).map(|it| texel(self.color_type, it)))
    }

    /// The part with its top left corner at `(left, top)`, as a texture. It must be inside the
    /// picture.
    pub(crate) fn part(
        &self,
        left: u32,
        top: u32,
        width: NonZeroU32,
        height: NonZeroU32,
    ) -> Texture {
        let count = self.color_type.samples();
        Texture::from_fn_with_alpha(width, height, |x, y| {
            let start = (top + y) as usize * self.row_size + (left + x) as usize * count;
            texel(self.color_type, &self.samples[start..start + count])
        })
    }
}

/// Decodes a PNG file of any colour type and depth. Of an animation, decodes the first picture. The
/// size is checked, and taken from `budget`, before memory is allocated.
pub(crate) fn decode(bytes: &[u8], budget: &mut PictureBudget) -> Result<Picture, PictureError> {
    budget.take(0, bytes.len())?;
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), DECODER_LIMITS);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    decoder.set_transformations(Transformations::EXPAND | Transformations::STRIP_16);
    let (width, height) = decoder.read_header_info()?.size();
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(PictureError::TooLarge { width, height });
    }
    budget.take(width * height, 0)?;
    let mut reader = decoder.read_info()?;
    if !has_whole_palette(reader.info()) {
        return Err(PictureError::BrokenPalette);
    }
    let mut samples = vec![0; reader.output_buffer_size().ok_or(DecodingError::LimitsExceeded)?];
    let picture = reader.next_frame(&mut samples)?;
    let sizes = (NonZeroU32::new(picture.width), NonZeroU32::new(picture.height));
    let (Some(width), Some(height)) = sizes else {
        return Err(DecodingError::LimitsExceeded.into());
    };
    let (color_type, row_size) = (picture.color_type, picture.line_size);
    Ok(Picture { width, height, color_type, samples, row_size })
}

/// Returns whether the palette ends with a whole colour. If it does not, the decoder would panic.
fn has_whole_palette(info: &Info<'_>) -> bool {
    let palette = info.palette.as_deref().unwrap_or_default();
    info.color_type != ColorType::Indexed || palette.len().is_multiple_of(3)
}

/// The colour and alpha of one texel of 8-bit samples.
fn texel(color_type: ColorType, samples: &[u8]) -> (Rgb, u8) {
    match (color_type, samples) {
        (ColorType::GrayscaleAlpha, &[gray, alpha]) => (Rgb::new(gray, gray, gray), alpha),
        (ColorType::Rgb, &[red, green, blue]) => (Rgb::new(red, green, blue), u8::MAX),
        (ColorType::Rgba, &[red, green, blue, alpha]) => (Rgb::new(red, green, blue), alpha),
        (_, samples) => {
            let gray = samples.first().copied().unwrap_or_default();
            (Rgb::new(gray, gray, gray), u8::MAX)
        }
    }
}

#[cfg(test)]
mod tests;

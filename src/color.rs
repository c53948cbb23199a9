//! Colours: sRGB, linear light, palettes, and colour spaces in which distance is perceived
//! difference.
//!
//! Each conversion exists once, with its source. Pictures consist of [`Rgb`]; the submodules serve code that
//! averages, compares or reduces colours. Rejected: a crate for colour spaces. Pictures must be identical, bit
//! for bit, on every machine and in every version.

#[cfg(test)]
pub(crate) mod blindness;
pub mod lab;
pub mod oklab;
pub mod palette;
pub mod srgb;

use std::fmt;
use std::ops::{Add, Mul};
use std::str::FromStr;

/// An opaque sRGB colour with 8 bits per channel.
///
/// It is stored as `0x00RRGGBB` in one word: writing a pixel is one store, and halving all channels
/// is one shift and one mask. Rejected: three separate bytes, which take three of each.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Rgb(u32);

impl Rgb {
    /// Black.
    pub const BLACK: Self = Self::new(0, 0, 0);
    /// White.
    pub const WHITE: Self = Self::new(255, 255, 255);
    /// The colour with the name `sky`.
    pub const SKY: Self = Self::new(0x87, 0xb5, 0xd9);

    /// A colour from its red, green and blue channels.
    pub const fn new(red: u8, green: u8, blue: u8) -> Self {
        Self((red as u32) << 16 | (green as u32) << 8 | blue as u32)
    }

    /// The red channel.
    pub const fn red(self) -> u8 {
        (self.0 >> 16) as u8
    }

    /// The green channel.
    pub const fn green(self) -> u8 {
        (self.0 >> 8) as u8
    }

    /// The blue channel.
    pub const fn blue(self) -> u8 {
        self.0 as u8
    }

    /// The colour as a number, `0x00RRGGBB`. Many window systems use this pixel format.
    #[inline]
    pub const fn to_bits(self) -> u32 {
        self.0
    }

    /// The channels: red, green and blue.
    pub const fn channels(self) -> [u8; 3] {
        [self.red(), self.green(), self.blue()]
    }

    /// The colour at half brightness: each channel is divided by two and rounded down.
    #[must_use]
    pub const fn halved(self) -> Self {
        const LOW_SEVEN_BITS_OF_EACH_CHANNEL: u32 = 0x007f_7f7f;
        Self(self.0 >> 1 & LOW_SEVEN_BITS_OF_EACH_CHANNEL)
    }

    /// Blends this colour over `behind` with an opacity of `alpha` / 255 (Porter and Duff,
    /// "Compositing Digital Images", 1984). Each channel is rounded to the nearest.
    #[inline]
    #[must_use]
    pub const fn over(self, behind: Self, alpha: u8) -> Self {
        const WHOLE: u32 = 255;
        const RED_AND_BLUE: u32 = 0x00ff_00ff;
        /// Divides both 16-bit halves of a word by 255 and rounds to the nearest. Neither half may exceed 255 ·
        /// 255.
        const fn shared(sums: u32) -> u32 {
            const HALF_OF_EACH: u32 = 0x007f_007f;
            const ONE_OF_EACH: u32 = 0x0001_0001;
            let sums = sums + HALF_OF_EACH;
            (sums + ONE_OF_EACH + (sums >> 8 & RED_AND_BLUE)) >> 8 & RED_AND_BLUE
        }
        let (own, rest) = (alpha as u32, WHOLE - alpha as u32);
        let red_and_blue = (self.0 & RED_AND_BLUE) * own + (behind.0 & RED_AND_BLUE) * rest;
        let green = self.green() as u32 * own + behind.green() as u32 * rest;
        Self(shared(red_and_blue) | shared(green) << 8)
    }

    /// Blends this colour over each of `pixels`, as [`Rgb::over`] does, several channels per instruction.
    pub(crate) fn paint_over(self, pixels: &mut [Self], alpha: u8) {
        let rest = u16::from(u8::MAX - alpha);
        let channel = |behind: u16, own: u16| {
            // Divided by 255 and rounded to the nearest. No sum exceeds 16 bits.
            let sum = behind * rest + own + u16::from(u8::MAX) / 2;
            ((sum + 1 + (sum >> 8)) >> 8) as u8
        };
        Self::mix_all(pixels, (self, alpha.into()), channel, |pixel| self.over(pixel, alpha));
    }

    /// Replaces each channel of `pixels` by the result of `channel`. The arguments are that channel and `factor`
    /// times the same channel of `other`. The last pixels may not fill a block. They are replaced by the result
    /// of `pixel`, which must compute the same colour.
    #[inline]
    fn mix_all(
        pixels: &mut [Self],
        (other, factor): (Self, u16),
        channel: impl Fn(u16, u16) -> u8,
        pixel: impl Fn(Self) -> Self,
    ) {
        /// The number of pixels in a register, with eight bits for each channel.
        const AT_ONCE: usize = 4;
        const CHANNELS: usize = 4 * AT_ONCE;
        let others = other.0.to_le_bytes().map(|of_other| u16::from(of_other) * factor);
        let others: [u16; CHANNELS] = std::array::from_fn(|channel| others[channel % 4]);
        let (blocks, rest) = pixels.as_chunks_mut::<AT_ONCE>();
        for block in blocks {
            let mut channels = [0; CHANNELS];
            for (channels, pixel) in channels.as_chunks_mut().0.iter_mut().zip(&*block) {
                *channels = pixel.0.to_le_bytes();
            }
            for (of_pixel, of_other) in channels.iter_mut().zip(others) {
                *of_pixel = channel(u16::from(*of_pixel), of_other);
            }
            for (channels, pixel) in channels.as_chunks().0.iter().zip(block) {
                *pixel = Self(u32::from_le_bytes(*channels));
            }
        }
        for it in rest {
            *it = pixel(*it);
        }
    }

    /// The sum of `own` 256ths of this colour and `share` 256ths of `other`, rounded down.
    ///
    /// `own + share` must be at most 256, so that no channel overflows into the next.
    #[inline]
    #[must_use]
    pub(crate) const fn blended(self, own: u32, other: Self, share: u32) -> Self {
        const RED_AND_BLUE: u32 = 0x00ff_00ff;
        const GREEN: u32 = 0x0000_ff00;
        let red_and_blue = (self.0 & RED_AND_BLUE) * own + (other.0 & RED_AND_BLUE) * share;
        let green = (self.0 & GREEN) * own + (other.0 & GREEN) * share;
        Self(red_and_blue >> 8 & RED_AND_BLUE | green >> 8 & GREEN)
    }

    /// Blends each of `pixels` with `other`, as [`Rgb::blended`] does, several channels per instruction.
    pub(crate) fn blend_all(pixels: &mut [Self], own: u32, other: Self, share: u32) {
        let channel =
            |of_pixel: u16, of_other: u16| ((of_pixel * own as u16 + of_other) >> 8) as u8;
        let blended = |pixel: Self| pixel.blended(own, other, share);
        Self::mix_all(pixels, (other, share as u16), channel, blended);
    }

    /// The luma of the colour, from 0 to 255, with the weights of ITU-R BT.709 in 16-bit fixed point.
    pub const fn luma(self) -> u8 {
        const RED: u32 = 13_933;
        const GREEN: u32 = 46_871;
        const BLUE: u32 = 4_732;
        let sum = RED * self.red() as u32 + GREEN * self.green() as u32 + BLUE * self.blue() as u32;
        (sum >> 16) as u8
    }
}

impl fmt::Display for Rgb {
    /// Writes `#rrggbb`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:06x}", self.0)
    }
}

impl fmt::Debug for Rgb {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// The error of [`Rgb::from_str`]: the text is not a colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ParseColorError;

impl fmt::Display for ParseColorError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a colour is written as \"#rrggbb\", such as \"#a04030\", or as \"sky\"")
    }
}

impl std::error::Error for ParseColorError {}

impl FromStr for Rgb {
    type Err = ParseColorError;

    /// Reads `#rrggbb`, in either case, or `sky`.
    fn from_str(text: &str) -> Result<Self, ParseColorError> {
        if text == "sky" {
            return Ok(Self::SKY);
        }
        let digits = text.strip_prefix('#').ok_or(ParseColorError)?;
        if digits.len() != 6 || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return Err(ParseColorError);
        }
        u32::from_str_radix(digits, 16).map(Self).map_err(|_| ParseColorError)
    }
}

/// The product of a matrix, given by rows, and a vector.
#[inline]
fn product<T: Copy + Add<Output = T> + Mul<Output = T>>(
    rows: &[[T; 3]; 3],
    [x, y, z]: [T; 3],
) -> [T; 3] {
    rows.map(|[a, b, c]| a * x + b * y + c * z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_colour_agree() {
        for text in ["#000000", "#a04030", "#ffffff"] {
            assert_eq!(text.parse::<Rgb>().unwrap().to_string(), text);
        }
        assert_eq!("#A04030".parse(), Ok(Rgb::new(0xa0, 0x40, 0x30)));
        for text in ["", "#", "a04030", "#a0403", "#a040300", "#+12345", "#gg0000", "#ä0000", "red"]
        {
            assert_eq!(text.parse::<Rgb>(), Err(ParseColorError), "{text}");
        }
    }

    #[test]
    fn halving_never_borrows_from_the_next_channel() {
        assert_eq!(Rgb::new(255, 1, 3).halved(), Rgb::new(127, 0, 1));
    }

    #[test]
    fn opacity_is_a_share_of_255() {
        let (front, behind) = (Rgb::new(255, 0, 10), Rgb::new(0, 255, 20));
        assert_eq!(front.over(behind, 0), behind);
        assert_eq!(front.over(behind, 255), front);
        assert_eq!(front.over(behind, 51), Rgb::new(51, 204, 18));
    }

    #[test]
    fn blends_round_to_the_nearest_value() {
        for (alpha, front) in (0..=255).flat_map(|alpha| (0..=255).map(move |front| (alpha, front)))
        {
            for behind in (0..=255).step_by(3).chain([254, 255]) {
                let sum = u32::from(front) * u32::from(alpha)
                    + u32::from(behind) * (255 - u32::from(alpha));
                let mixed = ((sum + 127) / 255) as u8;
                let drawn = Rgb::new(front, behind, front).over(Rgb::new(behind, behind, 0), alpha);
                assert_eq!(
                    (drawn.red(), drawn.green()),
                    (mixed, behind),
                    "{front} {behind} {alpha}"
                );
            }
        }
    }

    #[test]
    fn many_pixels_blend_like_single_ones() {
        let behind: Vec<_> = (0..=255).map(|it| Rgb::new(it, 255 - it, it / 2)).collect();
        for (alpha, count) in (0..=255).zip((0..9).chain(248..257).cycle()) {
            for front in [Rgb::BLACK, Rgb::WHITE, Rgb::new(alpha, 17, 200)] {
                let mut pixels = behind[..count.min(behind.len())].to_vec();
                let drawn: Vec<_> = pixels.iter().map(|&it| front.over(it, alpha)).collect();
                front.paint_over(&mut pixels, alpha);
                assert_eq!(pixels, drawn, "{front} {alpha}");
            }
        }
    }

    #[test]
    fn channels_blend_separately() {
        let (one, other) = (Rgb::new(200, 0, 255), Rgb::new(100, 255, 1));
        assert_eq!(one.blended(256, other, 0), one);
        assert_eq!(one.blended(0, other, 256), other);
        assert_eq!(one.blended(128, other, 128), Rgb::new(150, 127, 128));
        assert_eq!(one.blended(128, other, 0), one.halved());
    }

    #[test]
    fn luma_spans_its_range() {
        assert_eq!(Rgb::BLACK.luma(), 0);
        assert_eq!(Rgb::WHITE.luma(), 255);
    }
}

//! The colours of a terminal, as parameters of SGR.

use std::fmt;

use ratatui::style::Color;

use super::super::control::{self, ControlSequence};
use super::super::ink::Notation;
use crate::color::Rgb;

/// A colour in the form that SGR writes, of which ratatui has several names. It has few bits, since
/// most operations on colours are comparisons.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shade(u32);

/// The kind of a [`Shade`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Default,
    Indexed(u8),
    Rgb([u8; 3]),
}

/// One of the two colours of a cell.
#[derive(Clone, Copy)]
enum Ground {
    Fore,
    Back,
}

impl Shade {
    /// The terminal's default colour.
    pub(crate) const DEFAULT: Self = Self(0);
    /// A value that no colour has.
    pub(crate) const NONE: Self = Self(u32::MAX);
    /// The number of bits of a colour.
    pub(crate) const BITS: u32 = 26;
    const INDEXED: u32 = 1 << 24;
    const RGB: u32 = 2 << 24;

    pub(crate) const fn indexed(index: u8) -> Self {
        Self(Self::INDEXED | index as u32)
    }

    pub(crate) const fn rgb([red, green, blue]: [u8; 3]) -> Self {
        Self(Self::RGB | u32::from_be_bytes([0, red, green, blue]))
    }

    #[inline]
    pub(crate) fn of(color: Color) -> Self {
        // Most colours are RGB: this branch is more predictable than a jump table of all kinds.
        if let Color::Rgb(red, green, blue) = color {
            Self::rgb([red, green, blue])
        } else {
            Self::of_named(color)
        }
    }

    #[inline(never)]
    fn of_named(color: Color) -> Self {
        Self::indexed(match color {
            Color::Rgb(red, green, blue) => return Self::rgb([red, green, blue]),
            Color::Reset => return Self::DEFAULT,
            Color::Indexed(index) => index,
            Color::Black => 0,
            Color::Red => 1,
            Color::Green => 2,
            Color::Yellow => 3,
            Color::Blue => 4,
            Color::Magenta => 5,
            Color::Cyan => 6,
            Color::Gray => 7,
            Color::DarkGray => 8,
            Color::LightRed => 9,
            Color::LightGreen => 10,
            Color::LightYellow => 11,
            Color::LightBlue => 12,
            Color::LightMagenta => 13,
            Color::LightCyan => 14,
            Color::White => 15,
        })
    }

    #[inline]
    pub(crate) fn of_pixel(pixel: Rgb) -> Self {
        Self(Self::RGB | pixel.to_bits())
    }

    /// A number of [`Shade::BITS`] bits, unique to the colour.
    #[inline]
    pub(crate) const fn in_bits(self) -> u32 {
        self.0
    }

    /// The colour of the number in the lower bits of `bits`; the upper bits are ignored.
    #[inline]
    pub(crate) const fn from_bits(bits: u32) -> Self {
        Self(bits & ((1 << Self::BITS) - 1))
    }

    #[inline]
    pub(crate) fn kind(self) -> Kind {
        let [kind, red, green, blue] = self.0.to_be_bytes();
        if self.is_rgb() {
            return Kind::Rgb([red, green, blue]);
        }
        if kind == 0 { Kind::Default } else { Kind::Indexed(blue) }
    }

    #[inline]
    pub(crate) fn is_rgb(self) -> bool {
        self.0 & Self::RGB != 0
    }

    /// The colour as ratatui names it.
    pub(crate) fn color(self) -> Color {
        match self.kind() {
            Kind::Default => Color::Reset,
            Kind::Indexed(index) => Color::Indexed(index),
            Kind::Rgb([red, green, blue]) => Color::Rgb(red, green, blue),
        }
    }

    /// The notation of the longest of several colours, from the union of their bits.
    pub(crate) fn longest_of(bits: u32) -> Notation {
        /// Bits that no index of a named colour has.
        const ABOVE_NAMED: u32 = 0xF0;
        if bits & Self::RGB != 0 {
            Notation::Rgb
        } else if bits & ABOVE_NAMED != 0 {
            Notation::Indexed
        } else {
            Notation::Named
        }
    }

    /// The approximate number of bytes of its parameters.
    #[inline]
    pub(crate) fn bytes(self) -> usize {
        match self.kind() {
            Kind::Default | Kind::Indexed(..16) => 2,
            Kind::Indexed(index) => 5 + control::digits(index),
            Kind::Rgb([red, green, blue]) => {
                7 + control::digits(red) + control::digits(green) + control::digits(blue)
            }
        }
    }

    /// Adds the change of the text colour and the background from `current` to `new`, of which at least one
    /// differs; `told` maps colours to the ones to send.
    #[inline]
    pub(crate) fn push_change(
        new: [Self; 2],
        current: [Self; 2],
        told: impl Fn(Self) -> Self,
        rendition: &mut ControlSequence,
    ) {
        for (place, ground) in [Ground::Fore, Ground::Back].into_iter().enumerate() {
            rendition.add_if(new[place] != current[place], |rendition| {
                told(new[place]).write(ground, rendition);
            });
        }
    }

    #[expect(clippy::inline_always, reason = "calls would take longer than what they do")]
    #[inline(always)]
    fn write(self, ground: Ground, rendition: &mut ControlSequence) {
        let (dark, bright, default, rgb, indexed) = match ground {
            Ground::Fore => (30, 90, 39, *b";38;2\0\0\0", *b";38;5\0\0\0"),
            Ground::Back => (40, 100, 49, *b";48;2\0\0\0", *b";48;5\0\0\0"),
        };
        match self.kind() {
            Kind::Rgb(channels) => {
                rendition.literal(rgb, 5);
                rendition.parameters(channels);
            }
            Kind::Default => rendition.parameter(default),
            Kind::Indexed(index @ 0..=7) => rendition.parameter(dark + index),
            Kind::Indexed(index @ 8..=15) => rendition.parameter(bright + (index - 8)),
            Kind::Indexed(index) => {
                rendition.literal(indexed, 5);
                rendition.parameter(index);
            }
        }
    }
}

impl fmt::Debug for Shade {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.kind().fmt(f)
    }
}

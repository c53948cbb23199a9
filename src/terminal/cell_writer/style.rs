//! Colours and modifiers, as parameters of Select Graphic Rendition (SGR).

use std::fmt;

use ratatui::buffer::Cell;
use ratatui::style::{Color, Modifier};

use super::super::sequence;
#[cfg(feature = "cli")]
use super::bytes::Bytes;
use super::bytes::Piece;
use super::control::{self, ControlSequence};
use super::ink::Notation;
use crate::color::Rgb;

/// The colours and modifiers of a character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Style {
    pub(super) foreground: Shade,
    pub(super) background: Shade,
    pub(super) modifier: Modifier,
}

/// A colour in the form that SGR writes, of which ratatui has several names. It has few bits, since
/// most operations on colours are comparisons.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) struct Shade(u32);

/// The kind of a [`Shade`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
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

/// A modifier, and the parameters to turn it on and off.
struct Switch {
    modifier: Modifier,
    on: u8,
    off: u8,
}

/// Bold and dim share the parameter that turns them off.
const SWITCHES: [Switch; 5] = [
    Switch { modifier: Modifier::BOLD, on: 1, off: 22 },
    Switch { modifier: Modifier::DIM, on: 2, off: 22 },
    Switch { modifier: Modifier::ITALIC, on: 3, off: 23 },
    Switch { modifier: Modifier::UNDERLINED, on: 4, off: 24 },
    Switch { modifier: Modifier::REVERSED, on: 7, off: 27 },
];

const INTENSITIES: Modifier = Modifier::BOLD.union(Modifier::DIM);

const SUPPORTED: Modifier =
    INTENSITIES.union(Modifier::ITALIC).union(Modifier::UNDERLINED).union(Modifier::REVERSED);

impl Style {
    /// The terminal's default colours, without modifiers.
    pub(crate) const RESET: Self = Self {
        foreground: Shade::DEFAULT,
        background: Shade::DEFAULT,
        modifier: Modifier::empty(),
    };

    /// The style of `cell`.
    #[inline]
    pub(crate) fn of(cell: &Cell) -> Self {
        Self {
            foreground: Shade::of(cell.fg),
            background: Shade::of(cell.bg),
            modifier: cell.modifier.intersection(SUPPORTED),
        }
    }

    /// These two colours, without modifiers.
    pub(super) fn plain(foreground: Shade, background: Shade) -> Self {
        Self { foreground, background, modifier: Modifier::empty() }
    }

    /// These two colours, as ratatui names them, without modifiers.
    pub(super) fn in_colors(colors: [Color; 2]) -> Self {
        let [foreground, background] = colors.map(Shade::of);
        Self::plain(foreground, background)
    }

    pub(super) fn has_no_modifiers(self) -> bool {
        self.modifier.is_empty()
    }

    /// The text and background colours; `None` with modifiers.
    pub(super) fn plain_colors(self) -> Option<[Shade; 2]> {
        self.has_no_modifiers().then_some([self.foreground, self.background])
    }

    /// Writes the change from `current`, or from an unknown style, to this style.
    #[cfg(feature = "cli")]
    pub(crate) fn write_from(self, current: Option<Self>, bytes: &mut Bytes) {
        let mut piece = bytes.piece();
        self.push_from(current, |shade| shade, &mut piece);
        piece.finish();
    }

    /// Adds the change from `current`, or from an unknown style, to this style; `told` maps colours
    /// to the ones to send.
    #[expect(clippy::inline_always, reason = "calls would take longer than what they do")]
    #[inline(always)]
    pub(super) fn push_from(
        self,
        current: Option<Self>,
        told: impl Fn(Shade) -> Shade,
        piece: &mut Piece,
    ) {
        let known = match current {
            Some(style) if self != Self::RESET => style,
            _ => {
                sequence::RESET_STYLE.bytes().for_each(|byte| piece.push([byte], 1));
                Self::RESET
            }
        };
        let mut rendition = ControlSequence::begin(piece);
        if self.modifier != known.modifier {
            self.switch_modifiers(known.modifier, &mut rendition);
        }
        rendition.add_if(self.foreground != known.foreground, |rendition| {
            told(self.foreground).write(Ground::Fore, rendition);
        });
        rendition.add_if(self.background != known.background, |rendition| {
            told(self.background).write(Ground::Back, rendition);
        });
        rendition.end(b'm');
    }

    #[cold]
    fn switch_modifiers(self, known: Modifier, rendition: &mut ControlSequence) {
        let removed = known.difference(self.modifier);
        let kept = if removed.intersects(INTENSITIES) {
            known.difference(INTENSITIES)
        } else {
            known.intersection(self.modifier)
        };
        let added = self.modifier.difference(kept);
        let within =
            |set: Modifier| SWITCHES.iter().filter(move |switch| set.contains(switch.modifier));
        rendition.parameters(within(removed).map(|switch| switch.off));
        rendition.parameters(within(added).map(|switch| switch.on));
    }
}

impl Shade {
    /// The terminal's default colour.
    pub(super) const DEFAULT: Self = Self(0);
    /// A value that no colour has.
    pub(super) const NONE: Self = Self(u32::MAX);
    /// The number of bits of a colour.
    pub(super) const BITS: u32 = 26;
    const INDEXED: u32 = 1 << 24;
    const RGB: u32 = 2 << 24;

    pub(super) const fn indexed(index: u8) -> Self {
        Self(Self::INDEXED | index as u32)
    }

    pub(super) const fn rgb([red, green, blue]: [u8; 3]) -> Self {
        Self(Self::RGB | u32::from_be_bytes([0, red, green, blue]))
    }

    #[inline]
    pub(super) fn of(color: Color) -> Self {
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
    pub(super) fn of_pixel(pixel: Rgb) -> Self {
        Self(Self::RGB | pixel.to_bits())
    }

    /// A number of [`Shade::BITS`] bits, unique to the colour.
    #[inline]
    pub(super) const fn in_bits(self) -> u32 {
        self.0
    }

    /// The colour of the number in the lower bits of `bits`; the upper bits are ignored.
    #[inline]
    pub(super) const fn from_bits(bits: u32) -> Self {
        Self(bits & ((1 << Self::BITS) - 1))
    }

    #[inline]
    pub(super) fn kind(self) -> Kind {
        let [kind, red, green, blue] = self.0.to_be_bytes();
        match kind {
            0 => Kind::Default,
            1 => Kind::Indexed(blue),
            _ => Kind::Rgb([red, green, blue]),
        }
    }

    /// The colour as ratatui names it.
    pub(super) fn color(self) -> Color {
        match self.kind() {
            Kind::Default => Color::Reset,
            Kind::Indexed(index) => Color::Indexed(index),
            Kind::Rgb([red, green, blue]) => Color::Rgb(red, green, blue),
        }
    }

    /// The notation of the longest of several colours, from the union of their bits.
    pub(super) fn longest_of(bits: u32) -> Notation {
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
    pub(super) fn bytes(self) -> usize {
        match self.kind() {
            Kind::Default | Kind::Indexed(..16) => 2,
            Kind::Indexed(index) => 5 + control::digits(index),
            Kind::Rgb([red, green, blue]) => {
                7 + control::digits(red) + control::digits(green) + control::digits(blue)
            }
        }
    }

    #[expect(clippy::inline_always, reason = "calls would take longer than what they do")]
    #[inline(always)]
    fn write(self, ground: Ground, rendition: &mut ControlSequence) {
        let (dark, bright, default, rgb, indexed) = match ground {
            Ground::Fore => (30, 90, 39, *b";38;2", *b";38;5"),
            Ground::Back => (40, 100, 49, *b";48;2", *b";48;5"),
        };
        match self.kind() {
            Kind::Rgb(channels) => {
                rendition.literal(rgb);
                rendition.parameters(channels);
            }
            Kind::Default => rendition.parameter(default),
            Kind::Indexed(index @ 0..=7) => rendition.parameter(dark + index),
            Kind::Indexed(index @ 8..=15) => rendition.parameter(bright + (index - 8)),
            Kind::Indexed(index) => {
                rendition.literal(indexed);
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

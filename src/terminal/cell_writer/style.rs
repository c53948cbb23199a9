//! Colours and modifiers, as parameters of Select Graphic Rendition (SGR).

use std::fmt;

use ratatui::buffer::Cell;
use ratatui::style::{Color, Modifier};

#[cfg(feature = "cli")]
use super::bytes::Bytes;
use super::bytes::{self, ControlSequence, Piece};
use crate::color::Rgb;
use crate::terminal::sequence;

/// The colours and modifiers of a character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Style {
    pub(crate) foreground: PackedColor,
    pub(crate) background: PackedColor,
    pub(crate) modifier: Modifier,
}

/// A modifier, and the parameters that turn it on and off.
struct ModifierCodes {
    modifier: Modifier,
    on: u8,
    off: u8,
}

/// Bold and dim share the parameter that turns them off.
const SWITCHES: [ModifierCodes; 5] = [
    ModifierCodes { modifier: Modifier::BOLD, on: 1, off: 22 },
    ModifierCodes { modifier: Modifier::DIM, on: 2, off: 22 },
    ModifierCodes { modifier: Modifier::ITALIC, on: 3, off: 23 },
    ModifierCodes { modifier: Modifier::UNDERLINED, on: 4, off: 24 },
    ModifierCodes { modifier: Modifier::REVERSED, on: 7, off: 27 },
];

const INTENSITIES: Modifier = Modifier::BOLD.union(Modifier::DIM);

const SUPPORTED: Modifier =
    INTENSITIES.union(Modifier::ITALIC).union(Modifier::UNDERLINED).union(Modifier::REVERSED);

impl Style {
    /// The terminal's default colours, without modifiers.
    pub(crate) const RESET: Self = Self {
        foreground: PackedColor::DEFAULT,
        background: PackedColor::DEFAULT,
        modifier: Modifier::empty(),
    };

    /// The style of `cell`.
    #[inline]
    pub(crate) fn of(cell: &Cell) -> Self {
        Self {
            foreground: PackedColor::of(cell.fg),
            background: PackedColor::of(cell.bg),
            modifier: cell.modifier.intersection(SUPPORTED),
        }
    }

    /// A style of these two colours, without modifiers.
    pub(crate) fn plain(foreground: PackedColor, background: PackedColor) -> Self {
        Self { foreground, background, modifier: Modifier::empty() }
    }

    /// A style of these two colours in ratatui's type, without modifiers.
    pub(crate) fn in_colors(colors: [Color; 2]) -> Self {
        let [foreground, background] = colors.map(PackedColor::of);
        Self::plain(foreground, background)
    }

    pub(crate) fn has_no_modifiers(self) -> bool {
        self.modifier.is_empty()
    }

    /// The text colour and the background.
    pub(crate) fn colors(self) -> [PackedColor; 2] {
        [self.foreground, self.background]
    }

    /// The text colour and the background. `None` if there are modifiers.
    pub(crate) fn plain_colors(self) -> Option<[PackedColor; 2]> {
        self.has_no_modifiers().then_some(self.colors())
    }

    /// Writes the change from `current`, or from an unknown style, to this style.
    #[cfg(feature = "cli")]
    pub(crate) fn write_from(self, current: Option<Self>, bytes: &mut Bytes) {
        let mut piece = bytes.piece();
        self.push_from(current, |shade| shade, &mut piece);
        piece.finish();
    }

    /// Adds the change from `current`, or from an unknown style, to this style. `told` maps each colour to the colour
    /// to send.
    #[expect(clippy::inline_always, reason = "calls would take longer than what they do")]
    #[inline(always)]
    pub(crate) fn push_from(
        self,
        current: Option<Self>,
        told: impl Fn(PackedColor) -> PackedColor,
        piece: &mut Piece,
    ) {
        let known = match current {
            Some(style) if self != Self::RESET => style,
            _ => {
                sequence::RESET_STYLE.bytes().for_each(|byte| piece.push([byte], 1));
                if self == Self::RESET {
                    return;
                }
                Self::RESET
            }
        };
        let mut rendition = ControlSequence::begin(piece);
        if self.modifier != known.modifier {
            let (numbers, count) = self.switches_from(known.modifier);
            rendition.parameters(numbers.into_iter().take(count));
        }
        PackedColor::push_change(self.colors(), known.colors(), told, &mut rendition);
        rendition.end(b'm');
    }

    /// The parameters that switch from the modifiers `known` to this style's modifiers, and their number.
    #[cold]
    fn switches_from(self, known: Modifier) -> ([u8; 2 * SWITCHES.len()], usize) {
        let removed = known.difference(self.modifier);
        let kept = if removed.intersects(INTENSITIES) {
            known.difference(INTENSITIES)
        } else {
            known.intersection(self.modifier)
        };
        let added = self.modifier.difference(kept);
        let within =
            |set: Modifier| SWITCHES.iter().filter(move |switch| set.contains(switch.modifier));
        let off = within(removed).map(|switch| switch.off);
        let switches = off.chain(within(added).map(|switch| switch.on));
        let (mut numbers, mut count) = ([0; 2 * SWITCHES.len()], 0);
        for (number, switch) in numbers.iter_mut().zip(switches) {
            *number = switch;
            count += 1;
        }
        (numbers, count)
    }
}

/// A colour in the form that SGR writes, in few bits, because most operations on colours are comparisons. Each colour
/// has one value, while ratatui has several names for some colours.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct PackedColor(u32);

/// The kind of a [`PackedColor`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PackedColorKind {
    Default,
    Indexed(u8),
    Rgb([u8; 3]),
}

/// The notation of a colour in a control sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Notation {
    /// As one of the 16 named colours, in two bytes.
    Named,
    /// As one of the 240 fixed colours, in up to eight bytes.
    Indexed,
    /// As an entry of the palette if an entry holds the colour, in up to eight bytes.
    Entry,
    /// As red, green and blue, in up to sixteen bytes.
    Rgb,
}

/// One of the two colours of a cell.
#[derive(Clone, Copy)]
enum CellColor {
    Fore,
    Back,
}

impl PackedColor {
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
        // Most colours are RGB, so this branch is more predictable than a jump table of all kinds.
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

    /// A number of [`PackedColor::BITS`] bits, unique to the colour.
    #[inline]
    pub(crate) const fn in_bits(self) -> u32 {
        self.0
    }

    /// The colour whose number is in the lower bits of `bits`. The upper bits are ignored.
    #[inline]
    pub(crate) const fn from_bits(bits: u32) -> Self {
        Self(bits & ((1 << Self::BITS) - 1))
    }

    /// A hash with this number of bits.
    #[inline]
    pub(crate) const fn hash(self, bits: u32) -> usize {
        (self.0.wrapping_mul(0x9E37_79B1) >> (u32::BITS - bits)) as usize
    }

    #[inline]
    pub(crate) fn kind(self) -> PackedColorKind {
        let [kind, red, green, blue] = self.0.to_be_bytes();
        if self.is_rgb() {
            return PackedColorKind::Rgb([red, green, blue]);
        }
        if kind == 0 { PackedColorKind::Default } else { PackedColorKind::Indexed(blue) }
    }

    #[inline]
    pub(crate) fn is_rgb(self) -> bool {
        self.0 & Self::RGB != 0
    }

    /// The colour in ratatui's type.
    pub(crate) fn color(self) -> Color {
        match self.kind() {
            PackedColorKind::Default => Color::Reset,
            PackedColorKind::Indexed(index) => Color::Indexed(index),
            PackedColorKind::Rgb([red, green, blue]) => Color::Rgb(red, green, blue),
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
            PackedColorKind::Default | PackedColorKind::Indexed(..16) => 2,
            PackedColorKind::Indexed(index) => 5 + bytes::digits(index),
            PackedColorKind::Rgb([red, green, blue]) => {
                7 + bytes::digits(red) + bytes::digits(green) + bytes::digits(blue)
            }
        }
    }

    /// Adds the change of the text colour and the background from `current` to `new`. At least one of them must
    /// differ. `told` maps each colour to the colour to send.
    #[inline]
    pub(crate) fn push_change(
        new: [Self; 2],
        current: [Self; 2],
        told: impl Fn(Self) -> Self,
        rendition: &mut ControlSequence,
    ) {
        for (place, ground) in [CellColor::Fore, CellColor::Back].into_iter().enumerate() {
            rendition.add_if(new[place] != current[place], |rendition| {
                told(new[place]).write(ground, rendition);
            });
        }
    }

    #[expect(clippy::inline_always, reason = "calls would take longer than what they do")]
    #[inline(always)]
    fn write(self, ground: CellColor, rendition: &mut ControlSequence) {
        let (dark, bright, default, rgb, indexed) = match ground {
            CellColor::Fore => (30, 90, 39, *b";38;2\0\0\0", *b";38;5\0\0\0"),
            CellColor::Back => (40, 100, 49, *b";48;2\0\0\0", *b";48;5\0\0\0"),
        };
        match self.kind() {
            PackedColorKind::Rgb(channels) => {
                rendition.literal(rgb, 5);
                rendition.parameters(channels);
            }
            PackedColorKind::Default => rendition.parameter(default),
            PackedColorKind::Indexed(index @ 0..=7) => rendition.parameter(dark + index),
            PackedColorKind::Indexed(index @ 8..=15) => rendition.parameter(bright + (index - 8)),
            PackedColorKind::Indexed(index) => {
                rendition.literal(indexed, 5);
                rendition.parameter(index);
            }
        }
    }
}

impl fmt::Debug for PackedColor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.kind().fmt(f)
    }
}

//! Colours and modifiers, as Select Graphic Rendition (SGR) takes them.

use ratatui::buffer::Cell;
use ratatui::style::{Color, Modifier};

use super::super::sequence;
use super::control::ControlSequence;

/// How a character is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Style {
    pub(super) foreground: Shade,
    pub(super) background: Shade,
    modifier: Modifier,
}

/// A colour in the one way that SGR writes it, of ratatui's several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shade {
    Default,
    Indexed(u8),
    Rgb(u8, u8, u8),
}

/// Which of the two colours of a cell.
#[derive(Clone, Copy)]
enum Ground {
    Fore,
    Back,
}

/// A modifier, and the parameters that turn it on and off.
struct Switch {
    modifier: Modifier,
    on: u16,
    off: u16,
}

/// Bold and dim are turned off together.
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
    /// The terminal's own colours, and no modifiers.
    pub(crate) const RESET: Self = Self {
        foreground: Shade::Default,
        background: Shade::Default,
        modifier: Modifier::empty(),
    };

    /// How `cell` is drawn.
    pub(crate) fn of(cell: &Cell) -> Self {
        Self {
            foreground: Shade::of(cell.fg),
            background: Shade::of(cell.bg),
            modifier: cell.modifier.intersection(SUPPORTED),
        }
    }

    /// Those two colours, and no modifiers.
    pub(super) fn plain(foreground: Shade, background: Shade) -> Self {
        Self { foreground, background, modifier: Modifier::empty() }
    }

    pub(super) fn modifier_bits(self) -> u16 {
        self.modifier.bits()
    }

    pub(super) fn has_no_modifiers(self) -> bool {
        self.modifier.is_empty()
    }

    /// The text's colour and the ground's, where there are no modifiers.
    pub(super) fn plain_colors(self) -> Option<[Shade; 2]> {
        self.has_no_modifiers().then_some([self.foreground, self.background])
    }

    /// About how many bytes [`Style::write_from`] would write after `current`.
    pub(super) fn bytes_after(self, current: Self) -> usize {
        /// What introduces a sequence, and its last byte.
        const SEQUENCE: usize = 3;
        let colors = [(self.foreground, current.foreground), (self.background, current.background)];
        let parameters: usize =
            colors.iter().filter(|(new, old)| new != old).map(|(new, _)| new.bytes()).sum();
        let switches = SEQUENCE * usize::from(self.modifier != current.modifier);
        if parameters + switches == 0 { 0 } else { SEQUENCE + parameters + switches }
    }

    /// Writes what turns `current`, or an unknown style, into this one.
    pub(crate) fn write_from(self, current: Option<Self>, bytes: &mut Vec<u8>) {
        let known = match current {
            Some(style) if self != Self::RESET => style,
            _ => {
                bytes.extend_from_slice(sequence::RESET_STYLE.as_bytes());
                Self::RESET
            }
        };
        let mut rendition = ControlSequence::begin(bytes);
        self.switch_modifiers(known.modifier, &mut rendition);
        if self.foreground != known.foreground {
            self.foreground.write(Ground::Fore, &mut rendition);
        }
        if self.background != known.background {
            self.background.write(Ground::Back, &mut rendition);
        }
        rendition.end(b'm');
    }

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
    fn of(color: Color) -> Self {
        Self::Indexed(match color {
            Color::Reset => return Self::Default,
            Color::Rgb(red, green, blue) => return Self::Rgb(red, green, blue),
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

    /// A number of its own, of 26 bits.
    pub(super) fn in_bits(self) -> u32 {
        match self {
            Self::Default => 0,
            Self::Indexed(index) => 1 << 24 | u32::from(index),
            Self::Rgb(red, green, blue) => 2 << 24 | u32::from_be_bytes([0, red, green, blue]),
        }
    }

    /// The colour that has the number `bits`.
    pub(super) fn from_bits(bits: u32) -> Self {
        let [kind, red, green, blue] = bits.to_be_bytes();
        match kind {
            0 => Self::Default,
            1 => Self::Indexed(blue),
            _ => Self::Rgb(red, green, blue),
        }
    }

    /// The same colour, as ratatui names it.
    pub(super) fn color(self) -> Color {
        match self {
            Self::Default => Color::Reset,
            Self::Indexed(index) => Color::Indexed(index),
            Self::Rgb(red, green, blue) => Color::Rgb(red, green, blue),
        }
    }

    /// About how many bytes it takes as parameters.
    pub(super) fn bytes(self) -> usize {
        let digits = |number: u8| match number {
            0..10 => 1,
            10..100 => 2,
            _ => 3,
        };
        match self {
            Self::Default | Self::Indexed(..16) => 2,
            Self::Indexed(index) => 5 + digits(index),
            Self::Rgb(red, green, blue) => 7 + digits(red) + digits(green) + digits(blue),
        }
    }

    fn write(self, ground: Ground, rendition: &mut ControlSequence) {
        let (dark, bright, extended, default) = match ground {
            Ground::Fore => (30, 90, 38, 39),
            Ground::Back => (40, 100, 48, 49),
        };
        match self {
            Self::Default => rendition.parameter(default),
            Self::Indexed(index @ 0..=7) => rendition.parameter(dark + u16::from(index)),
            Self::Indexed(index @ 8..=15) => rendition.parameter(bright + u16::from(index - 8)),
            Self::Indexed(index) => rendition.parameters([extended, 5, index.into()]),
            Self::Rgb(red, green, blue) => {
                rendition.parameters([extended, 2, red.into(), green.into(), blue.into()]);
            }
        }
    }
}

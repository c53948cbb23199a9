//! Colours and modifiers, as parameters of Select Graphic Rendition (SGR).

mod shade;

use ratatui::buffer::Cell;
use ratatui::style::{Color, Modifier};

use super::super::sequence;
#[cfg(feature = "cli")]
use super::bytes::Bytes;
use super::bytes::Piece;
use super::control::ControlSequence;
pub(crate) use shade::{Kind, Shade};

/// The colours and modifiers of a character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Style {
    pub(crate) foreground: Shade,
    pub(crate) background: Shade,
    pub(crate) modifier: Modifier,
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
    pub(crate) fn plain(foreground: Shade, background: Shade) -> Self {
        Self { foreground, background, modifier: Modifier::empty() }
    }

    /// These two colours, as ratatui names them, without modifiers.
    pub(crate) fn in_colors(colors: [Color; 2]) -> Self {
        let [foreground, background] = colors.map(Shade::of);
        Self::plain(foreground, background)
    }

    pub(crate) fn has_no_modifiers(self) -> bool {
        self.modifier.is_empty()
    }

    /// The text colour and the background.
    pub(crate) fn colors(self) -> [Shade; 2] {
        [self.foreground, self.background]
    }

    /// The text colour and the background; `None` with modifiers.
    pub(crate) fn plain_colors(self) -> Option<[Shade; 2]> {
        self.has_no_modifiers().then_some(self.colors())
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
    pub(crate) fn push_from(
        self,
        current: Option<Self>,
        told: impl Fn(Shade) -> Shade,
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
        Shade::push_change(self.colors(), known.colors(), told, &mut rendition);
        rendition.end(b'm');
    }

    /// The parameters that switch from the modifiers `known` to these, and their number.
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

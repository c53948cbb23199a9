//! The keys of each preset.

use super::{Action, Bindings, MapChange};
use crate::game::Intent;
use crate::terminal::Key;

impl Default for Bindings {
    /// The bindings for QWERTY keyboards.
    fn default() -> Self {
        Self::with_letters(&Letters {
            forward: 'w',
            back: 's',
            strafe_left: 'a',
            leave: 'q',
            lamp: 'l',
            turns: None,
        })
    }
}

/// The keys that differ between presets.
struct Letters {
    forward: char,
    back: char,
    strafe_left: char,
    leave: char,
    lamp: char,
    /// Further keys that turn left and right, besides the arrows.
    turns: Option<[char; 2]>,
}

/// The name of a preset and its constructor.
pub(crate) type Preset = (&'static str, fn() -> Bindings);

/// The presets, the default first.
pub(crate) const PRESETS: [Preset; 3] =
    [("qwerty", Bindings::default), ("azerty", Bindings::azerty), ("hjkl", Bindings::hjkl)];

impl Bindings {
    /// The bindings for AZERTY keyboards: Z, Q, S and D are where W, A, S and D are on QWERTY
    /// keyboards; A leaves.
    pub fn azerty() -> Self {
        Self::with_letters(&Letters {
            forward: 'z',
            back: 's',
            strafe_left: 'q',
            leave: 'a',
            lamp: 'l',
            turns: None,
        })
    }

    /// The bindings for users of vi: H and L turn, J and K walk, A and D strafe, Z
    /// lights the lamp.
    pub fn hjkl() -> Self {
        Self::with_letters(&Letters {
            forward: 'k',
            back: 'j',
            strafe_left: 'a',
            leave: 'q',
            lamp: 'z',
            turns: Some(['h', 'l']),
        })
    }

    fn with_letters(letters: &Letters) -> Self {
        let mut keys = vec![
            (Key::Char(letters.forward), Action::Want(Intent::Forward)),
            (Key::Up, Action::Want(Intent::Forward)),
            (Key::Char(letters.back), Action::Want(Intent::Back)),
            (Key::Down, Action::Want(Intent::Back)),
            (Key::Char(letters.strafe_left), Action::Want(Intent::StrafeLeft)),
            (Key::Char('d'), Action::Want(Intent::StrafeRight)),
            (Key::Left, Action::Want(Intent::TurnLeft)),
            (Key::Right, Action::Want(Intent::TurnRight)),
            // These letters are on the same keys in nearly all layouts.
            (Key::Char('u'), Action::Want(Intent::FineLeft)),
            (Key::Char('o'), Action::Want(Intent::FineRight)),
            (Key::Char('b'), Action::Want(Intent::AboutFace)),
            (Key::Char('g'), Action::ToggleWalkOn),
            (Key::Shift, Action::Want(Intent::Run)),
            (Key::Char(' '), Action::Want(Intent::Jump)),
            (Key::Char('e'), Action::Want(Intent::Open)),
            // Control was refused: with another key held, it is a command to the terminal.
            (Key::Char('c'), Action::Want(Intent::Duck)),
            (Key::Char('f'), Action::Want(Intent::Strike)),
            (Key::Char('t'), Action::Want(Intent::Throw)),
            (Key::Char('n'), Action::Want(Intent::Shoot)),
            (Key::Char('y'), Action::Want(Intent::Smoke)),
            (Key::Char(letters.lamp), Action::Want(Intent::Lamp)),
            (Key::PageUp, Action::Want(Intent::LookUp)),
            (Key::PageDown, Action::Want(Intent::LookDown)),
            (Key::Home, Action::Want(Intent::LookAhead)),
            (Key::Char('r'), Action::ToggleRun),
            (Key::Char('x'), Action::ToggleDuck),
            (Key::Char('v'), Action::ToggleMouse),
            (Key::Char('m'), Action::ToggleMinimap),
            (Key::Tab, Action::ToggleMinimap),
            // As on a number pad.
            (Key::Char('9'), Action::ChangeMap(MapChange::Larger)),
            (Key::Char('3'), Action::ChangeMap(MapChange::Smaller)),
            (Key::Char('8'), Action::ChangeMap(MapChange::North)),
            (Key::Char('2'), Action::ChangeMap(MapChange::South)),
            (Key::Char('4'), Action::ChangeMap(MapChange::West)),
            (Key::Char('6'), Action::ChangeMap(MapChange::East)),
            (Key::Char('5'), Action::ChangeMap(MapChange::Center)),
            (Key::Char('?'), Action::ToggleHelp),
            (Key::Char('p'), Action::TogglePause),
            (Key::Char('+'), Action::WidenView),
            (Key::Char('='), Action::WidenView),
            (Key::Char('-'), Action::NarrowView),
            (Key::Char('i'), Action::ToggleStats),
            (Key::Char('.'), Action::ToggleCrosshair),
            (Key::Char(','), Action::ToggleCompass),
            (Key::Char('0'), Action::ToggleGhost),
            (Key::Char(letters.leave), Action::Leave),
            (Key::Escape, Action::Leave),
        ];
        if let Some([left, right]) = letters.turns {
            keys.push((Key::Char(left), Action::Want(Intent::TurnLeft)));
            keys.push((Key::Char(right), Action::Want(Intent::TurnRight)));
        }
        Self { keys }.in_order()
    }
}

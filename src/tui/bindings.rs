//! Which key does what: the actions, and presets of keys for them.

use crate::game::Intent;
use crate::terminal::{Key, KeyEvent};

/// What a key can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Action {
    /// Wanting something for as long as the key is held.
    Want(Intent),
    /// Running until it is pressed again.
    ToggleRun,
    /// Ducking until it is pressed again.
    ToggleDuck,
    /// Turning and tilting by the mouse, or not any more.
    ToggleMouse,
    /// Showing or hiding the minimap.
    ToggleMinimap,
    /// Showing the minimap larger, smaller, or another part of it.
    ChangeMap(MapChange),
    /// Showing or hiding the keys.
    ToggleHelp,
    /// Pausing, or going on.
    TogglePause,
    /// Seeing more at once.
    WidenView,
    /// Seeing less at once.
    NarrowView,
    /// Showing or hiding what frames take.
    ToggleStats,
    /// Leaving the game.
    Leave,
}

/// How the minimap can be changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum MapChange {
    Larger,
    Smaller,
    North,
    South,
    West,
    East,
    /// Around the player, in its usual size.
    Center,
}

impl Action {
    /// Every action: its name in a file, what it does in a word or two, and itself.
    pub(crate) const ALL: [(&'static str, &'static str, Self); 30] = [
        ("forward", "walk", Self::Want(Intent::Forward)),
        ("back", "walk back", Self::Want(Intent::Back)),
        ("strafe-left", "strafe left", Self::Want(Intent::StrafeLeft)),
        ("strafe-right", "strafe right", Self::Want(Intent::StrafeRight)),
        ("turn-left", "turn left", Self::Want(Intent::TurnLeft)),
        ("turn-right", "turn right", Self::Want(Intent::TurnRight)),
        ("run", "run while held", Self::Want(Intent::Run)),
        ("open", "open a door", Self::Want(Intent::Open)),
        ("jump", "jump, or open", Self::Want(Intent::Jump)),
        ("duck", "duck while held", Self::Want(Intent::Duck)),
        ("look-up", "look up", Self::Want(Intent::LookUp)),
        ("look-down", "look down", Self::Want(Intent::LookDown)),
        ("look-ahead", "look ahead", Self::Want(Intent::LookAhead)),
        ("toggle-run", "run, on and off", Self::ToggleRun),
        ("toggle-duck", "duck, on and off", Self::ToggleDuck),
        ("mouse", "turn by mouse", Self::ToggleMouse),
        ("minimap", "map", Self::ToggleMinimap),
        ("map-larger", "larger map", Self::ChangeMap(MapChange::Larger)),
        ("map-smaller", "smaller map", Self::ChangeMap(MapChange::Smaller)),
        ("map-north", "move it north", Self::ChangeMap(MapChange::North)),
        ("map-south", "move it south", Self::ChangeMap(MapChange::South)),
        ("map-west", "move it west", Self::ChangeMap(MapChange::West)),
        ("map-east", "move it east", Self::ChangeMap(MapChange::East)),
        ("map-center", "map around you", Self::ChangeMap(MapChange::Center)),
        ("help", "this help", Self::ToggleHelp),
        ("pause", "pause", Self::TogglePause),
        ("wider", "wider view", Self::WidenView),
        ("narrower", "narrower view", Self::NarrowView),
        ("stats", "frames and link", Self::ToggleStats),
        ("leave", "leave", Self::Leave),
    ];

    /// The action of that name.
    pub(super) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|&(known, ..)| known == name).map(|(.., action)| action)
    }

    /// Whether nobody wants both at once.
    pub(super) fn opposes(self, other: Self) -> bool {
        use Intent::{Back, Forward, LookDown, LookUp, StrafeLeft, StrafeRight};
        use Intent::{TurnLeft, TurnRight};
        let pairs =
            [(Forward, Back), (StrafeLeft, StrafeRight), (TurnLeft, TurnRight), (LookUp, LookDown)];
        pairs.into_iter().any(|(one, another)| {
            (self, other) == (Self::Want(one), Self::Want(another))
                || (other, self) == (Self::Want(one), Self::Want(another))
        })
    }
}

/// Which key does what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bindings {
    /// Each key once.
    keys: Vec<(Key, Action)>,
}

impl Default for Bindings {
    /// For QWERTY keyboards.
    fn default() -> Self {
        Self::with_letters(&Letters { forward: 'w', strafe_left: 'a', leave: 'q' })
    }
}

/// The keys in which the presets differ.
struct Letters {
    forward: char,
    strafe_left: char,
    leave: char,
}

/// The name of a preset, and what makes it.
pub(super) type Preset = (&'static str, fn() -> Bindings);

/// The presets, the default first.
pub(super) const PRESETS: [Preset; 2] =
    [("qwerty", Bindings::default), ("azerty", Bindings::azerty)];

impl Bindings {
    /// For AZERTY keyboards: Z, Q, S and D lie where W, A, S and D do on others; A leaves.
    pub fn azerty() -> Self {
        Self::with_letters(&Letters { forward: 'z', strafe_left: 'q', leave: 'a' })
    }

    /// Every action's keys, and what it does in a word or two, in the order of [`Action::ALL`].
    #[cfg(feature = "cli")]
    pub(crate) fn described(&self) -> impl Iterator<Item = (String, &'static str)> {
        Action::ALL.into_iter().map(|(_, does, action)| {
            let keys: Vec<String> = self.keys(action).map(|key| key.to_string()).collect();
            (keys.join(" "), does)
        })
    }

    fn with_letters(letters: &Letters) -> Self {
        let keys = vec![
            (Key::Char(letters.forward), Action::Want(Intent::Forward)),
            (Key::Up, Action::Want(Intent::Forward)),
            (Key::Char('s'), Action::Want(Intent::Back)),
            (Key::Down, Action::Want(Intent::Back)),
            (Key::Char(letters.strafe_left), Action::Want(Intent::StrafeLeft)),
            (Key::Char('d'), Action::Want(Intent::StrafeRight)),
            (Key::Left, Action::Want(Intent::TurnLeft)),
            (Key::Right, Action::Want(Intent::TurnRight)),
            (Key::Shift, Action::Want(Intent::Run)),
            (Key::Char(' '), Action::Want(Intent::Jump)),
            (Key::Char('e'), Action::Want(Intent::Open)),
            // Not Control: with another key held, it is a command to the terminal.
            (Key::Char('c'), Action::Want(Intent::Duck)),
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
            (Key::Char(letters.leave), Action::Leave),
            (Key::Escape, Action::Leave),
        ];
        Self { keys }.in_order()
    }

    /// The same, but that `bound` are the keys of the actions in `rebound`, and of no others.
    pub(super) fn rebound(mut self, rebound: &[Action], bound: Vec<(Key, Action)>) -> Self {
        let taken = |key| bound.iter().any(|&(bound, _)| bound == key);
        self.keys.retain(|&(key, action)| !rebound.contains(&action) && !taken(key));
        self.keys.extend(bound);
        self.in_order()
    }

    /// In the order of their actions.
    fn in_order(mut self) -> Self {
        let place = |action| Action::ALL.iter().position(|&(.., known)| known == action);
        self.keys.sort_by_key(|&(_, action)| place(action));
        self
    }

    /// What `key` does.
    pub(crate) fn action(&self, key: Key) -> Option<Action> {
        self.keys.iter().find(|&&(bound, _)| bound == key).map(|&(_, action)| action)
    }

    /// `event`, of the key that does something: where the one pressed does nothing, of the one at its
    /// place on a US keyboard.
    pub(crate) fn resolve(&self, event: KeyEvent) -> KeyEvent {
        let base = event.base.filter(|_| self.action(event.key).is_none());
        KeyEvent { key: base.unwrap_or(event.key), ..event }
    }

    /// The keys that do `action`, in the order in which they were bound.
    pub(crate) fn keys(&self, action: Action) -> impl Iterator<Item = Key> {
        self.keys.iter().filter(move |&&(_, bound)| bound == action).map(|&(key, _)| key)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::{Modifiers, Phase};
    use crate::tui::Configuration;

    #[test]
    fn every_action_has_a_key_in_every_preset() {
        for (preset, bindings) in PRESETS {
            for (name, _, action) in Action::ALL {
                assert!(bindings().keys(action).next().is_some(), "{name} in {preset}");
            }
        }
    }

    #[test]
    fn a_key_does_what_it_types_and_else_what_its_place_does() {
        let event = |key, base| KeyEvent {
            key: Key::Char(key),
            base: Some(Key::Char(base)),
            modifiers: Modifiers::default(),
            phase: Phase::Press,
        };
        let text = "[keys]\nopen = \"ц\"";
        let cyrillic = Configuration::parse(text, "config.toml").unwrap().bindings;
        assert_eq!(cyrillic.resolve(event('ц', 'w')).key, Key::Char('ц'));
        assert_eq!(cyrillic.resolve(event('ф', 'a')).key, Key::Char('a'));
        assert_eq!(Bindings::default().resolve(event('ц', 'w')).key, Key::Char('w'));
    }
}

//! Key bindings: the actions, and presets of keys for them.

use crate::game::Intent;
use crate::sort;
use crate::terminal::{Key, KeyEvent};

/// An action that a key can be bound to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// Want something for as long as the key is held.
    Want(Intent),
    /// Run until the key is pressed again.
    ToggleRun,
    /// Duck until the key is pressed again.
    ToggleDuck,
    /// Turn and tilt by the mouse, or stop that.
    ToggleMouse,
    /// Walk until this key or a key to walk is pressed.
    ToggleWalkOn,
    /// Show or hide the minimap.
    ToggleMinimap,
    /// Show the minimap larger or smaller, or another part of it.
    ChangeMap(MapChange),
    /// Show or hide the keys.
    ToggleHelp,
    /// Pause, or continue.
    TogglePause,
    /// Widen the field of view.
    WidenView,
    /// Narrow the field of view.
    NarrowView,
    /// Show or hide the figures of frames and the link.
    ToggleStats,
    /// Show or hide a dot in the middle of the picture.
    ToggleCrosshair,
    /// Show or hide the compass.
    ToggleCompass,
    /// Show or hide the best run.
    ToggleGhost,
    /// Leave the game.
    Leave,
}

/// A change of the minimap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapChange {
    Larger,
    Smaller,
    North,
    South,
    West,
    East,
    /// Show the player in the middle, at the usual size.
    Center,
}

impl Action {
    /// Every action with its name in a file and a short description.
    pub(crate) const ALL: [(&'static str, &'static str, Self); 42] = [
        ("forward", "walk", Self::Want(Intent::Forward)),
        ("back", "walk back", Self::Want(Intent::Back)),
        ("strafe-left", "strafe left", Self::Want(Intent::StrafeLeft)),
        ("strafe-right", "strafe right", Self::Want(Intent::StrafeRight)),
        ("turn-left", "turn left", Self::Want(Intent::TurnLeft)),
        ("turn-right", "turn right", Self::Want(Intent::TurnRight)),
        ("fine-left", "turn left by 5°", Self::Want(Intent::FineLeft)),
        ("fine-right", "turn right by 5°", Self::Want(Intent::FineRight)),
        ("about-face", "turn around", Self::Want(Intent::AboutFace)),
        ("walk-on", "keep walking", Self::ToggleWalkOn),
        ("run", "run while held", Self::Want(Intent::Run)),
        ("open", "open or use", Self::Want(Intent::Open)),
        ("jump", "jump, or open", Self::Want(Intent::Jump)),
        ("duck", "duck while held", Self::Want(Intent::Duck)),
        ("strike", "strike", Self::Want(Intent::Strike)),
        ("throw", "throw a pebble", Self::Want(Intent::Throw)),
        ("shoot", "shoot a dart", Self::Want(Intent::Shoot)),
        ("smoke", "throw smoke", Self::Want(Intent::Smoke)),
        ("lamp", "light, put out", Self::Want(Intent::Lamp)),
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
        ("crosshair", "crosshair", Self::ToggleCrosshair),
        ("compass", "compass", Self::ToggleCompass),
        ("ghost", "best run", Self::ToggleGhost),
        ("stats", "frames and link", Self::ToggleStats),
        ("leave", "leave", Self::Leave),
    ];

    /// The action with that name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|&(known, ..)| known == name).map(|(.., action)| action)
    }

    /// Whether the actions exclude each other.
    pub(crate) fn opposes(self, other: Self) -> bool {
        matches!((self, other), (Self::Want(one), Self::Want(other)) if one.opposes(other))
    }
}

/// The actions of all keys.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bindings {
    /// Each key occurs once.
    keys: Vec<(Key, Action)>,
}

impl Bindings {
    /// The keys of every action with a short description, in the order of [`Action::ALL`].
    #[cfg(feature = "cli")]
    pub(crate) fn described(&self) -> impl Iterator<Item = (String, &'static str)> {
        Action::ALL.into_iter().map(|(_, does, action)| {
            let keys: Vec<String> = self.keys(action).map(|key| key.to_string()).collect();
            (keys.join(" "), does)
        })
    }

    /// Replaces the keys of the actions in `rebound` by `bound`. Keys in `bound` are removed from
    /// other actions.
    pub(crate) fn rebound(mut self, rebound: &[Action], bound: Vec<(Key, Action)>) -> Self {
        let is_bound = |key| bound.iter().any(|&(bound, _)| bound == key);
        self.keys.retain(|&(key, action)| !rebound.contains(&action) && !is_bound(key));
        self.keys.extend(bound);
        self.in_order()
    }

    /// The bindings without those of `keys`.
    #[must_use]
    pub fn without(mut self, keys: &[Key]) -> Self {
        self.keys.retain(|(key, _)| !keys.contains(key));
        self
    }

    /// Sorts the keys by their actions.
    fn in_order(mut self) -> Self {
        let index = |action| Action::ALL.iter().position(|&(.., known)| known == action);
        sort::by_key(&mut self.keys, |&(_, action)| index(action));
        self
    }

    /// The action of `key`.
    pub fn action(&self, key: Key) -> Option<Action> {
        self.keys.iter().find(|&&(bound, _)| bound == key).map(|&(_, action)| action)
    }

    /// The event with the key whose action counts: the pressed one, or if that has no action, the
    /// key at its position on a US keyboard.
    pub fn resolve(&self, event: KeyEvent) -> KeyEvent {
        let base = event.base.filter(|_| self.action(event.key).is_none());
        KeyEvent { key: base.unwrap_or(event.key), ..event }
    }

    /// The keys of `action`, in the order in which they were bound.
    pub(crate) fn keys(&self, action: Action) -> impl Iterator<Item = Key> {
        self.keys.iter().filter(move |&&(_, bound)| bound == action).map(|&(key, _)| key)
    }
}

/// A keyboard that keys are for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Preset {
    #[default]
    Qwerty,
    /// Z, Q, S and D are where W, A, S and D are on QWERTY keyboards; A leaves.
    Azerty,
    /// For users of vi: H and L turn, J and K walk, A and D strafe, Z lights the lamp.
    Hjkl,
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

impl Preset {
    /// The bindings for that keyboard.
    pub(crate) fn bindings(self) -> Bindings {
        let qwerty = Letters {
            forward: 'w',
            back: 's',
            strafe_left: 'a',
            leave: 'q',
            lamp: 'l',
            turns: None,
        };
        Bindings::with_letters(&match self {
            Self::Qwerty => qwerty,
            Self::Azerty => Letters { forward: 'z', strafe_left: 'q', leave: 'a', ..qwerty },
            Self::Hjkl => {
                Letters { forward: 'k', back: 'j', lamp: 'z', turns: Some(['h', 'l']), ..qwerty }
            }
        })
    }
}

impl Default for Bindings {
    /// The bindings for QWERTY keyboards.
    fn default() -> Self {
        Preset::default().bindings()
    }
}

impl Bindings {
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
            // Rejected: Control. With another key held, it is a command to the terminal.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::Configuration;
    use crate::terminal::{Modifiers, Phase};

    #[test]
    fn every_action_has_a_key_in_every_preset() {
        for preset in [Preset::Qwerty, Preset::Azerty, Preset::Hjkl] {
            for (name, _, action) in Action::ALL {
                assert!(preset.bindings().keys(action).next().is_some(), "{name} in {preset:?}");
            }
        }
    }

    #[test]
    fn the_character_of_a_key_counts_before_its_position() {
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

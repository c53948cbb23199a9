//! Which key does what: presets, and a file to change them.
//!
//! ```toml
//! preset = "azerty"            # or "qwerty", or "hjkl"
//!
//! [keys]                       # the keys of an action, in place of the preset's
//! forward = ["z", "up"]
//! toggle-run = "c"
//! ```
//!
//! A key that the file gives to an action is taken from the one that the preset gave it to; one that
//! it gives to two actions is a fault.

mod presets;

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use crate::fault::{Fault, Faults, document, nearest, quoted};
use crate::game::Intent;
use crate::terminal::Key;
use presets::PRESETS;

/// What a key can do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Action {
    /// Wanting something for as long as the key is held.
    Want(Intent),
    /// Running until it is pressed again.
    ToggleRun,
    /// Ducking until it is pressed again.
    ToggleDuck,
    /// Walking on until it, or a key to walk, is pressed.
    ToggleWalkOn,
    /// Showing or hiding the minimap.
    ToggleMinimap,
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

impl Action {
    /// Every action: its name in a file, what it does in a word or two, and itself.
    pub(crate) const ALL: [(&'static str, &'static str, Self); 26] = [
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
        ("open", "open a door", Self::Want(Intent::Open)),
        ("jump", "jump, or open", Self::Want(Intent::Jump)),
        ("duck", "duck while held", Self::Want(Intent::Duck)),
        ("look-up", "look up", Self::Want(Intent::LookUp)),
        ("look-down", "look down", Self::Want(Intent::LookDown)),
        ("look-ahead", "look ahead", Self::Want(Intent::LookAhead)),
        ("toggle-run", "run, on and off", Self::ToggleRun),
        ("toggle-duck", "duck, on and off", Self::ToggleDuck),
        ("minimap", "map", Self::ToggleMinimap),
        ("help", "this help", Self::ToggleHelp),
        ("pause", "pause", Self::TogglePause),
        ("wider", "wider view", Self::WidenView),
        ("narrower", "narrower view", Self::NarrowView),
        ("stats", "frames and link", Self::ToggleStats),
        ("leave", "leave", Self::Leave),
    ];

    fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|&(known, ..)| known == name).map(|(.., action)| action)
    }

    /// Whether nobody wants both at once.
    pub(super) fn opposes(self, other: Self) -> bool {
        matches!((self, other), (Self::Want(one), Self::Want(other)) if one.opposes(other))
    }
}

/// Which key does what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bindings {
    /// Each key once.
    keys: Vec<(Key, Action)>,
}

impl Bindings {
    /// Reads a file of bindings, which faults call `name`.
    ///
    /// # Errors
    /// Everything that is wrong with the file.
    pub fn parse(text: &str, name: &str) -> Result<Self, Faults> {
        let mut faults = Vec::new();
        let document = document::parse(text, &mut faults);
        let bindings =
            if faults.is_empty() { read(&document, &mut faults) } else { Self::default() };
        if faults.is_empty() { Ok(bindings) } else { Err(Faults::new(name, text, faults)) }
    }

    /// What `key` does.
    pub(crate) fn action(&self, key: Key) -> Option<Action> {
        self.keys.iter().find(|&&(bound, _)| bound == key).map(|&(_, action)| action)
    }

    /// The keys that do `action`, in the order in which they were bound.
    pub(crate) fn keys(&self, action: Action) -> impl Iterator<Item = Key> {
        self.keys.iter().filter(move |&&(_, bound)| bound == action).map(|&(key, _)| key)
    }
}

fn read(document: &DeTable, faults: &mut Vec<Fault>) -> Bindings {
    let mut bindings = Bindings::default();
    let mut bound = Vec::new();
    for entry in document::entries(document) {
        match entry.key {
            "preset" => match entry.string("preset = \"azerty\"", faults) {
                Some("azerty") => bindings = Bindings::azerty(),
                Some("hjkl") => bindings = Bindings::hjkl(),
                Some("qwerty") | None => {}
                Some(other) => faults.push(unknown_preset(other, entry.value_place)),
            },
            "keys" => {
                if let Some(table) = entry.table("[keys]", faults) {
                    bound = read_keys(table, faults);
                }
            }
            _ => faults.push(entry.unknown_key("a file of key bindings", &["preset", "keys"])),
        }
    }
    let rebinds = |action| bound.iter().any(|&(_, bound)| bound == action);
    let taken = |key| bound.iter().any(|&(bound, _)| bound == key);
    bindings.keys.retain(|&(key, action)| !rebinds(action) && !taken(key));
    bindings.keys.extend(bound);
    bindings
}

/// What the table `[keys]` binds.
fn read_keys(table: &DeTable, faults: &mut Vec<Fault>) -> Vec<(Key, Action)> {
    const EXAMPLE: &str = "forward = [\"z\", \"up\"]";
    let names = Action::ALL.map(|(name, ..)| name);
    let mut bound: Vec<(Key, Action)> = Vec::new();
    for entry in document::entries(table) {
        let Some(action) = Action::named(entry.key) else {
            faults.push(entry.unknown_key("the table of keys", &names));
            continue;
        };
        let values = match entry.value {
            DeValue::Array(values) => {
                values.iter().map(|value| (value.get_ref(), value.span())).collect()
            }
            single => vec![(single, entry.value_place.clone())],
        };
        for (value, place) in values {
            let Some(name) = value.as_str() else {
                faults.push(entry.wrong_type("the name of a key, or a list of names", EXAMPLE));
                break;
            };
            match name.parse::<Key>() {
                Err(error) => {
                    faults.push(Fault::new(place, error.to_string()).label("unknown key"));
                }
                Ok(key) if bound.iter().any(|&(other, to)| other == key && to != action) => {
                    faults.push(bound_twice(key, place));
                }
                Ok(key) => bound.push((key, action)),
            }
        }
    }
    bound
}

fn unknown_preset(name: &str, place: Range<usize>) -> Fault {
    let help = match nearest(name, &PRESETS) {
        Some(meant) => format!("the nearest preset is {}", quoted(meant)),
        None => format!("the presets are {}", PRESETS.join(", ")),
    };
    Fault::new(place, format!("there is no preset {}", quoted(name))).help(help)
}

fn bound_twice(key: Key, place: Range<usize>) -> Fault {
    Fault::new(place, format!("the key {} is bound to two actions", quoted(&key.to_string())))
        .label("another action has it too")
        .help("give each key to one action")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faults(text: &str) -> String {
        Bindings::parse(text, "config.toml").unwrap_err().to_string()
    }

    #[test]
    fn an_empty_file_changes_nothing() {
        assert_eq!(Bindings::parse("", "config.toml").unwrap(), Bindings::default());
    }

    #[test]
    fn every_action_has_a_key_in_every_preset() {
        for bindings in [Bindings::default(), Bindings::azerty(), Bindings::hjkl()] {
            for (name, _, action) in Action::ALL {
                assert!(bindings.keys(action).next().is_some(), "{name}");
            }
        }
    }

    #[test]
    fn a_file_replaces_the_keys_of_an_action() {
        let text = "preset = \"azerty\"\n[keys]\nforward = [\"e\", \"UP\"]\nleave = \"m\"\n";
        let bindings = Bindings::parse(text, "config.toml").unwrap();
        assert_eq!(bindings.action(Key::Char('e')), Some(Action::Want(Intent::Forward)));
        assert_eq!(bindings.action(Key::Char('z')), None);
        assert_eq!(bindings.action(Key::Char('q')), Some(Action::Want(Intent::StrafeLeft)));
        assert_eq!(bindings.action(Key::Char('m')), Some(Action::Leave));
        assert_eq!(bindings.keys(Action::ToggleMinimap).collect::<Vec<_>>(), [Key::Tab]);
    }

    #[test]
    fn every_fault_is_named_with_its_place() {
        let text = r#"
preset = "azertie"
colour = 3
[keys]
foward = "w"
back = "hyperspace"
run = 7
wider = "x"
narrower = ["y", "x"]
"#;
        insta::assert_snapshot!(faults(text));
        insta::assert_snapshot!(faults("[keys"));
    }
}

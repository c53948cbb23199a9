//! The table `[keys]`: the keys that a file gives to actions.
//!
//! A key that the file gives to an action is removed from its action in the preset. A key given to
//! two actions is a fault. An empty list leaves an action without a key.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use crate::app::bindings::Action;
use crate::fault::document::Entry;
use crate::fault::{Fault, quoted};
use crate::terminal::Key;

/// The bindings of the table.
#[derive(Default)]
pub(crate) struct Bound {
    /// The actions in the table.
    pub(crate) actions: Vec<Action>,
    pub(crate) keys: Vec<(Key, Action)>,
}

/// Reads the table `[keys]`.
pub(crate) fn read(owner: &Entry<'_, '_>, table: &DeTable<'_>) -> Bound {
    const EXAMPLE: &str = "forward = [\"z\", \"up\"]";
    let names = Action::ALL.map(|(name, ..)| name);
    let mut bound = Bound::default();
    for entry in owner.entries(table) {
        let Some(action) = Action::named(entry.key) else {
            entry.faults.push(entry.unknown_key("the table of keys", &names));
            continue;
        };
        bound.actions.push(action);
        let values = match entry.value {
            DeValue::Array(values) => {
                values.iter().map(|value| (value.get_ref(), value.span())).collect()
            }
            single => vec![(single, entry.value_place.clone())],
        };
        for (value, place) in values {
            let Some(name) = value.as_str() else {
                entry
                    .faults
                    .push(entry.wrong_type("the name of a key, or a list of names", EXAMPLE));
                break;
            };
            match name.parse::<Key>() {
                Err(error) => {
                    entry.faults.push(Fault::new(place, error.to_string()).label("unknown key"));
                }
                Ok(key) if bound.keys.iter().any(|&(other, to)| other == key && to != action) => {
                    entry.faults.push(bound_twice(key, place));
                }
                Ok(key) => bound.keys.push((key, action)),
            }
        }
    }
    bound
}

fn bound_twice(key: Key, place: Range<usize>) -> Fault {
    Fault::new(place, format!("the key {} is bound to two actions", quoted(&key.to_string())))
        .label("another action has it too")
        .help("give each key to one action")
}

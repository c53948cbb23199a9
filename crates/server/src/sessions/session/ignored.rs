//! The players whose talk a visitor does not see.

use std::collections::BTreeSet;

use crate::accounts::{AccountSettings, Name};
use crate::line::Line;

/// The ignored players. Names that look alike count as the same.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ignored {
    names: Vec<Name>,
    /// The [keys](Name::keys) of all names, so that each line costs one look-up.
    keys: BTreeSet<String>,
}

impl Ignored {
    pub(crate) fn new(names: Vec<Name>) -> Self {
        let keys = names.iter().flat_map(Name::keys).collect();
        Self { names, keys }
    }

    pub(crate) fn names(&self) -> &[Name] {
        &self.names
    }

    pub(crate) fn contains(&self, name: &Line) -> bool {
        let has = |key: &String| self.keys.contains(key);
        !self.keys.is_empty() && Name::kept(name.as_str()).keys().iter().any(has)
    }

    /// Adds a player. Returns false if the list is full.
    pub(crate) fn add(&mut self, name: &Line) -> bool {
        if self.contains(name) {
            return true;
        }
        let has_room = self.names.len() < AccountSettings::MAX_IGNORED;
        if has_room {
            self.names.push(Name::kept(name.as_str()));
            *self = Self::new(std::mem::take(&mut self.names));
        }
        has_room
    }

    /// Removes a player. Returns false if they were not ignored.
    pub(crate) fn remove(&mut self, name: &Line) -> bool {
        let (count, name) = (self.names.len(), Name::kept(name.as_str()));
        self.names.retain(|other| !other.looks_like(&name));
        *self = Self::new(std::mem::take(&mut self.names));
        self.names.len() < count
    }
}

//! The levels that rooms can be in: the built-in ones, and the host's own.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::map::builtin;
use crate::world::World;

/// Levels by name, in their order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Catalog {
    names: Vec<String>,
    worlds: BTreeMap<String, Arc<World>>,
}

impl Catalog {
    /// The built-in levels.
    pub(crate) fn builtin() -> Self {
        let mut catalog = Self::default();
        for level in builtin::LEVELS {
            if let Ok(world) = level.world() {
                catalog.add(level.name, world);
            }
        }
        catalog
    }

    /// Adds a level. One with the same name is replaced.
    pub(crate) fn add(&mut self, name: &str, world: World) {
        if self.worlds.insert(name.to_owned(), Arc::new(world)).is_none() {
            self.names.push(name.to_owned());
        }
    }

    /// The names, in their order.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }

    /// The level with that name.
    pub(crate) fn world(&self, name: &str) -> Option<&Arc<World>> {
        self.worlds.get(name)
    }

    /// The title of a level, or else its name.
    pub(crate) fn title<'a>(&'a self, name: &'a str) -> &'a str {
        self.world(name).map(|world| world.title()).filter(|it| !it.is_empty()).unwrap_or(name)
    }

    /// The name of the level after `name`, which is the first after the last.
    pub(crate) fn after<'a>(&'a self, name: &'a str) -> &'a str {
        let index = self.names.iter().position(|it| it == name);
        let next = index.map_or(0, |index| (index + 1) % self.names.len());
        self.names.get(next).map_or(name, String::as_str)
    }
}

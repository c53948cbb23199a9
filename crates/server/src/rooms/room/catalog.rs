//! The levels that rooms can be in: the built-in ones, and the host's own.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::Mode;
use crate::rooms::maps::HostMaps;
use cellcaster::app::store::name_in_map_key;
use cellcaster::map::builtin;
use cellcaster::world::World;

/// Levels by name, in their order. The name of a host's map is its key, which differs between two texts of the map.
#[derive(Clone, Debug, Default)]
pub(crate) struct Catalog {
    pub(crate) names: Vec<String>,
    levels: BTreeMap<String, Listed>,
}

#[derive(Clone, Debug)]
struct Listed {
    /// The name for people, without a hash.
    short: String,
    world: Arc<World>,
    has_exit: bool,
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

    /// The built-in levels, then the host's maps.
    pub(crate) fn with(maps: &HostMaps) -> Self {
        let mut catalog = Self::builtin();
        for map in &maps.0 {
            catalog.list(&map.key, &map.name, Arc::clone(&map.world));
        }
        catalog
    }

    /// Adds a level, or replaces the one with the same name.
    pub(crate) fn add(&mut self, name: &str, world: World) {
        self.list(name, name, Arc::new(world));
    }

    /// The keys of the host's own maps.
    pub(crate) fn map_keys(&self) -> impl Iterator<Item = &str> {
        let names = self.names.iter().map(String::as_str);
        names.filter(|name| name_in_map_key(name).is_some())
    }

    /// The level with that name.
    pub(crate) fn world(&self, name: &str) -> Option<&Arc<World>> {
        self.levels.get(name).map(|level| &level.world)
    }

    /// The name of a level for people, which is the name of its file.
    pub(crate) fn short<'a>(&'a self, name: &'a str) -> &'a str {
        self.levels.get(name).map_or(name, |level| level.short.as_str())
    }

    /// The name of the level that people call `short`.
    pub(crate) fn named<'a>(&'a self, short: &'a str) -> Option<&'a str> {
        let level = |name: &&String| self.short(name) == short;
        self.names.iter().find(level).map(String::as_str)
    }

    /// The title of a level, or else its name.
    pub(crate) fn title<'a>(&'a self, name: &'a str) -> &'a str {
        let title = self.world(name).map(|world| world.title()).filter(|title| !title.is_empty());
        title.unwrap_or_else(|| self.short(name))
    }

    /// Whether a level can be played in `mode`: where an exit ends a round, there is one.
    pub(crate) fn suits(&self, name: &str, mode: Mode) -> bool {
        let level = self.levels.get(name);
        level.is_some_and(|level| level.has_exit || !mode.moves_on())
    }

    /// The name of the level with an exit after `name`. After the last one comes the first. Maps of the host follow
    /// maps of the host only, so that rooms in built-in levels go on alike on hosts with other maps.
    pub(crate) fn after<'a>(&'a self, name: &'a str) -> &'a str {
        let index = self.names.iter().position(|it| it == name).map_or(0, |index| index + 1);
        let (before, after) = self.names.split_at(index);
        let is_of_host = |name: &str| name_in_map_key(name).is_some();
        let follows = |next: &&String| {
            let has_exit = self.levels.get(*next).is_some_and(|it| it.has_exit);
            has_exit && is_of_host(next) == is_of_host(name)
        };
        after.iter().chain(before).find(follows).map_or(name, String::as_str)
    }

    fn list(&mut self, name: &str, short: &str, world: Arc<World>) {
        let has_exit = world.has_exit();
        let listed = Listed { short: short.to_owned(), world, has_exit };
        if self.levels.insert(name.to_owned(), listed).is_none() {
            self.names.push(name.to_owned());
        }
    }
}

/// The reason why a recorded room has no level, and what to do.
pub(crate) fn no_level(name: &str) -> String {
    match name_in_map_key(name) {
        Some(map) => format!(
            "it was recorded in the map {map}.toml, which is not given or has changed since (it was {name}); \
             name the map or its folder"
        ),
        None => format!("there is no level called {name}"),
    }
}

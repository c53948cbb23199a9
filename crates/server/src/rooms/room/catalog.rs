//! The levels that rooms can use: the built-in ones, then the host's own, and the daily level of each day.
//!
//! A daily level is not listed. It is generated when its name is first used, and kept while it is one of the last
//! [`MAX_DAILIES`] that were generated.

use std::borrow::Cow;
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, OnceLock};

use super::Mode;
use super::ways::ExitWays;
use crate::accounts::Day;
use crate::lock::locked;
use crate::queue::push_within;
use crate::rooms::maps::HostMaps;
use cellcaster::app::store::name_in_map_key;
use cellcaster::map::builtin;
use cellcaster::world::World;

/// The number of daily levels that are kept: of today, of yesterday, and of a host with another clock.
const MAX_DAILIES: usize = 3;

/// Levels by name, in lobby order. The name of a host's map is its key, which changes with the text of the map.
#[derive(Debug, Default)]
pub(crate) struct Catalog {
    pub(crate) names: Vec<String>,
    levels: BTreeMap<String, Arc<Level>>,
    /// Locked while a daily level is generated, so that each is generated once.
    dailies: Mutex<VecDeque<(Day, Arc<Level>)>>,
}

#[derive(Debug)]
struct Level {
    /// The name shown to people, without the hash.
    short: String,
    world: Arc<World>,
    has_exit: bool,
    /// Found when they are first needed.
    ways: OnceLock<Arc<ExitWays>>,
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

    /// Returns true if there is a level with this name. Generates nothing.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.levels.contains_key(name) || Day::of_level(name).is_some()
    }

    /// The level with this name.
    pub(crate) fn world(&self, name: &str) -> Option<Arc<World>> {
        self.level(name).map(|level| Arc::clone(&level.world))
    }

    /// The ways to the exit of a level; `None` if there is no such level.
    pub(crate) fn exit_ways(&self, name: &str) -> Option<Arc<ExitWays>> {
        let level = self.level(name)?;
        Some(Arc::clone(level.ways.get_or_init(|| Arc::new(ExitWays::of(&level.world)))))
    }

    /// The name of a level as shown to people: the name of its file.
    pub(crate) fn short<'a>(&'a self, name: &'a str) -> &'a str {
        self.levels.get(name).map_or(name, |level| level.short.as_str())
    }

    /// The name of the level that is shown as `short`.
    pub(crate) fn named<'a>(&'a self, short: &'a str) -> Option<&'a str> {
        let level = |name: &&String| self.short(name) == short;
        self.names.iter().find(level).map(String::as_str)
    }

    /// The title of a level, or its name if it has no title.
    pub(crate) fn title<'a>(&'a self, name: &'a str) -> Cow<'a, str> {
        if let Some(day) = Day::of_level(name) {
            return day.title().into();
        }
        let title = self.levels.get(name).map(|level| level.world.title());
        title.filter(|title| !title.is_empty()).unwrap_or_else(|| self.short(name)).into()
    }

    /// Returns true if a level can be played in `mode`: a mode that ends at the exit needs a level with one.
    pub(crate) fn suits(&self, name: &str, mode: Mode) -> bool {
        let level = self.levels.get(name);
        level.map_or(self.has(name), |level| level.has_exit || !mode.moves_on())
    }

    /// The name of the next level with an exit after `name`, wrapping around at the end. After a map of the
    /// host comes another map of the host, and after a built-in level another built-in one. Rooms in built-in
    /// levels therefore continue alike on hosts with different maps.
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

    fn level(&self, name: &str) -> Option<Arc<Level>> {
        self.levels.get(name).cloned().or_else(|| self.daily(Day::of_level(name)?))
    }

    fn daily(&self, day: Day) -> Option<Arc<Level>> {
        locked(&self.dailies, |dailies| {
            if let Some((_, level)) = dailies.iter().find(|(known, _)| *known == day) {
                return Some(Arc::clone(level));
            }
            let level = Arc::new(Level::new(&day.level(), Arc::new(day.world().ok()?)));
            push_within(dailies, (day, Arc::clone(&level)), MAX_DAILIES);
            Some(level)
        })
    }

    fn list(&mut self, name: &str, short: &str, world: Arc<World>) {
        let level = Arc::new(Level::new(short, world));
        if self.levels.insert(name.to_owned(), level).is_none() {
            self.names.push(name.to_owned());
        }
    }
}

impl Level {
    fn new(short: &str, world: Arc<World>) -> Self {
        let has_exit = world.has_exit();
        Self { short: short.to_owned(), world, has_exit, ways: OnceLock::new() }
    }
}

/// The reason why a recorded room's level is missing, and how to fix it.
pub(crate) fn no_level(name: &str) -> String {
    match name_in_map_key(name) {
        Some(map) => format!(
            "it was recorded in the map {map}.toml ({name}), which was not given or has changed: name the \
             original map or its folder"
        ),
        None => format!("there is no level called {name}"),
    }
}

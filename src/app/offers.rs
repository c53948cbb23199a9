//! What the title screen offers from outside of the program: map files, the date, and chance.
//!
//! The app knows neither files nor the date; its caller does.

use std::fmt;

use crate::map::Level;

/// What the title screen offers beside the built-in levels.
#[derive(Default)]
pub struct Offers {
    /// Finds the player's own maps. It is called when the player asks for them.
    pub maps: Option<FindMaps>,
    /// Loads the map file at a path, to go on with a game that was saved in it.
    pub load: Option<LoadMap>,
    /// The date, such as 20261122, whose daily run is offered.
    pub today: Option<u32>,
    /// The seed of the first endless descent. Each further one has the next seed.
    pub seed: u64,
}

/// Returns the player's own maps.
pub type FindMaps = Box<dyn FnMut() -> Vec<OwnMap>>;

/// Loads the map at a path; an error is a sentence for the player.
pub type LoadMap = Box<dyn Fn(&str) -> Result<OwnLevel, String>>;

/// A map of the player's own.
pub struct OwnMap {
    /// Its name in the list.
    pub name: String,
    /// The key of its results in the store, when it was found.
    pub key: String,
    /// Reads it; an error is a sentence for the player.
    pub load: Box<dyn Fn() -> Result<OwnLevel, String>>,
}

/// The level of a map of the player's own.
#[derive(Clone, Debug)]
pub struct OwnLevel {
    /// The level.
    pub level: Level,
    /// The key of its results in the store. It differs from that of the map if the file was changed after it
    /// was found.
    pub key: String,
    /// The absolute path of its file, for [`Offers::load`]. Without it, the map is found by its key.
    pub file: Option<String>,
}

impl fmt::Debug for Offers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Offers").field("maps", &self.maps.is_some()).finish_non_exhaustive()
    }
}

impl fmt::Debug for OwnMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OwnMap").field("name", &self.name).finish_non_exhaustive()
    }
}

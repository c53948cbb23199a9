//! What the title screen offers from outside of the program: map files.
//!
//! The app knows neither files nor the date; its caller does.

use std::fmt;

use crate::map::Level;

/// What the title screen offers beside the built-in levels.
#[derive(Default)]
pub struct Offers {
    /// Finds the player's own maps. It is called when the player asks for them.
    pub maps: Option<FindMaps>,
}

/// Returns the player's own maps.
pub type FindMaps = Box<dyn FnMut() -> Vec<OwnMap>>;

/// A map of the player's own.
pub struct OwnMap {
    /// Its name in the list.
    pub name: String,
    /// Reads it; an error is a sentence for the player.
    pub load: Box<dyn Fn() -> Result<Level, String>>,
}

impl fmt::Debug for Offers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Offers").field("maps", &self.maps.is_some()).finish()
    }
}

impl fmt::Debug for OwnMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OwnMap").field("name", &self.name).finish_non_exhaustive()
    }
}

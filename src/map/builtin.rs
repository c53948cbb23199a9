//! The built-in levels, compiled in from `maps/`.

use super::{NoFiles, parse};
use crate::fault::Faults;
use crate::world::World;

/// A built-in level.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// The name on the command line.
    pub name: &'static str,
    /// The text of its map file, which uses built-in textures only.
    pub text: &'static str,
}

impl Level {
    /// The world that the map describes.
    ///
    /// # Errors
    /// None in practice: the tests read every built-in level.
    pub fn world(&self) -> Result<World, Faults> {
        parse(self.text, self.name, &NoFiles)
    }
}

/// The built-in levels, in playing order: a campaign of twelve.
pub const LEVELS: &[Level] = &[
    Level { name: "cellar", text: include_str!("../../maps/cellar.toml") },
    Level { name: "museum", text: include_str!("../../maps/museum.toml") },
    Level { name: "kennels", text: include_str!("../../maps/kennels.toml") },
    Level { name: "chapel", text: include_str!("../../maps/chapel.toml") },
    Level { name: "archive", text: include_str!("../../maps/archive.toml") },
    Level { name: "cistern", text: include_str!("../../maps/cistern.toml") },
    Level { name: "barracks", text: include_str!("../../maps/barracks.toml") },
    Level { name: "prison", text: include_str!("../../maps/prison.toml") },
    Level { name: "citadel", text: include_str!("../../maps/citadel.toml") },
    Level { name: "clock", text: include_str!("../../maps/clock.toml") },
    Level { name: "treasury", text: include_str!("../../maps/treasury.toml") },
    Level { name: "observatory", text: include_str!("../../maps/observatory.toml") },
];

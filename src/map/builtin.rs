//! The built-in levels, compiled in from `maps/`.

use super::{NoFiles, parse};
use crate::fault::Faults;
use crate::world::World;

/// A built-in level.
#[derive(Clone, Copy, Debug)]
pub struct BuiltinLevel {
    /// The name on the command line.
    pub name: &'static str,
    /// The text of its map file, which uses built-in textures only.
    pub text: &'static str,
}

impl BuiltinLevel {
    /// The world that the map describes.
    ///
    /// # Errors
    /// None in practice: the tests read every built-in level.
    pub fn world(&self) -> Result<World, Faults> {
        parse(self.text, self.name, &NoFiles)
    }
}

/// The built-in levels, in playing order: a campaign of twelve.
pub const LEVELS: &[BuiltinLevel] = &[
    BuiltinLevel { name: "cellar", text: include_str!("../../maps/cellar.toml") },
    BuiltinLevel { name: "museum", text: include_str!("../../maps/museum.toml") },
    BuiltinLevel { name: "kennels", text: include_str!("../../maps/kennels.toml") },
    BuiltinLevel { name: "chapel", text: include_str!("../../maps/chapel.toml") },
    BuiltinLevel { name: "clock", text: include_str!("../../maps/clock.toml") },
    BuiltinLevel { name: "archive", text: include_str!("../../maps/archive.toml") },
    BuiltinLevel { name: "prison", text: include_str!("../../maps/prison.toml") },
    BuiltinLevel { name: "cistern", text: include_str!("../../maps/cistern.toml") },
    BuiltinLevel { name: "barracks", text: include_str!("../../maps/barracks.toml") },
    BuiltinLevel { name: "citadel", text: include_str!("../../maps/citadel.toml") },
    BuiltinLevel { name: "treasury", text: include_str!("../../maps/treasury.toml") },
    BuiltinLevel { name: "observatory", text: include_str!("../../maps/observatory.toml") },
];

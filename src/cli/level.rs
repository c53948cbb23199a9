//! Which level a command is about.

use std::ffi::OsStr;
use std::path::Path;

use super::Error;
use crate::map::{self, builtin};
use crate::world::World;

/// The level that `argument` names: a built-in one or a map file; without it, the first built-in.
pub(super) fn load(argument: Option<&OsStr>) -> Result<World, Error> {
    let world = match argument {
        None => builtin::LEVELS[0].world(),
        Some(argument) => match builtin_level(argument) {
            Some(index) => builtin::LEVELS[index].world(),
            None => map::load(Path::new(argument)),
        },
    };
    world.map_err(Error::from)
}

/// The place among the built-in levels of the one called `name`; a file of that name goes first.
pub(super) fn builtin_level(name: &OsStr) -> Option<usize> {
    let index = builtin::LEVELS.iter().position(|level| name == level.name)?;
    (!Path::new(name).exists()).then_some(index)
}

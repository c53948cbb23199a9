//! `cellcaster check`: all faults of maps.

use std::ffi::OsString;
use std::io::{self, Write};

use super::{Error, level};
use crate::fault::printable;
use crate::game::is_exit_out_of_reach;
use crate::map::Level;

/// Checks all `maps`, even after a fault, and lists the valid ones.
pub(super) fn run(maps: &[OsString]) -> Result<(), Error> {
    let mut wrong = 0_usize;
    for map in maps {
        match level::load(Some(map)) {
            Ok(level) => {
                let name = printable(&map.to_string_lossy());
                writeln!(io::stdout(), "{name}: right, {}", summary(&level))
                    .map_err(|error| Error::of_output(&error))?;
            }
            Err(error) => {
                error.report();
                wrong += 1;
            }
        }
    }
    match (wrong, maps.len()) {
        (0, _) => Ok(()),
        (1, 1) => Err(Error::reported()),
        (_, all) => Err(Error::mistake(format!("{wrong} of {all} maps are wrong, as said above"))),
    }
}

/// The size of a level, and remarks that are not faults.
fn summary(level: &Level) -> String {
    let world = match level {
        Level::Grid(world) => world,
        Level::Space(scene) => return format!("{} bodies", scene.bodies.len()),
    };
    let (width, height) = (world.grid().width(), world.grid().height());
    let note = if is_exit_out_of_reach(world) { UNREACHABLE_EXIT } else { "" };
    format!("{width}×{height} cells{note}")
}

const UNREACHABLE_EXIT: &str =
    "; but nobody can reach an exit: no way leads there from the start, not even by jumps";

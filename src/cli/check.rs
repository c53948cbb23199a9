//! `cellcaster check`: everything that is wrong with maps.

use std::ffi::OsString;
use std::io::{self, Write};

use super::{Error, level};
use crate::game::is_exit_out_of_reach;
use crate::map::Level;

/// Checks all `maps`, whatever the faults of the first, and says which ones are right.
pub(super) fn run(maps: &[OsString]) -> Result<(), Error> {
    let mut wrong = 0_usize;
    for map in maps {
        match level::load(Some(map)) {
            Ok(level) => {
                let size = match &level {
                    Level::Grid(world) => {
                        format!("{}×{} cells", world.grid().width(), world.grid().height())
                    }
                    Level::Space(scene) => format!("{} bodies", scene.bodies.len()),
                };
                let note = note(&level);
                writeln!(io::stdout(), "{}: right, {size}{note}", map.display())
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
        (1, 1) => Err(Error::told()),
        (_, all) => Err(Error::mistake(format!("{wrong} of {all} maps are wrong, as said above"))),
    }
}

/// What the author of a map may want to know that is no fault.
fn note(level: &Level) -> &'static str {
    match level {
        Level::Grid(world) if is_exit_out_of_reach(world) => {
            "; but nobody can reach an exit: no way leads there from the start, not even by jumps"
        }
        _ => "",
    }
}

//! `cellcaster check`: all faults of maps.

use std::io::{self, Write};

use super::arguments::Check;
use super::{Error, level};
use crate::fault::printable;
use crate::game::is_exit_out_of_reach;
use crate::map::Level;

/// Checks all maps, even after a fault, and lists the valid ones.
pub(crate) fn run(options: &Check) -> Result<(), Error> {
    let (mut wrong, mut remarks) = (0_usize, 0_usize);
    for map in &options.maps {
        match level::load(Some(map)) {
            Ok(level) => {
                let name = printable(&map.to_string_lossy());
                let (size, remark) = (size(&level), remark(&level));
                remarks += usize::from(remark.is_some());
                let note = remark.map(|it| format!("; {it}")).unwrap_or_default();
                writeln!(io::stdout(), "{name}: right, {size}{note}")
                    .map_err(|error| Error::of_output(&error))?;
            }
            Err(error) => {
                error.report();
                wrong += 1;
            }
        }
    }
    match (wrong, options.maps.len()) {
        (0, _) if options.deny_remarks && remarks > 0 => Err(denied(remarks)),
        (0, _) => Ok(()),
        (1, 1) => Err(Error::reported()),
        (_, all) => Err(Error::mistake(format!("{wrong} of {all} maps are wrong, as said above"))),
    }
}

fn size(level: &Level) -> String {
    match level {
        Level::Grid(world) => format!("{}×{} cells", world.grid().width(), world.grid().height()),
        Level::Space(scene) => format!("{} bodies", scene.bodies.len()),
    }
}

/// A remark on a level that can be shown, but not won.
fn remark(level: &Level) -> Option<&'static str> {
    let Level::Grid(world) = level else { return None };
    if !world.has_exit() {
        return Some("it has no exit");
    }
    is_exit_out_of_reach(world).then_some(
        "but nobody can reach an exit: no way leads there from the start, not even by jumps",
    )
}

fn denied(remarks: usize) -> Error {
    let maps = if remarks == 1 { "1 map has" } else { &format!("{remarks} maps have") };
    Error::mistake(format!("{maps} a remark, as said above, and --deny remarks allows none"))
}

//! `cellcaster check`: reports all faults in maps.

use std::ffi::OsString;
use std::io::{self, Write};

use clap::{Args, ValueEnum, ValueHint};

use super::options::STANDARD_INPUT;
use super::{Error, level};
use crate::fault::printable;
use crate::game::is_exit_out_of_reach;
use crate::map::Level;

/// Report every fault in maps
///
/// Reports every fault in every map, with its position and what to write instead. The exit status is 0 if all maps are
/// valid, otherwise 2. A level without a reachable exit is valid, but gets a remark.
#[derive(Args, Debug)]
#[command(
    after_long_help = "Examples:\n  cellcaster check maps/*.toml\n  cellcaster check --deny remarks my.toml"
)]
pub(crate) struct Check {
    /// Map files, or "-" for standard input
    #[arg(value_name = "MAP", required = true, value_hint = ValueHint::FilePath)]
    maps: Vec<OsString>,
    /// Treat remarks as faults
    #[arg(long, value_name = "KIND", value_enum)]
    deny: Option<Denied>,
}

/// A kind of message that counts as a fault.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Denied {
    Remarks,
}

/// Checks all maps, even after a fault, and prints a line for each valid one.
pub(crate) fn run(options: &Check) -> Result<(), Error> {
    if options.maps.iter().filter(|map| *map == STANDARD_INPUT).count() > 1 {
        return Err(Error::mistake("standard input holds only one map: write \"-\" only once"));
    }
    let (mut wrong, mut remarks) = (0_usize, 0_usize);
    for map in &options.maps {
        match level::load(Some(map)) {
            Ok(level) => {
                let name = printable(&map.to_string_lossy());
                let (size, remark) = (size(&level), remark(&level));
                remarks += usize::from(remark.is_some());
                let note = remark.map(|it| format!("; {it}")).unwrap_or_default();
                writeln!(io::stdout(), "{name}: valid, {size}{note}")
                    .map_err(|error| Error::of_output(&error))?;
            }
            Err(error) => {
                error.report();
                wrong += 1;
            }
        }
    }
    match (wrong, options.maps.len()) {
        (0, _) if options.deny.is_some() && remarks > 0 => Err(denied(remarks)),
        (0, _) => Ok(()),
        (1, 1) => Err(Error::reported()),
        (_, all) => Err(Error::mistake(format!("{wrong} of {all} maps have faults; see above"))),
    }
}

fn size(level: &Level) -> String {
    match level {
        Level::Grid(world) => format!("{}×{} cells", world.grid().width(), world.grid().height()),
        Level::Space(scene) => format!("{} bodies", scene.bodies.len()),
    }
}

/// A remark on a level that can be shown but not won.
fn remark(level: &Level) -> Option<&'static str> {
    let Level::Grid(world) = level else { return None };
    if !world.has_exit() {
        return Some("it has no exit");
    }
    is_exit_out_of_reach(world)
        .then_some("but no exit can be reached from the start, not even by jumping")
}

fn denied(remarks: usize) -> Error {
    let maps = if remarks == 1 { "1 map has" } else { &format!("{remarks} maps have") };
    Error::mistake(format!("{maps} a remark (see above), which --deny remarks does not allow"))
}

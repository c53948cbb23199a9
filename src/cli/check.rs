//! `cellcaster check`: reports all faults in maps.

use std::ffi::OsString;
use std::io::{self, Write};

use clap::{Args, ValueEnum, ValueHint};

use super::options::STANDARD_INPUT;
use super::{Error, level};
use crate::fault::printable;
use crate::game::is_exit_out_of_reach;
use crate::map::Level;

/// Say everything that is wrong with maps
///
/// Names every fault of every map, each with its place and what to write instead. The exit status is 0 if all maps are
/// right, and 2 if one is not. Remarks on a level without an exit, or with one that nobody can reach, leave it at 0.
#[derive(Args, Debug)]
#[command(
    after_long_help = "Examples:\n  cellcaster check maps/*.toml\n  cellcaster check --deny remarks my.toml"
)]
pub(crate) struct Check {
    /// Map files, or "-" for standard input
    #[arg(value_name = "MAP", required = true, value_hint = ValueHint::FilePath)]
    maps: Vec<OsString>,
    /// End with status 2 after a remark, too
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
        return Err(Error::mistake("standard input holds one map, and \"-\" stands there twice"));
    }
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
        (0, _) if options.deny.is_some() && remarks > 0 => Err(denied(remarks)),
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

/// A remark on a level that can be shown but not won.
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

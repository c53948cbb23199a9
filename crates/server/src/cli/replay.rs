//! `cellcaster-server replay`: plays a recorded room again, and prints its rounds.

use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write as _};
use std::sync::Arc;

use cellcaster::app::parts::of_steps;
use cellcaster::cli::{Error, ROOM_RECORDING};

use super::arguments::Replay;
use crate::rooms::maps::HostMaps;
use crate::rooms::replayed::{MOST_RECORDED_BYTES, replayed};
use crate::rooms::room::Catalog;

/// Prints each round of the recording with its standings and its checksum.
///
/// # Errors
/// If the file is not a recording of a room, or is damaged or too long.
pub(crate) fn run(options: &Replay) -> Result<(), Error> {
    let path = options.file.display().to_string().replace(char::is_control, "?");
    let cannot = |reason: &dyn std::fmt::Display| {
        Error::mistake(format!("{path} cannot be replayed: {reason}"))
    };
    let length = fs::metadata(&options.file).map_err(|error| cannot(&error))?;
    if !length.is_file() || length.len() > MOST_RECORDED_BYTES {
        return Err(cannot(&format!("it is no file of at most {MOST_RECORDED_BYTES} bytes")));
    }
    let text = fs::read_to_string(&options.file).map_err(|error| cannot(&error))?;
    if !text.starts_with(ROOM_RECORDING) {
        return Err(cannot(&"it is no recording of a room"));
    }
    let maps = options.maps.as_deref().map(HostMaps::read).transpose();
    let maps = maps.map_err(|error| Error::mistake(error.to_string()))?.unwrap_or_default();
    let catalog = Arc::new(Catalog::with(&maps));
    let rounds = replayed(&text, &catalog).map_err(|fault| cannot(&fault))?;
    let mut lines = String::new();
    for round in rounds {
        // Writing to a string cannot fail.
        let (mode, level) = (round.mode.title(), catalog.title(&round.level));
        let time = of_steps(round.steps);
        _ = writeln!(lines, "round {}: {mode} in {level}, {time}", round.round);
        for (name, points) in round.standings {
            _ = writeln!(lines, "  {name}  {points}");
        }
        _ = writeln!(lines, "  state {:016x}", round.checksum);
    }
    io::stdout().write_all(lines.as_bytes()).map_err(|error| Error::of_output(&error))
}

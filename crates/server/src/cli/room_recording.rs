//! `cellcaster replay` of a recorded room: what came out of its rounds.

use std::ffi::OsStr;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use cellcaster::cli::Error;
use cellcaster::app::parts::of_steps;
use crate::rooms::maps::HostMaps;
use crate::rooms::recorded::{MOST_RECORDED_BYTES, is_room_recording, replay_room};

/// A line for each round of the recording in `path`; `None` if the file is no recording of a room. `maps`
/// is a map file or a folder of maps, for rounds in maps of the host.
///
/// # Errors
/// If the recording is damaged, or too long.
pub(crate) fn replayed(path: &Path, maps: Option<&OsStr>) -> Result<Option<String>, Error> {
    // What cannot be read is reported where scripts are read.
    let length = fs::metadata(path).map_or(0, |file| if file.is_file() { file.len() } else { 0 });
    if length == 0 || length > MOST_RECORDED_BYTES {
        return Ok(None);
    }
    let Some(text) = fs::read_to_string(path).ok().filter(|text| is_room_recording(text)) else {
        return Ok(None);
    };
    let maps = maps.map(|path| HostMaps::read(Path::new(path))).transpose();
    let maps = maps.map_err(|error| Error::mistake(error.to_string()))?.unwrap_or_default();
    let rounds = replay_room(&text, &maps).map_err(|fault| {
        Error::mistake(format!("{} cannot be replayed: {fault}", path.display()))
    })?;
    let mut lines = String::new();
    for round in rounds {
        // Memory accepts every byte.
        _ = writeln!(lines, "round {}: {}, {}", round.number, round.about, of_steps(round.steps));
        for (name, points) in round.standings {
            _ = writeln!(lines, "  {name}  {points}");
        }
        _ = writeln!(lines, "  state {:016x}", round.checksum);
    }
    Ok(Some(lines))
}

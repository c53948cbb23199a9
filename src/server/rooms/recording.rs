//! Recordings of rooms: a file for each of them.
//!
//! Entries are few and short. They wait in memory for a second at most, see
//! [`RoundLog`](crate::server::sequencer::RoundLog), so that a killed server loses no more, and each
//! write ends with a whole line. So the disk is touched seldom, and a thread for it was refused.

use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use crate::server::room::{Log, Queue, Recorded};
use crate::server::summary::RoomId;

/// Where rooms are recorded.
#[derive(Clone, Debug)]
pub(crate) enum Recordings {
    Nowhere,
    /// In files of this folder.
    Folder(PathBuf),
    #[cfg(test)]
    Memory(crate::server::simulation::Tapes),
}

impl Recordings {
    /// The log of a room.
    pub(super) fn log(&self, id: RoomId) -> Box<dyn Log> {
        match self {
            Self::Nowhere => Box::new(Queue::default()),
            Self::Folder(folder) => in_file(folder, id),
            #[cfg(test)]
            Self::Memory(tapes) => Box::new(Recorded::new(Queue::default(), tapes.tape(id))),
        }
    }
}

fn in_file(folder: &Path, id: RoomId) -> Box<dyn Log> {
    match file(folder, id) {
        Ok(file) => Box::new(Recorded::new(Queue::default(), BufWriter::new(file))),
        Err(error) => {
            tracing::error!(%error, room = %id, "a room cannot be recorded");
            Box::new(Queue::default())
        }
    }
}

/// A file that did not exist before.
fn file(folder: &Path, id: RoomId) -> io::Result<File> {
    fs::create_dir_all(folder)?;
    for number in 0.. {
        let suffix = if number == 0 { String::new() } else { format!("-{number}") };
        let path = folder.join(format!("room-{id}{suffix}.log"));
        match File::create_new(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            result => return result,
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

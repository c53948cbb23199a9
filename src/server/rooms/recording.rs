//! Recordings of rooms: a file for each of them.
//!
//! Entries are few and short. They wait in memory for a second at most, see
//! [`RoundLog`](crate::server::sequencer::RoundLog), so that a killed server loses no more, and each
//! write ends with a whole line. So the disk is touched seldom, and a thread for it was refused.

use std::fmt;
use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use crate::server::room::{Log, Queue, Recorded};
use crate::server::summary::RoomId;
use crate::store::private;

/// Gives each room its log.
pub(crate) struct Logs(Box<dyn Fn(RoomId) -> Box<dyn Log> + Send + Sync>);

impl Logs {
    /// Logs as `open` gives them.
    pub(crate) fn new(open: impl Fn(RoomId) -> Box<dyn Log> + Send + Sync + 'static) -> Self {
        Self(Box::new(open))
    }

    /// Queues, which are recorded in `folder` if there is one.
    pub(crate) fn recorded(folder: Option<PathBuf>) -> Self {
        Self::new(move |id| log(folder.as_deref(), id))
    }

    /// The log of a new room.
    pub(super) fn open(&self, id: RoomId) -> Box<dyn Log> {
        (self.0)(id)
    }
}

impl fmt::Debug for Logs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Logs").finish_non_exhaustive()
    }
}

/// The log of a room, which is recorded if there is a folder for it.
fn log(folder: Option<&Path>, id: RoomId) -> Box<dyn Log> {
    let Some(folder) = folder else { return Box::new(Queue::default()) };
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
    private::create_folder(folder)?;
    for number in 0.. {
        let suffix = if number == 0 { String::new() } else { format!("-{number}") };
        let path = folder.join(format!("room-{id}{suffix}.log"));
        let mut options = OpenOptions::new();
        // What players say to each other is in it.
        private::restrict_file(&mut options);
        match options.write(true).create_new(true).open(&path) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            result => return result,
        }
    }
    Err(io::ErrorKind::AlreadyExists.into())
}

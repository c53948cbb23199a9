//! `cellcaster admin`: what an operator asks a host.
//!
//! Bans are written to the store, whether a server runs or not. A server that runs then ends the
//! sessions to which they apply.

mod bans;
mod table;

use std::io::{self, Write};
use std::path::Path;

use super::Error;
use super::arguments::{Admin, AdminAction, Database};
use super::data_folder::data_folder;
use super::host_store;
use crate::server::{AdminFailure, AdminReply, AdminRequest, RoomRow, Target, VisitorRow, ask};
use table::{table, time};

/// Does the action, and writes what came of it.
pub(super) fn run(options: Admin) -> Result<(), Error> {
    let folder = options.data.or_else(data_folder).ok_or_else(|| {
        Error::mistake("there is no folder for data files: name the one of the host by --data")
    })?;
    let database = host_store::named(options.store);
    let database = database.unwrap_or_else(|| Database::Folder(folder.clone()));
    let text = act(&folder, &database, options.action)?;
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))
}

fn act(folder: &Path, database: &Database, action: AdminAction) -> Result<String, Error> {
    match action {
        AdminAction::Who => request(folder, &AdminRequest::Who),
        AdminAction::Rooms => request(folder, &AdminRequest::Rooms),
        AdminAction::Say { text } => {
            let count = count(folder, &AdminRequest::Say { text })?;
            Ok(format!("said to {}\n", visitors(count)))
        }
        AdminAction::Drain => {
            let count = count(folder, &AdminRequest::Drain)?;
            Ok(format!("the server ends; it waits for {}\n", visitors(count)))
        }
        AdminAction::Kick { target, reason } => kick(folder, target, reason),
        AdminAction::Ban { target, time, reason } => {
            bans::ban(folder, database, &target, time, &reason)
        }
        AdminAction::Unban { target } => bans::unban(database, &target),
        AdminAction::Bans => bans::list(database),
    }
}

fn kick(folder: &Path, target: Target, reason: String) -> Result<String, Error> {
    match count(folder, &AdminRequest::Remove { target, reason, banned: false })? {
        0 => Err(Error::mistake("nobody there is on; \"cellcaster admin who\" lists who is")),
        count => Ok(format!("ended the sessions of {}\n", visitors(count))),
    }
}

fn request(folder: &Path, request: &AdminRequest) -> Result<String, Error> {
    Ok(match ask(folder, request)? {
        AdminReply::Visitors(rows) if rows.is_empty() => "nobody is on\n".to_owned(),
        AdminReply::Visitors(rows) => {
            table(["name", "room", "address", "time", "key"], rows.iter().map(of_visitor))
        }
        AdminReply::Rooms(rows) if rows.is_empty() => "no room is open\n".to_owned(),
        AdminReply::Rooms(rows) => {
            table(["room", "mode", "level", "difficulty", "members"], rows.iter().map(of_room))
        }
        AdminReply::Count(count) => format!("{}\n", visitors(count)),
        AdminReply::Fault(sentence) => return Err(Error::mistake(sentence)),
    })
}

fn of_visitor(row: &VisitorRow) -> [String; 5] {
    let or = |text: &Option<String>, other: &str| text.clone().unwrap_or(other.to_owned());
    let (name, room) = (or(&row.name, "-"), or(&row.room, "lobby"));
    [name, room, row.address.clone(), time(row.seconds), or(&row.key, "guest")]
}

fn of_room(row: &RoomRow) -> [String; 5] {
    let mut members = format!("{}/{}", row.members.len(), row.most);
    if !row.members.is_empty() {
        members = format!("{members} {}", row.members.join(", "));
    }
    if row.watchers > 0 {
        members = format!("{members} (watched by {})", row.watchers);
    }
    let room = row.room.to_string();
    [room, row.mode.clone(), row.level.clone(), row.difficulty.clone(), members]
}

/// How many visitors a request concerns.
fn count(folder: &Path, request: &AdminRequest) -> Result<usize, Error> {
    match ask(folder, request)? {
        AdminReply::Count(count) => Ok(count),
        AdminReply::Fault(sentence) => Err(Error::mistake(sentence)),
        AdminReply::Visitors(_) | AdminReply::Rooms(_) => {
            Err(Error::machine("the server is of another version: it answers something else"))
        }
    }
}

fn visitors(count: usize) -> String {
    match count {
        0 => "nobody".to_owned(),
        1 => "1 visitor".to_owned(),
        count => format!("{count} visitors"),
    }
}

impl From<AdminFailure> for Error {
    fn from(failure: AdminFailure) -> Self {
        match failure {
            AdminFailure::NoServer(_) | AdminFailure::NotAllowed(_) => {
                Self::mistake(failure.to_string())
            }
            AdminFailure::Failed(..) => Self::machine(failure.to_string()),
        }
    }
}

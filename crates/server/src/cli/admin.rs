//! `cellcaster-server admin`: what an operator asks a host.
//!
//! Bans are written to the store, whether a server runs or not. A server that runs then ends the
//! sessions to which they apply.

mod bans;
mod table;

use std::io::{self, Write};
use std::path::Path;

use super::arguments::{Admin, AdminAction};
use super::database::Database;
use crate::cli::host_store;
use crate::ops::admin::{
    AdminFailure, AdminReply, AdminRequest, HostInfo, RoomRow, Target, VisitorRow, ask,
};
use cellcaster::cli::Error;
use cellcaster::cli::machine::data_folder;
use cellcaster::rng;
use table::{table, time};

/// Does the action, and writes what came of it.
pub(crate) fn run(options: Admin) -> Result<(), Error> {
    let folder = options.data.or_else(data_folder).ok_or_else(|| {
        Error::mistake("there is no folder for data files: name the one of the host by --data")
    })?;
    let database = host_store::named(options.store);
    let database = database.unwrap_or_else(|| Database::Folder(folder.clone()));
    let text = act(&folder, &database, options.action)?;
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))
}

fn act(folder: &Path, database: &Database, action: AdminAction) -> Result<String, Error> {
    let mut host = RunningHost { folder, remarks: Vec::new() };
    let text = match action {
        AdminAction::Who => host.lists(&AdminRequest::Who),
        AdminAction::Rooms => host.lists(&AdminRequest::Rooms),
        AdminAction::Hosts => host.lists(&AdminRequest::Hosts),
        AdminAction::Say { text } => {
            let count = host.counts(&AdminRequest::Say { text });
            count.map(|count| format!("said to {}\n", visitors(count)))
        }
        AdminAction::Drain => {
            let count = host.counts(&AdminRequest::Drain);
            count.map(|count| format!("the server ends; it waits for {}\n", visitors(count)))
        }
        AdminAction::Kick { player, session, reason } => host.kicks(player.target(session), reason),
        AdminAction::Ban { player, time, reason } => {
            bans::ban(&mut host, database, &player.target(None), time, &reason)
        }
        AdminAction::Unban { player } => bans::unban(database, &player.target(None)),
        AdminAction::Bans => bans::list(database),
    };
    for remark in host.remarks {
        Error::machine(remark.replace(char::is_control, "?")).warn();
    }
    text
}

/// A server that runs with a data folder.
struct RunningHost<'a> {
    folder: &'a Path,
    /// What it has remarked of its answers.
    remarks: Vec<String>,
}

impl RunningHost<'_> {
    /// Asks it.
    fn answers(&mut self, request: &AdminRequest) -> Result<AdminReply, AdminFailure> {
        match ask(self.folder, request)? {
            AdminReply::AllHosts { reply, remarks } => {
                let new = remarks.into_iter().filter(|remark| !self.remarks.contains(remark));
                let new: Vec<String> = new.collect();
                self.remarks.extend(new);
                Ok(*reply)
            }
            reply => Ok(reply),
        }
    }

    /// A list as a table.
    fn lists(&mut self, request: &AdminRequest) -> Result<String, Error> {
        Ok(match self.answers(request)? {
            AdminReply::Visitors(rows) if rows.is_empty() => "nobody is on\n".to_owned(),
            AdminReply::Visitors(rows) if rows.iter().any(|row| row.host.is_some()) => {
                let titles = ["session", "name", "room", "address", "time", "host", "key"];
                table(titles, rows.iter().map(of_visitor_on_host))
            }
            AdminReply::Visitors(rows) => {
                let titles = ["session", "name", "room", "address", "time", "key"];
                table(titles, rows.iter().map(of_visitor))
            }
            AdminReply::Rooms(rows) if rows.is_empty() => "no room is open\n".to_owned(),
            AdminReply::Rooms(rows) => {
                table(["room", "mode", "level", "difficulty", "members"], rows.iter().map(of_room))
            }
            AdminReply::Hosts(rows) => {
                let titles =
                    ["host", "address", "version", "visitors", "seen", "maps", "writes rooms"];
                table(titles, rows.iter().map(of_host))
            }
            AdminReply::Count(count) => format!("{}\n", visitors(count)),
            AdminReply::Fault(sentence) => return Err(Error::mistake(sentence)),
            AdminReply::AllHosts { .. } => return Err(other_version()),
        })
    }

    /// How many visitors a request concerns.
    fn counts(&mut self, request: &AdminRequest) -> Result<usize, Error> {
        match self.answers(request)? {
            AdminReply::Count(count) => Ok(count),
            AdminReply::Fault(sentence) => Err(Error::mistake(sentence)),
            AdminReply::Visitors(_)
            | AdminReply::Rooms(_)
            | AdminReply::Hosts(_)
            | AdminReply::AllHosts { .. } => Err(other_version()),
        }
    }

    fn kicks(&mut self, target: Target, reason: String) -> Result<String, Error> {
        match self.counts(&AdminRequest::Remove { target, reason, banned: false })? {
            0 => Err(Error::mistake(
                "nobody there is on; \"cellcaster-server admin who\" lists who is",
            )),
            count => Ok(format!("ended {}\n", sessions(count))),
        }
    }
}

fn other_version() -> Error {
    Error::machine("the server is of another version: it answers something else")
}

fn of_visitor(row: &VisitorRow) -> [String; 6] {
    let or = |text: &Option<String>, other: &str| text.clone().unwrap_or(other.to_owned());
    let (name, room) = (or(&row.name, "-"), or(&row.room, "lobby"));
    let address = row.address.clone();
    [row.session.clone(), name, room, address, time(row.seconds), or(&row.key, "guest")]
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

fn of_visitor_on_host(row: &VisitorRow) -> [String; 7] {
    let [session, name, room, address, time, key] = of_visitor(row);
    [session, name, room, address, time, row.host.clone().unwrap_or_else(|| "-".to_owned()), key]
}

fn of_host(row: &HostInfo) -> [String; 7] {
    let rooms = match &row.rooms {
        None => "-".to_owned(),
        Some(rooms) if rooms.is_empty() => "none".to_owned(),
        Some(rooms) => rooms.iter().map(u32::to_string).collect::<Vec<_>>().join(", "),
    };
    let seen = format!("{} ago", time(row.seconds));
    let (visitors, version) = (row.visitors.to_string(), row.version.clone());
    let maps = row.maps.as_deref().map_or_else(|| "-".to_owned(), summary_of_maps);
    [row.host.clone(), row.address.clone(), version, visitors, seen, maps, rooms]
}

/// The number of maps, and a hash by which an operator sees that two hosts have the same ones.
fn summary_of_maps(keys: &[String]) -> String {
    let bytes = keys.iter().flat_map(|key| key.bytes().chain([b'\n']));
    match keys.len() {
        0 => "none".to_owned(),
        count => format!("{count} ({:08x})", rng::hash(0, bytes.map(u64::from)) as u32),
    }
}

fn sessions(count: usize) -> String {
    match count {
        0 => "no session".to_owned(),
        1 => "1 session".to_owned(),
        count => format!("{count} sessions"),
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

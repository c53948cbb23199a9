//! `cellcaster-server admin`: an operator's requests to a host.
//!
//! Bans and mutes are written to the store, whether a server runs or not. A running server then ends the
//! sessions that a ban applies to. It looks for new mutes itself.

use std::io::{self, Write};
use std::path::Path;
use std::{env, iter, mem};

use serde_json::{Value, json};
use unicode_width::UnicodeWidthStr;

use super::arguments::{Admin, AdminAction, BanTerms, ListFormat, ListOptions};
use super::host_store::{self, StoreLocation, failed};
use crate::accounts::{Ban, BanScope, BanTarget, HostStore, UnixTime, time_text};
use crate::admin::{AdminReply, AdminRequest, HostInfo, RoomRow, Target};
use crate::operator::socket::ask;
use crate::visitors::VisitorRow;
use cellcaster::cli::Error;
use cellcaster::fault::printable_path;
use cellcaster::rng;

/// Carries out the action, and prints the result.
pub(crate) fn run(options: Admin) -> Result<(), Error> {
    let folder = host_store::folder(options.data)?;
    let database = StoreLocation::named(options.store, Some(folder.clone()))?;
    let text = act(&folder, &database, options.action)?;
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))
}

fn act(folder: &Path, database: &StoreLocation, action: AdminAction) -> Result<String, Error> {
    let mut host = RunningHost { folder, remarks: Vec::new() };
    let text = match action {
        AdminAction::Who(list) => host.who(&list),
        AdminAction::Rooms(list) => host.rooms(&list),
        AdminAction::Hosts(list) => host.hosts(&list),
        AdminAction::Say { text } => {
            let reply = host.reply(&AdminRequest::Say { text });
            reply.map(|reply| format!("said to {}\n", visitors(reply.count)))
        }
        AdminAction::Drain => host.reply(&AdminRequest::Drain).map(|reply| {
            format!("the server is shutting down; it waits for {}\n", visitors(reply.count))
        }),
        AdminAction::Kick { player, reason } => host.kicks(player.target(), reason),
        AdminAction::Ban { player, terms } => {
            open(database).and_then(|mut store| ban(&mut host, &mut store, player.target(), &terms))
        }
        AdminAction::Unban { player } => open(database).and_then(|mut store| {
            let targets = with_account(&mut store, player.target())?;
            Ok(format!("{} may come back\n", allow(&mut store, BanScope::Visit, targets)?))
        }),
        AdminAction::Bans(list) => bans(database, BanScope::Visit, &list),
        AdminAction::Mute { player, terms } => open(database).and_then(|mut store| {
            let targets = muted_targets(&mut host, &mut store, player.target())?;
            Ok(format!("muted {}\n", forbid(&mut store, BanScope::Talk, &targets, &terms)?))
        }),
        AdminAction::Unmute { player } => open(database).and_then(|mut store| {
            let target = Target::Visitors(player.target());
            let targets = muted_targets(&mut host, &mut store, target)?;
            Ok(format!("{} may talk again\n", allow(&mut store, BanScope::Talk, targets)?))
        }),
        AdminAction::Mutes(list) => bans(database, BanScope::Talk, &list),
    };
    for remark in host.remarks {
        Error::machine(remark.replace(char::is_control, "?")).warn();
    }
    text
}

/// The server that runs with a data folder.
struct RunningHost<'a> {
    folder: &'a Path,
    /// The remarks in its replies, each once.
    remarks: Vec<String>,
}

impl RunningHost<'_> {
    /// Sends a request to the server, and collects the remarks in the reply. `None` if no server runs.
    fn ask(&mut self, request: &AdminRequest) -> Result<Option<AdminReply>, Error> {
        let mut reply = ask(self.folder, request)?;
        for remark in reply.iter_mut().flat_map(|reply| mem::take(&mut reply.remarks)) {
            if !self.remarks.contains(&remark) {
                self.remarks.push(remark);
            }
        }
        Ok(reply)
    }

    /// The reply to a request for which a server must run.
    fn reply(&mut self, request: &AdminRequest) -> Result<AdminReply, Error> {
        let folder = printable_path(self.folder);
        let none = || Error::mistake(format!("no server runs with the data folder {folder}"));
        self.ask(request)?.ok_or_else(none)
    }

    fn who(&mut self, options: &ListOptions) -> Result<String, Error> {
        let rows = self.reply(&AdminRequest::Who)?.visitors;
        let is_cluster = rows.iter().any(|row| row.host.is_some());
        let hosts: &[&str] = if is_cluster { &["host"] } else { &[] };
        let titles = [&["session", "name", "room", "address", "time"], hosts, &["key"]].concat();
        let cells = |row: &VisitorRow| of_visitor(row, is_cluster);
        Ok(listed(&rows, options, "nobody is online", &titles, (|row| json!(row), cells)))
    }

    fn rooms(&mut self, options: &ListOptions) -> Result<String, Error> {
        let rows = self.reply(&AdminRequest::Rooms)?.rooms;
        let titles = ["room", "mode", "level", "difficulty", "members"];
        Ok(listed(&rows, options, "no room is open", &titles, (|row| json!(row), of_room)))
    }

    fn hosts(&mut self, options: &ListOptions) -> Result<String, Error> {
        let rows = self.reply(&AdminRequest::Hosts)?.hosts;
        let titles = ["host", "address", "version", "visitors", "seen", "maps", "writes rooms"];
        Ok(listed(&rows, options, "no host is present", &titles, (|row| json!(row), of_host)))
    }

    fn kicks(&mut self, target: Target, reason: String) -> Result<String, Error> {
        let request = AdminRequest::Remove { target, reason, banned: false, moderator: None };
        match self.reply(&request)?.count {
            0 => Err(no_session()),
            count => Ok(format!("ended {}\n", sessions(count))),
        }
    }
}

fn no_session() -> Error {
    Error::mistake("no session matches; \"cellcaster-server admin who\" lists all")
}

/// Rows as a document of each row's object, or as a table of its cells.
fn listed<T>(
    rows: &[T],
    options: &ListOptions,
    none: &str,
    titles: &[&str],
    (object, cells): (impl Fn(&T) -> Value, impl Fn(&T) -> Vec<String>),
) -> String {
    match options.format {
        ListFormat::Json => document(&rows.iter().map(object).collect()),
        ListFormat::Table if rows.is_empty() => format!("{none}\n"),
        ListFormat::Table => table(titles, rows.iter().map(cells)),
    }
}

fn of_visitor(row: &VisitorRow, has_host: bool) -> Vec<String> {
    let name = or(row.name.as_ref(), "-");
    let (room, address) = (or(row.room.as_ref(), "lobby"), row.address.to_string());
    let host = has_host.then(|| or(row.host.as_ref(), "-"));
    let cells = [row.session.to_string(), name, room, address, time_text(row.seconds)];
    cells.into_iter().chain(host).chain([or(row.key.as_ref(), "guest")]).collect()
}

fn or(value: Option<&impl ToString>, other: &str) -> String {
    value.map_or_else(|| other.to_owned(), ToString::to_string)
}

fn of_room(row: &RoomRow) -> Vec<String> {
    let mut members = format!("{}/{}", row.members.len(), row.most);
    if !row.members.is_empty() {
        members = format!("{members} {}", row.members.join(", "));
    }
    if row.watchers > 0 {
        members = format!("{members} (watched by {})", row.watchers);
    }
    if row.is_private {
        members = format!("{members} (private)");
    }
    let room = row.room.to_string();
    vec![room, row.mode.clone(), row.level.clone(), row.difficulty.clone(), members]
}

fn of_host(row: &HostInfo) -> Vec<String> {
    let rooms = match &row.rooms {
        None => "-".to_owned(),
        Some(rooms) if rooms.is_empty() => "none".to_owned(),
        Some(rooms) => rooms.iter().map(u32::to_string).collect::<Vec<_>>().join(", "),
    };
    let seen = format!("{} ago", time_text(row.seconds));
    let (visitors, version) = (row.visitors.to_string(), row.version.clone());
    let maps = row.maps.as_deref().map_or_else(|| "-".to_owned(), summary_of_maps);
    vec![row.host.clone(), row.address.clone(), version, visitors, seen, maps, rooms]
}

/// The number of maps, and a hash that shows an operator whether two hosts have the same maps.
fn summary_of_maps(keys: &[String]) -> String {
    let bytes = keys.iter().flat_map(|key| key.bytes().chain([b'\n']));
    match keys.len() {
        0 => "none".to_owned(),
        count => format!("{count} ({:08x})", rng::hash(0, bytes.map(u64::from)) as u32),
    }
}

/// Bans a player, and ends the sessions that the ban applies to.
fn ban(
    host: &mut RunningHost<'_>,
    store: &mut HostStore,
    target: BanTarget,
    terms: &BanTerms,
) -> Result<String, Error> {
    let targets = with_account(store, target)?;
    let banned = forbid(store, BanScope::Visit, &targets, terms)?;
    let ended = match remove(host, targets, &terms.reason)? {
        None => "no server runs".to_owned(),
        Some(count) => format!("ended {}", sessions(count)),
    };
    Ok(format!("banned {banned}; {ended}\n"))
}

/// Writes a ban for each target, and describes them in words.
fn forbid(
    store: &mut HostStore,
    scope: BanScope,
    targets: &[BanTarget],
    BanTerms { time, reason }: &BanTerms,
) -> Result<String, Error> {
    let now = UnixTime::now();
    for target in targets {
        let ban = Ban {
            scope,
            target: target.clone(),
            until: time.map(|time| now.after(time.as_secs())),
            reason: reason.clone(),
            by: operator(),
            made_at: now,
        };
        store.ban(&ban).map_err(failed)?;
    }
    let time =
        time.map_or("forever".to_owned(), |time| format!("for {}", time_text(time.as_secs())));
    Ok(format!("{} {time}", joined(targets)))
}

/// Ends the bans of some targets, and names the targets with a ban.
fn allow(store: &mut HostStore, scope: BanScope, targets: Vec<BanTarget>) -> Result<String, Error> {
    let mut ended = Vec::new();
    for target in targets {
        if store.unban(scope, &target).map_err(failed)? {
            ended.push(target);
        }
    }
    if ended.is_empty() {
        let ban = if scope == BanScope::Visit { "ban" } else { "mute" };
        return Err(Error::mistake(format!(
            "there is no such {ban}; \"cellcaster-server admin {ban}s\" lists them"
        )));
    }
    Ok(joined(&ended))
}

fn joined(targets: &[BanTarget]) -> String {
    targets.iter().map(BanTarget::to_string).collect::<Vec<_>>().join(" and ")
}

/// Lists the bans of a scope in force.
fn bans(database: &StoreLocation, scope: BanScope, options: &ListOptions) -> Result<String, Error> {
    let mut store = database.open_to_read()?;
    let now = UnixTime::now();
    let bans = store.bans(scope, now).map_err(failed)?;
    let what = match scope {
        BanScope::Visit => "banned",
        BanScope::Talk => "muted",
    };
    let cells = |ban: &Ban| {
        let left = ban.until.map(|until| until.seconds().saturating_sub(now.seconds()));
        let left = left.map_or_else(|| "ever".to_owned(), time_text);
        let ago = time_text(now.seconds().saturating_sub(ban.made_at.seconds()));
        let (target, made) = (ban.target.to_string(), format!("{ago} ago"));
        vec![target, left, made, ban.by.clone(), ban.reason.clone()]
    };
    let titles = [what, "for", "made", "by", "reason"];
    Ok(listed(&bans, options, &format!("nobody is {what}"), &titles, (ban_object, cells)))
}

/// A ban with Unix times in seconds; `null` for no end.
fn ban_object(ban: &Ban) -> Value {
    let kind = match ban.target {
        BanTarget::Key(_) => "key",
        BanTarget::Name(_) => "name",
        BanTarget::Addresses(_) => "address",
    };
    json!({
        "kind": kind,
        "banned": ban.target.to_string(),
        "until": ban.until.map(UnixTime::seconds),
        "made": ban.made_at.seconds(),
        "by": ban.by,
        "reason": ban.reason,
    })
}

/// JSON as one line. Control characters, which can occur only in strings, are escaped.
fn document(json: &Value) -> String {
    let escaped = |char: char| {
        if char.is_control() { format!("\\u{:04x}", u32::from(char)) } else { char.to_string() }
    };
    json.to_string().chars().map(escaped).collect::<String>() + "\n"
}

/// The target of a ban, and for a name also the key of the account with that name.
fn with_account(store: &mut HostStore, target: BanTarget) -> Result<Vec<BanTarget>, Error> {
    let account = match &target {
        BanTarget::Name(name) => store.account_named(name).map_err(failed)?,
        BanTarget::Key(_) | BanTarget::Addresses(_) => None,
    };
    Ok([target].into_iter().chain(account.map(|account| BanTarget::Key(account.key))).collect())
}

/// The targets of a mute. A guest who is online is muted by address, because the next guest may have the same name.
fn muted_targets(
    host: &mut RunningHost<'_>,
    store: &mut HostStore,
    target: Target,
) -> Result<Vec<BanTarget>, Error> {
    let is_meant = |row: &&VisitorRow| match &target {
        Target::Session(session) => row.session == *session,
        Target::Visitors(BanTarget::Name(name)) => {
            row.key.is_none() && row.name.as_ref().is_some_and(|it| it.looks_like(name))
        }
        Target::Visitors(_) => false,
    };
    let rows = match target {
        Target::Session(_) => host.reply(&AdminRequest::Who)?.visitors,
        Target::Visitors(_) => {
            host.ask(&AdminRequest::Who)?.map(|reply| reply.visitors).unwrap_or_default()
        }
    };
    match (rows.iter().find(is_meant), target) {
        (Some(row), _) => Ok(vec![row.talker()]),
        (None, Target::Session(_)) => Err(no_session()),
        (None, Target::Visitors(target)) => with_account(store, target),
    }
}

/// Ends the sessions of `targets`, and returns their number; `None` if no server runs.
fn remove(
    host: &mut RunningHost<'_>,
    targets: Vec<BanTarget>,
    reason: &str,
) -> Result<Option<usize>, Error> {
    let mut removed = 0;
    for target in targets {
        let request = AdminRequest::Remove {
            target: Target::Visitors(target),
            reason: reason.to_owned(),
            banned: true,
            moderator: None,
        };
        let Some(reply) = host.ask(&request)? else { return Ok(None) };
        removed = removed.max(reply.count);
    }
    Ok(Some(removed))
}

/// Opens the store. Does not create it if there is none.
fn open(database: &StoreLocation) -> Result<HostStore, Error> {
    database.open_to_read()?;
    database.open().map_err(failed)
}

/// The author of a ban: the user who runs the command, also through `sudo`.
fn operator() -> String {
    let names = ["SUDO_USER", "USER", "LOGNAME"].into_iter().filter_map(|name| env::var(name).ok());
    names.into_iter().find(|name| !name.is_empty()).unwrap_or_else(|| "console".to_owned())
}

/// Rows below a line of titles, in columns as wide as necessary. Control characters are replaced.
fn table(titles: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let titles = titles.iter().map(|&title| title.to_owned()).collect();
    let mut rows: Vec<Vec<String>> = iter::once(titles).chain(rows).collect();
    rows.iter_mut().flatten().for_each(|cell| *cell = cell.replace(char::is_control, "?"));
    let widths: Vec<usize> = (0..rows[0].len())
        .map(|column| rows.iter().map(|row| row[column].width()).max().unwrap_or_default())
        .collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths);
        let line: String = cells
            .map(|(cell, width)| cell.clone() + &" ".repeat(width - cell.width() + 2))
            .collect();
        line.trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

fn sessions(count: usize) -> String {
    counted(count, "no session", "session")
}

fn visitors(count: usize) -> String {
    counted(count, "nobody", "visitor")
}

fn counted(count: usize, none: &str, one: &str) -> String {
    match count {
        0 => none.to_owned(),
        1 => format!("1 {one}"),
        count => format!("{count} {one}s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_contents() {
        let rows = [["漢字", "1"], ["A\u{1b}", "22"]].map(|row| row.map(str::to_owned).to_vec());
        assert_eq!(table(&["name", "n"], rows.into_iter()), "name  n\n漢字  1\nA?    22\n");
    }

    #[test]
    fn a_document_is_one_line_without_control_characters() {
        let reason = "\u{1b}[31m\n\u{9b}0m\u{7f}\"";
        let text = document(&json!([reason]));
        let (line, end) = text.split_at(text.len() - 1);
        assert!(!line.contains(char::is_control) && end == "\n", "{text:?}");
        assert_eq!(serde_json::from_str::<Value>(line).unwrap(), json!([reason]));
    }
}

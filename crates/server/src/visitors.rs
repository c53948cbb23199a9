//! The visitors on a server, as its operator sees them, and the notices to them: from the operator, and from
//! other visitors.
//!
//! The driver of a session holds a [`Presence`]. It records the visitor's name and location there and waits
//! for [notices](Presence::notice). An operator can list visitors, send a line to all of them, and remove
//! some. A visitor can write to one other visitor, or talk to all visitors in the lobby.
//!
//! The list also holds the mutes in force, as the store contains them.
//!
//! At most `MAX_LINES` lines of the operator and of other visitors each are queued per session; then the oldest
//! is dropped. A session that does not read them therefore uses no more memory.

use std::collections::{BTreeMap, VecDeque};
use std::fmt;
use std::net::IpAddr;
use std::sync::{Arc, Mutex};

use serde::{Deserialize, Serialize};
use tokio::sync::{Notify, watch};
use tokio::time::Instant;

use crate::accounts::{
    AccountKey, Ban, BanTarget, Identity, Name, UnixTime, applying, serialized_as_text,
};
use crate::admission::counted_address;
use crate::lock::locked;
use crate::queue::push_within;

/// The visitors of a server. Clones share the same list.
#[derive(Clone, Debug, Default)]
pub struct Visitors(Arc<Mutex<Table>>);

/// A visitor's entry in the list of [`Visitors`]. Dropping it removes the entry.
#[derive(Debug)]
pub struct Presence {
    number: u64,
    visitors: Visitors,
    inbox: Arc<NoticeQueue>,
}

/// An operator's notice to a visitor's session.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Notice {
    /// A line from the operator.
    Said(String),
    /// A line from another visitor.
    Heard(Heard),
    /// The session must end, with this sentence.
    Removed(String),
}

/// A line from another visitor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Heard {
    /// The name of the visitor.
    pub from: String,
    /// The text.
    pub text: String,
    /// `true` if it was written to this visitor alone, `false` if to everybody in the lobby.
    pub is_private: bool,
}

/// A number for a session, unique across all hosts and restarts, written as `3f9a-7`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SessionId {
    /// A random number for this run of the host.
    run: u16,
    number: u64,
}

serialized_as_text!(SessionId: "the id of a session, such as 3f9a-7");

/// A visitor. `cellcaster-server admin who --format json` prints the fields, so their names must stay.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct VisitorRow {
    /// The session.
    pub session: SessionId,
    /// The name; `None` until it is chosen.
    pub name: Option<Name>,
    /// The address from which the visitor connects.
    pub address: IpAddr,
    /// The visitor's key; `None` for a guest.
    pub key: Option<AccountKey>,
    /// The room; `None` for the lobby.
    pub room: Option<String>,
    /// How long the visitor has been connected, in seconds.
    pub seconds: u64,
    /// The visitor's host, in a cluster.
    #[serde(default)]
    pub host: Option<String>,
}

/// The visitors with a name who play in no room, as lobbies list them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Onlookers {
    /// The first [`MAX_ONLOOKERS`], in order of arrival, each with the room that they watch.
    pub(crate) first: Vec<(Name, Option<String>)>,
    /// The number of all.
    pub(crate) count: usize,
}

#[derive(Debug)]
struct Table {
    run: u16,
    next: u64,
    /// The entries, in order of arrival.
    entries: BTreeMap<u64, VisitorEntry>,
    mutes: Vec<Ban>,
    onlookers: watch::Sender<Arc<Onlookers>>,
}

#[derive(Debug)]
struct VisitorEntry {
    /// Without the time and the host, which are known when it is listed.
    row: VisitorRow,
    since: Instant,
    /// `true` if the visitor only watches their room.
    watches: bool,
    /// The [keys](Name::keys) of the name. Computing them takes longer than looking through a thousand entries.
    keys: Vec<String>,
    inbox: Arc<NoticeQueue>,
}

#[derive(Debug, Default)]
struct NoticeQueue {
    notices: Mutex<Notices>,
    changed: Notify,
}

#[derive(Debug, Default)]
struct Notices {
    lines: VecDeque<String>,
    heard: VecDeque<Heard>,
    removed: Option<String>,
}

/// The maximum number of lines of each kind queued per session.
const MAX_LINES: usize = 8;
/// The maximum number of onlookers whose names lobbies receive.
const MAX_ONLOOKERS: usize = 12;

impl Default for Table {
    fn default() -> Self {
        // If the system had no random numbers, the server would have no keys either.
        let run = getrandom::u32().unwrap_or_default() as u16;
        let (entries, mutes) = (BTreeMap::new(), Vec::new());
        Self { run, next: 1, entries, mutes, onlookers: watch::Sender::default() }
    }
}

impl SessionId {
    /// Parses text such as `3f9a-7`.
    pub fn parse(text: &str) -> Option<Self> {
        let (run, number) = text.split_once('-')?;
        let is_plain = run.len() == 4
            && run.bytes().all(|byte| byte.is_ascii_hexdigit())
            && number.bytes().all(|byte| byte.is_ascii_digit());
        let id =
            || Some(Self { run: u16::from_str_radix(run, 16).ok()?, number: number.parse().ok()? });
        is_plain.then(id)?
    }
}

impl fmt::Display for SessionId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04x}-{}", self.run, self.number)
    }
}

impl Visitors {
    /// Adds a visitor.
    pub fn arrive(&self, address: IpAddr, key: Option<AccountKey>) -> Presence {
        let inbox = Arc::<NoticeQueue>::default();
        let number = locked(&self.0, |table| {
            let number = table.next;
            table.next += 1;
            let session = SessionId { run: table.run, number };
            let address = address.to_canonical();
            let (name, room, seconds, host) = (None, None, 0, None);
            let row = VisitorRow { session, name, address, key, room, seconds, host };
            let (since, keys, inbox) = (Instant::now(), Vec::new(), inbox.clone());
            table.entries.insert(number, VisitorEntry { row, since, watches: false, keys, inbox });
            number
        });
        Presence { number, visitors: self.clone(), inbox }
    }

    /// All visitors, in order of arrival.
    pub fn list(&self) -> Vec<VisitorRow> {
        locked(&self.0, |table| table.entries.values().map(VisitorEntry::listed).collect())
    }

    /// The visitors who play in no room.
    pub(crate) fn onlookers(&self) -> watch::Receiver<Arc<Onlookers>> {
        locked(&self.0, |table| table.onlookers.subscribe())
    }

    /// The number of visitors.
    pub fn count(&self) -> usize {
        locked(&self.0, |table| table.entries.len())
    }

    /// Sends a line to all visitors; returns their number.
    pub fn say(&self, line: &str) -> usize {
        self.each(|_| true, |inbox| inbox.say(line))
    }

    /// Sends a line to the visitors with this key.
    pub(crate) fn say_to(&self, key: &AccountKey, line: &str) {
        self.each(|it| it.key.as_ref() == Some(key), |inbox| inbox.say(line));
    }

    /// Sends a line to the visitors in a room.
    pub(crate) fn say_in(&self, room: &str, line: &str) {
        self.each(|it| it.room.as_deref() == Some(room), |inbox| inbox.say(line));
    }

    /// Sends a line to the visitors with this name, or with a name that looks like it; returns their number.
    pub fn tell(&self, name: &Name, line: &Heard) -> usize {
        let keys = name.keys();
        locked(&self.0, |table| {
            table.named(&keys).map(|entry| entry.inbox.hear(line.clone())).count()
        })
    }

    /// Sends a line to the visitors with a name who are in no room.
    pub(crate) fn tell_lobby(&self, line: &Heard) {
        let is_in_lobby = |it: &VisitorRow| it.name.is_some() && it.room.is_none();
        self.each(is_in_lobby, |inbox| inbox.hear(line.clone()));
    }

    /// The visitor with this name, or with a name that looks like it.
    pub(crate) fn named(&self, name: &Name) -> Option<VisitorRow> {
        let keys = name.keys();
        locked(&self.0, |table| table.named(&keys).next().map(VisitorEntry::listed))
    }

    /// The names of the first `most` visitors in a room, or in no room.
    pub(crate) fn names_in(&self, room: Option<&str>, most: usize) -> Vec<Name> {
        locked(&self.0, |table| {
            let there = table.entries.values().filter(|it| it.row.room.as_deref() == room);
            there.filter_map(|it| it.row.name.clone()).take(most).collect()
        })
    }

    /// Replaces the mutes in force.
    pub(crate) fn set_mutes(&self, mutes: Vec<Ban>) {
        locked(&self.0, |table| table.mutes = mutes);
    }

    /// The mute in force that applies to a visitor. If several apply, returns the last to end.
    pub(crate) fn mute_of(&self, identity: &Identity<'_>, now: UnixTime) -> Option<Ban> {
        locked(&self.0, |table| {
            applying(table.mutes.iter().filter(|mute| mute.is_in_force(now)), identity).cloned()
        })
    }

    /// Ends the sessions that match `target` with a sentence; returns their number.
    pub fn remove(&self, target: &BanTarget, sentence: &str) -> usize {
        let is_meant = |it: &VisitorRow| {
            let (address, key, name) = (Some(it.address), it.key.as_ref(), it.name.as_ref());
            target.applies_to(&Identity { address, key, name })
        };
        self.each(is_meant, |inbox| inbox.remove(sentence))
    }

    /// Ends a session with a sentence; returns whether it exists.
    pub fn remove_session(&self, session: SessionId, sentence: &str) -> bool {
        self.each(|it| it.session == session, |inbox| inbox.remove(sentence)) > 0
    }

    /// Returns true if a guest has a name that looks like `name`.
    pub(crate) fn has_guest(&self, name: &Name) -> bool {
        let keys = name.keys();
        locked(&self.0, |table| table.has_guest(&keys, None))
    }

    /// Calls `act` on the inboxes of matching visitors; returns their number.
    fn each(&self, is_meant: impl Fn(&VisitorRow) -> bool, act: impl Fn(&NoticeQueue)) -> usize {
        locked(&self.0, |table| {
            let meant = table.entries.values().filter(|entry| is_meant(&entry.row));
            meant.map(|entry| act(&entry.inbox)).count()
        })
    }
}

impl VisitorEntry {
    fn listed(&self) -> VisitorRow {
        VisitorRow { seconds: self.since.elapsed().as_secs(), ..self.row.clone() }
    }
}

impl VisitorRow {
    /// The target of a mute of this visitor: the key or, for a guest, the address. An owner of an IPv6 address has the
    /// whole /64.
    pub(crate) fn talker(&self) -> BanTarget {
        let by_address = || BanTarget::Addresses(counted_address(self.address));
        self.key.map_or_else(by_address, BanTarget::Key)
    }
}

impl Table {
    /// Tells lobbies about the onlookers, if they have changed.
    fn publish(&self) {
        let onlooker = |VisitorEntry { row, watches, .. }: &VisitorEntry| {
            let is_onlooker = row.room.is_none() || *watches;
            Some((row.name.clone().filter(|_| is_onlooker)?, row.room.clone()))
        };
        let all = || self.entries.values().filter_map(onlooker);
        let (first, count) = (all().take(MAX_ONLOOKERS).collect(), all().count());
        let onlookers = Onlookers { first, count };
        self.onlookers.send_if_modified(|known| {
            let is_new = **known != onlookers;
            if is_new {
                *known = Arc::new(onlookers);
            }
            is_new
        });
    }

    /// The entries with a name that has one of these keys.
    fn named<'t>(&'t self, keys: &'t [String]) -> impl Iterator<Item = &'t VisitorEntry> {
        self.entries.values().filter(|entry| entry.keys.iter().any(|key| keys.contains(key)))
    }

    fn has_guest(&self, keys: &[String], except: Option<u64>) -> bool {
        let except = except.and_then(|number| self.entries.get(&number));
        self.named(keys).any(|entry| {
            entry.row.key.is_none() && except.is_none_or(|it| !std::ptr::eq(it, entry))
        })
    }
}

impl Presence {
    /// Sets a guest's name, unless another guest has a name that looks like it. Returns whether it was set.
    pub(crate) fn take_guest_name(&self, name: &Name) -> bool {
        let keys = name.keys();
        locked(&self.visitors.0, |table| {
            let is_free = !table.has_guest(&keys, Some(self.number));
            if let Some(entry) = table.entries.get_mut(&self.number).filter(|_| is_free) {
                (entry.row.name, entry.keys) = (Some(name.clone()), keys);
                table.publish();
            }
            is_free
        })
    }

    /// Records the visitor's name, from their account or chosen as a guest.
    pub fn set_name(&self, name: &str) {
        let name = Name::kept(name);
        let keys = name.keys();
        self.change(|it| (it.row.name, it.keys) = (Some(name), keys));
    }

    /// Records a short description of the visitor's room; `None` for the lobby.
    pub fn set_room(&self, room: Option<String>) {
        self.change(|it| it.row.room = room);
    }

    /// Records whether the visitor only watches the room.
    pub(crate) fn set_watching(&self, watches: bool) {
        self.change(|it| it.watches = watches);
    }

    /// Waits for the next notice. Cancellation-safe.
    pub async fn notice(&mut self) -> Notice {
        loop {
            if let Some(notice) = self.inbox.take() {
                return notice;
            }
            self.inbox.changed.notified().await;
        }
    }

    fn change(&self, act: impl FnOnce(&mut VisitorEntry)) {
        locked(&self.visitors.0, |table| {
            if let Some(entry) = table.entries.get_mut(&self.number) {
                act(entry);
            }
            table.publish();
        });
    }
}

impl Drop for Presence {
    fn drop(&mut self) {
        locked(&self.visitors.0, |table| {
            table.entries.remove(&self.number);
            table.publish();
        });
    }
}

impl NoticeQueue {
    fn change(&self, act: impl FnOnce(&mut Notices)) {
        locked(&self.notices, act);
        self.changed.notify_one();
    }

    fn say(&self, line: &str) {
        self.change(|notices| push_within(&mut notices.lines, line.to_owned(), MAX_LINES));
    }

    fn hear(&self, line: Heard) {
        self.change(|notices| push_within(&mut notices.heard, line, MAX_LINES));
    }

    fn remove(&self, sentence: &str) {
        self.change(|notices| notices.removed = Some(sentence.to_owned()));
    }

    /// Takes the next notice. A removal comes before any lines, and lines of the operator before others.
    fn take(&self) -> Option<Notice> {
        locked(&self.notices, |notices| {
            let removed = notices.removed.take().map(Notice::Removed);
            let said = || notices.lines.pop_front().map(Notice::Said);
            removed.or_else(said).or_else(|| notices.heard.pop_front().map(Notice::Heard))
        })
    }
}

#[cfg(test)]
mod tests;

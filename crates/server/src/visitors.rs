//! The visitors who are on a server, as its operator sees them, and the operator's notices to them.
//!
//! The driver of a session holds a [`Presence`], says in it what the visitor is called and where they
//! are, and waits for its [notices](Presence::notice). An operator lists visitors, says a line to all
//! of them, and removes some.
//!
//! At most `MAX_LINES` lines wait for a session; then the oldest one is dropped. So a session that
//! does not take them costs no memory.

use std::collections::{BTreeMap, VecDeque};
use std::fmt;
use std::net::IpAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use tokio::sync::Notify;
use tokio::time::Instant;

use crate::accounts::{AccountKey, BanTarget, Identity, Name};

/// The visitors of a server. Clones share them.
#[derive(Clone, Debug, Default)]
pub struct Visitors(Arc<Mutex<Table>>);

/// A visitor among the [`Visitors`], until it is dropped.
#[derive(Debug)]
pub struct Presence {
    number: u64,
    visitors: Visitors,
    inbox: Arc<Inbox>,
}

/// An operator's notice to a visitor's session.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Notice {
    /// A line from the host.
    Said(String),
    /// The session ends, with this sentence.
    Removed(String),
}

/// A session among those of all hosts, and of all their earlier runs: written as `3f9a-7`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SessionId {
    /// Of the run of the host, by chance.
    run: u16,
    number: u64,
}

/// A visitor, as an operator sees them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Present {
    /// Their session.
    pub session: SessionId,
    /// The name; `None` until it is chosen.
    pub name: Option<Name>,
    /// The address that they connect from.
    pub address: IpAddr,
    /// Their key; `None` for a guest.
    pub key: Option<AccountKey>,
    /// The room that they are in, in a few words; `None` for the lobby.
    pub room: Option<String>,
    /// For how long they have been here.
    pub time: Duration,
}

#[derive(Debug)]
struct Table {
    run: u16,
    next: u64,
    /// In the order in which they came.
    entries: BTreeMap<u64, Entry>,
}

#[derive(Debug)]
struct Entry {
    name: Option<Name>,
    address: IpAddr,
    key: Option<AccountKey>,
    room: Option<String>,
    since: Instant,
    inbox: Arc<Inbox>,
}

#[derive(Debug, Default)]
struct Inbox {
    notices: Mutex<Notices>,
    changed: Notify,
}

#[derive(Debug, Default)]
struct Notices {
    lines: VecDeque<String>,
    removed: Option<String>,
}

/// The most lines that wait for a session.
const MAX_LINES: usize = 8;

impl Default for Table {
    fn default() -> Self {
        // Without random numbers from the system there would be no keys, either.
        let run = getrandom::u32().unwrap_or_default() as u16;
        Self { run, next: 1, entries: BTreeMap::new() }
    }
}

impl SessionId {
    /// The session of a text such as `3f9a-7`.
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
        let inbox = Arc::<Inbox>::default();
        let (name, room, since) = (None, None, Instant::now());
        let address = address.to_canonical();
        let entry = Entry { name, address, key, room, since, inbox: inbox.clone() };
        let number = self.with(|table| {
            let number = table.next;
            table.next += 1;
            table.entries.insert(number, entry);
            number
        });
        Presence { number, visitors: self.clone(), inbox }
    }

    /// All visitors, in the order in which they came.
    pub fn list(&self) -> Vec<Present> {
        self.with(|table| {
            let present = |(&number, entry): (&u64, &Entry)| {
                entry.present(SessionId { run: table.run, number })
            };
            table.entries.iter().map(present).collect()
        })
    }

    /// The number of visitors.
    pub fn count(&self) -> usize {
        self.with(|table| table.entries.len())
    }

    /// Says a line to all visitors, and returns how many there are.
    pub fn say(&self, line: &str) -> usize {
        self.say_if(line, |_| true)
    }

    /// Says a line to those with a key.
    pub(crate) fn say_to(&self, key: &AccountKey, line: &str) {
        self.say_if(line, |entry| entry.key.as_ref() == Some(key));
    }

    /// Says a line to all visitors in a room.
    pub(crate) fn say_in(&self, room: &str, line: &str) {
        self.say_if(line, |entry| entry.room.as_deref() == Some(room));
    }

    fn say_if(&self, line: &str, is_meant: impl Fn(&Entry) -> bool) -> usize {
        self.with(|table| {
            let meant = table.entries.values().filter(|entry| is_meant(entry));
            meant.map(|entry| entry.inbox.say(line)).count()
        })
    }

    /// Ends the sessions of all visitors that a ban of `target` covers, with a sentence for them. Returns
    /// how many there are.
    pub fn remove(&self, target: &BanTarget, sentence: &str) -> usize {
        self.with(|table| {
            let removed =
                table.entries.values().filter(|entry| target.applies_to(&entry.identity()));
            removed.map(|entry| entry.inbox.remove(sentence)).count()
        })
    }

    /// Ends one session, with a sentence for the visitor. Returns whether it is one of this host.
    pub fn remove_session(&self, session: SessionId, sentence: &str) -> bool {
        self.with(|table| {
            let entry = table.entries.get(&session.number).filter(|_| table.run == session.run);
            entry.map(|entry| entry.inbox.remove(sentence)).is_some()
        })
    }

    fn with<T>(&self, act: impl FnOnce(&mut Table) -> T) -> T {
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Presence {
    /// Records the visitor's name: of an account, or chosen by a guest.
    pub fn set_name(&self, name: &str) {
        self.change(|entry| entry.name = Some(Name::kept(name)));
    }

    /// Records the room that the visitor is in, in a few words; `None` for the lobby.
    pub fn set_room(&self, room: Option<String>) {
        self.change(|entry| entry.room = room);
    }

    /// Waits for the next notice. It may be dropped before it is ready.
    pub async fn notice(&mut self) -> Notice {
        loop {
            if let Some(notice) = self.inbox.take() {
                return notice;
            }
            self.inbox.changed.notified().await;
        }
    }

    fn change(&self, act: impl FnOnce(&mut Entry)) {
        self.visitors.with(|table| table.entries.get_mut(&self.number).map(act));
    }
}

impl Drop for Presence {
    fn drop(&mut self) {
        self.visitors.with(|table| table.entries.remove(&self.number));
    }
}

impl Entry {
    fn present(&self, session: SessionId) -> Present {
        Present {
            session,
            name: self.name.clone(),
            address: self.address,
            key: self.key,
            room: self.room.clone(),
            time: self.since.elapsed(),
        }
    }

    fn identity(&self) -> Identity<'_> {
        Identity { address: Some(self.address), key: self.key.as_ref(), name: self.name.as_ref() }
    }
}

impl Inbox {
    fn say(&self, line: &str) {
        self.with(|notices| {
            notices.lines.push_back(line.to_owned());
            let surplus = notices.lines.len().saturating_sub(MAX_LINES);
            notices.lines.drain(..surplus);
        });
        self.changed.notify_one();
    }

    fn remove(&self, sentence: &str) {
        self.with(|notices| notices.removed = Some(sentence.to_owned()));
        self.changed.notify_one();
    }

    /// A removal comes before lines.
    fn take(&self) -> Option<Notice> {
        self.with(|notices| {
            let removed = notices.removed.take().map(Notice::Removed);
            removed.or_else(|| notices.lines.pop_front().map(Notice::Said))
        })
    }

    fn with<T>(&self, act: impl FnOnce(&mut Notices) -> T) -> T {
        act(&mut self.notices.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

#[cfg(test)]
mod tests;

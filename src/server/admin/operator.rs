//! What a request does.

use std::fmt;
use std::sync::Arc;

use tokio::sync::Notify;

use super::{AdminReply, AdminRequest, RoomRow, VisitorRow};
use crate::server::line::Line;
use crate::server::logging::events;
use crate::server::visitors::{Present, Visitors};

/// What an operator can see and change in a server.
pub struct Operator {
    /// Who is on.
    pub visitors: Visitors,
    /// The rooms now.
    pub rooms: Box<dyn Fn() -> Vec<RoomRow> + Send + Sync>,
    /// Notified when the server has to end.
    pub drain: Arc<Notify>,
}

/// The longest line that an operator says, in columns.
const SAID_COLUMNS: usize = 200;
/// The longest reason, in columns.
const REASON_COLUMNS: usize = 200;

impl Operator {
    /// Does what is asked.
    pub fn answer(&self, request: &AdminRequest) -> AdminReply {
        match request {
            AdminRequest::Who => {
                AdminReply::Visitors(self.visitors.list().into_iter().map(row).collect())
            }
            AdminRequest::Rooms => AdminReply::Rooms((self.rooms)()),
            AdminRequest::Remove { target, reason, banned } => match target.to_ban() {
                Err(sentence) => AdminReply::Fault(sentence),
                Ok(target) => {
                    let count = self.visitors.remove(&target, &farewell(reason, *banned));
                    events::removed(&target, count, *banned);
                    AdminReply::Count(count)
                }
            },
            AdminRequest::Say { text } => match Line::of(text, SAID_COLUMNS) {
                None => AdminReply::Fault("there is nothing to say".to_owned()),
                Some(line) => {
                    let count = self.visitors.say(line.as_str());
                    events::said(count);
                    AdminReply::Count(count)
                }
            },
            AdminRequest::Drain => {
                self.drain.notify_one();
                AdminReply::Count(self.visitors.list().len())
            }
        }
    }
}

impl fmt::Debug for Operator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Operator").field("visitors", &self.visitors).finish_non_exhaustive()
    }
}

/// The sentence for those who are sent away.
pub(crate) fn farewell(reason: &str, is_banned: bool) -> String {
    let what = if is_banned {
        "You are banned from this host"
    } else {
        "The operator of this host has ended your session"
    };
    match Line::of(reason, REASON_COLUMNS) {
        Some(reason) => format!("{what}: {reason}"),
        None => format!("{what}."),
    }
}

fn row(present: Present) -> VisitorRow {
    VisitorRow {
        name: present.name.map(|name| name.as_str().to_owned()),
        address: present.address.to_string(),
        key: present.key.map(|key| key.to_string()),
        room: present.room,
        seconds: present.time.as_secs(),
    }
}

//! The effect of an admin request: on this host, and on all hosts of a cluster.

#[cfg(unix)]
pub mod socket;

use std::sync::Arc;

use tokio::sync::watch;

use crate::admin::{AdminReply, AdminRequest, RoomRow, Target};
use crate::cluster::SharedRooms;
use crate::line::Line;
use crate::logging;
use crate::rooms::room::NAME_COLUMNS;
use crate::visitors::{Heard, Visitors};

/// The parts of a server that an operator can see and change. Clones share them.
#[derive(Clone)]
pub struct Operator {
    /// The visitors of this host.
    visitors: Visitors,
    /// Returns the current rooms.
    rooms: Arc<dyn Fn() -> Vec<RoomRow> + Send + Sync>,
    /// How many times the server was asked to end.
    ends: watch::Sender<u32>,
    /// The other hosts, in a cluster.
    cluster: Option<SharedRooms>,
}

/// The longest line that an operator can say, in columns.
const SAID_COLUMNS: usize = 200;
/// The longest reason, in columns.
const REASON_COLUMNS: usize = 200;

impl Operator {
    /// Creates an operator of these visitors and rooms. It counts a request to end the server in `ends`.
    pub(crate) fn new(
        visitors: Visitors,
        rooms: impl Fn() -> Vec<RoomRow> + Send + Sync + 'static,
        ends: watch::Sender<u32>,
        cluster: Option<SharedRooms>,
    ) -> Self {
        Self { visitors, rooms: Arc::new(rooms), ends, cluster }
    }

    /// Carries out a request, on all hosts of a cluster if the request is for all of them.
    pub async fn answer(&self, request: &AdminRequest) -> AdminReply {
        let own = self.answer_alone(request);
        if let Some(cluster) = &self.cluster
            && request.is_for_all_hosts()
            && own.fault.is_none()
        {
            return cluster.merged(own, request).await;
        }
        own
    }

    /// Answers the operators of other hosts until the future is dropped.
    pub async fn answer_others(self) {
        if let Some(cluster) = self.cluster.clone() {
            cluster.answer_others(|request| self.answer_alone(request)).await;
        }
    }

    /// Carries out a request on this host.
    pub(crate) fn answer_alone(&self, request: &AdminRequest) -> AdminReply {
        match request {
            AdminRequest::Who => {
                let mut visitors = self.visitors.list();
                if let Some(cluster) = &self.cluster {
                    let host = cluster.own_info().host;
                    for row in &mut visitors {
                        row.host = Some(host.clone());
                    }
                }
                AdminReply { visitors, ..AdminReply::default() }
            }
            AdminRequest::Hosts => match &self.cluster {
                Some(cluster) => {
                    AdminReply { hosts: vec![cluster.own_info()], ..AdminReply::default() }
                }
                None => AdminReply::of_fault("this host is not in a cluster"),
            },
            AdminRequest::Rooms => AdminReply { rooms: (self.rooms)(), ..AdminReply::default() },
            AdminRequest::Remove { target, reason, banned, moderator } => {
                let sentence = farewell(reason, *banned, moderator.as_deref());
                AdminReply::of_count(self.remove(target, &sentence, *banned))
            }
            AdminRequest::Tell { from, to, text } => {
                let (from, text) = (from.clone(), text.clone());
                let line = Heard { from, text, is_private: true };
                AdminReply::of_count(self.visitors.tell(to, &line))
            }
            AdminRequest::Say { text } => match Line::of(text, SAID_COLUMNS) {
                None => AdminReply::of_fault("the line contains no printable character"),
                Some(line) => {
                    let count = self.visitors.say(line.as_str());
                    logging::said(count);
                    AdminReply::of_count(count)
                }
            },
            AdminRequest::Drain => {
                self.ends.send_modify(|count| *count = 1.max(*count));
                AdminReply::of_count(self.visitors.count())
            }
        }
    }

    /// Ends the sessions of `target`, and returns their number.
    fn remove(&self, target: &Target, sentence: &str, is_banned: bool) -> usize {
        match target {
            Target::Session(session) => {
                let count = usize::from(self.visitors.remove_session(*session, sentence));
                logging::removed_session(*session, count);
                count
            }
            Target::Visitors(target) => {
                let count = self.visitors.remove(target, sentence);
                logging::removed(target, count, is_banned);
                count
            }
        }
    }
}

/// The sentence for visitors whose sessions are ended.
pub(crate) fn farewell(reason: &str, is_banned: bool, moderator: Option<&str>) -> String {
    let moderator = moderator.and_then(|name| Line::of(name, NAME_COLUMNS));
    let what = match moderator {
        _ if is_banned => "You are banned from this host".to_owned(),
        Some(name) => format!("The moderator {name} has ended your session"),
        None => "The operator of this host has ended your session".to_owned(),
    };
    match Line::of(reason, REASON_COLUMNS) {
        Some(reason) => format!("{what}: {reason}"),
        None => format!("{what}."),
    }
}

#[cfg(test)]
mod tests;

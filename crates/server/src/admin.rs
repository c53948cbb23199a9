//! The requests of an operator to a running server, over a socket in its data folder.
//!
//! A connection carries one [`AdminRequest`] and one [`AdminReply`], each a line of JSON. The socket is
//! `admin.sock`. Only its owner can open it, and the server answers only that user and root.
//!
//! In a cluster, the server asks all hosts, and the reply names the hosts that have not answered. To end a host,
//! the operator asks that host's own socket.
//!
//! A ban or a mute is not a request. `cellcaster-server admin` writes it to the store, so that an operator can ban
//! somebody while no server runs. A request then ends the sessions that the ban applies to.
//!
//! In a cluster, moderators' kicks and messages between visitors of different hosts are also requests.
//!
//! Rejected: a TCP port with a password. Every user of the machine could reach it.

use serde::{Deserialize, Serialize};

use crate::accounts::{BanTarget, Name};
use crate::visitors::{SessionId, VisitorRow};

/// A request of an operator.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
pub enum AdminRequest {
    /// Lists the visitors.
    Who,
    /// Lists the rooms.
    Rooms,
    /// Ends the sessions of some visitors.
    Remove {
        /// The visitors.
        target: Target,
        /// The reason, which they read; may be empty.
        reason: String,
        /// `true` if they are banned.
        banned: bool,
        /// The name of the moderator who ends the sessions; `None` if an operator ends them.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        moderator: Option<String>,
    },
    /// Shows a line from one visitor to another.
    Tell {
        /// The name of the visitor who wrote it.
        from: String,
        /// The name of the visitor who reads it.
        to: Name,
        /// The line.
        text: String,
    },
    /// Shows a line to all visitors.
    Say {
        /// The line. Only its printable characters are shown.
        text: String,
    },
    /// Lists the hosts of the cluster.
    Hosts,
    /// Ends the server as a signal does. The reply counts the visitors that it waits for.
    Drain,
}

/// The visitors whose sessions a request ends.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Target {
    /// The visitor with this session.
    Session(SessionId),
    /// The visitors that a ban would apply to.
    #[serde(untagged)]
    Visitors(BanTarget),
}

/// The reply of a server, with the list or the number that the request asks for.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AdminReply {
    /// The visitors.
    pub visitors: Vec<VisitorRow>,
    /// The rooms.
    pub rooms: Vec<RoomRow>,
    /// The hosts of a cluster.
    pub hosts: Vec<HostInfo>,
    /// The number of visitors that the request affects.
    pub count: usize,
    /// Remarks on the reply, such as that a host of a cluster did not answer.
    pub remarks: Vec<String>,
    /// The reason for a refusal.
    pub fault: Option<String>,
}

/// A host of a cluster. The names of the fields must stay, because `cellcaster-server admin hosts --format json` prints
/// them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct HostInfo {
    /// The name of the machine, and the port.
    pub host: String,
    /// The address at which the host listens.
    pub address: String,
    /// The version of the program.
    pub version: String,
    /// The number of visitors.
    pub visitors: usize,
    /// The rooms whose logs the host writes; `None` if it did not answer.
    pub rooms: Option<Vec<u32>>,
    /// The seconds since the host last announced itself.
    pub seconds: u64,
    /// The keys of the host's own maps: the name of each, and a hash of its text; `None` if the host did not
    /// answer.
    #[serde(default)]
    pub maps: Option<Vec<String>>,
}

/// A room. The names of the fields must stay, too.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RoomRow {
    /// The number.
    pub room: u32,
    /// The name of the mode.
    pub mode: String,
    /// The name of the level.
    pub level: String,
    /// The name of the difficulty.
    pub difficulty: String,
    /// The names of the members.
    pub members: Vec<String>,
    /// The most members that it takes.
    pub most: usize,
    /// The number of watchers.
    pub watchers: usize,
    /// `true` if only visitors with its code enter the room.
    #[serde(default)]
    pub is_private: bool,
}

impl AdminRequest {
    /// Returns true if all hosts of a cluster answer the request. For the list of rooms one host is enough, because
    /// all hosts have the same list.
    pub(crate) fn is_for_all_hosts(&self) -> bool {
        match self {
            Self::Who
            | Self::Hosts
            | Self::Say { .. }
            | Self::Remove { .. }
            | Self::Tell { .. } => true,
            Self::Rooms | Self::Drain => false,
        }
    }
}

impl AdminReply {
    /// The reply to a request that affects `count` visitors.
    pub(crate) fn of_count(count: usize) -> Self {
        Self { count, ..Self::default() }
    }

    /// A refusal.
    pub(crate) fn of_fault(sentence: impl Into<String>) -> Self {
        Self { fault: Some(sentence.into()), ..Self::default() }
    }
}

//! What an operator asks a running server, over a socket in its data folder.
//!
//! A connection carries one [`AdminRequest`] and one [`AdminReply`], each a line of JSON. The socket
//! is `admin.sock`, for its owner alone, and the server answers that user and root only.
//!
//! In a cluster, the server asks all hosts, and the reply says which ones have not answered. To end a host, its own
//! socket is asked.
//!
//! Bans are no request: the store keeps them, and `cellcaster admin` writes them there, so that they
//! can be made while no server runs. A request then ends the sessions to which the ban applies.
//!
//! Rejected: a port of TCP with a password. Every user of the machine could reach it.

use serde::{Deserialize, Serialize};

use crate::accounts::{AccountKey, AddressPrefix, BanTarget, Name};

/// What an operator asks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase", deny_unknown_fields)]
pub enum AdminRequest {
    /// The visitors: [`AdminReply::Visitors`].
    Who,
    /// The rooms: [`AdminReply::Rooms`].
    Rooms,
    /// To end the sessions of some visitors: [`AdminReply::Count`].
    Remove {
        /// Which ones.
        target: Target,
        /// Why, for them to read; may be empty.
        reason: String,
        /// Whether they are banned.
        banned: bool,
    },
    /// To say a line to all visitors: [`AdminReply::Count`].
    Say {
        /// The line. Only its printable characters are shown.
        text: String,
    },
    /// The hosts of the cluster: [`AdminReply::Hosts`].
    Hosts,
    /// To end the server as a signal does: [`AdminReply::Count`], the visitors whom it waits for.
    Drain,
}

/// Some visitors, as a text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Target {
    /// Those who are called so, or nearly so.
    Name(String),
    /// Those with the key of this fingerprint.
    Key(String),
    /// Those with an address in this range.
    Address(String),
    /// The one with this session.
    Session(String),
}

/// What a server answers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AdminReply {
    /// Who is on.
    Visitors(Vec<VisitorRow>),
    /// The rooms.
    Rooms(Vec<RoomRow>),
    /// The hosts of a cluster.
    Hosts(Vec<HostInfo>),
    /// How many visitors the request concerns.
    Count(usize),
    /// What all hosts of a cluster answer together.
    AllHosts {
        /// Their answer.
        reply: Box<AdminReply>,
        /// What is to be known of it, such as that a host did not answer.
        remarks: Vec<String>,
    },
    /// Why the request was refused.
    Fault(String),
}

/// A visitor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct VisitorRow {
    /// Their session; empty from a host of a version without.
    #[serde(default)]
    pub session: String,
    /// The name; `None` until it is chosen.
    pub name: Option<String>,
    /// The address that they connect from.
    pub address: String,
    /// The fingerprint of their key; `None` for a guest.
    pub key: Option<String>,
    /// The room; `None` for the lobby.
    pub room: Option<String>,
    /// For how long they have been here.
    pub seconds: u64,
    /// The host that they are on, in a cluster.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub host: Option<String>,
}

/// A host of a cluster.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct HostInfo {
    /// The name of its machine, and the port.
    pub host: String,
    /// The address that it listens at.
    pub address: String,
    /// The version of its program.
    pub version: String,
    /// The number of its visitors.
    pub visitors: usize,
    /// The rooms whose logs it writes; `None` if it did not answer.
    pub rooms: Option<Vec<u32>>,
    /// How long ago it has announced itself.
    pub seconds: u64,
    /// The keys of its own maps: the name of each, and a hash of its text; `None` if it did not answer.
    #[serde(default)]
    pub maps: Option<Vec<String>>,
}

/// A room.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RoomRow {
    /// Its number.
    pub room: u32,
    /// The name of the mode.
    pub mode: String,
    /// The name of the level.
    pub level: String,
    /// The name of the difficulty.
    pub difficulty: String,
    /// The names of its members.
    pub members: Vec<String>,
    /// The most members.
    pub most: usize,
    /// The number of those who watch.
    pub watchers: usize,
}

impl AdminRequest {
    /// Whether all hosts of a cluster answer it. All of them have the same list of rooms.
    pub(crate) fn is_for_all_hosts(&self) -> bool {
        match self {
            Self::Who | Self::Hosts | Self::Say { .. } | Self::Remove { .. } => true,
            Self::Rooms | Self::Drain => false,
        }
    }
}

impl Target {
    /// What a ban of them applies to.
    ///
    /// # Errors
    /// A sentence, if the text is no fingerprint or no range of addresses, or the target is a session.
    pub fn to_ban(&self) -> Result<BanTarget, String> {
        match self {
            Self::Name(name) => {
                let name = Name::kept(name);
                let has_text = !name.as_str().is_empty();
                has_text.then_some(BanTarget::Name(name)).ok_or("this is no name".to_owned())
            }
            Self::Key(key) => AccountKey::parse(key).map(BanTarget::Key).ok_or_else(|| {
                "a key is written as its fingerprint, SHA256: and 43 characters".to_owned()
            }),
            Self::Address(range) => {
                let range = AddressPrefix::parse(range).map(BanTarget::Addresses);
                range.ok_or_else(|| "addresses are written as 203.0.113.0/24 or as one".to_owned())
            }
            Self::Session(_) => {
                Err("a session is no target of a ban: name a player, a key or addresses".to_owned())
            }
        }
    }
}

//! The SSH server in which people play together.
//!
//! A [`Server`] accepts connections and turns each into a [`Visitor`] and a [`Link`], which it hands to
//! a [`Host`]. Everything that can be decided without a socket is decided by code without one:
//! [`Admission`] takes time and chance as arguments.
//!
//! # Rules
//!
//! - A visitor holds one session channel with a terminal, and nothing else: no command, subsystem,
//!   forwarding, agent or X11.
//! - A public key is an account, and its comment does not matter. A visitor without a key is a guest.
//! - Memory for a connection is bounded in both directions. What a client sends waits in its socket
//!   while the session is busy, and at most one frame waits for a client that does not read.
//! - A client costs the others nothing: connections, bytes and time before authentication are
//!   limited, and so are the bytes a second after it.
//!
//! `russh`'s own accept loop was refused: it has no limit of connections, no deadline before
//! authentication, and its queue to a channel tells nothing about the socket.

mod admin;
mod admission;
mod bucket;
#[cfg(feature = "cluster")]
mod cluster;
mod config;
mod driver;
#[cfg(fuzzing)]
#[doc(hidden)]
pub mod fuzzing;
mod ghost;
mod governor;
mod host_key;
mod line;
mod load;
mod lock;
mod logging;
mod maps;
mod metrics;
mod recorded;
mod room;
mod rooms;
mod sequencer;
mod session;
#[cfg(test)]
mod simulation;
mod summary;
mod transport;
mod visitors;

#[cfg(unix)]
pub use self::admin::{AdminFailure, AdminSocket, ask};
pub use self::admin::{AdminReply, AdminRequest, HostInfo, Operator, RoomRow, Target, VisitorRow};
pub use self::admission::{Admission, Admitted, Limits, Outcome, Refusal, VisitId};
#[cfg(feature = "cluster")]
pub use self::cluster::Cluster;
pub use self::config::{Config, LiveConfig, StandingRoom};
pub use self::driver::{GameHost, HostParts};
pub use self::host_key::{HostKey, HostKeyError};
use self::lock::locked;
pub(crate) use self::logging::events;
pub use self::logging::{LogFilter, LogFormat, Logging, UnknownLogFilter};
pub use self::maps::{HostMaps, MOST_BYTES, MOST_MAP_BYTES, MOST_MAPS, MapsError};
pub use self::metrics::{Counter, EachRoom, Gauge, Histogram, Metrics, RoomFigures, respond};
pub use self::recorded::{MOST_RECORDED_BYTES, RecordedRound, is_room_recording, replay_room};
pub use self::transport::{
    Arrival, Counters, Departure, Host, Inbound, KeyData, Link, Outbox, Server, Visitor,
};
pub use self::visitors::{Notice, Presence, Present, SessionId, Visitors};

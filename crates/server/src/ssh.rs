//! The SSH transport: from sockets to visitors.

mod client;
mod connection;
#[cfg(feature = "fuzzing")]
pub(crate) mod fuzzing;
mod gate;
pub mod host_key;
mod inbound;
mod outbox;
mod proxy_header;
mod server;
#[cfg(test)]
mod simulated;
mod visitor;
mod wire;

pub use inbound::{Arrival, Inbound};
pub use outbox::Outbox;
pub use server::Server;
#[cfg(test)]
pub(crate) use simulated::{ClientEnd, Parts, pipe};
pub use visitor::{Departure, Host, Link, Visitor};

//! From sockets to visitors.

pub mod admission;
mod client;
mod connection;
mod explanation;
#[cfg(fuzzing)]
pub(crate) mod fuzzing;
mod gate;
mod hello;
pub mod host_key;
mod inbound;
mod outbox;
#[cfg(test)]
mod pipe;
mod server;
mod visitor;
mod wire;

pub use inbound::{Arrival, Inbound};
pub use outbox::Outbox;
#[cfg(test)]
pub(crate) use pipe::{FarEnd, Parts, pipe};
pub use server::Server;
pub use visitor::{Departure, Host, Link, Visitor};

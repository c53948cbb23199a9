//! The SSH server in which people play Cellcaster together.
//!
//! ```text
//! socket ─ ssh ─▶ Link + Visitor ─ sessions ─▶ requests ─ rooms ─▶ snapshots ─ sessions ─▶ frames ─ ssh ─▶ socket
//! ```
//!
//! ARCHITECTURE.md has the table of the modules.
//!
//! # Rules
//!
//! - A visitor gets one session channel with a terminal, and nothing else: no command, subsystem, forwarding, agent or
//!   X11.
//! - A public key identifies an account; the comment of the key is ignored. A visitor without a key is a guest.
//! - Memory per connection is bounded in both directions. While a session is busy, the client's input waits in the
//!   socket. At most one frame waits for a client that does not read.
//! - A client cannot slow down the others. Connections, bytes and time before authentication are limited, and so are
//!   the bytes per second after it.
//! - Policies take the time and random numbers as arguments. Only [`ssh`], [`operator`] and [`metrics`] open sockets.
//!
//! Rejected: `russh`'s own accept loop. It has no limit on connections and no deadline before authentication, and its
//! queue to a channel says nothing about the socket.

#![allow(missing_docs, reason = "the crate is a program, not an interface for others")]

pub mod accounts;
pub mod admin;
pub mod admission;
mod bucket;
pub mod cli;
pub mod cluster;
pub mod config;
#[cfg(feature = "fuzzing")]
#[doc(hidden)]
pub mod fuzzing;
mod line;
mod load;
pub mod logging;
pub mod metrics;
pub mod operator;
pub mod rooms;
mod service;
pub mod sessions;
#[cfg(test)]
mod simulation;
pub mod ssh;
pub mod visitors;

mod lock {
    use std::sync::{Mutex, PoisonError};

    /// Runs `act` on the value behind a lock, even if a panic has poisoned it. The lock is never held across an await.
    pub(crate) fn locked<T, R>(mutex: &Mutex<T>, act: impl FnOnce(&mut T) -> R) -> R {
        act(&mut mutex.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

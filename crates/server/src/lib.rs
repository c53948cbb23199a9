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
//! - A visitor holds one session channel with a terminal, and nothing else: no command, subsystem,
//!   forwarding, agent or X11.
//! - A public key is an account, and its comment does not matter. A visitor without a key is a guest.
//! - Memory for a connection is bounded in both directions. What a client sends waits in its socket
//!   while the session is busy, and at most one frame waits for a client that does not read.
//! - A client costs the others nothing: connections, bytes and time before authentication are
//!   limited, and so are the bytes a second after it.
//! - Policies take time and chance as arguments; only [`ssh`], [`operator`] and [`metrics`] have sockets.
//!
//! Rejected: `russh`'s own accept loop. It has no limit of connections, no deadline before
//! authentication, and its queue to a channel tells nothing about the socket.

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

    /// Acts on the value behind a lock, which is never held across an await. A panic elsewhere does not close the lock.
    pub(crate) fn locked<T, R>(mutex: &Mutex<T>, act: impl FnOnce(&mut T) -> R) -> R {
        act(&mut mutex.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

//! `cellcaster-server`: an SSH server in which people play Cellcaster together, with nothing but `ssh`.
//!
//! ```no_run
//! let words = ["cellcaster-server", "--listen", "127.0.0.1:2222"];
//! let status = cellcaster_server::cli::run(words.map(Into::into));
//! ```
//!
//! This prints the command that players type, and serves until a signal ends it. docs/hosting.md in the repository is
//! the guide for operators. This page is a guide to the code.
//!
//! # The flow
//!
//! ```text
//! socket ─ ssh ─▶ Link + Visitor ─ sessions ─▶ requests ─ rooms ─▶ snapshots ─ sessions ─▶ frames ─ ssh ─▶ socket
//! ```
//!
//! Follow a key that a player presses:
//!
//! 1. [`ssh`] accepts the connection, if [`admission`] allows it, and authenticates the visitor. A visitor gets one
//!    session channel with a terminal, and nothing else: no command, subsystem, forwarding, agent or X11. A public key
//!    identifies an account of [`accounts`]; the comment of the key is ignored. A visitor without a key is a guest.
//! 2. The driver of the visitor's session in [`sessions`] owns the connection and the clock. It passes the bytes to the
//!    session, which decodes them into a key, and turns the key into a request.
//! 3. The sequencer of a room in [`rooms`] collects the requests of all members into the log, and steps the room sixty
//!    times a second. A room is a deterministic state machine: its log and the number of steps determine it, bit for
//!    bit.
//! 4. Each step makes a snapshot. The session draws it into a frame, with the widgets and the encoder of
//!    [`cellcaster`].
//! 5. The frame leaves by the visitor's outbox, which holds at most one. A client that does not read gets no more
//!    frames, and costs no more memory.
//!
//! In a [`cluster`], several hosts hold copies of a room. One of them, by a lease, writes its log on a bus, and all
//! apply it.
//!
//! # Rules
//!
//! - Memory per connection is bounded in both directions. While a session is busy, the client's input waits in the
//!   socket.
//! - A client cannot slow down the others. Connections, bytes and time before authentication are limited, and so are
//!   the bytes per second after it.
//! - Policies take the time and random numbers as arguments. Only [`ssh`], [`operator`], [`metrics`] and `web` open
//!   sockets.
//!
//! Rejected: `russh`'s own accept loop. It has no limit on connections and no deadline before authentication, and its
//! queue to a channel says nothing about the socket.
//!
//! # Where to go next
//!
//! - A room by itself: `rooms/room.rs`. A session by itself: `sessions/session.rs`.
//! - All of it in simulated time, with links that fail: `simulation.rs`, a part of the tests.
//! - What an operator can do: [`config`] and [`admin`].
//! - ARCHITECTURE.md has the table of the modules and their invariants.

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
mod web;

mod queue {
    use std::collections::VecDeque;

    /// Adds an item to a queue of at most `most` items. The oldest item makes room for it.
    pub(crate) fn push_within<T>(queue: &mut VecDeque<T>, item: T, most: usize) {
        queue.push_back(item);
        if queue.len() > most {
            queue.pop_front();
        }
    }
}

mod lock {
    use std::sync::{Mutex, PoisonError};

    /// Runs `act` on the value behind a lock, even if a panic has poisoned it. The lock is never held across an await.
    pub(crate) fn locked<T, R>(mutex: &Mutex<T>, act: impl FnOnce(&mut T) -> R) -> R {
        act(&mut mutex.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

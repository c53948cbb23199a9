//! The SSH server: real clients of OpenSSH in pseudo-terminals, and clients that break the rules.
#![cfg(all(unix, feature = "serve"))]

#[allow(dead_code, reason = "this file uses a share of it")]
#[path = "../support/emulator.rs"]
mod emulator;
#[path = "../support/player.rs"]
mod player;
mod transport;

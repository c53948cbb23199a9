//! A multiplayer host: real OpenSSH clients in pseudo-terminals, clients that break the rules, and the data
//! that survives.
#![cfg(unix)]

#[path = "../../../../tests/support/emulator.rs"]
mod emulator;
mod kept;
#[path = "../../../../tests/support/looks.rs"]
mod looks;
#[cfg(feature = "system-tests")]
#[path = "../support/nats_server.rs"]
mod nats_server;
mod ops;
mod play;
#[path = "../../../../tests/support/player.rs"]
mod player;
#[cfg(feature = "system-tests")]
#[path = "../support/postgres_server.rs"]
mod postgres_server;
mod running;
mod scores;
mod soak;
#[cfg(all(target_os = "linux", feature = "system-tests"))]
#[path = "../../../../tests/support/strace.rs"]
mod strace;
#[path = "../support/mod.rs"]
mod support;
mod transport;

//! A host on which people play together: real clients of OpenSSH in pseudo-terminals, clients that
//! break the rules, and what is kept.
#![cfg(unix)]

#[path = "../support/emulator.rs"]
mod emulator;
mod kept;
#[path = "../../examples/load/lamp.rs"]
mod lamp;
#[path = "../support/looks.rs"]
mod looks;
#[cfg(feature = "system-tests")]
#[path = "../support/nats_server.rs"]
mod nats_server;
mod ops;
mod play;
#[path = "../support/player.rs"]
mod player;
#[cfg(feature = "system-tests")]
#[path = "../support/postgres_server.rs"]
mod postgres_server;
mod scores;
mod soak;
#[cfg(all(target_os = "linux", feature = "system-tests"))]
#[path = "../support/strace.rs"]
mod strace;
#[path = "../support/mod.rs"]
mod support;
mod transport;

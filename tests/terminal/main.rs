//! The program in a terminal: the encoder's bytes in emulators, and whole games in a
//! pseudo-terminal.

mod encoding;
mod palette;
mod play;
mod session;

#[path = "../support/asciicast.rs"]
mod asciicast;
#[path = "../support/emulator.rs"]
mod emulator;
#[path = "../support/looks.rs"]
mod looks;
#[path = "../support/player.rs"]
mod player;
#[cfg(target_os = "linux")]
#[path = "../support/strace.rs"]
mod strace;
#[path = "../support/mod.rs"]
mod support;

//! The whole program in a real terminal: what it shows, what keys do, and how it ends.
#![cfg(all(unix, feature = "cli"))]

#[path = "support/mod.rs"]
mod support;

#[path = "support/asciicast.rs"]
mod asciicast;
#[path = "support/emulator.rs"]
mod emulator;
#[path = "support/looks.rs"]
mod looks;
#[path = "support/player.rs"]
mod player;

#[path = "play/digging.rs"]
mod digging;
#[path = "play/doors.rs"]
mod doors;
#[path = "play/ending.rs"]
mod ending;
#[path = "play/game.rs"]
mod game;
#[path = "play/holding.rs"]
mod holding;
#[path = "play/lagging.rs"]
mod lagging;
#[path = "play/layouts.rs"]
mod layouts;
#[path = "play/levels.rs"]
mod levels;
#[path = "play/looking.rs"]
mod looking;
#[path = "play/mouse.rs"]
mod mouse;
#[path = "play/moving.rs"]
mod moving;
#[path = "play/palette.rs"]
mod palette;
#[path = "play/recording.rs"]
mod recording;
#[path = "play/resting.rs"]
mod resting;
#[path = "play/settings.rs"]
mod settings;
#[path = "play/showing.rs"]
mod showing;
#[path = "play/watching.rs"]
mod watching;

//! The fuzz targets of Cellcaster.
//!
//! Each target is a function `run` of bytes that returns for every input, or panics where something is
//! wrong. libFuzzer calls it from `libfuzzer.rs`, and the test `corpus` with the inputs of `corpus`.

#[cfg(fuzzing)]
mod admin;
#[cfg(fuzzing)]
mod channel;
#[cfg(fuzzing)]
mod checkpoint;
#[cfg(fuzzing)]
mod cluster;
mod decoder;
mod encoder;
#[cfg(fuzzing)]
mod login;
pub mod maps;
#[cfg(fuzzing)]
mod operators;
mod png;
#[cfg(fuzzing)]
mod recording;
#[cfg(fuzzing)]
mod room;
#[cfg(fuzzing)]
mod rows;
#[cfg(fuzzing)]
mod texts;
#[cfg(fuzzing)]
mod typing;
mod waiting;

#[path = "../../tests/support/alacritty.rs"]
mod alacritty;
mod bytes;
mod faults;
mod files;
mod folder;
#[path = "../../tests/support/open.rs"]
mod open;
#[cfg(fuzzing)]
mod ssh;

/// A target, of which the corpus is in the folder of its name.
#[derive(Clone, Copy)]
pub struct Target {
    /// The name, in `fuzz/run`, too.
    pub name: &'static str,
    /// Tries an input.
    pub run: fn(&[u8]),
}

/// All targets. Some need what the crate opens with `--cfg fuzzing`.
pub const TARGETS: &[Target] = &[
    #[cfg(fuzzing)]
    Target { name: "admin", run: admin::run },
    #[cfg(fuzzing)]
    Target { name: "channel", run: channel::run },
    #[cfg(fuzzing)]
    Target { name: "checkpoint", run: checkpoint::run },
    #[cfg(fuzzing)]
    Target { name: "cluster", run: cluster::run },
    Target { name: "decoder", run: decoder::run },
    Target { name: "encoder", run: encoder::run },
    #[cfg(fuzzing)]
    Target { name: "login", run: login::run },
    Target { name: "maps", run: maps::run },
    #[cfg(fuzzing)]
    Target { name: "operators", run: operators::run },
    Target { name: "png", run: png::run },
    #[cfg(fuzzing)]
    Target { name: "recording", run: recording::run },
    #[cfg(fuzzing)]
    Target { name: "room", run: room::run },
    #[cfg(fuzzing)]
    Target { name: "rows", run: rows::run },
    #[cfg(fuzzing)]
    Target { name: "texts", run: texts::run },
    #[cfg(fuzzing)]
    Target { name: "typing", run: typing::run },
    Target { name: "waiting", run: waiting::run },
];

//! The fuzz targets of Cellcaster.
//!
//! Each target is a function `run` that takes bytes. It returns for every input, or panics if
//! something is wrong. libFuzzer calls it from `libfuzzer.rs`, and the test `corpus` calls it with
//! the inputs in `corpus`.

mod admin;
mod channel;
mod checkpoint;
mod cluster;
mod decoder;
mod encoder;
mod login;
pub mod maps;
mod operators;
mod png;
mod recording;
mod room;
mod rows;
mod texts;
mod tiled;
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
mod ssh;

/// A target. Its corpus is in the folder with its name.
#[derive(Clone, Copy)]
pub struct Target {
    /// The name, which is also the target's name in `fuzz/run`.
    pub name: &'static str,
    /// Tries an input.
    pub run: fn(&[u8]),
}

/// All targets.
pub const TARGETS: &[Target] = &[
    Target { name: "admin", run: admin::run },
    Target { name: "channel", run: channel::run },
    Target { name: "checkpoint", run: checkpoint::run },
    Target { name: "cluster", run: cluster::run },
    Target { name: "decoder", run: decoder::run },
    Target { name: "encoder", run: encoder::run },
    Target { name: "login", run: login::run },
    Target { name: "maps", run: maps::run },
    Target { name: "operators", run: operators::run },
    Target { name: "png", run: png::run },
    Target { name: "recording", run: recording::run },
    Target { name: "room", run: room::run },
    Target { name: "rows", run: rows::run },
    Target { name: "texts", run: texts::run },
    Target { name: "tiled", run: tiled::run },
    Target { name: "typing", run: typing::run },
    Target { name: "waiting", run: waiting::run },
];

//! Error against bytes: what a game costs on the wire, and what of it the viewer sees.
//!
//! A script is played once, and each of its frames goes through every encoder: ratatui's own for
//! crossterm, which most programs use, and ours at several fidelities. Counted are bytes, and bytes
//! after the compression of `ssh -C`; compared are the colours that the terminal shows with those
//! that the game drew. The distance of two colours is CIE76's ΔE, the one of the figures that are
//! published on terminal video; CIEDE2000 was refused, as it is meant for colours closer than most of
//! these, and its sectors of hue have steps.
//!
//! The first frame paints everything, whoever encodes it, and is told apart.

mod compression;
mod difference;
mod encoder;
mod lab;
mod palettes;
mod pipeline;
mod tally;

use std::num::NonZeroU32;

use ratatui::buffer::Buffer;
use ratatui::layout::Size;

use crate::game::Script;
use crate::palette::ColorDepth;
use crate::terminal::Fidelity;
use crate::tui::Replay;
use encoder::{Brevity, Encoder, Stock, Writer};
use tally::Tally;

pub use palettes::{GREY, PalettePlan, PaletteRow, report_palettes};
pub use pipeline::{PipelineRow, measure_pipeline};
pub use tally::{Bytes, Compressed, Part, Seen};

/// What to measure.
#[derive(Debug)]
pub struct Plan<'a> {
    /// What is played.
    pub script: &'a Script,
    /// The size of the window that `replay` plays in.
    pub size: Size,
    /// The colours that `replay` draws in. Only in true colour does an encoder define a palette.
    pub depth: ColorDepth,
    /// How many frames a second are sent.
    pub frames_per_second: NonZeroU32,
    /// The fidelities at which our encoder is measured.
    pub fidelities: Vec<Fidelity>,
}

/// What was measured.
#[derive(Clone, Debug)]
pub struct Report {
    /// How many frames there were after the first.
    pub frames: usize,
    /// Ratatui's encoder, then ours at each fidelity, and then ours at each with repeated characters and a palette.
    pub encoders: Vec<EncoderReport>,
}

/// What was measured of one encoder.
#[derive(Clone, Debug)]
pub struct EncoderReport {
    /// What it is called: `stock`, a fidelity, or a fidelity and `+`: with repeated characters and a palette.
    pub name: String,
    /// What the first frame took, in bytes.
    pub first_frame: usize,
    /// Every section of the script that has a name, in order; one name is one section.
    pub sections: Vec<Part>,
    /// All frames but the first.
    pub all: Part,
}

/// Plays the script of `plan` and measures.
pub fn report(plan: &Plan, replay: &mut Replay) -> Report {
    let ours = [Brevity::None, Brevity::Tried].into_iter().flat_map(|brevity| {
        plan.fidelities.iter().map(move |&fidelity| {
            let writer: Box<dyn Encoder> =
                Box::new(Writer::new(plan.size, plan.depth, fidelity, brevity));
            (brevity.name(fidelity), writer)
        })
    });
    let stock: Box<dyn Encoder> = Box::new(Stock::new());
    let mut tallies: Vec<Tally> = [("stock".to_owned(), stock)]
        .into_iter()
        .chain(ours)
        .map(|(name, encoder)| Tally::new(name, encoder, plan.script))
        .collect();
    let mut before = Buffer::empty(plan.size.into());
    let mut frames = 0;
    let Ok(()) = replay.play(plan.script, plan.frames_per_second, |frame, section, picture| {
        let changes = before.diff(picture);
        let section = (frame > 0).then_some(section);
        for tally in &mut tallies {
            tally.take(section, &changes, picture);
        }
        before.clone_from(picture);
        frames = frame as usize;
        Ok::<(), std::convert::Infallible>(())
    });
    let mut encoders: Vec<EncoderReport> = Vec::new();
    for tally in tallies {
        let report = tally.finish(encoders.first());
        encoders.push(report);
    }
    Report { frames, encoders }
}

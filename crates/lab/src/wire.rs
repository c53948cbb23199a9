//! Bytes and colour errors: the size of a game's frames on the wire, and the colours that the
//! viewer sees.
//!
//! A script is played once, and each of its frames passes through every encoder: ratatui's own for
//! crossterm, which most programs use, and Cellcaster's at several fidelities. The report counts
//! bytes, before and after the compression of `ssh -C`, and compares the colours on the terminal
//! with those that the game drew. The distance of two colours is ΔE of CIE76, the Euclidean
//! distance in CIELAB, which published figures on terminal video use. CIEDE2000 was refused: it is
//! meant for colours closer than most of these, and its hue sectors have discontinuities.
//!
//! The first frame paints everything with any encoder, and is reported separately.

mod encoder;
mod glyph_sets;
mod palettes;
mod pipeline;
mod seen;
mod tour;

use std::num::NonZeroU32;

use ratatui::buffer::Buffer;
use ratatui::layout::Size;

use cellcaster::app::Replay;
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::Script;
use cellcaster::terminal::Fidelity;
use encoder::{Encoder, EncoderRun, Extensions, Stock, Writer};

pub use encoder::{Bytes, Compressed, EncoderReport, Part, Seen};
pub use glyph_sets::{GlyphRow, report_glyphs};
pub use palettes::{PalettePlan, PaletteRow, report_palettes};
pub use pipeline::{PipelineRow, measure_pipeline};

/// The options of a measurement.
#[derive(Debug)]
pub struct Plan<'a> {
    /// The script to play.
    pub script: &'a Script,
    /// The size of the window in which `replay` plays.
    pub size: Size,
    /// The colour depth in which `replay` draws. Only in true colour does an encoder define a palette.
    pub depth: ColorDepth,
    /// The number of frames sent per second.
    pub frames_per_second: NonZeroU32,
    /// The fidelities at which Cellcaster's encoder is measured.
    pub fidelities: Vec<Fidelity>,
}

/// The results.
#[derive(Clone, Debug)]
pub struct Report {
    /// The number of frames after the first.
    pub frames: usize,
    /// Ratatui's encoder, then Cellcaster's at each fidelity, and then Cellcaster's at each
    /// fidelity with repeated characters and a defined palette.
    pub encoders: Vec<EncoderReport>,
}

/// Plays the script of `plan` and measures.
pub fn report(plan: &Plan, replay: &mut Replay) -> Report {
    let ours = [Extensions::Off, Extensions::On].into_iter().flat_map(|extensions| {
        plan.fidelities.iter().map(move |&fidelity| {
            let writer: Box<dyn Encoder> =
                Box::new(Writer::new(plan.size, plan.depth, fidelity, extensions));
            (extensions.name(fidelity), writer)
        })
    });
    let stock: Box<dyn Encoder> = Box::new(Stock::new());
    let mut runs: Vec<EncoderRun> = [("stock".to_owned(), stock)]
        .into_iter()
        .chain(ours)
        .map(|(name, encoder)| EncoderRun::new(name, encoder, plan.script))
        .collect();
    let mut before = Buffer::empty(plan.size.into());
    let mut frames = 0;
    let Ok(()) = replay.play(plan.script, plan.frames_per_second, |frame, section, picture| {
        let changes = before.diff(picture);
        let section = (frame > 0).then_some(section);
        for run in &mut runs {
            run.take(section, &changes, picture);
        }
        before.clone_from(picture);
        frames = frame as usize;
        Ok::<(), std::convert::Infallible>(())
    });
    let mut encoders: Vec<EncoderReport> = Vec::new();
    for run in runs {
        let report = run.finish(encoders.first());
        encoders.push(report);
    }
    Report { frames, encoders }
}

//! Bytes and colour errors: the size of a game's frames on the wire, and the colours that the
//! viewer sees.
//!
//! A script is played once, and each of its frames passes through every encoder: ratatui's own for
//! crossterm, which most programs use, and Cellcaster's at several fidelities. The report counts
//! bytes, before and after the compression of `ssh -C`, and compares the colours on the terminal
//! with the game's own. The distance of two colours is ΔE of CIE76, the Euclidean distance in
//! CIELAB, which published figures on terminal video use. Rejected: CIEDE2000. It is meant for
//! colours that are closer than most of these, and its hue sectors have discontinuities.
//!
//! The first frame paints everything with any encoder, and is reported separately.

mod encoder;
mod seen;
mod tour;

use std::num::NonZeroU32;

use ratatui::buffer::Buffer;
use ratatui::layout::Size;

use crate::report::{Diagram, Table, headings};
use cellcaster::app::Replay;
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::Script;
use cellcaster::terminal::{Effort, Fidelity};
use encoder::{COLUMNS, Encoder, EncoderRun};
pub use tour::{report_glyphs, report_palettes};

/// The options of a measurement.
#[derive(Debug)]
pub struct WirePlan<'a> {
    /// The script to play.
    pub script: &'a Script,
    /// The size of the window in which `replay` plays.
    pub size: Size,
    /// The colour depth in which `replay` draws. An encoder defines a palette only in true colour.
    pub depth: ColorDepth,
    /// The number of frames sent per second.
    pub frames_per_second: NonZeroU32,
    /// The fidelities at which Cellcaster's encoder is measured.
    pub fidelities: &'a [Fidelity],
}

/// Plays the script of `plan`, and compares ratatui's encoder (`stock`) with Cellcaster's at each
/// fidelity: by search (`ours`), by a greedy choice (`greedy`), and by search with repeated characters and a
/// defined palette (`ours+`).
pub fn report(plan: &WirePlan, replay: &mut Replay) -> Table {
    let kinds = [(Effort::Search, false), (Effort::Greedy, false), (Effort::Search, true)];
    let ours = kinds.into_iter().flat_map(|(effort, extensions)| {
        // An exact frame needs no choice.
        let has_choice =
            move |fidelity: &&Fidelity| effort == Effort::Search || **fidelity != Fidelity::EXACT;
        plan.fidelities.iter().filter(has_choice).map(move |&fidelity| {
            let mut encoder = Encoder::ours(plan.size, plan.depth, fidelity, extensions);
            encoder.set_effort(effort);
            let name = match effort {
                Effort::Greedy => "greedy",
                Effort::Search if extensions => "ours+",
                Effort::Search => "ours",
            };
            ((name, fidelity.to_string()), encoder)
        })
    });
    let mut runs: Vec<EncoderRun> = std::iter::once((("stock", String::new()), Encoder::stock()))
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
        frames = frame;
        Ok::<(), std::convert::Infallible>(())
    });
    let rows = runs[0].parts().flat_map(|part| {
        let stock = runs[0].mean_bytes(part);
        runs.iter().map(move |run| run.row(part, stock))
    });
    Table {
        name: "encoders",
        title: format!(
            "{frames} frames of {}×{} cells, {} a second, after a first one that paints everything",
            plan.size.width, plan.size.height, plan.frames_per_second
        ),
        keys: ["section", "encoder", "fidelity"],
        columns: headings(COLUMNS),
        rows: rows.collect(),
        diagrams: vec![
            Diagram { columns: [12, 1], range: [0.01, 100.0] },
            Diagram { columns: [12, 6], range: [0.01, 100.0] },
        ],
    }
}

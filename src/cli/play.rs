//! `cellcaster play`: the game on the terminal.

use std::time::Duration;

use super::arguments::Play;
use super::recording::RecordingFile;
use super::{Error, config, level};
use crate::tui::{self, Settings};

/// Plays until the player has had enough.
pub(super) fn run(options: Play) -> Result<(), Error> {
    let levels = level::load_or_dig(options.map.as_deref(), options.generated)?;
    let configuration = config::load(options.config)?.configuration;
    let frames_per_second =
        options.frames_per_second.map_or(configuration.frames_per_second, |it| it.get());
    let settings = Settings {
        bindings: configuration.bindings,
        frame_time: Duration::from_secs(1) / frames_per_second.get(),
        field_of_view: options.field_of_view.unwrap_or(configuration.field_of_view),
        cell_aspect: options.cell_aspect,
        glyphs: options.glyphs.or(configuration.glyphs).unwrap_or_default(),
        depth: options.depth.or(configuration.colors),
        method: options.method,
        filter: options.filter,
        fidelity: options.fidelity.unwrap_or(configuration.fidelity),
        shows_stats: options.shows_stats,
        minimap: configuration.minimap,
        mouse: configuration.mouse,
    };
    let file = options.record.as_deref().map(RecordingFile::create).transpose()?;
    let recording = file.as_ref().map(RecordingFile::recording).unwrap_or_default();
    tui::play(levels, settings, recording)?;
    file.map_or(Ok(()), RecordingFile::finish)
}

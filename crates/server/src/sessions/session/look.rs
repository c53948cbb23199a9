//! How pictures are drawn on the visitor's terminal.

use super::messages::Identity;
use cellcaster::app::parts::DrawOptions;
use cellcaster::app::store::Preferences;
use cellcaster::color::palette::{ColorDepth, ShadeInk};
use cellcaster::render::Filter;
use cellcaster::terminal::Protocol;
use cellcaster::tui::{CellAspect, Correction, GlyphSet};
use cellcaster::world::FieldOfView;

/// How pictures are drawn.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Look {
    pub(crate) glyphs: GlyphSet,
    pub(crate) depth: ColorDepth,
    pub(crate) field_of_view: FieldOfView,
    cell_aspect: CellAspect,
    /// The best that the terminal can show.
    terminal_depth: ColorDepth,
    terminal_glyphs: GlyphSet,
    shade_ink: ShadeInk,
    correction: Correction,
    marks_middle: bool,
    pub(crate) shows_ghosts: bool,
}

impl Look {
    /// For a terminal that shows only ASCII, or not, and the visitor `identity`.
    pub(crate) fn new(is_ascii: bool, identity: &Identity) -> Self {
        let terminal_glyphs = if is_ascii { GlyphSet::Ascii } else { GlyphSet::Half };
        let field_of_view = identity.configuration.field_of_view;
        let mut look = Self { field_of_view, terminal_glyphs, ..Self::default() };
        look.follow(&identity.preferences);
        look
    }

    /// Whether only ASCII is sent: the terminal shows no more, and the visitor did not ask for it.
    pub(crate) fn is_ascii(&self) -> bool {
        self.terminal_glyphs == GlyphSet::Ascii && !self.glyphs.has_blocks()
    }

    /// Takes over what is known of the terminal.
    pub(crate) fn follow_terminal(&mut self, protocol: &Protocol, preferences: &Preferences) {
        let aspect = protocol.size().cell_aspect.and_then(CellAspect::new);
        self.cell_aspect = aspect.unwrap_or_default();
        self.terminal_depth = protocol.color_depth();
        self.shade_ink = protocol.shade_ink();
        if self.terminal_glyphs.has_blocks() {
            self.terminal_glyphs = protocol.glyph_support();
        }
        self.follow(preferences);
    }

    /// Takes over what the visitor prefers.
    pub(crate) fn follow(&mut self, preferences: &Preferences) {
        self.glyphs = preferences.glyphs.unwrap_or(self.terminal_glyphs);
        self.depth = preferences.colors.unwrap_or(self.terminal_depth);
        self.marks_middle = preferences.crosshair;
        self.correction = preferences.correction;
        self.shows_ghosts = preferences.ghost;
    }

    /// The options of a picture without a flash.
    pub(crate) fn options(&self) -> DrawOptions {
        DrawOptions {
            glyphs: self.glyphs,
            depth: self.depth,
            shade_ink: self.shade_ink,
            cell_aspect: self.cell_aspect,
            filter: Filter::default(),
            correction: self.correction,
            field_of_view: self.field_of_view,
            flash: None,
            marks_middle: self.marks_middle,
        }
    }
}

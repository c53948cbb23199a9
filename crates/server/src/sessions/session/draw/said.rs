//! What was said, at the lower left of the picture, and the line that is typed.

use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};

use super::overhead::style;
use crate::sessions::session::talk::Remark;
use crate::sessions::session::visit::Visit;
use cellcaster::color::palette::ColorDepth;
use cellcaster::tui::canvas::Canvas;

/// The rows of a picture that are left to others.
const ROWS_ABOVE: u16 = 3;

/// Draws `remarks`, the newest at the bottom; above the typed line if there is one.
pub(crate) fn draw<'r>(
    canvas: &mut impl Canvas,
    picture: Rect,
    remarks: impl DoubleEndedIterator<Item = &'r Remark>,
    is_typed: bool,
    depth: ColorDepth,
) {
    let bottom = picture.bottom() - u16::from(is_typed);
    let rows = (picture.top() + ROWS_ABOVE..bottom).rev();
    for (y, remark) in rows.zip(remarks.rev()) {
        let by = remark.by.as_ref();
        let name = by.map(|(name, color)| Span::styled(format!(" {name}"), style(*color, depth)));
        let text = Span::raw(format!(" {} ", remark.text));
        let line = name.into_iter().chain([text]).collect::<Line<'_>>();
        let width = (line.width() as u16).min(picture.width);
        canvas.draw_widget(line, Rect { y, width, height: 1, ..picture });
    }
}

impl Visit {
    /// Draws the line of chat that is typed.
    pub(crate) fn draw_chat_entry(&self, canvas: &mut impl Canvas, picture: Rect) {
        const PROMPT: &str = " say: ";
        let room = usize::from(picture.width).saturating_sub(PROMPT.len());
        let line = Line::raw(format!("{PROMPT}{}", self.entry.shown(room)));
        let area = Rect { y: picture.bottom() - 1, height: 1, ..picture };
        canvas.draw_widget(line.style(Style::new().add_modifier(Modifier::REVERSED)), area);
    }
}

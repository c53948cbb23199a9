//! What lies over the picture while the game runs: directions of sounds, a flash at the edge, the
//! compass, the middle of the picture, and the text of a note.
//!
//! Everything here depends on the state of the game only. What there is nothing of is not drawn, so
//! that a level without guards looks and costs as if there were no HUD.

mod compass;
mod edge;
mod sounds;

use ratatui::layout::Rect;
use ratatui::text::{Line, Text};
use ratatui::widgets::{Block, Padding, Paragraph};

use super::panels::{BORDERS, PADDING, framed};
use super::wrap::wrapped;
use crate::color::Rgb;
use crate::render::Frame;
use crate::tui::canvas::Canvas;
pub use compass::draw as draw_compass;
pub use edge::{draw as draw_edge, tint};
pub use sounds::draw as draw_sounds;

/// The widest text of a note, in columns.
const NOTE_COLUMNS: usize = 56;

/// Draws the text of a note at the bottom of the picture.
pub(crate) fn draw_note(canvas: &mut impl Canvas, picture: Rect, note: &str) {
    let most_columns = usize::from(picture.width.saturating_sub(BORDERS + PADDING)).max(1);
    let columns = most_columns.min(NOTE_COLUMNS);
    let lines: Vec<String> = note.lines().flat_map(|line| wrapped(line, columns)).collect();
    let widest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0);
    let (width, height) = (widest as u16 + BORDERS + PADDING, lines.len() as u16 + BORDERS);
    let (width, height) = (width.max(8).min(picture.width), height.min(picture.height));
    let area = Rect {
        x: picture.x + (picture.width - width) / 2,
        y: picture.bottom() - height,
        width,
        height,
    };
    let inside = framed(canvas, area, "note");
    let text: Text = lines.into_iter().map(Line::from).collect();
    let padded = Block::new().padding(Padding::horizontal(PADDING / 2));
    canvas.draw_widget(Paragraph::new(text).block(padded), inside);
}

/// Marks the middle of a picture that is painted in half blocks.
pub(crate) fn mark_middle(frame: &mut Frame) {
    let (x, y) = (frame.width() as usize / 2, frame.height() as usize / 2);
    let Some(pixel) = frame.rows_mut().nth(y).and_then(|row| row.get_mut(x)) else { return };
    *pixel = if pixel.luma() < 128 { Rgb::WHITE } else { Rgb::BLACK };
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::{Buffer, Cell};

    use super::*;

    #[test]
    fn a_note_is_shown_whole_where_there_is_room() {
        let note =
            "The warden sleeps at the third bell.\nThe lamp by the stair is mine: put it out.";
        for (columns, rows) in [(80, 23), (40, 11), (20, 12)] {
            let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
            draw_note(&mut buffer, Rect::new(0, 0, columns, rows), note);
            let text: String = buffer.content().iter().map(Cell::symbol).collect();
            for word in note.split_whitespace() {
                assert!(text.contains(word), "{word} in {columns} by {rows}: {text}");
            }
        }
        for (columns, rows) in [(20, 5), (3, 2), (1, 1)] {
            let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
            draw_note(&mut buffer, Rect::new(0, 0, columns, rows), note);
        }
    }
}

//! Drawing the ceremony of rounds: large letters, the edge of the picture, and the line of a finisher.
//!
//! It uses colours of whole cells and ASCII, so every glyph set and every colour depth shows it.

use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::text::Line;

use super::overhead::style;
use crate::rooms::room::{Finish, MemberView};
use crate::sessions::session::ceremony::Edge;
use cellcaster::color::Rgb;
use cellcaster::color::palette::ColorDepth;
use cellcaster::tui::canvas::Canvas;
use cellcaster::tui::color_at;

/// The points of a letter, in columns and rows. A point is two cells wide, which is as wide as it is high.
const LETTER: (u16, u16) = (3, 5);
const POINT: u16 = 2;
/// The blank columns and rows around large letters.
const MARGIN: (u16, u16) = (2, 1);

const LARGE: Rgb = Rgb::new(0xff, 0xe0, 0x50);
const SEEKER: Rgb = Rgb::new(0xf0, 0x20, 0x18);
const NEAR: Rgb = Rgb::new(0xff, 0x90, 0x10);

/// The points of a letter, row by row; blank for a letter that no text has.
const fn letter(letter: char) -> [&'static str; LETTER.1 as usize] {
    match letter {
        '0' | 'O' => ["###", "# #", "# #", "# #", "###"],
        '1' => [" # ", "## ", " # ", " # ", "###"],
        '2' => ["###", "  #", "###", "#  ", "###"],
        '3' => ["###", "  #", "###", "  #", "###"],
        '4' => ["# #", "# #", "###", "  #", "  #"],
        '5' | 'S' => ["###", "#  ", "###", "  #", "###"],
        '6' => ["###", "#  ", "###", "# #", "###"],
        '7' => ["###", "  #", "  #", "  #", "  #"],
        '8' => ["###", "# #", "###", "# #", "###"],
        '9' => ["###", "# #", "###", "  #", "###"],
        'D' => ["## ", "# #", "# #", "# #", "## "],
        'E' => ["###", "#  ", "## ", "#  ", "###"],
        'G' => ["###", "#  ", "# #", "# #", "###"],
        'H' => ["# #", "# #", "###", "# #", "# #"],
        'I' => ["###", " # ", " # ", " # ", "###"],
        'K' => ["# #", "# #", "## ", "# #", "# #"],
        'N' => ["## ", "# #", "# #", "# #", "# #"],
        'R' => ["###", "# #", "## ", "# #", "# #"],
        'T' => ["###", " # ", " # ", " # ", " # "],
        _ => [""; LETTER.1 as usize],
    }
}

/// Draws `text` in large letters in the middle of the picture, if it fits.
pub(crate) fn draw_large(canvas: &mut impl Canvas, picture: Rect, text: &str, depth: ColorDepth) {
    let count = text.chars().count() as u16;
    let width = (count * (LETTER.0 + 1)).saturating_sub(1) * POINT + 2 * MARGIN.0;
    let height = LETTER.1 + 2 * MARGIN.1;
    if count == 0 || width > picture.width || height > picture.height {
        return;
    }
    let (left, top) =
        (picture.x + (picture.width - width) / 2, picture.y + (picture.height - height) / 2);
    let ground = ground(depth);
    for y in top..top + height {
        (left..left + width).for_each(|x| canvas.draw_character(x, y, ' ', [ground; 2]));
    }
    let colors = ink(LARGE, depth);
    for (index, character) in (0..).zip(text.chars()) {
        let left = left + MARGIN.0 + index * (LETTER.0 + 1) * POINT;
        for (y, row) in (top + MARGIN.1..).zip(letter(character)) {
            for (column, _) in (0..).zip(row.bytes()).filter(|(_, point)| *point == b'#') {
                let x = left + column * POINT;
                (x..x + POINT).for_each(|x| canvas.draw_character(x, y, '#', colors));
            }
        }
    }
}

/// Draws the edge of the picture.
pub(crate) fn draw_edge(canvas: &mut impl Canvas, picture: Rect, edge: Edge, depth: ColorDepth) {
    let (quarters, character, color) = match edge {
        Edge::Plain => return,
        Edge::Seeker => (4, '#', SEEKER),
        Edge::Near(quarters) => (quarters, '+', NEAR),
    };
    let colors = ink(color, depth);
    // The cells of a side are marked from its two corners.
    let is_marked = |place: u16, length: u16| {
        let from_corner = usize::from(place.min(length - 1 - place));
        from_corner * 8 < quarters * usize::from(length)
    };
    for x in (0..picture.width).filter(|&x| is_marked(x, picture.width)) {
        for y in [picture.top(), picture.bottom() - 1] {
            canvas.draw_character(picture.x + x, y, character, colors);
        }
    }
    for y in (0..picture.height).filter(|&y| is_marked(y, picture.height)) {
        for x in [picture.left(), picture.right() - 1] {
            canvas.draw_character(x, picture.y + y, character, colors);
        }
    }
}

/// Draws who has finished, a line for each, below the top row of the picture.
pub(crate) fn draw_finishers(
    canvas: &mut impl Canvas,
    picture: Rect,
    finishers: &[(Finish, &MemberView)],
    depth: ColorDepth,
) {
    for (y, (finish, member)) in (picture.y + 1..picture.bottom()).zip(finishers) {
        let line = format!(" {}: {} {} ", finish.ordinal(), member.name, finish.time());
        let line = Line::raw(line);
        let width = (line.width() as u16).min(picture.width);
        let area = Rect { x: picture.x + (picture.width - width) / 2, y, width, height: 1 };
        canvas.draw_widget(line.style(style(member.color, depth)), area);
    }
}

/// The colours of a cell that is filled with `color`. Without colours, its character shows.
fn ink(color: Rgb, depth: ColorDepth) -> [Color; 2] {
    if depth == ColorDepth::Mono { [Color::Reset; 2] } else { [color_at(depth, color); 2] }
}

fn ground(depth: ColorDepth) -> Color {
    if depth == ColorDepth::Mono { Color::Reset } else { color_at(depth, Rgb::BLACK) }
}

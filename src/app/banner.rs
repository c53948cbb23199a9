//! The program's name, in large letters of cells.
//!
//! The letters are a font of 3 by 5 points. Where half blocks can be shown, a point is half a cell
//! high; otherwise it is a cell.

use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::text::{Line, Text};
use ratatui::widgets::Block;

use crate::color::palette::ColorDepth;
use crate::tui::GlyphSet;
use crate::tui::canvas::Canvas;

const NAME: &str = "CELLCASTER";
/// The rows of each letter that the name needs, with a bit for each point, the left one first.
const FONT: [(char, [u8; 5]); 7] = [
    ('A', [0b010, 0b101, 0b111, 0b101, 0b101]),
    ('C', [0b111, 0b100, 0b100, 0b100, 0b111]),
    ('E', [0b111, 0b100, 0b110, 0b100, 0b111]),
    ('L', [0b100, 0b100, 0b100, 0b100, 0b111]),
    ('R', [0b110, 0b101, 0b110, 0b101, 0b101]),
    ('S', [0b111, 0b100, 0b111, 0b001, 0b111]),
    ('T', [0b111, 0b010, 0b010, 0b010, 0b010]),
];
/// The points of a letter and of the gap after it.
const ADVANCE: usize = 4;
const ROWS: usize = 5;
/// The points of the whole name from left to right.
const COLUMNS: usize = NAME.len() * ADVANCE - 1;
/// The rows that a menu below the name needs at least.
const LEAST_BELOW: u16 = 6;

/// Draws the name on a band at the top of `picture`, as large as there is room. Returns the area below it.
pub fn draw(canvas: &mut impl Canvas, picture: Rect, glyphs: GlyphSet, depth: ColorDepth) -> Rect {
    let lines = [2, 1].into_iter().map(|scale| lines(glyphs, scale));
    let fits = |lines: &Vec<String>| {
        let width = lines[0].chars().count();
        width <= usize::from(picture.width)
            && lines.len() + usize::from(LEAST_BELOW) <= usize::from(picture.height)
    };
    let lines = lines.into_iter().find(fits).unwrap_or_else(|| vec![NAME.to_owned()]);
    let (width, height) = (lines[0].chars().count() as u16, lines.len() as u16);
    let blank = u16::from(picture.height >= height + LEAST_BELOW + 6);
    let taken = (height + 2 * blank).min(picture.height);
    let band = Rect { height: taken, ..picture };
    let area = Rect {
        x: picture.x + (picture.width - width.min(picture.width)) / 2,
        y: picture.y + blank,
        width: width.min(picture.width),
        height: height.min(picture.height),
    };
    let style = style(depth);
    let text: Text = lines.into_iter().map(Line::from).collect();
    canvas.draw_widget(Block::new().style(style), band);
    canvas.draw_widget(text.style(style), area);
    Rect { y: picture.y + taken, height: picture.height - taken, ..picture }
}

/// Bright on black, on terminals with a light background too.
fn style(depth: ColorDepth) -> Style {
    let [text, ground] = match depth {
        ColorDepth::Mono => return Style::new(),
        ColorDepth::Indexed16 => [Color::Indexed(11), Color::Indexed(0)],
        ColorDepth::Indexed256 => [Color::Indexed(220), Color::Indexed(16)],
        ColorDepth::True => [Color::Rgb(0xff, 0xd0, 0x50), Color::Rgb(0, 0, 0)],
    };
    Style::new().fg(text).bg(ground)
}

/// The name in lines of characters. Each point is `scale` columns wide, and as many half cells or
/// cells high as fits the shape of a cell.
fn lines(glyphs: GlyphSet, scale: usize) -> Vec<String> {
    let is_set = |x: usize, y: usize| {
        let letter = NAME.chars().nth(x / scale / ADVANCE);
        let row = FONT.iter().find(|(known, _)| Some(*known) == letter).map(|(_, rows)| rows);
        let bit = 0b100 >> (x / scale % ADVANCE);
        row.and_then(|rows| rows.get(y)).is_some_and(|row| row & bit != 0)
    };
    let columns = 0..COLUMNS * scale;
    match glyphs {
        _ if glyphs.has_blocks() => {
            let rows = (0..(ROWS * scale).div_ceil(2)).map(|row| 2 * row);
            let half = |x, y| is_set(x, y / scale);
            rows.map(|y| columns.clone().map(|x| block(half(x, y), half(x, y + 1))).collect())
                .collect()
        }
        _ => (0..ROWS)
            .map(|y| columns.clone().map(|x| if is_set(x, y) { '#' } else { ' ' }).collect())
            .collect(),
    }
}

/// The character of two points, one above the other.
fn block(upper: bool, lower: bool) -> char {
    match (upper, lower) {
        (true, true) => '█',
        (true, false) => '▀',
        (false, true) => '▄',
        (false, false) => ' ',
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_is_as_large_as_it_is_drawn() {
        insta::assert_snapshot!(lines(GlyphSet::Half, 1).join("\n"));
        insta::assert_snapshot!(lines(GlyphSet::Ascii, 1).join("\n"));
        for (glyphs, scale, size) in [
            (GlyphSet::Half, 1, (39, 3)),
            (GlyphSet::Half, 2, (78, 5)),
            (GlyphSet::Ascii, 1, (39, 5)),
            (GlyphSet::Ramp, 2, (78, 5)),
        ] {
            let lines = lines(glyphs, scale);
            assert!(lines.iter().all(|line| line.chars().count() == size.0), "{lines:?}");
            assert_eq!(lines.len(), size.1, "{lines:?}");
        }
    }
}

//! The compass: a strip with the directions ahead.

use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::Line;

use crate::tui::canvas::Canvas;
use crate::world::Heading;

/// The names of the directions, clockwise from the east, where a heading is 0.
const NAMES: [&str; 8] = ["E", "SE", "S", "SW", "W", "NW", "N", "NE"];
/// The columns from one name to the next. It is odd, and a third of it is 15 degrees.
const ADVANCE: i32 = 9;
/// The widest strip.
const MOST_COLUMNS: u16 = 31;

/// Draws the strip in the middle of the picture's first row.
pub fn draw(canvas: &mut impl Canvas, picture: Rect, heading: Heading) {
    let width = MOST_COLUMNS.min(picture.width / 3);
    if width < 7 {
        return;
    }
    let area = Rect { x: picture.x + (picture.width - width) / 2, width, height: 1, ..picture };
    let strip = Line::raw(strip(heading, width.into()));
    canvas.draw_widget(strip.style(Style::new().add_modifier(Modifier::REVERSED)), area);
}

/// The directions around `heading`, which is in the middle.
fn strip(heading: Heading, width: usize) -> String {
    let around = NAMES.len() as i32 * ADVANCE;
    let middle = (heading.degrees() / 360.0 * f64::from(around)).round() as i32;
    let letter = |column: usize| {
        let at = (middle + column as i32 - width as i32 / 2).rem_euclid(around);
        // A name with two letters begins at the column of its direction.
        let (name, offset) = (NAMES[(at / ADVANCE) as usize], at % ADVANCE);
        match (name.as_bytes().get(offset as usize), offset % (ADVANCE / 3)) {
            (Some(&letter), _) => char::from(letter),
            (None, 0) => '.',
            (None, _) => ' ',
        }
    };
    (0..width).map(letter).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_direction_of_view_is_in_the_middle() {
        let strip = |degrees| strip(Heading::from_degrees(degrees).unwrap(), 31);
        insta::assert_snapshot!(
            [0.0, 45.0, 90.0, 180.0, 262.0, 270.0, 359.9].map(strip).join("\n")
        );
        for (degrees, letter) in [(0.0, 'E'), (90.0, 'S'), (180.0, 'W'), (270.0, 'N')] {
            assert_eq!(strip(degrees).chars().nth(15), Some(letter));
        }
    }
}

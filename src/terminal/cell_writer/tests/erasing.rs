//! Erased regions, and the position of the cursor after them and in a window of another size.

use proptest::prelude::*;
use ratatui::backend::{Backend, ClearType};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Size};

use super::super::CellWriter;
use super::support::{self, any_pixels, assert_shown};

const SIZE: Size = Size::new(6, 4);

fn writer(size: Size) -> (CellWriter<support::Screen>, support::Screen) {
    let screen = support::Screen::new(size);
    (CellWriter::new(screen.clone(), size), screen)
}

fn draw(writer: &mut CellWriter<support::Screen>, picture: &Buffer) {
    let positions = picture.area.positions().map(|at| (at.x, at.y));
    writer.draw(positions.zip(&picture.content).map(|((x, y), cell)| (x, y, cell))).unwrap();
    writer.flush().unwrap();
}

/// The cells of `region`, by their places in reading order.
fn erase(picture: &mut Buffer, region: ClearType, cursor: Position) {
    let width = usize::from(picture.area.width);
    let line = usize::from(cursor.y) * width;
    let at = line + usize::from(cursor.x);
    let cells = match region {
        ClearType::All => &mut picture.content[..],
        ClearType::AfterCursor => &mut picture.content[at..],
        ClearType::BeforeCursor => &mut picture.content[..=at],
        ClearType::CurrentLine => &mut picture.content[line..line + width],
        ClearType::UntilNewLine => &mut picture.content[at..line + width],
    };
    cells.fill(Cell::EMPTY);
}

proptest! {
    #[test]
    fn an_erased_region_is_known_to_be_blank(
        pictures in prop::collection::vec(any_pixels(24), 2),
        // Some are off the screen, which a terminal takes for the nearest cell.
        place in (0..9_u16, 0..6_u16),
        moves: bool,
        region in prop::sample::select(vec![
            ClearType::All,
            ClearType::AfterCursor,
            ClearType::BeforeCursor,
            ClearType::CurrentLine,
            ClearType::UntilNewLine,
        ]),
    ) {
        let [before, after] = [0, 1].map(|index| {
            Buffer { area: SIZE.into(), content: pictures[index].clone() }
        });
        let (mut writer, screen) = writer(SIZE);
        draw(&mut writer, &before);
        if moves {
            writer.set_cursor_position(place).unwrap();
        }
        let cursor = writer.get_cursor_position().unwrap();
        prop_assert!(!moves || cursor == Position::new(place.0.min(5), place.1.min(3)));
        writer.clear_region(region).unwrap();
        writer.flush().unwrap();
        let mut erased = before;
        erase(&mut erased, region, cursor);
        assert_shown(&screen, &erased);
        draw(&mut writer, &after);
        assert_shown(&screen, &after);
    }

    #[test]
    fn the_cursor_is_moved_right_in_a_window_of_another_size(
        sizes in prop::collection::vec((1..12_u16, 1..8_u16), 2..5),
        cells in any_pixels(96),
        place in (0..12_u16, 0..8_u16),
    ) {
        let size = |(width, height)| Size::new(width, height);
        let (mut writer, screen) = writer(size(sizes[0]));
        for &next in &sizes {
            screen.resize(size(next));
            writer.set_size(size(next));
            writer.set_cursor_position(place).unwrap();
            writer.flush().unwrap();
            let expected = (place.1.min(next.1 - 1), place.0.min(next.0 - 1));
            prop_assert_eq!(screen.0.borrow().parser.screen().cursor_position(), expected);
            writer.clear().unwrap();
            let content = cells[..usize::from(next.0 * next.1)].to_vec();
            let picture = Buffer { area: size(next).into(), content };
            draw(&mut writer, &picture);
            assert_shown(&screen, &picture);
        }
    }
}

#[test]
fn half_of_a_wide_character_may_be_erased() {
    for (column, region) in [(1, ClearType::UntilNewLine), (0, ClearType::BeforeCursor)] {
        let (mut writer, screen) = writer(SIZE);
        let mut picture = Buffer::empty(SIZE.into());
        picture.set_string(0, 1, "字b", ratatui::style::Style::default());
        draw(&mut writer, &picture);
        writer.set_cursor_position((column, 1)).unwrap();
        writer.clear_region(region).unwrap();
        let mut after = Buffer::empty(SIZE.into());
        after.set_string(0, 1, "x字", ratatui::style::Style::default());
        draw(&mut writer, &after);
        assert_shown(&screen, &after);
        draw(&mut writer, &picture);
        assert_shown(&screen, &picture);
    }
}

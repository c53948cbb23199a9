//! The shortest motion of the cursor.
//!
//! A move to a lower row is a carriage return and line feeds. With the return, the result is the
//! same whether or not the terminal's line discipline adds a return to each feed; with a line feed
//! alone it is not.

use ratatui::layout::{Position, Size};

use super::bytes::{ControlSequence, Piece};

/// Adds the motion from `cursor` to `target`, on a terminal of `size`. In the column after the last
/// one, a cursor waits to wrap.
pub(crate) fn push(cursor: Option<Position>, target: Position, size: Size, piece: &mut Piece) {
    if cursor == Some(target) {
        return;
    }
    match cursor {
        Some(cursor) if cursor.y == target.y && cursor.x < target.x => {
            push_right(target.x - cursor.x, piece);
        }
        _ => push_far(cursor, target, size, piece),
    }
}

fn push_right(by: u16, piece: &mut Piece) {
    if by == 1 {
        piece.push(*b"\x1b[C", 3);
    } else {
        let mut motion = ControlSequence::begin(piece);
        motion.place(by);
        motion.end(b'C');
    }
}

/// More line feeds than this are longer than an absolute row.
const MOST_FEEDS: u16 = 5;

fn push_far(cursor: Option<Position>, target: Position, size: Size, piece: &mut Piece) {
    let Some(cursor) = cursor else { return push_absolute(target, piece) };
    if cursor.y == target.y && target.x < cursor.x && cursor.x < size.width {
        let by = cursor.x - target.x;
        let longest = bytes_of_return(target.x);
        if by <= 3 && usize::from(by) <= longest {
            (0..by).for_each(|_| piece.push([b'\x08'], 1));
            return;
        }
        if 3 + digits(by) <= longest {
            let mut motion = ControlSequence::begin(piece);
            motion.place(by);
            return motion.end(b'D');
        }
    }
    let feeds = target.y.wrapping_sub(cursor.y);
    let is_near = feeds <= MOST_FEEDS && target.y < size.height;
    if is_near && usize::from(feeds) + bytes_of_return(target.x) <= bytes_of_absolute(target) {
        piece.push([b'\r'], 1);
        (0..feeds).for_each(|_| piece.push([b'\n'], 1));
        if target.x > 0 {
            push_right(target.x, piece);
        }
        return;
    }
    push_absolute(target, piece);
}

fn push_absolute(target: Position, piece: &mut Piece) {
    let mut motion = ControlSequence::begin(piece);
    motion.place(target.y.saturating_add(1));
    if target.x > 0 {
        motion.place(target.x.saturating_add(1));
    }
    motion.end(b'H');
}

/// The number of bytes of a motion to column `x` by way of the first column.
fn bytes_of_return(x: u16) -> usize {
    match x {
        0 => 1,
        1 => 4,
        _ => 4 + digits(x),
    }
}

fn bytes_of_absolute(target: Position) -> usize {
    let column = if target.x > 0 { 1 + digits(target.x + 1) } else { 0 };
    3 + digits(target.y + 1) + column
}

/// The number of digits of `number`.
#[inline]
pub(crate) fn digits(number: u16) -> usize {
    1 + usize::from(number > 9)
        + usize::from(number > 99)
        + usize::from(number > 999)
        + usize::from(number > 9999)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::bytes::Bytes;
    use super::*;

    fn motion(cursor: Option<Position>, target: Position) -> Vec<u8> {
        let mut bytes = Bytes::default();
        let mut piece = bytes.piece();
        push(cursor, target, Size::new(120, 40), &mut piece);
        piece.finish();
        bytes.as_slice().to_vec()
    }

    #[test]
    fn near_motions_are_short() {
        let from = Position::new(10, 5);
        for (x, y, expected) in [
            (10, 5, ""),
            (11, 5, "\x1b[C"),
            (12, 5, "\x1b[2C"),
            (9, 5, "\x08"),
            (7, 5, "\x08\x08\x08"),
            (5, 5, "\x1b[5D"),
            (0, 5, "\r"),
            (0, 6, "\r\n"),
            (1, 6, "\r\n\x1b[C"),
            (0, 4, "\x1b[5H"),
            (3, 20, "\x1b[21;4H"),
        ] {
            let bytes = motion(Some(from), Position::new(x, y));
            assert_eq!(bytes, expected.as_bytes(), "{x} {y}");
        }
        assert_eq!(motion(None, Position::ORIGIN), b"\x1b[1H");
        // On some terminals, a backspace does not move a cursor that waits to wrap.
        assert_eq!(motion(Some(Position::new(120, 5)), Position::new(119, 5)), b"\r\x1b[119C");
    }

    proptest! {
        #[test]
        fn every_motion_arrives(from in (0..=120_u16, 0..40_u16), to in (0..120_u16, 0..40_u16)) {
            let mut screen = vt100::Parser::new(
                40.try_into().unwrap(),
                120.try_into().unwrap(),
                0,
            );
            let waits = from.0 == 120;
            screen.process(format!("\x1b[{};{}H", from.1 + 1, (from.0 + 1).min(120)).as_bytes());
            if waits {
                screen.process(b"x");
            }
            let target = Position::new(to.0, to.1);
            let bytes = motion(Some(Position::new(from.0, from.1)), target);
            screen.process(&bytes);
            prop_assert_eq!(screen.screen().cursor_position(), (to.1, to.0));
            prop_assert!(bytes.len() <= bytes_of_absolute(target));
        }
    }
}

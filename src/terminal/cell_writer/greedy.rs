//! The greedy choice: for each cell of a row by itself, the action with the fewest bytes within the tolerance.
//!
//! A cell whose error is within the tolerance is kept. Another cell is drawn in the terminal's current colours if
//! these are near enough, with one new colour if that suffices, and otherwise with two. This is the cheap alternative
//! to the [search](super::trellis), which also weighs errors against bytes and looks ahead.
//!
//! Rejected: row shifts. With them, a frame of 80x24 cells has the same bytes at a tolerance of 10 instead of 12.4, but
//! its whole pipeline takes 1.2 times the instructions. Rejected: comparing shades (░▒▓) with blocks.

use std::ops::Range;

use super::block::BlockElement;
use super::ink::{Ink, Inks, Price};
use super::style::Style;
use super::trellis::{CellTarget, ColorTables, DrawAction, RowParameters};

/// Sets `actions` to the actions on the cells of a row for which `is_wrong` is true. The other parameters are the
/// parameters of [`Trellis::search`](super::trellis::Trellis::search).
pub(crate) fn choose(
    columns: Range<usize>,
    is_wrong: impl Fn(usize, &mut Inks) -> bool,
    wanted: impl Fn(usize, &mut Inks) -> Option<CellTarget>,
    RowParameters { price, style, .. }: RowParameters,
    tables: &mut ColorTables,
    actions: &mut Vec<(u16, DrawAction)>,
) {
    actions.clear();
    let colors = style.and_then(Style::plain_colors);
    // `None` if the terminal's colours are unknown.
    let mut current = colors.map(|colors| tables.inks.of_both(colors));
    for x in columns {
        if !is_wrong(x, tables.inks) {
            continue;
        }
        let action = match wanted(x, tables.inks) {
            None => {
                current = None;
                DrawAction::DrawExactly
            }
            Some(target) => {
                let (element, inks) = draw(&target, current, price, tables);
                current = Some(inks);
                DrawAction::Draw(element, Style::plain(inks[0].shade, inks[1].shade))
            }
        };
        actions.push((x as u16, action));
    }
}

/// The element and the text and background colours with the fewest bytes after the `current` colours that show
/// `target`.
fn draw(
    target: &CellTarget,
    current: Option<[Ink; 2]>,
    price: Price,
    tables: &mut ColorTables,
) -> (BlockElement, [Ink; 2]) {
    let [upper, lower] = target.inks;
    let is_near = |shown: Ink, wanted: Ink| price.allows(shown, wanted);
    let is_block = target.character.is_none();
    let is_flat = is_block && is_near(upper, lower);
    let mut code = |ink: Ink| tables.palette.telling(ink, ink.bytes(), price).ink;
    let Some([text, ground]) = current else {
        let upper = code(upper);
        return if is_flat {
            (BlockElement::Space, [upper, upper])
        } else {
            (BlockElement::Upper, [upper, code(lower)])
        };
    };
    let [text_above, text_below] = [is_near(text, upper), is_near(text, lower)];
    let [ground_above, ground_below] = [is_near(ground, upper), is_near(ground, lower)];
    if is_block && ground_above && ground_below {
        (BlockElement::Space, [text, ground])
    } else if text_above && ground_below {
        (BlockElement::Upper, [text, ground])
    } else if is_block && ground_above && text_below {
        (BlockElement::Lower, [text, ground])
    } else if is_block && text_above && text_below {
        (BlockElement::Full, [text, ground])
    } else if is_flat {
        (BlockElement::Space, [text, code(upper)])
    } else if text_above {
        (BlockElement::Upper, [text, code(lower)])
    } else if ground_below {
        (BlockElement::Upper, [code(upper), ground])
    } else if is_block && ground_above {
        (BlockElement::Lower, [code(lower), ground])
    } else if is_block && text_below {
        (BlockElement::Lower, [text, code(upper)])
    } else {
        let upper = code(upper);
        (BlockElement::Upper, [upper, code(lower)])
    }
}

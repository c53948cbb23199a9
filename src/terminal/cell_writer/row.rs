//! Makes a row look like its targets: exactly, or within a tolerance for fewer bytes.
//!
//! Within a tolerance, two cells are compared by the distance of their two colours in L\*a\*b\*, if they are both
//! blocks or both the same character without modifiers. A shade (░▒▓) is compared as a block of its mean colour. All
//! other cells are drawn exactly.
//!
//! Rejected: another character in place of the wanted one, such as its neighbour on a ramp of brightness. In ascii mode
//! the character also identifies the surface, and most of the bytes are colours.
//!
//! A picture that does not change becomes exact by refinement, in a few frames of similar size. The worst cells come
//! first. A row that has not changed for some frames is refined even while other rows change, because a blinking cell
//! or a clock changes in every picture.
//!
//! Rejected: reducing the tolerance step by step. Cells were sent twice, and the last frame had most of the bytes.

use std::cell::Cell;

use ratatui::buffer::CellWidth;
use ratatui::layout::Position;

use crate::terminal::cell_writer::block::{BlockElement, MosaicShape};
use crate::terminal::cell_writer::greedy;
use crate::terminal::cell_writer::ink::{self, Ink, Inks, Price};
use crate::terminal::cell_writer::packed_cell::{Form, GlyphId, GlyphTable, PackedCell};
use crate::terminal::cell_writer::pen::Pen;
use crate::terminal::cell_writer::screen::{Screen, ScreenRow};
use crate::terminal::cell_writer::shift::{BYTE, CELL, Loss, Shift, Shifts};
use crate::terminal::cell_writer::style::{Notation, PackedColor, Style};
use crate::terminal::cell_writer::trellis::{
    CellTarget, ColorTables, DrawAction, RowParameters, Trellis,
};
use crate::terminal::{Effort, Fidelity};
use crate::tui::canvas::SHADES;

/// Makes a row look like its target.
pub(crate) fn draw_row(pen: &mut Pen, shifts: &mut Shifts, mut row: ScreenRow) {
    if row.state.intricate {
        draw_intricate_row(pen, &mut row);
    } else {
        shift(pen, shifts, &mut row);
        let cells = row.targets.iter().copied().enumerate().zip(&shifts.losses);
        let wrong = cells.filter(|&(_, &loss)| loss > 0).map(|(cell, _)| cell);
        pen.draw_pixels(row.y, wrong, |pen, column, target| draw_target(pen, &row, column, target));
        row.shown.copy_from_slice(row.targets);
    }
    row.state.exact = true;
}

/// Draws a row whose characters may cover more than their cells.
fn draw_intricate_row(pen: &mut Pen, row: &mut ScreenRow) {
    let mut covered = 0;
    for column in 0..row.width() {
        if covered > 0 {
            // The second half of a wide character.
            covered -= 1;
            row.shown[column] = PackedCell::UNKNOWN;
            continue;
        }
        if !row.shown[column].is(row.targets[column]) {
            draw_cell(pen, row, column);
        }
        if row.targets[column].is_intricate() {
            covered = row.wanted[column].cell_width().saturating_sub(1);
        }
    }
    row.state.intricate = row.shown.iter().chain(row.targets).any(|target| target.is_intricate());
}

/// Draws one cell of a row.
#[inline(never)]
fn draw_cell(pen: &mut Pen, row: &mut ScreenRow, column: usize) {
    let target = row.targets[column];
    draw_target(pen, row, column, target);
    row.shown[column] = target;
}

/// Draws the target of a cell of a row.
#[inline(never)]
fn draw_target(pen: &mut Pen, row: &ScreenRow, column: usize, target: PackedCell) {
    let position = Position { x: column as u16, y: row.y };
    if let Some((shape, colors)) = target.block() {
        let (element, style) = BlockElement::cheapest(colors, pen.style);
        pen.draw_block(position, (shape, element), style);
    } else {
        draw_text(pen, row, position, target);
    }
}

/// Draws a cell that is not a block.
#[inline(never)]
fn draw_text(pen: &mut Pen, row: &ScreenRow, position: Position, target: PackedCell) {
    let mut character = [0; 4];
    let (text, style) = if let Some((text, style)) = target.text(row.glyph_table) {
        (&*text.encode_utf8(&mut character), style)
    } else {
        let cell = &row.wanted[usize::from(position.x)];
        (cell.symbol(), Style::of(cell))
    };
    pen.draw_text(position, text, style);
}

/// Shifts the stretches of a row that have moved sideways.
fn shift(pen: &mut Pen, shifts: &mut Shifts, row: &mut ScreenRow) {
    let lose = |row: &ScreenRow, from: usize, to: usize, losses: &mut Vec<Loss>| {
        let targets = row.shown[from..].iter().zip(&row.targets[to..]);
        losses.extend(targets.map(|(shown, target)| if shown == target { 0 } else { CELL }));
    };
    shifts.begin(row.targets, row.marks, |from, to, losses| lose(row, from, to, losses));
    while let Some(shift) = shifts.next(|from, to, losses| lose(row, from, to, losses)) {
        pen.shift_row(&shift, row.y);
        shift.apply(row.shown, PackedCell::UNKNOWN);
    }
    shifts.end(row.marks);
}

/// Draws rows inexactly. Each thread has one encoder, which keeps its memory between rows.
#[derive(Debug, Default)]
pub(crate) struct RowEncoder {
    inks: Inks,
    /// The colours of the row's targets, and of the cells on the screen.
    wanted: Colors,
    shown: Colors,
    /// The cost of keeping each cell, for its two colours.
    keep: Vec<[f32; 2]>,
    /// The cost if the cells had moved.
    moved: Vec<[f32; 2]>,
    trellis: Trellis,
    /// The actions on the row's cells, without the cells to keep.
    actions: Vec<(u16, DrawAction)>,
}

/// The two colours of each cell in L\*a\*b\*, component by component, so that several distances are
/// computed at once.
///
/// Characters are placed far from blocks and from other characters. A cell that may only be shown exactly is placed
/// far from every colour and from every cell that looks different.
#[derive(Debug, Default)]
struct Colors {
    components: [Vec<[f32; 2]>; 3],
    /// The shapes of all cells, or nothing if all are halves and characters.
    shapes: Vec<MosaicShape>,
}

thread_local! {
    static ENCODER: Cell<Option<Box<RowEncoder>>> = const { Cell::new(None) };
}

impl RowEncoder {
    /// Makes rows look like their targets within `fidelity`.
    pub(crate) fn draw_rows<'a>(
        pen: &mut Pen,
        shifts: &mut Shifts,
        rows: impl Iterator<Item = ScreenRow<'a>>,
        (fidelity, effort): (Fidelity, Effort),
    ) {
        let mut encoder = ENCODER.take().unwrap_or_default();
        rows.for_each(|row| encoder.draw_row(pen, shifts, row, (fidelity, effort)));
        ENCODER.set(Some(encoder));
    }

    /// Makes a row look like its target within `fidelity`.
    fn draw_row(
        &mut self,
        pen: &mut Pen,
        shifts: &mut Shifts,
        mut row: ScreenRow,
        (fidelity, effort): (Fidelity, Effort),
    ) {
        if row.state.intricate {
            // The extent of an intricate character is unknown.
            return draw_row(pen, shifts, row);
        }
        let notation = notation(row.targets, pen.palette().is_on);
        let price = Price::at(fidelity, notation);
        if effort == Effort::Search {
            self.wanted.fill(row.targets, row.glyph_table, &mut self.inks);
            self.shown.fill(row.shown, row.glyph_table, &mut self.inks);
            self.shift(pen, shifts, &mut row, price);
            self.shown.costs(&self.wanted, [0, 0], price, &mut self.keep);
        }
        let terms = RowParameters { price, style: pen.style, repeats: pen.repeats };
        let mut store = ColorTables { inks: &mut self.inks, palette: pen.palette() };
        let wanted =
            |column: usize, inks: &mut Inks| wanted(row.targets[column], row.glyph_table, inks);
        let actions = &mut self.actions;
        match effort {
            Effort::Search => self.trellis.search(&self.keep, wanted, terms, &mut store, actions),
            Effort::Greedy => {
                let is_wrong = |column: usize, inks: &mut Inks| {
                    let (shown, target) = (row.shown[column], row.targets[column]);
                    !is_near(shown, target, row.glyph_table, inks, price)
                };
                greedy::choose(0..row.width(), is_wrong, wanted, terms, &mut store, actions);
            }
        }
        for &(column, action) in &self.actions {
            match action {
                DrawAction::DrawExactly => draw_cell(pen, &mut row, usize::from(column)),
                DrawAction::Draw(element, style) => {
                    draw_near(pen, &mut row, column, element, style);
                }
            }
        }
        row.state.exact = row.shown == row.targets;
    }

    /// Shifts the stretches of a row that have moved sideways, at least approximately.
    fn shift(&mut self, pen: &mut Pen, shifts: &mut Shifts, row: &mut ScreenRow, price: Price) {
        let (wanted, moved) = (&self.wanted, &mut self.moved);
        let mut lose = |shown: &Colors, places: [usize; 2], losses: &mut Vec<Loss>| {
            shown.costs(wanted, places, price, moved);
            losses.extend(moved.iter().map(|[one, other]| loss(one + other)));
        };
        let shown = &self.shown;
        shifts.begin(row.targets, row.marks, |from, to, losses| lose(shown, [from, to], losses));
        while let Some(shift) =
            shifts.next(|from, to, losses| lose(&self.shown, [from, to], losses))
        {
            pen.shift_row(&shift, row.y);
            shift.apply(row.shown, PackedCell::UNKNOWN);
            self.shown.shift(&shift);
        }
        shifts.end(row.marks);
    }
}

/// The notation of the longest colour in a row of cells. `has_palette` tells whether palette entries may be defined.
fn notation(targets: &[PackedCell], has_palette: bool) -> Notation {
    let all = targets.iter().fold([0; 2], |all, target| {
        let colors = target.colors().map(PackedColor::in_bits);
        [all[0] | colors[0], all[1] | colors[1]]
    });
    match PackedColor::longest_of(all[0] | all[1]) {
        Notation::Rgb if has_palette => Notation::Entry,
        notation => notation,
    }
}

/// The loss of this number of bytes, at most [`CELL`].
#[inline]
fn loss(bytes: f32) -> Loss {
    /// The sum of this and a small number has the rounded number in its lowest bits.
    const INTEGER: f32 = 8_388_608.0;
    let (loss, most) = (bytes * f32::from(BYTE), f32::from(CELL));
    ((if loss < most { loss } else { most }) + INTEGER).to_bits() as Loss
}

/// The L*, a* and b* of two colours.
#[inline]
fn components([one, other]: [Ink; 2]) -> [[f32; 2]; 3] {
    [0, 1, 2].map(|index| [one.lab[index], other.lab[index]])
}

/// The colours of a cell that does not consist of halves.
#[inline(never)]
fn of_other(target: PackedCell, glyph_table: &GlyphTable, inks: &mut Inks) -> [[f32; 2]; 3] {
    match target.recolorable(glyph_table) {
        Some((Form::Block(_), colors)) => components(inks.of_both(colors)),
        Some((Form::Glyph(id), colors)) => {
            let glyph = glyph_table.glyph(id).character;
            let inks = inks.of_both(colors);
            if let Some(share) = share_of_text(glyph)
                && !colors.contains(&PackedColor::DEFAULT)
            {
                return components([mixed(inks, share); 2]);
            }
            let (apart, components) = (apart(id), components(inks));
            [0, 1, 2].map(|at| components[at].map(|component| component + apart[at]))
        }
        // Cells that look different are placed far from each other.
        _ => target.hashes().map(|hash| [FAR * (1.0 + f32::from(hash)); 2]),
    }
}

/// The share of the text colour in a shade. `None` for any other character.
fn share_of_text(character: char) -> Option<f32> {
    let quarters = 1 + SHADES.iter().position(|&shade| shade == character)?;
    Some(quarters as f32 / 4.0)
}

/// The colour of a shade, which is compared as a block of one colour.
fn mixed([text, ground]: [Ink; 2], share: f32) -> Ink {
    let lab = [0, 1, 2].map(|at| ground.lab[at] + share * (text.lab[at] - ground.lab[at]));
    Ink { lab, ..text }
}

/// The target of a cell for the search. `None` if the cell may only be drawn exactly.
#[inline]
fn wanted(target: PackedCell, glyph_table: &GlyphTable, inks: &mut Inks) -> Option<CellTarget> {
    let (form, colors) = target.recolorable(glyph_table)?;
    let (shape, character) = match form {
        Form::Block(shape) => (shape, None),
        Form::Glyph(id) => {
            (MosaicShape::HALF, Some(glyph_table.glyph(id).character.len_utf8() as u8))
        }
    };
    Some(CellTarget { inks: inks.of_both(colors), shape, character })
}

/// Draws a cell in these colours, as a block or as its own character.
#[inline]
fn draw_near(pen: &mut Pen, row: &mut ScreenRow, column: u16, element: BlockElement, style: Style) {
    let position = Position { x: column, y: row.y };
    let column = usize::from(column);
    let target = row.targets[column];
    row.shown[column] = match target.text(row.glyph_table) {
        None => {
            let shape = target.block().map_or(MosaicShape::HALF, |(shape, _)| shape);
            let drawn = if element.is_flat() { MosaicShape::HALF } else { shape };
            pen.draw_block(position, (drawn, element), style);
            PackedCell::of_block(drawn, element, style)
        }
        Some((character, _)) => {
            pen.draw_text(position, character.encode_utf8(&mut [0; 4]), style);
            target.recolored([style.foreground, style.background])
        }
    };
}

/// The displacement of a glyph from blocks: a point of its own in a lattice whose points are
/// farther apart than colours.
fn apart(id: GlyphId) -> [f32; 3] {
    const SPACING: f32 = 1000.0;
    let id = id.get() + 1;
    [id & 15, id >> 4 & 15, id >> 8].map(|digit| SPACING * f32::from(digit))
}

/// A distance from every colour that is larger than any tolerance.
const FAR: f32 = 1e6;

impl Colors {
    /// Computes the colours of cells.
    fn fill(&mut self, targets: &[PackedCell], glyph_table: &GlyphTable, inks: &mut Inks) {
        for components in &mut self.components {
            components.resize(targets.len(), [0.0; 2]);
        }
        self.shapes.clear();
        let mut has_shapes = false;
        let [ls, as_, bs] = &mut self.components;
        let places = ls.iter_mut().zip(as_).zip(bs);
        let mut last = (PackedCell::UNKNOWN, [[FAR; 2]; 3]);
        for (&target, ((l, a), b)) in targets.iter().zip(places) {
            if target != last.0 {
                last.0 = target;
                last.1 = if let Some(halves) = target.halves() {
                    components(inks.of_both(halves))
                } else {
                    has_shapes |= target.block().is_some();
                    of_other(target, glyph_table, inks)
                };
            }
            [*l, *a, *b] = last.1;
        }
        if has_shapes {
            let shape =
                |target: &PackedCell| target.block().map_or(MosaicShape::HALF, |(shape, _)| shape);
            self.shapes.extend(targets.iter().map(shape));
        }
    }

    /// Moves the cells as the terminal does. The uncovered cells become far from all others.
    fn shift(&mut self, shift: &Shift) {
        for components in &mut self.components {
            shift.apply(components, [-FAR; 2]);
        }
        if !self.shapes.is_empty() {
            shift.apply(&mut self.shapes, MosaicShape::HALF);
        }
    }

    /// Computes, cell by cell, the cost of showing this row's cells from column `from` on in place of the cells of
    /// `others` from column `to` on.
    fn costs(
        &self,
        others: &Self,
        [from, to]: [usize; 2],
        price: Price,
        costs: &mut Vec<[f32; 2]>,
    ) {
        let count = others.components[0].len() - from.max(to);
        costs.resize(count, [0.0; 2]);
        if !self.shapes.is_empty() || !others.shapes.is_empty() {
            let places = (0..count).map(|place| [from + place, to + place]);
            for (cost, places) in costs.iter_mut().zip(places) {
                *cost = self.cost_of_shapes(others, places, price);
            }
            return;
        }
        let shown = self.components.each_ref();
        let [ls, as_, bs] = shown.map(|shown| shown[from..][..count].as_flattened());
        let wanted = others.components.each_ref();
        let wanted = wanted.map(|wanted| wanted[to..][..count].as_flattened());
        let shown = ls.iter().zip(as_).zip(bs);
        let wanted = wanted[0].iter().zip(wanted[1]).zip(wanted[2]);
        for (cost, (((l, a), b), ((l2, a2), b2))) in
            costs.as_flattened_mut().iter_mut().zip(shown.zip(wanted))
        {
            let [l, a, b] = [l - l2, a - a2, b - b2];
            *cost = price.of_distance((l * l + a * a + b * b).sqrt());
        }
    }

    /// The cost of showing one cell in place of another of any shape: the cost of its dots, and the cost of the rest.
    #[inline]
    fn cost_of_shapes(&self, others: &Self, [from, to]: [usize; 2], price: Price) -> [f32; 2] {
        let lab = |colors: &Self, place: usize, which: usize| {
            colors.components.each_ref().map(|components| components[place][which])
        };
        let cost = |one: usize, other: usize, parts: u8| {
            if parts == 0 {
                return 0.0;
            }
            let distance = ink::distance(lab(self, from, one), lab(others, to, other));
            price.of_parts(parts).of_distance(distance)
        };
        let (shape, other) = (self.shape(from), others.shape(to));
        if shape == other {
            let [dots, rest] = shape.parts();
            return [cost(0, 0, dots), cost(1, 1, rest)];
        }
        let [both, dots, rest, neither] = shape.overlap(other).pairs().map(|(_, parts)| parts);
        [cost(0, 0, both) + cost(0, 1, dots), cost(1, 0, rest) + cost(1, 1, neither)]
    }

    fn shape(&self, place: usize) -> MosaicShape {
        self.shapes.get(place).copied().unwrap_or(MosaicShape::HALF)
    }
}

/// The progress of refinement.
#[derive(Debug)]
pub(crate) struct Refinement {
    /// The number of frames until the picture is exact.
    frames: usize,
}

/// The inexact cells.
#[derive(Debug, Default)]
struct Inexact {
    /// The errors and positions of the cells, row by row.
    cells: Vec<InexactCell>,
    inks: Inks,
}

/// The error and the position of a cell.
#[derive(Clone, Copy, Debug)]
struct InexactCell {
    error: f32,
    y: u16,
    column: u16,
}

/// The number of frames in which a still picture becomes exact.
const FRAMES: usize = 10;

/// The number of frames without a change after which a row is refined while others change. Before that, cells that
/// soon move on would be drawn in vain.
const RESTING_FRAMES: usize = 10;

thread_local! {
    static INEXACT: Cell<Option<Box<Inexact>>> = const { Cell::new(None) };
}

impl Refinement {
    pub(crate) fn new() -> Self {
        Self { frames: FRAMES }
    }

    /// Starts again after a motion.
    pub(crate) fn disturb(&mut self) {
        self.frames = FRAMES;
    }

    /// Draws the next refinement frame of the whole screen.
    pub(crate) fn draw(&mut self, pen: &mut Pen, shifts: &mut Shifts, screen: &mut Screen) {
        if screen.is_exact() {
            return;
        }
        let mut inexact = INEXACT.take().unwrap_or_default();
        inexact.cells.clear();
        for row in screen.inexact_rows() {
            if row.is_near() {
                inexact.add(&row);
            } else {
                draw_row(pen, shifts, row);
            }
        }
        inexact.choose_worst(self.frames);
        self.frames = (self.frames - 1).max(1);
        let mut chosen = inexact.cells.iter().peekable();
        for mut row in screen.inexact_rows() {
            while let Some(cell) = chosen.next_if(|cell| cell.y == row.y) {
                draw_cell(pen, &mut row, usize::from(cell.column));
            }
            row.state.exact = row.shown == row.targets;
        }
        INEXACT.set(Some(inexact));
    }

    /// Draws the next refinement frame of the rows that rest while others change.
    pub(crate) fn draw_resting(pen: &mut Pen, shifts: &mut Shifts, screen: &mut Screen) {
        if screen.is_exact() {
            return;
        }
        let mut inexact = INEXACT.take().unwrap_or_default();
        for mut row in screen.inexact_rows() {
            let Some(drawn) = usize::from(row.state.rested).checked_sub(RESTING_FRAMES) else {
                continue;
            };
            if !row.is_near() {
                draw_row(pen, shifts, row);
                continue;
            }
            inexact.cells.clear();
            inexact.add(&row);
            inexact.choose_worst(FRAMES.saturating_sub(drawn).max(1));
            for cell in &inexact.cells {
                draw_cell(pen, &mut row, usize::from(cell.column));
            }
            row.state.exact = row.shown == row.targets;
        }
        INEXACT.set(Some(inexact));
    }
}

impl Inexact {
    /// Adds the inexact cells of a row.
    fn add(&mut self, row: &ScreenRow) {
        self.cells.extend(errors(row, &mut self.inks));
    }

    /// Keeps the worst cells, as many as one of `frames` frames must draw, in the order of the screen.
    fn choose_worst(&mut self, frames: usize) {
        let share = self.cells.len().div_ceil(frames);
        if share < self.cells.len() {
            self.cells
                .select_nth_unstable_by(share, |one, other| other.error.total_cmp(&one.error));
            self.cells.truncate(share);
        }
        self.cells.sort_unstable_by_key(|cell| (cell.y, cell.column));
    }
}

/// The errors of the inexact cells of a row.
fn errors<'a>(row: &'a ScreenRow, inks: &'a mut Inks) -> impl Iterator<Item = InexactCell> + 'a {
    let targets = row.shown.iter().zip(row.targets);
    (0..).zip(targets).filter(|(_, (shown, target))| shown != target).map(
        |(column, (&shown, &target))| {
            let error = error(shown, target, row.glyph_table, inks);
            InexactCell { error, y: row.y, column }
        },
    )
}

/// Returns true if a cell may be shown in place of another: if its error is within the tolerance.
#[inline]
fn is_near(
    shown: PackedCell,
    wanted: PackedCell,
    glyph_table: &GlyphTable,
    inks: &mut Inks,
    price: Price,
) -> bool {
    if shown == wanted {
        return true;
    }
    let Some(([above, below], [upper, lower])) = shown.halves().zip(wanted.halves()) else {
        return error(shown, wanted, glyph_table, inks) <= price.farthest;
    };
    let mut is_near = |one, other| one == other || price.allows(inks.of(one), inks.of(other));
    is_near(above, upper) && is_near(below, lower)
}

/// The largest distance between two colours at the same place. Infinite if the cells cannot be compared.
fn error(shown: PackedCell, wanted: PackedCell, glyph_table: &GlyphTable, inks: &mut Inks) -> f32 {
    let parts = shown.recolorable(glyph_table).zip(wanted.recolorable(glyph_table));
    let Some(((shown_form, shown), (form, wanted))) = parts else { return f32::INFINITY };
    let pairs = match (shown_form, form) {
        (Form::Block(one), Form::Block(other)) => one.overlap(other).pairs(),
        _ if shown_form == form => MosaicShape::HALF.overlap(MosaicShape::HALF).pairs(),
        _ => return f32::INFINITY,
    };
    let distances = pairs.into_iter().filter(|&(_, parts)| parts > 0);
    distances
        .map(|([one, other], _)| inks.of(shown[one]).distance(inks.of(wanted[other])))
        .fold(0.0, f32::max)
}

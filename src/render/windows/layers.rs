//! Layers: what is painted over what is behind it, one after the other in each column.
//!
//! Glass tints whole areas, as every mirror does what it shows. So in a block of columns all else is
//! painted first that is behind the next glass, and then that glass of all of them, row by row: its
//! neighbours are mostly of the same tint. One column after the other, the tints of mirrors took a fifth
//! of a frame.

use std::ops::Range;

use super::Scene;
use super::blocks::by_columns;
use super::notes::Notes;
use super::profile::Profiles;
use super::things::{Billboards, Strip};
use super::veils::{Film, Pane, Veil};
use crate::color::Rgb;
use crate::render::band::Band;
use crate::render::marks::MarksOfBand;
use crate::render::shade::Shade;
use crate::render::tally::{Pass, Tally};

/// What is painted over what is behind it, as wide as a pixel.
#[derive(Clone, Debug)]
pub(super) enum Layer {
    /// Which of all panes.
    Pane(usize),
    Thing(Strip),
}

/// Finds out in `layers` what is to be painted for the veils of `notes`: in each column, what is nearer
/// comes later.
pub(super) fn lay_out(
    scene: Scene<'_>,
    (profiles, notes): (&Profiles, &Notes),
    billboards: &mut Billboards,
    layers: &mut Vec<Layer>,
) {
    layers.clear();
    layers.reserve(notes.veils.capacity());
    for veil in notes.veils.iter().rev() {
        match veil {
            &Veil::Pane(index) => layers.push(Layer::Pane(index)),
            Veil::Things(between) => {
                billboards
                    .cut((scene, profiles), between, |strip| layers.push(Layer::Thing(strip)));
            }
        }
    }
}

/// What the layers are made of.
#[derive(Clone, Copy)]
pub(super) struct Painter<'a> {
    pub(super) scene: Scene<'a>,
    pub(super) panes: &'a [Pane],
    pub(super) billboards: &'a Billboards,
}

impl Painter<'_> {
    /// Paints all `layers`, those of a column one after the other.
    pub(super) fn paint<T: Tally>(
        self,
        layers: &[Layer],
        marks: &mut MarksOfBand<'_>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        let column_of = |layer: &Layer| match layer {
            Layer::Pane(index) => self.panes[*index].column as usize,
            Layer::Thing(strip) => strip.column as usize,
        };
        for mut columns in by_columns::<COLUMNS_AT_ONCE, _>(layers, column_of) {
            while columns.iter().any(|column| !column.is_empty()) {
                let tints = columns
                    .each_mut()
                    .map(|column| self.paint_up_to_glass(column, marks, band, tally));
                paint_tints(&tints, band);
            }
        }
    }

    /// Paints the first layers of `column`, up to the next glass, and returns that.
    fn paint_up_to_glass<T: Tally>(
        self,
        column: &mut &[Layer],
        marks: &mut MarksOfBand<'_>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) -> Option<Tint> {
        let Self { scene, panes, billboards } = self;
        while let Some(layer) = column.split_off_first() {
            match layer {
                Layer::Thing(strip) => billboards.draw(scene, strip, marks, band, tally),
                &Layer::Pane(index) => {
                    let pane = &panes[index];
                    let rows = band.clip(&pane.rows);
                    tally.pixels(Pass::SeeThrough, rows.len());
                    let shade = pane.facing.shade(scene, pane.light, pane.t);
                    match pane.film {
                        Film::Mask(texture) => {
                            tally.texels(Pass::SeeThrough, rows.len());
                            pane.draw_mask(scene, texture, shade, rows, marks, band);
                        }
                        Film::Glass(glass) => {
                            let color = shade.apply(glass.color);
                            let (x, opacity) = (pane.column, glass.opacity);
                            return Some(Tint { x, rows, color, opacity });
                        }
                    }
                }
            }
        }
        None
    }
}

/// Glass before a column of pixels.
struct Tint {
    x: u32,
    rows: Range<u32>,
    color: Rgb,
    opacity: u8,
}

/// So many columns are painted together: as many as their pixels are fetched from memory at a time.
const COLUMNS_AT_ONCE: usize = 16;

/// Paints `tints`, each in a column of its own, from left to right.
fn paint_tints(tints: &[Option<Tint>; COLUMNS_AT_ONCE], band: &mut Band<'_>) {
    let look = |tint: &Option<Tint>| tint.as_ref().map(|tint| (tint.color, tint.opacity));
    for alike in tints.chunk_by(|one, other| look(one) == look(other)) {
        let tints = || alike.iter().flatten();
        let Some(&Tint { x: first, color, opacity, .. }) = tints().next() else { continue };
        let start = tints().map(|tint| tint.rows.start).max().unwrap_or_default();
        let end = tints().map(|tint| tint.rows.end).min().unwrap_or_default().max(start);
        for row in start..end {
            for pixel in &mut band.row_mut(row)[first as usize..][..alike.len()] {
                *pixel = color.over(*pixel, opacity);
            }
        }
        for Tint { x, rows, .. } in tints() {
            for rest in [rows.start..rows.end.min(start), rows.start.max(end)..rows.end] {
                for pixel in band.column_mut(*x, rest) {
                    *pixel = color.over(*pixel, opacity);
                }
            }
        }
    }
}

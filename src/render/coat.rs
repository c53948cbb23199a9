//! Coats: what covers columns of pixels, and how several of them are covered at once.
//!
//! Columns side by side are drawn together, row by row: what a row of them shows lies side by side
//! in memory, and is fetched from there once. One column after the other was refused: every pixel
//! would be in another stretch of memory than the one before, which in large pictures took most of
//! the time of a frame.

use std::ops::{Deref, DerefMut, Range};

use super::band::Band;
use super::shade::Shade;
use super::texels_down::TexelsDown;
use crate::world::Rgb;

/// At least as many columns as there are pixels in what a processor fetches from memory at a time.
pub(super) const COLUMNS_AT_ONCE: usize = 2 * LANES;
/// So many columns have what their loop needs in registers.
const LANES: usize = 8;
/// So few rows that their pixels in those columns stay at hand until the last column is drawn,
/// even where a row is a power of two wide and they compete for the same places in the cache.
const ROWS_AT_ONCE: u32 = 32;

/// What the columns are papered with that are drawn at once, one for each.
#[derive(Clone, Debug, Default)]
pub(super) struct Papers(Box<[Paper; COLUMNS_AT_ONCE]>);

impl Deref for Papers {
    type Target = [Paper; COLUMNS_AT_ONCE];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl DerefMut for Papers {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.0
    }
}

/// The texels of a column, as they are shaded.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paper([Rgb; PAPER]);

/// More texels than there are in a column of most textures.
const PAPER: usize = 1 << PAPER_BITS;
const PAPER_BITS: u32 = 7;

impl Default for Paper {
    fn default() -> Self {
        Self([Rgb::BLACK; PAPER])
    }
}

/// How a column of pixels is covered.
pub(super) struct Coat<'a, S> {
    pub(super) x: u32,
    pub(super) rows: Range<u32>,
    pub(super) cover: Cover<'a, S>,
}

pub(super) enum Cover<'a, S> {
    /// One colour, which is the first of its paper.
    Color(Rgb),
    /// Texels that are read so often that they were shaded once.
    Paper(TexelsDown),
    Texels(&'a [Rgb], TexelsDown, S),
}

impl<'a, S: Shade> Cover<'a, S> {
    pub(super) fn of_color(color: Rgb, shade: S, Paper(paper): &mut Paper) -> Self {
        paper[0] = shade.apply(color);
        Self::Color(paper[0])
    }

    /// Of so many `rows`.
    pub(super) fn of_texels(
        texels: &'a [Rgb],
        down: TexelsDown,
        shade: S,
        Paper(paper): &mut Paper,
        rows: usize,
    ) -> Self {
        if texels.len() >= PAPER || texels.len() > 2 * rows {
            return Self::Texels(texels, down, shade);
        }
        for (shaded, texel) in paper.iter_mut().zip(texels) {
            *shaded = shade.apply(*texel);
        }
        // Rounding may take the last row one texel too far.
        paper[texels.len()] = paper[texels.len() - 1];
        Self::Paper(down)
    }

    /// Of these `rows` of a face that may show its texels again and again, or only some of them.
    pub(super) fn of_face(
        texels: &'a [Rgb],
        down: TexelsDown,
        shade: S,
        Paper(paper): &mut Paper,
        rows: &Range<u32>,
    ) -> Self {
        let most = PAPER.min(2 * rows.len()) as i64;
        let Some(places) = down.places(rows).filter(|places| places.end - places.start <= most)
        else {
            return Self::Texels(texels, down, shade);
        };
        let mut place = places.start;
        while place < places.end {
            let (first, count) = down.texels_at(place..places.end);
            let paper = &mut paper[place as usize % PAPER..];
            let count = count.min(paper.len());
            for (shaded, texel) in paper.iter_mut().zip(&texels[first..first + count]) {
                *shaded = shade.apply(*texel);
            }
            place += count as i64;
        }
        Self::Paper(down)
    }
}

/// Draws `coats`, each in a column of its own, with `papers` that belong to them in that order.
pub(super) fn draw<S: Shade>(
    coats: &[Option<Coat<'_, S>>; COLUMNS_AT_ONCE],
    papers: &Papers,
    band: &mut Band<'_>,
) {
    let neighbours = || coats.chunks_exact(LANES).zip(papers.chunks_exact(LANES));
    let mut together = [const { None }; COLUMNS_AT_ONCE / LANES];
    for (lanes, (coats, papers)) in together.iter_mut().zip(neighbours()) {
        *lanes = Lanes::new(coats, papers);
    }
    let rows = union(together.iter().flatten().map(|lanes| &lanes.rows));
    for first in rows.clone().step_by(ROWS_AT_ONCE as usize) {
        for lanes in together.iter_mut().flatten() {
            lanes.draw(first..rows.end.min(first + ROWS_AT_ONCE), band);
        }
    }
    for (lanes, (coats, papers)) in together.iter().zip(neighbours()) {
        let rows = union(coats.iter().flatten().map(|coat| &coat.rows));
        let drawn = lanes.as_ref().map_or(rows.end..rows.end, |lanes| lanes.rows.clone());
        for part in [rows.start..drawn.start, drawn.end..rows.end] {
            draw_one_by_one(coats, papers, part, band);
        }
    }
}

/// Draws what of `coats` is in `rows`.
fn draw_one_by_one<S: Shade>(
    coats: &[Option<Coat<'_, S>>],
    papers: &[Paper],
    rows: Range<u32>,
    band: &mut Band<'_>,
) {
    for first in rows.clone().step_by(ROWS_AT_ONCE as usize) {
        for (coat, paper) in coats.iter().zip(papers) {
            if let Some(coat) = coat {
                coat.draw(paper, first..rows.end.min(first + ROWS_AT_ONCE), band);
            }
        }
    }
}

impl<S: Shade> Coat<'_, S> {
    /// Draws what of it is in `rows`.
    #[inline]
    fn draw(&self, Paper(paper): &Paper, rows: Range<u32>, band: &mut Band<'_>) {
        let rows = common(&rows, &self.rows);
        let first = rows.start;
        let pixels = band.column_mut(self.x, rows);
        match self.cover {
            Cover::Color(color) => pixels.for_each(|pixel| *pixel = color),
            Cover::Paper(down) => {
                for (pixel, texel) in pixels.zip(down.from(first)) {
                    *pixel = paper[texel % PAPER];
                }
            }
            Cover::Texels(texels, down, shade) => {
                for (pixel, row) in pixels.zip(first..) {
                    *pixel = shade.apply(texels[down.at(row)]);
                }
            }
        }
    }
}

/// Papered columns side by side, in the rows that all of them have.
struct Lanes<'a> {
    x: u32,
    rows: Range<u32>,
    papers: &'a [Paper; LANES],
    /// Where each is on its paper in the next row to be drawn, the texel in the uppermost bits.
    places: [u64; LANES],
    /// From one row to the next.
    steps: [u64; LANES],
}

impl<'a> Lanes<'a> {
    /// `None` where not all of them are papered, or have no row in common.
    #[inline]
    fn new<S>(coats: &[Option<Coat<'_, S>>], papers: &'a [Paper]) -> Option<Self> {
        let coats: &[_; LANES] = coats.try_into().ok()?;
        let papers = papers.try_into().ok()?;
        let x = coats[0].as_ref()?.x;
        let mut rows = 0..u32::MAX;
        for (coat, x) in coats.iter().zip(x..) {
            let coat = coat.as_ref().filter(|coat| coat.x == x)?;
            rows = common(&rows, &coat.rows);
        }
        if rows.is_empty() {
            return None;
        }
        let (mut places, mut steps) = ([0; LANES], [0; LANES]);
        for ((place, step), coat) in places.iter_mut().zip(&mut steps).zip(coats) {
            match coat.as_ref()?.cover {
                Cover::Color(_) => {}
                Cover::Paper(down) => {
                    (*place, *step) = down.in_uppermost::<PAPER_BITS>(rows.start);
                }
                Cover::Texels(..) => return None,
            }
        }
        Some(Self { x, rows, papers, places, steps })
    }

    /// Draws what of it is in `rows`, which follow those that were drawn before.
    #[inline]
    fn draw(&mut self, rows: Range<u32>, band: &mut Band<'_>) {
        let Self { papers, mut places, steps, .. } = *self;
        for pixels in band.block_mut::<LANES>(self.x, common(&rows, &self.rows)) {
            for lane in 0..LANES {
                let texel = places[lane] >> (u64::BITS - PAPER_BITS);
                pixels[lane] = papers[lane].0[texel as usize];
                places[lane] = places[lane].wrapping_add(steps[lane]);
            }
        }
        self.places = places;
    }
}

/// The rows that both have.
fn common(one: &Range<u32>, other: &Range<u32>) -> Range<u32> {
    let start = one.start.max(other.start);
    start..one.end.min(other.end).max(start)
}

/// The rows from the first that any of them has to the last.
fn union<'a>(all: impl Iterator<Item = &'a Range<u32>>) -> Range<u32> {
    all.cloned()
        .reduce(|one, other| one.start.min(other.start)..one.end.max(other.end))
        .unwrap_or_default()
}

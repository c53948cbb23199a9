//! Coats: what covers columns of pixels, and how many of them are covered at once.
//!
//! Columns side by side are drawn together, row by row: what a row of them shows lies side by side
//! in memory, and a processor sees where that leads and fetches it in time. One column after the other
//! was refused: every pixel would be in another stretch of memory than the one before, which in large
//! pictures took most of the time of a frame.

use std::ops::Range;
use std::ptr;

use super::band::Band;
use super::paper::{Paper, Papers, Place};
use super::shade::Shade;
use super::texels_down::TexelsDown;
use crate::color::Rgb;

/// So many columns are drawn together at most.
pub(super) const COLUMNS_AT_ONCE: usize = 15 * LANES;
/// So many rows of some columns are drawn before it is the turn of the columns beside them.
const ROWS_AT_ONCE: u32 = 8;
/// So many columns have what their loop needs in registers.
const LANES: usize = 8;

/// Memory for columns that are drawn together, so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct Wardrobe {
    papers: Papers,
    coats: Vec<Coat>,
    lanes: Vec<Lanes>,
}

/// Coats for the columns of `band`, from left to right until they are drawn, of texels in a shade `S`.
pub(super) struct Coats<'m, 'b, 'a, S> {
    wardrobe: &'m mut Wardrobe,
    band: &'m mut Band<'b>,
    /// Which texels the latest paper shows, and in which shade.
    latest: Option<(&'a [Rgb], S, Paper)>,
}

impl<'m, 'b, 'a, S: Shade> Coats<'m, 'b, 'a, S> {
    pub(super) fn new(wardrobe: &'m mut Wardrobe, band: &'m mut Band<'b>) -> Self {
        let mut coats = Self { wardrobe, band, latest: None };
        coats.clear();
        // However much of a wall shows later, there is room.
        coats.wardrobe.coats.reserve(COLUMNS_AT_ONCE);
        coats.wardrobe.lanes.reserve(COLUMNS_AT_ONCE / LANES);
        coats
    }

    /// Those of `rows` that can be covered.
    pub(super) fn clip(&self, rows: &Range<u32>) -> Range<u32> {
        self.band.clip(rows)
    }

    /// Covers `rows` of column `x` with one colour.
    pub(super) fn paint(&mut self, x: u32, rows: Range<u32>, color: Rgb, shade: S) {
        self.make_room_for(1);
        let papers = &mut self.wardrobe.papers;
        let place = papers.make(&[color], |color| shade.apply(color)).start();
        self.wardrobe.coats.push(Coat { x, rows, place, step: 0 });
    }

    /// Covers `rows` of column `x` with `texels`.
    #[inline]
    pub(super) fn hang(
        &mut self,
        x: u32,
        rows: Range<u32>,
        texels: &'a [Rgb],
        down: TexelsDown,
        shade: S,
    ) {
        if texels.len() > 2 * rows.len() || texels.len() > Papers::MOST {
            self.draw_without_paper(x, rows, texels, down, shade);
            return;
        }
        self.make_room_for(texels.len());
        let paper = match self.latest {
            Some((latest, of_shade, paper)) if ptr::eq(latest, texels) && of_shade == shade => {
                paper
            }
            _ => self.wardrobe.papers.make(texels, |texel| shade.apply(texel)),
        };
        self.latest = Some((texels, shade, paper));
        self.put_up(x, rows, paper, down);
    }

    /// Covers `rows` of column `x` with `texels` of a face that may show them again and again, or only some of
    /// them.
    pub(super) fn hang_on_face(
        &mut self,
        x: u32,
        rows: Range<u32>,
        texels: &'a [Rgb],
        down: TexelsDown,
        shade: S,
    ) {
        let most = Papers::MOST.min(2 * rows.len()) as i64;
        let places = down.places(&rows).filter(|places| places.end - places.start <= most);
        let Some(places) = places else {
            self.draw_without_paper(x, rows, texels, down, shade);
            return;
        };
        self.make_room_for((places.end - places.start) as usize);
        let first = places.start;
        let pieces = down.pieces(texels, places);
        let paper = self.wardrobe.papers.make_of_pieces(first, pieces, |texel| shade.apply(texel));
        self.put_up(x, rows, paper, down);
    }

    /// Has `paper` cover `rows` of column `x`.
    #[inline]
    fn put_up(&mut self, x: u32, rows: Range<u32>, paper: Paper, down: TexelsDown) {
        let (place, step) = paper.down(down, rows.start);
        self.wardrobe.coats.push(Coat { x, rows, place, step });
    }

    /// Covers `rows` of column `x` at once: it is not worth a paper, or too large for one.
    fn draw_without_paper(
        &mut self,
        x: u32,
        rows: Range<u32>,
        texels: &[Rgb],
        down: TexelsDown,
        shade: S,
    ) {
        let first = rows.start;
        for (pixel, row) in self.band.column_mut(x, rows).zip(first..) {
            *pixel = shade.apply(texels[down.at(row)]);
        }
    }

    fn make_room_for(&mut self, texels: usize) {
        let Wardrobe { papers, coats, .. } = &self.wardrobe;
        if coats.len() == COLUMNS_AT_ONCE || !papers.have_room_for(texels) {
            self.draw();
        }
    }

    /// Draws those that have not been drawn yet.
    pub(super) fn draw(&mut self) {
        let Wardrobe { papers, coats, lanes } = &mut *self.wardrobe;
        let mut rest = coats.as_slice();
        while let [coat, more @ ..] = rest {
            let Some(together) = rest.first_chunk().and_then(Lanes::new) else {
                coat.draw(papers, coat.rows.clone(), self.band);
                rest = more;
                continue;
            };
            let (coats, more) = rest.split_at(LANES);
            for coat in coats {
                coat.draw(papers, coat.rows.start..together.rows.start, self.band);
                coat.draw(papers, together.rows.end..coat.rows.end, self.band);
            }
            lanes.push(together);
            rest = more;
        }
        let start = lanes.iter().map(|lanes| lanes.rows.start).min().unwrap_or_default();
        let end = lanes.iter().map(|lanes| lanes.rows.end).max().unwrap_or_default();
        for first in (start..end).step_by(ROWS_AT_ONCE as usize) {
            for lanes in &mut *lanes {
                lanes.draw(papers, first..end.min(first + ROWS_AT_ONCE), self.band);
            }
        }
        self.clear();
    }

    fn clear(&mut self) {
        let Wardrobe { papers, coats, lanes } = &mut *self.wardrobe;
        papers.clear();
        coats.clear();
        lanes.clear();
        self.latest = None;
    }
}

/// How a column of pixels is covered.
#[derive(Clone, Debug)]
struct Coat {
    x: u32,
    rows: Range<u32>,
    /// Where the first of the rows is, and how far it is from each row to the next.
    place: Place,
    step: u64,
}

impl Coat {
    /// Draws it in those of its `rows`.
    #[inline]
    fn draw(&self, papers: &Papers, rows: Range<u32>, band: &mut Band<'_>) {
        let mut place = self.place_in(rows.start);
        for pixel in band.column_mut(self.x, rows) {
            *pixel = papers.at(place);
            place = place.further(self.step);
        }
    }

    #[inline]
    fn place_in(&self, row: u32) -> Place {
        self.place.further(self.step.wrapping_mul(u64::from(row - self.rows.start)))
    }
}

/// Columns side by side, in the rows that all of them have.
#[derive(Clone, Debug)]
struct Lanes {
    x: u32,
    rows: Range<u32>,
    /// Where each of them is in the next row to be drawn.
    places: [Place; LANES],
    /// From one row to the next.
    steps: [u64; LANES],
}

impl Lanes {
    /// `None` where they are not side by side, or have no row in common.
    #[inline]
    fn new(coats: &[Coat; LANES]) -> Option<Self> {
        let [Coat { x, .. }, .., last] = coats;
        let rows = coats.iter().map(|coat| coat.rows.clone()).reduce(common)?;
        // There are no two in one column.
        let are_side_by_side = last.x - x == LANES as u32 - 1;
        (are_side_by_side && !rows.is_empty()).then(|| Self {
            x: *x,
            places: coats.each_ref().map(|coat| coat.place_in(rows.start)),
            steps: coats.each_ref().map(|coat| coat.step),
            rows,
        })
    }

    /// Draws what of it is in `rows`, which follow those that were drawn before.
    #[inline]
    fn draw(&mut self, papers: &Papers, rows: Range<u32>, band: &mut Band<'_>) {
        let Self { x, mut places, steps, .. } = *self;
        band.for_each_in_block(x, common(rows, self.rows.clone()), |pixels: &mut [Rgb; LANES]| {
            for lane in 0..LANES {
                pixels[lane] = papers.at(places[lane]);
                places[lane] = places[lane].further(steps[lane]);
            }
        });
        self.places = places;
    }
}

/// The rows that both have.
fn common(one: Range<u32>, other: Range<u32>) -> Range<u32> {
    let start = one.start.max(other.start);
    start..one.end.min(other.end).max(start)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::cast::Side;
    use crate::render::shade::OfSide;
    use crate::render::{Frame, FrameSize, PixelAspect, Projection};
    use crate::world::{Camera, FieldOfView, Heading};

    const HEIGHT: u32 = 90;

    /// A column of a wall: none at all, or its distance, its side, and which of its texels it shows.
    fn column() -> impl Strategy<Value = Option<(f64, Side, Range<usize>)>> {
        let side = prop::sample::select(&[Side::X, Side::Y][..]);
        let texels = prop::sample::select(&[0..64, 64..128, 0..1, 128..1128, 0..9000][..]);
        prop::option::weighted(0.95, (0.01..20.0, side, texels))
    }

    proptest! {
        #[test]
        fn columns_show_their_texels(
            columns in prop::collection::vec(column(), 1..400),
            repeats in 1_usize..20,
        ) {
            let texels: Vec<_> =
                (0..9000).map(|texel| Rgb::new(1, (texel >> 8) as u8, texel as u8)).collect();
            let columns: Vec<_> =
                columns.iter().flat_map(|column| vec![column; repeats]).take(400).collect();
            let size = FrameSize::new(columns.len() as u32, HEIGHT).unwrap();
            let east = Heading::from_degrees(0.0).unwrap();
            let camera = Camera::new((0.0, 0.0).into(), east, FieldOfView::default()).unwrap();
            let projection = Projection::new(&camera, size, PixelAspect::SQUARE);
            let mut frame = Frame::new(size, PixelAspect::SQUARE);
            let mut wardrobe = Wardrobe::default();
            let mut band = frame.whole();
            let mut coats = Coats::new(&mut wardrobe, &mut band);
            let walls = || (0..).zip(&columns).filter_map(|(x, column)| Some((x, column.as_ref()?)));
            let down = |t: f64, range: &Range<usize>| projection.texels_down_the_wall(t, range.len());
            for (x, (t, side, range)) in walls() {
                let (rows, shade) = (projection.wall_rows(*t), OfSide(*side));
                match texels[range.clone()] {
                    [color] => coats.paint(x, rows, color, shade),
                    ref texels => coats.hang(x, rows, texels, down(*t, range), shade),
                }
            }
            coats.draw();
            let mut shown = vec![vec![Rgb::BLACK; columns.len()]; HEIGHT as usize];
            for (x, (t, side, range)) in walls() {
                let texels = &texels[range.clone()];
                for row in projection.wall_rows(*t) {
                    let texel = texels[down(*t, range).at(row)];
                    shown[row as usize][x as usize] = OfSide(*side).apply(texel);
                }
            }
            prop_assert!(frame.rows().eq(shown));
        }
    }
}

//! Bytes and errors of the finer glyph sets at each fidelity.
//!
//! A short walk leads through each level. Every set draws its frames, and the encoder sends them at every
//! fidelity. What the terminal then shows is compared with the view as both appear from a distance ([`seen`]).
//!
//! [`seen`]: super::seen

use std::num::NonZeroU32;

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::style::Color;
use ratatui::widgets::StatefulWidget;

use super::encoder::{Encoder, Extensions, Writer};
use super::seen::SeenPicture;
use super::tour::walk;
use cellcaster::color::Rgb;
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::Game;
use cellcaster::render::Filter;
use cellcaster::terminal::Fidelity;
use cellcaster::tui::canvas::Mosaic;
use cellcaster::tui::{FirstPerson, GlyphSet, View};
use cellcaster::world::{FieldOfView, World};

/// One in this number of frames is compared; the bytes of all are counted.
const COMPARED: usize = 30;
const SETS: [GlyphSet; 4] =
    [GlyphSet::Half, GlyphSet::Quadrant, GlyphSet::Sextant, GlyphSet::Octant];
const FIDELITIES: [Fidelity; 3] = [Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW];

/// The results of one glyph set at one fidelity, in all levels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GlyphRow {
    /// The glyphs of the picture.
    pub glyphs: GlyphSet,
    /// The fidelity of the encoder.
    pub fidelity: Fidelity,
    /// The mean number of bytes per frame, without the first of each level.
    pub bytes: f64,
    /// The mean distance in Oklab from the view, as both appear from a distance.
    pub error: f64,
}

/// Walks through `levels` in a window of this size, and measures the glyph sets of two, four, six and eight
/// dots in order, each at exact, high and low fidelity.
pub fn report_glyphs(
    size: Size,
    frames_per_second: NonZeroU32,
    levels: impl IntoIterator<Item = World>,
) -> Vec<GlyphRow> {
    let mut sums = SETS.map(|_| FIDELITIES.map(|_| Sums::default()));
    for world in levels {
        measure(size, frames_per_second, Game::new(world), &mut sums);
    }
    let rows = SETS.into_iter().zip(sums).flat_map(|(glyphs, sums)| {
        FIDELITIES.into_iter().zip(sums).map(move |(fidelity, sums)| GlyphRow {
            glyphs,
            fidelity,
            bytes: sums.bytes as f64 / sums.frames.max(1) as f64,
            error: sums.error / sums.compared.max(1) as f64,
        })
    });
    rows.collect()
}

/// The sums over all frames.
#[derive(Clone, Copy, Default)]
struct Sums {
    frames: usize,
    bytes: usize,
    compared: usize,
    error: f64,
}

fn measure(
    size: Size,
    frames_per_second: NonZeroU32,
    game: Game,
    sums: &mut [[Sums; FIDELITIES.len()]; SETS.len()],
) {
    let writer = |fidelity| Writer::new(size, ColorDepth::True, fidelity, Extensions::Off);
    let mut writers = SETS.map(|_| FIDELITIES.map(writer));
    let mut pictures = SETS.map(|_| Buffer::empty(Rect::from(size)));
    let mut view = View::default();
    let mut bytes = Vec::new();
    walk(game, frames_per_second, |frame, game| {
        let camera = game.camera(FieldOfView::default());
        let truth =
            (frame % COMPARED == 0).then(|| SeenPicture::of_view(game.world(), &camera, size));
        for (set, glyphs) in SETS.into_iter().enumerate() {
            let before = pictures[set].clone();
            let picture = &mut pictures[set];
            FirstPerson::new(game.world(), &camera).glyphs(glyphs).filter(Filter::Area).render(
                picture.area,
                picture,
                &mut view,
            );
            let changes = before.diff(picture);
            for (writer, sums) in writers[set].iter_mut().zip(&mut sums[set]) {
                bytes.clear();
                writer.encode(&changes, &mut bytes);
                if frame > 0 {
                    sums.frames += 1;
                    sums.bytes += bytes.len();
                }
                if let Some(truth) = &truth {
                    sums.compared += 1;
                    sums.error += shown(size, writer).distance(truth);
                }
            }
        }
    });
}

/// What the terminal shows.
fn shown(size: Size, writer: &Writer) -> SeenPicture {
    SeenPicture::of_cells(size, |x, y| match writer.shown(x, y) {
        Some((Some(mosaic), colors)) => (mosaic, colors.map(rgb)),
        _ => (Mosaic::halves(0), [Rgb::BLACK; 2]),
    })
}

/// The colour; black if it is one of the terminal's own.
fn rgb(color: Color) -> Rgb {
    if let Color::Rgb(red, green, blue) = color { Rgb::new(red, green, blue) } else { Rgb::BLACK }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::map::builtin;

    #[test]
    fn finer_glyphs_have_less_error_and_lower_fidelities_fewer_bytes() {
        let level = builtin::LEVELS.iter().find(|level| level.name == "cellar").unwrap();
        let rate = NonZeroU32::new(5).unwrap();
        let rows = report_glyphs(Size::new(40, 12), rate, [level.world().unwrap()]);
        let of_each: Vec<&[GlyphRow]> = rows.chunks(FIDELITIES.len()).collect();
        assert!(of_each.is_sorted_by(|coarser, finer| coarser[0].error > finer[0].error));
        for rows in of_each {
            assert!(rows.is_sorted_by(|one, other| one.bytes > other.bytes), "{rows:?}");
            assert!(rows.is_sorted_by(|one, other| one.error < other.error), "{rows:?}");
        }
    }
}

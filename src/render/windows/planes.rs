//! The pass for what lies flat, and for the sky: along rows, over the spans that show the same.

use std::{iter, mem};

use glam::DVec2;

use super::notes::{Notes, Run, Shown};
use super::{Part, Piece, Reflection, Scene};
use crate::color::Rgb;
use crate::render::band::Band;
use crate::render::lay::Layer;
use crate::render::sky::SkyView;
use crate::render::tally::{Pass, Tally};
use crate::world::{Ceiling, Cell, Covering, Light, Tile, TileKind, World};

/// Draws every span. `starts` is memory to work with.
///
/// Spans end where the next column shows something else: there are as many as that, and no row is
/// searched for them.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    sky: &SkyView<'_>,
    notes: &Notes,
    starts: &mut Vec<usize>,
    band: &mut Band<'_>,
    tally: &mut T,
) {
    let rows = band.rows();
    starts.clear();
    starts.resize(rows.len(), 0);
    let mut end_spans = |of: &Run, x: usize| {
        for row in band.clip(&of.rows) {
            let start = mem::replace(&mut starts[(row - rows.start) as usize], x);
            let pixels = &mut band.row_mut(row)[start..x];
            match of.shown {
                Shown::Face(_) => continue,
                Shown::Sky { reflection: Reflection::NONE } => sky.draw(row, start, pixels, tally),
                Shown::Sky { reflection } => {
                    sky.draw_reflected(notes.unfolding(reflection), row, start, pixels, tally);
                }
                Shown::Plane(piece) => lay(scene, notes, piece, row, start, pixels, tally),
            }
            tally.spans(1);
        }
    };
    let mut before: &[Run] = &[];
    for (x, column) in notes.columns().enumerate() {
        for change in changes(before, column) {
            end_spans(&change, x);
        }
        before = column;
    }
    for run in before {
        end_spans(run, scene.projection.columns());
    }
}

/// What `one` column shows that its neighbour does not show in the same rows.
fn changes(mut one: &[Run], mut other: &[Run]) -> impl Iterator<Item = Run> {
    let mut start = 0;
    iter::from_fn(move || {
        loop {
            let (this, that) = (one.first()?, other.first()?);
            let end = this.rows.end.min(that.rows.end);
            let rows = mem::replace(&mut start, end)..end;
            one = &one[usize::from(this.rows.end == end)..];
            other = &other[usize::from(that.rows.end == end)..];
            if this.shown != that.shown {
                return Some(Run { rows, shown: this.shown });
            }
        }
    })
}

/// Lays `piece` on `pixels`, which are those from column `x` on of `row`.
fn lay<T: Tally>(
    scene: Scene<'_>,
    notes: &Notes,
    piece: Piece,
    row: u32,
    x: usize,
    pixels: &mut [Rgb],
    tally: &mut T,
) {
    let Scene { world, projection, filter, .. } = scene;
    let ground = world.ground();
    let tile = piece.tile.map_or(&ground, |id| &world.tiles()[usize::from(id.0)]);
    let light = tile.light.unwrap_or(Light::FULL);
    let (height, covering) = match piece.tile {
        None => (0.0, world.floor()),
        Some(_) => height_and_covering(tile, piece.part),
    };
    let mut track = projection.track_at(row, height);
    if piece.reflection != Reflection::NONE {
        track = track.seen_in_mirrors(notes.unfolding(piece.reflection));
    }
    let pass = match piece.part {
        Part::Ceiling => Pass::Ceiling,
        Part::Floor | Part::Roof | Part::Top => Pass::Floor,
    };
    let layer = Layer { world, filter, pass };
    if !world.has_lamplight() || piece.tile.is_none() {
        layer.lay(covering, light, &track, x, pixels, tally);
        return;
    }
    // Lamps light each cell as it is.
    let lamplight = |x: usize| lamplight_at(world, track.point(x));
    let mut x = x;
    let mut rest = pixels;
    while !rest.is_empty() {
        let here = lamplight(x);
        let alike = (1..rest.len()).find(|&more| lamplight(x + more) != here).unwrap_or(rest.len());
        let (stretch, further) = rest.split_at_mut(alike);
        layer.lay(covering, light.plus(here), &track, x, stretch, tally);
        (x, rest) = (x + alike, further);
    }
}

/// What lamps add to the light at `point`.
fn lamplight_at(world: &World, point: DVec2) -> Light {
    let is_on_map = point.x >= 0.0 && point.y >= 0.0;
    let cell = Cell { column: point.x as u32, row: point.y as u32 };
    if is_on_map { world.lamplight_in(cell) } else { Light::NONE }
}

/// How high a part of a tile is, and what it is laid with.
fn height_and_covering(tile: &Tile, part: Part) -> (f64, Covering) {
    let mut gaps = tile.gaps();
    match (part, tile.ceiling, tile.kind) {
        (Part::Ceiling, Ceiling::Covered(covering), _) => (tile.heights.ceiling(), covering),
        (Part::Top, _, TileKind::Shape(shape)) => {
            (tile.top_of_what_stands(), Covering::from(shape.paint))
        }
        (Part::Roof, ..) => {
            (gaps.next_back().map_or(0.0, |gap| gap.bottom), Covering::from(tile.lintel))
        }
        (_, _, TileKind::Wall(_) | TileKind::Mirror(_)) => {
            (gaps.next().map_or(0.0, |gap| gap.bottom), Covering::from(tile.riser))
        }
        (..) => (gaps.next().map_or(0.0, |gap| gap.bottom), tile.floor),
    }
}

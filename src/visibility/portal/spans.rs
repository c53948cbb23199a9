//! The spans of the portal way: along rows, where neighbouring columns show the same surface.
//!
//! A span ends where the next column shows another: one step for each span, without a search of the
//! row.

use std::ops::Range;
use std::{iter, mem};

use glam::DVec2;

use crate::visibility::runs::{ColumnRuns, FlatSurface, ImageId, Part, Run, Shown};
use crate::visibility::{Pass, PlaneSpan, Scene, Span};
use crate::world::{Ceiling, Cell, Covering, Light, Tile, TileKind, World};

/// Passes every span of `runs` in `rows` to `emit`. `starts` is working memory.
pub(crate) fn for_each_span(
    scene: Scene<'_>,
    runs: &ColumnRuns,
    rows: &Range<u32>,
    starts: &mut Vec<usize>,
    emit: &mut impl FnMut(Span<'_>),
) {
    starts.clear();
    starts.reserve(rows.len());
    if runs.is_empty() {
        return;
    }
    starts.resize(rows.len(), 0);
    let mut end_spans = |of: &Run, starts: &mut [usize], x: usize| {
        let Range { start, end } = *rows;
        for row in of.rows.start.clamp(start, end)..of.rows.end.clamp(start, end) {
            let columns = mem::replace(&mut starts[(row - start) as usize], x)..x;
            match of.shown {
                Shown::Flat | Shown::Face(_) => {}
                Shown::Sky(ImageId::NONE) => emit(Span::Sky { row, columns, image: None }),
                Shown::Sky(id) => emit(Span::Sky { row, columns, image: Some(runs.image(id)) }),
                Shown::Plane(surface) => emit_plane(scene, runs, surface, row, columns, emit),
            }
        }
    };
    let mut before: &[Run] = &[];
    for (x, column) in runs.columns().enumerate() {
        if before.is_empty() || column.is_empty() {
            // The portal way does not fill one of the two columns.
            for run in before {
                end_spans(run, starts, x);
            }
            starts.fill(x);
        } else {
            changes(before, column).for_each(|change| end_spans(&change, starts, x));
        }
        before = column;
    }
    for run in before {
        end_spans(run, starts, scene.projection.columns());
    }
}

/// The runs of `one` column that its neighbour does not have in the same rows.
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

/// Emits a span for each stretch of one light in the `columns` of `row` that show `surface`.
fn emit_plane(
    scene: Scene<'_>,
    runs: &ColumnRuns,
    surface: FlatSurface,
    row: u32,
    columns: Range<usize>,
    emit: &mut impl FnMut(Span<'_>),
) {
    let Scene { world, projection, .. } = scene;
    let FlatSurface { tile: id, part, image } = surface;
    let ground = world.ground();
    let tile = id.map_or(&ground, |id| &world.tiles()[usize::from(id.0)]);
    let light = tile.light.unwrap_or(Light::FULL);
    let (height, covering) = match id {
        None => (0.0, world.floor()),
        Some(_) => height_and_covering(tile, part),
    };
    let mut mapping = projection.mapping_at(row, height);
    if image != ImageId::NONE {
        mapping = mapping.seen_in_mirrors(runs.image(image));
    }
    let pass = match part {
        Part::Ceiling => Pass::Ceiling,
        Part::Floor | Part::Roof | Part::Top => Pass::Floor,
    };
    let mapping = &mapping;
    let span =
        |columns, light| Span::Plane(PlaneSpan { pass, row, columns, covering, light, mapping });
    if !world.has_lamplight() || id.is_none() {
        emit(span(columns, light));
        return;
    }
    // Lamps light each cell separately.
    let lamplight = |x: usize| lamplight_at(world, mapping.point(x));
    let Range { mut start, end } = columns;
    while start < end {
        let here = lamplight(start);
        let next = (start + 1..end).find(|&x| lamplight(x) != here).unwrap_or(end);
        emit(span(start..next, light.plus(here)));
        start = next;
    }
}

/// The light that lamps add at `point`.
fn lamplight_at(world: &World, point: DVec2) -> Light {
    Cell::containing(point).map_or(Light::NONE, |cell| world.lamplight_in(cell))
}

/// The height and the covering of a part of a tile.
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

//! Wall runs: neighbouring wall columns with one texture on one kind of side, in full light.
//!
//! They are drawn together where they show one level of detail, so that its loop is selected once for all
//! of them. Selecting it for each column took longer than drawing the pixels of a small picture.

use std::ops::Range;

use super::column_batch::ColumnBatch;
use super::direct_columns::{self, DirectColumn};
use super::sampling::Sampling;
use super::wall_column::WallLevel;
use crate::visibility::{Column, Facing, Pass, Scene, SideLit, WallRun};
use crate::world::{Paint, TextureId};

/// Draws the part of `run` in the rows of `batch`.
pub(crate) fn draw<'a, M: Sampling>(
    scene: Scene<'a>,
    run: &WallRun<'_>,
    batch: &mut ColumnBatch<'_, '_, 'a, SideLit>,
) {
    if batch.target_mut().counts() {
        for column in shown_columns(run, batch.target_mut().rows()) {
            batch.count(Pass::Walls, column.rows.len(), run.paint);
        }
    }
    match run.paint {
        Paint::Color(color) => {
            for column in shown_columns(run, batch.target_mut().rows()) {
                batch.queue_color(column.x, column.rows, color, SideLit(run.side));
            }
        }
        Paint::Texture(id) => draw_texture::<M>(scene, run, id, batch),
    }
}

/// Draws `run`, which shows the texture `id`, level by level.
fn draw_texture<'a, M: Sampling>(
    scene: Scene<'a>,
    run: &WallRun<'_>,
    id: TextureId,
    batch: &mut ColumnBatch<'_, '_, 'a, SideLit>,
) {
    let texture = scene.world.texture(id);
    let facing = Facing::Side(run.side);
    let mut lods = (run.first..).zip(run.columns).map(|(x, column)| {
        let slope = facing.slope(scene.projection.direction_of(x));
        M::lod_on_face(scene, texture, column.distance, slope)
    });
    let Some(mut lod) = lods.next() else { return };
    let mut first = 0;
    let mut draw = |columns: Range<usize>, lod| {
        let WallRun { side, paint, .. } = *run;
        let part = WallRun {
            first: run.first + columns.start as u32,
            columns: &run.columns[columns],
            side,
            paint,
        };
        draw_level::<M>(scene, &part, WallLevel::new(scene, id, lod), batch);
    };
    for (index, next) in (1..).zip(lods) {
        if next != lod {
            draw(first..index, lod);
            (first, lod) = (index, next);
        }
    }
    draw(first..run.columns.len(), lod);
}

/// Draws `run`, which shows one level.
fn draw_level<'a, M: Sampling>(
    scene: Scene<'a>,
    run: &WallRun<'_>,
    WallLevel { level, texels, .. }: WallLevel<'a, M>,
    batch: &mut ColumnBatch<'_, '_, 'a, SideLit>,
) {
    let lighting = SideLit(run.side);
    let columns =
        shown_columns(run, batch.target_mut().rows()).map(|ShownColumn { x, rows, t, u }| {
            let stepper = scene.projection.texels_down_the_wall(t, texels);
            DirectColumn { x, rows, u, stepper }
        });
    if batch.is_direct(level) {
        direct_columns::draw(level, lighting, columns, batch.target_mut().band_mut());
        return;
    }
    for DirectColumn { x, rows, u, stepper } in columns {
        batch.queue_texels(x, rows, level.column(u), stepper, lighting);
    }
}

/// The visible part of a wall column.
struct ShownColumn {
    x: u32,
    rows: Range<u32>,
    t: f64,
    u: f64,
}

/// The columns of `run` that are visible in `rows`.
fn shown_columns(run: &WallRun<'_>, rows: Range<u32>) -> impl Iterator<Item = ShownColumn> {
    (run.first..).zip(run.columns).filter_map(move |(x, column)| {
        let Column { rows: of_column, hit, .. } = column;
        let hit = hit.as_ref()?;
        let shown = of_column.start.max(rows.start)..of_column.end.min(rows.end);
        (!shown.is_empty()).then_some(ShownColumn { x, rows: shown, t: hit.t, u: hit.u })
    })
}

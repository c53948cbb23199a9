//! Wall columns: upright faces as wide as a pixel.
//!
//! A wall column is one column of its texture, stretched. The texel of each pixel is computed from
//! its row, not from the texel above it, so that no error accumulates from row to row. If a wall is
//! so near that only a few of its texels are in view, they are the right ones.

use std::ops::Range;

use super::column_batch::{BatchMemory, ColumnBatch};
use super::direct_columns;
use super::sampling::Sampling;
use super::target::Target;
use super::wall_level::WallLevel;
use super::wall_run;
use crate::cast::Side;
use crate::visibility::{
    DrawList, Extent, Facing, Faded, Lighting, Pass, Scene, SideLit, Stats, WallColumn, WallSink,
};
use crate::world::{Light, Paint};

/// Draws all wall columns of `list`.
pub(super) fn draw<M: Sampling, S: Stats>(
    scene: Scene<'_>,
    list: &DrawList,
    memory: &mut BatchMemory,
    target: &mut Target<'_, S>,
) {
    let are_direct = direct_columns::are_for(scene, target.band_mut());
    let rows = target.rows();
    if scene.plan.walls.faded || scene.world.has_shapes() {
        let batch = ColumnBatch::new(memory, target, are_direct);
        let lighting = |wall: &WallColumn| lighting_of(scene, wall.facing, wall.light, wall.t);
        let mut queue = Queue::<M, _, _, _> { scene, batch, lighting, latest: None };
        list.for_each_flat_wall_column(scene, &rows, &mut queue);
        list.for_each_portal_wall_column(&rows, &mut queue);
        queue.batch.draw();
    } else {
        let mut batch = ColumnBatch::new(memory, target, are_direct);
        list.for_each_wall_run(scene, |run| wall_run::draw::<M, _>(scene, &run, &mut batch));
        let lighting = |wall: &WallColumn| SideLit(side_of(wall));
        let mut queue = Queue::<M, _, _, _> { scene, batch, lighting, latest: None };
        list.for_each_portal_wall_column(&rows, &mut queue);
        queue.batch.draw();
    }
}

/// The side that `wall` is, in a scene without shapes.
#[inline]
pub(super) fn side_of(wall: &WallColumn) -> Side {
    match wall.facing {
        Facing::Side(side) => side,
        // Only shapes have such a normal.
        Facing::Normal(_) => Side::X,
    }
}

/// The lighting of a face.
pub(super) fn lighting_of(scene: Scene<'_>, facing: Facing, light: Light, t: f64) -> Faded {
    let fog = scene.world.fog();
    match facing {
        Facing::Side(side) => Faded::of_wall(side, light, fog, t),
        Facing::Normal(normal) => Faded::of_surface(normal, light, fog, t),
    }
}

/// Queues wall columns in a lighting that depends on each column.
struct Queue<'m, 't, 'a, M: Sampling, L, S, F> {
    scene: Scene<'a>,
    batch: ColumnBatch<'m, 't, 'a, L, S>,
    lighting: F,
    /// The level of the column before.
    latest: Option<WallLevel<'a, M>>,
}

impl<M, L, S, F> WallSink for Queue<'_, '_, '_, M, L, S, F>
where
    M: Sampling,
    L: Lighting,
    S: Stats,
    F: Fn(&WallColumn) -> L,
{
    #[expect(clippy::inline_always, reason = "elsewhere every wall column would go through memory")]
    #[inline(always)]
    fn take(&mut self, wall: &WallColumn, rows: Range<u32>) {
        let Self { scene, batch, lighting, latest } = self;
        let (column, t) = (wall.column, wall.t);
        batch.count(Pass::Walls, rows.len(), wall.paint);
        let texture = match wall.paint {
            Paint::Color(color) => {
                batch.queue_color(column, rows, color, lighting(wall));
                return;
            }
            Paint::Texture(texture) => texture,
        };
        let WallLevel { level, texels, .. } =
            WallLevel::on_face(*scene, texture, (t, wall.slope), latest);
        let projection = scene.projection;
        match wall.extent {
            Extent::Level => {
                let stepper = projection.texels_down_the_wall(t, texels);
                batch.draw_wall((column, rows), (level, wall.u), stepper, lighting(wall));
            }
            Extent::Heights { bottom, top } => {
                let texels = level.column(wall.u);
                let stepper = projection.texels_down_the_face(t, texels.len(), bottom, top);
                batch.queue_repeating(column, rows, texels, stepper, lighting(wall));
            }
        }
    }
}

//! Wall columns: upright faces as wide as a pixel.
//!
//! A wall column is one column of its texture, stretched. The texel of each pixel is computed from
//! its row, not from the texel above it, so that no error accumulates from row to row. If a wall is
//! so near that only a few of its texels are in view, they are the right ones.
//!
//! Most columns show the same texture at the same level of detail as the one before. Looking it up for each
//! of them takes as long as a dozen pixels, so it is kept from one column to the next.

use std::ops::Range;

use super::column_batch::{BatchMemory, ColumnBatch};
use super::sampling::Sampling;
use super::target::Target;
use super::{direct_columns, wall_run};
use crate::cast::Side;
use crate::visibility::{
    DrawList, Extent, FaceTexels, Facing, Faded, Lighting, Pass, Projection, Scene, SideLit,
    WallColumn, WallSink, WallTexels,
};
use crate::world::texture::{MipLevel, Texture};
use crate::world::{Light, Paint, TextureId};

/// Draws all wall columns of `list`.
pub(crate) fn draw<M: Sampling>(
    scene: Scene<'_>,
    list: &DrawList,
    memory: &mut BatchMemory,
    target: &mut Target<'_>,
) {
    let are_direct = direct_columns::are_for(scene, target.band_mut());
    let rows = target.rows();
    if scene.plan.walls.faded || scene.world.has_shapes() {
        let batch = ColumnBatch::new(memory, target, are_direct);
        let lighting = |wall: &WallColumn| lighting_of(scene, wall.facing, wall.light, wall.t);
        let mut queue =
            Queue::<M, _, _> { scene, batch, lighting, latest: None, latest_face: None };
        list.for_each_flat_wall_column(scene, &rows, &mut queue);
        list.for_each_portal_wall_column(&rows, &mut queue);
        queue.batch.draw();
    } else {
        let mut batch = ColumnBatch::new(memory, target, are_direct);
        list.for_each_wall_run(scene, |run| wall_run::draw::<M>(scene, &run, &mut batch));
        let lighting = |wall: &WallColumn| SideLit(side_of(wall));
        let mut queue =
            Queue::<M, _, _> { scene, batch, lighting, latest: None, latest_face: None };
        list.for_each_portal_wall_column(&rows, &mut queue);
        queue.batch.draw();
    }
}

/// The side that `wall` is, in a scene without shapes.
#[inline]
pub(crate) fn side_of(wall: &WallColumn) -> Side {
    match wall.facing {
        Facing::Side(side) => side,
        // Only shapes have such a normal.
        Facing::Normal(_) => Side::X,
    }
}

/// The lighting of a face.
pub(crate) fn lighting_of(scene: Scene<'_>, facing: Facing, light: Light, t: f64) -> Faded {
    let fog = scene.world.fog();
    match facing {
        Facing::Side(side) => Faded::of_wall(side, light, fog, t),
        Facing::Normal(normal) => Faded::of_surface(normal, light, fog, t),
    }
}

/// The texels of a face, kept from one wall column to the next.
struct KnownFace {
    /// The number of texels for each cell of height.
    count: usize,
    /// The bottom and the top.
    heights: (f64, f64),
    texels: FaceTexels,
}

impl KnownFace {
    /// The texels of a face between these `heights`, `count` for each cell. `latest` is the face of the column
    /// before.
    #[inline]
    fn texels(
        projection: &Projection,
        count: usize,
        heights: (f64, f64),
        latest: &mut Option<Self>,
    ) -> FaceTexels {
        match latest {
            Some(known) if (known.count, known.heights) == (count, heights) => known.texels,
            _ => {
                let texels = projection.face_texels(count, heights);
                latest.insert(Self { count, heights, texels }).texels
            }
        }
    }
}

/// Queues wall columns in a lighting that depends on each column.
struct Queue<'m, 't, 'a, M: Sampling, L, F> {
    scene: Scene<'a>,
    batch: ColumnBatch<'m, 't, 'a, L>,
    lighting: F,
    /// The level of the column before.
    latest: Option<WallLevel<'a, M>>,
    /// The texels of the face before.
    latest_face: Option<KnownFace>,
}

impl<M, L, F> WallSink for Queue<'_, '_, '_, M, L, F>
where
    M: Sampling,
    L: Lighting,
    F: Fn(&WallColumn) -> L,
{
    #[expect(clippy::inline_always, reason = "elsewhere every wall column would go through memory")]
    #[inline(always)]
    fn take(&mut self, wall: &WallColumn, rows: Range<u32>) {
        let Self { scene, batch, lighting, latest, latest_face } = self;
        let (column, t) = (wall.column, wall.t);
        batch.count(Pass::Walls, rows.len(), wall.material);
        let texture = match wall.material {
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
                let count = level.height() as usize;
                let texels = KnownFace::texels(projection, count, (bottom, top), latest_face);
                let stepper = projection.texels_down_the_face(t, texels);
                batch.draw_face((column, rows), (level, wall.u), stepper, lighting(wall));
            }
        }
    }
}

/// A texture at one level of detail.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WallLevel<'a, M: Sampling> {
    id: TextureId,
    texture: &'a Texture,
    lod: M::Lod,
    pub(crate) level: &'a MipLevel,
    /// The texels of a wall that one texture of the level covers.
    pub(crate) texels: WallTexels,
}

impl<'a, M: Sampling> WallLevel<'a, M> {
    /// The level of the texture `id` for a face at distance `t`, which the ray approaches by `slope` cells
    /// per unit of `t`. `latest` is that of the column before.
    #[inline]
    pub(crate) fn on_face(
        scene: Scene<'a>,
        id: TextureId,
        (t, slope): (f64, f64),
        latest: &mut Option<Self>,
    ) -> Self {
        let known = (*latest).filter(|known| known.id == id);
        let texture = known.map_or_else(|| scene.world.texture(id), |known| known.texture);
        let lod = M::lod_on_face(scene, texture, t, slope);
        match known {
            Some(known) if known.lod == lod => known,
            _ => *latest.insert(Self::new(scene, id, lod)),
        }
    }

    /// The level `lod` of the texture `id`.
    #[inline(never)]
    pub(crate) fn new(scene: Scene<'a>, id: TextureId, lod: M::Lod) -> Self {
        let texture = scene.world.texture(id);
        let level = M::level_on_face(texture, lod);
        let texels = scene.projection.wall_texels(level.height() as usize);
        Self { id, texture, lod, level, texels }
    }
}

//! The pass for what stands upright: walls, the sides of floors and of what hangs from above, doors.

use std::ops::Range;

use glam::DVec2;

use super::Scene;
use super::blocks::by_columns;
use crate::cast::Side;
use crate::render::band::Band;
use crate::render::coat::{COLUMNS_AT_ONCE, Coats, Wardrobe};
use crate::render::shade::{Faded, OfSide, Shade};
use crate::render::tally::{Pass, Tally};
use crate::world::{Light, Paint};

/// A face as wide as a pixel, as far as it is seen.
#[derive(Clone, Debug)]
pub(super) struct Face {
    pub(super) column: u32,
    pub(super) rows: Range<u32>,
    pub(super) facing: Facing,
    /// How much of the ray leads straight at it, for each unit of `t`.
    pub(super) slope: f64,
    pub(super) t: f64,
    pub(super) u: f64,
    pub(super) paint: Paint,
    pub(super) light: Light,
    pub(super) stretch: Stretch,
}

/// Which way a face looks.
#[derive(Clone, Copy, Debug)]
pub(super) enum Facing {
    /// Along an axis.
    Side(Side),
    /// Along a vector of length 1, or the opposite way.
    Normal(DVec2),
}

/// From which height to which something reaches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stretch {
    pub(super) bottom: f64,
    pub(super) top: f64,
}

/// Draws all of `faces`, those of a column one after the other. `wardrobe` is memory to work with.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    faces: &[Face],
    wardrobe: &mut Wardrobe,
    band: &mut Band<'_>,
    tally: &mut T,
) {
    if scene.walls.faded || scene.world.has_shapes() {
        let shade = |face: &Face| face.facing.shade(scene, face.light, face.t);
        draw_shaded(scene, faces, Coats::new(wardrobe, band), tally, shade);
    } else {
        let shade = |face: &Face| match face.facing {
            Facing::Side(side) => OfSide(side),
            // Only shapes look that way, and there are none.
            Facing::Normal(_) => OfSide(Side::X),
        };
        draw_shaded(scene, faces, Coats::new(wardrobe, band), tally, shade);
    }
}

/// Neighbours in a block of columns are drawn together: mostly the first faces of each are parts of one
/// wall or step, and so are those behind them.
#[inline]
fn draw_shaded<'a, S: Shade, T: Tally>(
    scene: Scene<'a>,
    faces: &[Face],
    mut coats: Coats<'_, '_, 'a, S>,
    tally: &mut T,
    shade: impl Fn(&Face) -> S,
) {
    let blocks = by_columns::<COLUMNS_AT_ONCE, _>(faces, |face| face.column as usize);
    for mut columns in blocks {
        while columns.iter().any(|column| !column.is_empty()) {
            for face in columns.iter_mut().filter_map(|column| column.split_off_first()) {
                let rows = coats.clip(&face.rows);
                if !rows.is_empty() {
                    face.hang(scene, rows, shade(face), &mut coats, tally);
                }
            }
            coats.draw();
        }
    }
}

impl Facing {
    /// What becomes of the colours of what looks this way.
    pub(super) fn shade(self, scene: Scene<'_>, light: Light, t: f64) -> Faded {
        let fog = scene.world.fog();
        match self {
            Self::Side(side) => Faded::of_wall(side, light, fog, t),
            Self::Normal(normal) => Faded::of_surface(normal, light, fog, t),
        }
    }
}

impl Face {
    /// Has it covered in those `rows` in that shade.
    fn hang<'a, S: Shade, T: Tally>(
        &self,
        scene: Scene<'a>,
        rows: Range<u32>,
        shade: S,
        coats: &mut Coats<'_, '_, 'a, S>,
        tally: &mut T,
    ) {
        tally.pixels(Pass::Walls, rows.len());
        match self.paint {
            Paint::Color(color) => coats.paint(self.column, rows, color, shade),
            Paint::Texture(id) => {
                tally.texels(Pass::Walls, rows.len());
                let level = scene.level_on(scene.world.texture(id), self.t, self.slope);
                let texels = level.column(self.u);
                let Stretch { bottom, top } = self.stretch;
                let down = scene.projection.texels_down_the_face(self.t, texels.len(), bottom, top);
                coats.hang_on_face(self.column, rows, texels, down, shade);
            }
        }
    }
}

//! The pass for what stands upright: walls, the sides of floors and of what hangs from above, doors.

use std::ops::Range;

use glam::DVec2;

use super::Scene;
use crate::cast::Side;
use crate::render::band::Band;
use crate::render::coat::{self, COLUMNS_AT_ONCE, Coat, Cover, Paper, Papers};
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

/// Draws all of `faces`, those of a column one after the other. `papers` is memory to work with.
///
/// Neighbours in a block of columns are drawn together: mostly the first faces of each are parts of one
/// wall or step, and so are those behind them.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    faces: &[Face],
    papers: &mut Papers,
    band: &mut Band<'_>,
    tally: &mut T,
) {
    let is_faded = scene.walls.faded || scene.world.has_shapes();
    let block_of = |face: &Face| face.column as usize / COLUMNS_AT_ONCE;
    for block in faces.chunk_by(|one, other| block_of(one) == block_of(other)) {
        let mut columns: [&[Face]; COLUMNS_AT_ONCE] = [&[]; COLUMNS_AT_ONCE];
        for column in block.chunk_by(|one, other| one.column == other.column) {
            columns[column[0].column as usize % COLUMNS_AT_ONCE] = column;
        }
        while columns.iter().any(|column| !column.is_empty()) {
            let nearest = columns.each_mut().map(|column| column.split_off_first());
            if is_faded {
                let shade = |face: &Face| face.facing.shade(scene, face.light, face.t);
                let coats = coats(scene, nearest, shade, papers, band, tally);
                coat::draw(&coats, papers, band);
            } else {
                let shade = |face: &Face| match face.facing {
                    Facing::Side(side) => OfSide(side),
                    // Only shapes look that way, and there are none.
                    Facing::Normal(_) => OfSide(Side::X),
                };
                let coats = coats(scene, nearest, shade, papers, band, tally);
                coat::draw(&coats, papers, band);
            }
        }
    }
}

/// How `faces` are covered in `band`.
#[inline]
fn coats<'a, S: Shade, T: Tally>(
    scene: Scene<'a>,
    faces: [Option<&Face>; COLUMNS_AT_ONCE],
    shade: impl Fn(&Face) -> S,
    papers: &mut Papers,
    band: &Band<'_>,
    tally: &mut T,
) -> [Option<Coat<'a, S>>; COLUMNS_AT_ONCE] {
    let mut coats = [const { None }; COLUMNS_AT_ONCE];
    for (coat, (face, paper)) in coats.iter_mut().zip(faces.into_iter().zip(papers.iter_mut())) {
        let Some(face) = face else { continue };
        let rows = band.clip(&face.rows);
        if !rows.is_empty() {
            *coat = Some(face.coat(scene, rows, shade(face), paper, tally));
        }
    }
    coats
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
    /// How it is covered in those `rows` in that shade, by means of `paper`.
    fn coat<'a, S: Shade, T: Tally>(
        &self,
        scene: Scene<'a>,
        rows: Range<u32>,
        shade: S,
        paper: &mut Paper,
        tally: &mut T,
    ) -> Coat<'a, S> {
        tally.pixels(Pass::Walls, rows.len());
        let cover = match self.paint {
            Paint::Color(color) => Cover::of_color(color, shade, paper),
            Paint::Texture(id) => {
                tally.texels(Pass::Walls, rows.len());
                let level = scene.level_on(scene.world.texture(id), self.t, self.slope);
                let texels = level.column(self.u);
                let Stretch { bottom, top } = self.stretch;
                let down = scene.projection.texels_down_the_face(self.t, texels.len(), bottom, top);
                Cover::of_face(texels, down, shade, paper, &rows)
            }
        };
        Coat { x: self.column, rows, cover }
    }
}

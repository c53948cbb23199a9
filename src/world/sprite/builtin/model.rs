//! Models of guards: coloured solids, from which the pictures of all facings are computed.
//!
//! A guard has 64 pictures. Each frame is a model: ellipsoids, blocks and limbs, placed by the
//! joints of a [`skeleton`]. A `View` projects it orthographically for one facing; a picture
//! shows the nearest solid at the middle of each texel, with light from the upper left and a dark
//! outline. Rejected: drawings as text. They would be 320, and a change to one arm would change
//! dozens of them.

pub(crate) mod skeleton;
mod solid;

use std::f64::consts::TAU;
use std::ops::Range;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use solid::{Hit, Seen, Shape, Solid};
pub(crate) use solid::{Paint, glowing, matt};

use super::{INK, painted_by};
use crate::color::Rgb;
use crate::sort;
use crate::world::Texture;
use crate::world::sprite::Facings;

/// Solids in the coordinates of a body: x forwards, y to its right, z upwards from the floor, in
/// texels.
#[derive(Default)]
pub(crate) struct Model {
    solids: Vec<Solid>,
}

impl Model {
    /// Adds a limb: the hull of two balls.
    pub(crate) fn limb(&mut self, ends: [DVec3; 2], radii: [f64; 2], paint: Paint) {
        self.solids.push(Solid { shape: Shape::Limb { ends, radii }, paint });
    }

    /// Adds a ball.
    pub(crate) fn ball(&mut self, center: DVec3, radius: f64, paint: Paint) {
        self.limb([center; 2], [radius; 2], paint);
    }

    /// Adds an ellipsoid around the point `center` of `frame`, with those half axes in it.
    pub(crate) fn ellipsoid(
        &mut self,
        frame: DAffine3,
        center: [f64; 3],
        half: [f64; 3],
        paint: Paint,
    ) {
        let axes = placed(frame, center, half);
        self.solids.push(Solid { shape: Shape::Ellipsoid(axes), paint });
    }

    /// Adds a block around the point `center` of `frame`, with those half sides in it.
    pub(crate) fn block(
        &mut self,
        frame: DAffine3,
        center: [f64; 3],
        half: [f64; 3],
        paint: Paint,
    ) {
        let axes = placed(frame, center, half);
        self.solids.push(Solid { shape: Shape::Block(axes), paint });
    }
}

/// The lines of sight that the pictures of those models need at most.
#[cfg(test)]
pub(crate) fn lines_of_sight(frames: impl Iterator<Item = Model>, size: Size) -> usize {
    let lines_of = |model: &Model, view: View| -> usize {
        let seen = model.solids.iter().map(|solid| solid.seen(view));
        seen.map(|seen| size.columns(&seen).len() * size.rows(&seen).len()).sum()
    };
    let lines = frames
        .map(|model| View::all(Facings::Eight).map(|view| lines_of(&model, view)).sum::<usize>());
    lines.sum()
}

/// The map from the unit ball, or the cube around it, to a solid.
fn placed(frame: DAffine3, center: [f64; 3], half: [f64; 3]) -> DAffine3 {
    frame * DAffine3::from_translation(center.into()) * DAffine3::from_scale(half.into())
}

/// The pictures of the models of `frames`, frame by frame and within each frame facing by facing. A model is
/// made again for each picture that is first shown: that takes a hundredth of the time of the picture.
pub(crate) fn pictures<F: Copy + Send + Sync + 'static>(
    frames: impl IntoIterator<Item = F>,
    model: fn(F) -> Model,
    size: Size,
) -> Vec<Texture> {
    let views = || View::all(Facings::Eight);
    let pairs = frames.into_iter().flat_map(|frame| views().map(move |view| (frame, view)));
    pairs
        .map(|(frame, view)| {
            painted_by(size.width, size.height, move || {
                let mut studio = Studio::new(size);
                studio.draw_all(&model(frame).solids, view);
                move |x, y| studio.outlined(x as usize, y as usize)
            })
        })
        .collect()
}

/// From the coordinates of a body to those of a picture: x to the right, y upwards, z towards the
/// viewer.
#[derive(Clone, Copy)]
pub(crate) struct View {
    pub(crate) matrix: DMat3,
}

/// How far above the horizon the viewer is, in radians: the top of what lies on the floor shows.
const ELEVATION: f64 = 0.17;

impl View {
    /// The views of all facings, from the front on and clockwise around the body.
    pub(crate) fn all(facings: Facings) -> impl Iterator<Item = Self> {
        let turn = TAU / f64::from(facings.count());
        (0..facings.count()).map(move |facing| Self::from_angle(f64::from(facing) * turn))
    }

    /// The view of a viewer at that angle, in radians clockwise from the body's front.
    fn from_angle(angle: f64) -> Self {
        let (sine, cosine) = libm::sincos(angle);
        let (raised, level) = libm::sincos(ELEVATION);
        let to_viewer = DVec3::new(cosine * level, sine * level, raised);
        let right = DVec3::new(sine, -cosine, 0.0);
        let up = DVec3::new(-cosine * raised, -sine * raised, level);
        Self { matrix: DMat3::from_cols(right, up, to_viewer).transpose() }
    }
}

/// The size of a picture, in texels. The body's axis is in the middle, and the floor is one texel
/// above the lower edge, which leaves room for the outline.
#[derive(Clone, Copy)]
pub(crate) struct Size {
    pub(crate) width: u32,
    pub(crate) height: u32,
}

/// The picture of a model in the making.
struct Studio {
    size: Size,
    /// Row by row from the top, with an empty margin of one texel on all sides.
    texels: Vec<Texel>,
}

/// What a texel shows.
#[derive(Clone, Copy)]
struct Texel {
    /// The coordinate towards the viewer; negative infinity where nothing is.
    depth: f64,
    color: Rgb,
    glows: bool,
}

const NOTHING: Texel = Texel { depth: f64::NEG_INFINITY, color: INK, glows: false };

/// What is this much nearer than its neighbour has an outline within the figure, in texels.
const EDGE: f64 = 2.2;

impl Studio {
    pub(crate) fn new(size: Size) -> Self {
        Self { size, texels: vec![NOTHING; size.stride() * (size.height as usize + 2)] }
    }

    /// Draws `solids` in `view`.
    pub(crate) fn draw_all(&mut self, solids: &[Solid], view: View) {
        // From the nearest on, so that most of what is hidden is refused by its depth.
        let mut seen: Vec<_> = solids.iter().map(|solid| (solid.seen(view), solid.paint)).collect();
        sort::by(&mut seen, |(one, _), (other, _)| other.nearest.total_cmp(&one.nearest));
        for (seen, paint) in &seen {
            self.draw(seen, *paint);
        }
    }

    fn draw(&mut self, seen: &Seen, paint: Paint) {
        let columns = self.size.columns(seen);
        for row in self.size.rows(seen) {
            let start = self.size.place(0, row as usize);
            for column in columns.clone() {
                let texel = &mut self.texels[start + column as usize];
                if texel.depth >= seen.nearest {
                    continue;
                }
                let Some(hit) = seen.hit(self.size.point(column, row)) else { continue };
                if hit.depth > texel.depth {
                    let color = shaded(&hit, paint);
                    *texel = Texel { depth: hit.depth, color, glows: paint.glows };
                }
            }
        }
    }

    /// The colour at `(x, y)` with outlines: around the figure, and where a part is well behind its
    /// neighbour.
    fn outlined(&self, x: usize, y: usize) -> Option<Rgb> {
        let (place, stride) = (self.size.place(x, y), self.size.stride());
        let own = self.texels[place];
        let near = [place - 1, place + 1, place - stride, place + stride];
        let nearest = near.map(|place| self.texels[place].depth);
        let nearest = nearest.into_iter().fold(f64::NEG_INFINITY, f64::max);
        match own.depth {
            f64::NEG_INFINITY => (nearest > own.depth).then_some(INK),
            depth if nearest > depth + EDGE && !own.glows => Some(toned(own.color, [70; 3])),
            _ => Some(own.color),
        }
    }
}

impl Size {
    /// The number of texels in a row with its margins.
    fn stride(self) -> usize {
        self.width as usize + 2
    }

    /// The index of a texel, below the margin and to the right of it.
    fn place(self, column: usize, row: usize) -> usize {
        (row + 1) * self.stride() + column + 1
    }

    /// The point of the picture plane in the middle of a texel.
    fn point(self, column: u32, row: u32) -> DVec2 {
        let across = f64::from(column) + 0.5 - f64::from(self.width) / 2.0;
        DVec2::new(across, f64::from(self.height) - 1.5 - f64::from(row))
    }

    /// The columns whose middles a solid may cover.
    pub(crate) fn columns(self, seen: &Seen) -> Range<u32> {
        let middle = f64::from(self.width) / 2.0;
        between(seen.low.x + middle, seen.high.x + middle, self.width)
    }

    /// The rows above the floor whose middles a solid may cover.
    pub(crate) fn rows(self, seen: &Seen) -> Range<u32> {
        let floor = f64::from(self.height) - 1.0;
        between(floor - seen.high.y, floor - seen.low.y, self.height - 1)
    }
}

/// The texels, of `count`, whose middles are between two places.
fn between(low: f64, high: f64, count: u32) -> Range<u32> {
    let first = (low - 0.5).ceil().max(0.0) as u32;
    first..((high + 0.5).floor().max(0.0) as u32).clamp(first, count.max(first))
}

/// The colour of a surface in the light from the upper left.
fn shaded(hit: &Hit, paint: Paint) -> Rgb {
    const LIGHT: DVec3 = DVec3::new(-0.56, 0.66, 0.5);
    if paint.glows {
        return paint.color;
    }
    // Shares of each channel in 128ths: what is in the shade is bluer.
    let shares = match hit.normal.dot(LIGHT) {
        0.82.. => [148, 146, 140],
        0.40.. => [124, 124, 124],
        0.05.. => [94, 94, 102],
        _ => [66, 66, 76],
    };
    toned(paint.color, shares)
}

/// `color` with each channel multiplied by a number of 128ths.
fn toned(color: Rgb, shares: [u32; 3]) -> Rgb {
    let channel = |channel: u8, share: u32| (u32::from(channel) * share / 128).min(255) as u8;
    let [red, green, blue] = color.channels();
    Rgb::new(channel(red, shares[0]), channel(green, shares[1]), channel(blue, shares[2]))
}

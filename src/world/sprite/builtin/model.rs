//! Models of guards: coloured solids, from which the pictures of all facings are computed.
//!
//! A guard has 64 pictures. Each frame is a model: ellipsoids, blocks and limbs, placed by the
//! joints of a [`skeleton`]. A [`View`] projects it orthographically for one facing; a picture
//! shows the nearest solid at the middle of each texel, with light from the upper left and a dark
//! outline. Drawings as text were refused: they would be 320, and a change to one arm would change
//! dozens of them.

mod picture;
pub(crate) mod skeleton;
mod solid;
mod view;

use glam::{DAffine3, DVec3};

use super::painted_by;
use crate::world::Texture;
use crate::world::sprite::Facings;
pub(crate) use picture::Size;
use picture::Studio;
pub(crate) use solid::{Paint, glowing, matt};
use solid::{Shape, Solid};
use view::View;

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

//! Models of guards: coloured solids, from which the pictures of all facings are computed.
//!
//! A guard has 64 pictures. Each frame is a model: ellipsoids, blocks and limbs, placed by the
//! joints of a [`skeleton`]. A [`View`] projects it orthographically for one facing; a picture
//! shows the nearest solid at the middle of each texel, with light from the upper left and a dark
//! outline. Drawings as text were refused: they would be 320, and a change to one arm would change
//! dozens of them.

mod picture;
pub(super) mod skeleton;
mod solid;
mod view;

use glam::{DAffine3, DVec3};

use crate::world::Texture;
use crate::world::sprite::Facings;
pub(super) use picture::Size;
use picture::Studio;
pub(super) use solid::{Paint, glowing, matt};
use solid::{Shape, Solid};
use view::View;

/// Solids in the coordinates of a body: x forwards, y to its right, z upwards from the floor, in
/// texels.
#[derive(Default)]
pub(super) struct Model {
    solids: Vec<Solid>,
}

impl Model {
    /// Adds a limb: the hull of two balls.
    pub(super) fn limb(&mut self, ends: [DVec3; 2], radii: [f64; 2], paint: Paint) {
        self.solids.push(Solid { shape: Shape::Limb { ends, radii }, paint });
    }

    /// Adds a ball.
    pub(super) fn ball(&mut self, center: DVec3, radius: f64, paint: Paint) {
        self.limb([center; 2], [radius; 2], paint);
    }

    /// Adds an ellipsoid around the point `center` of `frame`, with those half axes in it.
    pub(super) fn ellipsoid(
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
    pub(super) fn block(
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
pub(super) fn lines_of_sight(frames: impl Iterator<Item = Model>, size: Size) -> usize {
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

/// The pictures of models, frame by frame and within each frame facing by facing.
pub(super) fn pictures(frames: impl Iterator<Item = Model>, size: Size) -> Vec<Texture> {
    let mut studio = Studio::new(size);
    let mut pictures = Vec::new();
    for model in frames {
        pictures.extend(View::all(Facings::Eight).map(|view| studio.picture(&model.solids, view)));
    }
    pictures
}

//! The orthographic projection of a model for one facing.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3};

use crate::world::sprite::Facings;

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

//! The 3-D caster: spheres, planes and boxes, and one ray for each pixel.
//!
//! This renderer shares only the [`Frame`](crate::render::Frame) with the grid's renderer. It draws
//! a [`Scene`] as seen by a [`Camera`]. The conventions are the same as for grids, with a third axis: x
//! points east, y south and z up, and lengths are in cells. Looking up turns the camera. This costs
//! no more than a level view, because rays are not grouped in columns.
//!
//! Rays are traced in groups of sixteen `lanes`, which are neighbouring pixels of a row. All lanes
//! run the same instructions, without branches.
//!
//! A surface is lit by its angle to the sun, unless another body is in between: see `shadows`. A
//! checker pattern shows its mean over the area of a pixel: see `checker`.
//!
//! A body is tested only against the pixels that it can cover. Its bounds on the screen are
//! computed first, and a row of pixels tests only the bodies that reach it. If these bounds overlap
//! so much that a pixel has many bodies to test, a bounding volume hierarchy finds the nearest
//! body: see `tree`. Other scenes do not use it, because most maps have few bodies, and testing
//! rows of pixels is then faster than searching a tree.

#![expect(clippy::inline_always, reason = "only inlined code is compiled for the widest registers")]
#![expect(clippy::needless_bitwise_bool, reason = "a branch keeps lanes from being one vector")]

mod bounds;
mod camera;
mod checker;
mod lanes;
mod ray;
mod relative_shape;
mod renderer;
mod row;
mod shading;
mod shadows;
mod tree;

pub use crate::world::scene::{
    Block, Body, BodyShape, EYE_CLEARANCE, Elevation, Fraction, MAX_COORDINATE, MIN_LENGTH, Plane,
    Scene, SceneStart, SolidTexture, Sphere, Sun,
};
pub use camera::{Axes, Camera};
pub use ray::{Hit, Ray};
pub use renderer::{Explanation, Renderer};

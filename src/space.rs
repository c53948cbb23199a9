//! The 3-D caster: spheres, planes and boxes, and one ray for each pixel.
//!
//! This renderer shares only the [`Frame`](crate::render::Frame) with the grid's renderer. It draws
//! what a [`Camera`] sees of a [`Scene`]. The conventions are those of grids with a third axis: x
//! points east, y south and z up, and lengths are in cells. Looking up turns the camera: without
//! columns, this costs no more than a level view.
//!
//! Rays are traced in `lanes` of sixteen pixels of a row, all by the same instructions without branches.
//!
//! A surface is lit by its angle to the sun, unless another body is in between: see `shadows`. A
//! checker pattern shows its mean over the area of a pixel: see `checker`.
//!
//! A body is tested only against the pixels that it can cover. Its bounds on the screen are
//! computed first, and a row of pixels tests only the bodies that reach it. Where these bounds overlap
//! so much that a pixel has many bodies to test, a bounding volume hierarchy finds the nearest of
//! them: see `tree`. It is not used elsewhere, since most maps have few bodies, and rows of pixels are
//! faster to test than a tree.

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
    Block, Body, EYE_CLEARANCE, Elevation, FARTHEST, Fraction, Plane, SMALLEST, Scene, Shape,
    SolidTexture, Sphere, Start, Sun,
};
pub use camera::{Axes, Camera};
pub use ray::{Hit, Ray};
pub use renderer::{Explanation, Renderer};

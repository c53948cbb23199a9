//! The 3-D caster: spheres, planes and boxes, and a ray for every pixel.
//!
//! It stands beside the grid's renderer and shares nothing with it but the frame: a [`Scene`] and a
//! [`Camera`] in, pixels out. The conventions are the grid's, with a third axis: x to the east, y to
//! the south, z upwards, lengths in cells. Looking up turns the camera, as there are no columns here
//! that it would cost.
//!
//! What a ray hits is lit by how it faces the sun, if no other body is in between: see `shadows`. A
//! checker shows the mean of what a pixel covers of it: see `checker`.
//!
//! A body is tested against the pixels that it can cover and no others: its bounds on the screen are
//! found first, and a row of pixels asks only the bodies that reach it. A tree of bounding volumes was
//! refused: it pays off with thousands of bodies, and a map is written by hand.

mod body;
mod bounds;
mod camera;
mod checker;
mod explanation;
mod light;
mod ray;
mod renderer;
mod scene;
mod seen;
mod shadows;

pub use body::{Block, Body, Coat, FARTHEST, Plane, SMALLEST, Shape, Sphere};
pub use camera::{Axes, Camera, EYE_ROOM, Elevation};
pub use explanation::Explanation;
pub use light::{Share, Sky, Sun};
pub use ray::{Hit, Ray};
pub use renderer::Renderer;
pub use scene::{Scene, Start};

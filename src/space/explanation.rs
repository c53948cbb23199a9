//! The counts of a frame of a scene.

use std::fmt;

/// The counts of a frame of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// Bodies in the scene.
    pub bodies: u64,
    /// Bodies that can cover a pixel.
    pub in_view: u64,
    /// Rays cast from the camera, one for each pixel.
    pub rays: u64,
    /// Tests of these rays against bodies.
    pub tests: u64,
    /// Rays that hit a body.
    pub hits: u64,
    /// Rays cast from these hits towards the sun.
    pub shadow_rays: u64,
    /// Tests of shadow rays against bodies, and of neighbouring ones together against boxes around them.
    pub shadow_tests: u64,
}

impl fmt::Display for Explanation {
    /// Writes a few lines for people.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { bodies, in_view, rays, tests, hits, shadow_rays, shadow_tests } = self;
        let without_bounds = rays * bodies;
        writeln!(f, "bodies   {in_view:>10} of {bodies} in view")?;
        writeln!(f, "rays     {rays:>10} cast, one a pixel, {hits} of them hit a body")?;
        writeln!(
            f,
            "tests    {tests:>10} of a ray against a body, of {without_bounds} without bounds"
        )?;
        writeln!(f, "shadows  {shadow_rays:>10} rays cast towards the sun, {shadow_tests} tests")
    }
}

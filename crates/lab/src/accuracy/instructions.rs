//! The instructions of each method for a ray, as Callgrind has counted them.
//!
//! A program cannot count its own instructions without the help of the system, and a time differs
//! from run to run. Therefore the counts of the ordinary scenes are kept in a file, which
//! `.ci/accuracy count` writes. They are those of [`SEED`] and [`RAYS`] rays, or a hundredth of
//! these on the plain.

use crate::casters::Method;

/// The seed of the counted rays.
pub const SEED: u64 = 1;
/// The number of counted rays in a scene.
pub const RAYS: usize = 2000;

/// A line for each scene and method: their names, and the instructions for a ray.
const COUNTS: &str = include_str!("instructions/counts");

/// The instructions for a ray of the scene with that name, if they are kept.
pub(crate) fn instructions(scene: &str, method: &Method) -> Option<f64> {
    let method = method.to_string();
    COUNTS.lines().find_map(|line| {
        let mut words = line.split(' ');
        let is_it = words.next() == Some(scene) && words.next() == Some(&method);
        is_it.then(|| words.next()?.parse().ok()).flatten()
    })
}

//! Texture filters: the error of each, and how much it shimmers.
//!
//! The reference is a picture that is eight times as wide and high and drawn without filtering;
//! each pixel is the mean of 64 of its pixels in linear light. It has smooth edges of walls and
//! things, which no picture with one ray for each column has. This part of the error is the same
//! for all filters. Shimmer is the change from frame to frame while the camera turns slowly. Moving
//! edges change pixels with every filter, so that shimmer is never zero, and is only good for
//! comparisons.

use std::num::NonZeroU32;

use super::pictures::cameras;
use crate::color::Rgb;
use crate::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use crate::world::{Camera, Texture, World};

/// The filters and their names on the command line.
const FILTERS: [(&str, Filter); 2] = [("mip", Filter::Mip), ("nearest", Filter::Nearest)];

/// The errors of a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilterRow {
    /// The name on the command line.
    pub name: &'static str,
    /// The errors in pictures of each of the requested sizes.
    pub errors: [FilterErrors; 2],
}

/// The errors of a filter in some pictures. Differences are between channels, in steps of 8 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FilterErrors {
    /// The mean difference from the reference.
    pub mean: f64,
    /// The largest difference.
    pub worst: u8,
    /// The mean change from frame to frame of a slow turn.
    pub shimmer: f64,
}

/// The errors of each filter in `count` pictures of `world`, in each of these sizes.
pub fn compare_filters(
    world: &World,
    sizes: [FrameSize; 2],
    count: usize,
    seed: u64,
) -> [FilterRow; 2] {
    let cameras: Vec<Camera> = cameras(world, seed).take(count).collect();
    FILTERS.map(|(name, filter)| {
        let errors = sizes.map(|size| errors(world, &cameras, size, filter));
        FilterRow { name, errors }
    })
}

/// The mean change of a channel from frame to frame, in steps of 8 bits, over sixty frames in which
/// `camera` turns by a ninth of a degree each.
pub fn shimmer(world: &World, camera: &Camera, size: FrameSize, filter: Filter) -> f64 {
    const TURNS: u32 = 60;
    const ANGLE: f64 = 0.002;
    let mut camera = *camera;
    let mut renderer = Renderer::new();
    renderer.set_filter(filter);
    let mut before = Frame::new(size, PixelAspect::SQUARE);
    let mut after = before.clone();
    renderer.render(world, &camera, &mut before);
    let mut changes = Mean::default();
    for _ in 0..TURNS {
        camera.heading = camera.heading.turned(ANGLE);
        renderer.render(world, &camera, &mut after);
        for (&one, &other) in before.rows().flatten().zip(after.rows().flatten()) {
            changes.add(one, other);
        }
        std::mem::swap(&mut before, &mut after);
    }
    changes.mean()
}

fn errors(world: &World, cameras: &[Camera], size: FrameSize, filter: Filter) -> FilterErrors {
    let mut differences = Mean::default();
    let mut sum_of_shimmer = 0.0;
    for camera in cameras {
        let picture = draw(world, camera, size, filter);
        let covered = covered(world, camera, size);
        for (y, row) in picture.rows().enumerate() {
            for (x, &pixel) in row.iter().enumerate() {
                let across = (x as f64 + 0.5) / f64::from(picture.width());
                differences.add(pixel, covered.level(MIP_LEVEL).column(across)[y]);
            }
        }
        sum_of_shimmer += shimmer(world, camera, size, filter);
    }
    FilterErrors {
        mean: differences.mean(),
        worst: differences.worst,
        shimmer: sum_of_shimmer / cameras.len().max(1) as f64,
    }
}

/// The factor by which the larger picture is wider and higher, and the number of mip levels to the
/// original size.
const SCALE: NonZeroU32 = NonZeroU32::new(1 << MIP_LEVEL).unwrap();
const MIP_LEVEL: usize = 3;

/// The larger picture. Its mip levels are the means over the pixels of a picture of `size`.
fn covered(world: &World, camera: &Camera, size: FrameSize) -> Texture {
    let [width, height] = [size.width, size.height].map(|side| side.saturating_mul(SCALE));
    let picture = draw(world, camera, FrameSize { width, height }, Filter::Nearest);
    Texture::from_fn(width, height, |x, y| picture.pixel(x, y))
}

fn draw(world: &World, camera: &Camera, size: FrameSize, filter: Filter) -> Frame {
    let mut renderer = Renderer::new();
    renderer.set_filter(filter);
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    renderer.render(world, camera, &mut frame);
    frame
}

/// Differences between channels.
#[derive(Default)]
struct Mean {
    worst: u8,
    sum: u64,
    count: u64,
}

impl Mean {
    fn add(&mut self, one: Rgb, other: Rgb) {
        for (one, other) in one.channels().into_iter().zip(other.channels()) {
            let difference = one.abs_diff(other);
            self.worst = self.worst.max(difference);
            self.sum += u64::from(difference);
            self.count += 1;
        }
    }

    fn mean(&self) -> f64 {
        self.sum as f64 / self.count.max(1) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map;

    fn room(wall: &str, floor: &str) -> World {
        let text = format!(
            "floor = '{floor}'\nceiling = '{floor}'\n\
             grid = '''\n####\n#@.#\n#..#\n####\n'''\n\
             tiles.'#'.wall = '{wall}'\nthings.'@'.start = 0\n"
        );
        map::parse_str(&text).unwrap()
    }

    fn compare(world: &World) -> [FilterRow; 2] {
        let size = FrameSize::new(40, 24).unwrap();
        compare_filters(world, [size; 2], 3, 5)
    }

    #[test]
    fn plain_colours_have_no_error_and_no_shimmer() {
        let rows = compare(&room("#000000", "#000000"));
        assert!(rows.iter().all(|row| row.errors == [FilterErrors::default(); 2]));
    }

    #[test]
    fn mip_levels_have_less_error_than_texels() {
        let [mip, nearest] = compare(&room("brick", "tile"));
        assert_eq!((mip.name, nearest.name), ("mip", "nearest"));
        assert!(mip.errors[0].mean < nearest.errors[0].mean);
        assert!(mip.errors[0].shimmer < nearest.errors[0].shimmer);
        assert!(mip.errors[0].worst > 0);
    }
}

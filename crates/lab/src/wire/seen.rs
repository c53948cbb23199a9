//! Compares pictures made of cells with the view of a camera, as both appear from a distance.
//!
//! The reference is a picture with 8×24 samples in each cell, averaged in linear light. The cells
//! are drawn by their dots at half that width and height. Both are blurred in linear light by a
//! Gaussian whose deviation is half a cell in each direction. The error is the mean distance in
//! Oklab, which is about what a reader sees at arm's length, where single dots blend. Rejected: the
//! distance of each dot. It counts a texture finer than the dots as an error, whatever the glyphs.

use std::num::NonZeroU32;

use ratatui::layout::Size;

use cellcaster::color::Rgb;
use cellcaster::color::oklab::Oklab;
use cellcaster::color::srgb::linear;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::tui::canvas::Mosaic;
use cellcaster::world::{Camera, World};

/// The columns and rows of points in each cell.
const POINTS: [usize; 2] = [4, 12];
/// The samples of the reference along each side of a point.
const SAMPLES: usize = 2;
/// The standard deviation of the blur, in columns and in rows of points: half a cell in each direction.
const DEVIATION: [f64; 2] = [2.0, 6.0];

/// A blurred picture.
pub(crate) struct SeenPicture(Vec<Oklab>);

impl SeenPicture {
    /// The view of `camera` in a window of `size` cells.
    pub(crate) fn of_view(world: &World, camera: &Camera, size: Size) -> Self {
        let [width, height] = extent(size);
        let side =
            |points: usize| NonZeroU32::new((points * SAMPLES) as u32).unwrap_or(NonZeroU32::MIN);
        let samples = FrameSize { width: side(width), height: side(height) };
        let aspect = PixelAspect::new(2.0 * POINTS[0] as f64 / POINTS[1] as f64);
        let mut frame = Frame::new(samples, aspect.unwrap_or(PixelAspect::SQUARE));
        let mut renderer = Renderer::new();
        renderer.set_filter(Filter::Area);
        renderer.render(world, camera, &mut frame);
        Self::blurred(size, |x, y| {
            let mut sum = [0.0; 3];
            for (dx, dy) in (0..SAMPLES * SAMPLES).map(|place| (place % SAMPLES, place / SAMPLES)) {
                let sample = frame.pixel((x * SAMPLES + dx) as u32, (y * SAMPLES + dy) as u32);
                for (sum, light) in sum.iter_mut().zip(linear(sample)) {
                    *sum += light / (SAMPLES * SAMPLES) as f64;
                }
            }
            sum
        })
    }

    /// A picture of cells, each with a mosaic in the colours of its dots and of the rest.
    pub(crate) fn of_cells(size: Size, cell: impl Fn(u16, u16) -> (Mosaic, [Rgb; 2])) -> Self {
        Self::blurred(size, |x, y| {
            let (mosaic, [dots, rest]) = cell((x / POINTS[0]) as u16, (y / POINTS[1]) as u16);
            let has_dot = mosaic.has((x % POINTS[0] / 2) as u32, (y % POINTS[1]) as u32);
            linear(if has_dot { dots } else { rest })
        })
    }

    fn blurred(size: Size, light: impl Fn(usize, usize) -> [f64; 3]) -> Self {
        let [width, height] = extent(size);
        let points: Vec<[f64; 3]> =
            (0..width * height).map(|at| light(at % width, at / width)).collect();
        Self(blurred(&points, width, DEVIATION))
    }

    /// The mean distance from another picture of the same size, in Oklab.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        let pairs = self.0.iter().zip(&other.0);
        let sum: f64 = pairs.map(|(one, other)| libm::sqrt(one.distance_squared(other))).sum();
        sum / self.0.len().max(1) as f64
    }
}

/// The columns and rows of points of a picture.
fn extent(size: Size) -> [usize; 2] {
    [usize::from(size.width) * POINTS[0], usize::from(size.height) * POINTS[1]]
}

/// Blurs a picture of linear light, row by row, by a Gaussian of this deviation across and down.
pub(crate) fn blurred(points: &[[f64; 3]], width: usize, deviation: [f64; 2]) -> Vec<Oklab> {
    let height = points.len() / width;
    let rows = blur(deviation[0], width, height, |x, y| points[y * width + x]);
    let columns = blur(deviation[1], height, width, |y, x| rows[y * width + x]);
    // `columns` stores the picture column by column.
    let rows = (0..height).flat_map(|y| columns.iter().skip(y).step_by(height));
    rows.map(|&light| Oklab::from_linear(light)).collect()
}

/// Blurs along the first coordinate. The result is stored row by row of the second. Points beyond
/// an edge equal the last point.
fn blur(
    deviation: f64,
    length: usize,
    count: usize,
    point: impl Fn(usize, usize) -> [f64; 3],
) -> Vec<[f64; 3]> {
    let reach = libm::ceil(3.0 * deviation) as i32;
    let weight =
        |distance: i32| libm::exp(-f64::from(distance * distance) / (2.0 * deviation * deviation));
    let total: f64 = (-reach..=reach).map(weight).sum();
    let weights: Vec<f64> = (-reach..=reach).map(|distance| weight(distance) / total).collect();
    let mut blurred = Vec::with_capacity(length * count);
    for across in 0..count {
        for along in 0..length {
            let mut sum = [0.0; 3];
            for (distance, weight) in (-reach..).zip(&weights) {
                let place = (along as i32 + distance).clamp(0, length as i32 - 1);
                for (sum, light) in sum.iter_mut().zip(point(place as usize, across)) {
                    *sum += weight * light;
                }
            }
            blurred.push(sum);
        }
    }
    blurred
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;
    use ratatui::style::Color;
    use ratatui::widgets::StatefulWidget;

    use super::*;
    use cellcaster::map::builtin;
    use cellcaster::tui::{FirstPerson, GlyphSet, View};
    use cellcaster::world::FieldOfView;

    fn rgb(color: Color) -> Rgb {
        let Color::Rgb(red, green, blue) = color else { panic!("{color:?}") };
        Rgb::new(red, green, blue)
    }

    /// The error of a level's first picture at 80×24, in thousandths.
    fn error(name: &str, glyphs: GlyphSet) -> f64 {
        let size = Size::new(80, 24);
        let level = builtin::LEVELS.iter().find(|level| level.name == name).unwrap();
        let world = level.world().unwrap();
        let camera = world.start_camera(FieldOfView::default());
        let truth = SeenPicture::of_view(&world, &camera, size);
        let mut buffer = Buffer::empty(Rect::from(size));
        FirstPerson::new(&world, &camera).glyphs(glyphs).filter(Filter::Area).render(
            buffer.area,
            &mut buffer,
            &mut View::default(),
        );
        let shown = SeenPicture::of_cells(size, |x, y| {
            let cell = &buffer[(x, y)];
            let mosaic = cell.symbol().chars().next().and_then(Mosaic::of_character).unwrap();
            (mosaic, [rgb(cell.fg), rgb(cell.bg)])
        });
        1000.0 * shown.distance(&truth)
    }

    #[test]
    fn finer_glyphs_have_less_error() {
        const SETS: [GlyphSet; 4] =
            [GlyphSet::Half, GlyphSet::Quadrant, GlyphSet::Sextant, GlyphSet::Octant];
        // A tenth above the errors of 2026-11.
        for (name, most) in [
            ("cellar", [6.4, 6.0, 4.6, 3.7]),
            ("museum", [7.4, 6.6, 4.9, 4.4]),
            ("citadel", [5.0, 4.8, 3.8, 3.4]),
            ("treasury", [6.2, 5.7, 4.2, 3.7]),
        ] {
            let errors = SETS.map(|glyphs| error(name, glyphs));
            assert!(errors.is_sorted_by(|coarser, finer| coarser > finer), "{name} {errors:.2?}");
            assert!(
                errors.iter().zip(most).all(|(&error, most)| error <= most),
                "{name} {errors:.2?}"
            );
            // Sextants leave at most 0.76 of the error of half blocks, and octants 0.68.
            assert!(
                errors[2] <= 0.76 * errors[0] && errors[3] <= 0.68 * errors[0],
                "{name} {errors:.2?}"
            );
        }
    }
}

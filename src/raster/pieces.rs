//! Pieces: the squares of a checker and the stripes of a floor or a ceiling, which alternate
//! between two paints.
//!
//! The end of each piece is computed, and its pixels are drawn like a plane with one paint.

use std::mem;

use super::span::{PlaneSpan, Sample, draw_level};
use super::target::Target;
use crate::color::Rgb;
use crate::visibility::TexelPlaces;

/// The width of a piece. The pattern repeats after two pieces, so the uppermost bit of a position
/// is the index of the piece. The other bits are the position in the piece.
const PIECE: u64 = 1 << 63;

/// Draws `span` in two samples without lighting: as a checker if `IS_CHECKER`, otherwise in stripes
/// along the x axis. Returns its pixels.
pub(crate) fn draw<'p, const IS_CHECKER: bool>(
    span: &PlaneSpan<'_>,
    samples: &[Sample<'_>; 2],
    target: &'p mut Target<'_>,
) -> &'p mut [Rgb] {
    let &PlaneSpan { pass, row, ref columns, covering, mapping, .. } = span;
    let places = mapping.places(columns.start, 1.0 / covering.scale.cells() / 2.0);
    let mut texels = 0;
    if target.counts() {
        let sampled = places.clone().take(columns.len());
        let sampled = sampled.map(|place| &samples[index::<IS_CHECKER>(place)]);
        texels = sampled.filter(|sample| matches!(sample, Sample::Level(_))).count();
    }
    target.count_texels(pass, texels);
    let pixels = target.span_mut(pass, row, columns.clone());
    draw_pieces::<IS_CHECKER>(samples, places, pixels);
    pixels
}

/// The index of the piece at a position.
#[inline]
fn index<const IS_CHECKER: bool>((x, y): (u64, u64)) -> usize {
    ((if IS_CHECKER { x ^ y } else { y }) / PIECE) as usize
}

/// Draws the pixels at `places`, piece by piece.
fn draw_pieces<const IS_CHECKER: bool>(
    samples: &[Sample<'_>; 2],
    mut places: TexelPlaces,
    mut pixels: &mut [Rgb],
) {
    let [step_x, step_y] = places.steps();
    while !pixels.is_empty() {
        let [x, y] = places.first();
        let along_y = pixels_to_edge(y, step_y);
        let end = if IS_CHECKER { along_y.min(pixels_to_edge(x, step_x)) } else { along_y };
        let count = end.min(pixels.len() as u64);
        let (of_piece, rest) = mem::take(&mut pixels).split_at_mut(count as usize);
        match &samples[index::<IS_CHECKER>((x, y))] {
            Sample::Color(color) => of_piece.fill(*color),
            Sample::Level(level) => draw_level(level, places.doubled(), of_piece),
        }
        places.skip_pixels(count);
        pixels = rest;
    }
}

/// The number of pixels from the pixel at `place` to the first pixel of the next piece, along one
/// axis.
#[inline]
fn pixels_to_edge(place: u64, step: u64) -> u64 {
    // A negative step is mirrored to a positive one.
    let is_negative = step.cast_signed() < 0;
    let (place, step) = if is_negative { (!place, step.wrapping_neg()) } else { (place, step) };
    let last_of_piece = PIECE - 1 - place % PIECE;
    last_of_piece.checked_div(step).map_or(u64::MAX, |steps| steps + 1)
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use glam::DVec2;
    use proptest::prelude::*;

    use super::*;
    use crate::visibility::SpanMapping;
    use crate::world::Texture;

    fn draw_pixels<const IS_CHECKER: bool>(
        samples: &[Sample<'_>; 2],
        places: TexelPlaces,
        pixels: &mut [Rgb],
    ) {
        for (pixel, (x, y)) in pixels.iter_mut().zip(places) {
            *pixel = match &samples[index::<IS_CHECKER>((x, y))] {
                Sample::Color(color) => *color,
                Sample::Level(level) => level.at_fraction(x << 1, y << 1),
            };
        }
    }

    proptest! {
        #[test]
        fn drawing_by_pieces_equals_drawing_by_pixels(
            middle in (-50.0..50.0, -50.0..50.0),
            on_edges: bool,
            half_step in prop::array::uniform2(prop_oneof![
                prop::sample::select(&[0.0, -0.0, 0.25, -0.5, 1.0 / 4096.0][..]),
                -0.1..0.1,
                -1e-18..1e-18,
            ]),
            width in 1_u32..1000,
            sides in prop::array::uniform2(1_u32..70),
            are_levels: [bool; 2],
        ) {
            let middle = DVec2::from(middle);
            let middle = if on_edges { middle.floor() } else { middle };
            let half_step = DVec2::from(half_step);
            let mapping = SpanMapping { distance: 1.0, pixel_area: 1.0, middle, half_step, width };
            let textures = sides.map(|side| {
                let side = NonZeroU32::new(side).unwrap();
                Texture::from_fn(side, side, |x, y| Rgb::new(x as u8, y as u8, 1))
            });
            let samples = [0, 1].map(|index: usize| {
                let color = Rgb::new(0, 0, index as u8);
                let level = textures[index].level(0);
                if are_levels[index] { Sample::Level(level) } else { Sample::Color(color) }
            });
            let places = mapping.places(0, 0.5);
            let mut drawn = [(); 4].map(|()| vec![Rgb::WHITE; width as usize]);
            let [one, other, of_stripes, single] = &mut drawn;
            draw_pieces::<true>(&samples, places.clone(), one);
            draw_pixels::<true>(&samples, places.clone(), other);
            prop_assert_eq!(one, other);
            draw_pieces::<false>(&samples, places.clone(), of_stripes);
            draw_pixels::<false>(&samples, places, single);
            prop_assert_eq!(of_stripes, single);
        }
    }
}

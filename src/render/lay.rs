//! Laying: the inner loops of floor and ceiling, one for each kind of pattern and shade.

use super::Filter;
use super::runs::Runs;
use super::shade::{Bright, Faded, Shade};
use super::tally::{Pass, Tally};
use super::track::{Places, Track};
use crate::color::Rgb;
use crate::color::srgb::mean_of_two;
use crate::world::texture::{Level, LevelByShifts};
use crate::world::{Covering, Light, Paint, Pattern, World};

/// What all of a floor's or a ceiling's spans have in common.
#[derive(Clone, Copy)]
pub(super) struct Layer<'a> {
    pub(super) world: &'a World,
    pub(super) filter: Filter,
    pub(super) pass: Pass,
}

impl Layer<'_> {
    /// Lays `covering` on `pixels`, which are those from column `x` on of the row of `track`.
    pub(super) fn lay<T: Tally>(
        self,
        covering: Covering,
        light: Light,
        track: &Track,
        x: usize,
        pixels: &mut [Rgb],
        tally: &mut T,
    ) {
        match Faded::of_plane(light, self.world.fog(), track.distance) {
            None => self.lay_shaded(covering, Bright, track, x, pixels, tally),
            Some(faded) => self.lay_shaded(covering, faded, track, x, pixels, tally),
        }
    }

    fn lay_shaded<S: Shade, T: Tally>(
        self,
        Covering { pattern, scale }: Covering,
        shade: S,
        track: &Track,
        x: usize,
        pixels: &mut [Rgb],
        tally: &mut T,
    ) {
        tally.pixels(self.pass, pixels.len());
        let per_cell = 1.0 / scale.cells();
        let sample = |paint| self.sample(paint, track, per_cell);
        // Patterns of two repeat after two pieces: the first bit of a place tells which piece it is
        // in, the others where in that.
        let places_in_two = || track.places(x, per_cell / 2.0);
        let are_too_small =
            self.filter.halvings(PIECES_IN_A_PIXEL * track.pixel_area * per_cell * per_cell) > 0;
        match pattern {
            Pattern::Checker([one, other]) | Pattern::Stripes([one, other]) if are_too_small => {
                let mean = mean_of_two(self.mean(one), self.mean(other));
                pixels.fill(shade.apply(mean));
            }
            Pattern::Plain(paint) => match sample(paint) {
                Sample::Color(color) => pixels.fill(shade.apply(color)),
                Sample::Level(level) => {
                    tally.texels(self.pass, pixels.len());
                    let places = track.places(x, per_cell);
                    match level.by_shifts() {
                        Some(level) => match Runs::of(level, &places, pixels.len()) {
                            Some(runs) => runs.lay(level, shade, pixels),
                            None => lay_by_shifts(level, shade, places, pixels),
                        },
                        None => {
                            for (pixel, (x, y)) in pixels.iter_mut().zip(places) {
                                *pixel = shade.apply(level.at_fraction(x, y));
                            }
                        }
                    }
                }
            },
            Pattern::Checker(paints) => {
                let samples = paints.map(sample);
                for (pixel, (x, y)) in pixels.iter_mut().zip(places_in_two()) {
                    let sample = &samples[((x ^ y) >> 63) as usize];
                    *pixel = shade.apply(sample.at_fraction(x << 1, y << 1, self.pass, tally));
                }
            }
            Pattern::Stripes(paints) => {
                let samples = paints.map(sample);
                for (pixel, (x, y)) in pixels.iter_mut().zip(places_in_two()) {
                    let sample = &samples[(y >> 63) as usize];
                    *pixel = shade.apply(sample.at_fraction(x << 1, y << 1, self.pass, tally));
                }
            }
        }
    }
}

/// Lays `level` on `pixels`, many at a time: which texels they show is computed first, in a loop that
/// reads no texel, so that a compiler has several of them computed at once.
fn lay_by_shifts<S: Shade>(
    level: LevelByShifts<'_>,
    shade: S,
    mut places: Places,
    pixels: &mut [Rgb],
) {
    let mut texels = [0; AT_ONCE];
    for pixels in pixels.chunks_mut(AT_ONCE) {
        // A few too many take less time than a few that are computed one by one.
        let texels = &mut texels[..pixels.len().next_multiple_of(LANES)];
        for (texel, (x, y)) in texels.iter_mut().zip(places.clone()) {
            *texel = level.index(x, y);
        }
        look_up(level, shade, texels, pixels);
        places.skip_pixels(AT_ONCE as u64);
    }
}

/// Colours `pixels` by the indices of their texels, of which there are at least as many.
#[inline]
fn look_up<S: Shade>(level: LevelByShifts<'_>, shade: S, texels: &[u32], pixels: &mut [Rgb]) {
    // Each may be the last, for all that a compiler knows, and so it does not unroll this by itself.
    let (pixels, rest) = pixels.as_chunks_mut::<UNROLLED>();
    let (texels, rest_of_texels) = texels.split_at(pixels.as_flattened().len());
    for (pixels, texels) in pixels.iter_mut().zip(texels.as_chunks::<UNROLLED>().0) {
        for (pixel, &texel) in pixels.iter_mut().zip(texels) {
            *pixel = shade.apply(level.at_index(texel));
        }
    }
    for (pixel, &texel) in rest.iter_mut().zip(rest_of_texels) {
        *pixel = shade.apply(level.at_index(texel));
    }
}

/// So many pixels are laid at once, at most.
const AT_ONCE: usize = 64;
/// A multiple of how many texels a processor computes at once.
const LANES: usize = 16;
const UNROLLED: usize = 8;

impl<'a> Layer<'a> {
    /// What `paint` is infinitely far away.
    fn mean(self, paint: Paint) -> Rgb {
        match paint {
            Paint::Color(color) => color,
            Paint::Texture(id) => self.world.texture(id).level(usize::MAX).at_fraction(0, 0),
        }
    }

    /// What `paint` is at the distance of `track`, where it repeats `per_cell` times in a cell.
    fn sample(self, paint: Paint, track: &Track, per_cell: f64) -> Sample<'a> {
        match paint {
            Paint::Color(color) => Sample::Color(color),
            Paint::Texture(id) => {
                let texture = self.world.texture(id);
                let texels = f64::from(texture.width()) * f64::from(texture.height());
                let area = track.pixel_area * per_cell * per_cell * texels;
                Sample::Level(texture.level(self.filter.halvings(area)))
            }
        }
    }
}

/// Where a pixel covers half a piece of a pattern, it shows the mean of both paints: this many times
/// the pieces in a pixel are as many as the texels from which on a texture is halved.
const PIECES_IN_A_PIXEL: f64 = 4.0;

/// A paint as it is at one distance.
enum Sample<'a> {
    Color(Rgb),
    Level(&'a Level),
}

impl Sample<'_> {
    #[inline]
    fn at_fraction<T: Tally>(&self, x: u64, y: u64, pass: Pass, tally: &mut T) -> Rgb {
        match self {
            Self::Color(color) => *color,
            Self::Level(level) => {
                tally.texels(pass, 1);
                level.at_fraction(x, y)
            }
        }
    }
}

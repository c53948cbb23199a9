//! Laying: the inner loops of floor and ceiling, one for each kind of pattern and shade.

use super::Filter;
use super::shade::{Bright, Faded, Shade};
use super::tally::{Pass, Tally};
use super::track::Track;
use crate::world::texture::{Level, mean_of_two};
use crate::world::{Covering, Light, Paint, Pattern, Rgb, World};

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
                    let pixels = pixels.iter_mut().zip(track.places(x, per_cell));
                    if let Some(level) = level.by_shifts() {
                        for (pixel, (x, y)) in pixels {
                            *pixel = shade.apply(level.at_fraction(x, y));
                        }
                    } else {
                        for (pixel, (x, y)) in pixels {
                            *pixel = shade.apply(level.at_fraction(x, y));
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

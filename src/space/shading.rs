//! Shading: the colours of neighbouring pixels that show the same body, or the sky.

use glam::DVec3;

use super::camera::SceneProjection;
use super::checker;
use super::lanes::{LANES, Lanes, Vectors};
use super::relative_shape::RelativeShape;
use super::row::RayGroup;
use super::shadows::Shadows;
use crate::color::Rgb;
use crate::color::srgb::{from_linear_16, linear_16};
use crate::numeric::rounding::rounded_short;
use crate::world::scene::{Scene, SolidTexture};

/// The values that all pixels of a frame share.
pub(crate) struct Shader<'a> {
    scene: &'a Scene,
    origin: DVec3,
    /// The changes of direction to the next column and to the next row.
    steps: [DVec3; 2],
    /// Whether the directions of a row have the same `z`. A row then meets a horizontal plane at
    /// one `t`.
    is_level: bool,
}

/// Memory for shading, which is reused.
#[derive(Clone, Debug, Default)]
pub(crate) struct Shading {
    /// The rays of the pixels.
    pub(crate) stretch: RayGroup,
    points: Vectors,
    normals: Vectors,
    brightness: Lanes,
    /// The footprints of the pixels, and the points below the surface, both in cubes of a checker.
    widths: Vectors,
    below: Vectors,
    /// The shares of the second colour of a checker.
    shares: Lanes,
    light: PixelLight,
}

/// The light of each pixel.
#[derive(Clone, Debug, Default)]
struct PixelLight {
    /// The share of the surface's own colour, in 256ths.
    own: [u32; LANES],
    /// The share of the fog's colour, in 256ths.
    fog: [u32; LANES],
}

impl Scene {
    /// The colour of the sky in this direction. It changes linearly with the slope.
    pub fn sky_color(&self, direction: DVec3) -> Rgb {
        self.sky.zenith.over(self.sky.horizon, sky_share(direction) as u8)
    }
}

impl<'a> Shader<'a> {
    pub(crate) fn new(scene: &'a Scene, projection: &SceneProjection, is_level: bool) -> Self {
        Self { scene, origin: projection.origin, steps: projection.steps(), is_level }
    }

    /// Colours `pixels`, which show the sky.
    #[inline(always)]
    pub(crate) fn shade_sky(&self, shading: &Shading, pixels: &mut [Rgb]) {
        let sky = self.scene.sky;
        let mut shares = [0; LANES];
        for (lane, share) in shares.iter_mut().enumerate() {
            *share = sky_share(shading.stretch.directions.get(lane));
        }
        // Many neighbours have the same colour.
        let (mut last, mut color) = (0, sky.horizon);
        for (pixel, share) in pixels.iter_mut().zip(shares) {
            if share != last {
                (last, color) = (share, sky.zenith.over(sky.horizon, share as u8));
            }
            *pixel = color;
        }
    }

    /// Colours `pixels`, which show `body`. Returns the number of shadow rays and of their tests.
    #[inline(always)]
    pub(crate) fn shade(
        &self,
        body: usize,
        shape: &RelativeShape,
        shadows: &Shadows,
        shading: &mut Shading,
        pixels: &mut [Rgb],
    ) -> (u64, u64) {
        let Shading { stretch: RayGroup { directions, t }, points, normals, .. } = shading;
        let normal = shape.common_normal();
        match normal {
            Some(normal) => normals.fill(|_| normal),
            None => shape.find_normals(directions, t, normals),
        }
        points.fill(|lane| self.origin + directions.get(lane) * t[lane]);
        // The points on a plane are on a line, in order.
        let ends = [points.get(0), points.get(pixels.len() - 1)];
        let bounds = match normal {
            Some(_) => [ends[0].min(ends[1]), ends[0].max(ends[1])],
            None => points.bounds(),
        };
        self.find_brightness(normal, shading);
        let ambient = self.scene.sun.ambient.get();
        let Shading { points, brightness, .. } = &mut *shading;
        let count = pixels.len();
        let rays = brightness[..count].iter().filter(|&&it| it > ambient).count() as u64;
        let mut tests = 0;
        if rays > 0 {
            let (boxes, exact) = shadows.darken(points, bounds, body, ambient, brightness);
            tests = boxes + exact * count as u64;
        }
        let is_level = self.is_level && normal.is_some_and(|it| it.x == 0.0 && it.y == 0.0);
        self.find_light(is_level, shading);
        match self.scene.bodies[body].texture {
            SolidTexture::Plain(color) => pixels.fill(color),
            SolidTexture::Checker(colors, scale) => {
                self.find_shares(is_level, scale.cells(), shading);
                mix(colors, &shading.shares, pixels);
            }
        }
        let fog = self.scene.fog.map_or(Rgb::BLACK, |fog| fog.color);
        let PixelLight { own, fog: shares } = &shading.light;
        for ((pixel, &own), &share) in pixels.iter_mut().zip(own).zip(shares) {
            *pixel = pixel.blended(own, fog, share);
        }
        (rays, tests)
    }

    /// Sets the brightness without shadows. `normal` is the normal that all pixels share, if there
    /// is one.
    #[inline(always)]
    fn find_brightness(&self, normal: Option<DVec3>, shading: &mut Shading) {
        let sun = self.scene.sun;
        let Shading { normals, brightness, .. } = shading;
        match normal {
            Some(normal) => brightness.fill(sun.brightness(normal)),
            None => {
                for (lane, brightness) in brightness.iter_mut().enumerate() {
                    *brightness = sun.brightness(normals.get(lane));
                }
            }
        }
    }

    /// Sets the light from the brightness and the fog. `is_level` is true if all pixels are at the
    /// same `t`.
    #[inline(always)]
    fn find_light(&self, is_level: bool, shading: &mut Shading) {
        const WHOLE: f64 = 256.0;
        let Shading { stretch: RayGroup { t, .. }, brightness, light, .. } = shading;
        let clearness = |t: f64| self.scene.fog.map_or(1.0, |fog| fog.clearness(t));
        if is_level || self.scene.fog.is_none() {
            let clearness = clearness(t[0]);
            light.fog = [256 - rounded_short(WHOLE * clearness); LANES];
            for (own, brightness) in light.own.iter_mut().zip(&*brightness) {
                *own = rounded_short(WHOLE * brightness * clearness);
            }
        } else {
            for lane in 0..LANES {
                let clearness = clearness(t[lane]);
                light.own[lane] = rounded_short(WHOLE * brightness[lane] * clearness);
                light.fog[lane] = 256 - rounded_short(WHOLE * clearness);
            }
        }
    }

    /// Sets the shares of the second colour of a checker of this `scale`.
    ///
    /// The colour is looked up slightly below the surface. A surface between two layers of cubes would
    /// otherwise show a random mixture of both.
    #[inline(always)]
    fn find_shares(&self, is_level: bool, scale: f64, shading: &mut Shading) {
        /// A part of a cube that is larger than any rounding and too small to be visible.
        const DEPTH: f64 = 1.0 / 1024.0;
        let Shading { stretch, points, normals, widths, below, shares, .. } = shading;
        let RayGroup { directions, t } = stretch;
        checker::find_footprints(directions, t, normals, self.steps, is_level, widths);
        below.fill(|lane| points.get(lane) / scale - normals.get(lane) * DEPTH);
        if scale != 1.0 {
            widths.divide(scale);
        }
        checker::find_means(below, widths, shares);
        // The cube at the origin is +1, its neighbours −1.
        for share in shares {
            *share = (1.0 - *share) / 2.0;
        }
    }
}

/// Colours `pixels` with the weighted mean of two colours in linear light. The weights of the second are
/// `shares`, from 0 to 1.
#[inline(always)]
fn mix([one, other]: [Rgb; 2], shares: &Lanes, pixels: &mut [Rgb]) {
    let is_one = |&share: &f64| (share == 0.0) | (share == 1.0);
    if shares.iter().fold(true, |all, share| all & is_one(share)) {
        for (pixel, &share) in pixels.iter_mut().zip(shares) {
            *pixel = if share == 0.0 { one } else { other };
        }
        return;
    }
    let (one, other) = (linear_16(one), linear_16(other));
    let mut channels = [[0; LANES]; 3];
    for (channels, (one, other)) in channels.iter_mut().zip(one.into_iter().zip(other)) {
        let [one, other] = [one, other].map(f64::from);
        for (channel, share) in channels.iter_mut().zip(shares) {
            *channel = rounded_short(one + (other - one) * share);
        }
    }
    let [red, green, blue] = channels;
    for (lane, pixel) in pixels.iter_mut().enumerate() {
        *pixel = from_linear_16([red[lane], green[lane], blue[lane]].map(|it| it as u16));
    }
}

/// The share of the zenith's colour in this direction, in 255ths.
#[inline(always)]
fn sky_share(direction: DVec3) -> u32 {
    const STEEPEST: f64 = 0.5;
    let DVec3 { x, y, z } = direction;
    let away = (x * x + y * y).sqrt();
    let height = z / STEEPEST;
    let above = if height > 0.0 { height } else { 0.0 };
    let height = if above < away { above } else { away };
    // Straight up or down, the horizontal distance is zero.
    let vertical = if z > 0.0 { 1.0 } else { 0.0 };
    let share = if away > 0.0 { height / away } else { vertical };
    rounded_short(share * 255.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sky_runs_from_horizon_to_zenith() {
        let scene = Scene::default();
        assert_eq!(scene.sky_color(DVec3::Z), scene.sky.zenith);
        assert_eq!(scene.sky_color(DVec3::new(1.0, 0.0, 0.5)), scene.sky.zenith);
        assert_eq!(scene.sky_color(DVec3::X), scene.sky.horizon);
        assert_eq!(scene.sky_color(-DVec3::Z), scene.sky.horizon);
    }
}

//! Scenes: levels made of bodies instead of a grid. All bodies are convex.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::{Fog, Heading, Scale, SkyGradient};
use crate::color::Rgb;

/// The largest absolute value of a coordinate along each axis, and the largest radius, in cells.
pub const MAX_COORDINATE: f64 = 1e9;
/// The smallest radius, and the shortest edge of a block, in cells.
pub const MIN_LENGTH: f64 = 1e-9;

/// The distance that the player's eye keeps from all bodies, in cells.
pub const EYE_CLEARANCE: f64 = 0.25;

/// A level made of bodies. Each body is valid by construction, and bodies may overlap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The level's name; empty if the map has none.
    pub title: String,
    /// The bodies in the order of the map. If a ray hits two at once, the first is visible.
    pub bodies: Vec<Body>,
    /// The directional light.
    pub sun: Sun,
    /// The background.
    pub sky: SkyGradient,
    /// The fog, if there is any.
    pub fog: Option<Fog>,
    /// The player's start.
    pub start: SceneStart,
}

/// The position and direction in which the player starts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SceneStart {
    /// The position of the eye, within the limits of a camera.
    position: DVec3,
    /// The compass direction.
    pub heading: Heading,
    /// The angle above or below the horizon.
    pub elevation: Elevation,
}

impl SceneStart {
    /// A start at `position`, in cells. `None` if a coordinate is beyond [`MAX_COORDINATE`].
    pub fn new(position: DVec3, heading: Heading, elevation: Elevation) -> Option<Self> {
        is_near(position).then_some(Self { position, heading, elevation })
    }

    /// The position of the eye.
    pub fn position(&self) -> DVec3 {
        self.position
    }
}

/// A visible object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// The position and the shape.
    pub shape: BodyShape,
    /// The colours.
    pub texture: SolidTexture,
}

/// The position and the shape of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BodyShape {
    /// A sphere, which is hollow for a camera inside.
    Sphere(Sphere),
    /// An infinite plane, which is visible from both sides.
    Plane(Plane),
    /// A box along the axes, which is hollow for a camera inside.
    Block(Block),
}

/// The colours of a body, as a function of the position in space: solid texturing (Peachey, "Solid
/// Texturing of Complex Surfaces", 1985).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolidTexture {
    /// One colour.
    Plain(Rgb),
    /// A checker pattern of two colours: space is divided into cubes at whole multiples of the
    /// scale.
    Checker([Rgb; 2], Scale),
}

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    center: DVec3,
    radius: f64,
}

/// An infinite plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    point: DVec3,
    normal: DVec3,
}

/// A box whose edges are parallel to the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    low: DVec3,
    high: DVec3,
}

impl Sphere {
    /// The sphere with this `center` and `radius`. `None` if a coordinate of the center is beyond
    /// [`MAX_COORDINATE`], or if the radius is not between [`MIN_LENGTH`] and [`MAX_COORDINATE`].
    pub fn new(center: DVec3, radius: f64) -> Option<Self> {
        let fits = is_near(center) && (MIN_LENGTH..=MAX_COORDINATE).contains(&radius);
        fits.then_some(Self { center, radius })
    }

    /// The center, in cells.
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// The radius, in cells.
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl Plane {
    /// The plane through `point` and perpendicular to `normal`, which may have any length. `None`
    /// if a coordinate of the point is beyond [`MAX_COORDINATE`], or if the normal is zero or not finite.
    pub fn new(point: DVec3, normal: DVec3) -> Option<Self> {
        let largest = normal.abs().max_element();
        let has_direction = normal.is_finite() && largest > 0.0;
        // The normal is scaled first, because the squares of very large and very small doubles are
        // not representable.
        let fits = is_near(point) && has_direction;
        fits.then(|| Self { point, normal: (normal / largest).normalize() })
    }

    /// A point of the plane.
    pub fn point(&self) -> DVec3 {
        self.point
    }

    /// The unit normal.
    pub fn normal(&self) -> DVec3 {
        self.normal
    }
}

impl Block {
    /// The box with two opposite corners, in any order. `None` if a coordinate is beyond
    /// [`MAX_COORDINATE`], or if an edge is shorter than [`MIN_LENGTH`].
    pub fn new(corner: DVec3, opposite: DVec3) -> Option<Self> {
        let (low, high) = (corner.min(opposite), corner.max(opposite));
        let fits = is_near(corner) && is_near(opposite) && (high - low).min_element() >= MIN_LENGTH;
        fits.then_some(Self { low, high })
    }

    /// The corner in the north-west, at the bottom.
    pub fn low(&self) -> DVec3 {
        self.low
    }

    /// The corner in the south-east, at the top.
    pub fn high(&self) -> DVec3 {
        self.high
    }
}

impl BodyShape {
    /// The distance of `point` from the surface, in cells, and the unit vector from the nearest
    /// point of the surface to `point`. Inside a sphere or a box, the distance is negative and the
    /// vector still points outwards.
    ///
    /// Both sides of a plane are outside.
    pub fn signed_distance(&self, point: DVec3) -> (f64, DVec3) {
        match self {
            Self::Sphere(sphere) => {
                let from_center = point - sphere.center;
                let distance = from_center.length();
                (distance - sphere.radius, from_center.try_normalize().unwrap_or(DVec3::Z))
            }
            Self::Plane(plane) => {
                let distance = plane.normal.dot(point - plane.point);
                let side = if distance < 0.0 { -1.0 } else { 1.0 };
                (distance.abs(), plane.normal * side)
            }
            Self::Block(block) => block.signed_distance(point),
        }
    }

    /// Returns whether the boxes around both shapes overlap, in which case no tree separates them.
    /// Planes have no boxes, and overlap each other.
    pub(crate) fn overlaps(&self, other: &Self) -> bool {
        match (self.bounds(), other.bounds()) {
            (Some([low, high]), Some([other_low, other_high])) => {
                low.cmplt(other_high).all() && other_low.cmplt(high).all()
            }
            (None, None) => true,
            _ => false,
        }
    }

    /// The low and the high corner of the box around the shape; `None` for a plane.
    pub(crate) fn bounds(&self) -> Option<[DVec3; 2]> {
        match self {
            Self::Sphere(Sphere { center, radius }) => Some([center - radius, center + radius]),
            Self::Plane(_) => None,
            Self::Block(Block { low, high }) => Some([*low, *high]),
        }
    }
}

impl Block {
    fn signed_distance(&self, point: DVec3) -> (f64, DVec3) {
        let beside = point - point.clamp(self.low, self.high);
        if let Some(outwards) = beside.try_normalize() {
            return (beside.length(), outwards);
        }
        let outside = (self.low - point).max(point - self.high);
        let distance = outside.max_element();
        let axis = DVec3::AXES.into_iter().find(|&axis| axis.dot(outside) == distance);
        let axis = axis.unwrap_or(DVec3::Z);
        let middle = (self.low + self.high) / 2.0;
        (distance, if axis.dot(point - middle) < 0.0 { -axis } else { axis })
    }
}

/// A fraction from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fraction(f64);

impl Fraction {
    /// The fraction, if it is from 0 to 1.
    pub fn new(fraction: f64) -> Option<Self> {
        (0.0..=1.0).contains(&fraction).then_some(Self(fraction))
    }

    /// The fraction, from 0 to 1.
    pub fn get(self) -> f64 {
        self.0
    }
}

/// The directional light of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    toward: DVec3,
    /// The brightness of a surface that the sun does not reach.
    pub ambient: Fraction,
}

impl Sun {
    /// A sun in the direction `toward`, of any length. `None` if the direction is zero or not
    /// finite.
    pub fn new(toward: DVec3, ambient: Fraction) -> Option<Self> {
        let largest = toward.abs().max_element();
        let has_direction = toward.is_finite() && largest > 0.0;
        has_direction.then(|| Self { toward: (toward / largest).normalize(), ambient })
    }

    /// The unit vector towards the sun.
    pub fn toward(&self) -> DVec3 {
        self.toward
    }

    /// The brightness of a surface with this unit normal, from the ambient fraction to 1. By
    /// Lambert's cosine law ("Photometria", 1760), it is proportional to the cosine of the angle to
    /// the sun.
    pub fn brightness(&self, normal: DVec3) -> f64 {
        let Fraction(ambient) = self.ambient;
        ambient + (1.0 - ambient) * self.toward.dot(normal).clamp(0.0, 1.0)
    }
}

impl Default for Sun {
    /// A sun high in the north-west.
    fn default() -> Self {
        const TOWARD: DVec3 = DVec3::new(-2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0);
        Self { toward: TOWARD, ambient: Fraction(0.2) }
    }
}

/// The angle by which a camera looks up or down, between straight down and straight up.
///
/// Beyond these limits the picture would be upside down, and left and right would be swapped.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Elevation {
    radians: f64,
}

impl Elevation {
    /// Neither up nor down.
    pub const LEVEL: Self = Self { radians: 0.0 };

    /// An elevation in degrees, from −90 (straight down) to 90 (straight up). `None` outside that
    /// range.
    pub fn from_degrees(degrees: f64) -> Option<Self> {
        let is_within = (-90.0..=90.0).contains(&degrees);
        is_within.then(|| Self::LEVEL.raised(degrees.to_radians()))
    }

    /// The elevation in degrees; positive is up.
    pub fn degrees(self) -> f64 {
        self.radians.to_degrees()
    }

    /// The elevation in radians; positive is up.
    pub fn radians(self) -> f64 {
        self.radians
    }

    /// The elevation changed by `radians`, clamped to the limits; negative values lower it. A NaN
    /// changes nothing.
    #[must_use]
    pub fn raised(self, radians: f64) -> Self {
        if radians.is_nan() {
            return self;
        }
        Self { radians: (self.radians + radians).clamp(-FRAC_PI_2, FRAC_PI_2) }
    }
}

/// Returns whether a position is within the limits of bodies and cameras.
pub(crate) fn is_near(point: DVec3) -> bool {
    point.is_finite() && point.abs().max_element() <= MAX_COORDINATE
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_without_a_size_or_a_position_are_refused() {
        let far = DVec3::new(0.0, 1.1e9, 0.0);
        assert_eq!(Sphere::new(DVec3::ZERO, 0.0), None);
        assert_eq!(Sphere::new(DVec3::ZERO, f64::NAN), None);
        assert_eq!(Sphere::new(far, 1.0), None);
        assert_eq!(Plane::new(DVec3::ZERO, DVec3::ZERO), None);
        assert_eq!(Plane::new(DVec3::NAN, DVec3::X), None);
        assert_eq!(Block::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)), None);
        assert!(Sphere::new(DVec3::splat(MAX_COORDINATE), MAX_COORDINATE).is_some());
        assert!(Sphere::new(DVec3::ZERO, MIN_LENGTH).is_some());
    }

    #[test]
    fn a_normal_may_have_any_length() {
        for length in [1e-320, 1e-200, 1.0, 1e300] {
            let plane = Plane::new(DVec3::ZERO, DVec3::new(0.0, length, -length)).unwrap();
            assert!((plane.normal().length() - 1.0).abs() < 1e-12, "{length}");
        }
    }

    #[test]
    fn signed_distance_is_negative_inside() {
        let sphere = BodyShape::Sphere(Sphere::new(DVec3::ZERO, 2.0).unwrap());
        assert_eq!(sphere.signed_distance(DVec3::new(3.0, 0.0, 0.0)), (1.0, DVec3::X));
        assert_eq!(sphere.signed_distance(DVec3::new(0.0, -1.0, 0.0)), (-1.0, -DVec3::Y));
        let block = BodyShape::Block(Block::new(DVec3::ZERO, DVec3::splat(4.0)).unwrap());
        assert_eq!(block.signed_distance(DVec3::new(2.0, 2.0, 5.0)), (1.0, DVec3::Z));
        assert_eq!(block.signed_distance(DVec3::new(2.0, 0.5, 2.0)), (-0.5, -DVec3::Y));
        let plane = BodyShape::Plane(Plane::new(DVec3::ZERO, DVec3::Z).unwrap());
        assert_eq!(plane.signed_distance(DVec3::new(9.0, 9.0, -2.0)), (2.0, -DVec3::Z));
    }

    #[test]
    fn shapes_that_touch_do_not_overlap() {
        let block = |low: f64, high: f64| {
            BodyShape::Block(Block::new(DVec3::splat(low), DVec3::splat(high)).unwrap())
        };
        let plane = |normal| BodyShape::Plane(Plane::new(DVec3::ZERO, normal).unwrap());
        let sphere = BodyShape::Sphere(Sphere::new(DVec3::splat(3.0), 1.0).unwrap());
        assert!(block(0.0, 2.0).overlaps(&block(1.0, 3.0)));
        assert!(block(0.0, 9.0).overlaps(&block(1.0, 3.0)));
        assert!(!block(0.0, 1.0).overlaps(&block(1.0, 3.0)));
        assert!(sphere.overlaps(&sphere) && sphere.overlaps(&block(0.0, 2.5)));
        assert!(!sphere.overlaps(&block(0.0, 2.0)) && !block(0.0, 2.0).overlaps(&sphere));
        assert!(plane(DVec3::X).overlaps(&plane(DVec3::Z)));
        assert!(!plane(DVec3::X).overlaps(&sphere));
    }

    #[test]
    fn surfaces_facing_the_sun_are_bright_and_others_ambient() {
        let sun = Sun::new(DVec3::new(0.0, 0.0, 1e-200), Fraction(0.25)).unwrap();
        assert_eq!(sun.brightness(DVec3::Z), 1.0);
        assert_eq!(sun.brightness(DVec3::X), 0.25);
        assert_eq!(sun.brightness(-DVec3::Z), 0.25);
        assert_eq!(Sun::new(DVec3::ZERO, Fraction(0.0)), None);
    }

    #[test]
    fn elevation_ends_at_straight_up() {
        let up = Elevation::from_degrees(90.0).unwrap();
        assert_eq!(Elevation::LEVEL.raised(f64::INFINITY), up);
        assert_eq!(up.raised(f64::NAN), up);
        assert_eq!(Elevation::from_degrees(90.5), None);
        assert_eq!(Elevation::from_degrees(f64::NAN), None);
    }
}

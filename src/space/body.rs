//! Bodies, of which a scene consists. All of them are convex.

use glam::DVec3;

use super::checker;
use crate::color::Rgb;
use crate::world::Scale;

/// The largest absolute value of a coordinate along each axis, and the largest radius, in cells.
pub const FARTHEST: f64 = 1e9;
/// The smallest radius, and the shortest edge of a block, in cells.
pub const SMALLEST: f64 = 1e-9;

/// A visible object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// The position and the shape.
    pub shape: Shape,
    /// The colours.
    pub texture: SolidTexture,
}

/// The position and the shape of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
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
    /// [`FARTHEST`], or if the radius is not between [`SMALLEST`] and [`FARTHEST`].
    pub fn new(center: DVec3, radius: f64) -> Option<Self> {
        let fits = is_near(center) && (SMALLEST..=FARTHEST).contains(&radius);
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
    /// if a coordinate of the point is beyond [`FARTHEST`], or if the normal is zero or not finite.
    pub fn new(point: DVec3, normal: DVec3) -> Option<Self> {
        let largest = normal.abs().max_element();
        let has_direction = normal.is_finite() && largest > 0.0;
        // Scaled first, because the squares of very large and very small doubles are not
        // representable.
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
    /// [`FARTHEST`], or if an edge is shorter than [`SMALLEST`].
    pub fn new(corner: DVec3, opposite: DVec3) -> Option<Self> {
        let (low, high) = (corner.min(opposite), corner.max(opposite));
        let fits = is_near(corner) && is_near(opposite) && (high - low).min_element() >= SMALLEST;
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

impl Shape {
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

    /// Whether the boxes around both shapes overlap: no tree then separates them. Planes, which have no
    /// boxes, overlap each other.
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

impl SolidTexture {
    /// The colour at `point`.
    pub fn color_at(&self, point: DVec3) -> Rgb {
        match *self {
            Self::Plain(color) => color,
            Self::Checker([first, second], scale) => {
                if checker::is_first(point / scale.cells()) {
                    first
                } else {
                    second
                }
            }
        }
    }
}

fn is_near(point: DVec3) -> bool {
    point.is_finite() && point.abs().max_element() <= FARTHEST
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
        assert!(Sphere::new(DVec3::splat(FARTHEST), FARTHEST).is_some());
        assert!(Sphere::new(DVec3::ZERO, SMALLEST).is_some());
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
        let sphere = Shape::Sphere(Sphere::new(DVec3::ZERO, 2.0).unwrap());
        assert_eq!(sphere.signed_distance(DVec3::new(3.0, 0.0, 0.0)), (1.0, DVec3::X));
        assert_eq!(sphere.signed_distance(DVec3::new(0.0, -1.0, 0.0)), (-1.0, -DVec3::Y));
        let block = Shape::Block(Block::new(DVec3::ZERO, DVec3::splat(4.0)).unwrap());
        assert_eq!(block.signed_distance(DVec3::new(2.0, 2.0, 5.0)), (1.0, DVec3::Z));
        assert_eq!(block.signed_distance(DVec3::new(2.0, 0.5, 2.0)), (-0.5, -DVec3::Y));
        let plane = Shape::Plane(Plane::new(DVec3::ZERO, DVec3::Z).unwrap());
        assert_eq!(plane.signed_distance(DVec3::new(9.0, 9.0, -2.0)), (2.0, -DVec3::Z));
    }

    #[test]
    fn shapes_that_touch_do_not_overlap() {
        let block = |low: f64, high: f64| {
            Shape::Block(Block::new(DVec3::splat(low), DVec3::splat(high)).unwrap())
        };
        let plane = |normal| Shape::Plane(Plane::new(DVec3::ZERO, normal).unwrap());
        let sphere = Shape::Sphere(Sphere::new(DVec3::splat(3.0), 1.0).unwrap());
        assert!(block(0.0, 2.0).overlaps(&block(1.0, 3.0)));
        assert!(block(0.0, 9.0).overlaps(&block(1.0, 3.0)));
        assert!(!block(0.0, 1.0).overlaps(&block(1.0, 3.0)));
        assert!(sphere.overlaps(&sphere) && sphere.overlaps(&block(0.0, 2.5)));
        assert!(!sphere.overlaps(&block(0.0, 2.0)) && !block(0.0, 2.0).overlaps(&sphere));
        assert!(plane(DVec3::X).overlaps(&plane(DVec3::Z)));
        assert!(!plane(DVec3::X).overlaps(&sphere));
    }
}

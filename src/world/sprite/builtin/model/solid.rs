//! Solids, and where the line of sight through a point of a picture meets them.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::View;
use crate::color::Rgb;

/// A coloured solid.
#[derive(Clone, Copy)]
pub(crate) struct Solid {
    pub(crate) shape: Shape,
    pub(crate) paint: Paint,
}

/// The shape of a solid.
#[derive(Clone, Copy)]
pub(crate) enum Shape {
    /// The hull of two balls.
    Limb { ends: [DVec3; 2], radii: [f64; 2] },
    /// The image of the unit ball.
    Ellipsoid(DAffine3),
    /// The image of the cube around the unit ball.
    Block(DAffine3),
}

/// The colour of a solid.
#[derive(Clone, Copy)]
pub(crate) struct Paint {
    pub(crate) color: Rgb,
    /// Whether it is as bright in the shade as in the light.
    pub(crate) glows: bool,
}

/// Paint that is lit.
pub(crate) const fn matt(red: u8, green: u8, blue: u8) -> Paint {
    Paint { color: Rgb::new(red, green, blue), glows: false }
}

/// Paint that shines: flames and eyes.
pub(crate) const fn glowing(red: u8, green: u8, blue: u8) -> Paint {
    Paint { color: Rgb::new(red, green, blue), glows: true }
}

/// A solid in the coordinates of a picture.
pub(crate) struct Seen {
    shape: SeenShape,
    /// The corners of the rectangle that it covers.
    pub(crate) low: DVec2,
    pub(crate) high: DVec2,
    /// The greatest coordinate towards the viewer.
    pub(crate) nearest: f64,
}

enum SeenShape {
    Limb { from: DVec3, along: DVec3, length_squared: f64, radii: [f64; 2] },
    Ellipsoid(Inside),
    Block(Inside),
}

/// The coordinates in which a solid is the unit ball, or the cube around it.
struct Inside {
    center: DVec3,
    matrix: DMat3,
}

/// The point of a solid that is nearest to the viewer.
pub(crate) struct Hit {
    /// Its coordinate towards the viewer.
    pub(crate) depth: f64,
    /// The unit vector that points away from the solid.
    pub(crate) normal: DVec3,
}

impl Solid {
    /// The solid as seen in a view.
    pub(crate) fn seen(&self, view: View) -> Seen {
        match self.shape {
            Shape::Limb { ends, radii } => seen_limb(ends.map(|end| view.matrix * end), radii),
            Shape::Ellipsoid(axes) => {
                let (inside, matrix) = inside(axes, view);
                let half = [0, 1, 2].map(|row| matrix.row(row).length());
                seen_around(inside.center, half, SeenShape::Ellipsoid(inside))
            }
            Shape::Block(axes) => {
                let (inside, matrix) = inside(axes, view);
                let half = [0, 1, 2].map(|row| matrix.row(row).abs().element_sum());
                seen_around(inside.center, half, SeenShape::Block(inside))
            }
        }
    }
}

fn seen_limb(ends: [DVec3; 2], radii: [f64; 2]) -> Seen {
    let [from, to] = ends;
    let along = to - from;
    let length_squared = along.truncate().length_squared();
    let shape = SeenShape::Limb { from, along, length_squared, radii };
    let low = (from - radii[0]).min(to - radii[1]);
    let high = (from + radii[0]).max(to + radii[1]);
    Seen { shape, low: low.truncate(), high: high.truncate(), nearest: high.z }
}

fn seen_around(center: DVec3, half: [f64; 3], shape: SeenShape) -> Seen {
    let half = DVec3::from(half);
    let (low, high) = (center - half, center + half);
    Seen { shape, low: low.truncate(), high: high.truncate(), nearest: high.z }
}

/// The inverse of a map from the unit ball, and its matrix, in the coordinates of a picture.
fn inside(axes: DAffine3, view: View) -> (Inside, DMat3) {
    let matrix = view.matrix * axes.matrix3;
    let center = view.matrix * axes.translation;
    (Inside { center, matrix: matrix.inverse() }, matrix)
}

impl Seen {
    /// Where the line of sight through `point` meets it first.
    pub(crate) fn hit(&self, point: DVec2) -> Option<Hit> {
        match &self.shape {
            &SeenShape::Limb { from, along, length_squared, radii } => {
                limb_hit(point, from, along, length_squared, radii)
            }
            SeenShape::Ellipsoid(inside) => inside.ball_hit(point),
            SeenShape::Block(inside) => inside.cube_hit(point),
        }
    }
}

/// Where the line of sight meets a limb. Between the ends that is the ball around the point of the
/// axis that is nearest in the picture: exact where the axis is parallel to the picture, and off by
/// less than the radius elsewhere. The balls at the ends are exact.
fn limb_hit(
    point: DVec2,
    from: DVec3,
    along: DVec3,
    length_squared: f64,
    radii: [f64; 2],
) -> Option<Hit> {
    let ball = |share: f64| {
        let center = from + along * share;
        let radius = radii[0] + (radii[1] - radii[0]) * share;
        let off = point - center.truncate();
        let height = radius * radius - off.length_squared();
        (height > 0.0).then(|| {
            let height = height.sqrt();
            Hit { depth: center.z + height, normal: off.extend(height) / radius }
        })
    };
    let share = (point - from.truncate()).dot(along.truncate()) / length_squared.max(1e-9);
    let on_axis = ball(share.clamp(0.0, 1.0));
    let slant = along.z * along.z;
    if slant <= length_squared {
        return on_axis;
    }
    // The axis points at the viewer more than across.
    let nearer = ball(if along.z > 0.0 { 1.0 } else { 0.0 });
    [on_axis, nearer].into_iter().flatten().max_by(|one, other| one.depth.total_cmp(&other.depth))
}

impl Inside {
    /// The point of the picture plane and the direction to the viewer, inside.
    fn ray(&self, point: DVec2) -> (DVec3, DVec3) {
        let origin = (point - self.center.truncate()).extend(0.0);
        (self.matrix * origin, self.matrix.z_axis)
    }

    fn ball_hit(&self, point: DVec2) -> Option<Hit> {
        let (origin, towards) = self.ray(point);
        let (squared, half) = (towards.length_squared(), origin.dot(towards));
        let root = half * half - squared * (origin.length_squared() - 1.0);
        (root > 0.0).then(|| {
            let depth = (root.sqrt() - half) / squared;
            let normal = self.matrix.transpose() * (origin + towards * depth);
            Hit { depth: depth + self.center.z, normal: normal.normalize() }
        })
    }

    fn cube_hit(&self, point: DVec2) -> Option<Hit> {
        let (origin, towards) = self.ray(point);
        let (mut back, mut front) = (f64::NEG_INFINITY, f64::INFINITY);
        let mut side = (0, 1.0);
        for axis in 0..3 {
            let (from, step) = (origin[axis], towards[axis]);
            if step.abs() < 1e-9 {
                if from.abs() > 1.0 {
                    return None;
                }
                continue;
            }
            let sign = step.signum();
            back = back.max((-sign - from) / step);
            if (sign - from) / step < front {
                front = (sign - from) / step;
                side = (axis, sign);
            }
        }
        (back < front).then(|| Hit {
            depth: front + self.center.z,
            normal: (self.matrix.row(side.0) * side.1).normalize(),
        })
    }
}

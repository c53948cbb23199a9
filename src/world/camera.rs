//! The camera: position, height of the eye, heading, pitch and field of view.
//!
//! Looking up or down shears the picture: it moves by whole rows of pixels. Rejected: a rotation.
//! Walls would lean, a column of pixels would no longer be one ray, and every stage would pay for
//! it. The shear is the picture of a camera that looks straight ahead with its image plane shifted,
//! as in architectural photography. It looks distorted at large angles, so it is limited to
//! [`Pitch::MAX_DEGREES`].

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
use std::fmt;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::Cell;

/// A direction on the map: 0° is east, 90° south, clockwise.
///
/// It is stored as a number of quarter turns and an angle of at most an eighth of a turn. Therefore
/// the four axes are exact (to the south, `x` is 0 and not 6e-17). Turning never accumulates an
/// error in length, because sine and cosine are computed from that angle. Rejected: a unit vector
/// that is rotated in each step. Its length drifts.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "(u8, f64)")]
pub struct Heading {
    quarter_turns: u8,
    /// In radians, within ±π/4 except for rounding.
    beside: f64,
}

impl Heading {
    /// A heading from any number of degrees. `None` if the number is not finite.
    pub fn from_degrees(degrees: f64) -> Option<Self> {
        if !degrees.is_finite() {
            return None;
        }
        // The remainder of a floating-point division is exact.
        let degrees = degrees % 360.0;
        let quarters = (degrees / 90.0).round();
        let beside = (degrees - 90.0 * quarters).to_radians();
        Some(Self { quarter_turns: quarters.rem_euclid(4.0) as u8, beside })
    }

    /// Degrees, at least 0 and below 360.
    pub fn degrees(self) -> f64 {
        let degrees = 90.0 * f64::from(self.quarter_turns) + self.beside.to_degrees();
        if degrees < 0.0 { degrees + 360.0 } else { degrees }
    }

    /// The heading turned clockwise by `radians`; unchanged if `radians` is not finite.
    #[must_use]
    pub fn turned(self, radians: f64) -> Self {
        if !radians.is_finite() {
            return self;
        }
        let beside = self.beside + radians % (4.0 * FRAC_PI_2);
        // On a diagonal, two quarters are equally near, and the heading could switch between them
        // forever.
        let quarters = if beside.abs() <= FRAC_PI_4 { 0.0 } else { (beside / FRAC_PI_2).round() };
        Self {
            quarter_turns: (f64::from(self.quarter_turns) + quarters).rem_euclid(4.0) as u8,
            beside: beside - quarters * FRAC_PI_2,
        }
    }

    /// The unit vector in this direction.
    pub fn direction(self) -> DVec2 {
        let (sin, cos) = (libm::sin(self.beside), libm::cos(self.beside));
        match self.quarter_turns {
            0 => DVec2::new(cos, sin),
            1 => DVec2::new(-sin, cos),
            2 => DVec2::new(-cos, -sin),
            _ => DVec2::new(sin, -cos),
        }
    }
}

/// A heading from the quarter turns and the radians beside them.
impl TryFrom<(u8, f64)> for Heading {
    type Error = &'static str;

    fn try_from((quarter_turns, beside): (u8, f64)) -> Result<Self, &'static str> {
        let is_one = quarter_turns < 4 && beside.abs() < FRAC_PI_2;
        is_one.then_some(Self { quarter_turns, beside }).ok_or("a heading")
    }
}

/// The field of view: the angle between the left and the right edge of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOfView {
    degrees: f64,
}

impl FieldOfView {
    /// A field of view above 0 and below 180 degrees. `None` outside that range.
    pub fn from_degrees(degrees: f64) -> Option<Self> {
        (degrees > 0.0 && degrees < 180.0).then_some(Self { degrees })
    }

    /// Degrees, above 0 and below 180.
    pub fn degrees(self) -> f64 {
        self.degrees
    }

    /// The tangent of half the angle, which is half the width of the picture at distance 1: from
    /// 10⁻¹⁰⁰ to 10¹⁷.
    pub fn half_width(self) -> f64 {
        /// All rays of such a picture have the same direction. Through a longer lens, products of
        /// lengths would not be finite.
        const MIN: f64 = 1e-100;
        libm::tan(self.degrees.to_radians() / 2.0).max(MIN)
    }
}

impl Default for FieldOfView {
    /// 66°, with a half width close to 0.65.
    fn default() -> Self {
        Self { degrees: 66.0 }
    }
}

impl fmt::Display for FieldOfView {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}°", self.degrees)
    }
}

/// The position, height, direction and field of view of an observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    position: DVec2,
    eye: f64,
    /// The heading.
    pub heading: Heading,
    /// The pitch.
    pub pitch: Pitch,
    /// The field of view.
    pub field_of_view: FieldOfView,
}

impl Camera {
    /// The height of the eye of a standing player, in cells above the floor.
    pub const STANDING: f64 = 0.5;

    /// A camera at `position`, in cells, with its eye at [`Camera::STANDING`] and no pitch. `None`
    /// if the position is not finite.
    pub fn new(position: DVec2, heading: Heading, field_of_view: FieldOfView) -> Option<Self> {
        let camera = Self::at(position, heading, field_of_view);
        position.is_finite().then_some(camera)
    }

    /// A camera in the middle of `cell`, otherwise as [`Camera::new`].
    pub fn in_cell(cell: Cell, heading: Heading, field_of_view: FieldOfView) -> Self {
        Self::at(cell.center(), heading, field_of_view)
    }

    fn at(position: DVec2, heading: Heading, field_of_view: FieldOfView) -> Self {
        Self { position, eye: Self::STANDING, heading, pitch: Pitch::LEVEL, field_of_view }
    }

    /// The camera with its eye at another height, in cells above 0. `None` if the height is not
    /// finite.
    pub fn with_eye(self, eye: f64) -> Option<Self> {
        eye.is_finite().then_some(Self { eye, ..self })
    }

    /// The camera with another pitch.
    #[must_use]
    pub fn with_pitch(self, pitch: Pitch) -> Self {
        Self { pitch, ..self }
    }

    /// The position, in cells.
    pub fn position(&self) -> DVec2 {
        self.position
    }

    /// The height of the eye, in cells above the map's own floor.
    pub fn eye(&self) -> f64 {
        self.eye
    }

    /// The unit vector straight ahead.
    pub fn direction(&self) -> DVec2 {
        self.heading.direction()
    }

    /// The vector from the point straight ahead, at distance 1, to the right edge of the picture.
    pub fn plane(&self) -> DVec2 {
        self.direction().perp() * self.field_of_view.half_width()
    }
}

/// The angle by which the camera looks up or down, within ±30°.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "f64")]
pub struct Pitch {
    slope: f64,
}

/// The tangent of [`Pitch::MAX_DEGREES`].
const STEEPEST: f64 = 0.577_350_269_189_625_7;

impl Pitch {
    /// Straight ahead.
    pub const LEVEL: Self = Self { slope: 0.0 };
    /// The limit, in degrees. Beyond it the horizon is far out of view, and walls look stretched.
    pub const MAX_DEGREES: f64 = 30.0;

    /// A pitch in degrees, positive for up. `None` beyond ±[`Pitch::MAX_DEGREES`].
    pub fn from_degrees(degrees: f64) -> Option<Self> {
        let is_within = degrees.abs() <= Self::MAX_DEGREES;
        is_within.then(|| Self::LEVEL.tilted(libm::tan(degrees.to_radians())))
    }

    /// Degrees, positive for up.
    pub fn degrees(self) -> f64 {
        libm::atan(self.slope).to_degrees()
    }

    /// The slope of the ray through the middle of the picture: cells up for each cell ahead.
    pub fn slope(self) -> f64 {
        self.slope
    }

    /// The pitch with `slope` added, within the limit; unchanged if `slope` is NaN.
    #[must_use]
    pub fn tilted(self, slope: f64) -> Self {
        if slope.is_nan() {
            return self;
        }
        // Adding zero removes the sign of a negative zero.
        Self { slope: (self.slope + slope).clamp(-STEEPEST, STEEPEST) + 0.0 }
    }
}

/// A pitch from its slope.
impl TryFrom<f64> for Pitch {
    type Error = &'static str;

    fn try_from(slope: f64) -> Result<Self, &'static str> {
        let pitch = Self::LEVEL.tilted(slope);
        if pitch.slope.to_bits() == slope.to_bits() { Ok(pitch) } else { Err("a pitch") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heading(degrees: f64) -> Heading {
        Heading::from_degrees(degrees).unwrap()
    }

    #[test]
    fn headings_along_the_axes_are_exact() {
        for turns in [-1e6, -1.0, 0.0, 7.0] {
            let axes = [(0.0, DVec2::X), (90.0, DVec2::Y), (180.0, -DVec2::X), (270.0, -DVec2::Y)];
            for (degrees, axis) in axes {
                assert_eq!(heading(degrees + 360.0 * turns).direction(), axis);
            }
        }
    }

    #[test]
    fn a_turn_by_zero_keeps_the_heading() {
        for degrees in (0..720).map(|half| f64::from(half) / 2.0) {
            assert_eq!(heading(degrees).turned(0.0), heading(degrees), "{degrees}");
        }
    }

    #[test]
    fn heading_degrees_survive_a_round_trip() {
        for degrees in [0.0, 1.0, 44.0, 45.0, 46.0, 135.0, 225.5, 359.0] {
            assert!((heading(degrees).degrees() - degrees).abs() < 1e-12, "{degrees}");
        }
        assert_eq!(Heading::from_degrees(f64::NAN), None);
        assert_eq!(Heading::from_degrees(f64::INFINITY), None);
    }

    #[test]
    fn ten_million_turns_of_the_wheel_leave_a_unit_vector() {
        let mut wheel = heading(12.0);
        for _ in 0..10_000_000 {
            wheel = wheel.turned(0.1);
        }
        assert!((wheel.direction().length() - 1.0).abs() < 4.0 * f64::EPSILON);
        let camera = Camera::new(DVec2::ZERO, wheel, FieldOfView::default()).unwrap();
        assert!(camera.direction().dot(camera.plane()).abs() < 4.0 * f64::EPSILON);
    }

    #[test]
    fn a_turn_by_nan_keeps_the_heading() {
        assert_eq!(heading(3.0).turned(f64::NAN), heading(3.0));
        assert_eq!(heading(3.0).turned(f64::INFINITY), heading(3.0));
    }

    #[test]
    fn the_plane_points_to_the_right() {
        let camera = Camera::new(DVec2::ZERO, heading(0.0), FieldOfView::default()).unwrap();
        assert!(camera.plane().x == 0.0 && camera.plane().y > 0.0);
    }

    #[test]
    fn any_field_of_view_has_a_width() {
        for degrees in [1e-320, 0.001, 66.0, 179.9, 180.0_f64.next_down()] {
            let width = FieldOfView::from_degrees(degrees).unwrap().half_width();
            assert!((1e-100..1e17).contains(&width), "{degrees}");
        }
        for degrees in [0.0, -1.0, 180.0, f64::NAN, f64::INFINITY] {
            assert_eq!(FieldOfView::from_degrees(degrees), None);
        }
    }

    #[test]
    fn pitch_degrees_survive_a_round_trip() {
        for degrees in [-30.0, -12.5, 0.0, 1.0, 29.999, 30.0] {
            let pitch = Pitch::from_degrees(degrees).unwrap();
            assert!((pitch.degrees() - degrees).abs() < 1e-12, "{degrees}");
        }
        for degrees in [30.001, -31.0, f64::NAN, f64::INFINITY] {
            assert_eq!(Pitch::from_degrees(degrees), None);
        }
    }

    #[test]
    fn pitch_stops_at_its_limit() {
        let highest = Pitch::from_degrees(30.0).unwrap();
        assert_eq!(Pitch::LEVEL.tilted(f64::INFINITY), highest.tilted(1e9));
        assert_eq!(highest.tilted(1.0).tilted(-2.0 * STEEPEST).degrees(), -highest.degrees());
        assert_eq!(highest.tilted(f64::NAN), highest);
    }
}

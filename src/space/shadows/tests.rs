use proptest::prelude::*;

use super::*;
use crate::color::Rgb;
use crate::space::lanes::LANES;
use crate::space::{Block, Fraction, SolidTexture, Sphere};

/// Points on a coarse grid, so that bodies share surfaces.
fn point(reach: i32) -> impl Strategy<Value = DVec3> {
    [-reach..=reach, -reach..=reach, -reach..=reach]
        .prop_map(|place| DVec3::from_array(place.map(|it| f64::from(it) / 2.0)))
}

fn body() -> impl Strategy<Value = Body> {
    let texture = SolidTexture::Plain(Rgb::BLACK);
    let shape = prop_oneof![
        (point(12), 1..6).prop_filter_map("a sphere", |(center, radius)| {
            Sphere::new(center, f64::from(radius) / 2.0).map(BodyShape::Sphere)
        }),
        (point(12), point(12)).prop_filter_map("a box", |(corner, opposite)| {
            Block::new(corner, opposite).map(BodyShape::Block)
        }),
    ];
    shape.prop_map(move |shape| Body { shape, texture })
}

proptest! {
    #[test]
    fn the_tree_and_the_boxes_miss_no_shadow(
        bodies in prop::collection::vec(body(), 0..30),
        toward in point(3),
        points in prop::collection::vec(point(14), 1..LANES),
    ) {
        let ambient = Fraction::new(0.2).unwrap();
        let Some(sun) = Sun::new(toward, ambient) else { return Ok(()) };
        let mut shadows = Shadows::default();
        shadows.begin(&bodies, &sun);
        let mut lanes = Vectors::default();
        lanes.fill(|lane| points[lane % points.len()]);
        let points = lanes;
        let mut expected = [1.0; LANES];
        for body in bodies.iter().skip(1) {
            darken_behind(&body.shape, &points, sun.toward(), 0.2, &mut expected);
        }
        let mut brightness = [1.0; LANES];
        shadows.darken(&points, points.bounds(), 0, 0.2, &mut brightness);
        prop_assert_eq!(brightness, expected);
    }
}

//! The 3-D caster: rays at spheres, planes and boxes, compared with a reference in fixed point.

use std::hint::black_box;

use glam::DVec3;

use super::super::fixed_point::FixedPoint;
use super::Feature;
use cellcaster::color::Rgb;
use cellcaster::rng::SplitMix64;
use cellcaster::space::{Block, Body, BodyShape, Plane, Ray, Scene, SolidTexture, Sphere};

const RAYS: usize = 2000;
const BODIES: usize = 6;

pub(crate) fn features(seed: u64) -> Vec<Feature> {
    let mut random = SplitMix64::new(seed);
    let mut point = |reach: f64| {
        let mut coordinate = || random.between(-reach, reach);
        DVec3::new(coordinate(), coordinate(), coordinate())
    };
    let spheres = (0..BODIES).filter_map(|index| {
        Some(BodyShape::Sphere(Sphere::new(point(5.0), 0.25 * (index + 1) as f64)?))
    });
    let spheres = scene(spheres);
    let planes = scene(
        (0..BODIES).filter_map(|_| Some(BodyShape::Plane(Plane::new(point(5.0), point(1.0))?))),
    );
    let boxes = (0..BODIES).filter_map(|_| {
        let corner = point(5.0);
        Some(BodyShape::Block(Block::new(corner, corner + point(3.0))?))
    });
    let boxes = scene(boxes);
    let rays: Vec<Ray> = (0..RAYS).map(|_| Ray::new(point(8.0), point(1.0))).collect();
    vec![
        feature("3-D caster: spheres", spheres, rays.clone()),
        feature("3-D caster: planes", planes, rays.clone()),
        feature("3-D caster: boxes", boxes, rays),
    ]
}

fn scene(shapes: impl Iterator<Item = BodyShape>) -> Scene {
    let texture = SolidTexture::Plain(Rgb::WHITE);
    Scene { bodies: shapes.map(|shape| Body { shape, texture }).collect(), ..Scene::default() }
}

fn feature(name: &'static str, scene: Scene, rays: Vec<Ray>) -> Feature {
    let outcome = |ray: &Ray| {
        let meetings = scene.bodies.iter().enumerate();
        let meetings = meetings.filter_map(|(index, body)| Some((meet(&body.shape, ray)?, index)));
        match (meetings.min(), scene.cast(ray)) {
            (None, None) => (false, None),
            (Some((t, body)), Some(hit)) if body == hit.body => {
                (false, Some(t.relative_error(hit.t)))
            }
            _ => (true, None),
        }
    };
    let outcomes = rays.iter().map(outcome).collect();
    let work = move || {
        for ray in &rays {
            black_box(scene.cast(black_box(ray)));
        }
    };
    let (figure, unit) = ("distance of a ray", "relative");
    Feature { name, figure, unit, outcomes, work: Box::new(work) }
}

fn fixed(vector: DVec3) -> [FixedPoint; 3] {
    vector.to_array().map(FixedPoint::new)
}

fn dot(one: &[FixedPoint; 3], other: &[FixedPoint; 3]) -> FixedPoint {
    one.iter().zip(other).fold(FixedPoint::new(0.0), |sum, (one, other)| &sum + &(one * other))
}

fn minus(one: &[FixedPoint; 3], other: &[FixedPoint; 3]) -> [FixedPoint; 3] {
    std::array::from_fn(|axis| &one[axis] - &other[axis])
}

/// The distance at which `ray` meets `shape` first.
fn meet(shape: &BodyShape, ray: &Ray) -> Option<FixedPoint> {
    let (origin, direction) = (fixed(ray.origin), fixed(ray.direction));
    match shape {
        BodyShape::Sphere(sphere) => {
            let from_center = minus(&origin, &fixed(sphere.center()));
            let radius = FixedPoint::new(sphere.radius());
            let (a, b) = (dot(&direction, &direction), dot(&from_center, &direction));
            let c = &dot(&from_center, &from_center) - &(&radius * &radius);
            let discriminant = &(&b * &b) - &(&a * &c);
            if discriminant.is_negative() {
                return None;
            }
            let root = discriminant.square_root();
            let ends = [&(&-&b - &root) / &a, &(&-&b + &root) / &a];
            ends.into_iter().find(|t| !t.is_negative())
        }
        BodyShape::Plane(plane) => {
            let normal = fixed(plane.normal());
            let speed = dot(&normal, &direction);
            let way = dot(&normal, &minus(&fixed(plane.point()), &origin));
            let t = (!speed.is_zero()).then(|| &way / &speed)?;
            (!t.is_negative()).then_some(t)
        }
        BodyShape::Block(block) => meet_block(block, &origin, &direction),
    }
}

/// The distance to a box, found by the slabs between opposite faces. No direction in the report is
/// parallel to a face.
fn meet_block(
    block: &Block,
    origin: &[FixedPoint; 3],
    direction: &[FixedPoint; 3],
) -> Option<FixedPoint> {
    let (low, high) = (fixed(block.low()), fixed(block.high()));
    let slabs: Option<Vec<(FixedPoint, FixedPoint)>> = (0..3)
        .map(|axis| {
            let speed = &direction[axis];
            let to =
                |face: &FixedPoint| (!speed.is_zero()).then(|| &(face - &origin[axis]) / speed);
            let (one, other) = (to(&low[axis])?, to(&high[axis])?);
            Some(if one < other { (one, other) } else { (other, one) })
        })
        .collect();
    let slabs = slabs?;
    let first = slabs.iter().map(|slab| &slab.0).max()?;
    let last = slabs.iter().map(|slab| &slab.1).min()?;
    if last < first || last.is_negative() {
        return None;
    }
    Some(if first.is_negative() { last.clone() } else { first.clone() })
}

//! The 3-D caster: rays at spheres, planes and boxes, compared with a reference in fixed point.

use std::hint::black_box;

use glam::DVec3;

use super::super::fixed_point::Fixed;
use super::Feature;
use cellcaster::color::Rgb;
use cellcaster::rng::SplitMix64;
use cellcaster::space::{Block, Body, Plane, Ray, Scene, Shape, SolidTexture, Sphere};

const RAYS: usize = 2000;
const BODIES: usize = 6;

pub(crate) fn features(seed: u64) -> Vec<Feature> {
    let mut random = SplitMix64::new(seed);
    let mut point = |reach: f64| {
        let mut coordinate = || random.between(-reach, reach);
        DVec3::new(coordinate(), coordinate(), coordinate())
    };
    let spheres = (0..BODIES).filter_map(|index| {
        Some(Shape::Sphere(Sphere::new(point(5.0), 0.25 * (index + 1) as f64)?))
    });
    let spheres = scene(spheres);
    let planes =
        scene((0..BODIES).filter_map(|_| Some(Shape::Plane(Plane::new(point(5.0), point(1.0))?))));
    let boxes = (0..BODIES).filter_map(|_| {
        let corner = point(5.0);
        Some(Shape::Block(Block::new(corner, corner + point(3.0))?))
    });
    let boxes = scene(boxes);
    let rays: Vec<Ray> = (0..RAYS).map(|_| Ray::new(point(8.0), point(1.0))).collect();
    vec![
        feature("3-D caster: spheres", spheres, rays.clone()),
        feature("3-D caster: planes", planes, rays.clone()),
        feature("3-D caster: boxes", boxes, rays),
    ]
}

fn scene(shapes: impl Iterator<Item = Shape>) -> Scene {
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

fn fixed(vector: DVec3) -> [Fixed; 3] {
    vector.to_array().map(Fixed::new)
}

fn dot(one: &[Fixed; 3], other: &[Fixed; 3]) -> Fixed {
    one.iter().zip(other).fold(Fixed::new(0.0), |sum, (one, other)| &sum + &(one * other))
}

fn minus(one: &[Fixed; 3], other: &[Fixed; 3]) -> [Fixed; 3] {
    std::array::from_fn(|axis| &one[axis] - &other[axis])
}

/// The distance at which `ray` meets `shape` first.
fn meet(shape: &Shape, ray: &Ray) -> Option<Fixed> {
    let (origin, direction) = (fixed(ray.origin), fixed(ray.direction));
    match shape {
        Shape::Sphere(sphere) => {
            let from_center = minus(&origin, &fixed(sphere.center()));
            let radius = Fixed::new(sphere.radius());
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
        Shape::Plane(plane) => {
            let normal = fixed(plane.normal());
            let speed = dot(&normal, &direction);
            let way = dot(&normal, &minus(&fixed(plane.point()), &origin));
            let t = (!speed.is_zero()).then(|| &way / &speed)?;
            (!t.is_negative()).then_some(t)
        }
        Shape::Block(block) => meet_block(block, &origin, &direction),
    }
}

/// The distance to a box, found by the slabs between opposite faces. No direction in the report is
/// parallel to a face.
fn meet_block(block: &Block, origin: &[Fixed; 3], direction: &[Fixed; 3]) -> Option<Fixed> {
    let (low, high) = (fixed(block.low()), fixed(block.high()));
    let slabs: Option<Vec<(Fixed, Fixed)>> = (0..3)
        .map(|axis| {
            let speed = &direction[axis];
            let to = |face: &Fixed| (!speed.is_zero()).then(|| &(face - &origin[axis]) / speed);
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

//! The 3-D caster: hits agree with geometry at any size, and a picture shows the hits of its rays.

use cellcaster::color::Rgb;
use cellcaster::render::{Frame, FrameSize, PixelAspect};
use cellcaster::space::{
    Block, Body, BodyShape, Camera, Elevation, Fraction, Plane, Ray, Renderer, Scene, SolidTexture,
    Sphere, Sun,
};
use cellcaster::world::{FieldOfView, Heading, Scale};
use glam::DVec3;
use proptest::prelude::*;

const ROUNDING: f64 = 1e-12;

fn scene(shapes: impl IntoIterator<Item = BodyShape>) -> Scene {
    let body =
        |(index, shape)| Body { shape, texture: SolidTexture::Plain(Rgb::new(index, 255, 255)) };
    Scene { bodies: (0..).zip(shapes).map(body).collect(), ..Scene::default() }
}

fn sphere(center: DVec3, radius: f64) -> BodyShape {
    BodyShape::Sphere(Sphere::new(center, radius).unwrap())
}

fn direction() -> impl Strategy<Value = DVec3> {
    let component = || prop_oneof![Just(0.0), -1.0..1.0];
    (component(), component(), component())
        .prop_map(DVec3::from)
        .prop_filter_map("no direction", DVec3::try_normalize)
}

fn power_of_ten(exponents: std::ops::Range<f64>) -> impl Strategy<Value = f64> {
    exponents.prop_map(|exponent| libm::pow(10.0, exponent))
}

fn point(reach: f64) -> impl Strategy<Value = DVec3> {
    [-reach..reach, -reach..reach, -reach..reach].prop_map(DVec3::from)
}

fn shape() -> impl Strategy<Value = BodyShape> {
    prop_oneof![
        (point(6.0), 0.01..4.0).prop_map(|(center, radius)| sphere(center, radius)),
        (point(6.0), direction())
            .prop_map(|(point, normal)| BodyShape::Plane(Plane::new(point, normal).unwrap())),
        (point(6.0), point(3.0)).prop_filter_map("no size", |(corner, size)| {
            Block::new(corner, corner + size).map(BodyShape::Block)
        }),
    ]
}

fn camera() -> impl Strategy<Value = Camera> {
    (point(6.0), 0.0..360.0, -90.0..=90.0, 1.0..170.0).prop_map(
        |(position, heading, elevation, field_of_view)| {
            let heading = Heading::from_degrees(heading).unwrap();
            let field_of_view = FieldOfView::from_degrees(field_of_view).unwrap();
            let camera = Camera::new(position, heading, field_of_view).unwrap();
            camera.with_elevation(Elevation::from_degrees(elevation).unwrap())
        },
    )
}

/// Returns whether another body is between the sun and `point` on `body`, by casting at each body
/// separately.
fn is_in_shadow(scene: &Scene, body: usize, point: DVec3) -> bool {
    let others = scene.bodies.iter().enumerate().filter(|&(index, _)| index != body);
    others.map(|(_, &other)| other).any(|other| {
        let alone = Scene { bodies: vec![other], ..Scene::default() };
        let is_outside = other.shape.signed_distance(point).0 > 0.0;
        let casts = !matches!(other.shape, BodyShape::Plane(_)) && is_outside;
        casts && alone.cast(&Ray::new(point, scene.sun.toward())).is_some()
    })
}

proptest! {
    /// The oracle uses an angle instead of a quadratic equation: a sphere of radius r at distance d
    /// covers the cone of half-angle asin(r/d) around its center.
    #[test]
    fn a_spheres_outline_is_where_geometry_says(
        toward in direction(),
        ray in direction(),
        distance in power_of_ten(-3.0..8.5),
        share in power_of_ten(-6.0..0.0),
    ) {
        let scene = scene([sphere(toward * distance, (distance * share).max(1e-9))]);
        let BodyShape::Sphere(sphere) = scene.bodies[0].shape else { unreachable!() };
        let beside = libm::atan2(ray.cross(toward).length(), ray.dot(toward));
        let half_angle = libm::asin(sphere.radius() / sphere.center().length());
        prop_assume!((beside - half_angle).abs() > 1e-9);
        let hit = scene.cast(&Ray::new(DVec3::ZERO, ray));
        prop_assert_eq!(hit.is_some(), beside < half_angle);
    }

    /// A point on the sphere is chosen first, so that its distance is known.
    #[test]
    fn a_sphere_of_any_size_is_hit_at_the_chosen_distance(
        outwards in direction(),
        aside in direction(),
        radius in power_of_ten(-9.0..9.0),
        height in power_of_ten(-6.0..3.0),
    ) {
        // The camera is on the axis through the center, at this distance from the surface.
        let distance = height.max(radius * 1e-6);
        let center = -outwards * (radius + distance);
        prop_assume!(center.abs().max_element() <= 1e9);
        let sphere = sphere(center, radius);
        let hit = scene([sphere]).cast(&Ray::new(DVec3::ZERO, -outwards)).unwrap();
        // The rounding of the center changes the true distance.
        let rounding = ROUNDING * distance + f64::EPSILON * 4.0 * center.length();
        prop_assert!((hit.t - distance).abs() <= rounding, "{} for {distance}", hit.t);
        let tilt = 1e-6 + f64::EPSILON * 4.0 * center.length() / radius;
        prop_assert!((hit.normal - outwards).length() < tilt);
        // A ray from inside through the center hits the far side.
        let inside = scene([sphere]).cast(&Ray::new(center, aside)).unwrap();
        prop_assert!((inside.t / radius - 1.0).abs() <= ROUNDING);
    }

    #[test]
    fn hits_are_on_the_nearest_surface(
        shape in shape(),
        origin in point(10.0),
        direction in direction(),
    ) {
        let scene = scene([shape]);
        let ray = Ray::new(origin, direction);
        let (outside, _) = shape.signed_distance(origin);
        let end = match scene.cast(&ray) {
            Some(hit) => {
                let (off, _) = shape.signed_distance(ray.at(hit.t));
                prop_assert!(off.abs() <= ROUNDING * (1.0 + hit.t) * 10.0, "{off} off at {}", hit.t);
                prop_assert!(hit.normal.dot(direction) <= 0.0);
                hit.t
            }
            None => 40.0,
        };
        for part in 1..32 {
            let (clearance, _) = shape.signed_distance(ray.at(end * f64::from(part) / 32.0));
            prop_assert!(clearance * outside.signum() >= -1e-9, "{clearance} at part {part}");
        }
    }

    /// Bounds, rows and reused memory change nothing: each pixel has the colour of its own ray.
    #[test]
    fn a_picture_shows_the_hits_of_its_rays(
        shapes in prop::collection::vec(shape(), 0..6),
        camera in camera(),
        (width, height) in (1..24_u32, 1..24_u32),
        aspect in 0.2..4.0,
    ) {
        let scene = scene(shapes);
        let (size, aspect) = (FrameSize::new(width, height).unwrap(), PixelAspect::new(aspect).unwrap());
        let mut frame = Frame::new(size, aspect);
        let explanation = Renderer::new().explain(&scene, &camera, &mut frame);
        let mut hits = 0;
        for (row, pixels) in (0..).zip(frame.rows()) {
            for (column, &pixel) in (0..).zip(pixels) {
                let ray = camera.ray(size, aspect, column, row);
                let expected = match scene.cast(&ray) {
                    None => scene.sky_color(ray.direction),
                    Some(hit) => {
                        hits += 1;
                        let brightness = if is_in_shadow(&scene, hit.body, ray.at(hit.t)) {
                            scene.sun.ambient.get()
                        } else {
                            scene.sun.brightness(hit.normal)
                        };
                        let share = (256.0 * brightness).round() / 256.0;
                        let [red, ..] = pixel.channels();
                        prop_assert_eq!(red, (hit.body as f64 * share) as u8);
                        let level = (255.0 * share) as u8;
                        Rgb::new(red, level, level)
                    }
                };
                prop_assert_eq!(pixel, expected, "column {}, row {}", column, row);
            }
        }
        prop_assert_eq!(explanation.hits, hits);
    }

    #[test]
    fn any_scene_can_be_drawn_from_any_camera(
        center in [-1e9..=1e9, -1e9..=1e9, -1e9..=1e9],
        radius in power_of_ten(-9.0..9.0),
        field_of_view in prop_oneof![Just(1e-320), Just(180.0_f64.next_down()), 1.0..170.0],
    ) {
        let center = DVec3::from(center);
        let block = Block::new(center, center - DVec3::splat(1e-6)).map(BodyShape::Block);
        let plane = Plane::new(center, DVec3::new(1e-300, 0.0, 1e-300)).map(BodyShape::Plane);
        let shapes = [Some(sphere(center, radius)), block, plane];
        let field_of_view = FieldOfView::from_degrees(field_of_view).unwrap();
        let camera = Camera::new(center, Heading::default(), field_of_view).unwrap();
        let mut frame = Frame::new(FrameSize::new(3, 1000).unwrap(), PixelAspect::SQUARE);
        Renderer::new().render(&scene(shapes.into_iter().flatten()), &camera, &mut frame);
    }
}

#[test]
fn a_small_body_costs_few_tests() {
    let scene = scene([sphere(DVec3::new(10.0, 0.0, 0.0), 0.5)]);
    let camera = Camera::new(DVec3::ZERO, Heading::default(), FieldOfView::default()).unwrap();
    let mut frame = Frame::new(FrameSize::new(160, 96).unwrap(), PixelAspect::SQUARE);
    let explanation = Renderer::new().explain(&scene, &camera, &mut frame);
    assert!(explanation.hits > 100 && explanation.tests < 2 * explanation.hits);
    let behind = Camera::new(DVec3::X * 20.0, Heading::default(), FieldOfView::default()).unwrap();
    assert_eq!(Renderer::new().explain(&scene, &behind, &mut frame).tests, 0);
}

/// A pixel of a checkered floor shows the mean over the hits of rays through the pixel.
#[test]
fn a_checkered_floor_averages_over_each_pixel() {
    const SAMPLES: u32 = 24;
    let floor = BodyShape::Plane(Plane::new(DVec3::ZERO, DVec3::Z).unwrap());
    let texture = SolidTexture::Checker([Rgb::BLACK, Rgb::WHITE], Scale::ONE);
    let sun = Sun::new(DVec3::Z, Fraction::new(0.5).unwrap()).unwrap();
    let bodies = vec![Body { shape: floor, texture }];
    let scene = Scene { bodies, sun, ..Scene::default() };
    let camera = Camera::new(DVec3::Z * 1.7, Heading::default(), FieldOfView::default()).unwrap();
    let (size, fine) = (FrameSize::new(48, 36), FrameSize::new(48 * SAMPLES, 36 * SAMPLES));
    let (size, fine) = (size.unwrap(), fine.unwrap());
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    Renderer::new().render(&scene, &camera, &mut frame);
    let is_white = |column: u32, row: u32| {
        let ray = camera.ray(fine, PixelAspect::SQUARE, column, row);
        let hit = scene.cast(&ray).unwrap();
        texture.color_at(ray.at(hit.t) - DVec3::Z * 0.01) == Rgb::WHITE
    };
    let linear = |channel: u8| libm::pow((f64::from(channel) / 255.0 + 0.055) / 1.055, 2.4);
    let (mut error, mut error_of_one_sample) = (0.0, 0.0);
    // The row below the horizon covers an unbounded area. The area of a pixel is not exactly a box.
    for row in 19..36 {
        for column in 0..48 {
            let samples = (0..SAMPLES * SAMPLES)
                .filter(|index| {
                    let (x, y) = (index % SAMPLES, index / SAMPLES);
                    is_white(column * SAMPLES + x, row * SAMPLES + y)
                })
                .count();
            let expected = samples as f64 / f64::from(SAMPLES * SAMPLES);
            let shown = linear(frame.pixel(column, row).red()).max(0.0);
            error += (shown - expected).abs();
            let middle = SAMPLES / 2;
            let sample = is_white(column * SAMPLES + middle, row * SAMPLES + middle);
            error_of_one_sample += (f64::from(u8::from(sample)) - expected).abs();
        }
    }
    let pixels = f64::from(17 * 48);
    assert!(error / pixels < 0.08, "{}", error / pixels);
    assert!(error_of_one_sample > 2.0 * error, "{error_of_one_sample} {error}");
}

#[test]
fn far_squares_are_grey() {
    let floor = BodyShape::Plane(Plane::new(DVec3::ZERO, DVec3::Z).unwrap());
    let texture = SolidTexture::Checker([Rgb::BLACK, Rgb::WHITE], Scale::ONE);
    let sun = Sun::new(DVec3::Z, Fraction::new(0.0).unwrap()).unwrap();
    let scene = Scene { bodies: vec![Body { shape: floor, texture }], sun, ..Scene::default() };
    let camera = Camera::new(DVec3::Z * 1.7, Heading::default(), FieldOfView::default()).unwrap();
    let mut frame = Frame::new(FrameSize::new(80, 400).unwrap(), PixelAspect::SQUARE);
    Renderer::new().render(&scene, &camera, &mut frame);
    for column in 0..80 {
        // Half of white, in linear light.
        assert!(frame.pixel(column, 200).red().abs_diff(188) <= 6, "{}", frame.pixel(column, 200));
    }
}

/// The cost of shadows depends on the bodies near the way to the sun, not on all bodies.
#[test]
fn a_thousand_balls_in_a_row_cast_few_shadow_rays_at_each_other() {
    let ball = |index: u32| sphere(DVec3::new(8.0, f64::from(index) - 500.0, 0.5), 0.4);
    let floor = BodyShape::Plane(Plane::new(DVec3::ZERO, DVec3::Z).unwrap());
    let shapes = (0..1000).map(ball).chain([floor]);
    let scene = Scene {
        bodies: shapes
            .map(|shape| Body { shape, texture: SolidTexture::Plain(Rgb::WHITE) })
            .collect(),
        sun: Sun::new(DVec3::new(-1.0, 0.0, 1.0), Fraction::new(0.2).unwrap()).unwrap(),
        ..Scene::default()
    };
    let camera = Camera::new(DVec3::Z * 2.0, Heading::default(), FieldOfView::default()).unwrap();
    let mut frame = Frame::new(FrameSize::new(160, 96).unwrap(), PixelAspect::SQUARE);
    let explanation = Renderer::new().explain(&scene, &camera, &mut frame);
    assert!(explanation.shadow_rays > 1000);
    assert!(explanation.shadow_tests < 2 * explanation.shadow_rays, "{explanation}");
}

#[test]
fn a_sphere_ahead_is_round() {
    let scene = scene([sphere(DVec3::new(5.0, 0.0, 0.0), 1.0)]);
    let camera = Camera::new(DVec3::ZERO, Heading::default(), FieldOfView::default()).unwrap();
    let size = FrameSize::new(80, 24).unwrap();
    let mut frame = Frame::new(size, PixelAspect::new(2.0).unwrap());
    Renderer::new().render(&scene, &camera, &mut frame);
    let is_sphere = |column: u32, row: u32| frame.pixel(column, row).red() == 0;
    let across = (0..80).filter(|&column| is_sphere(column, 12)).count();
    let down = (0..24).filter(|&row| is_sphere(40, row)).count();
    assert!(down > 8 && across.abs_diff(2 * down) <= 2, "{across} by {down}");
}

/// If bodies overlap on the screen, a ray is tested against only a few of them.
#[test]
fn bodies_that_overlap_cost_little_more_than_the_nearest() {
    let place = |index: u32, factor: u32| f64::from(index * factor % 1000) / 1000.0;
    let ball = |index: u32| {
        let aside = DVec3::new(0.0, place(index, 7) - 0.5, place(index, 13) - 0.5) * 20.0;
        sphere(DVec3::new(20.0 + 80.0 * place(index, 17), 0.0, 0.0) + aside, 9.0)
    };
    let texture = SolidTexture::Plain(Rgb::WHITE);
    let bodies = (0..1000).map(|index| Body { shape: ball(index), texture }).collect();
    let scene = Scene { bodies, ..Scene::default() };
    let camera = Camera::new(DVec3::ZERO, Heading::default(), FieldOfView::default()).unwrap();
    let (size, aspect) = (FrameSize::new(60, 40).unwrap(), PixelAspect::SQUARE);
    let mut frame = Frame::new(size, aspect);
    let explained = Renderer::new().explain(&scene, &camera, &mut frame);
    assert!(explained.tests < 50 * explained.rays, "{} tests", explained.tests);
}

/// Draws `scene` in bands while fewer than `most` are drawn. Returns whether the frame is complete,
/// and the number of bands.
fn draw_bands(scene: &Scene, camera: &Camera, frame: &mut Frame, most: u64) -> (bool, u64) {
    let mut bands = 0;
    let is_complete = Renderer::new().render_while(scene, camera, frame, &mut || {
        bands += u64::from(bands < most);
        bands < most
    });
    (is_complete, bands)
}

#[test]
fn a_drawing_can_be_interrupted_after_bounded_work() {
    let scene = scene((0..100).map(|_| sphere(DVec3::new(9.0, 0.0, 0.0), 8.0)));
    let camera = Camera::new(DVec3::ZERO, Heading::default(), FieldOfView::default()).unwrap();
    let black = Frame::new(FrameSize::new(120, 80).unwrap(), PixelAspect::SQUARE);
    let (mut whole, mut in_bands) = (black.clone(), black.clone());
    let counts = Renderer::new().explain(&scene, &camera, &mut whole);
    let (is_complete, bands) = draw_bands(&scene, &camera, &mut in_bands, u64::MAX);
    assert!(is_complete && whole == in_bands);
    let work = counts.rays + counts.tests + counts.shadow_tests;
    assert!(bands > 10 && work / bands < 100_000, "{work} tests and pixels in {bands} bands");

    let mut partial = black.clone();
    assert_eq!(draw_bands(&scene, &camera, &mut partial, 3), (false, 3));
    let rows = |frame: &Frame| frame.rows().map(<[Rgb]>::to_vec).collect::<Vec<_>>();
    let [partial, whole, black] = [&partial, &whole, &black].map(rows);
    let drawn = partial.iter().zip(&whole).take_while(|(one, other)| one == other).count();
    assert!((1..80).contains(&drawn) && partial[drawn..] == black[drawn..], "{drawn} rows");
}

//! Pitch and eye height: the picture moves by rows, and pixels that stay in view do not change.

use std::path::Path;

use cellcaster::map::{self, builtin};
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, Cell, FieldOfView, Heading, Pitch, World};
use proptest::prelude::*;

/// Levels with doors, glass, masks, fog, a panorama, a gradient, and different tiles.
fn world(index: usize) -> World {
    const GALLERY: [&str; 7] = ["doors", "glass", "masks", "fog", "panorama", "gradient", "tiles"];
    match GALLERY.get(index) {
        Some(name) => map::load(Path::new(&format!("maps/gallery/{name}.toml"))).unwrap(),
        None => builtin::LEVELS[index - GALLERY.len()].world().unwrap(),
    }
}

const WORLDS: usize = 10;

fn picture(world: &World, camera: &Camera, size: (u32, u32), aspect: f64) -> Frame {
    let size = FrameSize::new(size.0, size.1).unwrap();
    let mut frame = Frame::new(size, PixelAspect::new(aspect).unwrap());
    Renderer::new().render(world, camera, &mut frame);
    frame
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// The picture of a camera that looks up is the level picture moved down by some rows, bit for
    /// bit.
    #[test]
    fn a_pitched_picture_is_the_level_one_shifted_by_rows(
        index in 0..WORLDS,
        place in any::<prop::sample::Index>(),
        degrees in 0.0..360.0,
        pitch in -30.0..=30.0,
        eye in prop_oneof![Just(0.5), 0.02..0.98],
        size in (1_u32..80, 1_u32..80),
        aspect in prop_oneof![Just(1.0), Just(2.0)],
    ) {
        let world = world(index);
        let grid = world.grid();
        let cells = (0..grid.height()).flat_map(|row| (0..grid.width()).map(move |c| (c, row)));
        let open: Vec<_> = cells.filter(|&(c, r)| !grid.is_solid(c.into(), r.into())).collect();
        let (column, row) = *place.get(&open);
        let heading = Heading::from_degrees(degrees).unwrap();
        let level = Camera::in_cell(Cell { column, row }, heading, FieldOfView::default())
            .with_eye(eye)
            .unwrap();
        let pitched = level.with_pitch(Pitch::from_degrees(pitch).unwrap());

        let focal_length = f64::from(size.0) / 2.0 / level.field_of_view.half_width() / aspect;
        let rows_down = (pitched.pitch.slope() * focal_length).round() as i64;
        let (before, after) =
            (picture(&world, &level, size, aspect), picture(&world, &pitched, size, aspect));
        for y in 0..size.1 {
            let moved = i64::from(y) + rows_down;
            let Some(moved) = u32::try_from(moved).ok().filter(|&row| row < size.1) else {
                continue;
            };
            for x in 0..size.0 {
                prop_assert_eq!(before.pixel(x, y), after.pixel(x, moved), "at ({}, {})", x, y);
            }
        }
    }

    #[test]
    fn no_camera_panics(
        index in 0..WORLDS,
        eye in any::<f64>(),
        pitch in -30.0..=30.0,
        field_of_view in prop_oneof![Just(1e-320), Just(1e-9), Just(179.999_999), 1.0..179.0],
        size in (1_u32..30, 1_u32..30),
    ) {
        let world = world(index);
        let field_of_view = FieldOfView::from_degrees(field_of_view).unwrap();
        let camera = world.start_camera(field_of_view);
        let camera = camera.with_eye(eye).unwrap_or(camera);
        let pitched = camera.with_pitch(Pitch::from_degrees(pitch).unwrap());
        picture(&world, &pitched, size, 1.0);
    }
}

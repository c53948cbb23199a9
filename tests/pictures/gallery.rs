//! The gallery: a small map for each feature, with golden pictures, and the examples of the page
//! about maps.

use std::fs;

use crate::support::output_of;
use cellcaster::map::{self, Level, NoFiles};
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::space;
use cellcaster::world::FieldOfView;

fn names() -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir("maps/gallery")
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter_map(|name| name.strip_suffix(".toml").map(str::to_owned))
        .collect();
    names.sort();
    names
}

#[test]
fn every_feature_looks_as_it_did() {
    for name in names() {
        assert_golden(&name, &name, &[]);
    }
}

#[test]
fn every_feature_looks_as_it_did_on_a_large_screen() {
    for name in names() {
        let map = format!("maps/gallery/{name}.toml");
        let picture = output_of(&["snapshot", &map, "--size", "200x60", "--format", "png"]);
        insta::assert_binary_snapshot!(&format!("{name}_200x60.png"), picture);
    }
}

#[test]
fn every_feature_is_explained_as_it_was() {
    for name in names() {
        let map = format!("maps/gallery/{name}.toml");
        let explanation = String::from_utf8(output_of(&["snapshot", &map, "--explain"])).unwrap();
        insta::assert_snapshot!(format!("explain_{name}"), explanation);
    }
}

#[test]
fn every_example_on_the_map_page_is_valid() {
    let page = fs::read_to_string("docs/maps.md").unwrap();
    let examples: Vec<&str> = page
        .split("```toml\n")
        .skip(1)
        .map(|rest| rest.split("```").next().unwrap_or_default())
        .collect();
    assert!(examples.len() >= 10, "where are the examples?");
    for example in examples {
        if example.contains("[[") {
            assert!(shows_something(&scene_picture(example)), "{example}");
            continue;
        }
        // An example of a feature is a part of a map. The other parts are always the same.
        let text = if example.contains("grid") { example.to_owned() } else { with_room(example) };
        let world = map::parse_str(&text).unwrap_or_else(|faults| panic!("{text}\n{faults}"));
        let mut frame = Frame::new(FrameSize::new(80, 48).unwrap(), PixelAspect::SQUARE);
        let camera = world.start_camera(FieldOfView::default());
        Renderer::new().render(&world, &camera, &mut frame);
        assert!(shows_something(&frame), "{example}");
    }
}

fn shows_something(frame: &Frame) -> bool {
    let first = frame.pixel(0, 0);
    frame.rows().flatten().any(|&pixel| pixel != first)
}

/// The picture of a map of bodies.
fn scene_picture(text: &str) -> Frame {
    let level = map::parse_level(text, "example", &NoFiles);
    let Ok(Level::Space(scene)) = level else { panic!("{text}\n{level:?}") };
    let mut frame = Frame::new(FrameSize::new(80, 48).unwrap(), PixelAspect::SQUARE);
    let camera = scene.start_camera(FieldOfView::default());
    space::Renderer::new().render(&scene, &camera, &mut frame);
    frame
}

/// A part of a map, completed by a room.
fn with_room(part: &str) -> String {
    const ROOM: &str = "grid = '''\n######\n#@,;.#\n#....#\n######\n'''\n";
    const WALL: &str = "\"#\" = { wall = \"brick\" }\n";
    const OPEN: &str = "\",\" = { light = 1 }\n\";\" = { light = 1 }\n";
    const START: &str = "[things]\n\"@\" = { start = 0 }\n";
    match part.split_once("[tiles]\n") {
        None => format!("{part}{ROOM}[tiles]\n{WALL}{OPEN}{START}"),
        Some((head, tiles)) => {
            let missing: String = [WALL]
                .into_iter()
                .chain(OPEN.split_inclusive('\n'))
                .filter(|line| !tiles.contains(&line[..3]))
                .collect();
            format!("{head}{ROOM}[tiles]\n{tiles}{missing}{START}")
        }
    }
}

/// Compares with a golden picture.
fn assert_golden(map: &str, name: &str, options: &[&str]) {
    let path = format!("maps/gallery/{map}.toml");
    let arguments = [&["snapshot", &path, "--format", "png"], options].concat();
    insta::assert_binary_snapshot!(&format!("{name}_png.png"), output_of(&arguments));
}

#[test]
fn a_ramp_of_sixteen_shades_draws_both_kinds_of_maps() {
    assert_golden("spheres", "spheres_ramp", &["--glyphs", "ramp"]);
    assert_golden("doors", "doors_ramp", &["--glyphs", "ramp"]);
}

#[test]
fn doors_are_set_back_between_their_jambs() {
    assert_golden("doors", "doors_at_an_angle", &["--camera", "2.5,4.2,308"]);
    assert_golden("doors", "doors_from_the_front", &["--camera", "2.7,2.5,0"]);
}

#[test]
fn masks_are_transparent_in_their_holes() {
    assert_golden("masks", "masks_in_a_row", &["--camera", "2.5,2.5,4"]);
    assert_golden("masks", "masks_along_a_fence", &["--camera", "1.6,2.6,24"]);
}

#[test]
fn several_cubes_of_glass_blend() {
    assert_golden("glass", "glass_in_a_row", &["--camera", "4.6,2.6,10"]);
    assert_golden("glass", "glass_along_a_row", &["--camera", "8.4,5.6,250"]);
}

#[test]
fn pitched_pictures_shift_the_level_one() {
    assert_golden("looking", "looking_up", &["--pitch", "14"]);
    assert_golden("looking", "looking_down", &["--pitch", "-14"]);
    assert_golden("looking", "looking_from_below", &["--eye", "0.2"]);
    assert_golden("looking", "looking_from_above", &["--eye", "0.9", "--pitch", "-10"]);
}

#[test]
fn heights_are_seen_from_below_and_from_above() {
    assert_golden("heights", "heights_large", &["--size", "200x60"]);
    let above = ["--camera", "2.5,10.5,330", "--eye", "3.3", "--pitch", "-20"];
    assert_golden("heights", "heights_from_above", &above);
    assert_golden("heights", "heights_of_a_pit", &["--camera", "5.5,9.5,190", "--pitch", "-12"]);
    assert_golden("heights", "heights_under_a_roof", &["--camera", "8.5,7.5,40", "--pitch", "8"]);
}

#[test]
fn mirrors_show_mirrors() {
    assert_golden("mirrors", "mirrors_large", &["--size", "200x60"]);
    assert_golden("mirrors", "mirrors_face_to_face", &["--camera", "6.5,6.6,4"]);
    assert_golden("mirrors", "mirrors_and_whoever_looks", &["--camera", "2.5,3.5,180"]);
}

#[test]
fn shapes_do_not_fill_their_cells() {
    assert_golden("shapes", "shapes_of_pillars", &["--camera", "6.5,4.5,200"]);
    assert_golden("shapes", "shapes_of_diagonals", &["--camera", "10.5,5.5,90"]);
    assert_golden("shapes", "shapes_of_thin_walls", &["--camera", "6.5,6.5,340"]);
    let above = ["--eye", "1.6", "--pitch", "-15"];
    assert_golden("stumps", "shapes_from_above", &above);
}

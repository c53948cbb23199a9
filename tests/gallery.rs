//! Golden pictures of the maps in `maps/gallery`: one small map for each feature.

mod support;

use support::output_of;

/// A golden file for the picture, and one for its characters.
fn assert_golden(map: &str, name: &str, camera: &str) {
    let path = format!("maps/gallery/{map}.toml");
    for format in ["png", "text"] {
        let arguments = ["snapshot", &path, "--camera", camera, "--format", format];
        insta::assert_binary_snapshot!(&format!("{name}_{format}.{format}"), output_of(&arguments));
    }
}

#[test]
fn doors_stand_back_between_their_jambs() {
    assert_golden("doors", "doors_at_an_angle", "2.5,4.2,308");
    assert_golden("doors", "doors_from_the_front", "2.7,2.5,0");
}

#[test]
fn masks_show_what_is_behind_their_holes() {
    assert_golden("masks", "masks_in_a_row", "2.5,2.5,4");
    assert_golden("masks", "masks_along_a_fence", "1.6,2.6,24");
}

#[test]
fn panes_of_glass_add_up() {
    assert_golden("glass", "glass_in_a_row", "4.6,2.6,10");
    assert_golden("glass", "glass_along_a_row", "8.4,5.6,250");
}

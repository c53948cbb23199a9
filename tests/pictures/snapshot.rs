//! `cellcaster snapshot`: golden pictures, and the behaviour that scripts rely on.

use std::io::Read;
use std::num::NonZeroU16;
use std::process::Stdio;

use crate::support::{cellcaster, complaint_about, grid_of, output_of};
use cellcaster::map;
use cellcaster::testing::{CellGrid, assert_grid};
use cellcaster::tui::FirstPerson;
use cellcaster::world::FieldOfView;
use ratatui::style::Color;
use serde_json::Value;

/// Levels that never change, unlike the levels of the campaign.
const LEVELS: [&str; 5] = ["cellar", "museum", "citadel", "cistern", "observatory"];

/// Compares the cells with a golden grid, and their picture with a golden PNG.
fn assert_golden(level: &str, size: &str, options: &[(&str, &str)]) {
    let map = format!("tests/maps/{level}.toml");
    let mut arguments = vec!["snapshot", &map, "--size", size];
    arguments.extend(options.iter().flat_map(|&(name, value)| [name, value]));
    let values = options.iter().map(|&(_, value)| value);
    let name = [level, size].into_iter().chain(values).collect::<Vec<_>>().join("_");
    assert_grid!(grid_of(&arguments), &name);
    let picture = output_of(&[&arguments[..], &["--format", "png"]].concat());
    insta::assert_binary_snapshot!(&format!("{name}_png.png"), picture);
}

#[test]
fn every_level_looks_as_it_did() {
    for level in LEVELS {
        for size in ["80x24", "120x40", "33x9"] {
            assert_golden(level, size, &[]);
        }
    }
}

#[test]
fn every_depth_and_glyph_mode_looks_as_it_did() {
    for level in LEVELS {
        for depth in ["true", "256", "16", "mono"] {
            for glyphs in ["half", "ascii"] {
                assert_golden(level, "80x24", &[("--colors", depth), ("--glyphs", glyphs)]);
            }
        }
    }
}

#[test]
fn finer_glyphs_look_as_they_did() {
    for glyphs in ["quadrant", "sextant", "octant"] {
        assert_golden(LEVELS[0], "80x24", &[("--glyphs", glyphs)]);
    }
}

#[test]
fn a_snapshot_has_the_widgets_cells() {
    const MUSEUM: &str = "tests/maps/museum.toml";
    let world = map::load(MUSEUM.as_ref()).unwrap();
    let camera = world.start_camera(FieldOfView::default());
    let widget = CellGrid::of(FirstPerson::new(&world, &camera), 80, 24);
    assert_eq!(grid_of(&["snapshot", MUSEUM]), widget);
    let json = output_of(&["snapshot", MUSEUM, "--format", "json"]);
    assert_eq!(CellGrid::read_from(&json[..]), Ok(widget));
}

#[test]
fn mono_names_no_colours() {
    let arguments = ["snapshot", "--colors", "mono", "--format", "json", "--size", "9x4"];
    let json: Value = serde_json::from_slice(&output_of(&arguments)).unwrap();
    let cells: Vec<&Value> =
        json["cells"].as_array().unwrap().iter().flat_map(|row| row.as_array().unwrap()).collect();
    assert_eq!(cells.len(), 36);
    assert!(cells.iter().all(|cell| cell["fg"].is_null() && cell["bg"].is_null()));
    let ansi = output_of(&["snapshot", "--colors", "mono", "--format", "ansi"]);
    assert!(!ansi.contains(&0x1b));
}

fn in_vt100(color: Color) -> vt100::Color {
    match color {
        Color::Rgb(red, green, blue) => vt100::Color::Rgb(red, green, blue),
        Color::Indexed(index) => vt100::Color::Idx(index),
        _ => vt100::Color::Default,
    }
}

#[test]
fn ansi_shows_the_same_cells_in_a_terminal() {
    for depth in ["true", "256", "16", "mono"] {
        let arguments = ["snapshot", "citadel", "--colors", depth];
        let cells = grid_of(&arguments);
        let ansi = output_of(&[&arguments[..], &["--format", "ansi"]].concat());
        let mut terminal =
            vt100::Parser::new(NonZeroU16::new(24).unwrap(), NonZeroU16::new(80).unwrap(), 0);
        terminal.process(&String::from_utf8(ansi).unwrap().replace('\n', "\r\n").into_bytes()[..]);
        // The last line break has scrolled the first row away.
        for (column, row) in (0..80).flat_map(|column| (1..24).map(move |row| (column, row))) {
            let wanted = cells.cell(column, row).unwrap();
            let shown = terminal.screen().cell(row - 1, column).unwrap();
            let place = format!("{depth}, column {column}, row {row}");
            assert_eq!(
                shown.contents().chars().next().unwrap_or(' ').to_string(),
                wanted.symbol(),
                "{place}"
            );
            assert_eq!(in_vt100(wanted.bg), shown.bgcolor(), "{place}");
            if wanted.symbol() != " " {
                assert_eq!(in_vt100(wanted.fg), shown.fgcolor(), "{place}");
            }
        }
    }
}

#[test]
fn a_letter_on_a_wall_reads_the_same_from_all_sides() {
    let seen_from = |camera| {
        let map = "tests/maps/letter.toml";
        let picture = output_of(&["snapshot", map, "--size", "40x20", "--camera", camera]);
        String::from_utf8(picture).unwrap()
    };
    let from_the_west = seen_from("1.5,3.5,0");
    insta::assert_snapshot!(from_the_west);
    for camera in ["5.5,3.5,180", "3.5,1.5,90", "3.5,5.5,270"] {
        assert_eq!(seen_from(camera), from_the_west, "{camera}");
    }
}

#[test]
fn a_camera_can_stand_anywhere() {
    for camera in ["2.5,2.5,90", "-3,-4.5,45", "1e300,0,180", "0,0,1e300", "3,3,-0"] {
        let arguments = ["snapshot", "--camera", camera, "--size", "20x5"];
        let output = cellcaster(&arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{camera}");
        assert_eq!(String::from_utf8(output.stdout).unwrap().lines().count(), 5, "{camera}");
    }
}

#[test]
fn a_camera_in_a_wall_is_reported() {
    let remark = |arguments: &[&str]| {
        let arguments = [&["snapshot", "--size", "20x5"], arguments].concat();
        let output = cellcaster(&arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        String::from_utf8(output.stderr).unwrap()
    };
    assert_eq!(remark(&["--camera", "2.5,2.5,90"]), "");
    assert!(remark(&["--camera", "0.5,0.5,90"]).contains("inside a wall"));
    assert!(remark(&["--camera", "-3,-4.5,45"]).contains("outside the map, which has"));
    assert!(remark(&["--camera", "1e300,0,180"]).contains("outside the map"));
    assert!(remark(&["--camera", "2.5,2.5,90", "--eye", "-1"]).contains("below the floor"));
    assert!(remark(&["maps/gallery/floor.toml", "--eye", "1.0"]).is_empty());
}

/// The map is the one in which this fault was found.
#[test]
fn an_unreachable_exit_is_reported() {
    let check = |map: &str| String::from_utf8(output_of(&["check", map])).unwrap();
    let reachable = check("tests/maps/way_out.toml");
    assert!(!reachable.contains("exit"), "{reachable}");
    let walled_in = check("tests/maps/walled_in.toml");
    assert!(walled_in.contains("valid, 16×10 cells; but no exit can be reached"), "{walled_in}");
    for level in ["cellar", "museum", "cistern", "observatory", "citadel"] {
        assert!(!check(level).contains("exit"), "{level}");
    }
    assert!(check("tests/maps/cross.toml").contains("valid, 5×5 cells; it has no exit"));
}

#[test]
fn remarks_can_be_denied() {
    let status = |maps: &[&str]| {
        let output =
            cellcaster(&[&["check", "--deny", "remarks"], maps].concat()).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    assert_eq!(status(&["cellar", "tests/maps/way_out.toml"]), (Some(0), String::new()));
    for (maps, count) in [
        (&["tests/maps/cross.toml"][..], "1 map has a remark"),
        (&["cellar", "tests/maps/walled_in.toml"], "1 map has a remark"),
        (&["tests/maps/cross.toml", "tests/maps/walled_in.toml"], "2 maps have a remark"),
    ] {
        let (code, complaint) = status(maps);
        assert_eq!(code, Some(2), "{maps:?}");
        assert!(complaint.contains(count), "{complaint}");
    }
}

#[test]
fn extreme_pictures_are_drawn() {
    for (size, fov, aspect) in [
        ("1x1", "66", "2"),
        ("1x300", "0.001", "0.1"),
        ("300x1", "179.9", "10"),
        ("4096x2", "1e-300", "2"),
    ] {
        for format in ["text", "png"] {
            let options = [
                "snapshot",
                "--size",
                size,
                "--fov",
                fov,
                "--cell-aspect",
                aspect,
                "--format",
                format,
            ];
            assert!(!output_of(&options).is_empty());
        }
    }
}

#[test]
fn a_closed_pipe_ends_the_command_quietly() {
    let mut child = cellcaster(&["snapshot", "--size", "4096x500", "--format", "json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = [0; 100];
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    assert!(output.status.success());
}

#[test]
fn each_mistake_is_reported_in_one_sentence() {
    let mistakes: [&[&str]; 25] = [
        &["--size", "80"],
        &["--size", "0x24"],
        &["--size", "80x4097"],
        &["--size", "-1x2"],
        &["--size"],
        &["--camera", "1,2"],
        &["--camera", "1,nan,3"],
        &["--camera", "1,2,3,4"],
        &["--eye", "high"],
        &["--eye", "inf"],
        &["--pitch", "31"],
        &["--pitch", "nan"],
        &["--fov", "0"],
        &["--fov", "180"],
        &["--fov", "wide"],
        &["--cell-aspect", "0.05"],
        &["--glyphs", "braille"],
        &["--colors", "17"],
        &["--format", "jpeg"],
        &["--fromat", "png"],
        &["--walls"],
        &["-x"],
        &["cellar", "museum"],
        &["no-such-map.toml"],
        &["musuem"],
    ];
    let complaints: Vec<String> = mistakes
        .into_iter()
        .map(|mistake| {
            let arguments = [&["snapshot"], mistake].concat();
            let complaint = complaint_about(&arguments);
            assert_eq!(complaint.lines().count(), 1, "{complaint}");
            format!("{}\n  {complaint}", arguments.join(" "))
        })
        .collect();
    insta::assert_snapshot!(complaints.concat());
}

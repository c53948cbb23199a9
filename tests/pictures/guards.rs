//! The kinds of guard, seen from afar in a dim room of stone, as a window of 80 by 24 cells shows
//! them: golden pictures, and the contrast of each kind with the room and with the other kinds.

use std::fmt::Write;

use serde_json::Value;

use crate::support::run_with_input;

/// A picture around a guard: the upper and the lower half of each cell, by row.
type Picture = Vec<Vec<String>>;

const KINDS: [&str; 5] = ["warden", "listener", "lantern", "hound", "archer"];
/// The distances in cells, and the number of columns and rows of the picture at each distance.
const DISTANCES: [(f64, usize, usize); 3] = [(2.0, 20, 18), (5.0, 16, 12), (9.0, 12, 8)];
/// The colour depths, each with the smallest number of half cells by which a kind must differ from
/// the empty room, and then from every other kind, at each distance.
const DEPTHS: [(&str, [usize; 3], [usize; 3]); 3] = [
    ("true", [70, 10, 10], [200, 40, 12]),
    ("256", [70, 8, 4], [200, 25, 8]),
    ("mono", [40, 8, 6], [120, 16, 6]),
];
const COLUMNS: usize = 80;
const ROWS: usize = 23;

/// A room with `thing` at its end, which faces the viewer.
fn room(thing: &str) -> String {
    format!(
        "floor = 'flagstone'\nlight = 0.6\n\
         grid = '''\n################\n#..............#\n#@..........g..#\n\
         #..............#\n################\n'''\n\
         [tiles]\n'#' = {{ wall = 'stone' }}\n[things]\n'@' = {{ start = 0 }}\n'g' = {{ {thing} }}\n"
    )
}

/// The picture of the thing from a distance of `distance` cells.
fn picture(thing: &str, depth: &str, (distance, columns, rows): (f64, usize, usize)) -> Picture {
    let camera = format!("{},2.5,0", 12.5 - distance);
    let size = format!("{COLUMNS}x{ROWS}");
    let arguments =
        ["snapshot", "-", "--size", &size, "--camera", &camera, "--colors", depth, "--format"];
    let output = run_with_input(&[&arguments[..], &["json"]].concat(), room(thing).as_bytes());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let snapshot: Value = serde_json::from_slice(&output.stdout).unwrap();
    let cells = snapshot["cells"].as_array().unwrap();
    let shown = &cells[(ROWS - rows).div_ceil(2)..][..rows];
    let halves = shown.iter().map(|row| {
        let row = &row.as_array().unwrap()[(COLUMNS - columns) / 2..][..columns];
        row.iter().map(halves).unzip::<_, _, Vec<_>, Vec<_>>()
    });
    halves.flat_map(|(upper, lower)| [upper, lower]).collect()
}

/// The colours of the halves of a cell: three digits each, or a sign in a picture without colours.
/// A shade is as bright as its dots.
fn halves(cell: &Value) -> (String, String) {
    let glyph = cell["ch"].as_str().unwrap();
    if let Some(quarters) = ["░", "▒", "▓"].iter().position(|shade| *shade == glyph) {
        let channel = |name: &str, at: usize| {
            cell[name].as_str().map(|color| u32::from_str_radix(&color[at..at + 2], 16).unwrap())
        };
        let mixed = [1, 3, 5].map(|at| {
            let (text, ground) = (channel("fg", at)?, channel("bg", at)?);
            let quarters = quarters as u32 + 1;
            char::from_digit((text * quarters + ground * (4 - quarters)) / 64, 16)
        });
        let mixed: Option<String> = mixed.into_iter().collect();
        let mixed = mixed.unwrap_or_else(|| glyph.to_owned());
        return (mixed.clone(), mixed);
    }
    let color = |name: &str| match cell[name].as_str() {
        Some(color) => [1, 3, 5].map(|digit| &color[digit..=digit]).concat(),
        None => if name == "fg" { "#" } else { "." }.to_owned(),
    };
    let (front, back) = (color("fg"), color("bg"));
    match glyph {
        "▀" => (front, back),
        "▄" => (back, front),
        "█" => (front.clone(), front),
        _ => (back.clone(), back),
    }
}

fn difference(one: &Picture, other: &Picture) -> usize {
    let pairs = one.iter().flatten().zip(other.iter().flatten());
    pairs.filter(|(one, other)| one != other).count()
}

#[test]
fn kinds_can_be_told_apart_at_any_distance_and_depth() {
    for (depth, from_room, from_others) in DEPTHS {
        let mut shown = String::new();
        for (index, distance) in DISTANCES.into_iter().enumerate() {
            let empty = picture("guard = 'hound', difficulty = 'hard'", depth, distance);
            let pictures = KINDS
                .map(|kind| picture(&format!("guard = '{kind}', heading = 180"), depth, distance));
            for (number, (kind, picture)) in KINDS.iter().zip(&pictures).enumerate() {
                let seen = difference(picture, &empty);
                let place = format!("{kind} at {} cells in {depth}", distance.0);
                assert!(seen >= from_room[index], "{place}: {seen} from the room");
                for (other, other_picture) in KINDS.iter().zip(&pictures).skip(number + 1) {
                    let apart = difference(picture, other_picture);
                    assert!(apart >= from_others[index], "{place}: {apart} from the {other}");
                }
                _ = writeln!(shown, "{place}");
                for row in picture {
                    _ = writeln!(shown, "{}", row.join(" "));
                }
            }
        }
        insta::assert_snapshot!(format!("guards_{depth}"), shown);
    }
}

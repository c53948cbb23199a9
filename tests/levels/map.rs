//! Valid maps of all kinds, and random texts, which never cause a panic.

use std::cell::RefCell;
use std::io;

use cellcaster::color::Rgb;
use cellcaster::map::{self, TextureFileError, TextureFiles, builtin};
use cellcaster::world::{
    Ceiling, Cell, Covering, Glass, Paint, Pattern, ThingKind, TileKind, World,
};
use proptest::prelude::*;

const VALID: &str = r##"
title = "Two rooms"
ceiling = "sky"
floor = "stone"

grid = '''
#########
#@..#...#
#...+.. #
#...#..X#
#########
'''

[tiles]
"#" = { wall = "brick" }
"+" = { wall = "#a04030" }

[things]
"@" = { start = 90 }
"X" = { exit = true }
"##;

/// The grid of the world, with open floor as `.`.
fn drawn(world: &World) -> String {
    let row = |tiles: &[_]| tiles.iter().map(|&tile| world.tile(tile).character).collect();
    world.grid().rows().map(row).collect::<Vec<String>>().join("\n")
}

#[test]
fn a_map_describes_a_whole_world() {
    let world = map::parse_str(VALID).unwrap();
    assert_eq!(world.title(), "Two rooms");
    assert_eq!(world.ceiling(), Ceiling::Sky);
    assert!(matches!(world.floor().pattern, Pattern::Plain(Paint::Texture(_))));
    assert_eq!(drawn(&world), "#########\n#...#...#\n#...+...#\n#...#...#\n#########");
    let characters: String = world.tiles().iter().map(|tile| tile.character).collect();
    assert_eq!(characters, ".#+");
    assert_eq!(world.tiles()[2].kind, TileKind::Wall(Paint::Color(Rgb::new(0xa0, 0x40, 0x30))));
    assert_eq!(world.start().cell, Cell { column: 1, row: 1 });
    assert_eq!(world.start().heading.degrees(), 90.0);
    let [exit] = world.things() else { panic!("one thing") };
    assert_eq!((exit.kind, exit.cell), (ThingKind::Exit, Cell { column: 7, row: 3 }));
}

#[test]
fn one_cell_without_walls_or_an_exit_is_a_valid_map() {
    let world = map::parse_str("grid = '@'\nthings.'@'.start = -4.5e2").unwrap();
    assert_eq!((world.grid().width(), world.grid().height()), (1, 1));
    assert_eq!(world.start().heading.degrees(), 270.0);
    assert_eq!((world.title(), world.things()), ("", [].as_slice()));
}

#[test]
fn crlf_and_a_byte_order_mark_change_nothing() {
    let world = map::parse_str(VALID).unwrap();
    let other = format!("\u{feff}{}", VALID.replace('\n', "\r\n"));
    assert_eq!(map::parse_str(&other).unwrap(), world);
}

#[test]
fn unused_kinds_of_tiles_are_left_out() {
    let text = VALID.replace("[things]", "\"%\" = { wall = \"unused.png\" }\n[things]");
    assert_eq!(map::parse_str(&text).unwrap(), map::parse_str(VALID).unwrap());
}

#[test]
fn a_map_may_have_the_maximum_number_of_wall_kinds() {
    let characters: String = ('\u{4e00}'..).take(254).collect();
    let mut text = format!("grid = '{characters}@'\nthings.'@'.start = 0\n[tiles]\n");
    for wall in characters.chars() {
        text.extend(["'", wall.encode_utf8(&mut [0; 4]), "'.wall = 'sky'\n"]);
    }
    let world = map::parse_str(&text).unwrap();
    assert_eq!(drawn(&world), format!("{characters}."));
}

#[test]
fn the_built_in_levels_can_be_finished() {
    for level in builtin::LEVELS {
        let world = map::parse_str(level.text).unwrap();
        assert!(!world.title().is_empty(), "{}", level.name);
        assert!(exit_is_within_reach(&world), "{}", level.name);
    }
}

fn exit_is_within_reach(world: &World) -> bool {
    let mut reached = vec![world.start().cell];
    let mut next = 0;
    while let Some(&Cell { column, row }) = reached.get(next) {
        next += 1;
        for (east, south) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
            let (column, row) = (i64::from(column) + east, i64::from(row) + south);
            if world.grid().tile(column, row).is_none() {
                continue;
            }
            let cell = Cell { column: column as u32, row: row as u32 };
            // The reader would have rejected a map with unreachable keys.
            let open = !world.grid().is_solid(column, row) || world.door(cell).is_some();
            if open && !reached.contains(&cell) {
                reached.push(cell);
            }
        }
    }
    world
        .things()
        .iter()
        .any(|thing| thing.kind == ThingKind::Exit && reached.contains(&thing.cell))
}

#[test]
fn doors_keys_and_glass_match_the_map() {
    let world = map::parse_str(
        r##"
grid = '''
#######
#@+.k.#
#%###=#
#g....#
#######
'''
[tiles]
"#" = { wall = "brick" }
"+" = { door = "oak" }
"=" = { door = "#102030", key = "brass" }
"%" = { mask = "grate" }
"g" = { glass = "#80c0ff", opacity = 0.5 }
[things]
"@" = { start = 0 }
"k" = { key = "brass" }
"##,
    )
    .unwrap();
    let door = |column, row| world.door(Cell { column, row });
    assert_eq!(door(2, 1).unwrap().key, None);
    let lock = door(5, 2).unwrap();
    assert_eq!(lock.leaf, Paint::Color(Rgb::new(0x10, 0x20, 0x30)));
    assert_eq!(world.key_name(lock.key.unwrap()), "brass");
    assert_eq!(door(4, 1), None);
    let [key] = world.things() else { panic!("one thing") };
    assert_eq!(key.kind, ThingKind::Key(lock.key.unwrap()));
    let kind = |column, row| world.tile(world.grid().tile(column, row).unwrap()).kind;
    assert!(matches!(kind(1, 2), TileKind::Mask(_)));
    let glass = Glass { color: Rgb::new(0x80, 0xc0, 0xff), opacity: 128 };
    assert_eq!(kind(1, 3), TileKind::Glass(glass));
    assert_eq!(drawn(&world).replace('=', "+").matches('+').count(), 2);
}

/// Returns a picture of one red texel for every name, and records the names.
#[derive(Default)]
struct RedFiles {
    asked: RefCell<Vec<String>>,
}

impl TextureFiles for RedFiles {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        self.asked.borrow_mut().push(name.to_owned());
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 1, 1);
        encoder.set_color(png::ColorType::Rgb);
        let written = encoder.write_header().and_then(|mut png| png.write_image_data(&[255, 0, 0]));
        written.map_err(|error| TextureFileError::Unreadable(io::Error::other(error)))?;
        Ok(bytes)
    }
}

#[test]
fn a_texture_is_read_once_and_only_if_used() {
    let text = VALID
        .replace("\"brick\"", "\"a.png\"")
        .replace("\"#a04030\"", "\"a.png\"")
        .replace("\"sky\"", "\"b/c.PNG\"")
        .replace("[things]", "\"%\" = { wall = \"unused.png\" }\n[things]");
    let files = RedFiles::default();
    let world = map::parse(&text, "map", &files).unwrap();
    assert_eq!(files.asked.into_inner(), ["b/c.PNG", "a.png"]);
    let Ceiling::Covered(Covering { pattern: Pattern::Plain(paint), .. }) = world.ceiling() else {
        panic!("a ceiling of one texture")
    };
    assert_eq!(world.mean_color(paint), Rgb::new(255, 0, 0));
    assert_eq!(world.tiles()[1].kind, world.tiles()[2].kind);
}

/// A valid map with some bytes replaced, removed or repeated.
fn mutated_map() -> impl Strategy<Value = String> {
    let edit = (any::<prop::sample::Index>(), 0..12_usize, "[\\[\\]{}='\"#@.X\n\ta0é\\\\]{0,4}");
    prop::collection::vec(edit, 1..6).prop_map(|edits| {
        let mut characters: Vec<char> = VALID.chars().collect();
        for (place, length, replacement) in edits {
            let start = place.index(characters.len() + 1);
            let end = (start + length).min(characters.len());
            characters.splice(start..end, replacement.chars());
        }
        characters.into_iter().collect()
    })
}

/// Rows of equal width with one `@`.
fn rows() -> impl Strategy<Value = Vec<String>> {
    (1..12_usize, 1..12_usize)
        .prop_flat_map(|(width, height)| {
            let character = prop::sample::select(vec!['.', '#', '%', 'é', '壁', '\\']);
            let cells = prop::collection::vec(character, width * height);
            (Just(width), cells, any::<prop::sample::Index>())
        })
        .prop_map(|(width, mut cells, start)| {
            let start = start.index(cells.len());
            cells[start] = '@';
            cells.chunks(width).map(|row| row.iter().collect()).collect()
        })
}

proptest! {
    #[test]
    fn any_text_is_a_world_or_has_faults(text in any::<String>()) {
        if let Err(faults) = map::parse_str(&text) {
            prop_assert!(faults.len() > 0 && faults.to_string().starts_with("error: "));
        }
    }

    #[test]
    fn a_mutated_map_is_a_world_or_has_faults(text in mutated_map()) {
        if let Err(faults) = map::parse_str(&text) {
            prop_assert!(faults.len() > 0 && faults.to_string().starts_with("error: "));
        }
    }

    #[test]
    fn a_grid_reads_as_drawn(rows in rows()) {
        let grid = rows.join("\n");
        let text = format!(
            "grid = '''\n{grid}\n'''\nthings.'@'.start = 0\n\
             tiles = {{ '#'.wall = 'brick', '%'.wall = 'stone', 'é'.wall = 'sky', \
             '壁'.wall = '#000000', '\\'.wall = 'brick' }}"
        );
        let world = map::parse_str(&text).unwrap();
        prop_assert_eq!(drawn(&world), grid.replace('@', "."));
        let Cell { column, row } = world.start().cell;
        prop_assert_eq!(rows[row as usize].chars().nth(column as usize), Some('@'));
    }
}

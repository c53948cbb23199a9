//! Maps that were written to take long or to need much memory, and the bytes that reading them
//! takes.
//!
//! The tests assert bytes and not seconds, because every bounded step of the work also allocates,
//! or is counted against the limit itself.

use std::cell::Cell;

use allocation_counter::measure;
use cellcaster::fault::Faults;
use cellcaster::map::{self, Level, NoFiles, TextureFileError, TextureFiles};

/// The largest number of bytes that a map under 1 MB may need.
const SMALL_MAP: u64 = 256 << 20;
/// The largest number of bytes that any map may need.
const LARGE_MAP: u64 = 1 << 30;

/// Reads a map, and asserts that this needs at most `most` bytes at once.
#[track_caller]
fn read(text: &str, most: u64) -> Result<Level, Faults> {
    read_with(&NoFiles, text, most)
}

/// Reads a map as [`read`] does, with pictures from `files`.
#[track_caller]
fn read_with(files: &dyn TextureFiles, text: &str, most: u64) -> Result<Level, Faults> {
    let mut level = None;
    let needed = measure(|| level = Some(map::parse_level(text, "map", files)));
    let start: String = text.chars().take(20).collect();
    assert!(needed.bytes_max <= most, "{} bytes for {start:?}…", needed.bytes_max);
    level.unwrap()
}

/// `part` repeated up to `length` bytes.
fn repeated(part: &str, length: usize) -> String {
    part.repeat(length / part.len())
}

#[test]
fn text_of_many_tokens_is_refused_before_it_is_parsed() {
    let parts = ["=\n", "[", "a.", "a=1\n", "[[a]]\n", "sphere=[{},{},{}]\n", "'\n", "#\n", "\n"];
    for part in parts {
        assert!(read(&repeated(part, map::MAX_BYTES), LARGE_MAP).is_err(), "{part:?}");
        assert!(read(&repeated(part, 1_000_000), SMALL_MAP).is_err(), "{part:?}");
    }
    for (start, item, end) in [("a=[", "1,", "]"), ("sphere=[", "{},", "]"), ("a='", "#", "'")] {
        for (length, most) in [(map::MAX_BYTES - 10, LARGE_MAP), (1_000_000, SMALL_MAP)] {
            let text = [start, &repeated(item, length), end].concat();
            assert!(read(&text, most).is_err(), "{start:?}");
        }
    }
}

#[test]
fn the_fault_of_too_many_tokens_has_a_place() {
    let text = format!("title = 'Hall'\n{}", "k = 1\n".repeat(100_000));
    insta::assert_snapshot!(read(&text, SMALL_MAP).unwrap_err(), @r"
    error: a file may have at most 262144 TOML tokens
         --> map:43691:5
          |
    43691 | k = 1
          |     ^ this is one too many
          |
          = help: leave some definitions out; a string is one token, however long
    ");
}

/// A picture of the largest size under every name, and the number of times that it was read.
struct LargePictures {
    png: Vec<u8>,
    reads: Cell<u32>,
}

impl LargePictures {
    fn new() -> Self {
        let mut png = Vec::new();
        let mut encoder = png::Encoder::new(&mut png, 1024, 1024);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::One);
        encoder.write_header().unwrap().write_image_data(&vec![0; 1024 * 1024 / 8]).unwrap();
        Self { png, reads: Cell::new(0) }
    }
}

impl TextureFiles for LargePictures {
    fn read(&self, _: &str) -> Result<Vec<u8>, TextureFileError> {
        self.reads.set(self.reads.get() + 1);
        Ok(self.png.clone())
    }
}

/// The `count` characters from U+4E00 on, which are all letters.
fn characters(count: u32) -> impl Iterator<Item = char> {
    ('\u{4e00}'..).take(count as usize)
}

/// A map with one thing for each of `count` characters, defined as `definition` returns.
fn things(count: u32, definition: impl Fn(u32) -> String) -> String {
    let row: String = characters(count).collect();
    let defined =
        characters(count).zip(0..).map(|(it, index)| format!("{it:?} = {}\n", definition(index)));
    let definitions: String = defined.collect();
    format!("grid = \"@{row}\"\n[things]\n\"@\" = {{ start = 0 }}\n{definitions}")
}

#[test]
fn a_sheet_is_decoded_once_per_frame_count() {
    let files = LargePictures::new();
    let map = things(900, |index| {
        format!("{{ sprite = \"a.png\", frames = {}, reach = 2 }}", 1 << (index % 3))
    });
    assert!(read_with(&files, &map, SMALL_MAP).is_ok());
    assert_eq!(files.reads.get(), 3);
}

#[test]
fn the_total_number_of_texels_is_limited() {
    let files = LargePictures::new();
    let sheets = things(900, |index| format!("{{ sprite = \"{index}.png\" }}"));
    let faults = read_with(&files, &sheets, SMALL_MAP).unwrap_err();
    // After the first picture that is one too many, no picture is read.
    assert_eq!((faults.len(), files.reads.get()), (1, 17));
    insta::assert_snapshot!(faults.summary(), @r#"map:20: the sprite "16.png" is too much: the pictures of a map may have at most 16777216 texels and 64 MiB"#);
    let wall = |it| format!("{it:?} = {{ wall = \"{}.png\" }}", u32::from(it));
    let walls = characters(200).map(wall).collect::<Vec<_>>().join("\n");
    let row: String = characters(200).collect();
    let map = format!(
        "grid = \"@{row}\"\nfloor = \"0.png\"\n[things]\n\"@\" = {{ start = 0 }}\n[tiles]\n{walls}"
    );
    let faults = read_with(&files, &map, SMALL_MAP).unwrap_err();
    assert_eq!((faults.len(), files.reads.get()), (1, 2 * 17));
}

/// A dim map with `side` rows and columns of the lamp `lamp`, and one start.
fn lamps(side: usize, lamp: &str) -> String {
    let row = "l".repeat(side);
    let rows = vec![row.as_str(); side - 1].join("\n");
    format!(
        "light = 0.1\ngrid = '''\n@{}\n{rows}\n'''\n[things]\n\"@\" = {{ start = 0 }}\n\"l\" = {lamp}\n",
        &row[1..]
    )
}

#[test]
fn the_number_of_cells_lit_by_lamps_is_limited() {
    let lamp = r#"{ sprite = "lamp", light = 1, reach = 32 }"#;
    assert!(read(&lamps(100, lamp), SMALL_MAP).is_ok());
    insta::assert_snapshot!(read(&lamps(103, lamp), SMALL_MAP).unwrap_err(), @r#"
    error: the lamps of a map may light at most 33554432 cells, counted for each lamp
       --> map:109:1
        |
    109 | "l" = { sprite = "lamp", light = 1, reach = 32 }
        | ^^^ with these, they light more
        |
        = help: draw fewer lamps, or give them a shorter reach
    "#);
    let near = r#"{ sprite = "lamp", light = 1, reach = 1 }"#;
    assert!(read(&lamps(990, near), SMALL_MAP).is_ok());
    let kinds = |count| {
        things(count, |index| {
            format!(
                "{{ sprite = \"lamp\", light = 0.5, reach = {} }}",
                31.5 + f64::from(index) / 1e4
            )
        })
    };
    assert!(read(&format!("light = 0.1\n{}", kinds(300)), SMALL_MAP).is_ok());
    assert_eq!(read(&kinds(900), SMALL_MAP).unwrap_err().len(), 1);
}

#[test]
fn the_number_of_things_is_limited() {
    let map = lamps(1025, "{ treasure = 1 }");
    insta::assert_snapshot!(read(&map, SMALL_MAP).unwrap_err().summary(), @"map:2: the grid has 1050624 things, but at most 1048576 are allowed");
}

/// A map in which one switch moves `lifts` floors, and in which `spikes` spikes come out.
fn lifts_and_spikes(lifts: usize, spikes: usize) -> String {
    let (lifts, spikes) = ("m".repeat(lifts), "s".repeat(spikes));
    format!(
        "ceiling = 'sky'\ngrid = '@{lifts}{spikes}p'\n[tiles]\np.plate = 'a'\n\
         m = {{ moves_to = 1, switch = 'a' }}\n[things]\n'@'.start = 0\ns.spikes = 1\n"
    )
}

#[test]
fn the_number_of_cells_moved_by_one_step_is_limited() {
    assert!(read(&lifts_and_spikes(512, 512), SMALL_MAP).is_ok());
    insta::assert_snapshot!(read(&lifts_and_spikes(513, 0), SMALL_MAP).unwrap_err());
    insta::assert_snapshot!(read(&lifts_and_spikes(1, 513), SMALL_MAP).unwrap_err());
}

#[test]
fn the_search_for_keys_takes_a_few_bytes_for_each_cell() {
    const SIDE: usize = 990;
    let legend = "[tiles]\n\"+\" = { door = \"oak\", key = \"brass\" }\n\"#\" = { wall = \"brick\" }\n\
                  \"o\" = { pillar = \"brick\" }\n\"p\" = { plate = \"gate\" }\n\
                  \"g\" = { door = \"oak\", switch = \"gate\" }\n\
                  [things]\n\"@\" = { start = 0 }\n\"k\" = { key = \"brass\" }\n";
    for most_cells in ["o", "p", "."] {
        let row = most_cells.repeat(SIDE);
        let rows = vec![row.as_str(); SIDE - 5].join("\n");
        let (floor, wall) = (".".repeat(SIDE - 5), "#".repeat(SIDE - 3));
        let start = format!("@kp..{floor}\n#+#{wall}\n.....{floor}\n#g#{wall}\n.....{floor}");
        let map = format!("grid = '''\n{start}\n{rows}\n'''\n{legend}");
        let level = read(&map, 40 * (SIDE * SIDE) as u64);
        assert!(level.is_ok(), "{level:?}");
    }
}

/// A map of `count` spheres of radius 8, one every `apart` cells.
fn spheres(count: u32, apart: f64) -> String {
    let sphere = |number| {
        let x = 9.0 + f64::from(number) * apart;
        format!("{{ center = [{x}, 0, 0], radius = 8, color = '#fff000' }},")
    };
    let spheres: String = (0..count).map(sphere).collect();
    format!("start = {{ at = [0, 0, 0], heading = 0 }}\nsphere = [{spheres}]\nbox = []\n")
}

#[test]
fn the_number_of_bodies_is_limited() {
    assert!(read(&spheres(1000, 16.0), SMALL_MAP).is_ok());
    let faults = read(&spheres(1001, 16.0), SMALL_MAP).unwrap_err();
    insta::assert_snapshot!(faults.summary(), @"map:2: a map has 1000 bodies at most");
    // If there are more, only the first one that is one too many is reported.
    assert_eq!(read(&spheres(15_000, 16.0), SMALL_MAP).unwrap_err().len(), 1);
}

/// A ray is tested against all bodies in one place.
#[test]
fn the_number_of_bodies_in_one_place_is_limited() {
    for apart in [0.0, 1e-6, 0.1] {
        assert!(read(&spheres(141, apart), SMALL_MAP).is_ok());
        let faults = read(&spheres(142, apart), SMALL_MAP).unwrap_err();
        insta::allow_duplicates! {
            insta::assert_snapshot!(faults.summary(), @"map:2: more than 10000 pairs of bodies overlap");
        }
    }
    let planes = |count| {
        let planes = "{ height = -1, color = '#fff000' },".repeat(count);
        format!("start = {{ at = [0, 0, 0], heading = 0 }}\nplane = [{planes}]\n")
    };
    assert!(read(&planes(141), SMALL_MAP).is_ok());
    let faults = read(&planes(142), SMALL_MAP).unwrap_err();
    insta::assert_snapshot!(faults.summary(), @"map:2: more than 10000 pairs of bodies overlap");
}

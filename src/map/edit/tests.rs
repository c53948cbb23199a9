use std::fs;
use std::path::{Path, PathBuf};

use proptest::prelude::*;

use super::*;
use crate::map::{Folder, NoFiles};

/// Every map file with a grid that the program comes with, and that its tests read.
fn maps() -> Vec<PathBuf> {
    let folders = ["maps", "maps/gallery", "tests/maps", "tests/bad_maps"];
    let files = folders.into_iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten();
    let paths = files.map(|file| file.unwrap().path());
    let mut maps: Vec<_> =
        paths.filter(|path| path.extension().is_some_and(|it| it == "toml")).collect();
    maps.sort();
    maps
}

fn open(path: &Path) -> Option<MapDocument> {
    MapDocument::open(fs::read_to_string(path).ok()?, "map").ok()
}

fn document(text: &str) -> MapDocument {
    MapDocument::open(text.to_owned(), "map").unwrap()
}

fn cell(column: u32, row: u32) -> Cell {
    Cell { column, row }
}

/// The numbers of the lines of `old` that `new` lacks, and the lines that it adds.
fn changes<'a>(old: &str, new: &'a str) -> (Vec<usize>, Vec<&'a str>) {
    let lines = |text: &'a str| text.split_inclusive('\n').collect::<Vec<_>>();
    let new = lines(new);
    let gone = old.split_inclusive('\n').enumerate().filter(|(_, line)| !new.contains(line));
    let is_new = |line: &&str| !old.split_inclusive('\n').any(|known| known == *line);
    (gone.map(|(number, _)| number).collect(), new.iter().copied().filter(is_new).collect())
}

const GUARDED: &str = r##"# A level with comments.
title = "Yard"     # kept

# The plan:
grid = '''
#######
#@.g,X#
#..g,.#
#######
'''

[tiles]  # what stands
"#" = { wall = "brick" } # bricks
"," = { floor = "moss" }

# who walks
[things]
"@" = { start = 0 }
"X" = { exit = true, on = "," }
"g" = { guard = "warden", heading = 90 } # two of them
"##;

/// An operation of the editor.
#[derive(Clone, Debug)]
enum Operation {
    Draw(Vec<(u32, u32)>, usize, bool),
    Write((u32, u32), char),
    Erase((u32, u32)),
    /// Turns one of the things with a heading.
    Turn(usize, f64),
    Resize(u32, u32),
    Define(bool, char, &'static str),
    Set(&'static str, &'static str),
    Undo,
    Redo,
}

impl Operation {
    /// The largest number of lines that may change or go.
    fn lines(&self) -> usize {
        match self {
            // The cells, the earlier places of a thing, which a faulty map may have twice, and its definition.
            Self::Draw(cells, ..) => cells.len() + 4,
            Self::Write(..) | Self::Erase(_) | Self::Define(..) | Self::Set(..) => 1,
            Self::Turn(..) => 2,
            Self::Resize(..) | Self::Undo | Self::Redo => usize::MAX,
        }
    }
}

fn operation() -> impl Strategy<Value = Operation> {
    use Operation::{Define, Draw, Erase, Redo, Resize, Set, Turn, Undo, Write};
    let place = || (0_u32..70, 0_u32..50);
    let texts =
        prop::sample::select(vec!["wall = 'moss'", "key = \"brass\"", "floor = 3", "x", "a = [1]"]);
    let keys = prop::sample::select(vec![
        ("title", "'T'"),
        ("fog", "{ color = '#000000' }"),
        ("grid", "1"),
    ]);
    prop_oneof![
        4 => (prop::collection::vec(place(), 1..5), 0_usize..40, any::<bool>())
            .prop_map(|(cells, brush, joins)| Draw(cells, brush, joins)),
        2 => (place(), any::<char>()).prop_map(|(cell, character)| Write(cell, character)),
        2 => place().prop_map(Erase),
        4 => (0_usize..100, prop::sample::select(vec![45.0, -45.0, 7.5])).prop_map(|(at, by)| Turn(at, by)),
        1 => (0_u32..80, 0_u32..60).prop_map(|(columns, rows)| Resize(columns, rows)),
        2 => (any::<bool>(), any::<char>(), texts).prop_map(|(thing, it, text)| Define(thing, it, text)),
        1 => keys.prop_map(|(key, value)| Set(key, value)),
        2 => Just(Undo),
        1 => Just(Redo),
    ]
}

/// Carries out `operation`, which may not be possible.
fn carry_out(map: &mut MapDocument, operation: &Operation) {
    let at = |&(column, row): &(u32, u32)| cell(column, row);
    let brushes: Vec<char> =
        ['.', ' '].into_iter().chain(map.definitions().iter().map(|it| it.character)).collect();
    _ = match operation {
        Operation::Draw(cells, brush, joins) => {
            let cells: Vec<Cell> = cells.iter().map(at).collect();
            map.draw(&cells, brushes[brush % brushes.len()], *joins).is_ok()
        }
        Operation::Write(cell, character) => map.write(&[(at(cell), *character)], false).is_ok(),
        Operation::Erase(cell) => map.erase(&[at(cell)]).is_ok(),
        Operation::Turn(index, degrees) => {
            let turned = map.definitions().iter().filter(|it| it.heading().is_some());
            let cells: Vec<Cell> = turned.flat_map(|it| map.map.cells_of(it.character)).collect();
            !cells.is_empty() && map.turn(cells[index % cells.len()], *degrees).is_ok()
        }
        Operation::Resize(columns, rows) => map.resize(*columns, *rows).is_ok(),
        Operation::Define(is_thing, character, text) => {
            map.define(*is_thing, *character, text).is_ok()
        }
        Operation::Set(key, value) => map.set(key, value).is_ok(),
        Operation::Undo => map.undo().is_some(),
        Operation::Redo => map.redo().is_some(),
    };
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// After any operations, the text can be opened, every step can be undone down to the bytes of the file,
    /// and every step can be done again.
    #[test]
    fn any_operations_can_be_undone_and_done_again(
        which in any::<prop::sample::Index>(),
        windows in any::<bool>(),
        operations in prop::collection::vec(operation(), 1..30),
    ) {
        let maps = maps();
        let Some(map) = open(&maps[which.index(maps.len())]) else { return Ok(()) };
        let text = if windows { map.text().replace("\r\n", "\n").replace('\n', "\r\n") } else { map.text().to_owned() };
        let Ok(mut map) = MapDocument::open(text.clone(), "map") else { return Ok(()) };
        for operation in &operations {
            let before = map.text().to_owned();
            carry_out(&mut map, operation);
            let (gone, _) = changes(&before, map.text());
            prop_assert!(gone.len() <= operation.lines(), "{:?}: {:?}", operation, gone);
            prop_assert!(MapDocument::open(map.text().to_owned(), "map").is_ok());
            if windows {
                prop_assert!(!map.text().replace("\r\n", "").contains('\n'));
            }
        }
        let mut later = vec![map.text().to_owned()];
        while map.undo().is_some() {
            later.push(map.text().to_owned());
        }
        prop_assert_eq!(map.text(), &text);
        later.pop();
        while let Some(next) = later.pop() {
            prop_assert!(map.redo().is_some());
            prop_assert_eq!(map.text(), next);
        }
    }
}

#[test]
fn a_cell_changes_its_line_only_in_every_map() {
    let mut drawn = 0;
    for path in maps() {
        let Some(mut map) = open(&path) else { continue };
        let (columns, rows) = map.size();
        let text = map.text().to_owned();
        let there = map.character(cell(columns / 2, rows / 2));
        let other = if there == Some('.') { ' ' } else { '.' };
        map.draw(&[cell(columns / 2, rows / 2)], other, false).unwrap();
        let differing =
            text.lines().zip(map.text().lines()).filter(|(old, new)| old != new).count();
        assert_eq!(differing, 1, "{}", path.display());
        assert_eq!(text.chars().count(), map.text().chars().count(), "{}", path.display());
        drawn += 1;
    }
    assert!(drawn > 40, "only {drawn} maps were opened");
}

/// A thing that is drawn once is turned by one value in its definition. Nothing else changes in any level, and the level
/// stays valid.
#[test]
fn turning_the_start_of_any_level_changes_one_value() {
    let levels = maps().into_iter().filter(|path| path.starts_with("maps"));
    for path in levels {
        let Some(mut map) = open(&path) else { continue };
        let (text, name) = (map.text().to_owned(), path.display().to_string());
        let is_start = |it: &&Definition| it.properties.contains_key("start");
        let start = map.definitions().iter().find(is_start).unwrap().character;
        let at = map.map.cells_of(start).next().unwrap();
        map.turn(at, 45.0).unwrap_or_else(|error| panic!("{name}: {error}"));
        let (gone, added) = changes(&text, map.text());
        assert_eq!((gone.len(), added.len()), (1, 1), "{name}");
        let files = Folder::of(&path);
        let before = crate::map::parse(&text, &name, &files).unwrap().start();
        let after = crate::map::parse(map.text(), &name, &files).unwrap().start();
        assert_eq!(after.cell, before.cell);
        let turned = (before.heading.degrees() + 45.0) % 360.0;
        assert!((after.heading.degrees() - turned).abs() < 1e-6, "{name}");
    }
}

#[test]
fn a_thing_that_shares_its_character_is_turned_alone() {
    let mut map = document(GUARDED);
    assert_eq!(map.turn(cell(3, 1), 90.0), Ok(180.0));
    let (gone, added) = changes(GUARDED, map.text());
    assert_eq!(gone.len(), 1);
    assert_eq!(added, ["#@.G,X#\n", "\"G\" = { guard = \"warden\", heading = 180 }\n"]);
    // The other one is alone with its character now, and turns back into what exists already.
    assert_eq!(map.turn(cell(3, 2), 90.0), Ok(180.0));
    assert!(map.text().contains("\"g\" = { guard = \"warden\", heading = 180 } # two of them\n"));
    crate::map::parse(map.text(), "map", &NoFiles).unwrap();
}

#[test]
fn things_without_a_heading_are_not_turned() {
    let mut map = document(GUARDED);
    for cell in [cell(5, 1), cell(0, 0), cell(2, 1), cell(60, 60)] {
        assert!(map.turn(cell, 90.0).is_err());
    }
    assert_eq!(map.text(), GUARDED);
}

#[test]
fn a_thing_keeps_the_floor_on_which_it_is_drawn() {
    let mut map = document(GUARDED);
    map.draw(&[cell(4, 1)], 'g', false).unwrap();
    assert_eq!(map.rows().nth(1), Some("#@.gGX#"));
    assert_eq!(map.definition('G').unwrap().text, r#"guard = "warden", heading = 90, on = ",""#);
    map.erase(&[cell(4, 1), cell(3, 1), cell(5, 1), cell(0, 1)]).unwrap();
    assert_eq!(map.rows().nth(1), Some(".@..,,#"));
}

#[test]
fn a_thing_that_a_map_draws_once_moves() {
    let mut map = document(GUARDED);
    map.draw(&[cell(2, 2), cell(4, 2)], '@', false).unwrap();
    assert_eq!(map.rows().collect::<Vec<_>>()[1..3], ["#..g,X#", "#..g@.#"]);
    let (_, added) = changes(GUARDED, map.text());
    assert!(added.contains(&"\"@\" = { start = 0, on = \",\" }\n"), "{added:?}");
    map.draw(&[cell(1, 1)], '@', false).unwrap();
    assert_eq!(map.text(), GUARDED);
}

#[test]
fn waypoints_move_as_the_start_does() {
    let text = GUARDED.replace("#..g,.#", "#..1,.#").replace("heading = 90", "patrol = '1'");
    let mut map = document(&format!("{text}1 = {{ waypoint = true }}\n"));
    map.draw(&[cell(1, 2)], '1', false).unwrap();
    assert_eq!(map.rows().nth(2), Some("#1..,.#"));
    // A guard on a patrol of their own is drawn once, too.
    map.define(true, 'g', "guard = 'hound', patrol = '1g'").unwrap();
    map.draw(&[cell(2, 2)], 'g', false).unwrap();
    assert_eq!(map.rows().collect::<Vec<_>>()[1..3], ["#@..,X#", "#1g.,.#"]);
}

#[test]
fn definitions_keep_the_way_in_which_they_are_written() {
    let grid = "grid = '''\n@k.\n'''\n";
    for (before, after) in [
        ("[things]\n'@'.start = 0\nk={key='a'}", "[things]\n'@'.start = 90\nk={key='a'}"),
        (
            "things = { '@' = { start = 0 }, k = { key = 'a' } }",
            "things = { '@' = { start = 90 }, k = { key = 'a' } }",
        ),
        (
            "[things.'@'] # who\nstart = 0 # east\n\n[things.k]\nkey = 'a'",
            "[things.'@'] # who\nstart = 90 # east\n\n[things.k]\nkey = 'a'",
        ),
        (
            "[things]\n'@' = {start=0} # east\n  k   =  { key = 'a' }\n",
            "[things]\n'@' = {start=90} # east\n  k   =  { key = 'a' }\n",
        ),
    ] {
        let mut map = document(&format!("{grid}{before}"));
        map.turn(cell(0, 0), 90.0).unwrap();
        assert_eq!(map.text(), format!("{grid}{after}"));
        // Another definition is added after the others, wherever these are.
        map.define(true, 'w', "guard = 'hound'").unwrap();
        assert_eq!(map.definitions().len(), 3, "{}", map.text());
        assert!(map.text().starts_with(grid));
        map.define(true, '@', "start = 180").unwrap();
        assert_eq!(map.definition('@').unwrap().text, "start = 180", "{}", map.text());
        assert_eq!(map.definition('k').unwrap().text, "key = 'a'");
        let comments = map.text().matches('#').count();
        assert_eq!(comments, before.matches('#').count().min(comments + 1), "{}", map.text());
    }
}

#[test]
fn a_grid_grows_and_shrinks_in_the_east_and_in_the_south() {
    let mut map = document(GUARDED);
    map.resize(9, 5).unwrap();
    assert_eq!(
        changes(GUARDED, map.text()).1,
        ["#######..\n", "#@.g,X#..\n", "#..g,.#..\n", "#######..\n", ".........\n"]
    );
    assert!(map.text().ends_with(&GUARDED[GUARDED.find("'''\n\n[tiles]").unwrap()..]));
    map.resize(7, 4).unwrap();
    assert_eq!(map.text(), GUARDED);
    map.resize(2, 2).unwrap();
    assert_eq!(map.rows().collect::<Vec<_>>(), ["##", "#@"]);
    assert!(map.resize(0, 4).is_err() && map.resize(5000, 4).is_err());
    // A grid on one line has no second row.
    assert!(document("grid = '#@#'").resize(3, 2).is_err());
}

#[test]
fn a_short_row_is_filled_up_to_the_cell() {
    let mut map = document("grid = '''\n####\n#\n'''");
    map.draw(&[cell(3, 1)], '#', false).unwrap();
    assert_eq!(map.rows().collect::<Vec<_>>(), ["####", "#..#"]);
}

#[test]
fn characters_that_end_the_grid_are_not_written() {
    let mut map = document("grid = '''\n#''.\n'''");
    assert!(map.write(&[(cell(3, 0), '\'')], false).is_err());
    assert!(map.write(&[(cell(0, 0), '\n')], false).is_err());
    assert!(map.write(&[(cell(0, 0), '\u{1b}')], false).is_err());
    let mut quoted = document("grid = \"#.\"");
    assert!(quoted.write(&[(cell(1, 0), '"')], false).is_err());
    assert_eq!(quoted.text(), "grid = \"#.\"");
}

#[test]
fn a_drag_is_one_step() {
    let mut map = document(GUARDED);
    for (column, joins) in [(1, false), (2, true), (3, true)] {
        map.draw(&[cell(column, 2)], '#', joins).unwrap();
    }
    assert_eq!(map.undo(), Some(HistoryStep { cell: Some(cell(1, 2)) }));
    assert_eq!(map.text(), GUARDED);
    assert_eq!(map.undo(), None);
    map.redo();
    assert_eq!(map.rows().nth(2), Some("####,.#"));
}

#[test]
fn keys_of_the_map_are_set_where_they_are() {
    let mut map = document(GUARDED);
    map.set("title", "'Court'").unwrap();
    map.set("light", "0.5").unwrap();
    assert_eq!(changes(GUARDED, map.text()).1, ["title = 'Court'     # kept\n", "light = 0.5\n"]);
    assert_eq!(map.value("light").as_deref(), Some("0.5"));
    assert!(map.set("titel", "'x'").unwrap_err().contains("title"));
    assert!(map.set("title", "oak").is_err() && map.set("grid", "'#'").is_err());
    crate::map::parse(map.text(), "map", &NoFiles).unwrap();
}

#[test]
fn texts_without_a_grid_are_not_opened() {
    for text in
        ["", "grid = 3", "grid = \"\"", "grid = \"#\\u0023\"", "grid = '#", "[[sphere]]", "a = ="]
    {
        assert!(MapDocument::open(text.to_owned(), "map").is_err(), "{text}");
    }
}

/// A map with faults is opened, and the faults are found in cells.
#[test]
fn faults_have_cells() {
    let text = GUARDED.replace("#..g,.#", "#.?g,.").replace("90", "'x'");
    let map = document(&text);
    let faults = crate::map::parse(&text, "map", &NoFiles).unwrap_err();
    let cells: Vec<_> = faults.iter().map(|fault| map.cells_at(fault.place().unwrap())).collect();
    let guards = vec![cell(3, 1), cell(3, 2)];
    assert!(cells.contains(&vec![cell(6, 2)]) && cells.contains(&guards), "{faults} {cells:?}");
    assert!(cells.contains(&vec![cell(2, 2)]), "{faults} {cells:?}");
}

/// Some editors begin a file with a byte order mark. It stays.
#[test]
fn a_byte_order_mark_stays() {
    let mut map = document(&format!("\u{feff}{GUARDED}"));
    map.draw(&[cell(2, 2)], '#', false).unwrap();
    map.turn(cell(1, 1), 90.0).unwrap();
    assert!(map.text().starts_with("\u{feff}# A level"), "{}", map.text());
    assert!(map.text().contains("{ start = 90 }"));
}

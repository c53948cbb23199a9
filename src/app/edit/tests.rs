use std::env;
use std::fs;
use std::path::PathBuf;

use ratatui::buffer::Buffer;
use ratatui::style::Color;

use super::*;
use crate::color::palette::ColorDepth;
use crate::terminal::{Key, KeyEvent, Modifiers, MouseButton, MouseEvent, MouseEventKind, Phase};

const MAP: &str = r##"title = "Yard" # kept
grid = """
########
#@.....#
#....X.#
########
"""

[tiles]
"#" = { wall = "brick" }
"," = { floor = "moss" }
[things]
"@" = { start = 0 }
"X" = { exit = true }
"g" = { guard = "warden", heading = 90 }
"##;

/// An editor with a window of 80 by 24 cells.
struct Rig {
    editor: Editor,
    path: PathBuf,
}

impl Rig {
    /// An editor of a new file with this text, in a folder of its own.
    fn new(name: &str, text: Option<&str>) -> Self {
        let folder =
            env::temp_dir().join(format!("cellcaster-editor-{name}-{}", std::process::id()));
        _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("yard.toml");
        if let Some(text) = text {
            fs::write(&path, text).unwrap();
        }
        Self { editor: Editor::open(&path).unwrap(), path }
    }

    /// The same file in an editor that starts again, after the first one was killed.
    fn again(self) -> Self {
        Self { editor: Editor::open(&self.path).unwrap(), path: self.path }
    }

    /// Types `text`. `\n` is Enter, `\t` Tab, and `\x1b` Escape.
    fn types(&mut self, text: &str) -> &mut Self {
        for character in text.chars() {
            let key = match character {
                '\n' => Key::Enter,
                '\t' => Key::Tab,
                '\x1b' => Key::Escape,
                _ => Key::typing(character),
            };
            let modifiers = Modifiers { shift: character.is_uppercase(), ..Modifiers::default() };
            self.editor.key(KeyEvent { key, base: None, modifiers, phase: Phase::Press });
        }
        self
    }

    fn press(&mut self, key: Key, modifiers: Modifiers) -> &mut Self {
        self.editor.key(KeyEvent { key, base: None, modifiers, phase: Phase::Press });
        self
    }

    /// A mouse event at a cell of the plan.
    fn mouse(&mut self, kind: MouseEventKind, (column, row): (u16, u16)) -> &mut Self {
        let PlanArea { area, cell_width, .. } = self.editor.screen.plan;
        let units = |cell: u16| u32::from(cell) * MouseEvent::UNITS_PER_CELL + 1;
        let (x, y) = (units(area.x + column * cell_width), units(area.y + row));
        self.editor.mouse(MouseEvent { x, y, kind });
        self
    }

    fn draw(&mut self) -> Buffer {
        self.draw_at(ColorDepth::Indexed256, (80, 24))
    }

    fn draw_at(&mut self, depth: ColorDepth, (columns, rows): (u16, u16)) -> Buffer {
        let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
        let settings = Settings { depth: Some(depth), ..Settings::default() };
        self.editor.check();
        self.editor.draw(&mut buffer, &settings, &TerminalLook::default());
        buffer
    }

    fn text(&mut self) -> String {
        let buffer = self.draw();
        let rows = buffer.content.chunks(80);
        rows.map(|row| row.iter().map(ratatui::buffer::Cell::symbol).collect::<String>() + "\n")
            .collect()
    }

    fn rows(&self) -> Vec<&str> {
        self.editor.document.rows().collect()
    }

    /// The background of a cell of the plan.
    fn ground(&mut self, (column, row): (u16, u16)) -> Color {
        let buffer = self.draw();
        let PlanArea { area, cell_width, .. } = self.editor.screen.plan;
        buffer[(area.x + column * cell_width, area.y + row)].bg
    }

    /// Leaves without writing the file, and removes the folder.
    fn leave(mut self) {
        self.types(":q!\n");
        assert!(self.editor.has_left && !self.journal().exists());
        fs::remove_dir_all(self.path.parent().unwrap()).unwrap();
    }

    fn journal(&self) -> PathBuf {
        self.path.with_file_name("yard.toml.journal")
    }

    fn file(&self) -> String {
        fs::read_to_string(&self.path).unwrap()
    }
}

#[test]
fn keys_of_vi_draw_erase_copy_and_undo() {
    let mut rig = Rig::new("keys", Some(MAP));
    rig.types("llr#");
    assert_eq!(rig.rows()[1], "#@.#...#");
    rig.types("l ").press(Key::Right, Modifiers::default()).types("\n");
    assert_eq!(rig.rows()[1], "#@.###.#");
    rig.types("hhx");
    assert_eq!(rig.rows()[1], "#@..##.#");
    rig.types("uuuu");
    assert_eq!(rig.editor.document.text(), MAP);
    let control = Modifiers { control: true, ..Modifiers::default() };
    rig.press(Key::Char('r'), control);
    assert_eq!(rig.rows()[1], "#@.#...#");
    // A rectangle of a wall and floor, copied two rows below itself.
    rig.types("0vjly").types("l$hhhp");
    assert_eq!(rig.rows()[1..3], ["#@.##@.#", "#...#..#"]);
    rig.leave();
}

#[test]
fn faults_are_marked_in_the_plan_and_said_below_it() {
    let mut rig = Rig::new("faults", Some(MAP));
    assert!(rig.text().contains("no faults"));
    let sound = rig.ground((3, 2));
    rig.types("jllr?h");
    let text = rig.text();
    assert!(text.contains("'?' is not defined"), "{text}");
    assert_ne!(rig.ground((3, 2)), sound);
    // The exit is hidden from the fault by nothing: the view still shows the map before it.
    assert!(text.contains("before the faults"), "{text}");
    rig.types("t");
    assert!(rig.text().contains("the map has faults") && rig.editor.test.take().is_none());
    rig.types("kn");
    assert_eq!(rig.editor.cursor, Cell { column: 3, row: 2 });
    rig.types(":tile ? wall = \"moss\"\n");
    assert!(rig.text().contains("no faults"), "{}", rig.text());
    rig.leave();
}

#[test]
fn a_test_begins_at_the_cursor_with_the_heading_of_the_view() {
    let mut rig = Rig::new("test", Some(MAP));
    rig.types("jll>>t");
    let game = rig.editor.test.take().unwrap();
    let camera = game.camera(crate::world::FieldOfView::default());
    assert_eq!((camera.position().x, camera.position().y), (3.5, 2.5));
    assert!((camera.heading.degrees() - 90.0).abs() < 1e-9);
    rig.types("0t");
    assert!(rig.editor.test.take().is_none());
    assert!(rig.text().contains("no room here"));
    assert_eq!(rig.editor.document.text(), MAP);
    rig.types(":q\n");
    assert!(rig.editor.has_left);
    rig.leave();
}

#[test]
fn changes_outlive_a_kill_and_are_offered() {
    let mut rig = Rig::new("kill", Some(MAP));
    rig.types("llr#");
    assert_eq!(rig.file(), MAP);
    let mut rig = rig.again();
    assert!(rig.text().contains("Restore the changes"));
    rig.types("\x1b");
    assert!(rig.editor.has_left && rig.journal().exists(), "leaving it alone keeps it");

    let mut rig = rig.again();
    rig.types("\n");
    assert_eq!(rig.rows()[1], "#@.#...#");
    assert!(rig.journal().exists());
    rig.types("u");
    assert_eq!(rig.editor.document.text(), MAP);
    let control = Modifiers { control: true, ..Modifiers::default() };
    rig.press(Key::Char('r'), control).types(":w\n");
    assert_eq!(rig.file(), MAP.replace("#@.....#", "#@.#...#"));
    assert!(!rig.journal().exists());
    rig.types(":q\n");
    assert!(rig.editor.has_left);
    rig.leave();
}

#[test]
fn discarded_changes_are_gone() {
    let mut rig = Rig::new("discard", Some(MAP));
    rig.types("llr#");
    let mut rig = rig.again();
    rig.types("j\n");
    assert!(!rig.journal().exists() && rig.editor.document.text() == MAP);
    rig.types("x:q\n");
    let text = rig.text();
    assert!(text.contains("unsaved changes") && text.contains("> Go on editing"), "{text}");
    rig.types("\n");
    assert!(!rig.editor.has_left && rig.journal().exists());
    rig.types(":q\n3");
    assert!(rig.editor.has_left && !rig.journal().exists());
    assert_eq!(rig.file(), MAP);
    rig.leave();
}

#[test]
fn a_file_is_written_byte_for_byte_without_changes_and_not_over_others() {
    let mut rig = Rig::new("write", Some(MAP));
    rig.types(":w\n");
    assert_eq!(rig.file(), MAP);
    fs::write(&rig.path, "grid = '#'").unwrap();
    rig.types("x:w\n");
    assert!(rig.text().contains("another program has changed the file"));
    assert_eq!(rig.file(), "grid = '#'");
    rig.types(":w!\n:q\n");
    assert!(rig.editor.has_left);
    rig.leave();
}

#[test]
fn a_missing_file_begins_as_a_small_level() {
    let mut rig = Rig::new("new", None);
    let text = rig.text();
    assert!(text.contains("a new level") && text.contains("no faults"), "{text}");
    assert!(!rig.path.exists() && !rig.journal().exists());
    rig.types(":wq\n");
    assert!(rig.editor.has_left);
    assert_eq!(map::load(&rig.path).unwrap().title(), "yard");
}

#[test]
fn things_are_turned_with_the_view() {
    let mut rig = Rig::new("turn", Some(MAP));
    rig.types(">");
    assert!(rig.editor.document.text().contains("\"@\" = { start = 45 }\n"));
    assert_eq!(rig.editor.heading, 45.0);
    rig.types("l<<");
    assert_eq!(rig.editor.heading, 315.0);
    assert!(rig.editor.document.text().contains("\"@\" = { start = 45 }\n"));
    rig.leave();
}

#[test]
fn the_mouse_moves_the_cursor_and_draws() {
    let mut rig = Rig::new("mouse", Some(MAP));
    rig.draw();
    rig.types("\t\t\t");
    let left = MouseEventKind::Pressed(MouseButton::Left);
    rig.types("r#").types("u");
    rig.mouse(left, (2, 1)).mouse(MouseEventKind::Released, (2, 1));
    assert_eq!(rig.editor.cursor, Cell { column: 2, row: 1 });
    assert_eq!(rig.editor.document.text(), MAP);
    rig.mouse(left, (2, 2))
        .mouse(MouseEventKind::Moved, (3, 2))
        .mouse(MouseEventKind::Moved, (5, 2));
    rig.mouse(MouseEventKind::Released, (5, 2)).mouse(MouseEventKind::Moved, (6, 1));
    assert_eq!(rig.rows()[1..3], ["#@.....#", "#.####.#"]);
    rig.types("u");
    assert_eq!(rig.editor.document.text(), MAP);
    let right = MouseEventKind::Pressed(MouseButton::Right);
    rig.mouse(right, (5, 2));
    assert_eq!(rig.editor.brush, 'X');
    rig.leave();
}

#[test]
fn definitions_are_opened_to_be_changed() {
    let mut rig = Rig::new("define", Some(MAP));
    rig.types(":thing g\n");
    assert!(rig.text().contains(":thing g guard = \"warden\", heading = 90"));
    rig.types(", asleep = true\n");
    assert!(rig.editor.document.text().contains("heading = 90, asleep = true }"));
    assert_eq!(rig.editor.brush, 'g');
    rig.types("e").press(Key::Backspace, Modifiers::default()).types("270\n");
    assert!(rig.editor.document.text().contains("start = 270"));
    rig.types(":set title\n");
    assert!(rig.text().contains(":set title = \"Yard\""));
    rig.press(Key::Escape, Modifiers::default()).types(":set light = 0.5\n:size 10x5\n");
    assert_eq!(rig.rows()[4], "..........");
    for (wrong, sentence) in [
        ("tile", "write a character"),
        ("tile # oak", "is not TOML"),
        ("thing # key = 'a'", "is a tile already"),
        ("set titel = 1", "titel"),
        ("size 3", "columns and the rows"),
        ("z", "there is no command z"),
    ] {
        rig.types(&format!(":{wrong}\n"));
        let text = rig.text();
        assert!(text.contains(sentence), "{wrong}: {text}");
    }
    rig.leave();
}

/// No key, click, map or size of the window causes a panic.
#[test]
fn every_level_is_drawn_at_every_size_and_depth() {
    let levels = ["maps", "maps/gallery", "tests/bad_maps"]
        .into_iter()
        .flat_map(|folder| fs::read_dir(folder).unwrap());
    let mut opened = 0;
    for path in levels.map(|entry| entry.unwrap().path()) {
        let Ok(editor) = Editor::open(&path) else { continue };
        let mut rig = Rig { editor, path: PathBuf::new() };
        opened += 1;
        for (depth, size) in [
            (ColorDepth::True, (80, 24)),
            (ColorDepth::Indexed16, (61, 7)),
            (ColorDepth::Mono, (200, 60)),
            (ColorDepth::Indexed256, (20, 6)),
            (ColorDepth::True, (1, 1)),
        ] {
            rig.types("$jjk0ll").draw_at(depth, size);
        }
    }
    assert!(opened > 40, "{opened}");
}

/// Escape leads from a test back to the editor without a question, and so do the panels after its end.
#[test]
fn a_test_leads_back_to_the_editor() {
    let mut rig = Rig::new("trial", Some(MAP));
    rig.types("jllllt");
    let trial_of =
        |game| trial(game, &Settings::default(), Store::in_memory(), &Detection::default());
    let mut app = trial_of(rig.editor.test.take().unwrap());
    app.advance(Duration::from_secs(1));
    assert_eq!(app.pages.menu.heading().next(), Some("you found the way out"));
    let entries: Vec<String> = app.pages.menu.lines_of_entries().collect();
    assert_eq!(entries, ["Play it again", "Back to the editor"]);

    for key in [Key::Escape, Key::Char('q')] {
        rig.types("ht");
        let mut app = trial_of(rig.editor.test.take().unwrap());
        app.advance(Duration::from_secs(1));
        assert!(!app.has_left);
        let (base, modifiers, phase) = (None, Modifiers::default(), Phase::Press);
        app.key(KeyEvent { key, base, modifiers, phase }, Duration::from_secs(2));
        assert!(app.has_left);
    }
    rig.leave();
}

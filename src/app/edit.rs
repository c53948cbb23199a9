//! The editor of map files: a plan and the first-person view side by side.
//!
//! The plan is the minimap with the characters of the grid over it. After each change the map is read as `check` reads it.
//! While it has faults, the last map without faults stays in the background of the plan and in the view, and the cells of
//! the faults are marked. The text itself, with every step back, is a [`MapDocument`].
//!
//! An [`Editor`] contains neither a terminal nor a clock, so tests send it keys and look at its cells. [`edit`] is its loop.
//!
//! - The keys are vi's where vi has one: `hjkl`, `x`, `r`, `v`, `y`, `p`, `u`, `Ctrl-R`, `:w`, `:q`.
//! - The unsaved text is in the journal before the screen shows it. The end of the program by a signal therefore loses
//!   nothing, and the next start offers it.
//! - A test is a whole game, which begins at the cursor. `Escape` leads back.

mod draw;
pub mod file;
mod keys;
mod plan;

use std::collections::BTreeSet;
use std::mem;
use std::path::Path;
use std::time::Duration;

use ratatui::layout::Rect;

use crate::app::App;
use crate::app::detection::Detection;
use crate::app::levels::Levels;
use crate::app::page::{Menu, Page, PageKind, Pages};
use crate::app::picture::TerminalLook;
use crate::app::played::Goal;
use crate::app::run::{InitialState, enter};
use crate::app::settings::Settings;
use crate::app::store::Store;
use crate::fault::{Faults, printable_path};
use crate::game::{Game, Rules, is_exit_out_of_reach};
use crate::map::edit::MapDocument;
use crate::map::{self, Folder};
use crate::sort;
use crate::terminal::{Error, Event};
use crate::tui::View;
use crate::world::{Cell, Difficulty, Heading, Start, World};
use file::MapFile;
use keys::CommandLine;
use plan::PlanArea;

/// Shows `editor` on the terminal until the user leaves it. Returns a sentence about unsaved changes if the program was
/// ended from outside.
///
/// # Errors
/// If there is no terminal, or if it fails.
pub fn edit(mut editor: Editor, settings: Settings, store: Store) -> Result<Option<String>, Error> {
    let mut settings = settings.preferring(&store.preferences());
    let (mut session, mut detection) = enter(&settings, None)?;
    let given_glyphs = settings.given.glyphs.is_some() || store.preferences().glyphs.is_some();
    let mut store = Some(store);
    loop {
        if let Some(game) = editor.test.take() {
            let mut app = trial(game, &settings, store.take().unwrap_or_default(), &detection);
            let must_end = app.run(&mut session)?;
            detection = mem::take(&mut app.detection);
            store = Some(mem::take(&mut app.store));
            if must_end {
                return Ok(editor.unsaved_sentence());
            }
            editor.is_stale = true;
        }
        if editor.has_left {
            return Ok(None);
        }
        session.set_mouse(true)?;
        let protocol = session.protocol();
        let look = TerminalLook { glyphs: session.glyph_support(), ..TerminalLook::of(protocol) };
        if !given_glyphs && settings.glyphs.has_blocks() {
            settings.glyphs = look.glyphs;
        }
        let is_settled = protocol.is_settled();
        if (editor.is_stale || !is_settled) && session.is_ready() {
            if editor.is_stale {
                editor.check();
                session.draw(|screen| editor.draw(screen, &settings, &look))?;
            } else {
                session.refine()?;
            }
        }
        // A frame that is not exact yet is refined at the usual rate.
        let timeout = (!session.protocol().is_settled()).then_some(settings.frame_time);
        match session.next_event(timeout)? {
            None
            | Some(Event::Ready | Event::FocusGained | Event::FocusLost | Event::TmuxTold(_)) => {}
            Some(Event::Key(event)) => editor.key(event),
            Some(Event::Mouse(event)) => editor.mouse(event),
            Some(Event::Resized | Event::ColorDepth(_) | Event::Identified) => {
                editor.is_stale = true;
            }
            Some(Event::KeyReleases(reported)) => detection.reports_releases = Some(reported),
            Some(Event::Suspend) => {
                session.suspend()?;
                editor.is_stale = true;
            }
            Some(Event::Quit(_)) => return Ok(editor.unsaved_sentence()),
        }
    }
}

/// A game that tests the map.
fn trial(game: Game, settings: &Settings, store: Store, detection: &Detection) -> App {
    let levels = Box::new(Levels::trial(game));
    let mut app = App::opened(InitialState::Levels(levels), settings.clone(), store);
    app.notice = Some(Goal::new("Esc returns to the editor", "Esc returns"));
    if let Some(reported) = detection.reports_releases {
        app.releases_reported(reported);
    }
    app.detection = detection.clone();
    app
}

/// The state of the editor.
#[derive(Debug)]
pub struct Editor {
    document: MapDocument,
    file: MapFile,
    /// The text of the file, or of a new level.
    base: String,
    /// The map as faults call it.
    name: String,
    cursor: Cell,
    /// The direction of the view, in degrees.
    heading: f64,
    /// The character that is drawn.
    brush: char,
    /// The corner of the selection opposite the cursor.
    anchor: Option<Cell>,
    /// The copied rows of characters.
    copied: Vec<Vec<char>>,
    /// `true` while the next key is the character to draw.
    awaits_character: bool,
    command: Option<CommandLine>,
    message: Option<Message>,
    pages: Pages<EditorPage, Choice>,
    check: Check,
    /// The cell that the pressed mouse button has reached, and whether it has drawn.
    drag: Option<(Cell, bool)>,
    screen: ScreenParts,
    view: View,
    /// The text of the journal that is offered.
    offered: Option<String>,
    /// The game to play, if the user wants to test the map.
    test: Option<Game>,
    has_left: bool,
    /// `true` if the screen does not show the current state.
    is_stale: bool,
}

/// A sentence about the last key.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Message {
    text: String,
    is_error: bool,
}

/// The result of reading the map.
#[derive(Debug, Default)]
struct Check {
    /// `true` after the current text was read.
    is_current: bool,
    /// The last map without faults.
    sound: Option<Box<SoundMap>>,
    /// The first faults.
    faults: Vec<CellFault>,
    /// The cells of these faults.
    faulty: BTreeSet<Cell>,
    remark: Option<&'static str>,
}

/// A map without faults.
#[derive(Debug)]
struct SoundMap {
    world: World,
    /// A game in it, with the guards of every difficulty.
    game: Game,
    /// The rows of its grid.
    rows: Vec<Vec<char>>,
}

/// A fault of the map, with its cells.
#[derive(Debug)]
struct CellFault {
    cells: Vec<Cell>,
    sentence: String,
}

/// The places of the parts of the screen in the last drawing.
#[derive(Clone, Debug, Default)]
struct ScreenParts {
    plan: PlanArea,
    palette: Rect,
    /// The characters in the palette, from left to right, with their columns.
    brushes: Vec<(u16, char)>,
}

/// A page of the editor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum EditorPage {
    #[default]
    Plan,
    Help,
    /// The question about unsaved changes.
    Unsaved,
    /// The offer to restore the journal.
    Journal,
}

/// The effect of a menu entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    Stay,
    Save,
    Leave,
    Restore,
    Discard,
}

impl Page for EditorPage {
    fn kind(self) -> PageKind {
        match self {
            Self::Plan | Self::Help => PageKind::Bare,
            Self::Unsaved | Self::Journal => PageKind::Menu { has_values: false },
        }
    }
}

/// The number of faults that are marked. Nobody corrects more at once.
const MAX_FAULTS: usize = 100;
/// The largest grid, in cells, whose exits are searched after each change.
const MAX_SEARCHED: u32 = 1 << 14;

impl Editor {
    /// An editor of the map file at `path`. If there is no file, it begins with a small level.
    ///
    /// # Errors
    /// The reason why the file cannot be edited.
    pub fn open(path: &Path) -> Result<Self, Faults> {
        let file = MapFile::open(path)?;
        let name = path.display().to_string();
        let base = file.saved().map_or_else(|| new_level(path), str::to_owned);
        let document = MapDocument::open(base.clone(), &name)?;
        let offered = file.unsaved().map_err(|sentence| {
            Faults::of_whole_file(&name, &sentence, "move it away, or remove it")
        })?;
        let mut editor = Self {
            base,
            name,
            cursor: Cell { column: 0, row: 0 },
            heading: 0.0,
            brush: '.',
            anchor: None,
            copied: Vec::new(),
            awaits_character: false,
            command: None,
            message: None,
            pages: Pages::default(),
            check: Check::default(),
            drag: None,
            screen: ScreenParts::default(),
            view: View::default(),
            offered: None,
            test: None,
            has_left: false,
            is_stale: true,
            document,
            file,
        };
        editor.check();
        editor.begin_at_start();
        if editor.file.saved().is_none() {
            editor.say("a new level: ? shows the keys, and :w writes the file");
        }
        if let Some(text) = offered {
            editor.offered = Some(text);
            editor.open_page(EditorPage::Journal);
        }
        Ok(editor)
    }

    /// Moves the cursor to the player's start, and chooses the first tile.
    fn begin_at_start(&mut self) {
        if let Some(sound) = &self.check.sound {
            let start = sound.world.start();
            (self.cursor, self.heading) = (start.cell, start.heading.degrees());
        }
        self.brush = self.document.definitions().first().map_or('.', |first| first.character);
    }

    fn is_changed(&self) -> bool {
        self.document.text() != self.base
    }

    /// A sentence about changes that are in the journal only.
    fn unsaved_sentence(&self) -> Option<String> {
        let name = printable_path(self.file.path());
        let is_offered = self.offered.is_some();
        (self.is_changed() || is_offered).then(|| {
            format!("{name} has unsaved changes: \"cellcaster edit {name}\" offers to restore them")
        })
    }

    fn say(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_error: false });
    }

    fn complain(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_error: true });
    }

    /// Follows a change of the text.
    fn changed(&mut self, result: Result<(), String>) {
        match result {
            Ok(()) => self.follow_text(),
            Err(sentence) => self.complain(sentence),
        }
    }

    /// Keeps the text in the journal, and reads the map again before the next drawing.
    fn follow_text(&mut self) {
        self.check.is_current = false;
        let (columns, rows) = self.document.size();
        self.cursor.column = self.cursor.column.min(columns.saturating_sub(1));
        self.cursor.row = self.cursor.row.min(rows.saturating_sub(1));
        if self.offered.is_some() {
            return;
        }
        let kept = if self.is_changed() {
            self.file.keep(self.document.text())
        } else {
            self.file.discard();
            Ok(())
        };
        if let Err(sentence) = kept {
            self.complain(sentence);
        }
    }

    /// Reads the map, unless the current text was read already.
    fn check(&mut self) {
        if mem::replace(&mut self.check.is_current, true) {
            return;
        }
        let files = Folder::of(self.file.path());
        self.check.faults.clear();
        self.check.faulty.clear();
        self.check.remark = None;
        match map::parse(self.document.text(), &self.name, &files) {
            Ok(world) => {
                self.check.remark = remark(&world);
                let rows = self.document.rows().map(|row| row.chars().collect()).collect();
                let rules = Rules { difficulty: Difficulty::Hard, seed: 0 };
                let game = Game::with_rules(world.clone(), rules);
                self.check.sound = Some(Box::new(SoundMap { world, game, rows }));
            }
            Err(faults) => {
                let faults = faults.iter().map(|fault| CellFault {
                    cells: fault.place().map_or_else(Vec::new, |it| self.document.cells_at(it)),
                    sentence: fault.line(),
                });
                self.check.faults = faults.take(MAX_FAULTS).collect();
                let cells = self.check.faults.iter().flat_map(|fault| &fault.cells);
                self.check.faulty = sort::gathered(cells.copied());
            }
        }
    }

    /// Begins a game at the cursor.
    fn test_here(&mut self) {
        self.check();
        if !self.check.faults.is_empty() {
            return self.complain("the map has faults: n goes to the next one");
        }
        let heading = Heading::from_degrees(self.heading).unwrap_or_default();
        let start = Start { cell: self.cursor, heading };
        let world = self.check.sound.as_ref().map(|sound| sound.world.clone());
        match world.and_then(|world| Game::starting_at(world, start)) {
            Some(game) => self.test = Some(game),
            None => self.complain("a player has no room here: move to open floor"),
        }
    }

    fn save(&mut self, overwrites: bool) -> bool {
        match self.file.save(self.document.text(), overwrites) {
            Ok(()) => {
                self.base = self.document.text().to_owned();
                self.say("written");
                true
            }
            Err(file::NotSaved::Changed) => {
                self.complain("another program has changed the file: :w! overwrites it");
                false
            }
            Err(file::NotSaved::Failed(sentence)) => {
                self.complain(sentence);
                false
            }
        }
    }

    /// Leaves, after a question if there are unsaved changes.
    fn leave(&mut self, asks: bool) {
        if asks && self.is_changed() {
            return self.open_page(EditorPage::Unsaved);
        }
        self.file.discard();
        self.has_left = true;
    }

    fn open_page(&mut self, page: EditorPage) {
        let menu = match page {
            EditorPage::Plan | EditorPage::Help => Menu::default(),
            EditorPage::Unsaved => Menu::new("unsaved changes")
                .entry("Go on editing", Choice::Stay)
                .entry("Write the file and leave", Choice::Save)
                .entry("Leave without writing it", Choice::Discard),
            EditorPage::Journal => Menu::new("unsaved changes")
                .line(format!("{} has changes that were not", self.file.journal_name()))
                .line("written to the map. The editor ended early,")
                .line("or is open elsewhere.")
                .lines(
                    self.file.is_newer_than_journal().then_some("The map was written after them."),
                )
                .entry("Restore the changes", Choice::Restore)
                .entry("Discard them", Choice::Discard)
                .entry("Leave them alone", Choice::Leave),
        };
        self.pages.open(page, menu, Duration::ZERO);
    }

    fn close_page(&mut self) {
        self.pages.close(EditorPage::Plan, Duration::ZERO);
    }

    fn choose(&mut self, choice: Choice) {
        let page = self.pages.page();
        match (page, choice) {
            (EditorPage::Journal, Choice::Restore) => {
                let Some(text) = self.offered.clone() else { return };
                match self.document.replace(text, &self.file.journal_name()) {
                    Ok(()) => {
                        self.offered = None;
                        self.close_page();
                        self.follow_text();
                        self.check();
                        self.begin_at_start();
                        self.say("restored: :w writes the file, and u takes the changes back");
                    }
                    Err(faults) => self.complain(faults.summary()),
                }
            }
            (EditorPage::Journal, Choice::Discard) => {
                self.offered = None;
                self.file.discard();
                self.close_page();
            }
            (EditorPage::Journal, _) => self.has_left = true,
            (_, Choice::Save) => {
                self.close_page();
                if self.save(false) {
                    self.leave(false);
                }
            }
            (_, Choice::Discard) => self.leave(false),
            (..) => self.close_page(),
        }
    }
}

/// The remark of `check` on a map without faults.
fn remark(world: &World) -> Option<&'static str> {
    let grid = world.grid();
    if !world.has_exit() {
        return Some("no faults; the map has no exit");
    }
    let is_small = grid.width().saturating_mul(grid.height()) <= MAX_SEARCHED;
    (is_small && is_exit_out_of_reach(world)).then_some("no faults, but no exit can be reached")
}

/// The text of a new level, whose title is the name of the file.
fn new_level(path: &Path) -> String {
    let title: String =
        path.file_stem().unwrap_or_default().to_string_lossy().replace(char::is_control, "");
    let title = toml_edit::Value::from(title).to_string();
    format!(
        "\
title   = {}
ceiling = \"#202028\"
floor   = \"flagstone\"

grid = '''
######################
#....................#
#.@..................#
#....................#
#....................#
#....................#
#....................#
#....................#
#..................X.#
#....................#
######################
'''

[tiles]
\"#\" = {{ wall = \"brick\" }}
\"+\" = {{ door = \"oak\" }}

[things]
\"@\" = {{ start = 0 }}
\"X\" = {{ exit = true }}
\"g\" = {{ guard = \"warden\", heading = 180 }}
\"l\" = {{ sprite = \"lamp\" }}
",
        title.trim()
    )
}

#[cfg(test)]
mod tests;

//! The title screen: the program's name, the level that plays itself behind it, and the entries
//! that depend on data from outside the program.
//!
//! - The demo has no guards, because their pictures take twice the time of everything else in the
//!   first frame.
//! - The app has no access to files or to the date. Its caller passes them as [`Offers`].
//! - While tmux sends fewer colours than the terminal is known to show, and no other setting
//!   decides the colours, a menu entry offers to tell tmux. It opens a panel with the command. Only
//!   the answer in that panel makes the loop run the command. Rejected: a letter as its key. A
//!   player can bind every letter, and the walking keys select entries in menus.
//! - The letters of the name are a font of 3 by 5 points. A point is half a cell high if half
//!   blocks can be shown, and one cell high otherwise.

use std::fmt;

use ratatui::layout::Rect;
use ratatui::style::{Color, Style};
use ratatui::text::{Line, Text};
use ratatui::widgets::Block;

use crate::app::App;
use crate::app::page::Menu;
use crate::app::played::Played;
use crate::app::recording::{self, Steps};
use crate::app::screen::{AppScreen, MenuChoice};
use crate::color::palette::ColorDepth;
use crate::game::Script;
use crate::map::{Level, builtin};
use crate::terminal::{ColorSource, TmuxClient};
use crate::tui::GlyphSet;
use crate::tui::canvas::Canvas;

/// The demo's level, and the script that plays it.
const LEVEL: &str = "citadel";
const SCRIPT: &str = include_str!("../../maps/showcase.script");

/// The demo's level at its start, and the intents of each step. Only this level is read, because
/// the program's first picture needs no other.
fn demo() -> Option<(Played, Steps)> {
    let level = builtin::LEVELS.iter().find(|level| level.name == LEVEL)?;
    let script = Script::parse(SCRIPT, "showcase").ok()?;
    let world = level.world().ok()?.without_guards();
    Some((Played::new(Level::from(world)), recording::steps(&script)))
}

/// The data for the title screen's entries, apart from the built-in levels.
#[derive(Default)]
pub struct Offers {
    /// Finds the player's own maps. Called when the player opens the list of maps.
    pub maps: Option<FindMaps>,
    /// Loads the map file at a path, to continue a saved game in it.
    pub load: Option<LoadMap>,
    /// The date of the daily run, such as 20261122; `None` to offer no daily run.
    pub today: Option<u32>,
    /// The seed of the first endless descent. Each later descent uses the next seed.
    pub seed: u64,
}

/// A function that returns the player's own maps.
pub type FindMaps = Box<dyn FnMut() -> Vec<OwnMap>>;

/// A function that loads the map at a path. An error is a sentence for the player.
pub type LoadMap = Box<dyn Fn(&str) -> Result<OwnLevel, String>>;

/// A map that belongs to the player.
pub struct OwnMap {
    /// The name in the list of maps.
    pub name: String,
    /// The key for its results in the store, as of the time when the map was found.
    pub key: String,
    /// Reads the map. An error is a sentence for the player.
    pub load: Box<dyn Fn() -> Result<OwnLevel, String>>,
}

/// The level in a map that belongs to the player.
#[derive(Clone, Debug)]
pub struct OwnLevel {
    /// The level.
    pub level: Level,
    /// The key for its results in the store. It differs from the key in [`OwnMap`] if the file has
    /// changed since the map was found.
    pub key: String,
    /// The absolute path of its file, for [`Offers::load`]; `None` if the map is found by its key.
    pub file: Option<String>,
}

impl fmt::Debug for Offers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Offers").field("maps", &self.maps.is_some()).finish_non_exhaustive()
    }
}

impl fmt::Debug for OwnMap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("OwnMap").field("name", &self.name).finish_non_exhaustive()
    }
}

/// The progress of the player's request to tell tmux.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum TmuxOrder {
    #[default]
    None,
    /// The loop has not yet taken the request.
    Given,
    Running,
    Done,
    Failed,
}

impl App {
    /// Begins the level behind the title.
    pub(crate) fn begin_demo(&mut self) {
        let (game, steps) = demo().unzip();
        (self.game, self.demo) = (game.unwrap_or_default(), steps);
    }

    /// Advances the level behind the title by one step. At its end, the level begins again.
    pub(crate) fn step_demo(&mut self) {
        let Some(demo) = &mut self.demo else { return };
        match demo.next().filter(|_| !self.game.is_finished()) {
            Some(intents) => self.game.step(intents),
            None => self.begin_demo(),
        }
    }

    /// The command that the title offers to run; `None` if it offers none.
    pub(crate) fn tmux_remedy(&self) -> Option<String> {
        let decides = self.detection.source == Some(ColorSource::Tmux);
        let is_offered =
            decides && self.settings.depth.is_none() && self.depth() == ColorDepth::Indexed256;
        self.detection.tmux.as_ref().filter(|_| is_offered).and_then(TmuxClient::remedy)
    }

    /// The title's entry for the offer to tell tmux.
    pub(crate) fn tmux_offer(&self) -> Option<(&'static str, &'static str, MenuChoice)> {
        self.tmux_remedy()
            .map(|_| ("24-bit colours in tmux", "", MenuChoice::Open(AppScreen::Tmux)))
    }

    pub(crate) fn tmux_menu(&self) -> Menu<MenuChoice> {
        let menu = Menu::new("tmux sends 256 colours");
        let Some(remedy) = self.tmux_remedy() else { return menu.entry("Back", MenuChoice::Back) };
        let menu = match self.tmux_order {
            TmuxOrder::None => menu
                .line("Tell this server, then detach and attach again:")
                .line(format!("tmux {remedy}"))
                .line("For good, add to ~/.tmux.conf:")
                .line(remedy)
                .entry("Tell tmux", MenuChoice::TellTmux),
            TmuxOrder::Given | TmuxOrder::Running => menu.line("Telling tmux."),
            TmuxOrder::Done => menu
                .line("Done. Detach (prefix d), attach again, and press a key.")
                .line("For good, add to ~/.tmux.conf:")
                .line(remedy),
            TmuxOrder::Failed => menu.line("tmux rejected the command; see docs/terminals.md."),
        };
        menu.entry("Back", MenuChoice::Back)
    }

    pub(crate) fn order_tmux(&mut self) {
        self.tmux_order = TmuxOrder::Given;
        self.renew_menu();
    }

    /// Returns true if the loop must tell tmux now. Each request returns true once.
    pub(crate) fn take_tmux_order(&mut self) -> bool {
        let is_given = self.tmux_order == TmuxOrder::Given;
        if is_given {
            self.tmux_order = TmuxOrder::Running;
        }
        is_given
    }

    /// Shows whether telling tmux has succeeded.
    pub(crate) fn tmux_told(&mut self, has_worked: bool) {
        self.tmux_order = if has_worked { TmuxOrder::Done } else { TmuxOrder::Failed };
        if self.screen() == AppScreen::Tmux {
            self.renew_menu();
        }
    }

    /// Updates the menu if the offered command is no longer `offered`.
    pub(crate) fn renew_tmux_offer(&mut self, offered: Option<&str>) {
        let now = self.tmux_remedy();
        if now.as_deref() == offered {
            return;
        }
        self.tmux_order = TmuxOrder::None;
        match self.screen() {
            AppScreen::Tmux if now.is_none() => self.close(),
            AppScreen::Tmux | AppScreen::Title => self.renew_menu(),
            _ => {}
        }
    }
}

const NAME: &str = "CELLCASTER";
/// The five rows of each letter in the name. Each row has one bit per point, with the left point in
/// the highest bit.
const FONT: [(char, [u8; 5]); 7] = [
    ('A', [0b010, 0b101, 0b111, 0b101, 0b101]),
    ('C', [0b111, 0b100, 0b100, 0b100, 0b111]),
    ('E', [0b111, 0b100, 0b110, 0b100, 0b111]),
    ('L', [0b100, 0b100, 0b100, 0b100, 0b111]),
    ('R', [0b110, 0b101, 0b110, 0b101, 0b101]),
    ('S', [0b111, 0b100, 0b111, 0b001, 0b111]),
    ('T', [0b111, 0b010, 0b010, 0b010, 0b010]),
];
/// The width of a letter and the gap after it, in points.
const ADVANCE: usize = 4;
const ROWS: usize = 5;
/// The width of the whole name, in points.
const COLUMNS: usize = NAME.len() * ADVANCE - 1;
/// The minimum number of rows for the menu below the name.
const MIN_ROWS_BELOW: u16 = 6;

/// Draws the name on a band at the top of `picture`, in the largest size that fits. Returns the
/// area below the band.
pub fn draw_banner(
    canvas: &mut impl Canvas,
    picture: Rect,
    glyphs: GlyphSet,
    depth: ColorDepth,
) -> Rect {
    let lines = [2, 1].into_iter().map(|scale| lines(glyphs, scale));
    let fits = |lines: &Vec<String>| {
        let width = lines[0].chars().count();
        width <= usize::from(picture.width)
            && lines.len() + usize::from(MIN_ROWS_BELOW) <= usize::from(picture.height)
    };
    let lines = lines.into_iter().find(fits).unwrap_or_else(|| vec![NAME.to_owned()]);
    let (width, height) = (lines[0].chars().count() as u16, lines.len() as u16);
    let blank = u16::from(picture.height >= height + MIN_ROWS_BELOW + 6);
    let taken = (height + 2 * blank).min(picture.height);
    let band = Rect { height: taken, ..picture };
    let area = Rect {
        x: picture.x + (picture.width - width.min(picture.width)) / 2,
        y: picture.y + blank,
        width: width.min(picture.width),
        height: height.min(picture.height),
    };
    let style = style(depth);
    let text: Text = lines.into_iter().map(Line::from).collect();
    canvas.draw_widget(Block::new().style(style), band);
    canvas.draw_widget(text.style(style), area);
    Rect { y: picture.y + taken, height: picture.height - taken, ..picture }
}

/// Bright letters on black, even on a terminal with a light background.
fn style(depth: ColorDepth) -> Style {
    let [text, ground] = match depth {
        ColorDepth::Mono => return Style::new(),
        ColorDepth::Indexed16 => [Color::Indexed(11), Color::Indexed(0)],
        ColorDepth::Indexed256 => [Color::Indexed(220), Color::Indexed(16)],
        ColorDepth::True => [Color::Rgb(0xff, 0xd0, 0x50), Color::Rgb(0, 0, 0)],
    };
    Style::new().fg(text).bg(ground)
}

/// The name as lines of characters. Each point is `scale` columns wide. Its height follows from the
/// shape of a cell: `scale` half cells with half blocks, one cell otherwise.
fn lines(glyphs: GlyphSet, scale: usize) -> Vec<String> {
    let is_set = |x: usize, y: usize| {
        let letter = NAME.chars().nth(x / scale / ADVANCE);
        let row = FONT.iter().find(|(known, _)| Some(*known) == letter).map(|(_, rows)| rows);
        let bit = 0b100 >> (x / scale % ADVANCE);
        row.and_then(|rows| rows.get(y)).is_some_and(|row| row & bit != 0)
    };
    let columns = 0..COLUMNS * scale;
    if glyphs.has_blocks() {
        let rows = (0..(ROWS * scale).div_ceil(2)).map(|row| 2 * row);
        let half = |x, y| is_set(x, y / scale);
        rows.map(|y| columns.clone().map(|x| block(half(x, y), half(x, y + 1))).collect()).collect()
    } else {
        let point = |x, y| if is_set(x, y) { '#' } else { ' ' };
        (0..ROWS).map(|y| columns.clone().map(|x| point(x, y)).collect()).collect()
    }
}

/// The character for two points, one above the other.
fn block(upper: bool, lower: bool) -> char {
    match (upper, lower) {
        (true, true) => '█',
        (true, false) => '▀',
        (false, true) => '▄',
        (false, false) => ' ',
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_demo_moves_and_ends() {
        let (mut played, intents_of_steps) = demo().unwrap();
        let start = played.grid().unwrap().clone();
        let mut steps = 0;
        for intents in intents_of_steps {
            played.step(intents);
            steps += 1;
        }
        assert!(steps > 600, "{steps} steps");
        assert_ne!(*played.grid().unwrap(), start);
        assert_eq!(*demo().unwrap().0.grid().unwrap(), start);
    }

    #[test]
    fn the_reported_size_of_the_name_matches_its_drawing() {
        insta::assert_snapshot!(lines(GlyphSet::Half, 1).join("\n"));
        insta::assert_snapshot!(lines(GlyphSet::Ascii, 1).join("\n"));
        for (glyphs, scale, size) in [
            (GlyphSet::Half, 1, (39, 3)),
            (GlyphSet::Half, 2, (78, 5)),
            (GlyphSet::Ascii, 1, (39, 5)),
            (GlyphSet::Ramp, 2, (78, 5)),
        ] {
            let lines = lines(glyphs, scale);
            assert!(lines.iter().all(|line| line.chars().count() == size.0), "{lines:?}");
            assert_eq!(lines.len(), size.1, "{lines:?}");
        }
    }
}

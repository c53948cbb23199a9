//! A game that a test plays.

use std::fmt::{Display, Write};
use std::ops::{Deref, DerefMut};
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::emulator::{Emulator, Speaks};
use crate::player::Player;
use crate::support::output_of;

pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_cellcaster");

/// A terminal with all colours, and an empty folder as the user's configuration folder.
pub(crate) const ENVIRONMENT: [(&str, &str); 2] =
    [("COLORTERM", "truecolor"), ("HOME", env!("CARGO_TARGET_TMPDIR"))];

/// The default size of the window.
const SIZE: (u16, u16) = (80, 24);

/// The game and its terminal.
pub(crate) struct Game {
    player: Player,
    speaks: Speaks,
    map: Option<String>,
}

/// A key with its number in the kitty protocol.
#[derive(Clone, Copy)]
pub(crate) enum Key {
    Char(char),
    Right,
    Escape,
    Enter,
}

/// The player's arrow on the minimap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Arrow {
    pub(crate) column: u16,
    pub(crate) row: u16,
    pub(crate) points: char,
}

impl Game {
    /// Starts the test map `cellar`, in which only the player moves, in a terminal that reports key
    /// releases.
    pub(crate) fn start() -> Self {
        Self::with(Speaks::Kitty, SIZE, None, &[], &[])
    }

    /// Starts the test map `map` in a terminal that reports key releases.
    pub(crate) fn start_map(map: &str) -> Self {
        Self::with(Speaks::Kitty, SIZE, Some(map), &[], &[])
    }

    /// Starts a game on the test map `map`, or else on `cellar`, and waits until it shows a
    /// picture.
    pub(crate) fn with(
        speaks: Speaks,
        size: (u16, u16),
        map: Option<&str>,
        options: &[&str],
        environment: &[(&str, &str)],
    ) -> Self {
        let map = map.or((!options.contains(&"--generate")).then_some("cellar"));
        let map = map.map(|name| test_map(name).to_str().unwrap().to_owned());
        let words = ["play"].iter().chain(options).copied();
        let arguments: Vec<&str> = words.chain(map.as_deref()).collect();
        let environment = [&ENVIRONMENT[..], environment].concat();
        let player = Player::start(size, speaks, PROGRAM, arguments, &environment);
        player.wait_for("? help");
        Self { player, speaks, map }
    }

    /// The player, without the game's map.
    pub(crate) fn into_player(self) -> Player {
        self.player
    }

    /// Waits until the terminal reports releases.
    #[track_caller]
    pub(crate) fn wait_for_releases(&self) {
        let pushed = |emulator: &Emulator| emulator.modes().key_flags == [0, 1];
        self.wait_until("asked for releases", pushed);
    }

    /// Presses and holds `key`.
    pub(crate) fn press(&self, key: Key) {
        match self.speaks {
            Speaks::Kitty | Speaks::Alacritty => {
                self.wait_for_releases();
                self.send(key.event(1));
            }
            Speaks::Plain | Speaks::Nothing => self.send(key.text()),
        }
    }

    /// Releases `key`. The program notices this only if the terminal reports releases.
    pub(crate) fn release(&self, key: Key) {
        if matches!(self.speaks, Speaks::Kitty | Speaks::Alacritty) {
            self.send(key.event(3));
        }
    }

    /// Presses and releases `key`. If the press ends the game, the terminal sends the release.
    pub(crate) fn tap(&self, key: Key) {
        self.press(key);
        self.release(key);
    }

    /// Leaves the game, and confirms it.
    pub(crate) fn leave(&self) {
        self.press(Key::Char('q'));
        self.press(Key::Enter);
    }

    /// The player's arrow on the minimap.
    #[track_caller]
    pub(crate) fn arrow(&self) -> Arrow {
        self.wait_until("showed an arrow", |emulator| arrow(emulator).is_some());
        self.look(arrow).unwrap()
    }

    /// Waits until the arrow satisfies `condition`.
    #[track_caller]
    pub(crate) fn wait_for_arrow(&self, what: &str, condition: impl Fn(Arrow) -> bool) {
        self.wait_until(what, |emulator| arrow(emulator).is_some_and(&condition));
    }

    /// Waits until the screen shows the status line and, except under panels, the picture that
    /// `snapshot` draws with `options`.
    #[track_caller]
    pub(crate) fn wait_for_picture(&self, options: &[&str]) {
        let (columns, rows) = self.look(size);
        let size = format!("{columns}x{}", rows - 1);
        let words = ["snapshot", "--format", "json", "--size", &size];
        let arguments: Vec<&str> =
            words.into_iter().chain(options.iter().copied()).chain(self.map.as_deref()).collect();
        let snapshot: Value = serde_json::from_slice(&output_of(&arguments)).unwrap();
        let rows = snapshot["cells"].as_array().unwrap();
        let what = format!("showed the picture of {arguments:?}");
        self.wait_until(&what, |emulator| shows(emulator, rows));
    }

    /// Waits until the screen shows only that picture and the status line.
    #[track_caller]
    pub(crate) fn wait_for_bare_picture(&self, options: &[&str]) {
        self.wait_until("hid the panels", |emulator| panel(emulator).is_none());
        self.wait_for_picture(options);
    }
}

impl Deref for Game {
    type Target = Player;

    fn deref(&self) -> &Player {
        &self.player
    }
}

impl DerefMut for Game {
    fn deref_mut(&mut self) -> &mut Player {
        &mut self.player
    }
}

impl Key {
    /// The bytes of the kitty protocol. `phase` is 1 for a press, 2 for a repetition, 3 for a
    /// release.
    pub(crate) fn event(self, phase: u8) -> String {
        match self {
            Self::Char(character) => code(u32::from(character), phase),
            Self::Escape => code(27, phase),
            Self::Enter => code(13, phase),
            Self::Right => format!("\x1b[1;1:{phase}C"),
        }
    }

    /// The bytes that every terminal sends.
    fn text(self) -> String {
        match self {
            Self::Char(character) => character.to_string(),
            Self::Escape => "\x1b".to_owned(),
            Self::Enter => "\r".to_owned(),
            Self::Right => "\x1b[C".to_owned(),
        }
    }
}

fn code(number: impl Display, phase: u8) -> String {
    format!("\x1b[{number};1:{phase}u")
}

/// The path of a test map.
pub(crate) fn test_map(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/maps").join(name).with_extension("toml")
}

/// The numbers of columns and rows.
fn size(emulator: &Emulator) -> (u16, u16) {
    let (rows, columns) = emulator.screen().size();
    (columns.get(), rows.get())
}

/// The character in a cell of the screen.
pub(crate) fn symbol(emulator: &Emulator, column: u16, row: u16) -> &str {
    emulator.screen().cell(row, column).map_or("", |cell| cell.contents())
}

fn arrow(emulator: &Emulator) -> Option<Arrow> {
    let (columns, rows) = size(emulator);
    let mut cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    cells.find_map(|(column, row)| {
        let points = symbol(emulator, column, row).chars().next()?;
        "→↘↓↙←↖↑↗".contains(points).then_some(Arrow { column, row, points })
    })
}

/// The first column and the last row of the panel in the upper right corner.
fn panel(emulator: &Emulator) -> Option<(u16, u16)> {
    let (columns, rows) = size(emulator);
    let left = (0..columns).find(|&column| symbol(emulator, column, 0) == "┌")?;
    let bottom = (0..rows).find(|&row| symbol(emulator, left, row) == "└")?;
    Some((left, bottom))
}

/// Returns whether the screen shows the cells of `rows` and a status line below them.
fn shows(emulator: &Emulator, rows: &[Value]) -> bool {
    let hidden = panel(emulator).unwrap_or((u16::MAX, 0));
    let is_hidden = |column, row| column >= hidden.0 && row <= hidden.1;
    let picture =
        rows.iter().zip(0..).all(|(cells, row)| {
            cells.as_array().unwrap().iter().zip(0..).all(|(cell, column)| {
                is_hidden(column, row) || shows_cell(emulator, column, row, cell)
            })
        });
    let (columns, height) = size(emulator);
    let status = emulator.screen().cell(height - 1, columns / 2);
    picture && status.is_some_and(vt100::Cell::inverse)
}

/// The appearance of every cell of the screen.
pub(crate) fn looks(emulator: &Emulator) -> Vec<String> {
    let (columns, rows) = size(emulator);
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    cells
        .filter_map(|(row, column)| emulator.screen().cell(row, column))
        .map(|cell| {
            let (text, ground) = (hexadecimal(cell.fgcolor()), hexadecimal(cell.bgcolor()));
            match halves(cell.contents(), &text, &ground) {
                Some((top, bottom)) => format!("{top} {bottom}"),
                None => format!("{} {text} {ground}", cell.contents()),
            }
        })
        .collect()
}

/// The colours of the halves of each cell, in any emulator; `None` for a cell with a character.
pub(crate) fn halves_shown(emulator: &Emulator) -> Vec<Option<[[u8; 3]; 2]>> {
    let (columns, rows) = size(emulator);
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
    cells.map(|(column, row)| emulator.halves(column, row)).collect()
}

fn shows_cell(emulator: &Emulator, column: u16, row: u16, cell: &Value) -> bool {
    let text = |key: &str| cell[key].as_str().unwrap();
    emulator.screen().cell(row, column).is_some_and(|shown| {
        let (foreground, background) = (hexadecimal(shown.fgcolor()), hexadecimal(shown.bgcolor()));
        let shown = halves(shown.contents(), &foreground, &background);
        shown.is_some() && shown == halves(text("ch"), text("fg"), text("bg"))
    })
}

/// The colours of the upper and the lower half of a block character, because several such
/// characters look the same. `None` for any other character.
fn halves<'a>(symbol: &str, text: &'a str, ground: &'a str) -> Option<(&'a str, &'a str)> {
    match symbol {
        "▀" => Some((text, ground)),
        "▄" => Some((ground, text)),
        "█" => Some((text, text)),
        " " | "" => Some((ground, ground)),
        _ => None,
    }
}

fn hexadecimal(color: vt100::Color) -> String {
    let mut text = String::new();
    match color {
        vt100::Color::Rgb(red, green, blue) => {
            write!(text, "#{red:02x}{green:02x}{blue:02x}").unwrap();
        }
        other => write!(text, "{other:?}").unwrap(),
    }
    text
}

//! Events from the terminal: keys, the mouse, and the size of the window.
//!
//! A key is a physical key, not the text that it types: letters are lower-case, and Shift is a
//! modifier.
//!
//! Bindings name Latin letters. For layouts without them, an event also contains the key of a US keyboard at the same
//! place. The kitty protocol reports that key. Other terminals send only the letter, and its place is derived from the
//! most common layout of its script. Latin letters are not mapped: users of an AZERTY or Dvorak keyboard choose keys by
//! their letters.
//!
//! Rejected: the key types of a parser library. Files with bindings contain the names of these keys, and must outlive
//! any library.

use std::fmt;
use std::str::FromStr;

use crate::color::palette::ColorDepth;

/// An event from the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A key was pressed, repeated or released.
    Key(KeyEvent),
    /// The mouse was moved, or one of its buttons was pressed or released. Sent only if
    /// [`Session::set_mouse`](super::Session::set_mouse) has turned on reports.
    Mouse(MouseEvent),
    /// The window has received the focus.
    FocusGained,
    /// The window has lost the focus. Releases of held keys may not be reported.
    FocusLost,
    /// The size of the window may have changed. The next frame repaints all of it.
    Resized,
    /// The terminal, or the tmux around the program, has reported this colour depth, which differs from the depth
    /// assumed before.
    ColorDepth(ColorDepth),
    /// The terminal has reported its name. [`Session::glyph_support`](super::Session::glyph_support) and
    /// [`Protocol::shade_ink`](super::Protocol::shade_ink) may have changed.
    Identified,
    /// The terminal has answered whether it reports key releases. Sent at most once. No release is reported before it.
    KeyReleases(bool),
    /// The outcome of [`Session::tell_tmux`](super::Session::tell_tmux): `true` if it has worked.
    TmuxTold(bool),
    /// The terminal is ready for the next frame. Sent only after
    /// [`Session::is_ready`](super::Session::is_ready) has returned `false`.
    Ready,
    /// The user wants to return to the shell for a while (Ctrl-Z or a signal). The program should call
    /// [`Session::suspend`](super::Session::suspend).
    Suspend,
    /// The program should end. After a signal, it is forced to end one second later.
    Quit(QuitReason),
}

/// The reason why the program should end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuitReason {
    /// The user pressed Ctrl-C, or the process received SIGINT.
    Interrupted,
    /// The process received SIGTERM.
    Terminated,
    /// The terminal is gone: the process received SIGHUP.
    HungUp,
    /// The input is closed: no more keys can arrive.
    InputClosed,
}

/// An event of the mouse.
///
/// Terminals report the position of the pointer in the window, in cells or in pixels, but never the motion of the mouse
/// itself. Both kinds of position are converted to the same unit, so programs need not distinguish them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MouseEvent {
    /// The distance of the pointer from the left edge of the window, in units of 1 / [`MouseEvent::UNITS_PER_CELL`] of
    /// a cell's width. If the terminal reports only cells, this is the middle of the cell.
    pub x: u32,
    /// The distance of the pointer from the upper edge of the window, in units of 1 / [`MouseEvent::UNITS_PER_CELL`] of
    /// a cell's height.
    pub y: u32,
    /// The kind of event.
    pub kind: MouseEventKind,
}

impl MouseEvent {
    /// The number of units in a cell: in its width for `x`, in its height for `y`.
    pub const UNITS_PER_CELL: u32 = 64;
}

/// The kind of a mouse event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MouseEventKind {
    /// The pointer was moved, with or without a button held.
    Moved,
    /// A button was pressed.
    Pressed(MouseButton),
    /// A button was released. Some terminals do not report which one.
    Released,
}

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MouseButton {
    /// The first button.
    Left,
    /// The wheel, when pressed.
    Middle,
    /// The second button.
    Right,
}

/// A report of a mouse event, as the terminal sends it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MouseReport {
    pub(crate) kind: MouseEventKind,
    /// The column and the row of the cell or the pixel, from 1.
    pub(crate) place: [u32; 2],
}

/// The unit of the pointer's position in reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MouseUnits {
    Cells,
    Pixels,
}

impl MouseReport {
    /// The event in a window of `size`; `None` if the position is in pixels and the size in pixels
    /// is unknown.
    pub(crate) fn event(self, units: MouseUnits, size: WindowSize) -> Option<MouseEvent> {
        const UNITS: u64 = MouseEvent::UNITS_PER_CELL as u64;
        let from_zero = self.place.map(|one| u64::from(one.saturating_sub(1)));
        let [x, y] = match units {
            MouseUnits::Cells => from_zero.map(|cell| cell * UNITS + UNITS / 2),
            MouseUnits::Pixels => {
                let [width, height] = size.pixels?.map(|length| u64::from(length).max(1));
                let [x, y] = from_zero;
                [
                    x * u64::from(size.columns) * UNITS / width,
                    y * u64::from(size.rows) * UNITS / height,
                ]
            }
        };
        let within = |units: u64, cells: u16| units.min(u64::from(cells) * UNITS) as u32;
        Some(MouseEvent { x: within(x, size.columns), y: within(y, size.rows), kind: self.kind })
    }
}

/// The size of the window, and the shape of its cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowSize {
    /// The width in cells: 0 to [`WindowSize::MAX_COLUMNS`].
    pub columns: u16,
    /// The height in cells: 0 to [`WindowSize::MAX_ROWS`].
    pub rows: u16,
    /// A cell's height divided by its width, from 1.5 to 3, if the terminal reports it.
    pub cell_aspect: Option<f64>,
    /// The width and the height in pixels, if the terminal reports them and the cells then have a
    /// plausible shape.
    pub pixels: Option<[u16; 2]>,
}

impl WindowSize {
    /// The maximum number of columns. Further columns stay blank, because a terminal that reports more is not credible.
    pub const MAX_COLUMNS: u16 = 2048;
    /// The maximum number of rows. Further rows stay blank.
    pub const MAX_ROWS: u16 = 1024;

    /// The assumed size of a terminal that reports no size.
    #[cfg(unix)]
    pub(crate) const UNKNOWN: Self =
        Self { columns: 80, rows: 24, cell_aspect: None, pixels: None };

    /// A window of this many cells. Its size in pixels is unknown.
    pub fn of_cells(columns: u16, rows: u16) -> Self {
        Self::new((columns, rows), (0, 0))
    }

    /// The size of a window in columns and rows, and in pixels. Pixels are ignored if they make the shape of a cell
    /// implausible: some terminals report no pixels, and some report wrong numbers.
    pub fn new((columns, rows): (u16, u16), (width, height): (u16, u16)) -> Self {
        let cell_width = f64::from(width) / f64::from(columns);
        let cell_height = f64::from(height) / f64::from(rows);
        let cell_aspect =
            Some(cell_height / cell_width).filter(|aspect| (1.5..=3.0).contains(aspect));
        Self {
            columns: columns.min(Self::MAX_COLUMNS),
            rows: rows.min(Self::MAX_ROWS),
            cell_aspect,
            pixels: cell_aspect.map(|_| [width, height]),
        }
    }

    /// The size in cells, as ratatui's type.
    pub(crate) fn cells(self) -> ratatui::layout::Size {
        ratatui::layout::Size { width: self.columns, height: self.rows }
    }
}

/// An event of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct KeyEvent {
    /// The key, by the character that the keyboard's layout assigns to it.
    pub key: Key,
    /// The key of a US keyboard at the same place, if the layout types non-Latin letters and the
    /// place is known.
    pub base: Option<Key>,
    /// The modifiers during the event.
    pub modifiers: Modifiers,
    /// The kind of event.
    pub phase: Phase,
}

impl KeyEvent {
    /// The character that the event types into a text. `None` for keys without a character, for keys with Control or
    /// Alt, and for releases.
    pub fn typed(&self) -> Option<char> {
        let Key::Char(character) = self.key else { return None };
        let Modifiers { shift, control, alt } = self.modifiers;
        if control || alt || self.phase == Phase::Release {
            return None;
        }
        let mut upper = character.to_uppercase();
        match (upper.next(), upper.next()) {
            (Some(single), None) if shift => Some(single),
            _ => Some(character),
        }
    }
}

/// A key of the keyboard.
///
/// Its text, for [`Display`](fmt::Display) and [`FromStr`], is the character or a name: `space`,
/// `up`, `down`, `left`, `right`, `enter`, `escape`, `tab`, `backspace`, `insert`, `delete`,
/// `home`, `end`, `pageup`, `pagedown`, `shift`, `control`, `alt`, `f1` to `f35`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Key {
    /// A key that types a character. A letter is lower-case, whether Shift is down or not.
    Char(char),
    /// Arrow up.
    Up,
    /// Arrow down.
    Down,
    /// Arrow to the left.
    Left,
    /// Arrow to the right.
    Right,
    /// Enter, also the keypad's.
    Enter,
    /// Escape.
    Escape,
    /// Tab; backwards with Shift.
    Tab,
    /// Backspace.
    Backspace,
    /// Insert.
    Insert,
    /// Delete.
    Delete,
    /// Home.
    Home,
    /// End.
    End,
    /// Page up.
    PageUp,
    /// Page down.
    PageDown,
    /// Either Shift key by itself. Reported only if the terminal reports releases.
    Shift,
    /// Either Control key by itself. Reported only if the terminal reports releases.
    Control,
    /// Either Alt key by itself. Reported only if the terminal reports releases.
    Alt,
    /// A function key, from 1 to 35.
    Function(u8),
}

/// The modifiers that are held during an event.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Modifiers {
    /// Either Shift key.
    pub shift: bool,
    /// Either Control key.
    pub control: bool,
    /// Either Alt key, or Option.
    pub alt: bool,
}

/// The kind of a key event.
///
/// A terminal that does not report releases sends only presses, and repeats them while the key is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Phase {
    /// The key was pressed.
    Press,
    /// The key is held, and the keyboard repeats it.
    Repeat,
    /// The key was released.
    Release,
}

/// The error of [`Key::from_str`]: no key has this name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{0:?} is not a key: write one character, such as \"w\", or a name, such as \"up\", \"space\" or \"f1\""
)]
pub struct UnknownKey(String);

const LAST_FUNCTION_KEY: u8 = 35;

const NAMES: [(&str, Key); 18] = [
    ("space", Key::Char(' ')),
    ("up", Key::Up),
    ("down", Key::Down),
    ("left", Key::Left),
    ("right", Key::Right),
    ("enter", Key::Enter),
    ("escape", Key::Escape),
    ("tab", Key::Tab),
    ("backspace", Key::Backspace),
    ("insert", Key::Insert),
    ("delete", Key::Delete),
    ("home", Key::Home),
    ("end", Key::End),
    ("pageup", Key::PageUp),
    ("pagedown", Key::PageDown),
    ("shift", Key::Shift),
    ("control", Key::Control),
    ("alt", Key::Alt),
];

impl Key {
    /// The key that types `character`, in upper or lower case.
    pub(crate) fn typing(character: char) -> Self {
        let mut lower = character.to_lowercase();
        match (lower.next(), lower.next()) {
            (Some(single), None) => Self::Char(single),
            _ => Self::Char(character),
        }
    }
}

impl fmt::Display for Key {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (NAMES.iter().find(|(_, key)| key == self), self) {
            (Some((name, _)), _) => f.write_str(name),
            (None, Self::Char(character)) => write!(f, "{character}"),
            (None, Self::Function(number)) => write!(f, "f{number}"),
            (None, named) => unreachable!("{named:?} is in the list of names"),
        }
    }
}

impl FromStr for Key {
    type Err = UnknownKey;

    /// Parses a name or a single character, in upper or lower case.
    fn from_str(text: &str) -> Result<Self, UnknownKey> {
        let unknown = || UnknownKey(text.to_owned());
        let mut characters = text.chars();
        if let (Some(only), None) = (characters.next(), characters.next()) {
            return if only.is_control() { Err(unknown()) } else { Ok(Self::typing(only)) };
        }
        let name = text.to_ascii_lowercase();
        if let Some((_, key)) = NAMES.iter().find(|(known, _)| *known == name) {
            return Ok(*key);
        }
        name.strip_prefix('f')
            .filter(|number| number.bytes().all(|digit| digit.is_ascii_digit()))
            .and_then(|number| number.parse().ok())
            .filter(|number| (1..=LAST_FUNCTION_KEY).contains(number))
            .map(Self::Function)
            .ok_or_else(unknown)
    }
}

/// Letters, and the keys of a US keyboard at their places. The layouts are Russian, with the letters that differ in
/// Ukrainian and Belarusian, and Greek.
const PLACES: [(&str, &str); 7] = [
    ("йцукенгшщзхъ", "qwertyuiop[]"),
    ("фывапролджэ", "asdfghjkl;'"),
    ("ячсмитьбюё", "zxcvbnm,.`"),
    ("іїєґў", "s]'\\o"),
    ("ςερτυθιοπ", "wertyuiop"),
    ("ασδφγηξκλ", "asdfghjkl"),
    ("ζχψωβνμ", "zxcvbnm"),
];

/// The key of a US keyboard at the place of `key`, if `key` types a non-Latin letter. It is the key that the terminal
/// has reported (`told`), or otherwise the key in the table.
pub(crate) fn base_key(key: Key, told: Option<char>) -> Option<Key> {
    let Key::Char(letter) = key else { return None };
    if !letter.is_alphabetic() || is_latin(letter) {
        return None;
    }
    let told = told.filter(char::is_ascii_graphic);
    let mut places = PLACES.iter().flat_map(|(letters, keys)| letters.chars().zip(keys.chars()));
    let known = || places.find(|&(known, _)| known == letter).map(|(_, key)| key);
    told.or_else(known).map(Key::typing)
}

/// Returns true if `letter` is in one of Unicode's Latin blocks.
fn is_latin(letter: char) -> bool {
    matches!(letter, '\0'..='\u{24f}' | '\u{1e00}'..='\u{1eff}' | '\u{ff00}'..='\u{ff5e}')
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn place(units: MouseUnits, place: [u32; 2]) -> Option<(u32, u32)> {
        let report = MouseReport { kind: MouseEventKind::Moved, place };
        let event = report.event(units, WindowSize::new((80, 24), (720, 432)))?;
        Some((event.x, event.y))
    }

    #[test]
    fn cells_and_pixels_map_to_the_same_places() {
        assert_eq!(place(MouseUnits::Cells, [1, 1]), Some((32, 32)));
        assert_eq!(place(MouseUnits::Cells, [80, 24]), Some((79 * 64 + 32, 23 * 64 + 32)));
        assert_eq!(place(MouseUnits::Pixels, [1, 1]), Some((0, 0)));
        // A cell has 9 by 18 pixels.
        assert_eq!(place(MouseUnits::Pixels, [10, 19]), Some((64, 64)));
        assert_eq!(place(MouseUnits::Pixels, [4, 9]), Some((21, 28)));
    }

    #[test]
    fn every_place_is_inside_the_window() {
        for units in [MouseUnits::Cells, MouseUnits::Pixels] {
            assert_eq!(place(units, [u32::MAX, u32::MAX]), Some((80 * 64, 24 * 64)));
            assert!(place(units, [0, 0]).is_some());
        }
    }

    #[test]
    fn pixels_are_ignored_if_their_number_is_unknown() {
        let report = MouseReport { kind: MouseEventKind::Moved, place: [100, 100] };
        assert_eq!(report.event(MouseUnits::Pixels, WindowSize::new((80, 24), (0, 0))), None);
    }

    fn aspect(cells: (u16, u16), pixels: (u16, u16)) -> Option<f64> {
        WindowSize::new(cells, pixels).cell_aspect
    }

    #[test]
    fn a_plausible_cell_shape_is_used() {
        assert_eq!(aspect((80, 24), (640, 384)), Some(2.0));
        assert_eq!(aspect((100, 50), (1000, 1100)), Some(2.2));
    }

    #[test]
    fn implausible_pixels_are_ignored() {
        for (cells, pixels) in [
            ((80, 24), (0, 0)),
            ((80, 24), (640, 0)),
            ((80, 24), (0, 384)),
            ((0, 0), (0, 0)),
            ((0, 0), (640, 384)),
            ((80, 24), (80, 24)),
            ((80, 24), (640, 3840)),
        ] {
            assert_eq!(aspect(cells, pixels), None, "{cells:?} {pixels:?}");
        }
    }

    #[test]
    fn no_window_is_too_large_to_draw() {
        let size = WindowSize::new((u16::MAX, u16::MAX), (0, 0));
        assert_eq!((size.columns, size.rows), (2048, 1024));
    }

    #[test]
    fn names_and_keys_agree() {
        for (name, key) in NAMES {
            assert_eq!(name.parse(), Ok(key));
            assert_eq!(key.to_string(), name);
        }
        for number in 1..=LAST_FUNCTION_KEY {
            let key = Key::Function(number);
            assert_eq!(key.to_string().parse(), Ok(key));
        }
    }

    #[test]
    fn either_case_names_the_same_key() {
        assert_eq!("W".parse(), Ok(Key::Char('w')));
        assert_eq!("Ä".parse(), Ok(Key::Char('ä')));
        assert_eq!("PageUp".parse(), Ok(Key::PageUp));
        assert_eq!("F11".parse(), Ok(Key::Function(11)));
    }

    #[test]
    fn an_invalid_name_is_refused_and_named() {
        for text in ["", "upp", "f0", "f36", "f+1", "f999", "ctrl-c", "\u{7}"] {
            let error = text.parse::<Key>().unwrap_err();
            assert!(error.to_string().starts_with(&format!("{text:?}")), "{error}");
        }
    }

    proptest! {
        #[test]
        fn every_character_key_survives_a_text_round_trip(character: char) {
            prop_assume!(!character.is_control());
            let key = Key::typing(character);
            prop_assert_eq!(key.to_string().parse::<Key>(), Ok(key));
        }
    }

    #[test]
    fn every_letter_in_the_table_has_one_place() {
        let mut letters = Vec::new();
        for (row, keys) in PLACES {
            assert_eq!(row.chars().count(), keys.chars().count(), "{row}");
            letters.extend(row.chars());
        }
        for &letter in &letters {
            assert_eq!(letters.iter().filter(|&&other| other == letter).count(), 1, "{letter}");
            assert!(base_key(Key::Char(letter), None).is_some(), "{letter}");
        }
    }

    #[test]
    fn latin_letters_and_signs_are_not_mapped() {
        for character in ['z', 'é', 'ß', 'ő', 'ĳ', 'ạ', ';', ' ', '7', '—'] {
            assert_eq!(base_key(Key::Char(character), Some('w')), None, "{character}");
        }
        assert_eq!(base_key(Key::Up, Some('w')), None);
    }

    #[test]
    fn the_key_reported_by_the_terminal_takes_precedence() {
        // A phonetic layout has this letter at the place of S.
        assert_eq!(base_key(Key::Char('с'), Some('s')), Some(Key::Char('s')));
        assert_eq!(base_key(Key::Char('с'), None), Some(Key::Char('c')));
        assert_eq!(base_key(Key::Char('ש'), None), None);
    }
}

//! A line of text that the visitor types.

use unicode_width::UnicodeWidthChar;

use crate::server::line::Line;
use crate::terminal::{Key, KeyEvent};

/// A line that is being typed. It takes printable characters only.
#[derive(Clone, Debug, Default)]
pub(super) struct LineEntry {
    text: String,
    /// The most columns.
    columns: usize,
    /// Whether the text is an offer, in whose place the first character is typed.
    is_offer: bool,
}

impl LineEntry {
    /// An empty line of at most `columns`.
    pub(super) fn new(columns: usize) -> Self {
        Self { columns, ..Self::default() }
    }

    /// A line with an offer in it.
    pub(super) fn offering(offer: &Line, columns: usize) -> Self {
        Self { text: offer.to_string(), columns, is_offer: true }
    }

    /// The text.
    #[cfg(test)]
    fn text(&self) -> &str {
        &self.text
    }

    /// The text as a line; `None` if it is blank.
    pub(super) fn line(&self) -> Option<Line> {
        Line::of(&self.text, self.columns)
    }

    /// Changes the text by a key. Returns whether it has changed.
    pub(super) fn press(&mut self, event: KeyEvent) -> bool {
        if event.key == Key::Backspace {
            self.is_offer = false;
            return self.text.pop().is_some();
        }
        let Some(character) = event.typed() else { return false };
        let before = if self.is_offer { "" } else { &self.text };
        let is_first = before.is_empty();
        // What would end a line is kept while it is typed.
        let is_printable = character == ' ' && !is_first
            || Line::of(character.encode_utf8(&mut [0; 4]), self.columns).is_some();
        let width: usize = before.chars().chain([character]).filter_map(char::width).sum();
        if !is_printable || width > self.columns {
            return false;
        }
        if std::mem::take(&mut self.is_offer) {
            self.text.clear();
        }
        self.text.push(character);
        true
    }

    /// The end of the text that fits in `columns` with a cursor after it.
    pub(super) fn shown(&self, columns: usize) -> String {
        let mut room = columns.saturating_sub(1);
        let fits = |character: &char| {
            let width = character.width().unwrap_or(0);
            let fits = width <= room;
            room = room.saturating_sub(width);
            fits
        };
        let mut shown: Vec<char> = self.text.chars().rev().take_while(fits).collect();
        shown.reverse();
        shown.into_iter().chain(['_']).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terminal::{Modifiers, Phase};

    fn event(key: Key, shift: bool) -> KeyEvent {
        let modifiers = Modifiers { shift, ..Modifiers::default() };
        KeyEvent { key, base: None, modifiers, phase: Phase::Press }
    }

    fn type_all(entry: &mut LineEntry, text: &str) {
        for character in text.chars() {
            entry.press(event(Key::Char(character), false));
        }
    }

    #[test]
    fn the_first_character_replaces_an_offer() {
        let offer = Line::of("guest-fox", 16).unwrap();
        let mut entry = LineEntry::offering(&offer, 16);
        assert_eq!(entry.line(), Some(offer.clone()));
        entry.press(event(Key::Char('m'), true));
        type_all(&mut entry, "ara v ");
        assert_eq!(entry.text(), "Mara v ");
        assert_eq!(entry.line().unwrap().as_str(), "Mara v");
        let mut entry = LineEntry::offering(&offer, 16);
        entry.press(event(Key::Backspace, false));
        type_all(&mut entry, "!");
        assert_eq!(entry.text(), "guest-fo!");
    }

    #[test]
    fn only_what_is_printable_and_fits_is_taken() {
        let mut entry = LineEntry::new(6);
        type_all(&mut entry, " a\u{1b}\u{7f}\u{202e}\u{301}日b日本");
        assert_eq!(entry.text(), "a日b日");
        assert_eq!(entry.shown(4), "b日_");
        assert_eq!(entry.shown(0), "_");
        assert_eq!(LineEntry::new(4).line(), None);
    }
}

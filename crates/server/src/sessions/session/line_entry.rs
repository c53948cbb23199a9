//! Entry of a line of text.

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use crate::accounts::printable;
use crate::line::Line;
use cellcaster::terminal::{Key, KeyEvent};

/// A line that is being typed. Its text always equals its [`printable`] form, except for a trailing blank.
#[derive(Clone, Debug, Default)]
pub(crate) struct LineEntry {
    text: String,
    /// The maximum width, in columns.
    pub(crate) columns: usize,
    /// Whether the text is an offer, which the first typed character replaces.
    is_offer: bool,
}

impl LineEntry {
    /// An entry that begins with `text`, of at most `columns` columns.
    pub(crate) fn beginning(text: &str, columns: usize) -> Self {
        Self { text: text.to_owned(), columns, ..Self::default() }
    }

    /// An entry that contains an offer.
    pub(crate) fn offering(offer: &Line, columns: usize) -> Self {
        Self { text: offer.to_string(), columns, is_offer: true }
    }

    /// The text as a line; `None` if it is blank.
    pub(crate) fn line(&self) -> Option<Line> {
        Line::of(&self.text, self.columns)
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Handles a key. Returns whether the text has changed.
    pub(crate) fn press(&mut self, event: KeyEvent) -> bool {
        if event.key == Key::Backspace {
            self.is_offer = false;
            return self.text.pop().is_some();
        }
        let Some(character) = event.typed() else { return false };
        let offer = self.is_offer.then(|| std::mem::take(&mut self.text));
        let is_taken = append(&mut self.text, character, self.columns);
        match offer {
            Some(offer) if !is_taken => self.text = offer,
            _ => self.is_offer = false,
        }
        is_taken
    }

    /// The end of the text, with a cursor, that fits into `columns`.
    pub(crate) fn shown(&self, columns: usize) -> String {
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

/// Appends a character to `line`, where it may combine with the last one. Returns whether it was accepted.
fn append(line: &mut String, character: char, columns: usize) -> bool {
    if character.is_whitespace() {
        let is_taken = !line.is_empty() && !line.ends_with(' ') && line.width() < columns;
        line.extend(is_taken.then_some(' '));
        return is_taken;
    }
    // A character can combine only with the last one.
    let last = line.chars().next_back().filter(|last| *last != ' ');
    line.truncate(line.len() - last.map_or(0, char::len_utf8));
    let room = columns.saturating_sub(line.width());
    let end = printable(&last.into_iter().chain([character]).collect::<String>(), room);
    let is_taken = !end.chars().eq(last);
    line.push_str(&end);
    is_taken
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::terminal::{Modifiers, Phase};

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
    fn the_first_character_replaces_the_offered_name() {
        let offer = Line::of("guest-fox", 16).unwrap();
        let mut entry = LineEntry::offering(&offer, 16);
        assert_eq!(entry.line(), Some(offer.clone()));
        entry.press(event(Key::Char('m'), true));
        type_all(&mut entry, "ara v ");
        assert_eq!(entry.text, "Mara v ");
        assert_eq!(entry.line().unwrap().as_str(), "Mara v");
        let mut entry = LineEntry::offering(&offer, 16);
        entry.press(event(Key::Backspace, false));
        type_all(&mut entry, "!");
        assert_eq!(entry.text, "guest-fo!");
    }

    #[test]
    fn only_printable_characters_that_fit_are_accepted() {
        let mut entry = LineEntry::beginning("", 6);
        type_all(&mut entry, " a\u{1b}\u{7f}\u{202e}\u{301}日b日本");
        // The accent combines with the character before it.
        assert_eq!(entry.text, "á日b日");
        assert_eq!(entry.shown(4), "b日_");
        assert_eq!(entry.shown(0), "_");
        assert_eq!(LineEntry::beginning("", 4).line(), None);
    }

    proptest::proptest! {
        #[test]
        fn typing_key_by_key_gives_the_same_line_as_pasting(
            text in "([a-e漢 \u{a0}][\u{300}-\u{303}]?|[ᄀ-ᄂ][ᅡ-ᅣ][ᆨ-ᆪ]?){0,16}",
        ) {
            let mut entry = LineEntry::beginning("", 60);
            type_all(&mut entry, &text);
            assert_eq!(entry.line(), Line::of(&text, 60), "{text:?}");
        }
    }

    #[test]
    fn the_line_is_shown_as_it_will_be_sent() {
        for text in ["e\u{301}te\u{301}", "a  b \u{a0}c", "\u{ad}\u{3164}x\u{e000}", "שלום 日本"]
        {
            let mut entry = LineEntry::beginning("", 12);
            type_all(&mut entry, text);
            assert_eq!(entry.line(), Line::of(text, 12), "{text:?}");
        }
        let mut entry = LineEntry::beginning("", 12);
        type_all(&mut entry, "cafe\u{301} ");
        assert_eq!(entry.text, "café ");
        assert!(!entry.press(event(Key::Char(' '), false)));
        assert!(!entry.press(event(Key::Char('\u{202e}'), false)));
        assert_eq!(entry.text, "café ");
    }
}

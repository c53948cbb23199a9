//! The characters that a screen shows, by number, so that what a cell looks like is one word.
//!
//! A character and its modifiers take 26 bits, and two colours 52. Most screens show some dozens of
//! characters; what there is no number for is shown all the same, but not compared.

use std::collections::BTreeMap;

use ratatui::style::Modifier;

/// A character that is one cell wide, and the modifiers it is drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Letter {
    character: char,
    /// As bits, which have an order.
    modifiers: u16,
}

/// The number of a letter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Number(u16);

/// The letters that have a number.
#[derive(Debug)]
pub(super) struct Alphabet {
    letters: Vec<Letter>,
    numbers: BTreeMap<Letter, Number>,
}

impl Letter {
    pub(super) const fn new(character: char, modifier: Modifier) -> Self {
        Self { character, modifiers: modifier.bits() }
    }

    pub(super) fn character(self) -> char {
        self.character
    }

    pub(super) fn modifier(self) -> Modifier {
        Modifier::from_bits_truncate(self.modifiers)
    }
}

impl Number {
    /// The number of a space without modifiers, in every alphabet.
    pub(super) const SPACE: Self = Self(0);
    /// That of an upper half block, likewise.
    pub(super) const UPPER_HALF: Self = Self(1);
    /// So many letters have a number.
    pub(super) const COUNT: u16 = 4000;

    /// Lower than their count.
    pub(super) const fn get(self) -> u16 {
        self.0
    }

    /// That number, if it is one that [`Number::get`] gave.
    pub(super) fn new(number: u16) -> Self {
        Self(number)
    }
}

impl Alphabet {
    /// The number of `letter`, a new one if it has none yet; `None` where all have been given away.
    pub(super) fn number(&mut self, letter: Letter) -> Option<Number> {
        if let Some(&number) = self.numbers.get(&letter) {
            return Some(number);
        }
        let next = u16::try_from(self.letters.len()).ok()?;
        let number = (next < Number::COUNT).then_some(Number(next))?;
        self.letters.push(letter);
        self.numbers.insert(letter, number);
        Some(number)
    }

    /// The letter that has that number.
    pub(super) fn letter(&self, number: Number) -> Letter {
        self.letters[usize::from(number.0)]
    }
}

impl Default for Alphabet {
    fn default() -> Self {
        let mut alphabet = Self { letters: Vec::new(), numbers: BTreeMap::new() };
        let mut number = |letter| alphabet.number(Letter::new(letter, Modifier::empty()));
        let numbers = [' ', '▀'].map(&mut number);
        debug_assert_eq!(numbers, [Some(Number::SPACE), Some(Number::UPPER_HALF)]);
        alphabet
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_have_numbers_until_there_are_no_more() {
        let mut alphabet = Alphabet::default();
        // A half block has one from the start.
        let letters = || {
            std::iter::once('▀').chain(' '..).map(|letter| Letter::new(letter, Modifier::empty()))
        };
        let numbers: Vec<_> =
            letters().take(Number::COUNT.into()).map(|letter| alphabet.number(letter)).collect();
        for (letter, number) in letters().zip(&numbers) {
            assert_eq!(alphabet.letter(number.unwrap()), letter);
            assert_eq!(alphabet.number(letter), *number);
        }
        assert_eq!(alphabet.number(Letter::new('a', Modifier::BOLD)), None);
    }
}

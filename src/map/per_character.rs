//! A value for each character: an array for ASCII, a tree for other characters.

use std::collections::BTreeMap;

const ASCII_COUNT: usize = 128;

/// A value for each character, the default at first.
pub(crate) struct PerCharacter<T> {
    ascii: [T; ASCII_COUNT],
    others: BTreeMap<char, T>,
}

impl<T: Copy + Default> PerCharacter<T> {
    pub(crate) fn new() -> Self {
        Self { ascii: [T::default(); ASCII_COUNT], others: BTreeMap::new() }
    }

    pub(crate) fn get(&self, character: char) -> T {
        match self.ascii.get(character as usize) {
            Some(value) => *value,
            None => self.others.get(&character).copied().unwrap_or_default(),
        }
    }

    pub(crate) fn get_mut(&mut self, character: char) -> &mut T {
        match self.ascii.get_mut(character as usize) {
            Some(value) => value,
            None => self.others.entry(character).or_default(),
        }
    }

    /// The characters and their values, in the order of the characters.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (char, T)> {
        let ascii = (0..).map(|code: u8| char::from(code)).zip(self.ascii);
        ascii.chain(self.others.iter().map(|(&character, &value)| (character, value)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn characters_come_in_their_order() {
        let mut counts = PerCharacter::<u32>::new();
        for character in "éxaé\u{7f}\u{80}\0".chars() {
            *counts.get_mut(character) += 1;
        }
        let seen: Vec<_> = counts.iter().filter(|&(_, count)| count > 0).collect();
        let expected = [('\0', 1), ('a', 1), ('x', 1), ('\u{7f}', 1), ('\u{80}', 1), ('é', 2)];
        assert_eq!(seen, expected);
        assert_eq!((counts.get('é'), counts.get('b'), counts.get('ß')), (2, 0, 0));
    }
}

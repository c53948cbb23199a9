//! Private rooms: their invitation codes, and the limit on guesses.
//!
//! - A code has six letters, without vowels and without letters that look like another one. So nobody misreads it,
//!   and no code is a word. There are 24 million codes.
//! - Codes come from a seed of their own. Rejected: the seed of the rooms. Recordings contain the rooms' seeds, and
//!   from one of them all later numbers follow.
//! - Each wrong code costs the visitor's address and key a token of a bucket. Without a token, no code is looked up.
//!   With one address, somebody needs a month on average to find one of a hundred rooms.

use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

use crate::accounts::{AccountKey, AddressPrefix, serialized_as_text};
use crate::bucket::Bucket;
use cellcaster::rng::SplitMix64;

/// The letters of codes.
const LETTERS: &[u8] = b"BCDFGHJKMPQRSTWXZ";
/// The number of letters in a code.
pub(crate) const CODE_LETTERS: usize = 6;

/// The code of a private room, with which others enter it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RoomCode([u8; CODE_LETTERS]);

serialized_as_text!(RoomCode: "an invitation code");

impl RoomCode {
    /// A new code.
    pub(crate) fn random(chance: &mut SplitMix64) -> Self {
        Self(std::array::from_fn(|_| {
            // A letter depends on two numbers, so letters do not reveal the generator's state.
            let bits = chance.bits() ^ chance.bits();
            LETTERS[(bits % LETTERS.len() as u64) as usize]
        }))
    }

    /// Parses a code as somebody typed it: in upper or lower case, with or without blanks.
    pub(crate) fn parse(text: &str) -> Option<Self> {
        let mut letters = text.bytes().filter(|letter| !letter.is_ascii_whitespace());
        let mut next = || letters.next().map(|letter| letter.to_ascii_uppercase());
        let mut code = [0; CODE_LETTERS];
        for letter in &mut code {
            *letter = next().filter(|letter| LETTERS.contains(letter))?;
        }
        next().is_none().then_some(Self(code))
    }
}

impl fmt::Display for RoomCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|&letter| write!(f, "{}", char::from(letter)))
    }
}

/// The number of wrong codes at once, and per minute after that.
const MAX_WRONG: f64 = 5.0;
/// The maximum number of addresses and keys with wrong codes. Beyond that, nobody else may guess for a while.
const MAX_GUESSERS: usize = 4096;

/// The addresses and keys from which wrong codes came in the last minute.
#[derive(Debug, Default)]
pub(crate) struct WrongCodes(BTreeMap<Guesser, Bucket>);

/// An address or a key that somebody guesses from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Guesser {
    /// An IPv4 address or a /64 of IPv6.
    Address(AddressPrefix),
    Key(AccountKey),
}

impl WrongCodes {
    /// Returns true if all of `guessers` may try a code.
    pub(crate) fn may_try(&mut self, guessers: &[Guesser], now: Duration) -> bool {
        self.0.retain(|_, bucket| bucket.fill(now) < MAX_WRONG);
        guessers.iter().all(|guesser| match self.0.get_mut(guesser) {
            Some(bucket) => bucket.fill(now) >= 1.0,
            None => self.0.len() < MAX_GUESSERS,
        })
    }

    /// Counts a wrong code of `guessers`, who were allowed to try it.
    pub(crate) fn count(&mut self, guessers: &[Guesser], now: Duration) {
        for guesser in guessers {
            let new = || Bucket::new(MAX_WRONG / 60.0, MAX_WRONG, now);
            self.0.entry(*guesser).or_insert_with(new).take(1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::admission::counted_address;

    #[test]
    fn a_code_is_read_as_people_type_it() {
        let code = RoomCode::random(&mut SplitMix64::new(7));
        let text = code.to_string();
        let (first, last) = text.split_at(3);
        for typed in [text.clone(), text.to_lowercase(), format!(" {first} {last} ")] {
            assert_eq!(RoomCode::parse(&typed), Some(code), "{typed:?}");
        }
        for wrong in ["", first, "BCDFGA", "BCDFG1", "BCDFGHJ", "BCDFG\u{212a}"] {
            assert_eq!(RoomCode::parse(wrong), None, "{wrong:?}");
        }
    }

    #[test]
    fn wrong_codes_are_limited_by_address_and_by_key() {
        let address = |last| Guesser::Address(counted_address([192, 0, 2, last].into()));
        let key = Guesser::Key(AccountKey::new([7; 32]));
        let mut wrong = WrongCodes::default();
        let mut tries = |guessers: &[Guesser], seconds| {
            let now = Duration::from_secs(seconds);
            let tries = (0..100).take_while(|_| {
                let may = wrong.may_try(guessers, now);
                if may {
                    wrong.count(guessers, now);
                }
                may
            });
            tries.count()
        };
        assert_eq!(tries(&[address(1), key], 0), 5);
        assert_eq!(tries(&[address(1)], 0), 0);
        assert_eq!(tries(&[address(2), key], 0), 0);
        assert_eq!(tries(&[address(2)], 0), 5);
        assert_eq!(tries(&[address(1), key], 24), 2);
        assert_eq!(tries(&[address(1)], 600), 5);
    }

    #[test]
    fn the_memory_for_wrong_codes_is_bounded() {
        let mut wrong = WrongCodes::default();
        let guesser = |number: u32| Guesser::Address(counted_address(number.to_be_bytes().into()));
        for number in 0..2 * MAX_GUESSERS as u32 {
            if wrong.may_try(&[guesser(number)], Duration::ZERO) {
                wrong.count(&[guesser(number)], Duration::ZERO);
            }
        }
        assert_eq!(wrong.0.len(), MAX_GUESSERS);
        let later = Duration::from_mins(1);
        assert!(wrong.may_try(&[guesser(u32::MAX)], later) && wrong.0.is_empty());
    }
}

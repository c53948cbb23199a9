//! The bytes of a stored game: how values are written, and how they are read by somebody who does not
//! trust the writer.
//!
//! - A whole number is a variable-length integer: 7 bits in a byte, the lowest first. A signed one is
//!   first mapped to 0, −1, 1, −2, ….
//! - A real number is the eight bytes of its bits. It is finite, and at most 4·10⁹.
//! - A list is its length and its elements, each of at least one byte. So what is read takes at most a
//!   constant multiple of the memory of the bytes.
//! - A cell is on the map.
//!
//! The state of a type is named once, by the macro `stored!` beside its definition. It takes the type
//! apart without `..`: a new field does not compile before it is named there.

use glam::DVec2;

use super::Unrestorable;
use crate::world::World;

/// A value that is stored as a whole.
pub trait Stored: Sized {
    /// Appends the value.
    fn write(&self, out: &mut Writer);

    /// Reads a value.
    fn read(input: &mut Reader) -> Result<Self, Unrestorable>;
}

/// A value of which the level gives one part, and the other part is stored.
pub trait StoredPart {
    /// Appends the part that is stored.
    fn write(&self, out: &mut Writer);

    /// Replaces the part that is stored in a value of the same level.
    fn read_over(&mut self, input: &mut Reader) -> Result<(), Unrestorable>;
}

/// Bytes that grow.
#[derive(Debug, Default)]
pub struct Writer {
    bytes: Vec<u8>,
}

impl Writer {
    /// What was written.
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    /// Appends bytes as they are.
    pub fn raw(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// Appends a whole number.
    pub fn number(&mut self, mut number: u64) {
        while number >= 0x80 {
            self.bytes.push(number as u8 | 0x80);
            number >>= 7;
        }
        self.bytes.push(number as u8);
    }

    /// Appends the parts of values that the level gives too, with their number.
    pub(crate) fn parts(&mut self, parts: &[impl StoredPart]) {
        self.number(parts.len() as u64);
        for part in parts {
            part.write(self);
        }
    }
}

/// Bytes that are left to read, and the size of the map that they are about.
#[derive(Debug)]
pub struct Reader<'a> {
    bytes: &'a [u8],
    size: (u32, u32),
}

impl<'a> Reader<'a> {
    /// Reads `bytes`, in which all cells are on a map with that many columns and rows.
    pub fn new(bytes: &'a [u8], size: (u32, u32)) -> Self {
        Self { bytes, size }
    }

    /// The columns and rows of the map.
    pub(crate) fn size(&self) -> (u32, u32) {
        self.size
    }

    /// The bytes that are left.
    pub fn rest(&self) -> &'a [u8] {
        self.bytes
    }

    /// Takes the next `count` bytes.
    pub(crate) fn raw(&mut self, count: usize) -> Result<&'a [u8], Unrestorable> {
        let (taken, rest) = self.bytes.split_at_checked(count).ok_or(Unrestorable::Cut)?;
        self.bytes = rest;
        Ok(taken)
    }

    /// Reads a whole number in its shortest form.
    pub fn number(&mut self) -> Result<u64, Unrestorable> {
        let mut number = 0;
        for shift in (0..u64::BITS).step_by(7) {
            let byte = self.raw(1)?[0];
            let part = u64::from(byte & 0x7f);
            let is_whole = part << shift >> shift == part;
            let is_shortest = byte != 0 || shift == 0;
            if !is_whole || !is_shortest {
                break;
            }
            number |= part << shift;
            if byte < 0x80 {
                return Ok(number);
            }
        }
        Err(Unrestorable::Damaged("a number"))
    }

    /// Reads a whole number up to `most`.
    pub fn number_to(&mut self, most: u64) -> Result<u64, Unrestorable> {
        let number = self.number()?;
        (number <= most).then_some(number).ok_or(Unrestorable::Damaged("a number"))
    }

    /// Reads the length of a list whose elements have at least one byte.
    pub(crate) fn length(&mut self) -> Result<usize, Unrestorable> {
        let length = self.number()?;
        if length > self.bytes.len() as u64 { Err(Unrestorable::Cut) } else { Ok(length as usize) }
    }

    /// Reads a list of at most `most` values.
    pub fn list<T: Stored>(&mut self, most: usize) -> Result<Vec<T>, Unrestorable> {
        let length = self.length()?;
        check(length <= most, "the length of a list")?;
        (0..length).map(|_| T::read(self)).collect()
    }

    /// Reads over parts of values, as many as there are.
    pub(crate) fn parts(&mut self, parts: &mut [impl StoredPart]) -> Result<(), Unrestorable> {
        if self.number()? != parts.len() as u64 {
            return Err(Unrestorable::OtherLevel);
        }
        parts.iter_mut().try_for_each(|part| part.read_over(self))
    }
}

/// An error that names `what`, unless it holds.
pub fn check(holds: bool, what: &'static str) -> Result<(), Unrestorable> {
    if holds { Ok(()) } else { Err(Unrestorable::Damaged(what)) }
}

/// An error, unless a position is on the map of `world`.
pub fn check_on_map(world: &World, position: DVec2) -> Result<(), Unrestorable> {
    let end = DVec2::new(world.grid().width().into(), world.grid().height().into());
    let is_on_map = position.cmpge(DVec2::ZERO).all() && position.cmplt(end).all();
    check(is_on_map, "a position")
}

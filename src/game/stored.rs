//! The format of stored games, and checksums, which are hashes of stored bytes.
//!
//! The first line identifies the version that can read the rest:
//!
//! ```text
//! cellcaster-game 2 rules 2 version 0.1.0
//! ```
//!
//! The rest is the state in the format of [`postcard`]. The bytes may come from a network.
//! Therefore [`Reader`], which reads them, is stricter than the reader of `postcard`: it accepts
//! only numbers that a game can add to for years, and only cells on the map. Each type checks its
//! other invariants. Whatever the bytes are, reading them ends and takes memory in proportion to
//! them and to the level. It returns an error, or a game in which every index is valid and every
//! step succeeds. It does not prove that the game was ever played like that.
//!
//! Rejected: storing the script up to now. Replaying it takes a second for each minute. Rejected:
//! `postcard`'s own reader with a check of each number afterwards. A new field would be unchecked
//! until somebody notices.

#[cfg(test)]
pub(crate) mod tests;

use std::fmt;

use glam::DVec2;
use postcard::ser_flavors::Flavor;
use serde::de::{
    DeserializeOwned, DeserializeSeed, EnumAccess, Error as _, IntoDeserializer, MapAccess,
    SeqAccess, VariantAccess, Visitor,
};
use serde::{Deserialize, Deserializer, Serialize, forward_to_deserialize_any};

use crate::rng::hash;
use crate::world::World;

/// The version of the rules. It is incremented by every change after which the same intents may
/// produce a different game.
pub const RULES_VERSION: u32 = 2;

/// The version of the format.
const FORMAT_VERSION: u32 = 2;
/// The maximum number of bytes that are read.
pub const MAX_BYTES: usize = 1 << 20;
/// The largest real number in a game: above twice the greatest height of a map.
const MAX_REAL: f64 = 4e9;
/// The largest time or count. A game can add smaller numbers for millions of years without an
/// overflow.
pub const MAX_COUNT: u64 = 1 << 53;

/// An error while reading a stored game.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestoreError {
    /// The bytes are not a stored game, or come from another version of the format, the rules or
    /// the crate.
    OtherVersion,
    /// The game belongs to another level or to other rules.
    OtherLevel,
    /// The bytes end too early.
    Cut,
    /// The bytes continue after the end.
    Longer,
    /// There are more than the maximum of 2²⁰ bytes.
    TooLong,
    /// This part is out of its range.
    Damaged(&'static str),
}

impl fmt::Display for RestoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherVersion => write!(
                f,
                "the state is not from version {} of Cellcaster with version {RULES_VERSION} of \
                 the rules",
                env!("CARGO_PKG_VERSION")
            ),
            Self::OtherLevel => f.write_str("the state belongs to another level or other rules"),
            Self::Cut => f.write_str("the state ends too early"),
            Self::Longer => f.write_str("the state has bytes after its end"),
            Self::TooLong => write!(f, "the state is longer than {MAX_BYTES} bytes"),
            Self::Damaged(what) => write!(f, "the state is damaged: {what} is out of range"),
        }
    }
}

impl std::error::Error for RestoreError {}

impl serde::de::Error for RestoreError {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Self::Damaged("a value")
    }
}

/// The first line for `kind`, followed by `value`.
///
/// # Panics
/// If a list in `value` does not know its length. No type of the game contains such a list.
pub fn written(kind: &str, value: &impl Serialize) -> Vec<u8> {
    appended(first_line(kind).into_bytes(), value)
}

/// `bytes`, followed by `value`.
///
/// # Panics
/// See [`written`].
pub fn appended(bytes: Vec<u8>, value: &impl Serialize) -> Vec<u8> {
    postcard::to_extend(value, bytes).expect("all lists have a length, and memory takes all bytes")
}

/// The hash of the bytes in which `value` is stored.
///
/// # Panics
/// See [`written`].
pub fn checksum(value: &impl Serialize) -> u64 {
    postcard::serialize_with_flavor(value, Hash::default()).expect("all lists have a length")
}

/// The hash of the bytes that are written, eight at a time.
#[derive(Default)]
struct Hash {
    bits: u64,
    word: u64,
    count: u64,
}

impl Flavor for Hash {
    type Output = u64;

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.word = self.word << 8 | u64::from(byte);
        self.count += 1;
        if self.count.is_multiple_of(8) {
            self.bits = hash(self.bits, [self.word]);
        }
        Ok(())
    }

    fn finalize(self) -> postcard::Result<u64> {
        Ok(hash(self.bits, [self.word, self.count]))
    }
}

/// The first line of data stored as `kind`.
pub fn first_line(kind: &str) -> String {
    let version = env!("CARGO_PKG_VERSION");
    format!("cellcaster-{kind} {FORMAT_VERSION} rules {RULES_VERSION} version {version}\n")
}

/// A state that takes the fields skipped by serde from the level.
pub(crate) trait OfLevel: DeserializeOwned {
    /// The state with the skipped fields of `start`, the state at the start of the same level.
    fn of_level(self, start: Self) -> Result<Self, RestoreError>;
}

impl<T: OfLevel> OfLevel for Vec<T> {
    fn of_level(self, start: Self) -> Result<Self, RestoreError> {
        if self.len() != start.len() {
            return Err(RestoreError::OtherLevel);
        }
        self.into_iter().zip(start).map(|(state, start)| state.of_level(start)).collect()
    }
}

/// Numbers of any size as eight bytes, for `#[serde(with)]`.
pub mod bits {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    /// Writes all 64 bits of any number.
    ///
    /// # Errors
    /// If `to` fails.
    pub fn serialize<S: Serializer>(bits: &u64, to: S) -> Result<S::Ok, S::Error> {
        bits.to_le_bytes().serialize(to)
    }

    /// Reads any 64 bits.
    ///
    /// # Errors
    /// If `from` fails.
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<u64, D::Error> {
        Deserialize::deserialize(from).map(u64::from_le_bytes)
    }
}

/// Checks a part of the restored state.
///
/// # Errors
/// [`RestoreError::Damaged`] with `what`, unless `holds` is true.
pub fn check(holds: bool, what: &'static str) -> Result<(), RestoreError> {
    if holds { Ok(()) } else { Err(RestoreError::Damaged(what)) }
}

/// Returns an error unless a position is on the map of `world`.
pub(crate) fn check_on_map(world: &World, position: DVec2) -> Result<(), RestoreError> {
    let end = DVec2::new(world.grid().width().into(), world.grid().height().into());
    let is_on_map = position.cmpge(DVec2::ZERO).all() && position.cmplt(end).all();
    check(is_on_map, "a position")
}

/// Reads a list of at most `MAX` values, for `#[serde(deserialize_with)]`. Needed for values that
/// are much larger than their bytes.
pub(crate) fn at_most<'de, const MAX: usize, T, D>(from: D) -> Result<Vec<T>, D::Error>
where
    T: Deserialize<'de>,
    D: Deserializer<'de>,
{
    struct ListVisitor<T, const MAX: usize>(std::marker::PhantomData<T>);

    impl<'de, T: Deserialize<'de>, const MAX: usize> Visitor<'de> for ListVisitor<T, MAX> {
        type Value = Vec<T>;

        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            write!(f, "at most {MAX} values")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Vec<T>, A::Error> {
            let mut values = Vec::new();
            while let Some(value) = list.next_element()? {
                if values.len() == MAX {
                    return Err(A::Error::custom("a list is too long"));
                }
                values.push(value);
            }
            Ok(values)
        }
    }

    from.deserialize_seq(ListVisitor::<T, MAX>(std::marker::PhantomData))
}

/// The remaining bytes to read, and the size of the map that they refer to.
///
/// - A whole number is a variable-length integer: 7 bits in a byte, the lowest first. A signed
///   number is first mapped to 0, −1, 1, −2, …. No number is above [`MAX_COUNT`].
/// - A real number is the eight bytes of its bits. It is finite, and at most [`MAX_REAL`].
/// - A list is its length and its elements, each of at least one byte.
/// - A [`Cell`](crate::world::Cell) is on the map.
#[derive(Clone, Debug)]
pub struct Reader<'de> {
    bytes: &'de [u8],
    size: (u32, u32),
}

impl<'de> Reader<'de> {
    /// Reads data stored as `kind`, in which all cells are on a map with `size` columns and rows.
    ///
    /// # Errors
    /// If there are too many bytes, or if they are of another kind or version.
    pub fn new(kind: &str, bytes: &'de [u8], size: (u32, u32)) -> Result<Self, RestoreError> {
        let Self { bytes, .. } = Self::of(bytes)?;
        let bytes = bytes.strip_prefix(first_line(kind).as_bytes());
        Ok(Self { bytes: bytes.ok_or(RestoreError::OtherVersion)?, size })
    }

    /// Reads bytes that have no first line and contain no cells.
    ///
    /// # Errors
    /// If there are too many bytes.
    pub fn of(bytes: &'de [u8]) -> Result<Self, RestoreError> {
        let is_short = bytes.len() <= MAX_BYTES;
        is_short.then_some(Self { bytes, size: (0, 0) }).ok_or(RestoreError::TooLong)
    }

    /// The remaining bytes.
    pub fn rest(&self) -> &'de [u8] {
        self.bytes
    }

    /// Reads a value.
    ///
    /// # Errors
    /// If the bytes end too early, or a part is out of its range.
    pub fn read<T: Deserialize<'de>>(&mut self) -> Result<T, RestoreError> {
        T::deserialize(self)
    }

    /// Reads a value. Its skipped fields come from `start`, the value at the start of the level.
    pub(crate) fn read_with<T: OfLevel>(&mut self, start: T) -> Result<T, RestoreError> {
        self.read::<T>()?.of_level(start)
    }

    fn take(&mut self, count: usize) -> Result<&'de [u8], RestoreError> {
        let (taken, rest) = self.bytes.split_at_checked(count).ok_or(RestoreError::Cut)?;
        self.bytes = rest;
        Ok(taken)
    }

    fn number(&mut self) -> Result<u64, RestoreError> {
        let mut number = 0;
        for shift in (0..=49).step_by(7) {
            let byte = self.take(1)?[0];
            number |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                check(number <= MAX_COUNT, "a number")?;
                return Ok(number);
            }
        }
        Err(RestoreError::Damaged("a number"))
    }

    fn signed_number(&mut self) -> Result<i64, RestoreError> {
        let number = self.number()?;
        Ok((number >> 1) as i64 ^ -((number & 1) as i64))
    }

    fn flag(&mut self) -> Result<bool, RestoreError> {
        let byte = self.take(1)?[0];
        check(byte <= 1, "a flag")?;
        Ok(byte == 1)
    }

    /// Reads the length of a list whose elements have at least one byte.
    fn length(&mut self) -> Result<usize, RestoreError> {
        let length = self.number()?;
        if length > self.bytes.len() as u64 { Err(RestoreError::Cut) } else { Ok(length as usize) }
    }
}

macro_rules! numbers {
    ($($method:ident: $read:ident, $visit:ident;)*) => {$(
        fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, RestoreError> {
            visitor.$visit(self.$read()?)
        }
    )*};
}

impl<'de> Deserializer<'de> for &mut Reader<'de> {
    type Error = RestoreError;

    numbers! {
        deserialize_bool: flag, visit_bool;
        deserialize_u16: number, visit_u64;
        deserialize_u32: number, visit_u64;
        deserialize_u64: number, visit_u64;
        deserialize_i16: signed_number, visit_i64;
        deserialize_i32: signed_number, visit_i64;
    }

    fn deserialize_u8<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, RestoreError> {
        visitor.visit_u8(self.take(1)?[0])
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, RestoreError> {
        let mut bits = [0; 8];
        bits.copy_from_slice(self.take(8)?);
        let real = f64::from_le_bytes(bits);
        check(real.abs() <= MAX_REAL, "a real number")?;
        visitor.visit_f64(real)
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, RestoreError> {
        let length = self.length()?;
        let text = std::str::from_utf8(self.take(length)?);
        visitor.visit_borrowed_str(text.map_err(|_| RestoreError::Damaged("a text"))?)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, RestoreError> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, RestoreError> {
        if self.flag()? { visitor.visit_some(self) } else { visitor.visit_none() }
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, RestoreError> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, RestoreError> {
        let left = self.length()?;
        visitor.visit_seq(Elements { input: self, left })
    }

    fn deserialize_map<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, RestoreError> {
        let left = self.length()?;
        visitor.visit_map(Elements { input: self, left })
    }

    fn deserialize_tuple<V: Visitor<'de>>(
        self,
        left: usize,
        visitor: V,
    ) -> Result<V::Value, RestoreError> {
        visitor.visit_seq(Elements { input: self, left })
    }

    fn deserialize_tuple_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        left: usize,
        visitor: V,
    ) -> Result<V::Value, RestoreError> {
        self.deserialize_tuple(left, visitor)
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, RestoreError> {
        if name == "Cell" {
            let mut ahead = self.clone();
            let (column, row) = (ahead.number()?, ahead.number()?);
            check(column < self.size.0.into() && row < self.size.1.into(), "a cell")?;
        }
        self.deserialize_tuple(fields.len(), visitor)
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, RestoreError> {
        visitor.visit_enum(self)
    }

    /// The format does not describe its types.
    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, RestoreError> {
        Err(RestoreError::Damaged("a value"))
    }

    forward_to_deserialize_any! {
        i8 i64 f32 char bytes byte_buf unit unit_struct identifier ignored_any
    }

    fn is_human_readable(&self) -> bool {
        false
    }
}

/// The remaining elements of a list.
struct Elements<'a, 'de> {
    input: &'a mut Reader<'de>,
    left: usize,
}

impl<'de> SeqAccess<'de> for Elements<'_, 'de> {
    type Error = RestoreError;

    fn next_element_seed<T: DeserializeSeed<'de>>(
        &mut self,
        seed: T,
    ) -> Result<Option<T::Value>, RestoreError> {
        let Some(left) = self.left.checked_sub(1) else { return Ok(None) };
        self.left = left;
        seed.deserialize(&mut *self.input).map(Some)
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.left)
    }
}

impl<'de> MapAccess<'de> for Elements<'_, 'de> {
    type Error = RestoreError;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, RestoreError> {
        self.next_element_seed(seed)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(
        &mut self,
        seed: V,
    ) -> Result<V::Value, RestoreError> {
        seed.deserialize(&mut *self.input)
    }
}

impl<'de> EnumAccess<'de> for &mut Reader<'de> {
    type Error = RestoreError;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(
        self,
        seed: V,
    ) -> Result<(V::Value, Self), RestoreError> {
        let variant = self.number()?;
        Ok((seed.deserialize(variant.into_deserializer())?, self))
    }
}

impl<'de> VariantAccess<'de> for &mut Reader<'de> {
    type Error = RestoreError;

    fn unit_variant(self) -> Result<(), RestoreError> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(
        self,
        seed: T,
    ) -> Result<T::Value, RestoreError> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(
        self,
        left: usize,
        visitor: V,
    ) -> Result<V::Value, RestoreError> {
        self.deserialize_tuple(left, visitor)
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, RestoreError> {
        self.deserialize_tuple(fields.len(), visitor)
    }
}

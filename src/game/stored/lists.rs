//! Lists, sets and texts among stored values.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::Unrestorable;
use super::codec::{Reader, Stored, Writer, check};
use crate::sort;

fn write_list<'a, T: Stored + 'a>(list: impl ExactSizeIterator<Item = &'a T>, out: &mut Writer) {
    out.number(list.len() as u64);
    for value in list {
        value.write(out);
    }
}

fn read_list<T: Stored, L: FromIterator<T>>(input: &mut Reader) -> Result<L, Unrestorable> {
    let length = input.length()?;
    (0..length).map(|_| T::read(input)).collect()
}

impl<T: Stored> Stored for Vec<T> {
    fn write(&self, out: &mut Writer) {
        write_list(self.iter(), out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        read_list(input)
    }
}

impl<T: Stored> Stored for VecDeque<T> {
    fn write(&self, out: &mut Writer) {
        write_list(self.iter(), out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        read_list(input)
    }
}

impl<T: Stored + Ord> Stored for BTreeSet<T> {
    fn write(&self, out: &mut Writer) {
        write_list(self.iter(), out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let list: Vec<T> = read_list(input)?;
        check(list.is_sorted_by(|one, other| one < other), "the order of a set")?;
        Ok(sort::gathered(list))
    }
}

impl<K: Stored + Ord, V: Stored> Stored for BTreeMap<K, V> {
    fn write(&self, out: &mut Writer) {
        out.number(self.len() as u64);
        for (key, value) in self {
            key.write(out);
            value.write(out);
        }
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let list: Vec<(K, V)> = read_list(input)?;
        check(list.is_sorted_by(|one, other| one.0 < other.0), "the order of a map")?;
        Ok(sort::gathered(list))
    }
}

impl<T: Stored, const COUNT: usize> Stored for [T; COUNT] {
    fn write(&self, out: &mut Writer) {
        for value in self {
            value.write(out);
        }
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let list: Vec<T> = (0..COUNT).map(|_| T::read(input)).collect::<Result<_, _>>()?;
        Self::try_from(list).map_err(|_| Unrestorable::Cut)
    }
}

impl Stored for String {
    fn write(&self, out: &mut Writer) {
        out.number(self.len() as u64);
        out.raw(self.as_bytes());
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let length = input.length()?;
        let text = std::str::from_utf8(input.raw(length)?).ok();
        text.map(str::to_owned).ok_or(Unrestorable::Damaged("a text"))
    }
}

//! Numbers and pairs of them among stored values.

use std::convert::identity;

use glam::DVec2;

use super::Unrestorable;
use super::codec::{Reader, Stored, Writer, check};
use crate::world::Cell;

/// The largest real number that a game has anywhere: above twice the greatest height of a map.
const MOST_REAL: f64 = 4e9;
/// The largest time or count. Numbers below it can be added for millions of years.
pub const MOST_COUNT: u64 = 1 << 53;

macro_rules! whole_numbers {
    ($($type:ident by $widened:expr, to $most:expr;)*) => {$(
        impl Stored for $type {
            fn write(&self, out: &mut Writer) {
                out.number($widened(*self));
            }

            fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
                Ok(input.number_to($most)? as $type)
            }
        }
    )*};
}

whole_numbers!(
    u8 by u64::from, to u8::MAX.into();
    u16 by u64::from, to u16::MAX.into();
    u32 by u64::from, to u32::MAX.into();
    u64 by identity, to MOST_COUNT;
    usize by |index| index as u64, to u32::MAX.into();
);

macro_rules! signed_numbers {
    ($($type:ident),*) => {$(
        impl Stored for $type {
            fn write(&self, out: &mut Writer) {
                let wide = i64::from(*self);
                out.number((wide << 1 ^ wide >> 63) as u64);
            }

            fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
                let number = input.number()?;
                let wide = (number >> 1) as i64 ^ -((number & 1) as i64);
                Self::try_from(wide).map_err(|_| Unrestorable::Damaged("a number"))
            }
        }
    )*};
}

signed_numbers!(i16, i32);

impl Stored for bool {
    fn write(&self, out: &mut Writer) {
        out.number((*self).into());
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        Ok(input.number_to(1)? == 1)
    }
}

impl Stored for f64 {
    fn write(&self, out: &mut Writer) {
        out.raw(&self.to_bits().to_le_bytes());
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let mut bits = [0; 8];
        bits.copy_from_slice(input.raw(8)?);
        let real = Self::from_bits(u64::from_le_bytes(bits));
        check(real.abs() <= MOST_REAL, "a real number")?;
        Ok(real)
    }
}

impl Stored for DVec2 {
    fn write(&self, out: &mut Writer) {
        self.x.write(out);
        self.y.write(out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        Ok(Self::new(Stored::read(input)?, Stored::read(input)?))
    }
}

impl Stored for Cell {
    fn write(&self, out: &mut Writer) {
        let Self { column, row } = self;
        column.write(out);
        row.write(out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let (columns, rows) = input.size();
        let cell = Self { column: Stored::read(input)?, row: Stored::read(input)? };
        check(cell.column < columns && cell.row < rows, "a cell")?;
        Ok(cell)
    }
}

impl<T: Stored> Stored for Option<T> {
    fn write(&self, out: &mut Writer) {
        self.is_some().write(out);
        if let Some(value) = self {
            value.write(out);
        }
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        Ok(if Stored::read(input)? { Some(T::read(input)?) } else { None })
    }
}

impl<A: Stored, B: Stored, C: Stored> Stored for (A, B, C) {
    fn write(&self, out: &mut Writer) {
        self.0.write(out);
        self.1.write(out);
        self.2.write(out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        Ok((Stored::read(input)?, Stored::read(input)?, Stored::read(input)?))
    }
}

impl<A: Stored, B: Stored> Stored for (A, B) {
    fn write(&self, out: &mut Writer) {
        self.0.write(out);
        self.1.write(out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        Ok((Stored::read(input)?, Stored::read(input)?))
    }
}

//! Values as PostgreSQL has them.
//!
//! A text of PostgreSQL has no character with the number 0. It is written as U+0001 and `0`, and U+0001 itself
//! as U+0001 and `1`, so that each text has one form, and another text another one. All other texts are
//! themselves.

use std::borrow::Cow;
use std::error::Error;

use tokio_postgres::types::private::BytesMut;
use tokio_postgres::types::{FromSql, IsNull, ToSql, Type, to_sql_checked};

use crate::accounts::sql::Value;

const ESCAPE: char = '\u{1}';

impl ToSql for Value {
    fn to_sql(
        &self,
        kind: &Type,
        out: &mut BytesMut,
    ) -> Result<IsNull, Box<dyn Error + Sync + Send>> {
        match self {
            Self::Null => Ok(IsNull::Yes),
            Self::Integer(number) if *kind == Type::INT4 => {
                i32::try_from(*number)?.to_sql(kind, out)
            }
            Self::Integer(number) => number.to_sql(&checked::<i64>(kind)?, out),
            Self::Text(text) => escaped(text).as_ref().to_sql(&checked::<&str>(kind)?, out),
            Self::Bytes(bytes) => bytes.to_sql(&checked::<Vec<u8>>(kind)?, out),
        }
    }

    fn accepts(_: &Type) -> bool {
        true
    }

    to_sql_checked!();
}

impl<'a> FromSql<'a> for Value {
    fn from_sql(kind: &Type, raw: &'a [u8]) -> Result<Self, Box<dyn Error + Sync + Send>> {
        Ok(match *kind {
            Type::BOOL => bool::from_sql(kind, raw)?.into(),
            Type::INT4 => i64::from(i32::from_sql(kind, raw)?).into(),
            Type::INT8 => i64::from_sql(kind, raw)?.into(),
            Type::BYTEA => <&[u8]>::from_sql(kind, raw)?.into(),
            _ => unescaped(<&str>::from_sql(kind, raw)?).into(),
        })
    }

    fn from_sql_null(_: &Type) -> Result<Self, Box<dyn Error + Sync + Send>> {
        Ok(Self::Null)
    }

    fn accepts(kind: &Type) -> bool {
        [Type::BOOL, Type::INT4, Type::INT8, Type::BYTEA].contains(kind)
            || <&str as FromSql<'_>>::accepts(kind)
    }
}

/// The type of a column, if a `T` can be written into it.
fn checked<T: ToSql>(kind: &Type) -> Result<Type, String> {
    let fits = T::accepts(kind);
    fits.then(|| kind.clone()).ok_or_else(|| format!("the parameter is of the type {kind}"))
}

/// A text as the tables have it.
pub(crate) fn escaped(text: &str) -> Cow<'_, str> {
    if !text.contains(['\0', ESCAPE]) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 8);
    for character in text.chars() {
        match character {
            '\0' => escaped.extend([ESCAPE, '0']),
            ESCAPE => escaped.extend([ESCAPE, '1']),
            other => escaped.push(other),
        }
    }
    Cow::Owned(escaped)
}

fn unescaped(text: &str) -> String {
    if !text.contains(ESCAPE) {
        return text.to_owned();
    }
    let (mut unescaped, mut rest) = (String::with_capacity(text.len()), text.chars());
    while let Some(character) = rest.next() {
        unescaped.extend(match character {
            ESCAPE if rest.next() == Some('0') => Some('\0'),
            other => Some(other),
        });
    }
    unescaped
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_text_has_one_form_without_a_zero(
            text in "[\u{0}\u{1}01a]{0,9}|.{0,20}",
            other in "[\u{0}\u{1}01a]{0,9}",
        ) {
            let form = escaped(&text);
            prop_assert!(!form.contains('\0'));
            prop_assert_eq!(unescaped(&form), text.clone());
            prop_assert_eq!(form == escaped(&other), text == other);
        }
    }

    #[test]
    fn a_text_without_the_two_characters_is_itself() {
        assert!(matches!(escaped("10 steps; '\"\u{2}"), Cow::Borrowed("10 steps; '\"\u{2}")));
    }
}

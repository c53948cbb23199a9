//! Values of columns and parameters, in no database's own types.

use crate::accounts::{AccountId, Name, StoreFailure, UnixTime};

/// What a column holds, or a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Nothing.
    Null,
    /// A number.
    Integer(i64),
    /// A text, which may have any character.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
}

/// The columns of a row.
#[derive(Debug)]
pub struct Row(pub(crate) Vec<Value>);

/// What a column can be read as.
pub(crate) trait FromValue: Sized {
    /// `None` if the column holds something else.
    fn from_value(value: &Value) -> Option<Self>;
}

impl Row {
    /// The value of a column.
    pub(crate) fn get<T: FromValue>(&self, column: usize) -> Result<T, StoreFailure> {
        self.0.get(column).and_then(T::from_value).ok_or_else(|| {
            let sentence = format!("the host's store has a value of another kind: column {column}");
            StoreFailure::new(sentence)
        })
    }
}

/// The values of the parameters of a statement.
macro_rules! values {
    ($($value:expr),* $(,)?) => {
        &[$($crate::accounts::sql::Value::from($value)),*]
    };
}
pub(crate) use values;

impl From<i64> for Value {
    fn from(number: i64) -> Self {
        Self::Integer(number)
    }
}

impl From<u32> for Value {
    fn from(number: u32) -> Self {
        Self::Integer(number.into())
    }
}

impl From<bool> for Value {
    fn from(flag: bool) -> Self {
        Self::Integer(flag.into())
    }
}

impl From<UnixTime> for Value {
    fn from(time: UnixTime) -> Self {
        Self::Integer(time.seconds() as i64)
    }
}

impl From<AccountId> for Value {
    fn from(id: AccountId) -> Self {
        Self::Integer(id.0)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&[u8]> for Value {
    fn from(bytes: &[u8]) -> Self {
        Self::Bytes(bytes.to_owned())
    }
}

impl<T: Into<Self>> From<Option<T>> for Value {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Null, Into::into)
    }
}

impl FromValue for i64 {
    fn from_value(value: &Value) -> Option<Self> {
        if let Value::Integer(number) = value { Some(*number) } else { None }
    }
}

impl FromValue for u64 {
    fn from_value(value: &Value) -> Option<Self> {
        i64::from_value(value).map(|number| number.max(0) as u64)
    }
}

impl FromValue for u32 {
    fn from_value(value: &Value) -> Option<Self> {
        i64::from_value(value).and_then(|number| number.try_into().ok())
    }
}

impl FromValue for bool {
    fn from_value(value: &Value) -> Option<Self> {
        i64::from_value(value).map(|number| number != 0)
    }
}

impl FromValue for UnixTime {
    fn from_value(value: &Value) -> Option<Self> {
        u64::from_value(value).map(Self::new)
    }
}

impl FromValue for AccountId {
    fn from_value(value: &Value) -> Option<Self> {
        i64::from_value(value).map(Self)
    }
}

impl FromValue for String {
    fn from_value(value: &Value) -> Option<Self> {
        if let Value::Text(text) = value { Some(text.clone()) } else { None }
    }
}

impl FromValue for Name {
    fn from_value(value: &Value) -> Option<Self> {
        if let Value::Text(text) = value { Some(Self::kept(text)) } else { None }
    }
}

impl FromValue for [u8; 32] {
    fn from_value(value: &Value) -> Option<Self> {
        if let Value::Bytes(bytes) = value { bytes.as_slice().try_into().ok() } else { None }
    }
}

impl<T: FromValue> FromValue for Option<T> {
    fn from_value(value: &Value) -> Option<Self> {
        if *value == Value::Null { Some(None) } else { T::from_value(value).map(Some) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_read_as_what_it_holds_and_as_nothing_else() {
        let row = Row(vec![Value::Null, 7_i64.into(), "x".into(), (&[1_u8; 32][..]).into()]);
        assert_eq!(row.get::<Option<i64>>(0).unwrap(), None);
        assert_eq!(row.get::<Option<u32>>(1).unwrap(), Some(7));
        assert_eq!(row.get::<String>(2).unwrap(), "x");
        assert_eq!(row.get::<[u8; 32]>(3).unwrap(), [1; 32]);
        for column in [0, 2, 3, 4] {
            let failure = row.get::<i64>(column).unwrap_err().to_string();
            assert!(failure.ends_with(&format!("column {column}")), "{failure}");
        }
        assert!(row.get::<Option<u32>>(2).is_err() && row.get::<String>(1).is_err());
        assert!(Row(vec![Value::Integer(-1)]).get::<u32>(0).is_err());
        assert!(Row(vec![(&[1_u8; 31][..]).into()]).get::<[u8; 32]>(0).is_err());
    }
}

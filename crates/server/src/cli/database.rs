//! Where the store of a host is: in a folder, or in a database.

use std::ffi::OsString;
use std::fmt;
use std::path::PathBuf;

use cellcaster::cli::parse::Takes;

/// Where the store of a host is.
#[derive(Clone, PartialEq)]
pub(crate) enum Database {
    /// In a folder.
    Folder(PathBuf),
    /// At an address of PostgreSQL, which may have a password.
    Address(String),
}

impl Database {
    /// Reads the value of `--store`.
    pub(crate) fn parse(text: &str) -> Result<Self, Takes> {
        const TAKES: Takes = Takes("a folder, or an address such as postgres://user@host/database");
        if text.is_empty() { Err(TAKES) } else { Ok(Self::of(text.into())) }
    }

    /// What a word of the command line or of the environment names.
    pub(crate) fn of(word: OsString) -> Self {
        match word.to_str() {
            Some(text) if ["postgres:", "postgresql:"].iter().any(|it| text.starts_with(it)) => {
                Self::Address(text.to_owned())
            }
            _ => Self::Folder(word.into()),
        }
    }
}

impl fmt::Debug for Database {
    /// Without what may be secret.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Folder(folder) => f.debug_tuple("Folder").field(folder).finish(),
            Self::Address(_) => f.debug_tuple("Address").finish_non_exhaustive(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_begins_with_its_kind_and_is_not_shown() {
        for text in ["postgres://ada:geheim@host/games", "postgresql://ada:geheim@host"] {
            let database = Database::of(text.into());
            assert_eq!(database, Database::Address(text.to_owned()));
            assert!(!format!("{database:?}").contains("geheim"));
        }
        for text in ["data", "/var/lib/cellcaster", "postgres", "./postgres:"] {
            assert_eq!(Database::of(text.into()), Database::Folder(text.into()));
        }
    }
}

//! The option of all commands that need the store of a host.

use std::ffi::OsString;
use std::fmt;
use std::path::PathBuf;

use cellcaster::cli::arguments::option::{Parser, ValueOption};

/// Where the store of a host is.
#[derive(Clone, PartialEq)]
pub(crate) enum Database {
    /// In a folder.
    Folder(PathBuf),
    /// At an address of PostgreSQL, which may have a password.
    Address(String),
}

pub(crate) const STORE: ValueOption<Database> = ValueOption {
    name: "store",
    value: "URL|FOLDER",
    takes: "a folder, or an address such as postgres://user@host/database",
    help: "Where accounts, bans and results are: a folder, or a PostgreSQL database that several hosts share \
           [default: $CELLCASTER_STORE, or the folder for data]",
    default: "",
    choices: &[],
    read: Parser::Optional(|text| {
        // What is not UTF-8 has come as this character. The folder would be another one.
        let is_named = !text.is_empty() && !text.contains(char::REPLACEMENT_CHARACTER);
        is_named.then(|| Database::of(text.into()))
    }),
    repeats: false,
};

impl Database {
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

//! The location of a host's store: a folder or an address.
//!
//! `--store` names it, or otherwise `$CELLCASTER_STORE`. The default is the folder for data. The variable keeps a
//! password out of the list of processes.

use std::env;
use std::ffi::OsString;
use std::fmt;
use std::path::PathBuf;

use cellcaster::cli::Error;
use cellcaster::cli::machine::data_folder;
use cellcaster::cli::parse::ValidValues;
use cellcaster::fault::printable_path;

use crate::accounts::{HostStore, StoreFailure};

/// An address that may contain a password. Its `Debug` form leaves it out.
#[derive(Clone, PartialEq)]
pub(crate) struct Secret(pub(crate) String);

/// The location of a host's store.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum StoreLocation {
    /// A folder.
    Folder(PathBuf),
    /// An address of PostgreSQL.
    Address(Secret),
}

impl StoreLocation {
    /// Reads the value of `--store`.
    pub(crate) fn parse(text: &str) -> Result<Self, ValidValues> {
        const TAKES: ValidValues =
            ValidValues("a folder, or an address such as postgres://user@host/database");
        if text.is_empty() { Err(TAKES) } else { Ok(Self::of(text.into())) }
    }

    /// The location that `option` names, or otherwise the environment, or otherwise the [`folder`] for data.
    pub(crate) fn named(option: Option<Self>, data: Option<PathBuf>) -> Result<Self, Error> {
        let word = || env::var_os("CELLCASTER_STORE").filter(|word| !word.is_empty());
        let named = option.or_else(|| word().map(Self::of));
        named.map_or_else(|| folder(data).map(Self::Folder), Ok)
    }

    /// Opens the store, or creates it if there is none.
    pub(crate) fn open(&self) -> Result<HostStore, StoreFailure> {
        match self {
            Self::Folder(folder) => HostStore::open(folder),
            Self::Address(Secret(address)) => HostStore::connect(address),
        }
    }

    /// Opens an existing store to read from it.
    pub(crate) fn open_to_read(&self) -> Result<HostStore, Error> {
        let store = match self {
            Self::Folder(folder) => HostStore::open_to_read(folder),
            Self::Address(Secret(address)) => HostStore::connect_to_read(address),
        };
        store.map_err(failed)?.ok_or_else(|| match self {
            Self::Folder(folder) => Error::mistake(format!(
                "{} contains no store of a host: name its data folder, or start the host once",
                printable_path(folder)
            )),
            Self::Address(_) => {
                Error::mistake("this database contains no store of a host: start the host once")
            }
        })
    }

    fn of(word: OsString) -> Self {
        match word.to_str() {
            Some(text) if ["postgres:", "postgresql:"].iter().any(|it| text.starts_with(it)) => {
                Self::Address(Secret(text.to_owned()))
            }
            _ => Self::Folder(word.into()),
        }
    }
}

impl fmt::Debug for Secret {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Secret").finish_non_exhaustive()
    }
}

/// The folder for data that `option` names, or otherwise the user's.
///
/// # Errors
/// If the system has no such folder.
pub(crate) fn folder(option: Option<PathBuf>) -> Result<PathBuf, Error> {
    option.or_else(data_folder).ok_or_else(|| {
        Error::mistake("this system has no default data folder: name the host's with --data")
    })
}

/// The error for a failure of an existing store.
#[expect(clippy::needless_pass_by_value, reason = "`map_err` passes a value")]
pub(crate) fn failed(failure: StoreFailure) -> Error {
    Error::machine(failure.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_is_recognised_by_its_scheme_and_hidden() {
        for text in ["postgres://ada:geheim@host/games", "postgresql://ada:geheim@host"] {
            let database = StoreLocation::of(text.into());
            assert_eq!(database, StoreLocation::Address(Secret(text.to_owned())));
            assert!(!format!("{database:?}").contains("geheim"));
        }
        for text in ["data", "/var/lib/cellcaster", "postgres", "./postgres:"] {
            assert_eq!(StoreLocation::of(text.into()), StoreLocation::Folder(text.into()));
        }
    }
}

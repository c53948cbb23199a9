//! The store of a host: in a folder, or at an address.
//!
//! `--store` names it, or `$CELLCASTER_STORE`, or else it is in the folder for data. The variable keeps a
//! password out of the list of processes.

use std::env;

use crate::accounts::PostgresStore;
use crate::accounts::{HostStore, SqliteStore, StoreFailure};
use crate::cli::database::Database;
use cellcaster::cli::Error;

/// The store that `option` names, or else the environment.
pub(crate) fn named(option: Option<Database>) -> Option<Database> {
    let word = || env::var_os("CELLCASTER_STORE").filter(|word| !word.is_empty());
    option.or_else(|| word().map(Database::of))
}

/// Opens a store, which is made if there is none.
pub(crate) fn open(database: &Database) -> Result<Box<dyn HostStore>, StoreFailure> {
    match database {
        Database::Folder(folder) => Ok(Box::new(SqliteStore::open(folder)?)),
        Database::Address(address) => Ok(open_address(address)?),
    }
}

/// As [`open`], but goes on with what can be read of a damaged file. Returns a sentence about it then.
pub(crate) fn open_or_salvage(
    database: &Database,
) -> Result<(Box<dyn HostStore>, Option<String>), StoreFailure> {
    match database {
        Database::Folder(folder) => {
            let (store, sentence) = SqliteStore::open_or_salvage(folder)?;
            Ok((Box::new(store), sentence))
        }
        Database::Address(_) => Ok((open(database)?, None)),
    }
}

/// Opens a store that exists, to read from it.
pub(crate) fn open_to_read(database: &Database) -> Result<Box<dyn HostStore>, Error> {
    let store: Option<Box<dyn HostStore>> = match database {
        Database::Folder(folder) => {
            SqliteStore::open_to_read(folder).map_err(failed)?.map(|store| Box::new(store) as _)
        }
        Database::Address(address) => open_address_to_read(address).map_err(failed)?,
    };
    store.ok_or_else(|| match database {
        Database::Folder(folder) => {
            let folder = folder.display().to_string().replace(char::is_control, "?");
            Error::mistake(format!("there is no store of a host in {folder}"))
        }
        Database::Address(_) => {
            Error::mistake("there is no store of a host in this database: start the host once")
        }
    })
}

/// The error of a store that exists.
#[expect(clippy::needless_pass_by_value, reason = "`map_err` passes a value")]
pub(crate) fn failed(failure: StoreFailure) -> Error {
    Error::machine(failure.to_string())
}

fn open_address(address: &str) -> Result<Box<dyn HostStore>, StoreFailure> {
    Ok(Box::new(PostgresStore::open(address)?))
}

fn open_address_to_read(address: &str) -> Result<Option<Box<dyn HostStore>>, StoreFailure> {
    Ok(PostgresStore::open_to_read(address)?.map(|store| Box::new(store) as _))
}

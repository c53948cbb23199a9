//! Operation of a host: its log, metrics, operator, signals and shutdown, and the files that start it.

mod admin;
#[cfg(feature = "system-tests")]
mod away;
#[cfg(feature = "system-tests")]
mod browser;
#[cfg(feature = "system-tests")]
mod cluster;
mod documents;
#[cfg(all(target_os = "linux", feature = "system-tests"))]
mod failures;
mod killed;
mod maps;
mod metrics;
mod pictures;
mod results;
#[cfg(feature = "system-tests")]
mod shared_store;
mod signals;
mod talk;
mod watching;
mod web;

//! Running a host: its log, its metrics, its operator, its signals, its ends, and the files that start it.

mod admin;
#[cfg(feature = "system-tests")]
mod away;
#[cfg(feature = "system-tests")]
mod cluster;
mod documents;
#[cfg(all(target_os = "linux", feature = "system-tests"))]
mod failures;
mod killed;
mod maps;
mod metrics;
mod results;
mod running;
#[cfg(feature = "system-tests")]
mod shared_store;
mod signals;

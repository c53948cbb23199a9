//! Running a host: its log, its metrics, its operator, its signals, its ends, and the files that start it.

mod admin;
#[cfg(feature = "cluster-tests")]
mod away;
#[cfg(feature = "cluster-tests")]
mod cluster;
mod documents;
#[cfg(all(target_os = "linux", feature = "ssh-tests"))]
mod failures;
mod killed;
mod maps;
mod metrics;
mod results;
mod running;
#[cfg(feature = "cluster-tests")]
mod shared_store;
mod signals;

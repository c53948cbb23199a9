//! Running a host: its log, its metrics, its operator, its signals, and the files that start it.

mod admin;
mod documents;
mod maps;
mod metrics;
mod running;
mod signals;

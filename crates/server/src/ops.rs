//! Running a host: its configuration, its operator, its metrics and its log.

pub mod admin;
pub mod config;
pub mod logging;
pub mod metrics;

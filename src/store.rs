//! The stores of a host.

pub mod host;

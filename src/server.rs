//! The server.
#![allow(dead_code)]

mod line;
mod room;
mod session;
mod summary;

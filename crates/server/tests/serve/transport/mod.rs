//! The transport below the game. Every test ends with a visitor who still gets an answer.

mod awkward;
mod clients;
mod command;
mod echo;
mod floods;
mod host_key;
mod house;
mod proxies;
mod raw;

pub(crate) use house::{TIMEOUT, folder, wait_until};

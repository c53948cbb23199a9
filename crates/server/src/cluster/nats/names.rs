//! Names of subjects, keys and the bucket.

use std::fmt::Write;

use crate::cluster::bus::Key;
use crate::rooms::summary::RoomId;

pub(crate) const BUCKET: &str = "cellcaster";
pub(crate) const NUMBERS: &str = "cellcaster.number";
/// With the version of the format of requests.
pub(crate) const OPERATOR: &str = "cellcaster.operator.1";
pub(crate) const ROOMS: &str = "room.";

pub(crate) fn log_subject(room: RoomId) -> String {
    format!("cellcaster.log.{room}")
}

pub(crate) fn peers_subject(room: RoomId) -> String {
    format!("cellcaster.peers.{room}")
}

pub(crate) fn key_name(key: &Key) -> String {
    match key {
        Key::Room(room) => format!("{ROOMS}{room}"),
        Key::Checkpoint(room) => format!("checkpoint.{room}"),
        Key::Standing(hash) => format!("standing.{hash}"),
        Key::Place(key) => format!("place.{}", hex(key.bytes())),
    }
}

fn hex(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(2 * bytes.len());
    for byte in bytes {
        // Memory accepts every byte.
        _ = write!(text, "{byte:02x}");
    }
    text
}

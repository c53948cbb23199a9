//! The folder in which the program keeps what the player has done.

use std::env;
use std::path::PathBuf;

use etcetera::BaseStrategy;
use etcetera::base_strategy::choose_native_strategy;

/// `cellcaster` in the platform's folder for data, or the folder that `CELLCASTER_DATA` names.
/// `None` if there is no such folder.
pub fn data_folder() -> Option<PathBuf> {
    let named = env::var_os("CELLCASTER_DATA").filter(|name| !name.is_empty());
    named.map(PathBuf::from).or_else(|| {
        let folder = choose_native_strategy().ok()?.data_dir();
        Some(folder.join("cellcaster"))
    })
}

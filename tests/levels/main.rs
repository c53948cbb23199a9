//! Maps, scripts and levels: valid and invalid ones, and levels played to their end.

mod bad_maps;
mod bad_scripts;
mod climbing;
mod endless;
mod growth;
mod hostile;
mod landing;
mod map;
mod mechanisms;
mod playing;
mod several;
mod steps;
mod tiled;

#[path = "../support/open.rs"]
mod open;
#[path = "../support/reach.rs"]
mod reach;
#[path = "../support/mod.rs"]
mod support;
#[path = "../support/walker.rs"]
mod walker;

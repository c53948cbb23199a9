//! Maps, scripts and levels: what is read, what is refused, and that levels can be played to their end.

mod bad_maps;
mod bad_scripts;
mod climbing;
mod endless;
mod growth;
mod landing;
mod map;
mod playing;

#[path = "../support/reach.rs"]
mod reach;
#[path = "../support/mod.rs"]
mod support;
#[path = "../support/walker.rs"]
mod walker;

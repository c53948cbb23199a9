//! A host on which people play together.

mod kept;
mod scores;

#[path = "../support/mod.rs"]
mod support;

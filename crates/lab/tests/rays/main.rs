//! Rays: the hits of each caster compared with rational arithmetic, and the commands that report
//! them.

mod accuracy;
mod adversarial;
mod cast;
mod casters;
mod doors;
mod exact;
mod filters;
mod large_maps;

#[path = "../support/mod.rs"]
mod support;

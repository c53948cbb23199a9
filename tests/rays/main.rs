//! Rays: what each caster hits, against rational arithmetic, and the commands that report it.

mod accuracy;
mod cast;
mod casters;
mod exact;
mod filters;

#[path = "../support/mod.rs"]
mod support;

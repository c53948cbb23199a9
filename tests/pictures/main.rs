//! Pictures: golden frames, and the costs of frames.

mod areas;
mod costs;
mod exact_pictures;
mod extremes;
mod figures;
mod gallery;
mod guards;
mod looking;
mod mirrors;
mod opening;
mod planes;
mod see_through;
mod shapes;
mod snapshot;
mod space;
mod steady_state;
mod things;
mod threads;

#[path = "../support/geometry.rs"]
mod geometry;
#[path = "../support/mod.rs"]
mod support;

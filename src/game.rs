//! What happens: a player walks through a world, in fixed steps, until they reach the exit.

mod collision;
mod intent;
mod motion;

pub use intent::{Intent, Intents};

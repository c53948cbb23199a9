//! What happens: a player walks through a world, in fixed steps, until they reach the exit.

mod intent;

pub use intent::{Intent, Intents};

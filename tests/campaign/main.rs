//! The campaign: on every difficulty, a script wins every level, and a careless player who takes
//! the shortest way loses it.

mod careful;
mod curve;
mod fixtures;
mod lazy;
mod levels;
mod person;
mod route;
mod scripts;
mod taps;
mod temper;

#[path = "../support/pilot.rs"]
mod pilot;
#[path = "../support/ways.rs"]
mod ways;

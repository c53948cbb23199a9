//! The campaign: every level is won by a script on every difficulty, and lost by a player who takes
//! the shortest way without care.

mod careful;
mod fixtures;
mod lazy;
mod levels;
mod route;
mod scripts;
mod taps;
mod temper;

#[path = "../support/pilot.rs"]
mod pilot;
#[path = "../support/ways.rs"]
mod ways;

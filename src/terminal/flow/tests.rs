//! Tests of flow control: of single events, and of whole simulated links.

mod encoded;
mod events;
mod links;

use proptest::prelude::*;

use super::demand::MIN_FIDELITY;
use super::scenarios;
use super::simulation::{Conditions, FrameSource, Frames, Latency, Simulation, UNLIMITED, saving};
use super::*;

const MILLISECOND: Duration = Duration::from_millis(1);
const SECOND: Duration = Duration::from_secs(1);
/// Bytes a second.
const MEGABIT: f64 = 125_000.0;

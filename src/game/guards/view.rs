//! What can be known about a guard from outside.

use glam::DVec2;

use super::Mood;
use crate::world::{GuardKind, Heading};

/// A guard as a map or a test sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardView {
    /// The kind of guard.
    pub kind: GuardKind,
    /// The position, in cells.
    pub position: DVec2,
    /// The height of the feet, in cells.
    pub feet: f64,
    /// The direction in which the guard looks.
    pub heading: Heading,
    /// What the guard is doing.
    pub mood: Mood,
    /// Whether the guard lies on the floor.
    pub is_down: bool,
}

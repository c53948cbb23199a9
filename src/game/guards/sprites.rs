//! The sprites of the kinds of guard that a level has.

use crate::world::GuardKind;
use crate::world::sprite::{Sprite, builtin};

const KINDS: usize = GuardKind::ALL.len();

/// The sprites of the kinds that are needed, in the order of [`GuardKind::ALL`].
pub(crate) fn sprites_of(is_needed: impl Fn(GuardKind) -> bool) -> [Option<Sprite>; KINDS] {
    GuardKind::ALL.map(|kind| if is_needed(kind) { builtin::named(kind.name()) } else { None })
}

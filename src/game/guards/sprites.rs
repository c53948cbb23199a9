//! The sprites of the kinds of guard that a level has.
//!
//! The 64 pictures of a kind take about 3 ms, which is most of the time in which a level begins. So
//! each kind is computed in a thread of its own. Computing each picture when it is first seen was
//! refused: frames would then allocate memory in the middle of a game.

use std::thread::{self, Builder, ScopedJoinHandle};

use crate::world::GuardKind;
use crate::world::sprite::{Sprite, builtin};

const KINDS: usize = GuardKind::ALL.len();

/// The sprites of the kinds that are needed, in the order of [`GuardKind::ALL`].
pub(super) fn sprites_of(is_needed: impl Fn(GuardKind) -> bool) -> [Option<Sprite>; KINDS] {
    type Thread<'a> = ScopedJoinHandle<'a, Option<Sprite>>;
    thread::scope(|scope| {
        let kinds = GuardKind::ALL.map(|kind| is_needed(kind).then_some(kind));
        let threads: [Option<Thread<'_>>; KINDS] = kinds.map(|kind| {
            let kind = kind?;
            Builder::new().spawn_scoped(scope, move || builtin::named(kind.name())).ok()
        });
        let mut of_kinds = kinds.into_iter();
        threads.map(|thread| {
            let kind = of_kinds.next()??;
            // Without a thread, the sprite is computed here.
            match thread.and_then(|thread| thread.join().ok()) {
                Some(sprite) => sprite,
                None => builtin::named(kind.name()),
            }
        })
    })
}

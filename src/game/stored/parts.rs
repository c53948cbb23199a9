//! Values of a world among stored ones.

use super::Unrestorable;
use super::codec::{Reader, Stored, Writer, check};
use super::stored;
use crate::rng::SplitMix64;
use crate::world::sprite::builtin::PlayerColor;
use crate::world::{
    Figure, GuardKind, Heading, KeyId, NoteId, Pitch, Rhythm, SpriteId, Supply, SwitchId, Thing,
    ThingKind,
};

stored! { struct Figure { sprite, position, base, heading, frame, opacity } }

stored! { struct Thing { kind, cell, sprite, frame } }

stored! {
    enum ThingKind {
        0: Exit,
        1: Key(key),
        2: Ornament,
        3: Treasure(worth),
        4: Healing(points),
        5: Supply(supply, count),
        6: Note(note),
        7: Checkpoint,
        8: Lever(switch),
        9: Spikes(rhythm),
        10: Flame,
    }
}

stored! { enum Supply { 0: Pebbles, 1: Darts, 2: Flasks } }

stored! { struct Rhythm { period, delay } }

stored! { enum GuardKind { 0: Warden, 1: Listener, 2: Lantern, 3: Hound, 4: Archer } }

stored! {
    enum PlayerColor {
        0: Red, 1: Sky, 2: Yellow, 3: Violet, 4: Green, 5: Pink, 6: Orange, 7: Blue,
    }
}

macro_rules! ids {
    ($($id:ident),*) => {$(
        impl Stored for $id {
            fn write(&self, out: &mut Writer) {
                self.0.write(out);
            }

            fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
                Ok(Self(Stored::read(input)?))
            }
        }
    )*};
}

ids!(KeyId, NoteId, SpriteId, SwitchId);

impl Stored for Heading {
    fn write(&self, out: &mut Writer) {
        self.parts().write(out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let (quarter_turns, beside) = Stored::read(input)?;
        Self::from_parts(quarter_turns, beside).ok_or(Unrestorable::Damaged("a heading"))
    }
}

impl Stored for Pitch {
    fn write(&self, out: &mut Writer) {
        self.slope().write(out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let slope = f64::read(input)?;
        let pitch = Self::LEVEL.tilted(slope);
        check(pitch.slope().to_bits() == slope.to_bits(), "a pitch")?;
        Ok(pitch)
    }
}

impl Stored for SplitMix64 {
    fn write(&self, out: &mut Writer) {
        out.raw(&self.state().to_le_bytes());
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let mut state = [0; 8];
        state.copy_from_slice(input.raw(8)?);
        Ok(Self::new(u64::from_le_bytes(state)))
    }
}

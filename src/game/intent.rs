//! Intents: the actions that the player wants, independent of keys. Other modules decide the key
//! bindings and how long a key counts as held.
//!
//! A [`Look`] turns and tilts by an angle, as a pointer does, instead of for a time. Angles are
//! whole hundredths of a degree, so a script stores them without loss and replays them bit for bit.
//! They take effect at once, because the motion of a pointer is already smooth. Rejected:
//! converting an angle into a time of turning. A step turns by 2.3°, which is coarser than a hand
//! can aim.

use std::fmt;

use serde::{Deserialize, Serialize};

/// One action that the player may want.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Intent {
    /// Walk ahead.
    Forward,
    /// Walk backwards.
    Back,
    /// Walk to the left without turning.
    StrafeLeft,
    /// Walk to the right without turning.
    StrafeRight,
    /// Turn anticlockwise, as seen from above.
    TurnLeft,
    /// Turn clockwise, as seen from above.
    TurnRight,
    /// Walk faster.
    Run,
    /// Turn more slowly.
    Aim,
    /// Open the door ahead.
    Open,
    /// Look further up.
    LookUp,
    /// Look further down.
    LookDown,
    /// Look straight ahead.
    LookAhead,
    /// Jump. In front of a door that is not open, open the door instead.
    Jump,
    /// Duck for as long as this is held.
    Duck,
    /// Turn anticlockwise by exactly 5 degrees, once.
    FineLeft,
    /// Turn clockwise by exactly 5 degrees, once.
    FineRight,
    /// Turn around, by exactly 180 degrees, once.
    AboutFace,
    /// Strike a guard within reach, once.
    Strike,
    /// Throw a pebble, once.
    Throw,
    /// Shoot a dart, once.
    Shoot,
    /// Throw a flask of smoke, once.
    Smoke,
    /// Light the lamp or put it out, once.
    Lamp,
    /// Continue from the last checkpoint after death.
    Retry,
}

impl Intent {
    /// All intents.
    pub const ALL: [Self; 23] = [
        Self::Forward,
        Self::Back,
        Self::StrafeLeft,
        Self::StrafeRight,
        Self::TurnLeft,
        Self::TurnRight,
        Self::Run,
        Self::Aim,
        Self::Open,
        Self::LookUp,
        Self::LookDown,
        Self::LookAhead,
        Self::Jump,
        Self::Duck,
        Self::FineLeft,
        Self::FineRight,
        Self::AboutFace,
        Self::Strike,
        Self::Throw,
        Self::Shoot,
        Self::Smoke,
        Self::Lamp,
        Self::Retry,
    ];

    /// Returns true if each press acts once, however long it lasts.
    pub fn acts_once(self) -> bool {
        ONCE & bit(self) != 0
    }

    /// Whether the intent walks or strafes.
    pub fn walks(self) -> bool {
        use Intent::{Back, Forward, StrafeLeft, StrafeRight};
        matches!(self, Forward | Back | StrafeLeft | StrafeRight)
    }

    /// Whether the intent turns or tilts the camera for as long as it is held.
    pub fn turns(self) -> bool {
        use Intent::{LookDown, LookUp, TurnLeft, TurnRight};
        matches!(self, TurnLeft | TurnRight | LookUp | LookDown)
    }

    /// Whether the two intents cancel each other.
    pub fn opposes(self, other: Self) -> bool {
        use Intent::{Back, Forward, LookDown, LookUp, StrafeLeft, StrafeRight};
        use Intent::{TurnLeft, TurnRight};
        let pairs =
            [(Forward, Back), (StrafeLeft, StrafeRight), (TurnLeft, TurnRight), (LookUp, LookDown)];
        pairs.contains(&(self, other)) || pairs.contains(&(other, self))
    }

    /// The name in scripts.
    pub fn name(self) -> &'static str {
        match self {
            Self::Forward => "forward",
            Self::Back => "back",
            Self::StrafeLeft => "strafe-left",
            Self::StrafeRight => "strafe-right",
            Self::TurnLeft => "turn-left",
            Self::TurnRight => "turn-right",
            Self::Run => "run",
            Self::Aim => "aim",
            Self::Open => "open",
            Self::LookUp => "look-up",
            Self::LookDown => "look-down",
            Self::LookAhead => "look-ahead",
            Self::Jump => "jump",
            Self::Duck => "duck",
            Self::FineLeft => "fine-left",
            Self::FineRight => "fine-right",
            Self::AboutFace => "about-face",
            Self::Strike => "strike",
            Self::Throw => "throw",
            Self::Shoot => "shoot",
            Self::Smoke => "smoke",
            Self::Lamp => "lamp",
            Self::Retry => "retry",
        }
    }

    /// The intent with that name.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|intent| intent.name() == name)
    }
}

/// A set of intents, and the angles by which the player turns and tilts in each step.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
#[serde(try_from = "(u32, Look)")]
pub struct Intents {
    /// One bit for each intent, by its position in the enum.
    bits: u32,
    look: Look,
}

impl Intents {
    /// The empty set.
    pub const fn new() -> Self {
        Self { bits: 0, look: Look::NONE }
    }

    /// Adds `intent`.
    pub fn insert(&mut self, intent: Intent) {
        self.bits |= bit(intent);
    }

    /// Removes `intent`.
    pub fn remove(&mut self, intent: Intent) {
        self.bits &= !bit(intent);
    }

    /// Whether `intent` is in the set.
    pub fn contains(self, intent: Intent) -> bool {
        self.bits & bit(intent) != 0
    }

    /// The intents with these angles in each step.
    #[must_use]
    pub fn with_look(self, look: Look) -> Self {
        Self { look, ..self }
    }

    /// The angles by which the player turns and tilts in each step.
    pub fn look(self) -> Look {
        self.look
    }

    /// Whether the set is empty and the angles are 0.
    pub fn is_empty(self) -> bool {
        self == Self::new()
    }

    /// The intents of the set, in the order of [`Intent::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Intent> {
        Intent::ALL.into_iter().filter(move |&intent| self.contains(intent))
    }

    /// The intents of the set that [act once](Intent::acts_once), without angles.
    pub(crate) fn once(self) -> Self {
        Self { bits: self.bits & ONCE, look: Look::NONE }
    }

    /// Whether the set has an intent other than to turn, to look or to duck.
    pub(crate) fn act(self) -> bool {
        self.bits & !LOOKS != 0
    }

    /// The intents of the set that are not in `others`, without angles.
    pub(crate) fn without(self, others: Self) -> Self {
        Self { bits: self.bits & !others.bits, look: Look::NONE }
    }

    /// 1 if only `toward` is in the set, −1 if only `against` is, 0 otherwise.
    pub(crate) fn balance(self, toward: Intent, against: Intent) -> f64 {
        f64::from(i8::from(self.contains(toward)) - i8::from(self.contains(against)))
    }
}

impl TryFrom<(u32, Look)> for Intents {
    type Error = &'static str;

    fn try_from((bits, look): (u32, Look)) -> Result<Self, &'static str> {
        if bits >> Intent::ALL.len() == 0 { Ok(Self { bits, look }) } else { Err("an intent") }
    }
}

/// The bits of the intents that [act once](Intent::acts_once).
const ONCE: u32 = {
    use Intent::{AboutFace, FineLeft, FineRight, Lamp, Retry, Shoot, Smoke, Strike, Throw};
    bit(FineLeft)
        | bit(FineRight)
        | bit(AboutFace)
        | bit(Strike)
        | bit(Throw)
        | bit(Shoot)
        | bit(Smoke)
        | bit(Lamp)
        | bit(Retry)
};

/// The bits of the intents with which a player only looks around.
const LOOKS: u32 = {
    use Intent::{
        AboutFace, Aim, Duck, FineLeft, FineRight, LookAhead, LookDown, LookUp, Retry, Run,
        TurnLeft, TurnRight,
    };
    bit(TurnLeft)
        | bit(TurnRight)
        | bit(Run)
        | bit(Aim)
        | bit(LookUp)
        | bit(LookDown)
        | bit(LookAhead)
        | bit(Duck)
        | bit(FineLeft)
        | bit(FineRight)
        | bit(AboutFace)
        | bit(Retry)
};

const fn bit(intent: Intent) -> u32 {
    1 << intent as u8
}

impl FromIterator<Intent> for Intents {
    fn from_iter<I: IntoIterator<Item = Intent>>(intents: I) -> Self {
        let mut set = Self::new();
        for intent in intents {
            set.insert(intent);
        }
        set
    }
}

impl fmt::Debug for Intents {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let look = Some(self.look).filter(|&look| look != Look::NONE);
        f.debug_set().entries(self.iter()).entries(look).finish()
    }
}

/// The angles by which the player turns and tilts in one step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Look {
    /// Clockwise as seen from above, in hundredths of a degree.
    pub turn: i16,
    /// Upwards, in hundredths of a degree. Moves the horizon in a grid, and raises the eye's
    /// direction in a scene of bodies.
    pub tilt: i16,
}

/// The names of the two angles in scripts.
pub(crate) const TURN: &str = "turn";
pub(crate) const TILT: &str = "tilt";

impl Look {
    /// No turn and no tilt.
    pub const NONE: Self = Self { turn: 0, tilt: 0 };

    /// The number of units in a degree.
    pub const PER_DEGREE: i16 = 100;

    /// Clockwise, in radians.
    pub(crate) fn turn_radians(self) -> f64 {
        radians(self.turn)
    }

    /// Upwards, in radians.
    pub(crate) fn tilt_radians(self) -> f64 {
        radians(self.tilt)
    }

    /// The words for the angles in a script: none, one or two.
    pub(crate) fn words(self) -> impl Iterator<Item = String> {
        let amounts = [(TURN, self.turn), (TILT, self.tilt)];
        let amounts = amounts.into_iter().filter(|&(_, amount)| amount != 0);
        amounts.map(|(name, amount)| format!("{name}:{}", Degrees(amount)))
    }
}

fn radians(hundredths: i16) -> f64 {
    (f64::from(hundredths) / f64::from(Look::PER_DEGREE)).to_radians()
}

/// Hundredths of a degree, formatted in degrees with as many digits as necessary.
struct Degrees(i16);

impl fmt::Display for Degrees {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", f64::from(self.0) / f64::from(Look::PER_DEGREE))
    }
}

/// Parses `text`, an angle in degrees, into hundredths of a degree. `None` if it is not a number,
/// not a whole number of hundredths, 0, or too large.
pub(crate) fn hundredths(text: &str) -> Option<i16> {
    let degrees: f64 = text.parse().ok()?;
    let hundredths = (degrees * f64::from(Look::PER_DEGREE)).round();
    let is_whole = hundredths / f64::from(Look::PER_DEGREE) == degrees;
    let is_some = hundredths != 0.0 && hundredths.abs() <= f64::from(i16::MAX);
    (is_whole && is_some).then_some(hundredths as i16)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn intents_behave_as_a_set(changes: Vec<(bool, prop::sample::Index)>) {
            let mut intents = Intents::new();
            let mut model = BTreeSet::new();
            for (add, index) in changes {
                let intent = *index.get(&Intent::ALL);
                if add {
                    intents.insert(intent);
                    model.insert(intent);
                } else {
                    intents.remove(intent);
                    model.remove(&intent);
                }
                prop_assert_eq!(intents.is_empty(), model.is_empty());
                prop_assert!(intents.iter().eq(model.iter().copied()));
                prop_assert_eq!(intents, model.iter().copied().collect());
            }
        }
    }

    #[test]
    fn every_amount_reads_back_as_written() {
        for amount in i16::MIN + 1..=i16::MAX {
            let read = (amount != 0).then_some(amount);
            assert_eq!(hundredths(&Degrees(amount).to_string()), read);
        }
        assert_eq!(Degrees(-325).to_string(), "-3.25");
        assert_eq!(Degrees(100).to_string(), "1");
    }

    #[test]
    fn invalid_amounts_are_refused() {
        for text in ["", "x", "nan", "inf", "0", "-0.0", "0.001", "1.005", "328", "1e300", "1,5"] {
            assert_eq!(hundredths(text), None, "{text}");
        }
    }
}

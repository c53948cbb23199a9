//! The abilities of each kind of guard.

use crate::world::GuardKind;

/// The abilities of a kind of guard. Speeds are in cells per second, times in steps.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Abilities {
    /// The speed on duty.
    pub(crate) walk: f64,
    /// The speed while following a player.
    pub(crate) chase: f64,
    /// The height of the eye above the feet, in cells.
    pub(crate) eye: f64,
    /// The range and the angle of the guard's sight; `None` if they are blind.
    pub(crate) sight: Option<Sight>,
    /// A factor on the reach of sounds for this guard, in halves.
    pub(crate) hearing: u16,
    /// Whether they open doors without a key.
    pub(crate) opens_doors: bool,
    /// The duration of the warning before an attack.
    pub(crate) windup: u16,
    /// The duration of the rest after an attack.
    pub(crate) recovery: u16,
    /// The points of health that a hit takes.
    pub(crate) points: u8,
    /// The distance at which the centre of a player can be hit, in cells.
    pub(crate) reach: f64,
    /// The speed during the warning.
    pub(crate) windup_speed: f64,
    /// The speed during the blow.
    pub(crate) lunge: f64,
    /// The distance at which the guard's footsteps are heard, in cells.
    pub(crate) tread: u8,
}

/// The sight of a guard.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight {
    /// The range in full light, in cells.
    pub(crate) range: f64,
    /// The cosine of half the angle of the cone.
    pub(crate) least_cosine: f64,
}

const WARDEN: Abilities = Abilities {
    walk: 1.2,
    chase: 2.0,
    eye: 0.75,
    // 110°
    sight: Some(Sight { range: 10.0, least_cosine: 0.573_576_436_351_046 }),
    hearing: 2,
    opens_doors: true,
    windup: 48,
    recovery: 60,
    points: 3,
    reach: 1.25,
    windup_speed: 0.0,
    lunge: 1.5,
    tread: 8,
};

const LISTENER: Abilities = Abilities {
    walk: 1.5,
    chase: 4.2,
    eye: 0.7,
    sight: None,
    hearing: 3,
    opens_doors: true,
    windup: 28,
    recovery: 45,
    points: 2,
    reach: 1.1,
    windup_speed: 1.5,
    lunge: 2.5,
    tread: 4,
};

const LANTERN: Abilities = Abilities {
    walk: 1.6,
    chase: 2.6,
    eye: 0.65,
    // 130°
    sight: Some(Sight { range: 12.0, least_cosine: 0.422_618_261_740_699 }),
    hearing: 2,
    opens_doors: true,
    windup: 36,
    recovery: 50,
    points: 1,
    reach: 1.1,
    windup_speed: 1.0,
    lunge: 2.0,
    tread: 6,
};

const HOUND: Abilities = Abilities {
    walk: 2.2,
    chase: 6.0,
    eye: 0.35,
    // 160°
    sight: Some(Sight { range: 6.0, least_cosine: 0.173_648_177_666_930 }),
    hearing: 2,
    opens_doors: false,
    windup: 24,
    recovery: 45,
    points: 1,
    reach: 0.7,
    windup_speed: 4.5,
    lunge: 8.0,
    tread: 5,
};

const ARCHER: Abilities = Abilities {
    walk: 1.4,
    chase: 2.2,
    eye: 0.68,
    // 100°
    sight: Some(Sight { range: 16.0, least_cosine: 0.642_787_609_686_539 }),
    hearing: 2,
    opens_doors: true,
    windup: 60,
    recovery: 60,
    points: 2,
    reach: 12.0,
    windup_speed: 0.0,
    lunge: 0.0,
    tread: 6,
};

/// The abilities of `kind`.
pub(crate) const fn abilities(kind: GuardKind) -> &'static Abilities {
    match kind {
        GuardKind::Warden => &WARDEN,
        GuardKind::Listener => &LISTENER,
        GuardKind::Lantern => &LANTERN,
        GuardKind::Hound => &HOUND,
        GuardKind::Archer => &ARCHER,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_blow_is_announced_in_time() {
        for kind in GuardKind::ALL {
            assert!(abilities(kind).windup >= 24, "{}", kind.name());
        }
    }
}

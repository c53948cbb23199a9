//! Guards as bytes.

use super::Guards;
use super::guard::{ALARMED, Guard};
use super::state::State;
use crate::game::multiplayer::MOST_PLAYERS;
use crate::game::stored::{Reader, Stored, StoredPart, Unrestorable, Writer, check, check_on_map};
use crate::world::{Duty, World};

/// More steps than any guard is baffled.
const MOST_BAFFLED: u16 = 1000;
/// The number of paces after which they are counted anew.
const PACES: f64 = 1024.0;

impl StoredPart for Guards {
    fn write(&self, out: &mut Writer) {
        let Self {
            rules: _,
            list,
            // Found anew.
            awake: _,
            sprites: _,
            terrain: _,
            ways,
            air,
            trails,
            // Filled in each step.
            others: _,
            air_cells: _,
            work: _,
            acts,
            spoken,
            // Empty between steps.
            woken: _,
            steps,
            alarm,
            has_changed,
        } = self;
        out.parts(list);
        ways.write(out);
        air.write(out);
        trails.write(out);
        acts.write(out);
        spoken.write(out);
        steps.write(out);
        alarm.write(out);
        has_changed.write(out);
    }

    fn read_over(&mut self, input: &mut Reader) -> Result<(), Unrestorable> {
        input.parts(&mut self.list)?;
        self.ways = Stored::read(input)?;
        self.air = Stored::read(input)?;
        self.trails = input.list(MOST_PLAYERS)?;
        self.acts = Stored::read(input)?;
        self.spoken = Stored::read(input)?;
        self.steps = Stored::read(input)?;
        self.alarm = Stored::read(input)?;
        self.has_changed = Stored::read(input)?;
        self.others.clear();
        self.find_awake();
        Ok(())
    }
}

impl Guards {
    /// Refuses a state in which a step could fail.
    pub fn check(&self, world: &World) -> Result<(), Unrestorable> {
        self.trails.iter().try_for_each(|trail| trail.check(self.steps))?;
        for guard in &self.list {
            guard.check(world)?;
            check(guard.wakes_one_of(self.list.len()), "whom a guard wakes")?;
        }
        Ok(())
    }
}

impl Guard {
    fn check(&self, world: &World) -> Result<(), Unrestorable> {
        check_on_map(world, self.mover.position())?;
        if let Some(quarry) = self.quarry {
            check_on_map(world, quarry.position)?;
        }
        let stops = match &self.duty {
            Duty::Patrol(stops) => stops.len(),
            Duty::Stand | Duty::Sleep | Duty::Wander(_) => 1,
        };
        let counts = self.awareness <= ALARMED
            && self.stop < stops.max(1)
            && self.baffled <= MOST_BAFFLED
            && self.route.is_possible()
            && self.has_paces_below(PACES)
            && self.state != (State::Down { left: 0 });
        check(counts, "a count of a guard")
    }

    /// Whether a guard whom they go to wake is one of that many.
    fn wakes_one_of(&self, count: usize) -> bool {
        match self.state {
            State::Wondering { wakes, .. } => wakes.is_none_or(|index| index < count),
            _ => true,
        }
    }
}

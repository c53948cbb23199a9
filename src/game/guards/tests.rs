//! Guards in small scenes.

mod chasing;
mod hearing;
mod moving;
mod oracle;
mod seeing;

use glam::DVec2;

use super::*;
use crate::game::collision::overlaps;
use crate::game::doors::Doors;
use crate::game::sound::SoundKind;
use crate::map;
use crate::world::{Cell, Difficulty, Heading};

/// The tiles of all scenes.
const TILES: &str = r##"
[tiles]
"#" = { wall = "#808080" }
"+" = { door = "#a05020" }
"%" = { glass = "#80c0ff" }
"|" = { mask = "grate" }
"1" = { floor_height = 0.3, ceiling_height = 1.5 }
"2" = { floor_height = 0.6, ceiling_height = 2 }
"h" = { floor_height = 0.9, ceiling_height = 2 }
"0" = { ceiling_height = 1.5 }
"p" = { floor_height = -2 }
"~" = { water = true }
"##;

/// A game of guards alone: a world, its doors, and one player who does what the test says.
struct Scene {
    world: World,
    guards: Guards,
    doors: Doors,
    target: Target,
    clouds: Vec<Cloud>,
    /// What guards have done in the last step.
    acts: Vec<Act>,
}

impl Scene {
    /// The scene that `rows` draw, with `things` in the syntax of maps. `@` is the player.
    fn new(rows: &str, things: &str) -> Self {
        Self::with_rules(rows, things, Rules::default())
    }

    fn with_rules(rows: &str, things: &str, rules: Rules) -> Self {
        let text = format!(
            "ceiling = \"#202028\"\nfloor = \"#404040\"\ngrid = '''\n{}\n'''\n{TILES}\n[things]\n\
             \"@\" = {{ start = 0 }}\n{things}\n",
            rows.trim()
        );
        let mut world = map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"));
        let guards = Guards::new(&mut world, rules);
        let cell = world.start().cell;
        let feet = world.floor_at(cell);
        let target = Target {
            position: cell.center(),
            feet,
            head: feet + 0.7,
            visibility: 255,
            has_light: false,
            is_alive: true,
        };
        let (doors, clouds, acts) = (Doors::default(), Vec::new(), Vec::new());
        Self { world, guards, doors, target, clouds, acts }
    }

    fn step(&mut self, sounds: &[Sound]) {
        let acts = self.guards.step(&self.world, &[self.target], sounds, &self.clouds);
        self.acts = acts.to_vec();
        for act in &self.acts {
            if let Act::Open(cell) = act {
                self.doors.open(*cell);
            }
        }
        let (position, guards) = (self.target.position, &self.guards);
        let is_occupied = |cell| overlaps(position, cell, mover::RADIUS) || guards.touches(cell);
        self.doors.step(&mut self.world, is_occupied);
    }

    /// Steps until `is_it`, at most `most` times; the number of steps, or `None`.
    fn steps_until(&mut self, most: u32, mut is_it: impl FnMut(&Self) -> bool) -> Option<u32> {
        (1..=most).find(|_| {
            self.step(&[]);
            is_it(self)
        })
    }

    fn guard(&self, index: usize) -> GuardView {
        self.guards.views().nth(index).unwrap()
    }

    fn mood(&self, index: usize) -> Mood {
        self.guard(index).mood
    }

    fn is_alarmed(&self) -> bool {
        self.guards.alarm() == Alarm::Raised
    }

    fn has_sounded(&self, kind: SoundKind) -> bool {
        self.acts.iter().any(|act| matches!(act, Act::Sound(sound) if sound.kind == kind))
    }

    fn put(&mut self, x: f64, y: f64) {
        self.target.position = DVec2::new(x, y);
    }

    /// A sound that the player makes.
    fn sound(&self, kind: SoundKind, reach: u8) -> Sound {
        Sound { kind, cell: self.target.cell(), reach, by: Source::Player(0) }
    }

    /// Whether every guard is where their body has room.
    fn is_sound(&self) -> bool {
        self.guards.list.iter().all(|guard| {
            let ground = mover::Ground {
                world: &self.world,
                terrain: &self.guards.terrain,
                gait: guard.gait(),
            };
            ground.has_room_for(&guard.mover)
        })
    }
}

fn degrees(heading: Heading) -> f64 {
    heading.degrees()
}

fn cell(column: u32, row: u32) -> Cell {
    Cell { column, row }
}

fn on(difficulty: Difficulty) -> Rules {
    Rules { difficulty, seed: 0 }
}

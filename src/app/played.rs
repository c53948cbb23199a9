//! What is played: a walk in a grid, or a flight among bodies.
//!
//! Whatever both have goes through [`Simulation`]. What only a grid has goes through [`Played::grid`].

use std::fmt;
use std::ops::{Deref, DerefMut};

use glam::DVec3;
use ratatui::layout::Rect;

use super::Look;
use crate::canvas::Canvas;
use crate::game::{Flight, Game, Intents};
use crate::generate::Site;
use crate::map::Level;
use crate::render::Renderable;
use crate::space;
use crate::tui::{FirstPerson, View};
use crate::world::{FieldOfView, Heading};

/// A level, as far as it has been played.
#[derive(Debug)]
pub(super) enum Played {
    Grid(Box<Game>),
    Space(Box<Flight>),
}

/// A level that advances in steps.
pub(super) trait Simulation: fmt::Debug {
    /// The level's title, or what stands for it where the map gives none.
    fn title(&self) -> &str;

    /// Where the player looks from.
    fn viewpoint(&self, field_of_view: FieldOfView) -> Viewpoint;

    /// Seconds since the level began, counted in steps.
    fn elapsed(&self) -> f64;

    /// A number that grows whenever anything visible changes, other than the viewpoint.
    fn revision(&self) -> u64;

    fn is_finished(&self) -> bool;

    /// For how many steps with these intents only the clock changes.
    fn quiet_steps(&self, intents: Intents) -> u64;

    fn step(&mut self, intents: Intents);

    /// Advances the clock by `steps` in which nothing moves.
    fn wait(&mut self, steps: u64);
}

/// Where the player looks from, in a grid and among bodies alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Viewpoint {
    position: DVec3,
    heading: Heading,
    /// How far up: the slope of a pitch, or the radians of an elevation.
    upwards: f64,
    field_of_view: FieldOfView,
}

/// What drawing keeps from one frame to the next.
#[derive(Default)]
pub(super) struct Memory {
    pub(super) grid: View,
    space: View<space::Scene>,
}

impl Memory {
    pub(super) fn new(grid: View) -> Self {
        Self { grid, ..Self::default() }
    }

    /// The time on the game's clock at which something in the last picture looks different by itself;
    /// `None` for never.
    pub(super) fn next_change(&self) -> Option<f64> {
        self.grid.next_change()
    }
}

impl Played {
    pub(super) fn new(level: Level) -> Self {
        match level {
            Level::Grid(world) => Self::Grid(Box::new(Game::new(*world))),
            Level::Space(scene) => Self::Space(Box::new(Flight::new(scene))),
        }
    }

    /// A game of `level` that begins where this one is, if it can.
    pub(super) fn begun_again_in(&self, level: Level) -> Self {
        match (self, level) {
            (Self::Grid(game), Level::Grid(world)) => {
                Self::Grid(Box::new(game.begun_again_in(*world)))
            }
            (Self::Space(flight), Level::Space(scene)) => {
                Self::Space(Box::new(flight.begun_again_in(scene)))
            }
            (_, level) => Self::new(level),
        }
    }

    /// The game, where it is one in a grid.
    pub(super) fn grid(&self) -> Option<&Game> {
        match self {
            Self::Grid(game) => Some(game),
            Self::Space(_) => None,
        }
    }

    /// What the map tells the player to do.
    pub(super) fn goal(&self) -> Option<&str> {
        self.grid()?.world().goal()
    }

    /// Whether there is a way out to find.
    pub(super) fn has_exit(&self) -> bool {
        self.grid().is_some_and(Game::has_exit)
    }

    /// Where the player is in a generated level.
    pub(super) fn site(&self) -> Option<Site> {
        self.grid()?.site()
    }

    /// The names of the keys that the player has.
    pub(super) fn keys(&self) -> impl Iterator<Item = &str> {
        self.grid().into_iter().flat_map(Game::keys)
    }

    /// What there is to tell the player.
    pub(super) fn message(&self) -> Option<&str> {
        self.grid()?.message()
    }

    pub(super) fn is_airborne(&self) -> bool {
        self.grid().is_some_and(Game::is_airborne)
    }

    /// Whether there is no floor, and ducking leads downwards.
    pub(super) fn flies(&self) -> bool {
        self.grid().is_none()
    }

    /// Draws what the player sees.
    pub(super) fn draw(
        &self,
        look: &Look,
        canvas: &mut impl Canvas,
        area: Rect,
        memory: &mut Memory,
    ) {
        let seconds = self.elapsed();
        match self {
            Self::Grid(game) => {
                let camera = game.camera(look.field_of_view);
                look.draw(game.world(), &camera, seconds, canvas, area, &mut memory.grid);
            }
            Self::Space(flight) => {
                let camera = flight.camera(look.field_of_view);
                look.draw(flight.scene(), &camera, seconds, canvas, area, &mut memory.space);
            }
        }
    }
}

impl Deref for Played {
    type Target = dyn Simulation;

    fn deref(&self) -> &(dyn Simulation + 'static) {
        match self {
            Self::Grid(game) => &**game,
            Self::Space(flight) => &**flight,
        }
    }
}

impl DerefMut for Played {
    fn deref_mut(&mut self) -> &mut (dyn Simulation + 'static) {
        match self {
            Self::Grid(game) => &mut **game,
            Self::Space(flight) => &mut **flight,
        }
    }
}

impl Look {
    /// Draws what `camera` sees of `scene` at that time.
    fn draw<S: Renderable>(
        &self,
        scene: &S,
        camera: &S::Camera,
        seconds: f64,
        canvas: &mut impl Canvas,
        area: Rect,
        view: &mut View<S>,
    ) {
        let picture = FirstPerson::new(scene, camera)
            .glyphs(self.glyphs)
            .color_depth(self.depth)
            .cell_aspect(self.cell_aspect)
            .filter(self.filter)
            .time(seconds);
        picture.draw(area.as_size(), view);
        picture.paint(view, 0, area, canvas);
    }
}

impl Simulation for Game {
    fn title(&self) -> &str {
        or_untitled(self.world().title())
    }

    fn viewpoint(&self, field_of_view: FieldOfView) -> Viewpoint {
        let camera = self.camera(field_of_view);
        Viewpoint {
            position: camera.position().extend(camera.eye()),
            heading: camera.heading,
            upwards: camera.pitch.slope(),
            field_of_view,
        }
    }

    fn elapsed(&self) -> f64 {
        Self::elapsed(self)
    }

    fn revision(&self) -> u64 {
        Self::revision(self)
    }

    fn is_finished(&self) -> bool {
        Self::is_finished(self)
    }

    fn quiet_steps(&self, intents: Intents) -> u64 {
        Self::quiet_steps(self, intents)
    }

    fn step(&mut self, intents: Intents) {
        Self::step(self, intents);
    }

    fn wait(&mut self, steps: u64) {
        Self::wait(self, steps);
    }
}

impl Simulation for Flight {
    fn title(&self) -> &str {
        or_untitled(&self.scene().title)
    }

    fn viewpoint(&self, field_of_view: FieldOfView) -> Viewpoint {
        let camera = self.camera(field_of_view);
        Viewpoint {
            position: camera.position(),
            heading: camera.heading,
            upwards: camera.elevation.radians(),
            field_of_view,
        }
    }

    fn elapsed(&self) -> f64 {
        Self::elapsed(self)
    }

    /// Bodies do not change.
    fn revision(&self) -> u64 {
        0
    }

    /// A flight has no exit.
    fn is_finished(&self) -> bool {
        false
    }

    fn quiet_steps(&self, intents: Intents) -> u64 {
        Self::quiet_steps(self, intents)
    }

    fn step(&mut self, intents: Intents) {
        Self::step(self, intents);
    }

    fn wait(&mut self, steps: u64) {
        Self::wait(self, steps);
    }
}

fn or_untitled(title: &str) -> &str {
    if title.is_empty() { "a level without a name" } else { title }
}

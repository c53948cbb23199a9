//! What is played: a walk in a grid, or a flight among bodies.

use ratatui::layout::Rect;

use crate::canvas::Canvas;
use crate::game::{Flight, Game, Intents};
use crate::generate::Site;
use crate::map::Level;
use crate::space;
use crate::tui::{FirstPerson, SpaceMemory, SpaceView, View};
use crate::world::{Camera, FieldOfView};

/// A level, as far as it has been played.
#[derive(Debug)]
pub(super) enum Played {
    Grid(Box<Game>),
    Space(Box<Flight>),
}

/// Where the player looks from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Eye {
    Grid(Camera),
    Space(space::Camera),
}

/// What drawing keeps from one frame to the next.
#[derive(Default)]
pub(super) struct Memory {
    pub(super) grid: View,
    pub(super) space: SpaceMemory,
}

impl Memory {
    /// When, by the game's clock, something that was drawn last looks different by itself; `None` for
    /// never.
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

    pub(super) fn title(&self) -> &str {
        let title = match self {
            Self::Grid(game) => game.world().title(),
            Self::Space(flight) => &flight.scene().title,
        };
        if title.is_empty() { "a level without a name" } else { title }
    }

    pub(super) fn eye(&self, field_of_view: FieldOfView) -> Eye {
        match self {
            Self::Grid(game) => Eye::Grid(game.camera(field_of_view)),
            Self::Space(flight) => Eye::Space(flight.camera(field_of_view)),
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

    /// Where the player is in a level that is dug.
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

    pub(super) fn grid(&self) -> Option<&Game> {
        match self {
            Self::Grid(game) => Some(game),
            Self::Space(_) => None,
        }
    }

    /// A number that grows whenever anything changes that can be seen, other than what the eye tells.
    pub(super) fn revision(&self) -> u64 {
        match self {
            Self::Grid(game) => game.revision(),
            Self::Space(_) => 0,
        }
    }

    pub(super) fn is_finished(&self) -> bool {
        match self {
            Self::Grid(game) => game.is_finished(),
            Self::Space(_) => false,
        }
    }

    pub(super) fn is_airborne(&self) -> bool {
        self.grid().is_some_and(Game::is_airborne)
    }

    /// Whether there is no floor, and ducking leads downwards.
    pub(super) fn flies(&self) -> bool {
        self.grid().is_none()
    }

    pub(super) fn elapsed(&self) -> f64 {
        match self {
            Self::Grid(game) => game.elapsed(),
            Self::Space(flight) => flight.elapsed(),
        }
    }

    pub(super) fn quiet_steps(&self, intents: Intents) -> u64 {
        match self {
            Self::Grid(game) => game.quiet_steps(intents),
            Self::Space(flight) => flight.quiet_steps(intents),
        }
    }

    pub(super) fn step(&mut self, intents: Intents) {
        match self {
            Self::Grid(game) => game.step(intents),
            Self::Space(flight) => flight.step(intents),
        }
    }

    pub(super) fn wait(&mut self, steps: u64) {
        match self {
            Self::Grid(game) => game.wait(steps),
            Self::Space(flight) => flight.wait(steps),
        }
    }

    /// Draws what `eye`, one of its own, sees.
    pub(super) fn draw(
        &self,
        eye: &Eye,
        look: super::Look,
        (canvas, area): (&mut impl Canvas, Rect),
        memory: &mut Memory,
    ) {
        match (self, eye) {
            (Self::Grid(game), Eye::Grid(camera)) => {
                let picture = FirstPerson::new(game.world(), camera)
                    .glyphs(look.glyphs)
                    .color_depth(look.depth)
                    .cell_aspect(look.cell_aspect)
                    .filter(look.filter)
                    .time(game.elapsed());
                picture.draw(area.as_size(), &mut memory.grid);
                picture.paint(&memory.grid, 0, area, canvas);
            }
            (Self::Space(flight), Eye::Space(camera)) => {
                let picture = SpaceView::new(flight.scene(), camera)
                    .glyphs(look.glyphs)
                    .color_depth(look.depth)
                    .cell_aspect(look.cell_aspect);
                picture.draw(area.as_size(), &mut memory.space);
                picture.paint(&memory.space, 0, area, canvas);
            }
            // An eye is that of what is played.
            (Self::Grid(_), Eye::Space(_)) | (Self::Space(_), Eye::Grid(_)) => {}
        }
    }
}

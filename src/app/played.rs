//! The current level: a game on a grid, or a flight among bodies.
//!
//! [`Played`] is the interface that both share, and [`Played::grid`] gives access to the rest of a
//! game on a grid.
//!
//! A [`Goal`] is shown until the player has acted for some time. Rejected: hiding it by the clock.
//! That would draw a frame while nothing moves, and hide the goal from slow readers. For the same
//! reason, steps in which only guards move do not count.

use glam::DVec3;
use ratatui::layout::{Rect, Size};

use crate::app::picture::DrawOptions;
use crate::app::setting::MapDisplay;
use crate::game::{Alarm, Flight, Game, Intents, PlayerId, Rules, STEPS_PER_SECOND};
use crate::map::Level;
use crate::space;
use crate::tui::View;
use crate::tui::canvas::Canvas;
use crate::world::{Camera, FieldOfView, Heading};

/// A level that is being played.
#[derive(Clone, Debug)]
pub(crate) enum Played {
    Grid(Box<Game>),
    Space(Box<Flight>),
}

/// The player's position and direction of view, on a grid or among bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Viewpoint {
    position: DVec3,
    heading: Heading,
    /// The vertical direction of view: the slope of the pitch on a grid, the elevation in radians
    /// among bodies.
    upwards: f64,
    field_of_view: FieldOfView,
}

/// The state of both views between frames.
#[derive(Default)]
pub(crate) struct Views {
    pub(crate) grid: View,
    space: View<space::Scene>,
}

impl Views {
    pub(crate) fn new(grid: View) -> Self {
        Self { grid, ..Self::default() }
    }
}

impl Played {
    pub(crate) fn new(level: Level) -> Self {
        Self::with_rules(level, Rules::default())
    }

    /// `level` at its start, under these rules.
    pub(crate) fn with_rules(level: Level, rules: Rules) -> Self {
        match level {
            Level::Grid(world) => Self::Grid(Box::new(Game::with_rules(*world, rules))),
            Level::Space(scene) => Self::Space(Box::new(Flight::new(scene))),
        }
    }

    /// Begins `level`, at the player's current position if possible.
    pub(crate) fn begun_again_in(&self, level: Level) -> Self {
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

    /// The game, if it is on a grid.
    pub(crate) fn grid(&self) -> Option<&Game> {
        match self {
            Self::Grid(game) => Some(game),
            Self::Space(_) => None,
        }
    }

    /// The game, if it is on a grid.
    pub(crate) fn grid_mut(&mut self) -> Option<&mut Game> {
        match self {
            Self::Grid(game) => Some(game),
            Self::Space(_) => None,
        }
    }
}

impl Default for Played {
    /// A flight through empty space.
    fn default() -> Self {
        Self::new(Level::Space(space::Scene::default()))
    }
}

/// The interface that both kinds of level share.
impl Played {
    /// The level's title, or a substitute if the map has none.
    pub(crate) fn title(&self) -> &str {
        let title = match self {
            Self::Grid(game) => game.world().title(),
            Self::Space(flight) => &flight.scene().title,
        };
        if title.is_empty() { "a level without a name" } else { title }
    }

    /// The player's position and direction of view.
    pub(crate) fn viewpoint(&self, field_of_view: FieldOfView) -> Viewpoint {
        let (position, heading, upwards) = match self {
            Self::Grid(game) => {
                let camera = game.camera(field_of_view);
                let position = camera.position().extend(camera.eye());
                (position, camera.heading, camera.pitch.slope())
            }
            Self::Space(flight) => {
                let camera = flight.camera(field_of_view);
                (camera.position(), camera.heading, camera.elevation.radians())
            }
        };
        Viewpoint { position, heading, upwards, field_of_view }
    }

    /// The seconds since the level began, counted in steps.
    pub(crate) fn elapsed(&self) -> f64 {
        match self {
            Self::Grid(game) => game.elapsed(),
            Self::Space(flight) => flight.elapsed(),
        }
    }

    /// A number that grows with every visible change apart from the viewpoint and the figures.
    /// Bodies do not change.
    pub(crate) fn revision(&self) -> u64 {
        self.grid().map_or(0, Game::revision_without_figures)
    }

    /// Returns true if the player has reached the exit. A flight has no exit.
    pub(crate) fn is_finished(&self) -> bool {
        self.grid().is_some_and(Game::is_finished)
    }

    /// Returns true if steps with these intents change only the clock.
    pub(crate) fn is_at_rest(&self, intents: Intents) -> bool {
        match self {
            Self::Grid(game) => game.is_at_rest(intents),
            Self::Space(flight) => flight.is_at_rest(intents),
        }
    }

    pub(crate) fn step(&mut self, intents: Intents) {
        match self {
            Self::Grid(game) => game.step(intents),
            Self::Space(flight) => flight.step(intents),
        }
    }

    /// Advances the clock by `steps` steps in which nothing moves.
    pub(crate) fn wait(&mut self, steps: u64) {
        match self {
            Self::Grid(game) => game.wait(steps),
            Self::Space(flight) => flight.wait(steps),
        }
    }
}

impl Played {
    /// Renders the player's view, or on a grid the view of `camera`, for an area of this size.
    /// Rendering may stop once `go_on` returns `false`. Returns whether the picture is complete.
    pub(crate) fn render(
        &self,
        options: &DrawOptions,
        camera: Option<Camera>,
        size: Size,
        views: &mut Views,
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        let seconds = self.elapsed();
        match self {
            Self::Grid(game) => {
                let camera = camera.unwrap_or_else(|| game.camera(options.field_of_view));
                let picture = options.picture(game.world(), &camera, seconds);
                options.render(&picture, size, &mut views.grid, go_on)
            }
            Self::Space(flight) => {
                let camera = flight.camera(options.field_of_view);
                let picture = options.picture(flight.scene(), &camera, seconds);
                options.render(&picture, size, &mut views.space, go_on)
            }
        }
    }

    /// Paints the rendered picture into `area`, which must have the size used for rendering.
    /// `camera` must be the one used for rendering.
    pub(crate) fn paint(
        &self,
        options: &DrawOptions,
        camera: Option<Camera>,
        canvas: &mut impl Canvas,
        area: Rect,
        views: &Views,
    ) {
        let seconds = self.elapsed();
        match self {
            Self::Grid(game) => {
                let camera = camera.unwrap_or_else(|| game.camera(options.field_of_view));
                let picture = options.picture(game.world(), &camera, seconds);
                picture.paint(&views.grid, 0, area, canvas);
            }
            Self::Space(flight) => {
                let camera = flight.camera(options.field_of_view);
                let picture = options.picture(flight.scene(), &camera, seconds);
                picture.paint(&views.space, 0, area, canvas);
            }
        }
    }
}

/// The number of steps with intents for which a goal is shown: four seconds.
const SHOWN_FOR: u64 = 4 * STEPS_PER_SECOND as u64;

/// A goal, and the remaining time for which it is shown.
#[derive(Clone, Debug, Default)]
pub(crate) struct Goal {
    /// The goal as a sentence without the full stop.
    pub(crate) text: String,
    /// The shorter form for narrow windows.
    pub(crate) short: String,
    steps_left: u64,
}

impl Goal {
    /// The goal of `game`: the map's own goal if it has one, otherwise a general one.
    pub(crate) fn of(game: &Played, display: MapDisplay) -> Self {
        let has_exit = game.grid().is_some_and(Game::has_exit);
        let (text, short) = match game.grid().and_then(|game| game.world().goal()) {
            Some(own) => (own, own),
            None if has_exit && display == MapDisplay::Off => ("Find the way out", "Find the exit"),
            None if has_exit => ("Find the way out: green on the map", "Find the exit"),
            None => ("Roam as you like: no exit here", "Roam around"),
        };
        Self::new(text, short)
    }

    /// A goal with a shorter form for narrow windows. Both are sentences without the full stop.
    pub(crate) fn new(text: &str, short: &str) -> Self {
        Self { text: text.to_owned(), short: short.to_owned(), steps_left: SHOWN_FOR }
    }

    /// Returns true if the goal is still shown.
    pub(crate) fn is_shown(&self) -> bool {
        self.steps_left > 0
    }

    /// Counts `steps` steps in which the player wanted something.
    pub(crate) fn moved(&mut self, steps: u64) {
        self.steps_left = self.steps_left.saturating_sub(steps);
    }
}

/// Compares the state after each step with the previous one, to notice a rise of the alarm or a
/// loss of health.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    alarm: Alarm,
    health: u8,
    /// `true` if the alarm has risen or the player has lost health since the last
    /// [`Watch::take_ring`].
    rings: bool,
}

impl Watch {
    /// A watch that starts from the state of the first player of `game`.
    pub(crate) fn begin(game: Option<&Game>) -> Self {
        game.map_or_else(Self::default, |game| Self::of(game, PlayerId::FIRST))
    }

    /// A watch that starts from the state of `player` in `game`.
    pub fn of(game: &Game, player: PlayerId) -> Self {
        let mut watch = Self::default();
        watch.look_at(game, player);
        Self { rings: false, ..watch }
    }

    /// Compares the state of `player` after a step with the previous state.
    pub fn look_at(&mut self, game: &Game, player: PlayerId) {
        let alarm = game.alarm();
        let health = game.seen_by(player).map_or(self.health, |player| player.health().points);
        self.rings |= alarm > self.alarm || health < self.health;
        (self.alarm, self.health) = (alarm, health);
    }

    /// Returns true if the alarm has risen or the player has lost health since the last call.
    pub fn take_ring(&mut self) -> bool {
        std::mem::take(&mut self.rings)
    }
}

//! The look back after a death: the guard who noticed the player, and the last seconds seen from
//! above.
//!
//! Both are found by playing the last seconds again. Nothing is kept for them during play.

use std::time::Duration;

use glam::DVec2;
use ratatui::layout::Rect;

use crate::app::App;
use crate::app::history::History;
use crate::app::page::{BORDERS, framed};
use crate::app::picture::{DrawOptions, MapPanel, Suspicion};
use crate::app::recording::RunLog;
use crate::app::screen::AppScreen;
use crate::app::text::sentences::{COMPASS, eighth};
use crate::color::Rgb;
use crate::game::{Alarm, Game, GuardView, STEP, STEPS_PER_SECOND};
use crate::tui::MapMark;
use crate::tui::canvas::Canvas;
use crate::world::{Camera, Cell, FieldOfView, GuardKind, TileKind, World};

/// The number of steps that are shown: five seconds.
const SHOWN: u64 = 5 * STEPS_PER_SECOND as u64;
/// The number of steps in which the guard who noticed the player is searched: 15 seconds.
const SEARCHED: u64 = 15 * STEPS_PER_SECOND as u64;
/// The number of steps from one moment to the next.
const STRIDE: u64 = 6;
/// The time for which a moment is shown, and the moments for which the last one stays.
const INTERVAL: Duration = Duration::from_millis(100);
const PAUSE: usize = 12;

/// The last seconds before a death.
#[derive(Clone, Debug)]
pub(crate) struct LookBack {
    /// A sentence about the guard who noticed the player first.
    pub(crate) sentence: String,
    /// Oldest first; there is at least one.
    moments: Vec<Moment>,
    begun: Duration,
}

/// The places of everybody at one time.
#[derive(Clone, Debug)]
struct Moment {
    /// The number of steps before the death.
    before: u64,
    player: MapMark,
    guards: Vec<(MapMark, Option<Suspicion>)>,
}

/// A guard who begins to follow the player.
#[derive(Clone, Copy, Debug)]
struct Noticed {
    steps: u64,
    guard: GuardView,
    player: Camera,
}

impl LookBack {
    /// The last seconds of the run `log`, which ends now; `None` if no guard follows the player.
    pub(crate) fn of(history: &History, log: &RunLog, now: Duration) -> Option<Self> {
        let end = history.steps;
        let first = end.saturating_sub(SEARCHED).max(history.begun);
        let mut game = history.at(first, |first| log.since(first));
        let mut noticed: Vec<Option<Noticed>> = Vec::new();
        let mut moments = Vec::new();
        look(&game, first, &mut noticed);
        for (steps, intents) in (first + 1..=end).zip(log.since(first)) {
            game.step(intents);
            let before = end - steps;
            if before > 0 {
                // In the last step, guards give up the dead player.
                look(&game, steps, &mut noticed);
            }
            if before <= SHOWN && before.is_multiple_of(STRIDE) {
                moments.push(Moment::of(&game, before));
            }
        }
        let earliest = noticed.into_iter().flatten().min_by_key(|noticed| noticed.steps)?;
        let when = match earliest.steps {
            steps if steps == first => "more than 15 s ago".to_owned(),
            steps => match ((end - steps) as f64 * STEP).round() {
                0.0 => "just now".to_owned(),
                seconds => format!("{seconds} s ago"),
            },
        };
        let sentence = earliest.sentence(game.world(), &when);
        (!moments.is_empty()).then_some(Self { sentence, moments, begun: now })
    }

    /// The number of intervals since the beginning.
    fn intervals(&self, now: Duration) -> u128 {
        now.saturating_sub(self.begun).as_nanos() / INTERVAL.as_nanos()
    }

    /// The index of the moment to show at `now`.
    fn index(&self, now: Duration) -> usize {
        let cycle = self.moments.len() + PAUSE;
        let index = (self.intervals(now) % cycle as u128) as usize;
        index.min(self.moments.len() - 1)
    }

    /// The time after `now` at which the next moment is due.
    fn next_change(&self, now: Duration) -> Duration {
        self.begun + INTERVAL * (self.intervals(now) + 1) as u32
    }
}

/// Records the guards who follow the player since now, and forgets the others.
fn look(game: &Game, steps: u64, noticed: &mut Vec<Option<Noticed>>) {
    noticed.resize(game.guards().count(), None);
    for (noticed, guard) in noticed.iter_mut().zip(game.guards()) {
        let player = || game.camera(FieldOfView::default());
        *noticed = (guard.mood.alarm() == Alarm::Raised)
            .then(|| noticed.unwrap_or_else(|| Noticed { steps, guard, player: player() }));
    }
}

impl Moment {
    fn of(game: &Game, before: u64) -> Self {
        let camera = game.camera(FieldOfView::default());
        let player = MapMark { position: camera.position(), heading: camera.heading };
        let guards = game.guards().map(|guard| {
            let mark = MapMark { position: guard.position, heading: guard.heading };
            (mark, Suspicion::of(&guard))
        });
        Self { before, player, guards: guards.collect() }
    }
}

impl Noticed {
    fn sentence(&self, world: &World, when: &str) -> String {
        let Self { guard, player, .. } = self;
        let who = match guard.kind {
            GuardKind::Warden => "A warden",
            GuardKind::Listener => "A listener",
            GuardKind::Lantern => "A lantern-bearer",
            GuardKind::Hound => "A hound",
            GuardKind::Archer => "An archer",
        };
        let senses = if guard.kind == GuardKind::Listener { "heard" } else { "saw" };
        let way = guard.position - player.position();
        let (cells, degrees) = (way.length().round(), libm::atan2(way.y, way.x).to_degrees());
        let place = if cells < 2.0 {
            "beside you".to_owned()
        } else {
            let direction = COMPASS[eighth(degrees)];
            let door = if is_at_door(world, guard.position) { "at a door " } else { "" };
            format!("{door}{cells} cells to the {direction}")
        };
        let is_behind = way.dot(player.direction()) < 0.0;
        let behind = if is_behind { ", from behind" } else { "" };
        format!("{who} {place} {senses} you {when}{behind}.")
    }
}

/// Returns true if a door is in one of the cells around `position`.
fn is_at_door(world: &World, position: DVec2) -> bool {
    let cell = Cell::at(position);
    let around = (-1..=1).flat_map(|row| (-1..=1).map(move |column| (column, row)));
    around.into_iter().any(|(column, row)| {
        let tile = world.grid().tile(i64::from(cell.column) + column, i64::from(cell.row) + row);
        tile.is_some_and(|tile| matches!(world.tile(tile).kind, TileKind::Door(_)))
    })
}

/// The smallest picture with room for the map beside the menu, in columns and rows.
const MIN_SIZE: (u16, u16) = (64, 14);
/// The columns for the menu.
const MENU_COLUMNS: u16 = 36;
/// The largest zoom of the map.
const MAX_ZOOM: i32 = 3;
/// The width of the margin around everybody on the map, in cells.
const MARGIN: f64 = 2.0;

/// The colours of the paths, and of guards by what they suspect.
const PLAYER_PATH: Rgb = Rgb::new(0xff, 0xf0, 0x50);
const CALM: Rgb = Rgb::new(0x98, 0x98, 0xa0);
const WARY: Rgb = Rgb::new(0xf0, 0xb0, 0x40);
const ALARMED: Rgb = Rgb::new(0xff, 0x58, 0x48);

impl App {
    /// Finds the last seconds before the player's death.
    pub(crate) fn look_back(&mut self) {
        let history = self.history.as_ref();
        self.look_back = history.and_then(|it| LookBack::of(it, &self.log, self.now));
    }

    /// The look back, if the screen shows it.
    fn shown_look_back(&self) -> Option<&LookBack> {
        self.look_back.as_ref().filter(|_| self.screen() == AppScreen::Dead)
    }

    /// Returns true if a picture of this size shows the last seconds from above.
    pub(crate) fn looks_back_in(&self, picture: Rect) -> bool {
        let has_room = picture.width >= MIN_SIZE.0 && picture.height >= MIN_SIZE.1;
        has_room && self.shown_look_back().is_some()
    }

    /// The index of the moment that the screen shows.
    pub(crate) fn moment_shown(&self) -> Option<usize> {
        Some(self.shown_look_back()?.index(self.now))
    }

    /// The time at which the next moment is due.
    pub(crate) fn next_moment(&self) -> Option<Duration> {
        Some(self.shown_look_back()?.next_change(self.now))
    }

    /// Draws the last seconds from above if there is room. Returns the rest of the picture.
    pub(crate) fn draw_look_back(
        &self,
        canvas: &mut impl Canvas,
        picture: Rect,
        options: &DrawOptions,
    ) -> Rect {
        let look_back = self.look_back.as_ref().filter(|_| self.looks_back_in(picture));
        let Some((look_back, game)) = look_back.zip(self.game.grid()) else { return picture };
        let room = Rect { width: picture.width - MENU_COLUMNS, ..picture };
        look_back.draw(canvas, room, (game, &self.map), self.now, options);
        Rect { x: room.right(), width: MENU_COLUMNS, ..picture }
    }
}

impl LookBack {
    fn draw(
        &self,
        canvas: &mut impl Canvas,
        room: Rect,
        (game, panel): (&Game, &MapPanel),
        now: Duration,
        options: &DrawOptions,
    ) {
        let shown = &self.moments[..=self.index(now)];
        let Some(Moment { before, player, guards }) = shown.last() else { return };
        let view = FieldOfView::default();
        let camera = Camera::new(player.position, player.heading, view)
            .and_then(|camera| camera.with_eye(game.camera(view).eye()));
        let Some(camera) = camera else { return };
        let [least, most] = self.extent();
        let map = panel
            .plain(game, &camera)
            .glyphs(options.glyphs)
            .color_depth(options.depth)
            .offset(least.midpoint(most) - camera.position());
        let inner = Rect { width: room.width - BORDERS, height: room.height - BORDERS, ..room };
        let needed = most - least + 2.0 * MARGIN;
        let fits = |zoom: &i32| map.zoom(*zoom).extent_within(inner.as_size()).cmpge(needed).all();
        let map = map.zoom((1..=MAX_ZOOM).rev().find(fits).unwrap_or(0));
        let size = map.size_within(inner.as_size());
        let (width, height) = (size.width + BORDERS, size.height + BORDERS);
        let (x, y) = (room.x + (room.width - width) / 2, room.y + (room.height - height) / 2);
        let title = format!("{:.1} s before", *before as f64 * STEP);
        let area = framed(canvas, Rect { x, y, width, height }, &title);
        map.paint(area, canvas);
        for moment in shown {
            for (mark, suspicion) in &moment.guards {
                map.paint_dot(area, canvas, mark.position, false, color(*suspicion));
            }
            map.paint_dot(area, canvas, moment.player.position, true, PLAYER_PATH);
        }
        for (mark, suspicion) in guards {
            map.paint_mark(area, canvas, mark, color(*suspicion));
        }
        map.paint_arrow(area, canvas, player, PLAYER_PATH);
    }

    /// The corners of the part of the map in which the player and the guards who suspect something
    /// have been.
    fn extent(&self) -> [DVec2; 2] {
        let places = self.moments.iter().flat_map(|moment| {
            let guards = moment.guards.iter().filter(|(_, suspicion)| suspicion.is_some());
            guards.map(|(mark, _)| mark.position).chain([moment.player.position])
        });
        let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
        places.fold(none, |[least, most], place| [least.min(place), most.max(place)])
    }
}

fn color(suspicion: Option<Suspicion>) -> Rgb {
    match suspicion {
        None => CALM,
        Some(Suspicion::Wary(_) | Suspicion::Searching) => WARY,
        Some(Suspicion::Alarmed) => ALARMED,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::blindness::assert_apart;

    #[test]
    fn everybody_can_tell_calm_wary_and_alarmed_guards_apart() {
        assert_apart(&[("calm", CALM), ("wary", WARY), ("alarmed", ALARMED)]);
    }
}

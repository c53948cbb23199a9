//! A player of records: a cursor that moves over a [`Reader`] in both directions, and where the
//! record is seen from.
//!
//! A place that has not been read yet is shown once it is. A jump whose steps take too long is shown
//! on the way.

use ratatui::layout::Rect;

use super::free_camera;
use super::recorded::{Cursor, MarkKind, Reader, Record};
use super::time_line::{Bar, TimeLine};
use crate::color::palette::ColorDepth;
use crate::game::{Intents, STEPS_PER_SECOND};
use crate::terminal::Key;
use crate::tui::GlyphSet;
use crate::tui::canvas::Canvas;
use crate::world::{Camera, FieldOfView, World};

/// The speeds, in quarters of the usual one.
const SPEEDS: [(&str, u64); 7] =
    [("1/4x", 1), ("1/2x", 2), ("1x", 4), ("2x", 8), ("4x", 16), ("8x", 32), ("16x", 64)];
const USUAL_SPEED: usize = 2;
/// The distances of the arrow keys, in steps.
const FIVE_SECONDS: i64 = 5 * STEPS_PER_SECOND as i64;
const MINUTE: i64 = 60 * STEPS_PER_SECOND as i64;
/// While time passes, the key to the mark before skips a mark that was passed so recently.
const JUST_PASSED: u64 = STEPS_PER_SECOND as u64;

/// A record and how it is shown. Its owner has the game at the cursor.
#[derive(Debug)]
pub struct Player<R: Record> {
    reader: Reader<R>,
    cursor: Cursor,
    is_paused: bool,
    /// The index in [`SPEEDS`].
    speed: usize,
    /// The quarters of a step that are left over.
    quarters: u64,
    /// The place to go to once it is read.
    wanted: Option<u64>,
    perspective: Perspective,
    /// The place of the line on the screen.
    bar: Bar,
    /// The state on the screen: the step, the camera, and the number of steps read.
    drawn: Option<(u64, Perspective, u64)>,
}

/// Where a record is seen from.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum Perspective {
    /// The eyes of a player.
    #[default]
    Eyes,
    /// The map.
    Above,
    /// A camera that flies.
    Free(Camera),
}

/// The effect of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlayerKey {
    /// None.
    Other,
    /// The player has changed.
    Done,
    /// The cursor goes to an event.
    ToMark(MarkKind),
}

impl Perspective {
    fn name(self) -> &'static str {
        match self {
            Self::Eyes => "eyes",
            Self::Above => "above",
            Self::Free(_) => "free",
        }
    }
}

impl<R: Record> Player<R> {
    /// A player of `record`, and its first state. `None` if the record cannot begin.
    pub fn new(record: R) -> Option<(Self, R::Game)> {
        let (reader, start) = Reader::new(record)?;
        let player = Self {
            reader,
            cursor: Cursor::default(),
            is_paused: false,
            speed: USUAL_SPEED,
            quarters: 0,
            wanted: None,
            perspective: Perspective::default(),
            bar: Bar::default(),
            drawn: None,
        };
        Some((player, start))
    }

    /// The record.
    pub fn record(&self) -> &R {
        &self.reader.record
    }

    /// The record, without the player.
    pub(crate) fn into_record(self) -> R {
        self.reader.record
    }

    /// The place of the state that is shown.
    pub fn cursor(&self) -> Cursor {
        self.cursor
    }

    /// Where the record is seen from.
    pub fn perspective(&self) -> Perspective {
        self.perspective
    }

    /// The camera that flies; `None` in the other views.
    pub fn camera(&self, field_of_view: FieldOfView) -> Option<Camera> {
        let Perspective::Free(mut camera) = self.perspective else { return None };
        camera.field_of_view = field_of_view;
        Some(camera)
    }

    /// Shows the next view; a camera that flies begins at `camera`.
    pub fn change_perspective(&mut self, camera: Camera) {
        self.perspective = match self.perspective {
            Perspective::Eyes => Perspective::Above,
            Perspective::Above => Perspective::Free(camera),
            Perspective::Free(_) => Perspective::Eyes,
        };
    }

    /// Moves the camera that flies through `world` by a step.
    pub fn fly(&mut self, world: &World, intents: Intents) {
        if let Perspective::Free(camera) = &mut self.perspective {
            *camera = free_camera::flown(*camera, world, intents);
        }
    }

    /// Whether a part of the record has not been read, or has not been reached by a jump.
    pub fn is_busy(&self) -> bool {
        !self.reader.is_read() || self.wanted.is_some()
    }

    /// Whether time stands still.
    pub fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// Whether the screen shows another state than this one.
    pub fn is_stale(&self) -> bool {
        self.drawn != Some(self.to_draw())
    }

    /// Records that the state was drawn.
    pub fn drawn(&mut self) {
        self.drawn = Some(self.to_draw());
    }

    fn to_draw(&self) -> (u64, Perspective, u64) {
        (self.cursor.step, self.perspective, self.reader.steps_read())
    }

    /// Moves the cursor to the wanted place if it is read, or on by the time of `steps` steps, and
    /// then reads ahead until `is_late`. Returns the number of steps played.
    pub fn advance(&mut self, steps: u64, game: &mut R::Game, is_late: &dyn Fn() -> bool) -> u64 {
        // A place that has just been read is shown at once.
        if self.wanted.is_some_and(|wanted| wanted > self.reader.steps_read()) {
            self.reader.read(is_late);
        }
        let played = self.play(steps, game, is_late);
        self.reader.read(is_late);
        played
    }

    fn play(&mut self, steps: u64, game: &mut R::Game, is_late: &dyn Fn() -> bool) -> u64 {
        let before = self.cursor.step;
        if let Some(wanted) = self.wanted {
            let is_known = wanted <= self.reader.steps_read() || self.reader.is_read();
            if is_known && self.reader.seek(wanted, (&mut self.cursor, game), is_late) {
                self.wanted = None;
            }
            return 0;
        }
        if self.is_paused {
            return 0;
        }
        self.quarters += steps * SPEEDS[self.speed].1;
        for _ in 0..self.quarters / 4 {
            self.reader.step(&mut self.cursor, game);
        }
        self.quarters %= 4;
        self.is_paused = self.is_over();
        self.cursor.step - before
    }

    /// The place that the keys move from.
    fn place(&self) -> u64 {
        self.wanted.unwrap_or(self.cursor.step)
    }

    /// Goes to a place, as soon as it is read.
    fn go_to(&mut self, step: u64) {
        self.wanted = Some(step);
        self.quarters = 0;
    }

    fn go_by(&mut self, steps: i64) {
        self.go_to(self.place().saturating_add_signed(steps).min(self.reader.steps()));
    }

    fn is_over(&self) -> bool {
        self.reader.is_read() && self.place() >= self.reader.steps()
    }

    /// Pauses, or goes on: from the start if the end is shown.
    pub fn toggle_pause(&mut self) {
        if self.is_over() {
            self.go_to(0);
            self.is_paused = false;
        } else {
            self.is_paused ^= true;
        }
    }

    /// Handles a key that moves the cursor.
    pub fn press(&mut self, key: Key, is_repeat: bool) -> PlayerKey {
        match key {
            Key::Char(',' | '.') => {
                self.is_paused = true;
                self.go_by(if key == Key::Char('.') { 1 } else { -1 });
            }
            Key::Char('<') => self.speed = self.speed.saturating_sub(1),
            Key::Char('>') => self.speed = (self.speed + 1).min(SPEEDS.len() - 1),
            Key::Left => self.go_by(-FIVE_SECONDS),
            Key::Right => self.go_by(FIVE_SECONDS),
            Key::Down => self.go_by(-MINUTE),
            Key::Up => self.go_by(MINUTE),
            Key::Home => self.go_to(0),
            Key::End => self.go_to(self.reader.steps()),
            Key::Char('n' | 'b') => {
                if let Some((step, kind)) = self.neighbour_mark(key == Key::Char('n')) {
                    self.go_to(step);
                    return PlayerKey::ToMark(kind);
                }
            }
            Key::Char(' ') if !is_repeat => self.toggle_pause(),
            _ => return PlayerKey::Other,
        }
        PlayerKey::Done
    }

    /// Goes to the place at which a cell of the time line is pressed; returns whether there is one.
    pub fn press_at(&mut self, x: u16, y: u16) -> bool {
        let step = self.bar.step_at(x, y, self.reader.steps());
        step.map(|step| self.go_to(step)).is_some()
    }

    /// The mark after or before the cursor.
    fn neighbour_mark(&self, is_after: bool) -> Option<(u64, MarkKind)> {
        let place = self.place();
        let grace = if self.is_paused { 0 } else { JUST_PASSED };
        let marks = &self.reader.marks;
        let mark = if is_after {
            marks.iter().find(|mark| mark.step > place)
        } else {
            marks.iter().rfind(|mark| mark.step + grace < place)
        };
        mark.map(|mark| (mark.step, mark.kind))
    }

    /// The text about the speed on the time line.
    fn speed_name(&self) -> &'static str {
        if self.wanted.is_some() {
            "reading"
        } else if self.is_over() {
            "end"
        } else if self.is_paused {
            "paused"
        } else {
            SPEEDS[self.speed].0
        }
    }

    /// Draws the time line.
    pub fn draw_time_line(
        &mut self,
        canvas: &mut impl Canvas,
        area: Rect,
        glyphs: GlyphSet,
        depth: ColorDepth,
    ) {
        let line = TimeLine {
            steps: self.reader.steps(),
            read: self.reader.steps_read(),
            is_read: self.reader.is_read(),
            marks: &self.reader.marks,
            step: self.place(),
            speed: self.speed_name(),
            view: self.perspective.name(),
        };
        self.bar = line.draw(canvas, area, glyphs, depth);
    }
}

/// The lines of a help page about the keys of a player.
pub const PLAYER_HELP: [&str; 2] = [
    "space pauses; , . step back and forward; < > slower, faster",
    "left right 5 s; down up a minute; Home End; n b to the mark after, before",
];

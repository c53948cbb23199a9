//! The mapping from keys and the mouse to intents: actions and the keys bound to them, the division
//! of time into steps, and the pointer.
//!
//! The mouse turns and tilts the view, and its buttons open and jump. Terminals report the
//! pointer's position and not the motion of the mouse, so the player turns by the difference of two
//! positions. The pointer cannot go beyond the left and the right edge of the window. While it
//! rests at an edge, the player keeps turning. The turn ends after one full circle, because
//! terminals do not report that the pointer has left the window.
//!
//! Positions are converted to angles first, and then subtracted. Rounding errors therefore do not
//! add up: a pointer that returns to its old position has not turned the player at all.

use std::collections::BTreeMap;
use std::time::Duration;

use crate::game::{Intent, Intents, Look, STEP, STEPS_PER_SECOND};
use crate::sort;
use crate::terminal::{Key, KeyEvent, MouseButton, MouseEvent, MouseEventKind, Phase};
use crate::tui::{HeldKeys, Hold, Press, tap_steps, wanted};

/// An action that a key can be bound to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// Carry out an intent for as long as the key is held.
    Want(Intent),
    /// Run until the key is pressed again.
    ToggleRun,
    /// Duck until the key is pressed again.
    ToggleDuck,
    /// Start or stop turning and tilting by the mouse.
    ToggleMouse,
    /// Walk until this key or another walking key is pressed.
    ToggleWalkOn,
    /// Show or hide the minimap.
    ToggleMinimap,
    /// Change the size of the minimap, or the part that it shows.
    ChangeMap(MapChange),
    /// Show or hide the help.
    ToggleHelp,
    /// Pause or continue.
    TogglePause,
    /// Widen the field of view.
    WidenView,
    /// Narrow the field of view.
    NarrowView,
    /// Show or hide the statistics about frames and the link.
    ToggleStats,
    /// Show or hide a dot in the middle of the picture.
    ToggleCrosshair,
    /// Show or hide the compass.
    ToggleCompass,
    /// Show or hide the ghost of the best run.
    ToggleGhost,
    /// Take the last seconds back.
    TakeBack,
    /// Leave the game.
    Leave,
}

/// A change of the minimap's size or of the part that it shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MapChange {
    Larger,
    Smaller,
    North,
    South,
    West,
    East,
    /// Return to the usual size, with the player in the middle.
    Center,
}

impl Action {
    /// Every action with its name in a configuration file, a short description, and its keys on a
    /// QWERTY keyboard.
    pub(crate) const ALL: [(&'static str, &'static str, Self, &'static [Key]); 43] = [
        ("forward", "walk", Self::Want(Intent::Forward), &[Key::Char('w'), Key::Up]),
        ("back", "walk back", Self::Want(Intent::Back), &[Key::Char('s'), Key::Down]),
        ("strafe-left", "strafe left", Self::Want(Intent::StrafeLeft), &[Key::Char('a')]),
        ("strafe-right", "strafe right", Self::Want(Intent::StrafeRight), &[Key::Char('d')]),
        ("turn-left", "turn left", Self::Want(Intent::TurnLeft), &[Key::Left]),
        ("turn-right", "turn right", Self::Want(Intent::TurnRight), &[Key::Right]),
        // These letters are on the same keys in nearly all layouts.
        ("fine-left", "turn left by 5°", Self::Want(Intent::FineLeft), &[Key::Char('u')]),
        ("fine-right", "turn right by 5°", Self::Want(Intent::FineRight), &[Key::Char('o')]),
        ("about-face", "turn around", Self::Want(Intent::AboutFace), &[Key::Char('b')]),
        ("walk-on", "keep walking", Self::ToggleWalkOn, &[Key::Char('g')]),
        ("run", "run while held", Self::Want(Intent::Run), &[Key::Shift]),
        ("open", "open or use", Self::Want(Intent::Open), &[Key::Char('e')]),
        ("jump", "jump, or open", Self::Want(Intent::Jump), &[Key::Char(' ')]),
        // Rejected: Control. With another key held, it is a command to the terminal.
        ("duck", "duck while held", Self::Want(Intent::Duck), &[Key::Char('c')]),
        ("strike", "strike", Self::Want(Intent::Strike), &[Key::Char('f')]),
        ("throw", "throw a pebble", Self::Want(Intent::Throw), &[Key::Char('t')]),
        ("shoot", "shoot a dart", Self::Want(Intent::Shoot), &[Key::Char('n')]),
        ("smoke", "throw smoke", Self::Want(Intent::Smoke), &[Key::Char('y')]),
        ("lamp", "lamp on or off", Self::Want(Intent::Lamp), &[Key::Char('l')]),
        // On every keyboard, and free in all presets.
        ("take-back", "take back 10 s", Self::TakeBack, &[Key::Backspace]),
        ("look-up", "look up", Self::Want(Intent::LookUp), &[Key::PageUp]),
        ("look-down", "look down", Self::Want(Intent::LookDown), &[Key::PageDown]),
        ("look-ahead", "look ahead", Self::Want(Intent::LookAhead), &[Key::Home]),
        ("toggle-run", "run on or off", Self::ToggleRun, &[Key::Char('r')]),
        ("toggle-duck", "duck on or off", Self::ToggleDuck, &[Key::Char('x')]),
        ("mouse", "turn by mouse", Self::ToggleMouse, &[Key::Char('v')]),
        ("minimap", "map", Self::ToggleMinimap, &[Key::Char('m'), Key::Tab]),
        // The digits follow the layout of a number pad.
        ("map-larger", "larger map", Self::ChangeMap(MapChange::Larger), &[Key::Char('9')]),
        ("map-smaller", "smaller map", Self::ChangeMap(MapChange::Smaller), &[Key::Char('3')]),
        ("map-north", "move it north", Self::ChangeMap(MapChange::North), &[Key::Char('8')]),
        ("map-south", "move it south", Self::ChangeMap(MapChange::South), &[Key::Char('2')]),
        ("map-west", "move it west", Self::ChangeMap(MapChange::West), &[Key::Char('4')]),
        ("map-east", "move it east", Self::ChangeMap(MapChange::East), &[Key::Char('6')]),
        ("map-center", "map around you", Self::ChangeMap(MapChange::Center), &[Key::Char('5')]),
        ("help", "this help", Self::ToggleHelp, &[Key::Char('?')]),
        ("pause", "pause", Self::TogglePause, &[Key::Char('p')]),
        ("wider", "wider view", Self::WidenView, &[Key::Char('+'), Key::Char('=')]),
        ("narrower", "narrower view", Self::NarrowView, &[Key::Char('-')]),
        ("crosshair", "crosshair", Self::ToggleCrosshair, &[Key::Char('.')]),
        ("compass", "compass", Self::ToggleCompass, &[Key::Char(',')]),
        ("ghost", "best run", Self::ToggleGhost, &[Key::Char('0')]),
        ("stats", "link statistics", Self::ToggleStats, &[Key::Char('i')]),
        ("leave", "leave", Self::Leave, &[Key::Char('q'), Key::Escape]),
    ];

    /// The action called `name`.
    pub(crate) fn named(name: &str) -> Option<Self> {
        Self::entry(name).map(|(_, action)| action)
    }

    /// The name of the action called `name` for as long as the program runs, and the action.
    pub(crate) fn entry(name: &str) -> Option<(&'static str, Self)> {
        let entry = Self::ALL.into_iter().find(|&(known, ..)| known == name);
        entry.map(|(known, _, action, _)| (known, action))
    }

    /// A short description of the action.
    pub(crate) fn does(self) -> &'static str {
        Self::ALL.iter().find(|&&(.., known, _)| known == self).map_or("", |&(_, does, ..)| does)
    }

    /// Returns true if the two actions cancel each other.
    pub(crate) fn opposes(self, other: Self) -> bool {
        matches!((self, other), (Self::Want(one), Self::Want(other)) if one.opposes(other))
    }
}

/// The key bindings: the action of each key.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bindings {
    /// Each key occurs once.
    keys: Vec<(Key, Action)>,
}

impl Bindings {
    /// The keys and a short description of every action, in the order of [`Action::ALL`].
    #[cfg(feature = "cli")]
    pub(crate) fn described(&self) -> impl Iterator<Item = (String, &'static str)> {
        Action::ALL.into_iter().map(|(_, does, action, _)| (self.key_names(action), does))
    }

    /// Replaces the keys of the actions in `rebound` by `bound`. A key in `bound` is removed from
    /// any other action.
    pub(crate) fn rebound(mut self, rebound: &[Action], bound: Vec<(Key, Action)>) -> Self {
        let is_bound = |key| bound.iter().any(|&(bound, _)| bound == key);
        self.keys.retain(|&(key, action)| !rebound.contains(&action) && !is_bound(key));
        self.keys.extend(bound);
        self.in_order()
    }

    /// Replaces the keys of `action` by `keys`, which any other action loses.
    pub(crate) fn with_keys(self, action: Action, keys: Vec<Key>) -> Self {
        self.rebound(&[action], keys.into_iter().map(|key| (key, action)).collect())
    }

    /// Replaces the keys of the actions in `own`. If two of them have the same key, the first one
    /// keeps it.
    pub(crate) fn with_own(self, own: &OwnKeys) -> Self {
        let (mut actions, mut bound) = (Vec::new(), Vec::<(Key, Action)>::new());
        for (name, keys) in own {
            let Some(action) = Action::named(name) else { continue };
            actions.push(action);
            for &key in keys {
                if bound.iter().all(|&(other, _)| other != key) {
                    bound.push((key, action));
                }
            }
        }
        self.rebound(&actions, bound)
    }

    /// The keys of the actions that have other keys than in `usual`.
    pub(crate) fn differences(&self, usual: &Self) -> OwnKeys {
        let differs =
            |&(.., action, _): &(_, _, Action, _)| !self.keys(action).eq(usual.keys(action));
        let changed = Action::ALL.into_iter().filter(differs);
        changed.map(|(name, _, action, _)| (name, self.keys(action).collect())).collect()
    }

    /// Removes the bindings of `keys`.
    #[must_use]
    pub fn without(mut self, keys: &[Key]) -> Self {
        self.keys.retain(|(key, _)| !keys.contains(key));
        self
    }

    /// Keeps the bindings of the actions that `is_kept` accepts, and removes all others.
    pub(crate) fn only(mut self, is_kept: impl Fn(Action) -> bool) -> Self {
        self.keys.retain(|&(_, action)| is_kept(action));
        self
    }

    /// Sorts the keys by action.
    fn in_order(mut self) -> Self {
        let index = |action| Action::ALL.iter().position(|&(_, _, known, _)| known == action);
        sort::by_key(&mut self.keys, |&(_, action)| index(action));
        self
    }

    /// The action of `key`.
    pub fn action(&self, key: Key) -> Option<Action> {
        self.keys.iter().find(|&&(bound, _)| bound == key).map(|&(_, action)| action)
    }

    /// The event with the key that has an action. That is the pressed key or, if the pressed key
    /// has no action, the key at its position on a US keyboard.
    pub fn resolve(&self, event: KeyEvent) -> KeyEvent {
        let base = event.base.filter(|_| self.action(event.key).is_none());
        KeyEvent { key: base.unwrap_or(event.key), ..event }
    }

    /// The names of the keys of `action`, separated by spaces.
    pub(crate) fn key_names(&self, action: Action) -> String {
        let names: Vec<String> = self.keys(action).map(|key| key.to_string()).collect();
        names.join(" ")
    }

    /// The keys of `action`, in the order in which they were bound.
    pub(crate) fn keys(&self, action: Action) -> impl Iterator<Item = Key> {
        self.keys.iter().filter(move |&&(_, bound)| bound == action).map(|&(key, _)| key)
    }
}

/// The keys that a player has chosen, by the name of the action.
pub(crate) type OwnKeys = BTreeMap<&'static str, Vec<Key>>;

/// A keyboard layout with its own set of bindings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Preset {
    #[default]
    Qwerty,
    /// The letters Z, Q, S and D take the places of W, A, S and D on a QWERTY keyboard; A leaves.
    Azerty,
    /// Keys for vi users: H and L turn, J and K walk, A and D strafe, Z lights the lamp.
    Hjkl,
}

impl Preset {
    /// The bindings of this layout.
    pub(crate) fn bindings(self) -> Bindings {
        // The letters that replace other letters, and the extra keys.
        let letters: &[(char, char)] = match self {
            Self::Qwerty => &[],
            Self::Azerty => &[('w', 'z'), ('a', 'q'), ('q', 'a')],
            Self::Hjkl => &[('w', 'k'), ('s', 'j'), ('l', 'z')],
        };
        let turns = [('h', Intent::TurnLeft), ('l', Intent::TurnRight)];
        let further = if self == Self::Hjkl { &turns[..] } else { &[] };
        let on_keyboard = |key| {
            let own = letters.iter().find(|&&(usual, _)| key == Key::Char(usual));
            own.map_or(key, |&(_, own)| Key::Char(own))
        };
        let bound = |(.., action, keys): (_, _, Action, &'static [Key])| {
            keys.iter().map(move |&key| (on_keyboard(key), action))
        };
        let further = further.iter().map(|&(key, intent)| (Key::Char(key), Action::Want(intent)));
        Bindings { keys: Action::ALL.into_iter().flat_map(bound).chain(further).collect() }
            .in_order()
    }
}

impl Default for Bindings {
    /// The bindings for QWERTY keyboards.
    fn default() -> Self {
        Preset::default().bindings()
    }
}

/// Divides time into steps of the game. The remainder counts towards the next step.
#[derive(Clone, Debug, Default)]
pub struct Clock {
    /// The time up to which steps are already counted.
    counted: Duration,
}

impl Clock {
    /// The largest number of steps computed at once, a quarter of a second. A machine that is too
    /// slow plays more slowly, and does not fall further and further behind.
    pub const MAX_STEPS: u64 = 15;

    /// The number of whole steps since the last call.
    pub fn steps_until(&mut self, now: Duration) -> u64 {
        let steps = steps_in(now.saturating_sub(self.counted));
        self.counted = after(self.counted, steps);
        steps
    }

    /// Skips the time up to `now`.
    pub fn skip_to(&mut self, now: Duration) {
        self.counted = now;
    }

    /// The time at which the step after the next `steps` steps ends.
    pub fn step_after(&self, steps: u64) -> Duration {
        after(self.counted, steps.saturating_add(1))
    }
}

/// The time that is `steps` steps after `time`.
pub(crate) fn after(time: Duration, steps: u64) -> Duration {
    time + Duration::from_nanos(STEP_NANOSECONDS.saturating_mul(steps))
}

/// The number of whole steps in `time`.
fn steps_in(time: Duration) -> u64 {
    // Times beyond `u64::MAX` nanoseconds are longer than five centuries.
    u64::try_from(time.as_nanos()).unwrap_or(u64::MAX) / STEP_NANOSECONDS
}

/// The duration of a step.
#[cfg(any(test, debug_assertions))]
pub(crate) fn step() -> Duration {
    Duration::from_nanos(STEP_NANOSECONDS)
}

/// The duration of a step in nanoseconds, rounded.
const STEP_NANOSECONDS: u64 = (STEP * 1e9 + 0.5) as u64;

/// The movement modes that are switched on.
#[derive(Clone, Copy, Debug, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a mode of its own")]
pub struct Toggles {
    /// Running, or walking if the player runs by default.
    pub runs: bool,
    /// `true` if the player runs unless a key asks for walking.
    pub runs_by_default: bool,
    /// Ducking.
    pub ducks: bool,
    /// Walking on without a key.
    pub keeps_walking: bool,
}

/// The keys that are held, and the modes that are switched on.
#[derive(Clone, Debug, Default)]
pub struct Controls {
    /// The held keys.
    pub held: HeldKeys<Key>,
    /// The modes.
    pub toggles: Toggles,
    /// The last key pressed with Shift, for terminals that do not report Shift itself.
    shifted: Option<Key>,
}

/// The part of the game's state that decides the effect of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyContext {
    /// `true` while the game runs and is not paused.
    pub plays: bool,
    /// `true` while the player is in the air.
    pub is_airborne: bool,
    /// `true` if the player flies, in which case ducking moves them.
    pub flies: bool,
}

impl Controls {
    /// Handles a key event. Returns the kind of press, or `None` for a release.
    pub fn handle(
        &mut self,
        event: KeyEvent,
        now: Duration,
        bindings: &Bindings,
        context: KeyContext,
    ) -> Option<Press> {
        let KeyEvent { key, modifiers, phase, .. } = event;
        match phase {
            Phase::Release => {
                self.held.release(key);
                return None;
            }
            Phase::Repeat if self.held.reports_releases() => {
                self.held.repeat(key);
                return Some(Press::Repeat);
            }
            Phase::Press | Phase::Repeat => {}
        }
        let action = bindings.action(key);
        let wants = match action {
            Some(Action::Want(intent)) => Some(intent),
            _ => None,
        };
        let steps = wants.filter(|_| context.plays).map_or(0, tap_steps);
        let opposes = |other| {
            action.zip(bindings.action(other)).is_some_and(|(one, other)| one.opposes(other))
        };
        let press = self.held.press(key, steps, now, opposes);
        self.shifted = if modifiers.shift {
            Some(key)
        } else {
            self.shifted.filter(|&shifted| shifted != key)
        };
        if press == Press::Repeat {
            return Some(press);
        }
        let wants_by = |key, is_meant: fn(Intent) -> bool| matches!(bindings.action(key), Some(Action::Want(intent)) if is_meant(intent));
        if press == Press::Fresh {
            self.held.release_lingering(|key| wants_by(key, Intent::turns));
        }
        if wants.is_some_and(Intent::walks) {
            self.toggles.keeps_walking = false;
        }
        if wants == Some(Intent::LookAhead) {
            self.held.release_each(|key| wants_by(key, tilts));
        }
        if wants == Some(Intent::Jump) && context.plays && !context.is_airborne {
            self.held.join_newest(|key| wants_by(key, Intent::walks));
        }
        Some(press)
    }

    /// Releases the keys that are no longer held at `now`.
    pub fn advance(&mut self, now: Duration, context: KeyContext) {
        if context.is_airborne {
            self.held.keep(now);
        }
        self.held.advance(now);
    }

    /// The number of steps from `now`, between one and `most`, during which the intents do not
    /// change.
    pub(crate) fn steady_steps(&self, now: Duration, context: KeyContext, most: u64) -> u64 {
        if self.held.has_taps() || context.is_airborne {
            return 1;
        }
        let until = self.held.next_expiry().unwrap_or(Duration::MAX);
        steps_in(until.saturating_sub(now)).saturating_add(1).min(most)
    }

    /// The player's intents.
    pub fn intents(&self, bindings: &Bindings, context: KeyContext) -> Intents {
        let keys = self.held.iter().filter_map(|(key, hold)| match bindings.action(key) {
            Some(Action::Want(Intent::Duck)) if context.flies && hold == Hold::Unknown => None,
            Some(Action::Want(Intent::Run)) if self.toggles.runs_by_default => None,
            Some(Action::Want(intent)) => Some((intent, hold)),
            _ => None,
        });
        let shifted = self.shifted.filter(|_| !self.held.reports_releases());
        let changes =
            self.toggles.runs || shifted.is_some_and(|key| self.held.hold(key) != Hold::Up);
        let runs = if self.toggles.runs_by_default {
            let is_wanted = |(key, hold)| {
                hold != Hold::Up && bindings.action(key) == Some(Action::Want(Intent::Run))
            };
            !(changes || self.held.iter().any(is_wanted)) && self.walks(bindings)
        } else {
            changes
        };
        let others = [
            runs.then_some(Intent::Run),
            self.toggles.ducks.then_some(Intent::Duck),
            self.toggles.keeps_walking.then_some(Intent::Forward),
        ];
        wanted(keys.chain(others.into_iter().flatten().map(|intent| (intent, Hold::Held))))
    }
}

impl Controls {
    /// Returns true if a key or a mode makes the player walk.
    fn walks(&self, bindings: &Bindings) -> bool {
        let walks = |(key, hold)| {
            let action = bindings.action(key);
            hold != Hold::Up && matches!(action, Some(Action::Want(intent)) if intent.walks())
        };
        self.toggles.keeps_walking || self.held.iter().any(walks)
    }
}

/// Returns true if `intent` looks up or down.
fn tilts(intent: Intent) -> bool {
    matches!(intent, Intent::LookUp | Intent::LookDown)
}

/// The angle of turn or tilt for a motion across one cell, in degrees.
const DEGREES_PER_CELL: i32 = 2;
/// The turning speed while the pointer rests at an edge, in degrees per second.
const DEGREES_PER_SECOND: i32 = 90;
/// The number of steps that the player turns at an edge: one full circle.
const EDGE_STEPS: u32 = 360 * STEPS_PER_SECOND / DEGREES_PER_SECOND as u32;
/// An edge is one column wide, plus one for each 80 columns. A pointer that leaves the window
/// quickly is last reported slightly inside it.
const COLUMNS_PER_EDGE_COLUMN: i32 = 80;

/// The position of the pointer, and its motion and clicks since the last step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pointer {
    is_on: bool,
    columns: u16,
    /// The position from the upper left corner, in units of [`Look`]; `None` if unknown.
    position: Option<[i32; 2]>,
    /// The motion since the last step, in the same units.
    moved: [i32; 2],
    /// The intents from the buttons for the next step.
    clicked: Intents,
    /// The edge at which the pointer rests (−1 for left, 1 for right), and the number of steps for
    /// which it still turns the player.
    edge: Option<(i16, u32)>,
}

impl Pointer {
    /// A pointer with the mouse switched on or off.
    pub fn new(is_on: bool) -> Self {
        Self { is_on, ..Self::default() }
    }

    /// Returns true if the mouse turns the player.
    pub fn is_on(&self) -> bool {
        self.is_on
    }

    /// Switches the mouse on or off.
    pub fn toggle(&mut self) {
        *self = Self { is_on: !self.is_on, columns: self.columns, ..Self::default() };
    }

    /// Forgets the pointer's position.
    pub fn forget(&mut self) {
        *self = Self { is_on: self.is_on, columns: self.columns, ..Self::default() };
    }

    /// Sets the width of the window, in columns.
    pub fn set_columns(&mut self, columns: u16) {
        self.columns = columns;
        self.forget();
    }

    /// Handles a mouse event. Motion and clicks count only while the player `plays`.
    pub fn handle(&mut self, event: MouseEvent, plays: bool) {
        if !self.is_on {
            return;
        }
        self.move_to(event.x, event.y);
        if !plays {
            self.moved = [0, 0];
            return;
        }
        match event.kind {
            MouseEventKind::Pressed(MouseButton::Left) => self.clicked.insert(Intent::Open),
            MouseEventKind::Pressed(MouseButton::Right) => self.clicked.insert(Intent::Jump),
            _ => {}
        }
    }

    /// The intents from the buttons for the next step.
    pub fn clicked(&self) -> Intents {
        self.clicked
    }

    /// Returns true if the next step turns the player or uses a click.
    pub fn is_busy(&self) -> bool {
        self.has_input() || self.edge.is_some()
    }

    /// Moves the pointer to a position in units of [`MouseEvent`].
    fn move_to(&mut self, x: u32, y: u32) {
        let units_per_cell = MouseEvent::UNITS_PER_CELL as i32;
        let position = [x, y].map(|units| {
            units as i32 * DEGREES_PER_CELL * i32::from(Look::PER_DEGREE) / units_per_cell
        });
        let before = self.position.replace(position).unwrap_or(position);
        let [right, down] = [position[0] - before[0], position[1] - before[1]];
        let half_a_window =
            i32::from(self.columns) * DEGREES_PER_CELL * i32::from(Look::PER_DEGREE) / 2;
        // A longer motion means that the pointer left the window in between.
        if right.abs() <= half_a_window {
            self.moved = [self.moved[0] + right, self.moved[1] + down];
        }
        self.edge = self.edge_at(x as i32 / units_per_cell).map(|edge| (edge, EDGE_STEPS));
    }

    /// The edge at `column`, if any.
    fn edge_at(&self, column: i32) -> Option<i16> {
        let columns = i32::from(self.columns);
        let at_edge = 1 + columns / COLUMNS_PER_EDGE_COLUMN;
        if columns < 4 * at_edge {
            return None;
        }
        let to_the_left = column < at_edge;
        let to_the_right = column >= columns - at_edge;
        (to_the_left || to_the_right).then_some(if to_the_left { -1 } else { 1 })
    }

    /// The turn and tilt of the next step.
    pub fn look(&self) -> Look {
        let at_edge = self.edge.map_or(0, |(edge, _)| {
            i32::from(edge) * DEGREES_PER_SECOND * i32::from(Look::PER_DEGREE)
                / STEPS_PER_SECOND as i32
        });
        let within = |amount: i32| amount.clamp(-i32::from(i16::MAX), i16::MAX.into()) as i16;
        Look { turn: within(self.moved[0] + at_edge), tilt: within(-self.moved[1]) }
    }

    /// Returns true if the mouse moved or a button was pressed since the last step.
    pub(crate) fn has_input(&self) -> bool {
        self.moved != [0, 0] || !self.clicked.is_empty()
    }

    /// Records that `steps` steps have used the result of [`Pointer::look`].
    pub fn passed(&mut self, steps: u64) {
        if steps == 0 {
            return;
        }
        self.moved = [0, 0];
        self.clicked = Intents::new();
        self.edge = self.edge.and_then(|(edge, left)| {
            let left = u64::from(left).saturating_sub(steps) as u32;
            (left > 0).then_some((edge, left))
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::Configuration;
    use crate::terminal::{Modifiers, Phase};
    use proptest::prelude::*;

    #[test]
    fn every_action_has_a_key_in_every_preset() {
        for preset in [Preset::Qwerty, Preset::Azerty, Preset::Hjkl] {
            for (name, _, action, _) in Action::ALL {
                assert!(preset.bindings().keys(action).next().is_some(), "{name} in {preset:?}");
            }
        }
    }

    #[test]
    fn a_keys_character_takes_precedence_over_its_position() {
        let event = |key, base| KeyEvent {
            key: Key::Char(key),
            base: Some(Key::Char(base)),
            modifiers: Modifiers::default(),
            phase: Phase::Press,
        };
        let text = "[keys]\nopen = \"ц\"";
        let cyrillic = Configuration::parse(text, "config.toml").unwrap().bindings;
        assert_eq!(cyrillic.resolve(event('ц', 'w')).key, Key::Char('ц'));
        assert_eq!(cyrillic.resolve(event('ф', 'a')).key, Key::Char('a'));
        assert_eq!(Bindings::default().resolve(event('ц', 'w')).key, Key::Char('w'));
    }

    #[test]
    fn no_time_is_lost_between_calls() {
        let mut clock = Clock::default();
        let steps: u64 = (1..=997).map(|call| clock.steps_until(Duration::from_millis(call))).sum();
        assert_eq!(steps, 59);
        assert!(clock.step_after(0) > Duration::from_millis(997));
        assert_eq!(clock.step_after(2), clock.step_after(0) + 2 * step());
        clock.skip_to(Duration::from_hours(1));
        assert_eq!(clock.steps_until(Duration::from_hours(1)), 0);
    }

    fn on(columns: u16) -> Pointer {
        let mut pointer = Pointer::new(true);
        pointer.set_columns(columns);
        pointer
    }

    const CELL: u32 = MouseEvent::UNITS_PER_CELL;

    #[test]
    fn the_first_position_turns_nothing_and_a_cell_turns_two_degrees() {
        let mut pointer = on(80);
        pointer.move_to(40 * CELL, 10 * CELL);
        assert_eq!(pointer.look(), Look::NONE);
        pointer.move_to(41 * CELL, 10 * CELL);
        assert_eq!(pointer.look(), Look { turn: 200, tilt: 0 });
        pointer.passed(1);
        assert_eq!(pointer.look(), Look::NONE);
        pointer.move_to(41 * CELL, 8 * CELL);
        assert_eq!(pointer.look(), Look { turn: 0, tilt: 400 });
    }

    #[test]
    fn an_edge_turns_the_player_one_full_circle() {
        let mut pointer = on(80);
        pointer.move_to(50 * CELL, 10 * CELL);
        pointer.move_to(79 * CELL, 10 * CELL);
        pointer.passed(1);
        let mut turned = 0;
        for _ in 0..10_000 {
            turned += i32::from(pointer.look().turn);
            pointer.passed(1);
        }
        // The first of these steps already happened above, when the motion was used.
        assert_eq!(turned, 360 * 100 - 150);
        pointer.move_to(0, 10 * CELL);
        assert_eq!(pointer.look().turn, -150, "it came from the other side of the window");
        pointer.forget();
        assert_eq!(pointer.look(), Look::NONE);
    }

    #[test]
    fn a_narrow_window_has_no_edges() {
        let mut pointer = on(3);
        pointer.move_to(CELL, 0);
        pointer.move_to(0, 0);
        assert_eq!(pointer.look().turn, -200);
        pointer.passed(1);
        assert_eq!(pointer.look(), Look::NONE);
    }

    proptest! {
        #[test]
        fn returning_to_a_position_undoes_the_turn(
            positions in prop::collection::vec((20 * CELL..60 * CELL, 0..24 * CELL), 1..40),
            cuts in prop::collection::vec(any::<bool>(), 40),
        ) {
            let mut pointer = on(80);
            let mut sum = [0, 0];
            for (&(x, y), &cut) in positions.iter().chain(&positions[..1]).zip(cuts.iter().chain(&cuts)) {
                pointer.move_to(x, y);
                if cut {
                    let look = pointer.look();
                    sum = [sum[0] + i32::from(look.turn), sum[1] + i32::from(look.tilt)];
                    pointer.passed(1);
                }
            }
            let look = pointer.look();
            prop_assert_eq!([sum[0] + i32::from(look.turn), sum[1] + i32::from(look.tilt)], [0, 0]);
        }
    }
}

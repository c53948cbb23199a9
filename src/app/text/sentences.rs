//! Sentences about a game: what is near, what happens, and the state of the player.

use glam::DVec2;

use crate::app::screen::capitalized;
use crate::cast::{Caster, Exact, Ray};
use crate::game::{
    Alarm, FlashKind, Game, GuardView, Health, Heard, Mood, PlayerId, Share, SoundKind,
};
use crate::tui::Explored;
use crate::world::{Camera, Cell, FieldOfView, Supply, ThingKind, TileKind};

/// The number of rays with which the player looks around, and of things that are named at most.
const RAYS: u32 = 80;
const MAX_NAMED: usize = 8;
/// A difference of floors that is worth saying, in cells.
const STEP_HEIGHT: f64 = 0.3;
/// The distance between two points at which the floor is examined, in cells.
const STRIDE: f64 = 0.25;
/// The farthest floor that is examined, in cells.
const FAR: f64 = 64.0;

/// The surroundings of the player.
pub(crate) struct Surroundings<'a> {
    game: &'a Game,
    camera: Camera,
}

impl<'a> Surroundings<'a> {
    pub(crate) fn of(game: &'a Game) -> Self {
        Self { game, camera: game.camera(FieldOfView::default()) }
    }

    /// A sentence about the player's place, one for each of four directions, and one for each thing and guard in
    /// view, from near to far.
    pub(crate) fn sentences(&self) -> Vec<String> {
        let camera = &self.camera;
        let DVec2 { x, y } = camera.position().floor();
        let compass = COMPASS[eighth(camera.heading.degrees())];
        let mut sentences = vec![format!("You face {compass}, in column {x}, row {y}.")];
        let ways = [("Ahead", 0.0), ("Left", -90.0_f64), ("Right", 90.0), ("Behind", 180.0)];
        let ways = ways.map(|(name, degrees)| {
            let direction = camera.heading.turned(degrees.to_radians()).direction();
            format!("{name}: {}", self.along(direction))
        });
        sentences.push(format!("{}.", ways.join(". ")));
        sentences.extend(self.guards().map(|guard| format!("{}.", self.about_guard(&guard))));
        let mut things = self.things();
        things.sort_by(|one, other| one.1.total_cmp(&other.1));
        let named = things.into_iter().take(MAX_NAMED);
        sentences.extend(named.map(|(name, distance, way)| {
            format!("{}, {way}, {}.", capitalized(&name), cells(distance))
        }));
        sentences
    }

    fn guards(&self) -> impl Iterator<Item = GuardView> + use<'a> {
        let player = self.game.seen_by(PlayerId::FIRST);
        let camera = self.camera;
        player.into_iter().flat_map(move |player| player.guards_in_sight(&camera))
    }

    fn about_guard(&self, guard: &GuardView) -> String {
        let way = guard.position - self.camera.position();
        let (direction, distance) = (relative(&self.camera, way), way.length());
        let name = capitalized(guard.kind.name());
        format!("{name}, {direction}, {}, {}", cells(distance), mood(guard))
    }

    /// The first step or obstacle along `direction`.
    fn along(&self, direction: DVec2) -> String {
        let (world, origin) = (self.game.world(), self.camera.position());
        let hit = Ray::new(origin, direction).ok().and_then(|ray| Exact.cast(world.grid(), &ray));
        let end = hit.map_or(FAR, |hit| hit.t.min(FAR));
        let floor = |t: f64| Cell::containing(origin + direction * t).map(|it| world.floor_at(it));
        let own = self.game.feet();
        let steps = (1..).map(|step| f64::from(step) * STRIDE).take_while(|&t| t < end);
        let mut uneven = steps.filter_map(|t| Some((t, floor(t)? - own)));
        if let Some((t, rise)) = uneven.find(|(_, rise)| rise.abs() >= STEP_HEIGHT) {
            let what = if rise > 0.0 { "a step up" } else { "a step down" };
            return format!("{what} of {:.1} after {}", rise.abs(), cells(t));
        }
        let Some(hit) = hit else { return "nothing".to_owned() };
        let tile = world.grid().tile(hit.cell.column.into(), hit.cell.row.into());
        let what = match tile.map(|tile| world.tile(tile).kind) {
            Some(TileKind::Door(_)) => "a door",
            Some(TileKind::Mask(_)) => "a grate",
            Some(TileKind::Glass(_)) => "glass",
            Some(TileKind::Mirror(_)) => "a mirror",
            Some(TileKind::Shape(_)) => "a pillar or a thin wall",
            _ => "a wall",
        };
        format!("{what} after {}", cells(hit.t))
    }

    /// The things in view: their names, distances and directions.
    fn things(&self) -> Vec<(String, f64, &'static str)> {
        let world = self.game.world();
        let mut seen = Explored::default();
        seen.look(world, &self.camera, RAYS);
        let things = world.things().iter().filter(|thing| seen.contains(thing.cell));
        let named = things.filter_map(|thing| {
            let name = match thing.kind {
                ThingKind::Exit => "the exit".to_owned(),
                ThingKind::Key(key) => format!("the {} key", world.key_name(key)),
                ThingKind::Treasure(worth) => format!("treasure worth {worth}"),
                ThingKind::Healing(_) => "something that heals".to_owned(),
                ThingKind::Supply(supply, count) => format!("{count} {}", supply.name()),
                ThingKind::Note(_) => "a note".to_owned(),
                ThingKind::Checkpoint => "a checkpoint".to_owned(),
                ThingKind::Lever(_) => "a lever".to_owned(),
                ThingKind::Spikes(_) => "spikes".to_owned(),
                ThingKind::Flame => "a flame".to_owned(),
                ThingKind::Ornament => return None,
            };
            let way = thing.cell.center() - self.camera.position();
            Some((name, way.length(), relative(&self.camera, way)))
        });
        named.collect()
    }
}

/// The things that a player can notice in one step.
pub(crate) struct Observation {
    camera: Camera,
    health: Health,
    hurt_from: Option<&'static str>,
    alarm: Alarm,
    message: Option<String>,
    heard: Vec<Heard>,
    guards: Vec<(GuardView, String)>,
}

/// Something that happens in a step.
pub(crate) struct StepEvent {
    pub(crate) sentence: String,
    /// `true` if the player may want to do something else.
    pub(crate) threatens: bool,
}

impl Observation {
    pub(crate) fn of(game: &Game) -> Self {
        let surroundings = Surroundings::of(game);
        let camera = surroundings.camera;
        let hurt_from = game.flash().and_then(|flash| match flash.kind {
            FlashKind::Hurt { bearing } => Some(relative(&camera, bearing?.direction())),
            FlashKind::Gain => None,
        });
        let guards = surroundings.guards();
        Self {
            camera,
            health: game.health(),
            hurt_from,
            alarm: game.alarm(),
            message: game.message().map(str::to_owned),
            heard: game.heard().to_vec(),
            guards: guards.map(|guard| (guard, surroundings.about_guard(&guard))).collect(),
        }
    }

    /// The events that led from `before` to this moment.
    pub(crate) fn events_since(&self, before: &Self) -> Vec<StepEvent> {
        let mut events = Vec::new();
        let mut add = |sentence: String, threatens| events.push(StepEvent { sentence, threatens });
        let Health { points, most } = self.health;
        if points < before.health.points {
            let from = self.hurt_from.map_or_else(String::new, |way| format!(" from {way}"));
            add(format!("You are hurt{from}: {points} of {most} points left."), true);
        }
        if let Some(message) =
            self.message.as_ref().filter(|it| before.message.as_ref() != Some(it))
        {
            add(message.clone(), false);
        }
        let is_known = |guard: &GuardView| {
            let was_there = |it: &GuardView| {
                it.kind == guard.kind && it.position.distance(guard.position) < 1.0
            };
            before.guards.iter().any(|(it, _)| was_there(it))
        };
        for (_, about) in self.guards.iter().filter(|(guard, _)| !is_known(guard)) {
            add(format!("In view: {about}."), true);
        }
        match (before.alarm, self.alarm) {
            (before, now) if before == now => {}
            (_, Alarm::Raised) => add("Alarm: a guard follows you.".to_owned(), true),
            (Alarm::Calm, Alarm::Wary) => add("A guard has noticed something.".to_owned(), true),
            (_, Alarm::Wary) => {
                add("The guards have lost you and are searching.".to_owned(), false);
            }
            (_, Alarm::Calm) => add("The guards are calm.".to_owned(), false),
        }
        let is_new = |heard: &&Heard| {
            let is_it = |it: &Heard| it.kind == heard.kind && it.left >= heard.left;
            !before.heard.iter().any(is_it)
        };
        // The player knows their own cry.
        let is_own = |heard: &&Heard| {
            heard.kind == SoundKind::Cry && self.health.points < before.health.points
        };
        for heard in self.heard.iter().filter(is_new).filter(|it| !is_own(it)) {
            let way = relative(&self.camera, heard.bearing.direction());
            let threatens = matches!(heard.kind, SoundKind::Windup | SoundKind::Draw);
            add(format!("You hear {} {way}.", sound(heard.kind)), threatens);
        }
        events
    }
}

/// Sentences about the player's health, alarm, possessions and time.
pub(crate) fn status(game: &Game) -> Vec<String> {
    let Health { points, most } = game.health();
    let alarm = match game.alarm() {
        Alarm::Calm => "Nobody has noticed you",
        Alarm::Wary => "A guard is wary",
        Alarm::Raised => "A guard follows you",
    };
    let mut sentences = vec![format!("Health {points} of {most}. {alarm}.")];
    let supplies = Supply::ALL.iter().map(|&it| (game.supplies(it), it.name()));
    let carried: Vec<String> = supplies
        .filter(|(count, _)| *count > 0)
        .map(|(count, name)| format!("{count} {name}"))
        .collect();
    let carried = if carried.is_empty() { "nothing".to_owned() } else { carried.join(", ") };
    let lamp = if game.lamp_is_lit() { "lit" } else { "out" };
    sentences.push(format!("You carry {carried}. Your lamp is {lamp}."));
    sentences.extend(game.keys().map(|key| format!("You have the {key} key.")));
    let Share { found, total } = game.treasure();
    if total > 0 {
        let needed = game.world().treasure_needed();
        sentences.push(format!("Treasure {found} of {total}, {needed} needed."));
    }
    sentences.push(format!("Time {:.0} s.", game.elapsed()));
    sentences
}

/// The directions of the map, clockwise from east, which is heading 0.
pub(crate) const COMPASS: [&str; 8] =
    ["east", "south-east", "south", "south-west", "west", "north-west", "north", "north-east"];

/// The eighth of a circle that contains an angle, in degrees.
pub(crate) fn eighth(degrees: f64) -> usize {
    (degrees / 45.0).round().rem_euclid(8.0) as usize
}

/// The direction of `way` as the player sees it.
fn relative(camera: &Camera, way: DVec2) -> &'static str {
    const WAYS: [&str; 8] = [
        "ahead",
        "ahead to the right",
        "to the right",
        "behind to the right",
        "behind",
        "behind to the left",
        "to the left",
        "ahead to the left",
    ];
    let direction = camera.direction();
    let angle = libm::atan2(direction.perp_dot(way), direction.dot(way));
    WAYS[eighth(angle.to_degrees())]
}

fn cells(distance: f64) -> String {
    let rounded = format!("{distance:.1}");
    let rounded = rounded.strip_suffix(".0").unwrap_or(&rounded);
    if rounded == "1" { "1 cell".to_owned() } else { format!("{rounded} cells") }
}

fn mood(guard: &GuardView) -> &'static str {
    match guard.mood {
        Mood::Asleep => "asleep",
        Mood::OnDuty => "on duty",
        Mood::Wondering => "wary",
        Mood::Searching => "searching for you",
        Mood::Chasing => "following you",
        Mood::Attacking => "attacking",
        Mood::Down => "on the floor",
        Mood::Returning => "going back to duty",
    }
}

fn sound(kind: SoundKind) -> &'static str {
    match kind {
        SoundKind::Walking => "steps",
        SoundKind::Running => "running steps",
        SoundKind::Landing => "a landing",
        SoundKind::Splash => "a splash",
        SoundKind::Door => "a door",
        SoundKind::Mechanism => "stone that moves",
        SoundKind::Spikes => "spikes that are about to come out",
        SoundKind::Knock => "a knock",
        SoundKind::Crash => "something break",
        SoundKind::Blow => "a blow",
        SoundKind::Cry => "a cry",
        SoundKind::Fall => "somebody fall",
        SoundKind::Wonder => "\"hm?\"",
        SoundKind::GiveUp => "\"nothing there\"",
        SoundKind::Shout => "a shout",
        SoundKind::Bell => "a bell",
        SoundKind::Bark => "a bark",
        SoundKind::Windup => "a weapon being raised",
        SoundKind::Draw => "a bow being drawn",
        SoundKind::Shot => "a shot",
        SoundKind::Swing => "a blow that misses",
    }
}

/// `text` as a sentence, with a capital letter and a full stop.
pub(crate) fn sentence(text: &str) -> String {
    let ends = text.ends_with(['.', '!', '?', ':']);
    capitalized(text) + if ends { "" } else { "." }
}

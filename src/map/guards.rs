//! Guards: reads their definitions, and finds their posts and the waypoints of their patrols.

use std::collections::BTreeSet;
use std::ops::Range;

use toml::de::DeTable;

use super::drawing::Drawing;
use super::items::whole;
use super::legend::{Legend, Meaning, heading};
use super::mechanisms::is_true;
use super::per_character::PerCharacter;
use crate::fault::document::Entry;
use crate::fault::{Fault, nearest, quoted};
use crate::world::{Cell, Difficulty, Duty, GuardKind, GuardPost, Heading};

/// The largest number of guards.
const MOST_GUARDS: usize = 256;
/// The largest number of waypoints of a patrol.
const LONGEST_PATROL: usize = 64;
const EXAMPLE: &str = r#"{ guard = "warden", heading = 90 }"#;

/// A guard as the legend defines it.
pub(crate) struct GuardSymbol<'a> {
    kind: GuardKind,
    heading: Heading,
    duty: DutyText<'a>,
    from: Difficulty,
}

/// A duty as the legend defines it.
enum DutyText<'a> {
    Stand,
    Sleep,
    /// The characters of the waypoints, and their place in the map.
    Patrol(&'a str, Range<usize>),
    Wander(u8),
}

impl<'a> GuardSymbol<'a> {
    /// Reads the guard in `entry` of `table`; reports a fault where there is none.
    pub(crate) fn read(entry: &Entry<'a, '_>, table: &'a DeTable<'_>) -> Option<Self> {
        let faults_before = entry.faults.len();
        let kind = kind(entry);
        let mut duties = Vec::new();
        let mut first_heading = Heading::default();
        let mut from = Difficulty::Easy;
        for entry in entry.entries(table) {
            let duty = match entry.key {
                "heading" => {
                    first_heading = heading(&entry).unwrap_or_default();
                    continue;
                }
                "difficulty" => {
                    from = difficulty(&entry).unwrap_or(from);
                    continue;
                }
                "patrol" => patrol(&entry),
                "wander" => whole(&entry, 1..=64).map(DutyText::Wander),
                "asleep" => is_true(&entry).then_some(DutyText::Sleep),
                _ => continue,
            };
            duties.push((duty, entry.key_place));
        }
        if let [_, (_, second), ..] = &duties[..] {
            let message = "a guard has one duty: patrol, wander or asleep";
            entry.faults.push(
                Fault::new(second.clone(), message)
                    .label("this is another")
                    .help("keep one of them, or none for a guard who stands"),
            );
        }
        if entry.faults.len() > faults_before {
            return None;
        }
        let duty = duties.pop().and_then(|(duty, _)| duty).unwrap_or(DutyText::Stand);
        Some(Self { kind: kind?, heading: first_heading, duty, from })
    }

    fn post(&self, cell: Cell, waypoints: &PerCharacter<Option<Cell>>) -> GuardPost {
        let duty = match self.duty {
            DutyText::Stand => Duty::Stand,
            DutyText::Sleep => Duty::Sleep,
            DutyText::Wander(cells) => Duty::Wander(cells),
            DutyText::Patrol(characters, _) => {
                Duty::Patrol(characters.chars().filter_map(|it| waypoints.get(it)).collect())
            }
        };
        GuardPost { kind: self.kind, cell, heading: self.heading, duty, from: self.from }
    }
}

/// The guards in the drawing, row by row from the north, and within a row from the west.
pub(crate) fn posts(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Vec<GuardPost> {
    let guards: Vec<(char, &GuardSymbol<'_>)> = guards(drawing, legend).collect();
    let mut guard_of = PerCharacter::<Option<usize>>::new();
    for (index, (character, _)) in guards.iter().enumerate() {
        *guard_of.get_mut(*character) = Some(index);
    }
    let waypoints = waypoints(drawing, legend);
    let posts = drawing.cells().filter_map(|(cell, character)| {
        let (_, guard) = guards[guard_of.get(character)?];
        Some(guard.post(cell, &waypoints))
    });
    posts.collect()
}

/// The last cell of each waypoint.
fn waypoints(drawing: &Drawing<'_>, legend: &Legend<'_>) -> PerCharacter<Option<Cell>> {
    let mut is_wanted = PerCharacter::<bool>::new();
    let mut cells = PerCharacter::new();
    for (character, symbol) in legend.used_in(drawing) {
        *is_wanted.get_mut(character) = matches!(symbol.meaning, Meaning::Waypoint);
    }
    for (cell, character) in drawing.cells() {
        if is_wanted.get(character) {
            *cells.get_mut(character) = Some(cell);
        }
    }
    cells
}

/// The faults of patrols without their waypoints, and of waypoints without a patrol.
pub(crate) fn faults(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Vec<Fault> {
    if !legend.is_clear() {
        return Vec::new();
    }
    let mut faults: Vec<Fault> = too_many(drawing, legend).into_iter().collect();
    let mut walked = BTreeSet::new();
    for (_, guard) in guards(drawing, legend) {
        let DutyText::Patrol(characters, place) = &guard.duty else { continue };
        let missing = characters.chars().find(|&it| !is_waypoint(legend, it));
        let undrawn = characters.chars().find(|&it| drawing.sightings(it).count == 0);
        walked.extend(characters.chars());
        let fault = |message| Fault::new(place.clone(), message);
        if let Some(missing) = missing {
            let name = missing.to_string();
            faults.push(fault(format!("the patrol names {missing:?}, which is no waypoint")).help(
                format!("under [things] write {name:?} = {{ waypoint = true }}, and draw it once"),
            ));
        } else if let Some(undrawn) = undrawn {
            let message = format!("the waypoint {undrawn:?} of the patrol is not drawn");
            faults.push(fault(message).help(format!("draw one {undrawn:?} in the grid")));
        }
    }
    faults.extend(waypoint_faults(drawing, legend, &walked));
    faults
}

/// The fault of the guards after the first [`MOST_GUARDS`].
fn too_many(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Option<Fault> {
    let count: usize = guards(drawing, legend).map(|(it, _)| drawing.sightings(it).count).sum();
    (count > MOST_GUARDS).then(|| {
        let message =
            format!("the grid has {count} guards, and {MOST_GUARDS} at most can be there");
        Fault::new(drawing.key_place.clone(), message).help("draw fewer of them")
    })
}

/// The faults of waypoints that are drawn more than once, or that no guard walks to.
fn waypoint_faults(
    drawing: &Drawing<'_>,
    legend: &Legend<'_>,
    walked: &BTreeSet<char>,
) -> impl Iterator<Item = Fault> {
    let waypoints = drawing.characters().filter(|&(it, _)| is_waypoint(legend, it));
    waypoints.filter_map(|(character, sightings)| {
        let place = |index: usize| {
            sightings.first_places().get(index).map(|&at| drawing.place(character, at))
        };
        if !walked.contains(&character) {
            let message = format!("no guard walks to the waypoint {character:?}");
            let help = format!("name it in a guard's patrol, such as patrol = \"{character}\"");
            return Some(Fault::new(place(0)?, message).help(help));
        }
        let message = format!("the waypoint {character:?} is drawn more than once");
        Some(
            Fault::new(place(1)?, message)
                .label("this is the second")
                .help("draw each waypoint once, with a character of its own"),
        )
    })
}

fn is_waypoint(legend: &Legend<'_>, character: char) -> bool {
    let symbol = legend.symbols.get(&character);
    symbol.is_some_and(|symbol| matches!(symbol.meaning, Meaning::Waypoint))
}

/// The characters in the grid that are guards.
fn guards<'l, 'a>(
    drawing: &'l Drawing<'_>,
    legend: &'l Legend<'a>,
) -> impl Iterator<Item = (char, &'l GuardSymbol<'a>)> {
    legend.used_in(drawing).filter_map(|(character, symbol)| match &symbol.meaning {
        Meaning::Guard(guard) => Some((character, guard)),
        _ => None,
    })
}

fn kind(entry: &Entry<'_, '_>) -> Option<GuardKind> {
    let name = entry.string(EXAMPLE)?;
    let kind = GuardKind::ALL.into_iter().find(|kind| kind.name() == name);
    if kind.is_none() {
        let names = GuardKind::ALL.map(GuardKind::name);
        let help = match nearest(name, &names) {
            Some(near) => format!("the nearest guard is {}", quoted(near)),
            None => format!("write one of {}", names.join(", ")),
        };
        let message = format!("there is no guard {}", quoted(name));
        entry.faults.push(Fault::new(entry.value_place.clone(), message).help(help));
    }
    kind
}

fn difficulty(entry: &Entry<'_, '_>) -> Option<Difficulty> {
    let name = entry.string(r#"difficulty = "normal""#)?;
    let difficulty = Difficulty::named(name);
    if difficulty.is_none() {
        let names = Difficulty::ALL.map(Difficulty::name);
        let message = format!("there is no difficulty {}", quoted(name));
        let help = format!("write one of {}: the guard is there from it on", names.join(", "));
        entry.faults.push(Fault::new(entry.value_place.clone(), message).help(help));
    }
    difficulty
}

/// Reads the characters of a patrol's waypoints.
fn patrol<'a>(entry: &Entry<'a, '_>) -> Option<DutyText<'a>> {
    let characters = entry.string(r#"patrol = "123""#)?;
    if characters.is_empty() {
        entry.faults.push(
            Fault::new(entry.value_place.clone(), "the patrol names no waypoint")
                .help("write the characters of its waypoints, such as patrol = \"123\""),
        );
        return None;
    }
    let count = characters.chars().count();
    if count > LONGEST_PATROL {
        let message =
            format!("the patrol has {count} waypoints, and {LONGEST_PATROL} at most are allowed");
        let help = "leave some out; a guard finds the way from one to the next";
        entry.faults.push(Fault::new(entry.value_place.clone(), message).help(help));
        return None;
    }
    Some(DutyText::Patrol(characters, entry.value_place.clone()))
}

//! Things, as the legend defines them: items, sprites and guards.

use std::num::NonZeroU32;
use std::ops::Range;

use toml::de::DeTable;

use crate::fault::document::{Entry, FaultList};
use crate::fault::{Fault, nearest_or_all, quoted};
use crate::map::files::is_png;
use crate::map::picture::Picture;
use crate::map::surfaces::file_name;
use crate::map::textures::Textures;
use crate::map::values::{HEADING, LIGHT, Name, boolean, is_true, known, whole, whole_number};
use crate::world::sprite::builtin;
use crate::world::{
    Anchor, Difficulty, Duty, Facings, FrameTime, GuardKind, Heading, Lamp, Light, Reach, Rhythm,
    Sprite, SpriteHeight, Supply, ThingKind,
};

/// The largest number of frames of a sheet.
const MAX_FRAMES: u32 = 64;
/// The largest number of waypoints of a patrol.
const MAX_PATROL: usize = 64;
/// The longest note, in characters.
const MAX_NOTE: usize = 240;

/// The keys of items that refer to nothing else.
pub(crate) const ITEMS: &[&str] =
    &["exit", "treasure", "healing", "pebbles", "darts", "flasks", "checkpoint", "spikes"];

/// Reads the item in `entry` of `table`, whose key is one of [`ITEMS`].
pub(crate) fn item(entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Option<ThingKind> {
    let supply = |supply| whole(entry, 1..=9).map(|count| ThingKind::Supply(supply, count));
    match entry.key {
        "exit" => is_true(entry).then_some(ThingKind::Exit),
        "treasure" => whole(entry, 1..=1000).map(ThingKind::Treasure),
        "healing" => whole(entry, 1..=6).map(ThingKind::Healing),
        "pebbles" => supply(Supply::Pebbles),
        "darts" => supply(Supply::Darts),
        "flasks" => supply(Supply::Flasks),
        "checkpoint" => is_true(entry).then_some(ThingKind::Checkpoint),
        _ => rhythm(entry, table).map(ThingKind::Spikes),
    }
}

/// Reads the period of spikes in `entry`, and the delay in `table`.
fn rhythm(entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Option<Rhythm> {
    let seconds = entry.number().filter(|&seconds| Rhythm::new(seconds, 0.0).is_some());
    let Some(seconds) = seconds else {
        return entry.reject(
            "the period of spikes must be from 1 to 60 seconds",
            "this is not",
            "write 2.0 for spikes that come out every two seconds",
        );
    };
    let Some(delay) = entry.beside(table, "delay") else { return Rhythm::new(seconds, 0.0) };
    delay.number().and_then(|delay| Rhythm::new(seconds, delay)).or_else(|| {
        delay.reject(
            "the delay of spikes must be 0 seconds or more, and shorter than their period",
            format!("the period is {seconds} s"),
            "write 0.5 for spikes that come out half a second later than others",
        )
    })
}

/// Reads the text of a note.
pub(crate) fn note<'a>(entry: &Entry<'a, '_>) -> Option<&'a str> {
    let text = entry.string(r#"{ note = "The key is in the well." }"#)?;
    let length = text.chars().count();
    let message = if length > MAX_NOTE {
        format!("the note has {length} characters, but only {MAX_NOTE} fit in the panel")
    } else if text.trim().is_empty() {
        "the note is empty".to_owned()
    } else if text.contains(|it: char| it.is_control() && it != '\n') {
        "the note has a control character other than a line break".to_owned()
    } else {
        return Some(text);
    };
    entry.reject(message, "", "write a sentence or two; divide a longer text among several notes")
}

/// A sprite.
#[derive(Default)]
pub(crate) struct SpriteText<'a> {
    name: &'a str,
    place: Range<usize>,
    anchor: Option<Anchor>,
    blocks: Option<bool>,
    /// `true` if the player can put it out.
    pub(crate) is_doused: bool,
    height: Option<SpriteHeight>,
    heading: Option<Heading>,
    light: Option<Light>,
    reach: Option<Reach>,
    frame_time: Option<FrameTime>,
    /// The division of its sheet into frames and facings, with their places in the map.
    frames: Option<(u32, Range<usize>)>,
    facings: Option<(Facings, Range<usize>)>,
}

impl<'a> SpriteText<'a> {
    pub(crate) fn read(entry: &Entry<'a, '_>, table: &'a DeTable<'_>) -> Option<Self> {
        let name = entry.string(r#"{ sprite = "plant" }"#)?;
        let mut text = Self { name, place: entry.value_place.clone(), ..Self::default() };
        for entry in entry.entries(table) {
            text.take(&entry);
        }
        if is_png(name) {
            file_name(entry, name)?;
        } else if !builtin::NAMES.contains(&name) {
            let otherwise = "write the name of a PNG beside the map, or one of";
            let meant = "the nearest built-in sprite is";
            let help = nearest_or_all(name, builtin::NAMES, meant, otherwise);
            return entry.reject(format!("there is no sprite {}", quoted(name)), "", help);
        }
        Some(text)
    }

    fn take(&mut self, entry: &Entry<'_, '_>) {
        match entry.key {
            "anchor" => {
                let anchors = [("floor", Anchor::Floor), ("ceiling", Anchor::Ceiling)];
                let named = |(name, _): &(&str, Anchor)| entry.value.as_str() == Some(name);
                let anchor = anchors.into_iter().find(named).map(|(_, anchor)| anchor);
                self.anchor = known(entry, anchor, "\"floor\" or \"ceiling\"", "\"ceiling\"");
            }
            "blocks" => self.blocks = boolean(entry),
            "douse" => self.is_doused = boolean(entry).unwrap_or_default(),
            "height" => {
                let height = entry.number().and_then(SpriteHeight::new);
                self.height = known(entry, height, "a number above 0 and up to 4", "0.5");
            }
            "heading" => {
                let heading = entry.number().and_then(Heading::from_degrees);
                self.heading = known(entry, heading, "a finite number of degrees", "90");
            }
            "light" => self.light = LIGHT.read(entry),
            "reach" => {
                let reach = entry.number().and_then(Reach::new);
                self.reach = known(entry, reach, "a number of cells from 1 to 32", "5");
            }
            "frame_time" => {
                let time = entry.number().and_then(FrameTime::new);
                self.frame_time = known(entry, time, "a number of seconds from 0.05 to 60", "0.2");
            }
            "frames" => {
                let frames = whole_number(entry).filter(|count| (1..=MAX_FRAMES).contains(count));
                let frames = known(entry, frames, "a whole number from 1 to 64", "4");
                self.frames = frames.map(|frames| (frames, entry.value_place.clone()));
            }
            "facings" => {
                let facings =
                    known(entry, whole_number(entry).and_then(Facings::new), "1, 4 or 8", "4");
                self.facings = facings.map(|facings| (facings, entry.value_place.clone()));
            }
            _ => {}
        }
    }

    /// The sprite itself. Reports a fault if its sheet is missing or cannot be divided, once for
    /// all sprites that divide the sheet in the same way.
    pub(crate) fn sprite(&self, textures: &mut Textures<'_>) -> Option<Sprite> {
        let mut sprite = if let Some(sprite) = builtin::named(self.name) {
            textures.faults.extend(self.cut_of_built_in());
            sprite
        } else {
            let frames = self.frames.as_ref().map(|&(frames, _)| frames);
            let facings = self.facings.as_ref().map(|(facings, _)| facings.count());
            let key = (self.name.to_owned(), frames, facings);
            textures.sheet(key, &self.place, |sheet, faults| self.cut(sheet, faults))?
        };
        sprite.anchor = self.anchor.unwrap_or(sprite.anchor);
        sprite.blocks = self.blocks.unwrap_or(sprite.blocks);
        sprite.height = self.height.unwrap_or(sprite.height);
        sprite.heading = self.heading.unwrap_or(sprite.heading);
        let light = self.light.or(sprite.lamp.map(|lamp| lamp.light));
        let light = light.filter(|&light| light != Light::NONE);
        let reach = self.reach.unwrap_or_default();
        sprite.lamp = light.map(|light| Lamp { light, reach });
        Some(match self.frame_time {
            Some(frame_time) => sprite.with_frame_time(frame_time),
            None => sprite,
        })
    }

    /// The fault of frames or facings on a built-in sprite.
    fn cut_of_built_in(&self) -> Option<Fault> {
        let frames = self.frames.as_ref().map(|(_, place)| ("frames", place));
        let facings = self.facings.as_ref().map(|(_, place)| ("facings", place));
        let (key, place) = frames.or(facings)?;
        let message = format!("the built-in sprite {} has {key} of its own", quoted(self.name));
        Some(Fault::new(place.clone(), message).help(format!("leave {key} out")))
    }

    /// Divides `sheet`: frames from left to right, facings from top to bottom.
    fn cut(&self, sheet: &Picture, faults: &FaultList) -> Option<Sprite> {
        let (frames, place_of_frames) = self.frames.clone().unwrap_or((1, self.place.clone()));
        let (facings, place_of_facings) =
            self.facings.clone().unwrap_or((Facings::One, self.place.clone()));
        let name = quoted(self.name);
        let divided = |texels: u32, side: &str, count: u32, what: &str, place: Range<usize>| {
            let part = NonZeroU32::new(texels / count);
            part.filter(|part| part.get() * count == texels).or_else(|| {
                let message = format!(
                    "{name} is {texels} texels {side}, which does not divide into {count} {what}"
                );
                let help = format!("make it a multiple of {count} texels {side}");
                faults.push(Fault::new(place, message).help(help));
                None
            })
        };
        let width = divided(sheet.width(), "wide", frames, "frames", place_of_frames);
        let height = divided(sheet.height(), "high", facings.count(), "facings", place_of_facings);
        let (width, height) = (width?, height?);
        let pictures = (0..frames).flat_map(|frame| {
            (0..facings.count()).map(move |facing| {
                sheet.part(frame * width.get(), facing * height.get(), width, height)
            })
        });
        Sprite::new(pictures.collect(), facings)
    }
}

/// A guard.
pub(crate) struct GuardText<'a> {
    pub(crate) kind: GuardKind,
    pub(crate) heading: Heading,
    /// The duty of a guard who does not patrol.
    pub(crate) duty: Duty,
    /// The characters of the waypoints of a patrol.
    pub(crate) patrol: Option<Name<'a>>,
    pub(crate) from: Difficulty,
}

impl<'a> GuardText<'a> {
    pub(crate) fn read(entry: &Entry<'a, '_>, table: &'a DeTable<'_>) -> Option<Self> {
        let kind = guard_kind(entry);
        let (mut heading, mut from) = (Heading::default(), Difficulty::Easy);
        let (mut duty, mut waypoints) = (Duty::Stand, None);
        let mut duties = Vec::new();
        for entry in entry.entries(table) {
            match entry.key {
                "heading" => heading = HEADING.read(&entry).unwrap_or_default(),
                "difficulty" => from = difficulty(&entry).unwrap_or(from),
                "patrol" => waypoints = patrol(&entry),
                "wander" => duty = whole(&entry, 1..=64).map_or(duty, Duty::Wander),
                "asleep" => duty = if is_true(&entry) { Duty::Sleep } else { duty },
                _ => {}
            }
            if matches!(entry.key, "patrol" | "wander" | "asleep") {
                duties.push(entry.key_place);
            }
        }
        if let [_, second, ..] = &duties[..] {
            entry.faults.push(
                Fault::new(second.clone(), "a guard has one duty: patrol, wander or asleep")
                    .label("this is another")
                    .help("keep one of them, or none for a guard that stands still"),
            );
        }
        Some(Self { kind: kind?, heading, duty, patrol: waypoints, from })
    }
}

fn guard_kind(entry: &Entry<'_, '_>) -> Option<GuardKind> {
    let name = entry.string(r#"{ guard = "warden", heading = 90 }"#)?;
    let kind = GuardKind::ALL.into_iter().find(|kind| kind.name() == name);
    kind.or_else(|| {
        let names = GuardKind::ALL.map(GuardKind::name);
        let help = nearest_or_all(name, &names, "the nearest guard is", "write one of");
        entry.reject(format!("there is no guard {}", quoted(name)), "", help)
    })
}

fn difficulty(entry: &Entry<'_, '_>) -> Option<Difficulty> {
    let name = entry.string(r#"difficulty = "normal""#)?;
    Difficulty::named(name).or_else(|| {
        let names = Difficulty::ALL.map(Difficulty::name);
        let help = format!(
            "write one of {}: the guard appears at that difficulty and above",
            names.join(", ")
        );
        entry.reject(format!("there is no difficulty {}", quoted(name)), "", help)
    })
}

/// Reads the characters of a patrol's waypoints.
fn patrol<'a>(entry: &Entry<'a, '_>) -> Option<Name<'a>> {
    let text = entry.string(r#"patrol = "123""#)?;
    let count = text.chars().count();
    if text.is_empty() {
        let help = "write the characters of its waypoints, such as patrol = \"123\"";
        return entry.reject("the patrol names no waypoint", "", help);
    }
    if count > MAX_PATROL {
        let message =
            format!("the patrol has {count} waypoints, but at most {MAX_PATROL} are allowed");
        let help = "leave some out; a guard finds the way from one to the next";
        return entry.reject(message, "", help);
    }
    Some(Name { text, place: entry.value_place.clone() })
}

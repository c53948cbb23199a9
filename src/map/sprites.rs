//! Sprites, as the legend defines them.

use std::num::NonZeroU32;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::legend;
use super::picture::Picture;
use super::reader::Reader;
use super::textures::{is_png, stays_inside};
use crate::fault::document::Entry;
use crate::fault::{Fault, nearest, quoted};
use crate::world::sprite::builtin;
use crate::world::{Anchor, Facings, FrameTime, Heading, Lamp, Light, Reach, Sprite, SpriteHeight};

/// The keys that belong to a sprite.
pub(crate) const ADDITIONS: [(&str, &str); 10] = [
    ("anchor", "sprite"),
    ("blocks", "sprite"),
    ("douse", "sprite"),
    ("facings", "sprite"),
    ("frame_time", "sprite"),
    ("frames", "sprite"),
    ("heading", "sprite"),
    ("height", "sprite"),
    ("light", "sprite"),
    ("reach", "sprite"),
];

/// The largest number of frames of a sheet.
const MOST_FRAMES: f64 = 64.0;

/// A sprite as the legend defines it.
pub(crate) struct SpriteSymbol<'a> {
    name: &'a str,
    place: Range<usize>,
    anchor: Option<Anchor>,
    blocks: Option<bool>,
    /// Whether the player can put it out.
    pub(crate) is_doused: bool,
    height: Option<SpriteHeight>,
    heading: Option<Heading>,
    light: Option<Light>,
    reach: Option<Reach>,
    frame_time: Option<FrameTime>,
    frames: Option<(u32, Range<usize>)>,
    facings: Option<(Facings, Range<usize>)>,
}

impl<'a> SpriteSymbol<'a> {
    /// Reads the sprite in `entry` of `table`.
    pub(crate) fn read(entry: &Entry<'a, '_>, table: &'a DeTable<'_>) -> Option<Self> {
        let faults_before = entry.faults.len();
        let name = entry.string(r#"{ sprite = "plant" }"#)?;
        let place = entry.value_place.clone();
        entry.faults.extend(wrong_name(name, place.clone()));
        let mut symbol = Self {
            name,
            place,
            anchor: None,
            blocks: None,
            is_doused: false,
            height: None,
            heading: None,
            light: None,
            reach: None,
            frame_time: None,
            frames: None,
            facings: None,
        };
        for entry in entry.entries(table) {
            symbol.take(&entry);
        }
        (entry.faults.len() == faults_before).then_some(symbol)
    }

    fn take(&mut self, entry: &Entry<'a, '_>) {
        let place = || entry.value_place.clone();
        match entry.key {
            "anchor" => self.anchor = anchor(entry),
            "blocks" => self.blocks = boolean(entry),
            "douse" => self.is_doused = boolean(entry).unwrap_or_default(),
            "height" => {
                let height = entry.number().and_then(SpriteHeight::new);
                self.height = known(height, entry, "a number above 0 and up to 4", "0.5");
            }
            "heading" => {
                let heading = entry.number().and_then(Heading::from_degrees);
                self.heading = known(heading, entry, "a finite number of degrees", "90");
            }
            "light" => self.light = legend::light(entry),
            "reach" => {
                let reach = entry.number().and_then(Reach::new);
                self.reach = known(reach, entry, "a number of cells from 1 to 32", "5");
            }
            "frame_time" => {
                let time = entry.number().and_then(FrameTime::new);
                self.frame_time = known(time, entry, "a number of seconds from 0.05 to 60", "0.2");
            }
            "frames" => {
                let is_count =
                    |&number: &f64| number.fract() == 0.0 && (1.0..=MOST_FRAMES).contains(&number);
                let frames = entry.number().filter(is_count).map(|number| number as u32);
                let frames = known(frames, entry, "a whole number from 1 to 64", "4");
                self.frames = frames.map(|frames| (frames, place()));
            }
            "facings" => {
                let count = entry.number().filter(|number| number.fract() == 0.0);
                let facings = count.and_then(|count| Facings::new(count as u32));
                let facings = known(facings, entry, "1, 4 or 8", "4");
                self.facings = facings.map(|facings| (facings, place()));
            }
            _ => {}
        }
    }

    /// The sprite itself. Reports a fault where its sheet is missing or cannot be divided, once for
    /// all sprites that divide the sheet alike.
    pub(crate) fn sprite(&self, reader: &mut Reader<'_>) -> Option<Sprite> {
        let mut sprite = match builtin::named(self.name) {
            Some(sprite) => {
                reader.faults.extend(self.cut_of_built_in());
                sprite
            }
            None => self.of_sheet(reader)?,
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

    /// The fault that a built-in sprite is given frames or facings.
    fn cut_of_built_in(&self) -> Option<Fault> {
        let frames = self.frames.as_ref().map(|(_, place)| ("frames", place));
        let facings = self.facings.as_ref().map(|(_, place)| ("facings", place));
        let (key, place) = frames.or(facings)?;
        let message = format!("the built-in sprite {} has {key} of its own", quoted(self.name));
        Some(Fault::new(place.clone(), message).help(format!("leave {key} out")))
    }

    /// The sprite of the sheet as it is divided, which is decoded once for all sprites that divide
    /// it alike.
    fn of_sheet(&self, reader: &mut Reader<'_>) -> Option<Sprite> {
        let frames = self.frames.as_ref().map(|&(frames, _)| frames);
        let facings = self.facings.as_ref().map(|(facings, _)| facings.count());
        let key = (self.name.to_owned(), frames, facings);
        if let Some(known) = reader.sheets.get(&key) {
            return known.clone();
        }
        let sprite = self.sheet(reader).and_then(|sheet| self.cut(&sheet, reader));
        reader.sheets.insert(key, sprite.clone());
        sprite
    }

    fn sheet(&self, reader: &mut Reader<'_>) -> Option<Picture> {
        let sheet = reader.textures.picture(self.name);
        sheet
            .map_err(|error| {
                let Some(error) = error else { return };
                let message = format!("the sprite {} {error}", quoted(self.name));
                let help = error.help("a sprite is a PNG file beside the map");
                reader.faults.push(Fault::new(self.place.clone(), message).help(help));
            })
            .ok()
    }

    /// Divides `sheet`: frames from left to right, facings from top to bottom.
    fn cut(&self, sheet: &Picture, reader: &Reader<'_>) -> Option<Sprite> {
        let (frames, facings) = (self.frames.as_ref(), self.facings.as_ref());
        let facing_count = facings.map_or(1, |(facings, _)| facings.count());
        let frame_count = frames.map_or(1, |&(frames, _)| frames);
        let name = quoted(self.name);
        let divided = |texels: u32, side: &str, count: u32, what: &str, place: &Range<usize>| {
            let part = texels / count;
            match NonZeroU32::new(part).filter(|_| part * count == texels) {
                Some(part) => Ok(part),
                None => Err(Fault::new(
                    place.clone(),
                    format!(
                        "{name} is {texels} texels {side}, which does not divide into {count} {what}"
                    ),
                )
                .help(format!("make it a multiple of {count} texels {side}"))),
            }
        };
        let place_of_frames = frames.map_or(&self.place, |(_, place)| place);
        let place_of_facings = facings.map_or(&self.place, |(_, place)| place);
        let width = divided(sheet.width(), "wide", frame_count, "frames", place_of_frames);
        let height = divided(sheet.height(), "high", facing_count, "facings", place_of_facings);
        let (width, height) = match (width, height) {
            (Ok(width), Ok(height)) => (width, height),
            (width, height) => {
                reader.faults.extend(width.err().into_iter().chain(height.err()));
                return None;
            }
        };
        let pictures = (0..frame_count).flat_map(|frame| {
            (0..facing_count).map(move |facing| {
                sheet.part(frame * width.get(), facing * height.get(), width, height)
            })
        });
        Sprite::new(pictures.collect(), facings.map_or(Facings::One, |&(facings, _)| facings))
    }
}

/// The fault of a name that is no sprite. Does not check whether the file exists.
fn wrong_name(name: &str, place: Range<usize>) -> Option<Fault> {
    if builtin::NAMES.contains(&name) || is_png(name) && stays_inside(name) {
        return None;
    }
    if is_png(name) {
        let message = format!("{} is not a file in the map's folder", quoted(name));
        let help = "copy the picture beside the map, and separate folders by /";
        return Some(Fault::new(place, message).label("leads elsewhere").help(help));
    }
    let fault = Fault::new(place, format!("there is no sprite {}", quoted(name)));
    Some(match nearest(name, builtin::NAMES) {
        Some(known) => fault.help(format!("the nearest built-in sprite is {}", quoted(known))),
        None => fault.help(format!(
            "write the name of a PNG beside the map, or one of {}",
            builtin::NAMES.join(", ")
        )),
    })
}

fn anchor(entry: &Entry<'_, '_>) -> Option<Anchor> {
    let anchor = match entry.value {
        DeValue::String(text) if text == "floor" => Some(Anchor::Floor),
        DeValue::String(text) if text == "ceiling" => Some(Anchor::Ceiling),
        _ => None,
    };
    known(anchor, entry, "\"floor\" or \"ceiling\"", "\"ceiling\"")
}

fn boolean(entry: &Entry<'_, '_>) -> Option<bool> {
    let value = match entry.value {
        DeValue::Boolean(value) => Some(*value),
        _ => None,
    };
    known(value, entry, "true or false", "true")
}

/// `value`; if there is none, adds the fault that `entry` is not what is `wanted`.
fn known<T>(value: Option<T>, entry: &Entry<'_, '_>, wanted: &str, example: &str) -> Option<T> {
    if value.is_none() {
        let message = format!("{} must be {wanted}", quoted(entry.key));
        entry.faults.push(
            Fault::new(entry.value_place.clone(), message)
                .label("this is not")
                .help(format!("write, for example, {} = {example}", entry.key)),
        );
    }
    value
}

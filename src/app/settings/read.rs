//! Parsing: from a file to a configuration.

use std::num::NonZeroU32;

use toml::de::{DeTable, DeValue};

use super::value::{self, DEPTHS, DISPLAYS, GLYPH_SETS, Names, SETTINGS};
use super::{Configuration, keys};
use crate::app::bindings::PRESETS;
use crate::color::palette::ColorDepth;
use crate::fault::document::{self, Entry, FaultList};
use crate::fault::{Fault, Faults, nearest, quoted};
use crate::terminal::Fidelity;
use crate::world::FieldOfView;

impl Configuration {
    /// Parses a configuration file, which faults refer to as `name`.
    ///
    /// # Errors
    /// All faults of the file.
    pub fn parse(text: &str, name: &str) -> Result<Self, Faults> {
        let faults = FaultList::default();
        let document = document::parse(text, &faults);
        let mut configuration = Self::default();
        if faults.is_empty() {
            configuration.read(&document, &faults);
        }
        if faults.is_empty() {
            Ok(configuration)
        } else {
            Err(Faults::new(name, text, faults.take()))
        }
    }

    fn read(&mut self, document: &DeTable, faults: &FaultList) {
        let mut bound = keys::Bound::default();
        let mut preset = PRESETS[0].1;
        for entry in document::entries(document, faults) {
            match entry.key {
                "preset" => {
                    let presets = PRESETS.map(|(name, make)| (name, (name, make)));
                    if let Some((name, make)) = named(&entry, &presets) {
                        (self.preset, preset) = (name, make);
                    }
                }
                "colors" => read_colors(&entry, &mut self.colors),
                "glyphs" => set(&mut self.glyphs, named(&entry, &GLYPH_SETS)),
                "fov" => set(&mut self.field_of_view, field_of_view(&entry)),
                "fps" => set(&mut self.frames_per_second, frames_per_second(&entry)),
                "mouse" => set(&mut self.mouse, boolean(&entry)),
                "minimap" => set(&mut self.minimap, named(&entry, &DISPLAYS)),
                "fidelity" => read_fidelity(&entry, &mut self.fidelity),
                "keys" => {
                    if let Some(table) = entry.table("[keys]") {
                        bound = keys::read(&entry, table);
                    }
                }
                _ => {
                    let names = SETTINGS.map(|setting| setting.name);
                    let known: Vec<&str> = names.into_iter().chain(["keys"]).collect();
                    entry.faults.push(entry.unknown_key("the configuration", &known));
                }
            }
        }
        self.bindings = preset().rebound(&bound.actions, bound.keys);
    }
}

fn set<T>(setting: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *setting = value;
    }
}

/// The value with the entry's string as its name.
fn named<T: Copy, const N: usize>(entry: &Entry<'_, '_>, names: &Names<T, N>) -> Option<T> {
    let name = entry.string(&format!("{} = \"{}\"", entry.key, names[0].0))?;
    let value = names.iter().find(|&&(known, _)| known == name).map(|&(_, value)| value);
    if value.is_none() {
        let known = names.map(|(known, _)| known);
        let help = match nearest(name, &known) {
            Some(meant) => format!("the nearest is {}", quoted(meant)),
            None => format!("write one of {}", known.map(quoted).join(", ")),
        };
        let message = format!("{} is no value of {}", quoted(name), quoted(entry.key));
        entry.faults.push(Fault::new(entry.value_place.clone(), message).help(help));
    }
    value
}

/// Reads a colour depth by its name. 256 and 16 may be written without quotes.
fn read_colors(entry: &Entry<'_, '_>, colors: &mut Option<ColorDepth>) {
    let number = entry.number().map(|number| number.to_string());
    match DEPTHS.iter().find(|&&(known, _)| Some(known) == number.as_deref()) {
        Some(&(_, depth)) => *colors = depth,
        None => set(colors, named(entry, &DEPTHS)),
    }
}

fn field_of_view(entry: &Entry<'_, '_>) -> Option<FieldOfView> {
    let Some(degrees) = entry.number() else {
        entry.faults.push(entry.wrong_type("a number of degrees", "fov = 66"));
        return None;
    };
    let view = FieldOfView::from_degrees(degrees);
    if view.is_none() {
        entry.faults.push(out_of_range(entry, "degrees above 0 and below 180", "fov = 66"));
    }
    view
}

fn frames_per_second(entry: &Entry<'_, '_>) -> Option<NonZeroU32> {
    let DeValue::Integer(_) = entry.value else {
        entry.faults.push(entry.wrong_type("a whole number", "fps = 30"));
        return None;
    };
    let number = entry.number().filter(|number| (1.0..=240.0).contains(number));
    let frames = number.and_then(|number| NonZeroU32::new(number as u32));
    if frames.is_none() {
        entry.faults.push(out_of_range(entry, "a whole number from 1 to 240", "fps = 30"));
    }
    frames
}

fn boolean(entry: &Entry<'_, '_>) -> Option<bool> {
    let DeValue::Boolean(boolean) = entry.value else {
        entry.faults.push(entry.wrong_type("true or false", &format!("{} = true", entry.key)));
        return None;
    };
    Some(*boolean)
}

/// Reads a fidelity by its name or number.
fn read_fidelity(entry: &Entry<'_, '_>, fidelity: &mut Option<Fidelity>) {
    let example = format!("fidelity = \"{}\"", value::FIDELITY.default);
    let text = match entry.number() {
        Some(number) => number.to_string(),
        None => match entry.string(&example) {
            Some(text) => text.to_owned(),
            None => return,
        },
    };
    if text == value::FIDELITY.default {
        *fidelity = None;
    } else if let Ok(read) = text.parse() {
        *fidelity = Some(read);
    } else {
        let values = "\"auto\", \"exact\", \"high\", \"low\" or a whole number from 0 to 255";
        entry.faults.push(out_of_range(entry, values, &example));
    }
}

fn out_of_range(entry: &Entry<'_, '_>, wanted: &str, example: &str) -> Fault {
    let message = format!("{} must be {wanted}", quoted(entry.key));
    Fault::new(entry.value_place.clone(), message).help(format!("write {example}"))
}

//! Items: things of the game that have a built-in sprite, as the legend defines them.

use std::ops::RangeInclusive;

use toml::de::DeTable;

use super::mechanisms::is_true;
use super::switches::SwitchSymbol;
use crate::fault::document::Entry;
use crate::fault::{Fault, quoted};
use crate::world::{Rhythm, Supply};

/// The longest note, in characters.
const LONGEST_NOTE: usize = 240;
const TREASURE: RangeInclusive<u16> = 1..=1000;
const HEALING: RangeInclusive<u8> = 1..=6;
const SUPPLIES: RangeInclusive<u8> = 1..=9;

/// The keys that make an item.
pub(crate) const KEYS: &[&str] =
    &["treasure", "healing", "pebbles", "darts", "flasks", "note", "checkpoint", "lever", "spikes"];

/// An item as the legend defines it.
pub(crate) enum ItemSymbol<'a> {
    Treasure(u16),
    Healing(u8),
    Supply(Supply, u8),
    Note(&'a str),
    Checkpoint,
    Lever(SwitchSymbol<'a>),
    Spikes(Rhythm),
}

impl<'a> ItemSymbol<'a> {
    /// Reads the item in `entry` of `table`; reports a fault where there is none.
    pub(crate) fn read(entry: &Entry<'a, '_>, table: &DeTable<'_>) -> Option<Self> {
        match entry.key {
            "treasure" => whole(entry, TREASURE).map(Self::Treasure),
            "healing" => whole(entry, HEALING).map(Self::Healing),
            "pebbles" => supply(entry, Supply::Pebbles),
            "darts" => supply(entry, Supply::Darts),
            "flasks" => supply(entry, Supply::Flasks),
            "note" => note(entry).map(Self::Note),
            "checkpoint" => is_true(entry).then_some(Self::Checkpoint),
            "lever" => SwitchSymbol::read(entry, r#"{ lever = "gate" }"#).map(Self::Lever),
            _ => rhythm(entry, table).map(Self::Spikes),
        }
    }

    /// The name of its built-in sprite.
    pub(crate) fn sprite_name(&self) -> &'static str {
        match self {
            Self::Treasure(..25) => "coins",
            Self::Treasure(25..100) => "cup",
            Self::Treasure(100..) => "crown",
            Self::Healing(_) => "heart",
            Self::Supply(supply, _) => supply.name(),
            Self::Note(_) => "note",
            Self::Checkpoint => "checkpoint",
            Self::Lever(_) => "lever",
            Self::Spikes(_) => "spikes",
        }
    }
}

/// Reads a whole number in `range`; reports a fault where there is none.
pub(crate) fn whole<T>(entry: &Entry<'_, '_>, range: RangeInclusive<T>) -> Option<T>
where
    T: Copy + TryFrom<u32> + PartialOrd + std::fmt::Display,
    u32: From<T>,
{
    let is_whole = |number: &f64| number.fract() == 0.0 && (0.0..=1e9).contains(number);
    let number = entry.number().filter(is_whole).map(|number| number as u32);
    let number = number.and_then(|number| T::try_from(number).ok());
    let number = number.filter(|number| range.contains(number));
    if number.is_none() {
        let (least, most) = range.into_inner();
        let message =
            format!("{} must be a whole number from {least} to {most}", quoted(entry.key));
        entry.faults.push(
            Fault::new(entry.value_place.clone(), message)
                .label("this is not")
                .help(format!("write, for example, {} = {least}", entry.key)),
        );
    }
    number
}

fn supply<'a>(entry: &Entry<'_, '_>, supply: Supply) -> Option<ItemSymbol<'a>> {
    whole(entry, SUPPLIES).map(|count| ItemSymbol::Supply(supply, count))
}

/// Reads the text of a note.
fn note<'a>(entry: &Entry<'a, '_>) -> Option<&'a str> {
    let text = entry.string(r#"{ note = "The key is in the well." }"#)?;
    let length = text.chars().count();
    let message = if length > LONGEST_NOTE {
        format!("the note has {length} characters, and {LONGEST_NOTE} fit the panel")
    } else if text.trim().is_empty() {
        "the note is empty".to_owned()
    } else if text.contains(|it: char| it.is_control() && it != '\n') {
        "the note has a control character other than a line break".to_owned()
    } else {
        return Some(text);
    };
    let help = "write a sentence or two; divide a longer text among several notes";
    entry.faults.push(Fault::new(entry.value_place.clone(), message).help(help));
    None
}

/// Reads the period of spikes in `entry`, and the delay in `table`.
fn rhythm(entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Option<Rhythm> {
    let delay = entry.entries(table).find(|entry| entry.key == "delay");
    let period = entry.number().and_then(|seconds| Rhythm::new(seconds, 0.0));
    if period.is_none() {
        entry.faults.push(
            Fault::new(entry.value_place.clone(), "the period of spikes is from 1 to 60 seconds")
                .label("this is not")
                .help("write 2.0 for spikes that come out every two seconds"),
        );
    }
    let Some(delay) = delay else { return period };
    let seconds = entry.number()?;
    period?;
    let rhythm = delay.number().and_then(|delay| Rhythm::new(seconds, delay));
    if rhythm.is_none() {
        let message = "the delay of spikes is a number of seconds from 0, below their period";
        entry.faults.push(
            Fault::new(delay.value_place, message)
                .label(format!("the period is {seconds} s"))
                .help("write 0.5 for spikes that come out half a second later than others"),
        );
    }
    rhythm
}

//! Values of single entries: the accepted values, and the reports on all others.

use std::ops::{Range, RangeInclusive};

use toml::de::DeValue;

use crate::color::Rgb;
use crate::fault::document::Entry;
use crate::fault::quoted;
use crate::world::{Heading, Heights, Light, PillarRadius, Scale, ShapeHeight};

/// A kind of number: its type with its range, and the report on another value.
pub(crate) struct Quantity<T> {
    /// The value for a number; `None` if the number is out of range.
    pub(crate) of: fn(f64) -> Option<T>,
    pub(crate) wanted: &'static str,
    pub(crate) label: &'static str,
    pub(crate) help: &'static str,
}

pub(crate) const HEADING: Quantity<Heading> = Quantity {
    of: Heading::from_degrees,
    wanted: "a heading must be a finite number of degrees",
    label: "this is not",
    help: "write 0 for east, 90 for south, 180 for west, 270 for north",
};
pub(crate) const LIGHT: Quantity<Light> = Quantity {
    of: Light::new,
    wanted: "a light must be a number from 0 to 1",
    label: "this is not",
    help: "write 0 for darkness, 1 for full brightness",
};
pub(crate) const OPACITY: Quantity<f64> = Quantity {
    of: |opacity| (0.0..=1.0).contains(&opacity).then_some(opacity),
    wanted: "an opacity must be a number from 0 to 1",
    label: "this is not",
    help: "write 0 for clear glass, 1 for glass that hides what is behind it",
};
pub(crate) const SCALE: Quantity<Scale> = Quantity {
    of: Scale::new,
    wanted: "a scale must be a finite number of cells above 0",
    label: "this is not",
    help: "write 2.0 to stretch a texture over two cells",
};
pub(crate) const HEIGHT: Quantity<f64> = Quantity {
    of: |height| (height.abs() <= Heights::MAX).then_some(height),
    wanted: "a height must be a number of cells from -1000000000 to 1000000000",
    label: "this is not",
    help: "write 0.25 for a quarter of a cell above the map's floor",
};
pub(crate) const SHAPE_HEIGHT: Quantity<ShapeHeight> = Quantity {
    of: ShapeHeight::new,
    wanted: "the height of a shape must be above 0 and at most 1000000000 cells",
    label: "this is not",
    help: "",
};
pub(crate) const PILLAR_RADIUS: Quantity<PillarRadius> = Quantity {
    of: PillarRadius::new,
    wanted: "the radius of a pillar must be above 0 and at most 0.5, half a cell",
    label: "this is not",
    help: "",
};

impl<T> Quantity<T> {
    /// Reads the number in `entry`.
    pub(crate) fn read(&self, entry: &Entry<'_, '_>) -> Option<T> {
        let value = entry.number().and_then(self.of);
        value.or_else(|| entry.reject(self.wanted, self.label, self.help))
    }
}

/// A name that connects definitions, such as a key's, and its place in the map.
#[derive(Clone)]
pub(crate) struct Name<'a> {
    pub(crate) text: &'a str,
    pub(crate) place: Range<usize>,
}

impl<'a> Name<'a> {
    /// Reads the name of an `owner`, such as a key, in `entry`. `example` is a whole entry.
    pub(crate) fn read(entry: &Entry<'a, '_>, owner: &str, example: &str) -> Option<Self> {
        let text = entry.string(example)?;
        if text.is_empty() || text.contains(char::is_control) {
            let message = format!("a {owner}'s name must be one line with at least one character");
            return entry.reject(message, "", format!("write {example}"));
        }
        Some(Self { text, place: entry.value_place.clone() })
    }
}

/// Returns `value`. If there is none, reports that `entry` must be `wanted`.
pub(crate) fn known<T>(
    entry: &Entry<'_, '_>,
    value: Option<T>,
    wanted: &str,
    example: impl std::fmt::Display,
) -> Option<T> {
    value.or_else(|| {
        let message = format!("{} must be {wanted}", quoted(entry.key));
        entry.reject(
            message,
            "this is not",
            format!("write, for example, {} = {example}", entry.key),
        )
    })
}

/// The number in `entry`, if it is a whole number from 0 to 10⁹.
pub(crate) fn whole_number(entry: &Entry<'_, '_>) -> Option<u32> {
    let is_whole = |number: &f64| number.fract() == 0.0 && (0.0..=1e9).contains(number);
    entry.number().filter(is_whole).map(|number| number as u32)
}

/// Reads a whole number in `range`.
pub(crate) fn whole<T>(entry: &Entry<'_, '_>, range: RangeInclusive<T>) -> Option<T>
where
    T: Copy + TryFrom<u32> + PartialOrd + std::fmt::Display,
{
    let number = whole_number(entry).and_then(|number| T::try_from(number).ok());
    let (least, most) = (range.start(), range.end());
    let wanted = format!("a whole number from {least} to {most}");
    known(entry, number.filter(|number| range.contains(number)), &wanted, least)
}

/// Reads `true` or `false`.
pub(crate) fn boolean(entry: &Entry<'_, '_>) -> Option<bool> {
    known(entry, entry.value.as_bool(), "true or false", true)
}

/// Reads a key whose only value is `true`. Reports any other value, and returns whether it is
/// `true`.
pub(crate) fn is_true(entry: &Entry<'_, '_>) -> bool {
    let key = entry.key;
    let help = match key {
        "exit" => "write { exit = true }".to_owned(),
        _ => format!("write {key} = true, or leave it out"),
    };
    let is_true = matches!(entry.value, DeValue::Boolean(true));
    is_true || entry.reject(format!("\"{key}\" must be true"), "", help).unwrap_or_default()
}

/// Reads a colour for `purpose`, which may be empty. `example` is a whole entry.
pub(crate) fn color(entry: &Entry<'_, '_>, purpose: &str, example: &str) -> Option<Rgb> {
    let text = entry.string(example)?;
    match text.parse() {
        Ok(color) => Some(color),
        Err(error) => {
            let message = format!("{} is not a colour{purpose}", quoted(text));
            entry.reject(message, "", format!("{error}"))
        }
    }
}

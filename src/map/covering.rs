//! Floors and ceilings: one surface by its name, or a table with a pattern and a scale.

use toml::de::{DeTable, DeValue};

use super::reader::Reader;
use super::textures::Surface;
use crate::color::Rgb;
use crate::fault::Fault;
use crate::fault::document::Entry;
use crate::world::{Ceiling, Covering, Pattern, Scale};

const KEYS: &[&str] = &["texture", "checker", "stripes", "scale"];
const EXAMPLE: &str = r#"{ texture = "tile" }"#;

/// A floor or a ceiling as the map writes it.
pub(crate) struct CoveringText<'a> {
    pattern: PatternText<'a>,
    scale: Scale,
}

enum PatternText<'a> {
    Plain(Surface<'a>),
    Checker([Surface<'a>; 2]),
    Stripes([Surface<'a>; 2]),
}

impl<'a> CoveringText<'a> {
    /// One colour, for maps that do not name any.
    pub(crate) fn plain(color: Rgb) -> Self {
        Self { pattern: PatternText::Plain(Surface::plain(color)), scale: Scale::ONE }
    }

    /// One built-in texture.
    pub(crate) fn built_in(name: &'static str) -> Self {
        Self { pattern: PatternText::Plain(Surface::built_in(name)), scale: Scale::ONE }
    }

    /// Reads the covering in `entry`; reports a fault where there is none. `example` is a whole
    /// entry.
    pub(crate) fn read(entry: &Entry<'a, '_>, example: &str) -> Option<Self> {
        match entry.value {
            DeValue::String(_) => {
                let surface = Surface::read(entry, example)?;
                Some(Self { pattern: PatternText::Plain(surface), scale: Scale::ONE })
            }
            DeValue::Table(table) => Self::read_table(entry, table),
            _ => {
                entry.faults.push(entry.wrong_type("a string or a table", example));
                None
            }
        }
    }

    fn read_table(owner: &Entry<'a, '_>, table: &'a DeTable<'_>) -> Option<Self> {
        let faults_before = owner.faults.len();
        let mut patterns = Vec::new();
        let mut scale = Scale::ONE;
        for entry in owner.entries(table) {
            match entry.key {
                "scale" => scale = read_scale(&entry).unwrap_or(scale),
                "texture" | "checker" | "stripes" => {
                    patterns.extend(PatternText::read(&entry));
                }
                _ => entry.faults.push(entry.unknown_key(&format!("a {}", owner.key), KEYS)),
            }
        }
        if owner.faults.len() > faults_before {
            return None;
        }
        match (patterns.pop(), patterns.is_empty()) {
            (Some(pattern), true) => Some(Self { pattern, scale }),
            (found, _) => {
                let fault = |message: String| Fault::new(owner.value_place.clone(), message);
                owner.faults.push(if found.is_none() {
                    fault(format!("the {} does not say what it is laid with", owner.key))
                        .help(format!("write {} = {EXAMPLE}", owner.key))
                } else {
                    fault(format!("the {} is laid with several patterns at once", owner.key))
                        .help("keep one of texture, checker and stripes")
                });
                None
            }
        }
    }

    /// The covering itself. Reports a fault where a texture is missing.
    pub(crate) fn covering(&self, reader: &mut Reader<'_>) -> Option<Covering> {
        let mut both = |[first, second]: &[Surface<'_>; 2]| {
            let paints = [reader.paint(first), reader.paint(second)];
            Some([paints[0]?, paints[1]?])
        };
        let pattern = match &self.pattern {
            PatternText::Checker(surfaces) => Pattern::Checker(both(surfaces)?),
            PatternText::Stripes(surfaces) => Pattern::Stripes(both(surfaces)?),
            PatternText::Plain(surface) => Pattern::Plain(reader.paint(surface)?),
        };
        Some(Covering { pattern, scale: self.scale })
    }
}

impl<'a> PatternText<'a> {
    /// Reads the pattern in `entry`, one of a covering's table.
    fn read(entry: &Entry<'a, '_>) -> Option<Self> {
        if entry.key == "texture" {
            return Surface::read(entry, r#"texture = "tile""#).map(Self::Plain);
        }
        let example = format!(r#"{} = ["tile", "marble"]"#, entry.key);
        let pair = entry.pair(&example)?;
        let [first, second] = pair.map(|entry| Surface::read(&entry, &example));
        let surfaces = [first?, second?];
        Some(match entry.key {
            "checker" => Self::Checker(surfaces),
            _ => Self::Stripes(surfaces),
        })
    }
}

fn read_scale(entry: &Entry<'_, '_>) -> Option<Scale> {
    let scale = entry.number().and_then(Scale::new);
    if scale.is_none() {
        let message = "a scale must be a finite number of cells above 0";
        entry.faults.push(
            Fault::new(entry.value_place.clone(), message)
                .label("this is none")
                .help("write 2.0 to stretch a texture over two cells"),
        );
    }
    scale
}

/// A ceiling as the map writes it.
pub(crate) enum CeilingText<'a> {
    Sky,
    Covered(CoveringText<'a>),
}

impl<'a> CeilingText<'a> {
    /// One colour, for maps that do not name any.
    pub(crate) fn plain(color: Rgb) -> Self {
        Self::Covered(CoveringText::plain(color))
    }

    /// Reads the ceiling in `entry` as [`CoveringText::read`] does; `"sky"` is no ceiling.
    pub(crate) fn read(entry: &Entry<'a, '_>, example: &str) -> Option<Self> {
        match entry.value {
            DeValue::String(text) if text == "sky" => Some(Self::Sky),
            _ => CoveringText::read(entry, example).map(Self::Covered),
        }
    }

    /// The ceiling itself, as [`CoveringText::covering`].
    pub(crate) fn ceiling(&self, reader: &mut Reader<'_>) -> Option<Ceiling> {
        match self {
            Self::Sky => Some(Ceiling::Sky),
            Self::Covered(covering) => covering.covering(reader).map(Ceiling::Covered),
        }
    }
}

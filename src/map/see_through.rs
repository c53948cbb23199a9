//! Masks, glass and mirrors, as the legend defines them.

use toml::de::{DeTable, DeValue};

use super::reader::Reader;
use super::textures::Surface;
use crate::color::Rgb;
use crate::fault::document::Entry;
use crate::fault::{Fault, quoted};
use crate::world::{Glass, Paint, TextureId};

const GLASS_EXAMPLE: &str = r##"{ glass = "#80c0ff", opacity = 0.3 }"##;
const GLASS_OPACITY: f64 = 0.3;
const MIRROR_EXAMPLE: &str = "{ mirror = true }";
const MIRROR_OPACITY: f64 = 0.1;
const SILVER: Rgb = Rgb::new(0xb8, 0xc8, 0xd0);

/// A wall with holes as the legend defines it.
pub(crate) struct MaskSymbol<'a>(Surface<'a>);

impl<'a> MaskSymbol<'a> {
    pub(crate) fn read(entry: &Entry<'a, '_>) -> Option<Self> {
        Surface::read(entry, r#"{ mask = "grate" }"#).map(Self)
    }

    /// The texture with holes. A texture without holes is a fault, since the author would not know
    /// why it cannot be seen through.
    pub(crate) fn texture(&self, reader: &mut Reader<'_>) -> Option<TextureId> {
        let Self(surface) = self;
        let paint = reader.paint(surface)?;
        match paint {
            Paint::Texture(id) if reader.textures.get(id).has_alpha() => return Some(id),
            _ => reader.faults.push(
                Fault::new(surface.place(), "a mask needs a texture with holes, and this has none")
                    .help("write { mask = \"grate\" }, or { wall = … } for a wall without holes"),
            ),
        }
        None
    }
}

/// Reads the glass in `entry` of `table`, with the opacity in the table.
pub(crate) fn glass(entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Option<Glass> {
    let color = color(entry, GLASS_EXAMPLE);
    tinted(entry, table, color, GLASS_OPACITY)
}

/// Reads the tint of the mirror in `entry` of `table`, with the opacity in the table.
pub(crate) fn mirror(entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Option<Glass> {
    let color = match entry.value {
        DeValue::Boolean(true) => Some(SILVER),
        _ => color(entry, MIRROR_EXAMPLE),
    };
    tinted(entry, table, color, MIRROR_OPACITY)
}

/// Glass of that color, with the opacity in the table or else `usual_opacity`.
fn tinted(
    entry: &Entry<'_, '_>,
    table: &DeTable<'_>,
    color: Option<Rgb>,
    usual_opacity: f64,
) -> Option<Glass> {
    let opacity = entry.entries(table).find(|entry| entry.key == "opacity");
    let opacity = match opacity {
        None => usual_opacity,
        Some(entry) => opacity_of(&entry)?,
    };
    Some(Glass { color: color?, opacity: (opacity * 255.0).round() as u8 })
}

fn color(entry: &Entry<'_, '_>, example: &str) -> Option<Rgb> {
    let text = entry.string(example)?;
    let color = text.parse();
    color
        .map_err(|error| {
            let message = format!("{} is not a colour for a tint", quoted(text));
            entry
                .faults
                .push(Fault::new(entry.value_place.clone(), message).help(format!("{error}")));
        })
        .ok()
}

fn opacity_of(entry: &Entry<'_, '_>) -> Option<f64> {
    let opacity = match entry.value {
        DeValue::Integer(integer) => match integer.as_str() {
            "0" => 0.0,
            "1" => 1.0,
            _ => f64::NAN,
        },
        DeValue::Float(float) => float.as_str().parse().unwrap_or(f64::NAN),
        _ => f64::NAN,
    };
    if (0.0..=1.0).contains(&opacity) {
        return Some(opacity);
    }
    entry.faults.push(
        Fault::new(entry.value_place.clone(), "an opacity must be a number from 0 to 1")
            .label("this is none")
            .help("write 0 for clear glass, 1 for glass that hides what is behind it"),
    );
    None
}

//! Walls to see through: what the legend says of them.

use toml::de::{DeTable, DeValue};

use super::textures::{Surface, Textures};
use crate::fault::Fault;
use crate::fault::document::{Entry, entries};
use crate::world::{Glass, Paint, Rgb, TextureId};

const GLASS_EXAMPLE: &str = r##"{ glass = "#80c0ff", opacity = 0.3 }"##;
const DEFAULT_OPACITY: f64 = 0.3;

/// A wall with holes, as the legend has it.
pub(super) struct MaskSymbol<'a>(Surface<'a>);

impl<'a> MaskSymbol<'a> {
    pub(super) fn read(entry: &Entry<'a, '_>, faults: &mut Vec<Fault>) -> Option<Self> {
        Surface::read(entry, r#"{ mask = "grate" }"#, faults).map(Self)
    }

    /// The texture with the holes. What has none is a wall, and calling it a mask a fault: nobody
    /// would know why they can't see through it.
    pub(super) fn texture(
        &self,
        textures: &mut Textures<'_>,
        faults: &mut Vec<Fault>,
    ) -> Option<TextureId> {
        let Self(surface) = self;
        let paint = textures.paint(surface, faults)?;
        match paint {
            Paint::Texture(id) if textures.get(id).has_alpha() => return Some(id),
            _ => faults.push(
                Fault::new(surface.place(), "a mask needs a texture with holes, and this has none")
                    .help("write { mask = \"grate\" }, or { wall = … } for a wall without holes"),
            ),
        }
        None
    }
}

/// The glass that `entry` of `table` describes, with the opacity that the table gives.
pub(super) fn glass(
    entry: &Entry<'_, '_>,
    table: &DeTable<'_>,
    faults: &mut Vec<Fault>,
) -> Option<Glass> {
    let color = color(entry, faults);
    let opacity = entries(table).find(|entry| entry.key == "opacity");
    let opacity = match opacity {
        None => DEFAULT_OPACITY,
        Some(entry) => opacity_of(&entry, faults)?,
    };
    Some(Glass { color: color?, opacity: (opacity * 255.0).round() as u8 })
}

fn color(entry: &Entry<'_, '_>, faults: &mut Vec<Fault>) -> Option<Rgb> {
    let text = entry.string(GLASS_EXAMPLE, faults)?;
    let color = text.parse();
    color
        .map_err(|error| {
            let message = "glass has a colour for a tint";
            faults.push(Fault::new(entry.value_place.clone(), message).help(format!("{error}")));
        })
        .ok()
}

fn opacity_of(entry: &Entry<'_, '_>, faults: &mut Vec<Fault>) -> Option<f64> {
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
    faults.push(
        Fault::new(entry.value_place.clone(), "an opacity must be a number from 0 to 1")
            .label("this is none")
            .help("write 0 for clear glass, 1 for glass that hides what is behind it"),
    );
    None
}

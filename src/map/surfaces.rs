//! Surfaces as the map writes them: walls, floors, ceilings, the sky, and fog in front of them.

use toml::de::{DeTable, DeValue};

use super::files::{is_png, stays_inside};
use super::textures::{PaintText, SurfaceText, Textures};
use super::values::{SCALE, color};
use crate::color::Rgb;
use crate::fault::document::Entry;
use crate::fault::{nearest_or_all, quoted};
use crate::world::texture::builtin;
use crate::world::{Ceiling, Covering, Fog, Paint, Pattern, Scale, Sky, SkyGradient};

const SKY_EXAMPLE: &str = r##"sky = { gradient = ["#5080c0", "#c0d8f0"] }"##;
const FOG_EXAMPLE: &str = r##"fog = { color = "#101018", distance = 12.0 }"##;

impl<'a> SurfaceText<'a> {
    /// A surface of one colour, for maps that name no surface.
    pub(crate) fn plain(color: Rgb) -> Self {
        Self { source: PaintText::Color(color), place: 0..0 }
    }

    /// The built-in texture with this name.
    pub(crate) fn built_in(name: &'static str) -> Self {
        Self { source: PaintText::Texture(name), place: 0..0 }
    }

    /// Reads the surface in `entry`: a colour, a built-in texture or a PNG file. Does not check whether
    /// the file exists. `example` is a whole entry.
    pub(crate) fn read(entry: &Entry<'a, '_>, example: &str) -> Option<Self> {
        let text = entry.string(example)?;
        let source = match text.parse() {
            Ok(color) => PaintText::Color(color),
            Err(_) if text.starts_with('#') => PaintText::Color(color(entry, "", example)?),
            Err(_) if builtin::NAMES.contains(&text) => PaintText::Texture(text),
            Err(_) if is_png(text) => PaintText::Texture(file_name(entry, text)?),
            Err(_) => {
                let otherwise = "write a colour such as \"#a04030\", the name of a PNG beside the map, or one of";
                let meant = "the nearest built-in texture is";
                let help = nearest_or_all(text, builtin::NAMES, meant, otherwise);
                return entry.reject(format!("there is no texture {}", quoted(text)), "", help);
            }
        };
        Some(Self { source, place: entry.value_place.clone() })
    }

    /// Reads the panorama in `entry` as [`SurfaceText::read`] does.
    fn read_panorama(entry: &Entry<'a, '_>) -> Option<Self> {
        let example = r#"panorama = "hills""#;
        let text = entry.string(example)?;
        if is_png(text) {
            return Self::read(entry, example);
        }
        if !builtin::PANORAMAS.contains(&text) {
            let known = builtin::PANORAMAS.join(", ");
            let help = format!("write the name of a PNG beside the map, or one of {known}");
            return entry.reject(format!("there is no panorama {}", quoted(text)), "", help);
        }
        Some(Self { source: PaintText::Texture(text), place: entry.value_place.clone() })
    }
}

/// Returns `name`, a file name in `entry`. Reports a fault if it leads out of the map's folder.
pub(crate) fn file_name<'a>(entry: &Entry<'_, '_>, name: &'a str) -> Option<&'a str> {
    stays_inside(name).then_some(name).or_else(|| {
        let message = format!("{} is not a file in the map's folder", quoted(name));
        let help = "copy the picture beside the map, and separate folders with /";
        entry.reject(message, "outside the folder", help)
    })
}

/// A floor or a ceiling as the map writes it: one surface by its name, or a table with a pattern and a
/// scale.
pub(crate) struct CoveringText<'a> {
    pattern: PatternText<'a>,
    scale: Scale,
}

enum PatternText<'a> {
    Plain(SurfaceText<'a>),
    Checker([SurfaceText<'a>; 2]),
    Stripes([SurfaceText<'a>; 2]),
}

impl<'a> CoveringText<'a> {
    /// One surface, unscaled.
    pub(crate) fn plain(surface: SurfaceText<'a>) -> Self {
        Self { pattern: PatternText::Plain(surface), scale: Scale::ONE }
    }

    /// Reads the covering in `entry`. `example` is a whole entry.
    pub(crate) fn read(entry: &Entry<'a, '_>, example: &str) -> Option<Self> {
        match entry.value {
            DeValue::String(_) => SurfaceText::read(entry, example).map(Self::plain),
            DeValue::Table(table) => Self::read_table(entry, table),
            _ => {
                entry.faults.push(entry.wrong_type("a string or a table", example));
                None
            }
        }
    }

    fn read_table(owner: &Entry<'a, '_>, table: &'a DeTable<'_>) -> Option<Self> {
        let faults_before = owner.faults.len();
        let key = owner.key;
        let mut patterns = Vec::new();
        let mut scale = Scale::ONE;
        for entry in owner.entries(table) {
            match entry.key {
                "scale" => scale = SCALE.read(&entry).unwrap_or(scale),
                "texture" | "checker" | "stripes" => patterns.extend(PatternText::read(&entry)),
                _ => {
                    let known = ["texture", "checker", "stripes", "scale"];
                    entry.faults.push(entry.unknown_key(&format!("a {key}"), &known));
                }
            }
        }
        if owner.faults.len() > faults_before {
            return None;
        }
        match (patterns.pop(), patterns.is_empty()) {
            (Some(pattern), true) => Some(Self { pattern, scale }),
            (None, _) => {
                let message = format!("the {key} does not name a texture or pattern");
                owner.reject(message, "", format!(r#"write {key} = {{ texture = "tile" }}"#))
            }
            (Some(_), false) => {
                let message = format!("the {key} has several patterns at once");
                owner.reject(message, "", "keep one of texture, checker and stripes")
            }
        }
    }

    /// The covering itself. Reports a fault if a texture is missing.
    pub(crate) fn covering(&self, textures: &mut Textures<'_>) -> Option<Covering> {
        let mut both = |surfaces: &[SurfaceText<'_>; 2]| {
            let [first, second] = surfaces.each_ref().map(|surface| textures.paint(surface));
            Some([first?, second?])
        };
        let pattern = match &self.pattern {
            PatternText::Checker(surfaces) => Pattern::Checker(both(surfaces)?),
            PatternText::Stripes(surfaces) => Pattern::Stripes(both(surfaces)?),
            PatternText::Plain(surface) => Pattern::Plain(textures.paint(surface)?),
        };
        Some(Covering { pattern, scale: self.scale })
    }
}

impl<'a> PatternText<'a> {
    /// Reads the pattern in `entry`, which is an entry of a covering's table.
    fn read(entry: &Entry<'a, '_>) -> Option<Self> {
        if entry.key == "texture" {
            return SurfaceText::read(entry, r#"texture = "tile""#).map(Self::Plain);
        }
        let example = format!(r#"{} = ["tile", "marble"]"#, entry.key);
        let [first, second] =
            entry.pair(&example)?.map(|entry| SurfaceText::read(&entry, &example));
        let surfaces = [first?, second?];
        Some(if entry.key == "checker" { Self::Checker(surfaces) } else { Self::Stripes(surfaces) })
    }
}

/// A ceiling as the map writes it.
pub(crate) enum CeilingText<'a> {
    Sky,
    Covered(CoveringText<'a>),
}

impl<'a> CeilingText<'a> {
    /// Reads the ceiling in `entry` as [`CoveringText::read`] does. `"sky"` means no ceiling.
    pub(crate) fn read(entry: &Entry<'a, '_>, example: &str) -> Option<Self> {
        match entry.value {
            DeValue::String(text) if text == "sky" => Some(Self::Sky),
            _ => CoveringText::read(entry, example).map(Self::Covered),
        }
    }

    /// The ceiling itself, made as by [`CoveringText::covering`].
    pub(crate) fn ceiling(&self, textures: &mut Textures<'_>) -> Option<Ceiling> {
        match self {
            Self::Sky => Some(Ceiling::Sky),
            Self::Covered(covering) => covering.covering(textures).map(Ceiling::Covered),
        }
    }
}

/// The sky as the map writes it.
pub(crate) enum SkyText<'a> {
    Gradient(SkyGradient),
    Panorama(SurfaceText<'a>),
}

impl<'a> SkyText<'a> {
    /// Reads the sky in `entry`.
    pub(crate) fn read(entry: &Entry<'a, '_>) -> Option<Self> {
        let table = entry.table(SKY_EXAMPLE)?;
        let faults_before = entry.faults.len();
        let mut skies = Vec::new();
        for entry in entry.entries(table) {
            match entry.key {
                "gradient" => skies.extend(
                    colors(&entry, ["#5080c0", "#c0d8f0"])
                        .map(|[zenith, horizon]| Self::Gradient(SkyGradient { zenith, horizon })),
                ),
                "panorama" => skies.extend(SurfaceText::read_panorama(&entry).map(Self::Panorama)),
                _ => entry.faults.push(entry.unknown_key("a sky", &["gradient", "panorama"])),
            }
        }
        if entry.faults.len() > faults_before {
            return None;
        }
        if skies.len() == 1 {
            return skies.pop();
        }
        let label = if skies.is_empty() { "this has neither" } else { "this has both" };
        let message = "a sky is either a gradient or a panorama";
        entry.reject(message, label, format!("write {SKY_EXAMPLE}"))
    }

    /// The sky itself. Reports a fault if its texture is missing.
    pub(crate) fn sky(&self, textures: &mut Textures<'_>) -> Option<Sky> {
        match self {
            &Self::Gradient(gradient) => Some(Sky::Gradient(gradient)),
            Self::Panorama(surface) => match textures.paint(surface)? {
                Paint::Texture(texture) => Some(Sky::Panorama(texture)),
                Paint::Color(color) => {
                    Some(Sky::Gradient(SkyGradient { zenith: color, horizon: color }))
                }
            },
        }
    }
}

/// Reads two colours, such as `example`.
pub(crate) fn colors(entry: &Entry<'_, '_>, example: [&str; 2]) -> Option<[Rgb; 2]> {
    let example = format!("{} = {example:?}", entry.key);
    let [first, second] = entry.pair(&example)?.map(|entry| color(&entry, "", &example));
    Some([first?, second?])
}

/// Reads the fog in `entry`.
pub(crate) fn fog(entry: &Entry<'_, '_>) -> Option<Fog> {
    let table = entry.table(FOG_EXAMPLE)?;
    let faults_before = entry.faults.len();
    let (mut fog_color, mut distance) = (None, None);
    for entry in entry.entries(table) {
        match entry.key {
            "color" => fog_color = color(&entry, "", r##"color = "#101018""##),
            "distance" => distance = Some(entry),
            _ => entry.faults.push(entry.unknown_key("a fog", &["color", "distance"])),
        }
    }
    if entry.faults.len() > faults_before {
        return None;
    }
    let (Some(fog_color), Some(distance)) = (fog_color, distance) else {
        let help = format!("write {FOG_EXAMPLE}");
        return entry.reject("a fog has a colour and a distance", "", help);
    };
    distance.number().and_then(|distance| Fog::new(fog_color, distance)).or_else(|| {
        distance.reject(
            "the distance of a fog must be a finite number of cells above 0",
            "this is not",
            "write 12.0 for a fog that hides half of what is twelve cells away",
        )
    })
}

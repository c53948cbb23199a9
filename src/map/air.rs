//! The sky and the fog of a map.

use super::reader::Reader;
use super::textures::Surface;
use crate::color::Rgb;
use crate::fault::document::Entry;
use crate::fault::{Fault, quoted};
use crate::world::{Fog, Paint, Sky, SkyGradient};

const SKY_KEYS: &[&str] = &["gradient", "panorama"];
const SKY_EXAMPLE: &str = r##"sky = { gradient = ["#5080c0", "#c0d8f0"] }"##;
const FOG_KEYS: &[&str] = &["color", "distance"];
const FOG_EXAMPLE: &str = r##"fog = { color = "#101018", distance = 12.0 }"##;

/// The sky as the map writes it.
pub(crate) enum SkyText<'a> {
    Gradient(SkyGradient),
    Panorama(Surface<'a>),
}

impl<'a> SkyText<'a> {
    /// Reads the sky in `entry`; reports a fault where there is none.
    pub(crate) fn read(entry: &Entry<'a, '_>) -> Option<Self> {
        let table = entry.table(SKY_EXAMPLE)?;
        let faults_before = entry.faults.len();
        let mut skies = Vec::new();
        for entry in entry.entries(table) {
            match entry.key {
                "gradient" => skies.extend(gradient(&entry)),
                "panorama" => {
                    let surface = Surface::read_panorama(&entry, r#"panorama = "hills""#);
                    skies.extend(surface.map(Self::Panorama));
                }
                _ => entry.faults.push(entry.unknown_key("a sky", SKY_KEYS)),
            }
        }
        if entry.faults.len() > faults_before {
            return None;
        }
        if skies.len() != 1 {
            let message = "a sky is either a gradient or a panorama";
            entry.faults.push(
                Fault::new(entry.value_place.clone(), message)
                    .label(if skies.is_empty() { "this is none" } else { "this is both" })
                    .help(format!("write {SKY_EXAMPLE}")),
            );
        }
        skies.pop()
    }

    /// The sky itself. Reports a fault where its texture is missing.
    pub(crate) fn sky(&self, reader: &mut Reader<'_>) -> Option<Sky> {
        match self {
            &Self::Gradient(gradient) => Some(Sky::Gradient(gradient)),
            Self::Panorama(surface) => match reader.paint(surface)? {
                Paint::Texture(texture) => Some(Sky::Panorama(texture)),
                Paint::Color(color) => {
                    Some(Sky::Gradient(SkyGradient { zenith: color, horizon: color }))
                }
            },
        }
    }
}

fn gradient<'a>(entry: &Entry<'a, '_>) -> Option<SkyText<'a>> {
    let example = r##"gradient = ["#5080c0", "#c0d8f0"]"##;
    let pair = entry.pair(example)?;
    let [zenith, horizon] = pair.map(|entry| color(&entry, example));
    Some(SkyText::Gradient(SkyGradient { zenith: zenith?, horizon: horizon? }))
}

pub(crate) fn color(entry: &Entry<'_, '_>, example: &str) -> Option<Rgb> {
    let text = entry.string(example)?;
    text.parse()
        .map_err(|error| {
            let message = format!("{} is not a colour", quoted(text));
            entry
                .faults
                .push(Fault::new(entry.value_place.clone(), message).help(format!("{error}")));
        })
        .ok()
}

/// Reads the fog in `entry`; reports a fault where there is none.
pub(crate) fn fog(entry: &Entry<'_, '_>) -> Option<Fog> {
    let table = entry.table(FOG_EXAMPLE)?;
    let faults_before = entry.faults.len();
    let (mut fog_color, mut distance) = (None, None);
    for entry in entry.entries(table) {
        match entry.key {
            "color" => fog_color = color(&entry, r##"color = "#101018""##),
            "distance" => distance = Some(entry),
            _ => entry.faults.push(entry.unknown_key("a fog", FOG_KEYS)),
        }
    }
    if entry.faults.len() > faults_before {
        return None;
    }
    let (Some(fog_color), Some(distance)) = (fog_color, distance) else {
        let message = "a fog has a colour and a distance";
        let place = entry.value_place.clone();
        entry.faults.push(Fault::new(place, message).help(format!("write {FOG_EXAMPLE}")));
        return None;
    };
    let fog = distance.number().and_then(|distance| Fog::new(fog_color, distance));
    if fog.is_none() {
        let message = "the distance of a fog must be a finite number of cells above 0";
        entry.faults.push(
            Fault::new(distance.value_place, message)
                .label("this is none")
                .help("write 12.0 for a fog that hides half of what is twelve cells away"),
        );
    }
    fog
}

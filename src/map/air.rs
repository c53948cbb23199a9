//! The sky and the fog of a map.

use super::textures::{Surface, Textures};
use crate::color::Rgb;
use crate::fault::document::{Entry, entries};
use crate::fault::{Fault, quoted};
use crate::world::{Fog, Paint, Sky};

const SKY_KEYS: &[&str] = &["gradient", "panorama"];
const SKY_EXAMPLE: &str = r##"sky = { gradient = ["#5080c0", "#c0d8f0"] }"##;
const FOG_KEYS: &[&str] = &["color", "distance"];
const FOG_EXAMPLE: &str = r##"fog = { color = "#101018", distance = 12.0 }"##;

/// The sky as the map writes it.
pub(super) enum SkyText<'a> {
    Gradient { zenith: Rgb, horizon: Rgb },
    Panorama(Surface<'a>),
}

impl<'a> SkyText<'a> {
    /// Reads the sky in `entry`; adds to `faults` where there is none.
    pub(super) fn read(entry: &Entry<'a, '_>, faults: &mut Vec<Fault>) -> Option<Self> {
        let table = entry.table(SKY_EXAMPLE, faults)?;
        let faults_before = faults.len();
        let mut skies = Vec::new();
        for entry in entries(table) {
            match entry.key {
                "gradient" => skies.extend(gradient(&entry, faults)),
                "panorama" => {
                    let surface = Surface::read_panorama(&entry, r#"panorama = "hills""#, faults);
                    skies.extend(surface.map(Self::Panorama));
                }
                _ => faults.push(entry.unknown_key("a sky", SKY_KEYS)),
            }
        }
        if faults.len() > faults_before {
            return None;
        }
        if skies.len() != 1 {
            let message = "a sky is either a gradient or a panorama";
            faults.push(
                Fault::new(entry.value_place.clone(), message)
                    .label(if skies.is_empty() { "this is none" } else { "this is both" })
                    .help(format!("write {SKY_EXAMPLE}")),
            );
        }
        skies.pop()
    }

    /// The sky itself. Adds to `faults` where its texture is missing.
    pub(super) fn sky(&self, textures: &mut Textures<'_>, faults: &mut Vec<Fault>) -> Option<Sky> {
        match self {
            &Self::Gradient { zenith, horizon } => Some(Sky::Gradient { zenith, horizon }),
            Self::Panorama(surface) => match textures.paint(surface, faults)? {
                Paint::Texture(texture) => Some(Sky::Panorama(texture)),
                Paint::Color(color) => Some(Sky::Gradient { zenith: color, horizon: color }),
            },
        }
    }
}

fn gradient<'a>(entry: &Entry<'a, '_>, faults: &mut Vec<Fault>) -> Option<SkyText<'a>> {
    let example = r##"gradient = ["#5080c0", "#c0d8f0"]"##;
    let pair = entry.pair(example, faults)?;
    let [zenith, horizon] = pair.map(|entry| color(&entry, example, faults));
    Some(SkyText::Gradient { zenith: zenith?, horizon: horizon? })
}

pub(super) fn color(entry: &Entry<'_, '_>, example: &str, faults: &mut Vec<Fault>) -> Option<Rgb> {
    let text = entry.string(example, faults)?;
    text.parse()
        .map_err(|error| {
            let message = format!("{} is not a colour", quoted(text));
            faults.push(Fault::new(entry.value_place.clone(), message).help(format!("{error}")));
        })
        .ok()
}

/// Reads the fog in `entry`; adds to `faults` where there is none.
pub(super) fn fog(entry: &Entry<'_, '_>, faults: &mut Vec<Fault>) -> Option<Fog> {
    let table = entry.table(FOG_EXAMPLE, faults)?;
    let faults_before = faults.len();
    let (mut fog_color, mut distance) = (None, None);
    for entry in entries(table) {
        match entry.key {
            "color" => fog_color = color(&entry, r##"color = "#101018""##, faults),
            "distance" => distance = Some(entry),
            _ => faults.push(entry.unknown_key("a fog", FOG_KEYS)),
        }
    }
    if faults.len() > faults_before {
        return None;
    }
    let (Some(fog_color), Some(distance)) = (fog_color, distance) else {
        let message = "a fog has a colour and a distance";
        let place = entry.value_place.clone();
        faults.push(Fault::new(place, message).help(format!("write {FOG_EXAMPLE}")));
        return None;
    };
    let fog = distance.number().and_then(|distance| Fog::new(fog_color, distance));
    if fog.is_none() {
        let message = "the distance of a fog must be a finite number of cells above 0";
        faults.push(
            Fault::new(distance.value_place, message)
                .label("this is none")
                .help("write 12.0 for a fog that hides half of what is twelve cells away"),
        );
    }
    fog
}

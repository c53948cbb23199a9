//! Bodies: their shapes and colours, as the map writes them.

use std::ops::Range;

use glam::DVec3;
use toml::de::DeTable;

use super::bodies::Bodies;
use super::{coordinates, tables, vector};
use crate::color::Rgb;
use crate::fault::document::Entry;
use crate::fault::{Fault, quoted};
use crate::map::air;
use crate::space::{Block, Body, FARTHEST, Plane, SMALLEST, Shape, SolidTexture, Sphere};
use crate::world::Scale;

/// The kinds of body.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    Sphere,
    Plane,
    Box,
}

/// The entries of a body's table.
#[derive(Default)]
struct Said {
    vectors: Vec<(&'static str, DVec3)>,
    number: Option<(f64, Range<usize>)>,
    color: Option<Rgb>,
    checker: Option<[Rgb; 2]>,
    scale: Option<Scale>,
}

impl Kind {
    pub(crate) fn of_key(key: &str) -> Option<Self> {
        match key {
            "sphere" => Some(Self::Sphere),
            "plane" => Some(Self::Plane),
            "box" => Some(Self::Box),
            _ => None,
        }
    }

    /// Reads the bodies of `entry` into `bodies`; reports its faults. Nothing is read after a body that
    /// is one too many.
    pub(crate) fn read_all(self, entry: &Entry<'_, '_>, bodies: &mut Bodies) {
        for (table, place) in tables(entry, self.example()) {
            let Some(body) = self.read(entry, table, place.clone()) else { continue };
            if let Err(fault) = bodies.add(body, place) {
                entry.faults.push(fault);
                return;
            }
        }
    }

    fn example(self) -> &'static str {
        match self {
            Self::Sphere => r##"[[sphere]], center = [4, 0, 1], radius = 1 and color = "#c04030""##,
            Self::Plane => r##"[[plane]], height = 0 and color = "#608040""##,
            Self::Box => r##"[[box]], from = [4, 0, 0], to = [5, 1, 1] and color = "#c0a040""##,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Sphere => "a sphere",
            Self::Plane => "a plane",
            Self::Box => "a box",
        }
    }

    /// The keys of the vectors and of the number that define the shape.
    fn shape_keys(self) -> (&'static [&'static str], &'static str) {
        match self {
            Self::Sphere => (&["center"], "radius"),
            Self::Plane => (&["point", "normal"], "height"),
            Self::Box => (&["from", "to"], ""),
        }
    }

    fn read(self, entry: &Entry<'_, '_>, table: &DeTable<'_>, place: Range<usize>) -> Option<Body> {
        let faults_before = entry.faults.len();
        let said = self.read_entries(entry, table);
        if entry.faults.len() > faults_before {
            return None;
        }
        let fault = |message: String| {
            Some(Fault::new(place, message).help(format!("write {}", self.example())))
        };
        let (shape, texture) = (self.shape(&said), said.texture());
        let (fault, body) = match (shape, texture) {
            (Some(shape), Some(texture)) => (None, Some(Body { shape, texture })),
            (None, _) => (fault(format!("{} needs {}", self.name(), self.needs())), None),
            (_, None) => {
                let message = "has either a color, or a checker of two and perhaps a scale";
                (fault(format!("{} {message}", self.name())), None)
            }
        };
        entry.faults.extend(fault);
        body
    }

    fn needs(self) -> String {
        match self {
            Self::Sphere => format!("a center, and a radius from {SMALLEST:e} to {FARTHEST:e}"),
            Self::Plane => format!("a point and a normal, or a height {}", coordinates()),
            Self::Box => format!("two corners, at least {SMALLEST:e} apart along every axis"),
        }
    }

    fn read_entries(self, entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Said {
        let (vectors, number) = self.shape_keys();
        let mut said = Said::default();
        for entry in entry.entries(table) {
            if let Some(&key) = vectors.iter().find(|&&key| key == entry.key) {
                let vector = if key == "normal" {
                    vector::direction(&entry, "normal = [0, 0, 1]")
                } else {
                    vector::place(&entry)
                };
                said.vectors.extend(vector.map(|vector| (key, vector)));
                continue;
            }
            match entry.key {
                "color" => said.color = air::color(&entry, r##"color = "#c04030""##),
                "checker" => said.checker = checker(&entry),
                "scale" => said.scale = scale(&entry),
                key if key == number => match entry.number() {
                    Some(found) => said.number = Some((found, entry.value_place)),
                    None => {
                        entry.faults.push(entry.wrong_type("a number", &format!("{key} = 1.0")));
                    }
                },
                _ => {
                    let known = [vectors, &["color", "checker", "scale"]].concat();
                    let own = (!number.is_empty()).then_some(number);
                    let known: Vec<&str> = own.into_iter().chain(known).collect();
                    entry.faults.push(entry.unknown_key(self.name(), &known));
                }
            }
        }
        said
    }

    fn shape(self, said: &Said) -> Option<Shape> {
        let number = said.number.as_ref().map(|&(number, _)| number);
        let vector = |key| said.vectors.iter().find(|&&(said, _)| said == key).map(|&(_, it)| it);
        match self {
            Self::Sphere => Sphere::new(vector("center")?, number?).map(Shape::Sphere),
            Self::Box => Block::new(vector("from")?, vector("to")?).map(Shape::Block),
            Self::Plane => match (number, vector("point"), vector("normal")) {
                (Some(height), None, None) => Plane::new(DVec3::Z * height, DVec3::Z),
                (None, Some(point), Some(normal)) => Plane::new(point, normal),
                _ => None,
            }
            .map(Shape::Plane),
        }
    }
}

impl Said {
    fn texture(&self) -> Option<SolidTexture> {
        match (self.color, self.checker, self.scale) {
            (Some(color), None, None) => Some(SolidTexture::Plain(color)),
            (None, Some(checker), scale) => {
                Some(SolidTexture::Checker(checker, scale.unwrap_or(Scale::ONE)))
            }
            _ => None,
        }
    }
}

fn checker(entry: &Entry<'_, '_>) -> Option<[Rgb; 2]> {
    let example = r##"checker = ["#e0e0e0", "#404040"]"##;
    let [one, other] = entry.pair(example)?.map(|entry| air::color(&entry, example));
    Some([one?, other?])
}

fn scale(entry: &Entry<'_, '_>) -> Option<Scale> {
    let scale = entry.number().and_then(Scale::new);
    if scale.is_none() {
        let message = format!("{} must be a finite number above 0", quoted(entry.key));
        entry.faults.push(Fault::new(entry.value_place.clone(), message).help("write scale = 1.0"));
    }
    scale
}

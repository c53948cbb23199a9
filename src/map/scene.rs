//! Maps of bodies: spheres, planes and boxes instead of a grid.
//!
//! If the boxes of bodies overlap, no order makes the nearest body cheaper to find: a ray that
//! meets the boxes is tested against each body. A limit on the number of overlapping pairs
//! therefore limits the number of tests: 141 bodies in one place overlap in 9,870 pairs. Rejected:
//! a lower limit on the number of bodies. A thousand bodies side by side take only a few tests
//! each.

use std::ops::Range;

use glam::DVec3;
use toml::de::{DeTable, DeValue};

use super::definitions::title;
use super::surfaces::{self, SkyText, colors};
use super::values::{HEADING, Quantity, SCALE, color};
use crate::color::Rgb;
use crate::fault::document::{Entry, FaultList, entries};
use crate::fault::{Fault, quoted};
use crate::world::scene::{
    Block, Body, BodyShape, EYE_CLEARANCE, Elevation, Fraction, MAX_COORDINATE, Plane, Scene,
    SceneStart, SolidTexture, Sphere, Sun,
};
use crate::world::{Heading, Scale, SkyGradient};

/// The largest number of bodies.
const MAX_BODIES: usize = 1000;
/// The largest number of pairs of bodies that overlap.
const MAX_PAIRS: usize = 10_000;

const KEYS: &[&str] = &["title", "sky", "fog", "light", "start", "sphere", "plane", "box"];
const LIGHT_EXAMPLE: &str = "light = { toward = [-1, -1, 2], ambient = 0.2 }";
const START_EXAMPLE: &str = "start = { at = [0, 0, 0.5], heading = 0 }";

const AMBIENT: Quantity<Fraction> = Quantity {
    of: Fraction::new,
    wanted: "the ambient light must be a number from 0 to 1",
    label: "this is not",
    help: "write 0.2 for dark shading, 1 for no shading",
};
const PITCH: Quantity<Elevation> = Quantity {
    of: Elevation::from_degrees,
    wanted: "a pitch must be degrees from -90, down, to 90, up",
    label: "this is not",
    help: "",
};

/// A kind of body.
struct BodyKind {
    key: &'static str,
    name: &'static str,
    /// The keys that define the shape.
    keys: &'static [&'static str],
    needs: &'static str,
    example: &'static str,
    shape: fn(&BodyProperties<'_>) -> Option<BodyShape>,
}

const KINDS: [BodyKind; 3] = [
    BodyKind {
        key: "sphere",
        name: "a sphere",
        keys: &["radius", "center"],
        needs: "a center, and a radius from 1e-9 to 1e9",
        example: r##"[[sphere]], center = [4, 0, 1], radius = 1 and color = "#c04030""##,
        shape: |of| Sphere::new(of.vector("center")?, of.number?).map(BodyShape::Sphere),
    },
    BodyKind {
        key: "plane",
        name: "a plane",
        keys: &["height", "point", "normal"],
        needs: "a point and a normal, or a height from -1e9 to 1e9",
        example: r##"[[plane]], height = 0 and color = "#608040""##,
        shape: |of| match (of.number, of.vector("point"), of.vector("normal")) {
            (Some(height), None, None) => {
                Plane::new(DVec3::Z * height, DVec3::Z).map(BodyShape::Plane)
            }
            (None, Some(point), Some(normal)) => Plane::new(point, normal).map(BodyShape::Plane),
            _ => None,
        },
    },
    BodyKind {
        key: "box",
        name: "a box",
        keys: &["from", "to"],
        needs: "two corners, at least 1e-9 apart along every axis",
        example: r##"[[box]], from = [4, 0, 0], to = [5, 1, 1] and color = "#c0a040""##,
        shape: |of| Block::new(of.vector("from")?, of.vector("to")?).map(BodyShape::Block),
    },
];

/// The properties of a body, as the map writes them.
#[derive(Default)]
struct BodyProperties<'a> {
    /// The positions and directions, with their keys.
    vectors: Vec<(&'a str, DVec3)>,
    /// The radius of a sphere, or the height of a plane.
    number: Option<f64>,
    color: Option<Rgb>,
    checker: Option<[Rgb; 2]>,
    scale: Option<Scale>,
}

/// Returns whether `document` has bodies, and is therefore not a map with a grid.
pub(crate) fn has_bodies(document: &DeTable) -> bool {
    KINDS.iter().any(|kind| document.contains_key(kind.key))
}

/// Reads the scene in `document`; reports its faults. `None` if there is no scene.
pub(crate) fn read(document: &DeTable, faults: &FaultList) -> Option<Scene> {
    let mut scene = Scene::default();
    let mut start = None;
    let mut pairs = 0;
    for entry in entries(document, faults) {
        match entry.key {
            "title" => scene.title = title(&entry).unwrap_or_default(),
            "sky" => scene.sky = sky(&entry).unwrap_or_default(),
            "fog" => scene.fog = surfaces::fog(&entry),
            "light" => scene.sun = light(&entry).unwrap_or_default(),
            "start" => start = Some(entry),
            "grid" | "tiles" | "things" => faults.push(
                Fault::new(entry.key_place, "a map has either a grid or bodies")
                    .label("this map has bodies")
                    .help("split it into two maps"),
            ),
            key => match KINDS.iter().find(|kind| kind.key == key) {
                Some(kind) => kind.read_all(&entry, &mut scene.bodies, &mut pairs),
                None => faults.push(entry.unknown_key("a map of bodies", KEYS)),
            },
        }
    }
    let Some(entry) = start else {
        faults.push(
            Fault::new(0..0, "the map has no start")
                .label("a start is missing")
                .help(format!("write {START_EXAMPLE}")),
        );
        return None;
    };
    scene.start = read_start(&entry, &scene)?;
    Some(scene)
}

fn sky(entry: &Entry<'_, '_>) -> Option<SkyGradient> {
    match SkyText::read(entry)? {
        SkyText::Gradient(gradient) => Some(gradient),
        SkyText::Panorama(surface) => {
            entry.faults.push(
                Fault::new(surface.place, "the sky of a map of bodies has no panorama")
                    .help(r##"write sky = { gradient = ["#5080c0", "#c0d8f0"] }"##),
            );
            None
        }
    }
}

fn light(entry: &Entry<'_, '_>) -> Option<Sun> {
    let table = entry.table(LIGHT_EXAMPLE)?;
    let mut sun = Sun::default();
    for entry in entry.entries(table) {
        match entry.key {
            "toward" => {
                let toward = direction(&entry, "toward = [-1, -1, 2]");
                sun = toward.and_then(|toward| Sun::new(toward, sun.ambient)).unwrap_or(sun);
            }
            "ambient" => sun.ambient = AMBIENT.read(&entry).unwrap_or(sun.ambient),
            _ => entry.faults.push(entry.unknown_key("a light", &["toward", "ambient"])),
        }
    }
    Some(sun)
}

fn read_start(entry: &Entry<'_, '_>, scene: &Scene) -> Option<SceneStart> {
    let table = entry.table(START_EXAMPLE)?;
    let faults_before = entry.faults.len();
    let mut at = None;
    let (mut heading, mut elevation) = (Heading::default(), Elevation::LEVEL);
    for entry in entry.entries(table) {
        match entry.key {
            "at" => at = position(&entry).map(|at| (at, entry)),
            "heading" => heading = HEADING.read(&entry).unwrap_or_default(),
            "pitch" => elevation = PITCH.read(&entry).unwrap_or_default(),
            _ => entry.faults.push(entry.unknown_key("a start", &["at", "heading", "pitch"])),
        }
    }
    if entry.faults.len() > faults_before {
        return None;
    }
    let Some((at, at_entry)) = at else {
        let help = format!("write {START_EXAMPLE}");
        return entry.reject("the start does not say where it is", "", help);
    };
    let is_near = |body: &Body| body.shape.signed_distance(at).0 < EYE_CLEARANCE;
    if scene.bodies.iter().any(is_near) {
        let message =
            format!("the start is less than {EYE_CLEARANCE} cells from a body, or inside it");
        return at_entry.reject(message, "", "move one of the two");
    }
    SceneStart::new(at, heading, elevation)
}

impl BodyKind {
    /// Reads the bodies of `entry`, which the map writes as `[[key]]`, into `bodies`. Adds to
    /// `pairs` the number of pairs that overlap. Stops at a body that is one too many.
    fn read_all(&self, entry: &Entry<'_, '_>, bodies: &mut Vec<Body>, pairs: &mut usize) {
        let Some(list) = entry.list() else {
            entry.faults.push(entry.wrong_type("a list of tables", self.example));
            return;
        };
        for item in list {
            let DeValue::Table(table) = item.value else {
                entry.faults.push(entry.wrong_type("a list of tables", self.example));
                continue;
            };
            let Some(body) = self.read(&item, table) else { continue };
            *pairs += bodies.iter().filter(|other| other.shape.overlaps(&body.shape)).count();
            if let Some(fault) = one_too_many(item.value_place, bodies.len(), *pairs) {
                entry.faults.push(fault);
                return;
            }
            bodies.push(body);
        }
    }

    fn read(&self, entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Option<Body> {
        let faults_before = entry.faults.len();
        let properties = self.read_properties(entry, table);
        if entry.faults.len() > faults_before {
            return None;
        }
        let message = match ((self.shape)(&properties), properties.texture()) {
            (Some(shape), Some(texture)) => return Some(Body { shape, texture }),
            (None, _) => format!("{} needs {}", self.name, self.needs),
            (_, None) => {
                let message =
                    "needs either a color, or a checker of two colors and optionally a scale";
                format!("{} {message}", self.name)
            }
        };
        entry.reject(message, "", format!("write {}", self.example))
    }

    fn read_properties<'a>(
        &self,
        entry: &Entry<'a, '_>,
        table: &'a DeTable<'_>,
    ) -> BodyProperties<'a> {
        let mut properties = BodyProperties::default();
        for entry in entry.entries(table) {
            let key = entry.key;
            match key {
                "color" => properties.color = color(&entry, "", r##"color = "#c04030""##),
                "checker" => properties.checker = colors(&entry, ["#e0e0e0", "#404040"]),
                "scale" => properties.scale = SCALE.read(&entry),
                _ if !self.keys.contains(&key) => {
                    let known = [self.keys, &["color", "checker", "scale"]].concat();
                    entry.faults.push(entry.unknown_key(self.name, &known));
                }
                "radius" | "height" => {
                    properties.number = entry.number().or_else(|| {
                        entry.faults.push(entry.wrong_type("a number", &format!("{key} = 1.0")));
                        None
                    });
                }
                _ => {
                    let vector = match key {
                        "normal" => direction(&entry, "normal = [0, 0, 1]"),
                        _ => position(&entry),
                    };
                    properties.vectors.extend(vector.map(|vector| (key, vector)));
                }
            }
        }
        properties
    }
}

/// The fault of a body at `place` that is one too many. There are `count` bodies before it, and
/// `pairs` pairs overlap with it included.
fn one_too_many(place: Range<usize>, count: usize, pairs: usize) -> Option<Fault> {
    if count == MAX_BODIES {
        let fault = Fault::new(place, format!("a map has {MAX_BODIES} bodies at most"));
        let help = "leave some out, or split it into two maps";
        return Some(fault.label("this is one too many").help(help));
    }
    (pairs > MAX_PAIRS).then(|| {
        Fault::new(place, format!("more than {MAX_PAIRS} pairs of bodies overlap"))
            .label("with this body")
            .help("leave out bodies that others hide, or move them apart")
    })
}

impl BodyProperties<'_> {
    fn vector(&self, key: &str) -> Option<DVec3> {
        self.vectors.iter().find(|&&(known, _)| known == key).map(|&(_, vector)| vector)
    }

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

/// Reads the position in `entry`, within the limits of bodies and cameras.
fn position(entry: &Entry<'_, '_>) -> Option<DVec3> {
    let place = three(entry, &format!("{} = [2, 0, 0.5]", entry.key))?;
    (place.abs().max_element() <= MAX_COORDINATE).then_some(place).or_else(|| {
        let key = quoted(entry.key);
        let message = format!("the coordinates of {key} must be from -1e9 to 1e9");
        entry.reject(message, "this is too far away", "")
    })
}

/// Reads the direction in `entry`, which may have any length except 0.
fn direction(entry: &Entry<'_, '_>, example: &str) -> Option<DVec3> {
    let direction = three(entry, example)?;
    (direction.abs().max_element() > 0.0).then_some(direction).or_else(|| {
        let message = format!("{} points nowhere", quoted(entry.key));
        entry.reject(message, "all three are zero", format!("write {example}"))
    })
}

/// Reads three finite numbers.
fn three(entry: &Entry<'_, '_>, example: &str) -> Option<DVec3> {
    let Some(list) = entry.list() else {
        entry.faults.push(entry.wrong_type("a list of three numbers", example));
        return None;
    };
    let numbers = list.iter().map(|number| number.number().filter(|number| number.is_finite()));
    let numbers: Option<Vec<f64>> = numbers.collect();
    if let Some(&[x, y, z]) = numbers.as_deref() {
        return Some(DVec3::new(x, y, z));
    }
    let message = format!("{} must be a list of three finite numbers", quoted(entry.key));
    let label = "to the east, to the south, and upwards";
    entry.reject(message, label, format!("write {example}"))
}

//! Maps of bodies: spheres, planes and boxes instead of a grid.
//!
//! This file reads the keys of the whole map, `body` reads bodies, `bodies` limits them, and `vector`
//! reads positions, directions and numbers.

mod bodies;
mod body;
mod vector;

use std::ops::Range;

use glam::DVec3;
use toml::de::{DeTable, DeValue};

use super::air::{self, SkyText};
use super::definitions;
use crate::fault::Fault;
use crate::fault::document::{Entry, FaultList, entries};
use crate::space::{EYE_CLEARANCE, Elevation, FARTHEST, Fraction, Scene, Start, Sun};
use crate::world::{Heading, SkyGradient};
use bodies::Bodies;
use body::Kind;

const KEYS: &[&str] = &["title", "sky", "fog", "light", "start", "sphere", "plane", "box"];
const LIGHT_KEYS: &[&str] = &["toward", "ambient"];
const LIGHT_EXAMPLE: &str = "light = { toward = [-1, -1, 2], ambient = 0.2 }";
const START_KEYS: &[&str] = &["at", "heading", "pitch"];
const START_EXAMPLE: &str = "start = { at = [0, 0, 0.5], heading = 0 }";

/// Whether `document` has bodies, and so is not a map with a grid.
pub(crate) fn has_bodies(document: &DeTable) -> bool {
    document.keys().any(|key| Kind::of_key(key.get_ref()).is_some())
}

/// Reads the scene in `document`; reports its faults. `None` where there is no scene.
pub(crate) fn read(document: &DeTable, faults: &FaultList) -> Option<Scene> {
    let mut scene = Scene::default();
    let mut bodies = Bodies::default();
    let mut start = None;
    for entry in entries(document, faults) {
        match entry.key {
            "title" => scene.title = definitions::title(&entry).unwrap_or_default(),
            "sky" => scene.sky = sky(&entry).unwrap_or_default(),
            "fog" => scene.fog = air::fog(&entry),
            "light" => scene.sun = light(&entry).unwrap_or_default(),
            "start" => start = Some(entry),
            "grid" | "tiles" | "things" => entry.faults.push(both_kinds(&entry)),
            key => match Kind::of_key(key) {
                Some(kind) => kind.read_all(&entry, &mut bodies),
                None => entry.faults.push(entry.unknown_key("a map of bodies", KEYS)),
            },
        }
    }
    scene.bodies = bodies.into_list();
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

fn both_kinds(entry: &Entry<'_, '_>) -> Fault {
    Fault::new(entry.key_place.clone(), "a map has either a grid or bodies")
        .label("this map has bodies")
        .help("make two maps of it")
}

fn sky(entry: &Entry<'_, '_>) -> Option<SkyGradient> {
    match SkyText::read(entry)? {
        SkyText::Gradient(gradient) => Some(gradient),
        SkyText::Panorama(surface) => {
            entry.faults.push(
                Fault::new(surface.place(), "the sky of a map of bodies has no panorama")
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
            "toward" => sun = toward(&entry, sun).unwrap_or(sun),
            "ambient" => match entry.number().and_then(Fraction::new) {
                Some(ambient) => sun.ambient = ambient,
                None => entry.faults.push(
                    Fault::new(entry.value_place, "the ambient light must be a number from 0 to 1")
                        .label("this is none")
                        .help("write 0.2 for dark shades, 1 for none"),
                ),
            },
            _ => entry.faults.push(entry.unknown_key("a light", LIGHT_KEYS)),
        }
    }
    Some(sun)
}

fn toward(entry: &Entry<'_, '_>, sun: Sun) -> Option<Sun> {
    let toward = vector::direction(entry, "toward = [-1, -1, 2]")?;
    Sun::new(toward, sun.ambient)
}

fn read_start(entry: &Entry<'_, '_>, scene: &Scene) -> Option<Start> {
    let table = entry.table(START_EXAMPLE)?;
    let faults_before = entry.faults.len();
    let mut place = None;
    let (mut heading, mut elevation) = (Heading::default(), Elevation::LEVEL);
    for entry in entry.entries(table) {
        match entry.key {
            "at" => place = vector::place(&entry).map(|at| (at, entry.value_place)),
            "heading" => heading = read_heading(&entry).unwrap_or_default(),
            "pitch" => elevation = read_elevation(&entry).unwrap_or_default(),
            _ => entry.faults.push(entry.unknown_key("a start", START_KEYS)),
        }
    }
    if entry.faults.len() > faults_before {
        return None;
    }
    let Some((at, place)) = place else {
        let fault = Fault::new(entry.value_place.clone(), "the start does not say where it is");
        entry.faults.push(fault.help(format!("write {START_EXAMPLE}")));
        return None;
    };
    let is_free = |at: DVec3| {
        scene.bodies.iter().all(|body| body.shape.signed_distance(at).0 >= EYE_CLEARANCE)
    };
    if !is_free(at) {
        let message =
            format!("the start is less than {EYE_CLEARANCE} cells from a body, or inside it");
        entry.faults.push(Fault::new(place, message).help("move one of the two"));
        return None;
    }
    Start::new(at, heading, elevation)
}

fn read_heading(entry: &Entry<'_, '_>) -> Option<Heading> {
    let heading = entry.number().and_then(Heading::from_degrees);
    if heading.is_none() {
        entry.faults.push(number_wanted(entry, "a heading must be a finite number of degrees"));
    }
    heading
}

fn read_elevation(entry: &Entry<'_, '_>) -> Option<Elevation> {
    let elevation = entry.number().and_then(Elevation::from_degrees);
    if elevation.is_none() {
        entry
            .faults
            .push(number_wanted(entry, "a pitch must be degrees from -90, down, to 90, up"));
    }
    elevation
}

fn number_wanted(entry: &Entry<'_, '_>, message: &str) -> Fault {
    Fault::new(entry.value_place.clone(), message).label("this is none")
}

/// The range of coordinates, in words.
fn coordinates() -> String {
    format!("from -{FARTHEST:e} to {FARTHEST:e}")
}

/// The tables of `entry`, each of which the map writes as `[[key]]`.
fn tables<'a, 't>(entry: &Entry<'a, 't>, example: &str) -> Vec<(&'a DeTable<'t>, Range<usize>)> {
    let wrong = || entry.wrong_type("a list of tables", example);
    let DeValue::Array(list) = entry.value else {
        entry.faults.push(wrong());
        return Vec::new();
    };
    let mut tables = Vec::new();
    for value in list {
        match value.get_ref() {
            DeValue::Table(table) => tables.push((table, value.span())),
            _ => entry.faults.push(wrong()),
        }
    }
    tables
}

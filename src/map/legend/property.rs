//! Properties: what one entry of a definition means.

use toml::de::{DeTable, DeValue};

use super::{Meaning, Section};
use crate::fault::Fault;
use crate::fault::document::Entry;
use crate::map::doors::{DoorSymbol, KeySymbol};
use crate::map::guards::GuardSymbol;
use crate::map::heights;
use crate::map::items::{self, ItemSymbol};
use crate::map::mechanisms::{self, MovingWallSymbol};
use crate::map::see_through::{self, MaskSymbol};
use crate::map::shapes::ShapeSymbol;
use crate::map::sprites::SpriteSymbol;
use crate::map::switches::SwitchSymbol;
use crate::map::textures::Surface;
use crate::world::{Heading, Light};

/// Reads one property of a tile or a thing.
pub(crate) fn property<'a>(
    section: Section,
    entry: &Entry<'a, '_>,
    table: &'a DeTable<'_>,
) -> Option<Meaning<'a>> {
    let is_addition = |(key, to): (&str, &str)| key == entry.key && table.contains_key(to);
    if section.additions().any(is_addition) {
        return None;
    }
    match (section, entry.key) {
        (Section::Tiles, "wall") => {
            let surface = Surface::read(entry, r#"{ wall = "brick" }"#);
            let height = heights::of_wall(entry, table);
            if !table.contains_key("switch") {
                return surface.map(|surface| Meaning::Wall(surface, height));
            }
            let switch = SwitchSymbol::of(entry, table, r#"{ wall = "stone", switch = "gate" }"#)?;
            let symbol = |surface| MovingWallSymbol { surface, height, switch: Some(switch) };
            surface.map(symbol).map(Meaning::MovingWall)
        }
        (Section::Tiles, "secret") => {
            MovingWallSymbol::read_secret(entry, table).map(Meaning::MovingWall)
        }
        (Section::Tiles, "door") => DoorSymbol::read(entry, table).map(Meaning::Door),
        (Section::Tiles, "mask") => MaskSymbol::read(entry).map(Meaning::Mask),
        (Section::Tiles, "glass") => see_through::glass(entry, table).map(Meaning::Glass),
        (Section::Tiles, "mirror") => {
            let tint = see_through::mirror(entry, table);
            let height = heights::of_wall(entry, table);
            tint.map(|tint| Meaning::Mirror(tint, height))
        }
        (Section::Tiles, "pillar" | "diagonal" | "thin") => {
            ShapeSymbol::read(entry, table).map(Meaning::Shape)
        }
        (Section::Things, "key") => {
            KeySymbol::read(entry, r#"{ key = "brass" }"#).map(Meaning::Key)
        }
        (Section::Things, "sprite") => SpriteSymbol::read(entry, table).map(Meaning::Ornament),
        (Section::Things, "start") => Some(Meaning::Start(heading(entry)?)),
        (Section::Things, "exit") => exit(entry),
        (Section::Things, "guard") => GuardSymbol::read(entry, table).map(Meaning::Guard),
        (Section::Things, "waypoint") => mechanisms::is_true(entry).then_some(Meaning::Waypoint),
        (Section::Things, key) if items::KEYS.contains(&key) => {
            ItemSymbol::read(entry, table).map(Meaning::Item)
        }
        _ => {
            entry.faults.push(section.unknown_property(entry));
            None
        }
    }
}

pub(crate) fn heading(entry: &Entry<'_, '_>) -> Option<Heading> {
    let heading = entry.number().and_then(Heading::from_degrees);
    if heading.is_none() {
        entry.faults.push(
            Fault::new(entry.value_place.clone(), "a heading must be a finite number of degrees")
                .label("this is none")
                .help("write 0 for east, 90 for south, 180 for west, 270 for north"),
        );
    }
    heading
}

/// Reads a light, a number from 0 to 1.
pub(crate) fn light(entry: &Entry<'_, '_>) -> Option<Light> {
    let light = entry.number().and_then(Light::new);
    if light.is_none() {
        entry.faults.push(
            Fault::new(entry.value_place.clone(), "a light must be a number from 0 to 1")
                .label("this is none")
                .help("write 0 for darkness, 1 for full brightness"),
        );
    }
    light
}

fn exit<'a>(entry: &Entry<'a, '_>) -> Option<Meaning<'a>> {
    if let DeValue::Boolean(true) = entry.value {
        return Some(Meaning::Exit);
    }
    entry.faults.push(
        Fault::new(entry.value_place.clone(), "\"exit\" must be true")
            .help("write { exit = true }"),
    );
    None
}

//! Shapes: walls that do not fill their cell, as the legend defines them.

use toml::de::DeTable;

use super::reader::Reader;
use super::textures::Surface;
use crate::fault::document::Entry;
use crate::fault::{Fault, nearest, quoted};
use crate::world::{Heights, Line, Outline, PillarRadius, Shape, ShapeHeight};

const DEFAULT_RADIUS: PillarRadius = PillarRadius::new(0.3).expect("it fits a cell");

/// The places of a thin wall in its cell.
const PLACES: [(&str, Line); 6] = [
    ("north", Line::North),
    ("east", Line::East),
    ("south", Line::South),
    ("west", Line::West),
    ("east-west", Line::EastWest),
    ("north-south", Line::NorthSouth),
];

/// The corners where a diagonal begins.
const CORNERS: [(&str, Line); 4] = [
    ("north-west", Line::FromNorthWest),
    ("south-east", Line::FromNorthWest),
    ("north-east", Line::FromNorthEast),
    ("south-west", Line::FromNorthEast),
];

/// A shape as the legend defines it.
pub(crate) struct ShapeSymbol<'a> {
    outline: Outline,
    surface: Surface<'a>,
    height: Option<ShapeHeight>,
}

impl<'a> ShapeSymbol<'a> {
    /// Reads the shape in `entry` of `table`.
    pub(crate) fn read(entry: &Entry<'a, '_>, table: &DeTable<'_>) -> Option<Self> {
        let (addition, example) = match entry.key {
            "pillar" => ("radius", r#"{ pillar = "marble", radius = 0.3 }"#),
            "diagonal" => ("from", r#"{ diagonal = "brick", from = "north-west" }"#),
            _ => ("at", r#"{ thin = "wood", at = "north" }"#),
        };
        let surface = Surface::read(entry, example);
        let said = entry.entries(table).find(|entry| entry.key == addition);
        let outline = match (addition, said) {
            ("radius", None) => Some(Outline::Pillar(DEFAULT_RADIUS)),
            ("radius", Some(radius)) => read_radius(&radius).map(Outline::Pillar),
            ("from", Some(corner)) => {
                named(&corner, "corner", &CORNERS, example).map(Outline::Line)
            }
            (_, Some(place)) => {
                named(&place, "place in a cell", &PLACES, example).map(Outline::Line)
            }
            (_, None) => {
                let message = format!("a {} wall does not say where it is", entry.key);
                let fault = Fault::new(entry.key_place.clone(), message);
                entry.faults.push(
                    fault
                        .label(format!("{} is missing", quoted(addition)))
                        .help(format!("write, for example, {example}")),
                );
                None
            }
        };
        let height = entry.entries(table).find(|entry| entry.key == "height");
        let height = height.and_then(|height| read_height(&height));
        Some(Self { outline: outline?, surface: surface?, height })
    }

    /// The shape with its texture.
    pub(crate) fn shape(&self, reader: &mut Reader<'_>) -> Option<Shape> {
        let paint = reader.paint(&self.surface)?;
        Some(Shape { outline: self.outline, paint, height: self.height })
    }
}

fn read_radius(entry: &Entry<'_, '_>) -> Option<PillarRadius> {
    let radius = entry.number().and_then(PillarRadius::new);
    if radius.is_none() {
        let message = "the radius of a pillar is above 0 and at most 0.5, half a cell";
        entry.faults.push(Fault::new(entry.value_place.clone(), message).label("this is not"));
    }
    radius
}

fn read_height(entry: &Entry<'_, '_>) -> Option<ShapeHeight> {
    let height = entry.number().and_then(ShapeHeight::new);
    if height.is_none() {
        let most = Heights::MAX;
        let message = format!("the height of a shape is above 0 and at most {most} cells");
        entry.faults.push(Fault::new(entry.value_place.clone(), message).label("this is not"));
    }
    height
}

/// Reads the line that `entry` names: one of `lines`, each of which is a `what`.
fn named(entry: &Entry<'_, '_>, what: &str, lines: &[(&str, Line)], example: &str) -> Option<Line> {
    let name = entry.string(example)?;
    let line = lines.iter().find(|(known, _)| *known == name);
    if line.is_none() {
        let names: Vec<&str> = lines.iter().map(|&(name, _)| name).collect();
        let help = match nearest(name, &names) {
            Some(meant) => format!("the nearest is {}", quoted(meant)),
            None => format!("write one of {}", names.join(", ")),
        };
        let message = format!("{} is no {what}", quoted(name));
        entry.faults.push(Fault::new(entry.value_place.clone(), message).help(help));
    }
    line.map(|&(_, line)| line)
}

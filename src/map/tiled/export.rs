//! A Tiled map from a map file: each tile and each thing of the legend is a tile of one tileset,
//! with its keys as properties.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::FRAC_1_SQRT_2;

use font8x8::{BASIC_FONTS, UnicodeFonts};
use serde_json::{Value, json};
use toml::de::{DeTable, DeValue};

use super::classes::{CLASSES, ClassKind};
use super::properties::{CHARACTER, toml_value};
use super::{RecordedFiles, png};
use crate::color::Rgb;
use crate::fault::Faults;
use crate::fault::document::{self, FaultList};
use crate::map::{self, Level, TextureFiles, picture, things};
use crate::world::sprite::builtin as sprites;
use crate::world::texture::builtin as textures;
use crate::world::{Texture, ThingKind};

/// The side of a tile, in texels.
const SIDE: u32 = 32;
/// The number of tiles in a row of the tileset.
const COLUMNS: usize = 8;

/// A Tiled map.
#[derive(Debug)]
pub struct ExportedMap {
    /// The text of the map, in Tiled's JSON format.
    pub map: String,
    /// The PNG file with the tiles.
    pub tiles: Vec<u8>,
    /// The object types: the classes with their properties, for Tiled's editor of types.
    pub types: String,
    /// The PNG files that the map file names.
    pub pictures: BTreeMap<String, Vec<u8>>,
}

/// An entry of the legend.
struct LegendEntry<'d> {
    character: char,
    kind: ClassKind,
    keys: &'d DeTable<'d>,
}

/// Writes the map file `text`, which faults call `name`, as a Tiled map whose tiles are in the
/// file `tiles`. Textures come from `files`.
///
/// # Errors
/// All faults of the map file. A map of bodies is a fault too, because it has no grid.
pub fn export(
    text: &str,
    name: &str,
    tiles: &str,
    files: &dyn TextureFiles,
) -> Result<ExportedMap, Faults> {
    let files = RecordedFiles { files, read: RefCell::default() };
    if let Level::Space(_) = map::parse_level(text, name, &files)? {
        let message = format!("{name} is a map of bodies, but Tiled only has grids");
        return Err(Faults::of_whole_file(name, &message, "name a map with a grid"));
    }
    let document = document::parse(text, &FaultList::default());
    let symbols = symbols(&document);
    let pictures: Vec<Vec<[u8; 4]>> =
        symbols.iter().map(|symbol| symbol.picture(&document, &files)).collect();
    let map = tiled_map(&document, &symbols, text, tiles);
    let tiles = sheet(&symbols, pictures);
    let pictures = files.read.into_inner();
    Ok(ExportedMap {
        map: format!("{map:#}\n"),
        tiles,
        types: format!("{:#}\n", types()),
        pictures,
    })
}

fn entry<'d>(table: &'d DeTable<'d>, name: &str) -> Option<&'d DeValue<'d>> {
    table.iter().find(|(key, _)| key.get_ref() == name).map(|(_, value)| value.get_ref())
}

/// The legend of a map. A waypoint is a point of a line, and no tile.
fn symbols<'d>(document: &'d DeTable<'d>) -> Vec<LegendEntry<'d>> {
    let sections = [("tiles", ClassKind::Tile), ("things", ClassKind::Thing)];
    let symbols = sections.into_iter().flat_map(|(section, kind)| {
        let table = entry(document, section).and_then(DeValue::as_table);
        table.into_iter().flat_map(DeTable::iter).filter_map(move |(key, value)| {
            let (character, keys) = (key.get_ref().chars().next()?, value.get_ref().as_table()?);
            Some(LegendEntry { character, kind, keys })
        })
    });
    symbols.filter(|symbol| entry(symbol.keys, "waypoint").is_none()).collect()
}

fn tiled_map(
    document: &DeTable<'_>,
    symbols: &[LegendEntry<'_>],
    text: &str,
    tiles: &str,
) -> Value {
    let rows: Vec<Vec<char>> =
        map::rows_of_grid(text).iter().map(|row| row.chars().collect()).collect();
    let (width, height) = (rows.first().map_or(0, Vec::len), rows.len());
    let known: BTreeMap<char, (usize, &LegendEntry<'_>)> =
        (1..).zip(symbols).map(|(gid, symbol)| (symbol.character, (gid, symbol))).collect();
    let of = |character: char| known.get(&character).copied();
    let mut legend = BTreeMap::new();
    if let Some(things) = entry(document, "things").and_then(DeValue::as_table) {
        for (key, value) in things {
            legend.extend(key.get_ref().chars().next().zip(value.get_ref().as_table()));
        }
    }
    let tile = |character: char| match legend.get(&character) {
        Some(thing) => text_of(thing, "on").and_then(|tile| of(tile.chars().next()?)),
        None => of(character),
    };
    let data: Vec<usize> =
        rows.iter().flatten().map(|&it| tile(it).map_or(0, |(gid, _)| gid)).collect();
    let cells = || {
        let cells = rows.iter().enumerate();
        cells.flat_map(|(row, line)| line.iter().enumerate().map(move |(at, it)| (at, row, *it)))
    };
    let mut ids = 1..;
    let mut next = || ids.next().unwrap_or_default();
    let patrols: BTreeSet<&str> =
        symbols.iter().filter_map(|symbol| text_of(symbol.keys, "patrol")).collect();
    let lines: BTreeMap<&str, u32> = patrols.into_iter().map(|patrol| (patrol, next())).collect();
    let cell_of: BTreeMap<char, (usize, usize)> =
        cells().map(|(column, row, character)| (character, (column, row))).collect();
    let middle = |cell: usize| f64::from(SIDE) * (cell as f64 + 0.5);
    let line = |(patrol, id): (&&str, &u32)| {
        let points = patrol
            .chars()
            .filter_map(|it| cell_of.get(&it))
            .map(|&(column, row)| json!({ "x": middle(column), "y": middle(row) }));
        let points: Vec<Value> = points.collect();
        object(*id, json!({ "x": 0, "y": 0, "width": 0, "height": 0, "polyline": points }))
    };
    let lines_on_map: Vec<Value> = lines.iter().map(line).collect();
    let mut things = Vec::new();
    for (column, row, character) in cells() {
        let Some((gid, symbol)) = of(character).filter(|(_, it)| it.kind == ClassKind::Thing)
        else {
            continue;
        };
        let [x, y] = [column, row + 1].map(|cell| cell * SIDE as usize);
        let mut thing = json!({ "gid": gid, "x": x, "y": y, "width": SIDE, "height": SIDE });
        if let Some(line) = text_of(symbol.keys, "patrol").and_then(|it| lines.get(it)) {
            thing["properties"] = json!([{ "name": "patrol", "type": "object", "value": line }]);
        }
        things.push(object(next(), thing));
    }
    let layer = |id: u32, name: &str, mut content: Value| {
        merge(&mut content, json!({ "id": id, "name": name, "x": 0, "y": 0 }));
        merge(&mut content, json!({ "opacity": 1, "visible": true }));
        content
    };
    let objects = |id, name, objects: Vec<Value>| {
        let content = json!({ "type": "objectgroup", "draworder": "topdown", "objects": objects });
        layer(id, name, content)
    };
    let grid = json!({ "type": "tilelayer", "width": width, "height": height, "data": data });
    let whole =
        document.iter().filter(|(key, _)| !["grid", "tiles", "things"].contains(&&**key.get_ref()));
    json!({
        "type": "map",
        "version": "1.8",
        "orientation": "orthogonal",
        "renderorder": "right-down",
        "infinite": false,
        "width": width,
        "height": height,
        "tilewidth": SIDE,
        "tileheight": SIDE,
        "nextlayerid": 4,
        "nextobjectid": next(),
        "properties": whole.map(|(key, it)| property(key.get_ref(), it.get_ref())).collect::<Value>(),
        "layers": [layer(1, "tiles", grid), objects(2, "things", things), objects(3, "patrols", lines_on_map)],
        "tilesets": [tileset(symbols, tiles)],
    })
}

fn merge(object: &mut Value, other: Value) {
    if let (Value::Object(fields), Value::Object(other)) = (object, other) {
        fields.extend(other);
    }
}

fn object(id: u32, mut content: Value) -> Value {
    merge(
        &mut content,
        json!({ "id": id, "name": "", "type": "", "rotation": 0, "visible": true }),
    );
    content
}

fn tileset(symbols: &[LegendEntry<'_>], tiles: &str) -> Value {
    let tile = |(id, symbol): (usize, &LegendEntry<'_>)| {
        let keys =
            symbol.keys.iter().filter(|(key, _)| !["on", "patrol"].contains(&&**key.get_ref()));
        let keys = keys.map(|(key, value)| property(key.get_ref(), value.get_ref()));
        let character = json!({
            "name": CHARACTER, "type": "string", "value": symbol.character.to_string(),
        });
        let properties: Vec<Value> = keys.chain([character]).collect();
        json!({ "id": id, "type": symbol.class(), "properties": properties })
    };
    let rows = symbols.len().div_ceil(COLUMNS).max(1);
    json!({
        "firstgid": 1,
        "name": "cellcaster",
        "image": tiles,
        "imagewidth": COLUMNS * SIDE as usize,
        "imageheight": rows * SIDE as usize,
        "columns": COLUMNS,
        "tilecount": rows * COLUMNS,
        "tilewidth": SIDE,
        "tileheight": SIDE,
        "margin": 0,
        "spacing": 0,
        "tiles": symbols.iter().enumerate().map(tile).collect::<Value>(),
    })
}

/// A key of a map file as a property.
fn property(name: &str, value: &DeValue<'_>) -> Value {
    let number = |text: &str| text.parse::<f64>().ok();
    let (kind, value) = match value {
        DeValue::String(text) => ("string", json!(text)),
        DeValue::Boolean(value) => ("bool", json!(value)),
        DeValue::Integer(integer) => {
            let value = i64::from_str_radix(integer.as_str(), integer.radix()).unwrap_or_default();
            let kind = if i32::try_from(value).is_ok() { "int" } else { "float" };
            (kind, json!(value))
        }
        DeValue::Float(float) => ("float", json!(number(float.as_str()))),
        other => ("string", json!(toml_value(other))),
    };
    json!({ "name": name, "type": kind, "value": value })
}

/// The classes in the format of Tiled's object types.
fn types() -> Value {
    let property = |(name, value): &(&str, &str)| {
        let (kind, value) = match (value.strip_prefix('"'), value.parse::<f64>()) {
            (Some(text), _) => ("string", json!(text.trim_end_matches('"'))),
            (None, Ok(number)) => ("float", json!(number)),
            (None, Err(_)) => ("bool", json!(*value == "true")),
        };
        json!({ "name": name, "type": kind, "value": value })
    };
    let class = |class: &super::classes::Class| {
        let properties = [(class.name, class.value)];
        let properties = properties.iter().chain(class.others).map(property);
        let color = if class.kind == ClassKind::Thing { "#ffd0a040" } else { "#ff6080c0" };
        json!({ "name": class.name, "color": color, "properties": properties.collect::<Value>() })
    };
    CLASSES.iter().map(class).collect()
}

fn text_of<'d>(table: &'d DeTable<'d>, key: &str) -> Option<&'d str> {
    entry(table, key)?.as_str()
}

impl LegendEntry<'_> {
    /// The name of its class; empty for a floor.
    fn class(&self) -> &'static str {
        let mut classes = CLASSES.iter().filter(|class| class.kind == self.kind);
        let class = classes.find(|class| entry(self.keys, class.name).is_some());
        class.map_or("", |class| class.name)
    }

    /// The texels of its tile, row by row, of red, green, blue and alpha. A picture that cannot be
    /// shown is grey.
    fn picture(&self, document: &DeTable<'_>, files: &dyn TextureFiles) -> Vec<[u8; 4]> {
        match self.kind {
            ClassKind::Thing => fitted(self.sprite(files).as_ref()),
            ClassKind::Tile => self.tile(document, files),
        }
    }

    fn sprite(&self, files: &dyn TextureFiles) -> Option<Texture> {
        let class = self.class();
        let number = entry(self.keys, class).and_then(|value| match value {
            DeValue::Integer(integer) => integer.as_str().parse::<u16>().ok(),
            _ => None,
        });
        let name = match class {
            "start" => sprites::PLAYER,
            "exit" => sprites::EXIT,
            "treasure" => things::sprite_name(ThingKind::Treasure(number.unwrap_or_default())),
            "healing" => "heart",
            "sprite" | "guard" => text_of(self.keys, class)?,
            name => name,
        };
        if let Some(sprite) = sprites::named(name) {
            return sprite.pictures().first().cloned();
        }
        let sheet =
            picture::decode(&files.read(name).ok()?, &mut picture::PictureBudget::default())
                .ok()?;
        let parts = |key: &str| match entry(self.keys, key) {
            Some(DeValue::Integer(count)) => count.as_str().parse::<u32>().unwrap_or(1).max(1),
            _ => 1,
        };
        let [width, height] = sheet.size();
        let width = (width.get() / parts("frames")).try_into().unwrap_or(width);
        let height = (height.get() / parts("facings")).try_into().unwrap_or(height);
        Some(sheet.part(0, 0, width, height))
    }

    fn tile(&self, document: &DeTable<'_>, files: &dyn TextureFiles) -> Vec<[u8; 4]> {
        let class = self.class();
        let number = |key: &str| match entry(self.keys, key) {
            Some(DeValue::Float(float)) => float.as_str().parse::<f64>().ok(),
            _ => None,
        };
        let value = entry(self.keys, if class.is_empty() { "floor" } else { class });
        let [floor, ceiling] = ["floor", "ceiling"].map(|key| entry(self.keys, key));
        let surface = match class {
            "plate" => floor.map_or(Some(TileSurface::of("metal", files)), |it| surface(it, files)),
            "water" => {
                floor.map_or(Some(TileSurface::of("#1c4868", files)), |it| surface(it, files))
            }
            "mirror" => {
                Some(TileSurface::of(text_of(self.keys, class).unwrap_or("#b8c8d0"), files))
            }
            _ => value.or(ceiling).or(entry(document, "floor")).and_then(|it| surface(it, files)),
        };
        let surface = surface.unwrap_or(TileSurface::Color(Rgb::new(0x58, 0x58, 0x58)));
        let radius = number("radius").unwrap_or(0.3);
        let (at, from) = (text_of(self.keys, "at"), text_of(self.keys, "from"));
        let is_part = |x: f64, y: f64| match class {
            "pillar" => libm::hypot(x - 0.5, y - 0.5) <= radius,
            "thin" => {
                let distance = match at {
                    Some("north") => y,
                    Some("south") => 1.0 - y,
                    Some("west") => x,
                    Some("east") => 1.0 - x,
                    Some("north-south") => (x - 0.5).abs(),
                    _ => (y - 0.5).abs(),
                };
                distance < 0.13
            }
            "diagonal" => {
                let falls = matches!(from, Some("north-west" | "south-east"));
                let across = if falls { x - y } else { x + y - 1.0 };
                across.abs() * FRAC_1_SQRT_2 < 0.13
            }
            _ => true,
        };
        let opacity = if matches!(class, "glass" | "mirror") { 0xb0 } else { 0xff };
        texels(|x, y| {
            let (color, alpha) = surface.at(x, y);
            let [red, green, blue] = color.channels();
            [red, green, blue, if is_part(x, y) { alpha.min(opacity) } else { 0 }]
        })
    }
}

/// A surface of a tile.
enum TileSurface {
    Color(Rgb),
    Texture(Texture),
}

impl TileSurface {
    /// The surface with this name; black if there is none.
    fn of(name: &str, files: &dyn TextureFiles) -> Self {
        let texture = || {
            let bytes = files.read(name).ok()?;
            Some(picture::decode(&bytes, &mut picture::PictureBudget::default()).ok()?.texture())
        };
        match name.parse() {
            Ok(color) => Self::Color(color),
            Err(_) => textures::named(name)
                .or_else(texture)
                .map_or(Self::Color(Rgb::BLACK), Self::Texture),
        }
    }

    /// The colour and the alpha at a place from 0 to 1.
    fn at(&self, x: f64, y: f64) -> (Rgb, u8) {
        match self {
            Self::Color(color) => (*color, u8::MAX),
            Self::Texture(texture) => texel(texture, x, y),
        }
    }
}

/// The surface that a value of a key names, or the first of its pattern.
fn surface(value: &DeValue<'_>, files: &dyn TextureFiles) -> Option<TileSurface> {
    let name = match value {
        DeValue::Table(table) => {
            let pattern =
                ["texture", "checker", "stripes"].into_iter().find_map(|key| entry(table, key))?;
            match pattern {
                DeValue::Array(pair) => pair.iter().next()?.get_ref().as_str()?,
                name => name.as_str()?,
            }
        }
        name => name.as_str()?,
    };
    Some(TileSurface::of(name, files))
}

fn texel(texture: &Texture, x: f64, y: f64) -> (Rgb, u8) {
    let at = |place: f64, count: u32| ((place * f64::from(count)) as u32).min(count - 1);
    texture.texel(at(x, texture.width()), at(y, texture.height()))
}

/// The texels of a tile, row by row; `texel` is asked for places from 0 to 1.
fn texels(texel: impl Fn(f64, f64) -> [u8; 4]) -> Vec<[u8; 4]> {
    let middle = |at: u32| (f64::from(at) + 0.5) / f64::from(SIDE);
    let rows = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    rows.map(|(x, y)| texel(middle(x), middle(y))).collect()
}

/// A tile with a whole sprite that stands in its middle.
fn fitted(sprite: Option<&Texture>) -> Vec<[u8; 4]> {
    let Some(sprite) = sprite else { return texels(|_, _| [0x80, 0x80, 0x80, 0xff]) };
    let (width, height) = (f64::from(sprite.width()), f64::from(sprite.height()));
    let size = width.max(height);
    texels(|x, y| {
        let (x, y) = ((x - 0.5) * size / width + 0.5, (y - 1.0) * size / height + 1.0);
        if !(0.0..1.0).contains(&x) || !(0.0..1.0).contains(&y) {
            return [0; 4];
        }
        let (color, alpha) = texel(sprite, x, y);
        let [red, green, blue] = color.channels();
        [red, green, blue, alpha]
    })
}

/// The PNG file of the tiles. A tile that looks like an earlier one gets its character.
fn sheet(symbols: &[LegendEntry<'_>], mut pictures: Vec<Vec<[u8; 4]>>) -> Vec<u8> {
    let mut seen = BTreeSet::new();
    for (symbol, picture) in symbols.iter().zip(&mut pictures) {
        if !seen.insert(picture.clone()) {
            mark(picture, symbol.character);
        }
    }
    let rows = symbols.len().div_ceil(COLUMNS).max(1);
    let width = COLUMNS * SIDE as usize;
    let mut texels = vec![0; width * rows * SIDE as usize * 4];
    for (index, picture) in pictures.iter().enumerate() {
        let left = index % COLUMNS * SIDE as usize;
        let top = index / COLUMNS * SIDE as usize;
        for (y, row) in picture.chunks(SIDE as usize).enumerate() {
            let start = ((top + y) * width + left) * 4;
            texels[start..start + row.len() * 4].copy_from_slice(row.as_flattened());
        }
    }
    png([width as u32, (rows * SIDE as usize) as u32], &texels)
}

/// Draws `character` into the lower right corner of a tile.
fn mark(picture: &mut [[u8; 4]], character: char) {
    let glyph = BASIC_FONTS.get(character).or_else(|| BASIC_FONTS.get('?')).unwrap_or_default();
    let corner = SIDE as usize - 10;
    for (y, row) in picture.chunks_mut(SIDE as usize).enumerate().skip(corner) {
        for (x, texel) in row.iter_mut().enumerate().skip(corner) {
            let line = (y - corner).checked_sub(1).and_then(|at| glyph.get(at)).copied();
            let column = (x - corner).checked_sub(1).filter(|at| *at < 8);
            let is_lit = line.zip(column).is_some_and(|(line, column)| line >> column & 1 == 1);
            *texel = if is_lit { [0xff; 4] } else { [0, 0, 0, 0xff] };
        }
    }
}

//! A Tiled map: its layers with the tiles and the objects on them, and its tilesets.
//!
//! Layers in groups are as good as layers outside. Flips of tiles are left out.

use std::collections::BTreeMap;
use std::io::Read;
use std::rc::Rc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD_NO_PAD;
use flate2::read::{GzDecoder, ZlibDecoder};
use serde_json::Value;

use super::document;
use super::properties::{Properties, Property};
use crate::fault::{Fault, Faults, quoted};
use crate::map::files::{TextureFileError, TextureFiles, stays_inside};

/// The largest number of cells of a map, summed over its tile layers.
pub(crate) const MAX_CELLS: usize = 1 << 22;
/// The bits of a tile's number that say how it is flipped.
const FLIPS: u32 = 0xf000_0000;

pub(crate) struct TiledMap {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// The width and height of a cell, in the units of objects.
    pub(crate) cell: [f64; 2],
    pub(crate) properties: Properties,
    pub(crate) layers: Vec<TiledLayer>,
    tilesets: Vec<TiledTileset>,
}

pub(crate) struct TiledLayer {
    pub(crate) name: String,
    /// The place of faults.
    pub(crate) origin: Rc<str>,
    pub(crate) properties: Properties,
    pub(crate) content: Content,
}

pub(crate) enum Content {
    /// The number of the tile in each cell, row by row; 0 for none.
    Tiles(Vec<u32>),
    Objects(Vec<Object>),
}

pub(crate) struct Object {
    pub(crate) id: u64,
    pub(crate) origin: Rc<str>,
    pub(crate) class: String,
    pub(crate) properties: Properties,
    /// The number of the tile that it shows; 0 for none.
    pub(crate) tile: u32,
    /// The first corner, and the opposite corner, which is just outside the object.
    pub(crate) corners: [[f64; 2]; 2],
    /// The points of a polyline or a polygon; empty for any other object.
    pub(crate) points: Vec<[f64; 2]>,
    /// `true` for a text on the map.
    pub(crate) is_text: bool,
}

struct TiledTileset {
    first: u32,
    name: String,
    tiles: BTreeMap<u32, TilesetTile>,
    /// The image that all tiles are parts of.
    sheet: Option<TileSheet>,
}

struct TileSheet {
    image: String,
    columns: u32,
    /// The number of tiles.
    count: u32,
    /// The width and the height of a tile, in texels.
    size: [u32; 2],
    margin: u32,
    spacing: u32,
}

#[derive(Clone, Default)]
struct TilesetTile {
    class: String,
    properties: Properties,
    image: Option<String>,
}

/// A tile of a tileset.
pub(crate) struct TileView {
    pub(crate) origin: Rc<str>,
    pub(crate) class: String,
    pub(crate) properties: Properties,
    pub(crate) picture: Option<TilePicture>,
}

/// The picture of a tile.
pub(crate) enum TilePicture {
    /// A whole file.
    File(String),
    Region(SheetRegion),
}

/// A rectangle of a PNG file, with its left upper corner and its size in texels.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct SheetRegion {
    pub(crate) file: String,
    pub(crate) at: [u32; 2],
    pub(crate) size: [u32; 2],
}

/// A fault of the map, or the faults of another file that it names.
pub(crate) enum TiledError {
    InMap(Fault),
    InOtherFile(Faults),
}

impl From<Fault> for TiledError {
    fn from(fault: Fault) -> Self {
        Self::InMap(fault)
    }
}

/// Fields of a tree. A number may be written as text, as XML has it.
trait Fields {
    fn text(&self, key: &str) -> &str;
    fn number(&self, key: &str) -> f64;
    fn list(&self, key: &str) -> &[Value];

    /// A number as a count: at least 0.
    fn count(&self, key: &str) -> u32 {
        self.number(key) as u32
    }

    /// The class of a tile or an object: different versions of Tiled have different keys for it.
    fn class(&self) -> String {
        let class = ["class", "type"].map(|key| self.text(key));
        class.into_iter().find(|class| !class.is_empty()).unwrap_or_default().to_owned()
    }
}

impl Fields for Value {
    fn text(&self, key: &str) -> &str {
        self.get(key).and_then(Self::as_str).unwrap_or_default()
    }

    fn number(&self, key: &str) -> f64 {
        let number = self.get(key).map(|value| match value {
            Self::String(text) => text.trim().parse().unwrap_or_default(),
            value => value.as_f64().unwrap_or_default(),
        });
        number.filter(|number| number.is_finite()).unwrap_or_default()
    }

    fn list(&self, key: &str) -> &[Value] {
        self.get(key).and_then(Self::as_array).map_or(&[], Vec::as_slice)
    }
}

impl TiledMap {
    /// Reads the map in `root`. Tilesets come from `files`.
    pub(crate) fn read(root: &Value, files: &dyn TextureFiles) -> Result<Self, TiledError> {
        let fault = |message: &str, help: &str| Fault::at(MAP, message).help(help);
        if !matches!(root.text("orientation"), "" | "orthogonal") {
            let help = "make a new map, of the orientation Orthogonal";
            return Err(fault("a level is seen from straight above", help).into());
        }
        let is_infinite = root.get("infinite").is_some_and(|it| *it != false && *it != "0");
        if is_infinite {
            let help = "clear Infinite in Map > Map Properties";
            return Err(fault("the map is infinite, but a level has a size", help).into());
        }
        let (width, height) = (root.count("width") as usize, root.count("height") as usize);
        let cell = [root.number("tilewidth"), root.number("tileheight")];
        if width == 0 || height == 0 || cell.iter().any(|side| *side <= 0.0) {
            return Err(fault("the map has no cells", "give it a width and a height").into());
        }
        if width.saturating_mul(height) > MAX_CELLS {
            return Err(too_large(MAP).into());
        }
        let properties = Properties::read(root.list("properties"), MAP, &MAP.into())?;
        let tilesets = root.list("tilesets").iter().map(|it| TiledTileset::read(it, files));
        let mut map = Self {
            width,
            height,
            cell,
            properties,
            layers: Vec::new(),
            tilesets: tilesets.collect::<Result<_, TiledError>>()?,
        };
        map.tilesets.sort_by_key(|tileset| tileset.first);
        let mut cells_left = MAX_CELLS;
        map.read_layers(root, &mut cells_left)?;
        Ok(map)
    }

    /// Reads the layers in `owner`, a map or a group. The depth of groups is limited, as in any
    /// [`document`].
    fn read_layers(&mut self, owner: &Value, cells_left: &mut usize) -> Result<(), Fault> {
        for layer in owner.list("layers") {
            let name = layer.text("name");
            let origin: Rc<str> = format!("layer {}", quoted(name)).into();
            let content = match layer.text("type") {
                "group" => {
                    self.read_layers(layer, cells_left)?;
                    continue;
                }
                "tilelayer" => {
                    let count = self.width * self.height;
                    *cells_left =
                        cells_left.checked_sub(count).ok_or_else(|| too_large(&origin))?;
                    let tiles = tiles(layer, count).map_err(|reason| {
                        let fault = Fault::at(&*origin, format!("the tiles {reason}"));
                        fault.help(
                            "choose the format CSV in Map > Map Properties, and save the map again",
                        )
                    })?;
                    Content::Tiles(tiles)
                }
                "objectgroup" => {
                    let objects = layer.list("objects").iter();
                    let objects = objects.map(|object| Object::read(object, &origin));
                    Content::Objects(objects.collect::<Result<_, Fault>>()?)
                }
                _ => continue,
            };
            let properties = Properties::read(layer.list("properties"), MAP, &origin)?;
            self.layers.push(TiledLayer { name: name.to_owned(), origin, properties, content });
        }
        Ok(())
    }

    /// The tile with the number `gid`; `None` if no tileset has it.
    pub(crate) fn tile(&self, gid: u32) -> Option<TileView> {
        let after = self.tilesets.partition_point(|tileset| tileset.first <= gid);
        let tileset = &self.tilesets[after.checked_sub(1)?];
        let id = gid - tileset.first;
        let tile = tileset.tiles.get(&id);
        let (tile, picture) = match (tile, &tileset.sheet) {
            (Some(TilesetTile { image: Some(image), .. }), _) => {
                (tile.cloned(), Some(TilePicture::File(image.clone())))
            }
            (_, Some(sheet)) if id < sheet.count => (tile.cloned(), Some(sheet.part(id))),
            (None, _) => return None,
            _ => (tile.cloned(), None),
        };
        let TilesetTile { class, properties, .. } = tile.unwrap_or_default();
        let origin = format!("tile {id} of the tileset {}", quoted(&tileset.name)).into();
        Some(TileView { origin, class, properties, picture })
    }
}

/// The place of faults of the whole map.
pub(crate) const MAP: &str = "the map";

fn too_large(origin: &str) -> Fault {
    let message = format!("a map has at most {MAX_CELLS} cells, summed over its tile layers");
    Fault::at(origin, message).help("make the map smaller, or leave layers out")
}

/// The `count` tiles of a layer; or a reason why not, to follow "the tiles".
fn tiles(layer: &Value, count: usize) -> Result<Vec<u32>, String> {
    let number = |value: &Value| match value {
        Value::String(text) => text.trim().parse().ok(),
        value => value.as_u64().and_then(|gid| u32::try_from(gid).ok()),
    };
    let tiles: Option<Vec<u32>> = match (layer.get("data"), layer.text("encoding")) {
        (Some(Value::Array(list)), _) => list.iter().take(count + 1).map(number).collect(),
        (Some(Value::String(text)), "csv") => {
            let tiles = text.split(',').take(count + 1);
            tiles.map(|gid| gid.trim().parse().ok()).collect()
        }
        (Some(Value::String(text)), "base64") => {
            let bytes = base64(text).ok_or("are not valid base64")?;
            let bytes = unpacked(&bytes, layer.text("compression"), count * 4)?;
            let (tiles, rest) = bytes.as_chunks();
            let tiles = tiles.iter().copied().map(u32::from_le_bytes);
            rest.is_empty().then(|| tiles.collect())
        }
        _ => Some(layer.list("tiles").iter().map(|tile| tile.count("gid")).collect()),
    };
    let mut tiles = tiles.ok_or("are not all numbers")?;
    if tiles.len() != count {
        return Err(format!("do not match the map's {count} cells"));
    }
    for gid in &mut tiles {
        *gid &= !FLIPS;
    }
    Ok(tiles)
}

/// The unpacked content of `bytes`, up to four bytes more than `size`.
fn unpacked(bytes: &[u8], compression: &str, size: usize) -> Result<Vec<u8>, String> {
    let mut content = Vec::new();
    let limit = size as u64 + 4;
    let read = match compression {
        "" => bytes.take(limit).read_to_end(&mut content),
        "zlib" => ZlibDecoder::new(bytes).take(limit).read_to_end(&mut content),
        "gzip" => GzDecoder::new(bytes).take(limit).read_to_end(&mut content),
        other => {
            return Err(format!("are compressed with {}, which is not supported", quoted(other)));
        }
    };
    read.map_err(|_| "are truncated".to_owned())?;
    Ok(content)
}

/// The bytes that `text` encodes, with or without padding.
fn base64(text: &str) -> Option<Vec<u8>> {
    let is_digit = |byte: &u8| !byte.is_ascii_whitespace() && *byte != b'=';
    STANDARD_NO_PAD.decode(text.bytes().filter(is_digit).collect::<Vec<u8>>()).ok()
}

impl Object {
    fn read(object: &Value, layer: &str) -> Result<Self, Fault> {
        let id = object.number("id") as u64;
        let name = match object.text("name") {
            "" => String::new(),
            name => format!(" {}", quoted(name)),
        };
        let origin: Rc<str> = format!("object {id}{name} on {layer}").into();
        if object.get("template").is_some() {
            let fault = Fault::at(&*origin, "the object is an instance of a template");
            return Err(fault.help("choose Detach in the menu of the object"));
        }
        let tile = object.number("gid") as u32 & !FLIPS;
        let [x, y] = ["x", "y"].map(|key| object.number(key));
        let [width, height] = ["width", "height"].map(|key| object.number(key).max(0.0));
        // An object that shows a tile has its place at the lower left corner, any other at the upper.
        let [above, below] = if tile == 0 { [0.0, height] } else { [-height, 0.0] };
        let (sin, cos) = object.number("rotation").to_radians().sin_cos();
        let turned = |by: [f64; 2]| [x + by[0] * cos - by[1] * sin, y + by[0] * sin + by[1] * cos];
        let turned_corners =
            [[0.0, above], [width, above], [0.0, below], [width, below]].map(turned);
        let points = ["polyline", "polygon"].into_iter().find_map(|key| points(object.get(key)?));
        let points: Vec<[f64; 2]> = points.unwrap_or_default().into_iter().map(turned).collect();
        let corners = if points.is_empty() { turned_corners.to_vec() } else { points.clone() };
        let least = |axis: usize| corners.iter().map(|it| it[axis]).fold(f64::MAX, f64::min);
        let most = |axis: usize| corners.iter().map(|it| it[axis]).fold(f64::MIN, f64::max);
        let corners = [[least(0), least(1)], [most(0), most(1)]];
        Ok(Self {
            id,
            class: object.class(),
            properties: Properties::read(object.list("properties"), "", &origin)?,
            origin,
            tile,
            corners,
            points,
            is_text: object.get("text").is_some(),
        })
    }
}

/// The points of a polyline: a list, or pairs of numbers in a text.
fn points(value: &Value) -> Option<Vec<[f64; 2]>> {
    if let Value::Array(points) = value {
        return Some(points.iter().map(|point| [point.number("x"), point.number("y")]).collect());
    }
    let pairs = value.as_str()?.split_whitespace().map(|pair| {
        let (x, y) = pair.split_once(',')?;
        Some([x.parse().ok()?, y.parse().ok()?])
    });
    pairs.collect()
}

impl TiledTileset {
    fn read(entry: &Value, files: &dyn TextureFiles) -> Result<Self, TiledError> {
        let first = entry.count("firstgid");
        let source = entry.text("source");
        if source.is_empty() {
            return Ok(Self { first, ..Self::of(entry, "")? });
        }
        let origin = format!("the tileset {}", quoted(source));
        let fault = |message: String| Fault::at(&*origin, message);
        let path = beside("", source).ok_or_else(|| fault(OUTSIDE.to_owned()).help(COPY))?;
        let bytes = files.read(&path).map_err(|error: TextureFileError| {
            fault(format!("{path} {error}")).help("copy the tileset beside the map")
        })?;
        let text = Faults::text_of(bytes, &path, "tileset").map_err(TiledError::InOtherFile)?;
        let tileset = document::parse(&text, &path).map_err(TiledError::InOtherFile)?;
        let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
        Ok(Self { first, ..Self::of(&tileset, folder)? })
    }

    /// Reads a tileset whose images are named from `folder`.
    fn of(tileset: &Value, folder: &str) -> Result<Self, Fault> {
        let name = tileset.text("name");
        let origin: Rc<str> = format!("the tileset {}", quoted(name)).into();
        let image = |owner: &Value| match owner.text("image") {
            "" => Ok(None),
            image => beside(folder, image).map(Some).ok_or_else(|| {
                let message = format!("{} is {OUTSIDE}", quoted(image));
                Fault::at(&*origin, message).help(COPY)
            }),
        };
        let size = ["tilewidth", "tileheight"].map(|key| tileset.count(key));
        let sheet = image(tileset)?.map(|image| TileSheet {
            image,
            columns: tileset.count("columns").max(1),
            count: tileset.count("tilecount"),
            size,
            margin: tileset.count("margin"),
            spacing: tileset.count("spacing"),
        });
        let mut tiles = BTreeMap::new();
        for tile in tileset.list("tiles") {
            let id = tile.count("id");
            let origin = format!("tile {id} of {origin}").into();
            let properties = Properties::read(tile.list("properties"), folder, &origin)?;
            tiles.insert(id, TilesetTile { class: tile.class(), properties, image: image(tile)? });
        }
        Ok(Self { first: 0, name: name.to_owned(), tiles, sheet })
    }
}

impl TileSheet {
    fn part(&self, id: u32) -> TilePicture {
        let place = [id % self.columns, id / self.columns];
        let at = [0, 1].map(|axis| {
            let step = self.size[axis].saturating_add(self.spacing);
            place[axis].saturating_mul(step).saturating_add(self.margin)
        });
        TilePicture::Region(SheetRegion { file: self.image.clone(), at, size: self.size })
    }
}

const OUTSIDE: &str = "not a file in the map's folder";
const COPY: &str = "copy the file beside the map, and choose it again there";

/// The name of the file that is called `name` in `folder`, from the map's folder; `None` if it is
/// outside.
pub(crate) fn beside(folder: &str, name: &str) -> Option<String> {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in name.split('/') {
        match part {
            "." => {}
            ".." => _ = parts.pop()?,
            part => parts.push(part),
        }
    }
    let name = parts.join("/");
    stays_inside(&name).then_some(name)
}

impl Property {
    /// The number of the object that it refers to, if it is a reference.
    pub(crate) fn object(&self) -> Option<u64> {
        match self {
            Self::Object(id) => Some(*id),
            _ => None,
        }
    }
}

//! The tiles and the things of a Tiled map, as the text of a map file.
//!
//! Each cell has the tiles of all layers and the objects that cover it, from the bottom to the top.
//! Cells with the same ones share a character, and so do things with the same keys on the same
//! floor.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::mem;
use std::rc::Rc;

use super::classes::{self, ClassKind, FLOORS, FULL, GROUND, PICTURED, SOLID};
use super::legend::{Characters, Definition};
use super::model::{
    Content, MAP, MAX_CELLS, Object, SheetRegion, TilePicture, TileView, TiledLayer, TiledMap,
};
use super::properties::Property;
use super::text::{GridOrigins, MapWriter, Translation};
use crate::fault::document::toml_string;
use crate::fault::{Fault, nearest_or_all, quoted};
use crate::map::keys::CharacterTable;

/// The largest number of stacks in the cells of a map: more than a map file may have kinds of tile.
const MAX_STACKS: usize = 4096;
/// The largest number of items in all these stacks.
const MAX_ITEMS: usize = 100_000;
/// The largest number of things.
const MAX_THINGS: usize = 1 << 16;
/// The largest number of points of a patrol, as in map files.
const MAX_PATROL: usize = 64;

/// An item of a stack: the tile of a layer, or an object.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Item {
    Tile(u32),
    Object(usize),
}

/// A thing in a cell.
struct PlacedThing {
    definition: Definition,
    origin: Rc<str>,
    patrol: Patrol,
}

/// The way of a guard.
enum Patrol {
    None,
    /// An object with this number.
    Of(u64),
    Cells(Vec<usize>),
}

/// A polyline that is nothing else.
struct Polyline<'m> {
    object: &'m Object,
    cells: Vec<usize>,
    is_walked: bool,
}

struct Translator<'m> {
    map: &'m TiledMap,
    faults: RefCell<Vec<Fault>>,
    reported: RefCell<BTreeSet<(String, String)>>,
    tiles: BTreeMap<u32, Option<Rc<TileView>>>,
    parts: BTreeMap<String, SheetRegion>,
    /// The stack below, the layer, and the item on top. The first one is empty.
    stacks: Vec<(u32, usize, Item)>,
    known: BTreeMap<(u32, usize, Item), u32>,
    /// The stack of each cell.
    cells: Vec<u32>,
    things: BTreeMap<usize, PlacedThing>,
    characters: Characters,
}

/// Translates `map` into the text of a map file.
///
/// # Errors
/// Faults that only Tiled's file can have. The reader of map files finds the others.
pub(crate) fn translate(map: &TiledMap) -> Result<Translation, Vec<Fault>> {
    let mut translator = Translator {
        map,
        faults: RefCell::default(),
        reported: RefCell::default(),
        tiles: BTreeMap::new(),
        parts: BTreeMap::new(),
        stacks: vec![(0, 0, Item::Tile(0))],
        known: BTreeMap::new(),
        cells: vec![0; map.width * map.height],
        things: BTreeMap::new(),
        characters: Characters::default(),
    };
    translator.lay_tiles();
    translator.place_objects();
    let translation = translator.write();
    let faults = translator.faults.take();
    if faults.is_empty() { Ok(translation) } else { Err(faults) }
}

impl<'m> Translator<'m> {
    /// Reports a fault, once.
    fn fault(&self, origin: &str, message: impl Into<String>, help: impl Into<String>) {
        let message = message.into();
        if self.reported.borrow_mut().insert((origin.to_owned(), message.clone())) {
            self.faults.borrow_mut().push(Fault::at(origin, message).help(help));
        }
    }

    fn layers(&self) -> impl Iterator<Item = (usize, &'m TiledLayer)> + use<'m> {
        self.map.layers.iter().enumerate()
    }

    /// The tile with the number `gid`. Reports a number without a tile once.
    fn tile(&mut self, gid: u32, origin: &str) -> Option<Rc<TileView>> {
        if let Some(tile) = self.tiles.get(&gid) {
            return tile.clone();
        }
        let tile = self.map.tile(gid).map(Rc::new);
        if tile.is_none() {
            let help = "draw there with a tile of a tileset in this map";
            self.fault(origin, format!("no tileset has the tile {gid}"), help);
        }
        self.tiles.insert(gid, tile.clone());
        tile
    }

    /// The name of the PNG file with a picture.
    fn picture(&mut self, picture: &TilePicture) -> String {
        let part = match picture {
            TilePicture::File(file) => return file.clone(),
            TilePicture::Region(part) => part,
        };
        let SheetRegion { file, at, size } = part;
        let stem = file.rsplit_once('.').map_or(&**file, |(stem, _)| stem);
        let mut name = format!("{stem}-{}-{}.png", at[0], at[1]);
        if self.parts.get(&name).is_some_and(|known| known != part) {
            name = format!("{stem}-{}-{}-{}-{}.png", at[0], at[1], size[0], size[1]);
        }
        self.parts.insert(name.clone(), part.clone());
        name
    }

    /// Lays the tiles of all layers into the cells. A tile of a thing stands in its cell.
    fn lay_tiles(&mut self) {
        for (index, layer) in self.layers() {
            let Content::Tiles(tiles) = &layer.content else { continue };
            let mut last = (0, None);
            for (cell, &gid) in tiles.iter().enumerate().filter(|(_, gid)| **gid != 0) {
                let width = self.map.width;
                let origin = || {
                    let (column, row) = (cell % width, cell / width);
                    Rc::<str>::from(format!("{}, cell {column},{row}", layer.origin))
                };
                if last.0 != gid {
                    let origin = origin();
                    last = (gid, self.thing_on(gid, &origin));
                }
                match &last.1 {
                    Some(definition) => {
                        let (definition, origin) = (definition.clone(), origin());
                        self.stand(cell, PlacedThing { definition, origin, patrol: Patrol::None });
                    }
                    None => self.put(cell, index, Item::Tile(gid)),
                }
            }
        }
    }

    /// The thing that a tile is; `None` if it is none.
    fn thing_on(&mut self, gid: u32, origin: &Rc<str>) -> Option<Definition> {
        let tile = self.tile(gid, origin)?;
        if !classes::is_thing(&tile.class, |key| tile.properties.0.contains_key(key)) {
            return None;
        }
        let mut definition = Definition::default();
        definition.take(&tile.properties, &tile.origin);
        self.add_class(&mut definition, &tile.class, Some(&*tile), origin);
        Some(definition)
    }

    /// Lets a thing stand in a cell, if nothing else does.
    fn stand(&mut self, cell: usize, thing: PlacedThing) {
        if self.things.len() >= MAX_THINGS {
            let message = format!("the map has more than {MAX_THINGS} things");
            return self.fault(MAP, message, "draw fewer of them");
        }
        if let Some(other) = self.things.get(&cell) {
            let message = format!("its cell has another thing, {}", other.origin);
            return self.fault(&thing.origin, message, "move one of the two");
        }
        self.things.insert(cell, thing);
    }

    fn put(&mut self, cell: usize, layer: usize, item: Item) {
        let stack = (self.cells[cell], layer, item);
        let next = self.stacks.len() as u32;
        let id = *self.known.entry(stack).or_insert(next);
        self.cells[cell] = id;
        if id == next {
            self.stacks.push(stack);
        }
    }

    fn place_objects(&mut self) {
        let mut lines: Vec<Polyline<'m>> = Vec::new();
        let mut cells_left = MAX_CELLS;
        for (index, layer) in self.layers() {
            let Content::Objects(objects) = &layer.content else { continue };
            for (number, object) in objects.iter().enumerate().filter(|(_, it)| !it.is_text) {
                let Some((definition, kind)) = self.definition(object) else { continue };
                match kind {
                    Some(ClassKind::Thing) => self.place_thing(object, definition),
                    Some(ClassKind::Tile) => {
                        let cells = self.covered(object);
                        cells_left = cells_left.saturating_sub(cells.len());
                        if cells_left == 0 {
                            let message = format!("the objects cover more than {MAX_CELLS} cells");
                            return self.fault(&object.origin, message, "use a layer of tiles");
                        }
                        for cell in cells {
                            self.put(cell, index, Item::Object(number));
                        }
                    }
                    None => {
                        let cells = self.cells_of_points(object);
                        lines.push(Polyline { object, cells, is_walked: false });
                    }
                }
            }
        }
        self.find_patrols(&mut lines);
        for line in lines.iter().filter(|line| !line.is_walked) {
            let help =
                "let it begin in the cell of a guard, or name it in the guard's property patrol";
            self.fault(&line.object.origin, "no guard walks along this line", help);
        }
    }

    /// The keys of an object and its use; no use for a line that is only a way. Reports an
    /// object that says nothing.
    fn definition(&mut self, object: &Object) -> Option<(Definition, Option<ClassKind>)> {
        let tile = match object.tile {
            0 => None,
            gid => Some(self.tile(gid, &object.origin)?),
        };
        let mut definition = Definition::default();
        if let Some(tile) = &tile {
            definition.take(&tile.properties, &tile.origin);
        }
        definition.take(&object.properties, &object.origin);
        let class = tile.as_ref().map_or("", |tile| &*tile.class);
        let class = if object.class.is_empty() { class } else { &object.class };
        let made = self.add_class(&mut definition, class, tile.as_deref(), &object.origin)?;
        let is_thing = classes::is_thing("", |key| definition.keys.contains_key(key));
        let is_tile = definition.has(&SOLID) || definition.has(&FLOORS);
        let picture = tile.as_ref().and_then(|tile| tile.picture.as_ref());
        let kind = match (made, picture) {
            (Some(kind), _) => kind,
            (None, _) if is_thing => ClassKind::Thing,
            (None, Some(picture)) if !is_tile => {
                let picture = toml_string(&self.picture(picture));
                definition.set("sprite", picture, &object.origin);
                ClassKind::Thing
            }
            (None, _) if !definition.keys.is_empty() => ClassKind::Tile,
            (None, _) if !object.points.is_empty() => return Some((definition, None)),
            (None, _) => {
                let help =
                    "give it a class, such as start, exit, guard, sprite or note, or delete it";
                self.fault(&object.origin, "the object has no class and no property", help);
                return None;
            }
        };
        Some((definition, Some(kind)))
    }

    /// Adds the value of a class to a definition, unless it has one. Returns the use of
    /// the class, if there is a class; `None` after a fault.
    #[expect(clippy::option_option, reason = "a fault, no class, and a class")]
    fn add_class(
        &mut self,
        definition: &mut Definition,
        class: &str,
        tile: Option<&TileView>,
        origin: &Rc<str>,
    ) -> Option<Option<ClassKind>> {
        if matches!(class, "" | "patrol") {
            return Some(None);
        }
        let (class, value) = if let Some(class) = classes::named(class) {
            let picture = tile.and_then(|tile| tile.picture.as_ref());
            match picture.filter(|_| PICTURED.contains(&class.name)) {
                Some(picture) => (class, toml_string(&self.picture(picture))),
                None => (class, class.value.to_owned()),
            }
        } else if let Some((class, value)) = classes::of_kind(class) {
            (class, toml_string(value))
        } else {
            let names: Vec<&str> = classes::CLASSES.iter().map(|class| class.name).collect();
            let help = nearest_or_all(class, &names, "the nearest class is", "choose one of");
            self.fault(origin, format!("there is no class {}", quoted(class)), help);
            return None;
        };
        for (key, value) in [(class.name, value.as_str())].iter().chain(class.others) {
            let is_required = *key == class.name || class.kind == ClassKind::Tile;
            if is_required && !definition.keys.contains_key(*key) {
                definition.set(key, (*value).to_owned(), origin);
            }
        }
        Some(Some(class.kind))
    }

    fn place_thing(&mut self, object: &'m Object, mut definition: Definition) {
        let origin = object.origin.clone();
        let patrol = object.properties.0.get("patrol").and_then(Property::object);
        let mut patrol = patrol.map_or(Patrol::None, Patrol::Of);
        let middle =
            [0, 1].map(|axis| f64::midpoint(object.corners[0][axis], object.corners[1][axis]));
        let place = object.points.first().copied().unwrap_or(middle);
        if !object.points.is_empty() && definition.has(&["guard"]) {
            patrol = Patrol::Cells(self.cells_of_points(object));
        }
        if !matches!(patrol, Patrol::None) {
            definition.keys.remove("patrol");
        }
        let Some(cell) = self.cell(place) else {
            return self.fault(
                &origin,
                "the object is outside the map",
                "move it into a cell, or delete it",
            );
        };
        self.stand(cell, PlacedThing { definition, origin, patrol });
    }

    /// The cell at a place of the map; `None` outside.
    fn cell(&self, place: [f64; 2]) -> Option<usize> {
        let [column, row] = [0, 1].map(|axis| (place[axis] / self.map.cell[axis]).floor());
        let is_inside = (0.0..self.map.width as f64).contains(&column)
            && (0.0..self.map.height as f64).contains(&row);
        is_inside.then(|| row as usize * self.map.width + column as usize)
    }

    /// The cells whose middle is in the rectangle around an object; at least the cell of its own
    /// middle.
    fn covered(&self, object: &Object) -> Vec<usize> {
        let [least, most] = object.corners;
        let range = |axis: usize, count: usize| {
            let side = self.map.cell[axis];
            let first = (least[axis] / side - 0.5).ceil().max(0.0) as usize;
            let end = ((most[axis] / side - 0.5).floor() + 1.0).max(0.0) as usize;
            first..end.min(count)
        };
        let (columns, rows) = (range(0, self.map.width), range(1, self.map.height));
        if columns.is_empty() || rows.is_empty() {
            let middle = [0, 1].map(|axis| f64::midpoint(least[axis], most[axis]));
            return self.cell(middle).into_iter().collect();
        }
        let width = self.map.width;
        rows.flat_map(|row| columns.clone().map(move |column| row * width + column)).collect()
    }

    /// The cells of the points of a polyline. Reports a point outside the map.
    fn cells_of_points(&self, object: &Object) -> Vec<usize> {
        let count = object.points.len();
        if count > MAX_PATROL {
            let message =
                format!("the line has {count} points, but a patrol has at most {MAX_PATROL}");
            self.fault(&object.origin, message, "leave some out; a guard finds the way");
            return Vec::new();
        }
        let cells = object.points.iter().map(|point| self.cell(*point));
        let cells: Option<Vec<usize>> = cells.collect();
        cells.unwrap_or_else(|| {
            self.fault(&object.origin, "the line leaves the map", "move its points into cells");
            Vec::new()
        })
    }

    /// Finds the cells of each patrol. A line that no guard names belongs to the guard in the cell
    /// where it begins.
    fn find_patrols(&mut self, lines: &mut [Polyline<'m>]) {
        for thing in self.things.values_mut() {
            let Patrol::Of(id) = thing.patrol else { continue };
            let Some(line) = lines.iter_mut().find(|line| line.object.id == id) else {
                let fault = Fault::at(
                    &*thing.origin,
                    format!("its patrol is object {id}, which is not a line"),
                );
                self.faults
                    .borrow_mut()
                    .push(fault.help("draw a polyline, and choose it as the patrol"));
                continue;
            };
            line.is_walked = true;
            thing.patrol = Patrol::Cells(line.cells.clone());
        }
        for line in lines.iter_mut().filter(|line| !line.is_walked) {
            let guard = line.cells.first().and_then(|cell| self.things.get_mut(cell));
            let idle = guard.filter(|thing| {
                thing.definition.has(&["guard"])
                    && !thing.definition.has(&["patrol", "wander", "asleep"])
                    && matches!(thing.patrol, Patrol::None)
            });
            if let Some(guard) = idle {
                guard.patrol = Patrol::Cells(line.cells.clone());
                line.is_walked = true;
            }
        }
    }

    /// The definition of the tile that a stack makes; `None` if its items are more than are left.
    fn tile_of(&mut self, stack: u32, items_left: &mut usize) -> Option<Definition> {
        let mut items = Vec::new();
        let mut at = stack;
        while at != 0 {
            let (below, layer, item) = self.stacks[at as usize];
            items.push((layer, item));
            *items_left = items_left.checked_sub(1)?;
            at = below;
        }
        let mut tile = Definition::default();
        for (index, item) in items.into_iter().rev() {
            let layer = &self.map.layers[index];
            let above = match (item, &layer.content) {
                (Item::Tile(gid), _) => self.tile_on(gid, layer),
                (Item::Object(number), Content::Objects(objects)) => {
                    let (mut area, _) = self.definition(&objects[number]).unwrap_or_default();
                    let moves = area.has(&["moves_to"]);
                    for (name, key) in &mut area.keys {
                        key.is_ground =
                            GROUND.contains(&name.as_str()) || moves && name == "switch";
                    }
                    area
                }
                _ => continue,
            };
            if above.has(&SOLID) {
                tile.keys.retain(|_, key| key.is_ground);
            }
            tile.character = above.character.or(tile.character);
            tile.keys.extend(above.keys);
        }
        if tile.has(&FULL) {
            tile.keys.retain(|_, key| !key.is_ground);
        }
        Some(tile)
    }

    /// The definition of a tile on `layer`, whose name says what the picture of a tile is. The keys
    /// of the layer count for tiles that can have them and do not.
    fn tile_on(&mut self, gid: u32, layer: &TiledLayer) -> Definition {
        let mut definition = Definition::default();
        let Some(tile) = self.tile(gid, &layer.origin) else { return definition };
        definition.take(&tile.properties, &tile.origin);
        self.add_class(&mut definition, &tile.class, Some(&*tile), &tile.origin);
        let kind = layer.name.to_lowercase();
        let kind = kind.strip_suffix('s').unwrap_or(&kind);
        let key = ["wall", "floor", "ceiling"].into_iter().find(|key| *key == kind);
        let others: &[&str] = if key == Some("wall") { &FLOORS } else { &[] };
        if let (Some(key), Some(picture)) = (key, &tile.picture)
            && !definition.has(&SOLID)
            && !definition.has(others)
            && !definition.keys.contains_key(key)
        {
            let picture = toml_string(&self.picture(picture));
            definition.set(key, picture, &tile.origin);
        }
        for (name, property) in &layer.properties.0 {
            let owners = CharacterTable::Tiles.owners(name);
            let fits = owners.is_empty() || definition.has(owners);
            if fits && !definition.keys.contains_key(name) {
                definition.set(name, property.to_toml(), &layer.origin);
            }
        }
        if definition.keys.is_empty() {
            let help =
                "name the layer walls, floor or ceiling, or give the tile a class or a property";
            let message = format!("{} does not say what it is", tile.origin);
            self.fault(&layer.origin, message, help);
        }
        let is_ground = matches!(key, Some("floor" | "ceiling")) && !definition.has(&SOLID);
        definition.keys.values_mut().for_each(|value| value.is_ground = is_ground);
        definition
    }

    /// Writes the text, after everything lies and stands where it belongs.
    fn write(&mut self) -> Translation {
        let mut used: Vec<u32> = Vec::new();
        let mut is_used = vec![false; self.stacks.len()];
        for &stack in &self.cells {
            if !is_used[stack as usize] {
                is_used[stack as usize] = true;
                used.push(stack);
            }
        }
        if used.len() > MAX_STACKS {
            let message =
                format!("the cells have more than {MAX_STACKS} different combinations of tiles");
            self.fault(MAP, message, "use fewer combinations");
            return Translation::default();
        }
        let mut items_left = MAX_ITEMS;
        let mut tiles: Vec<(u32, Definition)> = Vec::new();
        for stack in used.into_iter().filter(|stack| *stack != 0) {
            let Some(tile) = self.tile_of(stack, &mut items_left) else {
                self.fault(MAP, "too many layers and objects overlap", "merge some of them");
                return Translation::default();
            };
            tiles.push((stack, tile));
        }
        let walked = self.walked();
        let definitions = tiles.iter().map(|(_, tile)| tile);
        let things = self.things.values().map(|thing| &thing.definition);
        self.characters.reserve(definitions.chain(things));
        let tiles: BTreeMap<u32, (char, Definition)> = tiles
            .into_iter()
            .map(|(stack, tile)| {
                let is_open = tile.keys.is_empty();
                let character = if is_open { '.' } else { self.characters.of_tile(&tile) };
                (stack, (character, tile))
            })
            .collect();
        self.check_supports(&tiles);
        let mut legend = BTreeMap::new();
        let things = self.things_in_cells(&walked, &tiles, &mut legend);
        if self.characters.are_exhausted {
            self.fault(
                MAP,
                "the map has more kinds of tile and thing than there are characters",
                "use fewer kinds",
            );
        }
        let character = |(cell, stack): (usize, &u32)| {
            let tile = || tiles.get(stack).map_or('.', |(character, _)| *character);
            things.get(&cell).map_or_else(tile, |character| *character)
        };
        let rows: Vec<String> = self
            .cells
            .chunks(self.map.width)
            .enumerate()
            .map(|(row, stacks)| {
                let start = row * self.map.width;
                (start..).zip(stacks).map(character).collect()
            })
            .collect();
        let mut writer = MapWriter::default();
        writer.write_map(&self.map.properties, &rows);
        let tiles = tiles.values().filter(|(character, _)| *character != '.');
        let tiles: BTreeMap<char, Definition> = tiles.cloned().collect();
        writer.write_section("[tiles]", &tiles);
        writer.write_section("[things]", &legend);
        let MapWriter { text, origins, grid } = writer;
        let tops = self.stacks.iter().map(|&(_, layer, item)| {
            let layer = self.map.layers.get(layer);
            match (layer, item) {
                (Some(TiledLayer { content: Content::Objects(it), .. }), Item::Object(number)) => {
                    it[number].origin.clone()
                }
                (Some(layer), _) => layer.origin.clone(),
                (None, _) => MAP.into(),
            }
        });
        let things = self.things.iter().map(|(cell, thing)| (*cell, thing.origin.clone()));
        let grid = GridOrigins {
            place: grid,
            width: self.map.width,
            tops: tops.collect(),
            things: things.collect(),
            stacks: mem::take(&mut self.cells),
        };
        Translation { text, parts: mem::take(&mut self.parts), origins, grid }
    }

    /// The cells of all patrols.
    fn walked(&self) -> BTreeSet<usize> {
        let patrols = self.things.values().filter_map(|thing| match &thing.patrol {
            Patrol::Cells(cells) => Some(cells),
            _ => None,
        });
        patrols.flatten().copied().collect()
    }

    /// Reports things and waypoints in walls.
    fn check_supports(&self, tiles: &BTreeMap<u32, (char, Definition)>) {
        for (cell, thing) in &self.things {
            let ways = match &thing.patrol {
                Patrol::Cells(cells) => cells.as_slice(),
                _ => &[],
            };
            for at in [cell].into_iter().chain(ways) {
                let tile = tiles.get(&self.cells[*at]).map(|(_, tile)| tile);
                let Some(solid) = tile.and_then(|it| SOLID.iter().find(|key| it.has(&[key])))
                else {
                    continue;
                };
                let (column, row) = (at % self.map.width, at / self.map.width);
                let what = if at == cell { "it stands on" } else { "its patrol leads to" };
                let message = format!("{what} a {solid}, in the cell {column},{row}");
                self.fault(&thing.origin, message, "move it to open floor, or erase the tile");
            }
        }
        let has_start = self.things.values().any(|thing| thing.definition.has(&["start"]));
        if !has_start && self.faults.borrow().is_empty() {
            let help = "put an object of the class start on a layer of objects";
            self.fault(MAP, "the map has no start", help);
        }
    }

    /// The characters of the cells with things and waypoints, whose definitions go to `legend`.
    fn things_in_cells(
        &mut self,
        walked: &BTreeSet<usize>,
        tiles: &BTreeMap<u32, (char, Definition)>,
        legend: &mut BTreeMap<char, Definition>,
    ) -> BTreeMap<usize, char> {
        let support =
            |definition: &mut Definition, cell: usize, stacks: &[u32], origin: &Rc<str>| {
                if let Some((character, _)) = tiles.get(&stacks[cell]).filter(|(it, _)| *it != '.')
                {
                    definition.set("on", toml_string(&character.to_string()), origin);
                }
            };
        // A waypoint has a character of its own, which patrols name.
        let mut characters = BTreeMap::new();
        for &cell in walked {
            let definition = self.things.get(&cell).map(|thing| &thing.definition);
            characters.insert(cell, self.characters.of_its_own(definition));
        }
        for &cell in walked.iter().filter(|cell| !self.things.contains_key(cell)) {
            let (mut waypoint, origin) = (Definition::default(), MAP.into());
            waypoint.set("waypoint", "true".to_owned(), &origin);
            support(&mut waypoint, cell, &self.cells, &origin);
            legend.insert(characters[&cell], waypoint);
        }
        for (&cell, thing) in &self.things {
            let mut definition = thing.definition.clone();
            if let Patrol::Cells(cells) = &thing.patrol {
                let way: String = cells.iter().filter_map(|cell| characters.get(cell)).collect();
                definition.set("patrol", toml_string(&way), &thing.origin);
            }
            support(&mut definition, cell, &self.cells, &thing.origin);
            let own = characters.get(&cell).copied();
            let character = own.unwrap_or_else(|| self.characters.of_thing(&definition));
            characters.insert(cell, character);
            legend.entry(character).or_insert(definition);
        }
        characters
    }
}

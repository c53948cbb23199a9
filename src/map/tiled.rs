//! Maps of the editor Tiled (mapeditor.org): read as levels, and written from map files.
//!
//! A Tiled map is translated into the text of a map file, which the reader of map files reads.
//! So a level is checked in one place. A fault in the text is reported with its origin: a layer and
//! a cell, a tile or an object.
//!
//! - [`document`] reads the text of `.tmx` and `.tmj`, and of tilesets, into one tree.
//! - [`model`] finds layers, tiles and objects in the tree.
//! - [`level`] translates them, with the characters of [`legend`], into [`text`].
//! - [`mod@export`] writes a Tiled map from a map file. Reading it again gives the same world.
//!
//! Rejected: the crate `tiled`. It does not read `.tmj`, unpacks a file of 400 kB into 1.7 GB, and
//! overflows the stack at 100,000 nested groups. Rejected too: layers compressed by zstd, for which
//! the C library would be built.

mod classes;
mod document;
mod export;
mod legend;
mod level;
mod model;
mod properties;
mod text;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::io::Cursor;
use std::num::NonZeroU32;
use std::path::Path;

use png::{BitDepth, ColorType, Compression, Encoder};

use super::picture::{self, Picture};
use super::{Level, TextureFileError, TextureFiles, parse_level, text_of_file};
use crate::fault::Faults;
pub use export::{ExportedMap, export};
use model::{SheetRegion, TiledError, TiledMap};

/// The largest Tiled file, in bytes.
const MAX_BYTES: usize = 16 << 20;

/// A level from a Tiled map, as a map file.
#[derive(Debug)]
pub struct ImportedLevel {
    /// The level.
    pub level: Level,
    /// The text of the map file.
    pub text: String,
    /// The PNG files that the map file names.
    pub pictures: BTreeMap<String, Vec<u8>>,
}

/// Returns whether the file at `path` is a Tiled map, by its name.
pub fn is_tiled(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default();
    ["tmx", "tmj"].iter().any(|known| ending.eq_ignore_ascii_case(known))
}

/// Reads the Tiled map at `path`, with tilesets and pictures from `files`.
///
/// # Errors
/// All faults of the map, or the reason why the file cannot be read.
pub fn load(path: &Path, files: &dyn TextureFiles) -> Result<ImportedLevel, Faults> {
    import(&text_of_file(path)?, &path.display().to_string(), files)
}

/// Reads `text`, a Tiled map that faults call `name`, as [`load`] does.
///
/// # Errors
/// All faults of the map.
pub fn import(text: &str, name: &str, files: &dyn TextureFiles) -> Result<ImportedLevel, Faults> {
    if text.len() > MAX_BYTES {
        let limit = MAX_BYTES >> 20;
        let message = format!("{name} is larger than {limit} MiB, the maximum for a Tiled map");
        return Err(Faults::of_whole_file(name, &message, ""));
    }
    let root = document::parse(text, name)?;
    let map = TiledMap::read(&root, files).map_err(|wrong| match wrong {
        TiledError::InMap(fault) => Faults::new(name, "", vec![fault]),
        TiledError::InOtherFile(faults) => faults,
    })?;
    let translation = level::translate(&map).map_err(|faults| Faults::new(name, "", faults))?;
    let cut = TileFiles { files, parts: &translation.parts, sheets: RefCell::default() };
    let pictures = RecordedFiles { files: &cut, read: RefCell::default() };
    let level = parse_level(&translation.text, name, &pictures)
        .map_err(|faults| faults.traced(|at| translation.origin(at)))?;
    let pictures = pictures.read.into_inner();
    Ok(ImportedLevel { level, text: translation.text, pictures })
}

/// Files, and a copy of each that is read.
struct RecordedFiles<'f> {
    files: &'f dyn TextureFiles,
    read: RefCell<BTreeMap<String, Vec<u8>>>,
}

impl TextureFiles for RecordedFiles<'_> {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let bytes = self.files.read(name)?;
        self.read.borrow_mut().insert(name.to_owned(), bytes.clone());
        Ok(bytes)
    }
}

/// Files, and the parts of them that are tiles.
struct TileFiles<'f> {
    files: &'f dyn TextureFiles,
    parts: &'f BTreeMap<String, SheetRegion>,
    sheets: RefCell<Sheets>,
}

/// The decoded files that have parts, within the limits of a map's pictures.
#[derive(Default)]
struct Sheets {
    decoded: BTreeMap<String, Picture>,
    budget: picture::PictureBudget,
}

impl TextureFiles for TileFiles<'_> {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let Some(SheetRegion { file, at, size }) = self.parts.get(name) else {
            return self.files.read(name);
        };
        let mut sheets = self.sheets.borrow_mut();
        let Sheets { decoded, budget } = &mut *sheets;
        let sheet = match decoded.entry(file.clone()) {
            Entry::Occupied(sheet) => sheet.into_mut(),
            Entry::Vacant(place) => {
                let bytes = self.files.read(file)?;
                // The reader of map files says what is wrong with a picture.
                let Ok(sheet) = picture::decode(&bytes, budget) else { return Ok(bytes) };
                place.insert(sheet)
            }
        };
        let ends = [0, 1].map(|axis| at[axis].checked_add(size[axis]));
        let is_inside = ends[0].is_some_and(|end| end <= sheet.width())
            && ends[1].is_some_and(|end| end <= sheet.height());
        let sides = size.map(NonZeroU32::new);
        let ([Some(width), Some(height)], true) = (sides, is_inside) else {
            return Err(TextureFileError::Missing);
        };
        let part = sheet.part(at[0], at[1], width, height);
        let texels = (0..height.get()).flat_map(|y| (0..width.get()).map(move |x| (x, y)));
        let texels = texels.flat_map(|(x, y)| {
            let (color, alpha) = part.texel(x, y);
            let [red, green, blue] = color.channels();
            [red, green, blue, alpha]
        });
        Ok(png(*size, &texels.collect::<Vec<u8>>()))
    }
}

/// The PNG file of a picture with this width and height, of red, green, blue and alpha.
fn png([width, height]: [u32; 2], texels: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(Cursor::new(&mut bytes), width, height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    let written = encoder.write_header().and_then(|mut writer| writer.write_image_data(texels));
    debug_assert!(written.is_ok(), "the picture has its texels");
    bytes
}

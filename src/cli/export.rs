//! `cellcaster export`: a map file as a Tiled map.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum, ValueHint};

use super::import::write_pictures;
use super::output_file::{OutputFile, print};
use super::{Error, level};
use crate::fault::printable_path;
use crate::map::{Folder, tiled};

/// Convert a map to a Tiled map
///
/// Writes three files: the map, the tileset with a tile for each tile and thing of the legend (.tiles.png), and the
/// classes for Tiled's editor of object types (.types.json). import restores the same level.
#[derive(Args, Debug)]
#[command(after_long_help = "\
Examples:
  cellcaster export cellar --format tmj
  cellcaster export my.toml --output tiled/my.tmj")]
pub(crate) struct Export {
    /// A map file, or a built-in level (see "cellcaster levels")
    #[arg(value_hint = ValueHint::FilePath)]
    map: OsString,
    /// The format of the map
    #[arg(long, value_enum, default_value_t)]
    format: ExportFormat,
    /// The Tiled map [default: the name of MAP, in this folder]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// Overwrite a Tiled map
    #[arg(long)]
    force: bool,
}

/// The format of a Tiled map.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum ExportFormat {
    #[default]
    Tmj,
}

/// Writes the files, and says which.
pub(crate) fn run(options: &Export) -> Result<(), Error> {
    let ExportFormat::Tmj = options.format;
    let path = Path::new(&options.map);
    let stem = path.file_stem().unwrap_or(OsStr::new("map"));
    let output = options.output.clone().unwrap_or_else(|| Path::new(stem).with_extension("tmj"));
    if !options.force && fs::exists(&output).unwrap_or_default() {
        let name = printable_path(&output);
        return Err(Error::mistake(format!(
            "{name} exists already: choose another --output, or add --force"
        )));
    }
    let (text, name) = level::text(&options.map)?;
    let tiles = output.with_extension("tiles.png");
    let types = output.with_extension("types.json");
    let tiles_name = tiles.file_name().unwrap_or_default().to_string_lossy();
    let export = tiled::export(&text, &name, &tiles_name, &Folder::of(path))?;
    write_pictures(&output, &export.pictures)?;
    let parts = [(&tiles, &export.tiles[..]), (&types, export.types.as_bytes())];
    for (path, bytes) in parts.into_iter().chain([(&output, export.map.as_bytes())]) {
        OutputFile::create(path)?.write(|file| file.write_all(bytes))?;
    }
    let names = [&output, &tiles, &types].map(|path| printable_path(path));
    print(format!("{}\n", names.join("\n")).as_bytes())
}

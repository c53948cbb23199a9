//! `cellcaster import`: a Tiled map as a map file.

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use super::Error;
use super::output_file::{OutputFile, print, unwritable};
use crate::fault::printable_path;
use crate::map::{Folder, tiled};

/// Convert a Tiled map to a map file
///
/// Reads .tmx and .tmj; docs/tiled.md says what layers, tiles and objects mean. Parts of tilesets become PNG files
/// beside the map file. play, check and snapshot accept a Tiled map directly.
#[derive(Args, Debug)]
#[command(after_long_help = "\
Examples:
  cellcaster import level.tmx
  cellcaster import level.tmj --output level.toml")]
pub(crate) struct Import {
    /// The Tiled map
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    map: PathBuf,
    /// The map file [default: standard output]
    #[arg(short, long, value_name = "MAP", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
}

/// Writes the map file, after the Tiled map was read without faults.
pub(crate) fn run(options: &Import) -> Result<(), Error> {
    if !tiled::is_tiled(&options.map) {
        let name = printable_path(&options.map);
        return Err(Error::mistake(format!(
            "{name} is not a Tiled map: its name must end in .tmx or .tmj"
        )));
    }
    let import = tiled::load(&options.map, &Folder::of(&options.map))?;
    let Some(output) = &options.output else { return print(import.text.as_bytes()) };
    write_pictures(output, &import.pictures)?;
    OutputFile::create(output)?.write(|file| file.write_all(import.text.as_bytes()))
}

/// Writes the pictures of a map to the places where the file at `map` looks for them. A file that is
/// there already stays as it is, and is a fault if it is another picture.
pub(crate) fn write_pictures(
    map: &Path,
    pictures: &BTreeMap<String, Vec<u8>>,
) -> Result<(), Error> {
    let folder = map.parent().unwrap_or(Path::new(""));
    for (name, bytes) in pictures {
        let path = folder.join(name);
        match fs::read(&path) {
            Ok(there) if there == *bytes => {}
            Ok(_) => {
                let path = printable_path(&path);
                return Err(Error::mistake(format!(
                    "{path} differs from the map's picture {name}: rename it, or write the map to \
                     another folder"
                )));
            }
            Err(_) => {
                let parent = path.parent().unwrap_or(Path::new(""));
                fs::create_dir_all(parent).map_err(|error| unwritable(&path, &error))?;
                OutputFile::create(&path)?.write(|file| file.write_all(bytes))?;
            }
        }
    }
    Ok(())
}

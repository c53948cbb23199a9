//! `cellcaster compare`: reports the cells in which two grids differ.

use std::ffi::{OsStr, OsString};
use std::io;
use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use super::Error;
use super::options::{STANDARD_INPUT, within};
use super::output_file::{OutputFile, print};
use super::parse::ValidValues;
use crate::testing::CellGrid;

/// Report the cells in which two grids differ
///
/// Reads grids that "cellcaster snapshot" wrote with --format grid or json. Prints the number of cells that differ,
/// their positions, and the largest difference. The exit status is 0 if the grids are the same, 1 if they differ, and 2
/// if a file contains no grid.
#[derive(Args, Debug)]
#[command(after_long_help = "\
Examples:
  cellcaster snapshot my.toml --format grid > before.grid
  cellcaster snapshot my.toml --format grid | cellcaster compare before.grid -
  cellcaster compare before.grid after.json --tolerance 2.3 --png difference.png")]
pub(crate) struct Compare {
    /// The expected grid: a file, or "-" for standard input
    #[arg(value_hint = ValueHint::FilePath)]
    wanted: OsString,
    /// The actual grid: a file, or "-" for standard input
    #[arg(value_hint = ValueHint::FilePath)]
    got: OsString,
    /// The colour difference ΔE that each cell may have; most people notice 2.3 or more
    #[arg(long, value_name = "E", default_value = "0", value_parser = tolerance)]
    tolerance: f64,
    /// Write a PNG of GOT, darkened, with the cells that differ in yellow to red
    #[arg(long, value_name = "OUT", value_hint = ValueHint::FilePath)]
    png: Option<PathBuf>,
}

fn tolerance(text: &str) -> Result<f64, ValidValues> {
    within(text, |it: &f64| (0.0..=1000.0).contains(it), "a number from 0 to 1000, such as 2.3")
}

/// Compares both grids, and prints the result.
pub(crate) fn run(options: &Compare) -> Result<(), Error> {
    if options.wanted == STANDARD_INPUT && options.got == STANDARD_INPUT {
        return Err(Error::mistake("standard input holds only one grid: write \"-\" only once"));
    }
    let (wanted, got) = (grid(&options.wanted)?, grid(&options.got)?);
    let comparison = wanted.compare(&got, options.tolerance);
    if let Some(path) = &options.png {
        OutputFile::create(path)?.write(|output| got.write_difference_png(&comparison, output))?;
    }
    print(format!("{comparison}\n").as_bytes())?;
    if comparison.differences.is_empty() { Ok(()) } else { Err(Error::failed()) }
}

fn grid(name: &OsStr) -> Result<CellGrid, Error> {
    let grid = if name == STANDARD_INPUT {
        CellGrid::read_from(io::stdin().lock())
    } else {
        CellGrid::read(Path::new(name))
    };
    grid.map_err(|error| Error::mistake(format!("{} {error}", name.display())))
}

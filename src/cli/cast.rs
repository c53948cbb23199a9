//! `cellcaster cast`: one line of output for each ray on standard input.

use std::ffi::OsString;
use std::io::{self, BufRead, BufReader, BufWriter, Write};

use clap::{Args, ValueHint};
use glam::DVec2;
use serde::Serialize;

use super::options::STANDARD_INPUT;
use super::{Error, level};
use crate::cast::{Caster, Ray, Side};
use crate::world::World;

/// Read rays from standard input, and write hits to standard output
#[derive(Args, Debug)]
#[command(long_about = LONG_ABOUT, after_long_help = EXAMPLES)]
pub(crate) struct Cast {
    /// A map file or a built-in level (see "cellcaster levels")
    #[arg(value_hint = ValueHint::FilePath)]
    map: Option<OsString>,
    /// The method that finds walls: exact; with cellcaster-lab also dda, dda32, accumulate, fixed:BITS, table:ANGLES or
    /// march:STEP
    #[arg(long, value_name = "METHOD", default_value = EXACT)]
    pub(crate) caster: String,
}

/// The name of the only caster in this program.
pub(crate) const EXACT: &str = "exact";

const LONG_ABOUT: &str = r##"Read rays from standard input, and write hits to standard output

Reads one ray a line, "X Y DX DY", and writes one JSON object a line:

{"cell":[c,r],"side":"x","t":1.5,"u":0.25,"tile":"#"}  what the ray hits
{"escaped":true}   for a ray that leaves the map
{"error":"..."}    for a line that is not a ray; the exit status is then 2"##;

const EXAMPLES: &str = "Examples:\n  echo \"1.5 1.5 1 0\" | cellcaster cast my.toml";

/// Reads rays from standard input until it ends, and writes hits to standard output.
///
/// # Errors
/// After all lines are answered, a user error if any line was not a ray.
pub(crate) fn run(options: &Cast, caster: &dyn Caster) -> Result<(), Error> {
    if options.map.as_ref().is_some_and(|map| map == STANDARD_INPUT) {
        return Err(Error::mistake(
            "cast reads rays from standard input, so the map can't come from there too: name a \
             file",
        ));
    }
    let world = level::load_grid(options.map.as_deref())?;
    let mut input = BufReader::new(io::stdin().lock());
    let mut output = BufWriter::new(io::stdout().lock());
    let mut line = Vec::new();
    let mut wrong_lines = 0_u64;
    loop {
        line.clear();
        let length = input
            .read_until(b'\n', &mut line)
            .map_err(|error| Error::machine(format!("standard input can't be read: {error}")))?;
        if length == 0 {
            output.flush().map_err(|error| Error::of_output(&error))?;
            return verdict(wrong_lines);
        }
        let answer = answer(&world, caster, &line);
        wrong_lines += u64::from(matches!(answer, OutputLine::Error { .. }));
        write(&answer, &mut output).map_err(|error| Error::of_output(&error))?;
        // The other program may wait for this answer before it sends the next ray.
        if input.buffer().is_empty() {
            output.flush().map_err(|error| Error::of_output(&error))?;
        }
    }
}

fn verdict(wrong_lines: u64) -> Result<(), Error> {
    let lines = match wrong_lines {
        0 => return Ok(()),
        1 => "1 line of the input is".to_owned(),
        count => format!("{count} lines of the input are"),
    };
    Err(Error::mistake(format!("{lines} not a ray; the output gives the reason for each")))
}

/// The output line for one ray.
#[derive(Debug, Serialize)]
#[serde(untagged)]
enum OutputLine {
    Hit { cell: [u32; 2], side: &'static str, t: f64, u: f64, tile: char },
    Escaped { escaped: bool },
    Error { error: String },
}

fn answer(world: &World, caster: &dyn Caster, line: &[u8]) -> OutputLine {
    let ray = match read_ray(line) {
        Ok(ray) => ray,
        Err(error) => return OutputLine::Error { error },
    };
    let mut nearest = None;
    let behind = caster.cast_through(world, &ray, &mut |hit| _ = nearest.get_or_insert(hit));
    let Some(hit) = nearest.or(behind) else {
        return OutputLine::Escaped { escaped: true };
    };
    let (column, row) = (hit.cell.column, hit.cell.row);
    let tile = world.grid().tile(i64::from(column), i64::from(row));
    OutputLine::Hit {
        cell: [column, row],
        side: match hit.side {
            Side::X => "x",
            Side::Y => "y",
        },
        t: hit.t,
        u: hit.u,
        tile: tile.map_or('.', |tile| world.tile(tile).character),
    }
}

fn read_ray(line: &[u8]) -> Result<Ray, String> {
    const FORM: &str = "a ray is four numbers, \"X Y DX DY\"";
    let text = std::str::from_utf8(line).map_err(|_| format!("{FORM}; this is not text"))?;
    let mut numbers = [0.0; 4];
    let mut words = text.split_whitespace();
    for number in &mut numbers {
        let word = words.next().ok_or_else(|| format!("{FORM}; this line has fewer"))?;
        *number = word.parse().map_err(|_| format!("{FORM}; \"{word}\" is not a number"))?;
    }
    if words.next().is_some() {
        return Err(format!("{FORM}; this line has more"));
    }
    let [x, y, dx, dy] = numbers;
    Ray::new(DVec2::new(x, y), DVec2::new(dx, dy)).map_err(|error| error.to_string())
}

fn write(answer: &OutputLine, output: &mut impl Write) -> io::Result<()> {
    serde_json::to_writer(&mut *output, answer)?;
    output.write_all(b"\n")
}

//! The report on palettes in each format.

use std::io::{self, BufWriter, Write};

use serde_json::{Value, json};

use crate::cli::arguments::{Wire, WireFormat};
use crate::color::palette::ColorDepth;
use crate::lab::wire::{GREY, PalettePlan, PaletteRow, report_palettes};
use crate::map::builtin;

pub(super) fn run(depth: ColorDepth, options: &Wire) -> io::Result<()> {
    let plan = PalettePlan {
        depth,
        size: options.size.cells(),
        frames_per_second: options.frames_per_second.get(),
    };
    let levels = builtin::LEVELS.iter().filter_map(|level| Some((level.name, level.world().ok()?)));
    let rows = report_palettes(&plan, levels);
    let mut output = BufWriter::new(io::stdout().lock());
    match options.format {
        WireFormat::Table => write_table(&plan, &rows, &mut output)?,
        WireFormat::Json => write_json(&plan, &rows, &mut output)?,
        WireFormat::Csv => write_csv(&rows, &mut output)?,
    }
    output.flush()
}

fn write_table(plan: &PalettePlan, rows: &[PaletteRow], output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "{}×{} cells, {} frames a second. Error: blurred over 2×2 cells, in Oklab. Grey: chroma below {GREY},\n\
         blurred, in percent; beside it in true colour, and of pixels without a blur.\n",
        plan.size.width, plan.size.height, plan.frames_per_second
    )?;
    writeln!(
        output,
        "level         method    grey   true  pixels    error  ratio  bytes a frame  ratio"
    )?;
    let mut level = rows.first().map(|row| &row.level);
    for row in rows {
        if level.replace(&row.level) != Some(&row.level) {
            writeln!(output)?;
        }
        writeln!(
            output,
            "{:<12}  {:<7}  {:>5.1}  {:>5.1}  {:>6.1}  {:>7.4}  {:>5.2}  {:>13.0}  {:>5.2}",
            row.level,
            row.method,
            100.0 * row.grey,
            100.0 * row.true_grey,
            100.0 * row.grey_pixels,
            row.error,
            row.error_ratio,
            row.bytes,
            row.bytes_ratio,
        )?;
    }
    Ok(())
}

fn write_json(plan: &PalettePlan, rows: &[PaletteRow], output: &mut impl Write) -> io::Result<()> {
    let rows: Vec<Value> = rows.iter().map(row).collect();
    let report = json!({
        "size": { "columns": plan.size.width, "rows": plan.size.height },
        "frames_per_second": plan.frames_per_second,
        "grey_chroma": GREY,
        "rows": rows,
    });
    serde_json::to_writer_pretty(&mut *output, &report)?;
    writeln!(output)
}

fn row(row: &PaletteRow) -> Value {
    json!({
        "level": row.level,
        "method": row.method,
        "grey": row.grey,
        "true_grey": row.true_grey,
        "grey_pixels": row.grey_pixels,
        "error": row.error,
        "error_ratio": row.error_ratio,
        "mean_bytes": row.bytes,
        "bytes_ratio": row.bytes_ratio,
    })
}

fn write_csv(rows: &[PaletteRow], output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "level,method,grey,true_grey,grey_pixels,error,error_ratio,mean_bytes,bytes_ratio"
    )?;
    for row in rows {
        writeln!(
            output,
            "{},{},{},{},{},{},{},{},{}",
            row.level,
            row.method,
            row.grey,
            row.true_grey,
            row.grey_pixels,
            row.error,
            row.error_ratio,
            row.bytes,
            row.bytes_ratio,
        )?;
    }
    Ok(())
}

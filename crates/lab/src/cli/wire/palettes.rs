//! The report on palettes in each format.

use std::io::{self, BufWriter, Write};

use serde_json::{Value, json};

use crate::cli::arguments::{Wire, WireFormat};
use crate::wire::{PalettePlan, PaletteRow, report_palettes};
use cellcaster::color::palette::ColorDepth;
use cellcaster::map::builtin;

pub(crate) fn run(depth: ColorDepth, options: &Wire) -> io::Result<()> {
    let plan =
        PalettePlan { depth, size: options.size, frames_per_second: options.frames_per_second };
    let levels = builtin::LEVELS.iter().filter_map(|level| Some((level.name, level.world().ok()?)));
    let rows = report_palettes(&plan, levels);
    let mut output = BufWriter::new(io::stdout().lock());
    match options.format {
        WireFormat::Table => write_table(&plan, &rows, &mut output)?,
        WireFormat::Json => write_json(&plan, &rows, &mut output)?,
        WireFormat::Csv | WireFormat::Svg => write_csv(&rows, &mut output)?,
    }
    output.flush()
}

fn write_table(plan: &PalettePlan, rows: &[PaletteRow], output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "{}×{} cells, {} frames a second. Errors in Oklab after a blur; lightness: how much lighter than\n\
         true colour; changes: percent of cells between block and shade, from frame to frame.\n",
        plan.size.width, plan.size.height, plan.frames_per_second
    )?;
    writeln!(output, "                     first picture")?;
    writeln!(
        output,
        "level        method   error  chroma  lightness   error  changes  bytes a frame"
    )?;
    let mut level = rows.first().map(|row| &row.level);
    for row in rows {
        if level.replace(&row.level) != Some(&row.level) {
            writeln!(output)?;
        }
        writeln!(
            output,
            "{:<11}  {:<7}  {:>5.4}  {:>5.4}  {:>9.4}  {:>5.4}  {:>7.1}  {:>13.0}",
            row.level,
            row.method,
            row.start_error,
            row.start_chroma_error,
            row.start_lightness,
            row.error,
            100.0 * row.changes,
            row.bytes,
        )?;
    }
    Ok(())
}

fn write_json(plan: &PalettePlan, rows: &[PaletteRow], output: &mut impl Write) -> io::Result<()> {
    let rows: Vec<Value> = rows.iter().map(row).collect();
    let report = json!({
        "size": { "columns": plan.size.width, "rows": plan.size.height },
        "frames_per_second": plan.frames_per_second,
        "rows": rows,
    });
    serde_json::to_writer_pretty(&mut *output, &report)?;
    writeln!(output)
}

fn row(row: &PaletteRow) -> Value {
    json!({
        "level": row.level,
        "method": row.method,
        "start_error": row.start_error,
        "start_chroma_error": row.start_chroma_error,
        "start_lightness": row.start_lightness,
        "error": row.error,
        "changes": row.changes,
        "mean_bytes": row.bytes,
    })
}

fn write_csv(rows: &[PaletteRow], output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "level,method,start_error,start_chroma_error,start_lightness,error,changes,mean_bytes"
    )?;
    for row in rows {
        writeln!(
            output,
            "{},{},{},{},{},{},{},{}",
            row.level,
            row.method,
            row.start_error,
            row.start_chroma_error,
            row.start_lightness,
            row.error,
            row.changes,
            row.bytes,
        )?;
    }
    Ok(())
}

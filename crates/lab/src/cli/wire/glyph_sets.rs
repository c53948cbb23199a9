//! The report on glyph sets in each format, and its plot.

use std::io::{self, BufWriter, Write};

use serde_json::{Value, json};

use crate::cli::arguments::{Wire, WireFormat};
use crate::cli::plot::{self, Align, Axis, Mark, Page, PlotColor};
use crate::wire::{GlyphRow, report_glyphs};
use cellcaster::map::builtin;
use cellcaster::tui::GlyphSet;

pub(crate) fn run(options: &Wire) -> io::Result<()> {
    let levels = builtin::LEVELS.iter().filter_map(|level| level.world().ok());
    let rows = report_glyphs(options.size, options.frames_per_second, levels);
    let mut output = BufWriter::new(io::stdout().lock());
    match options.format {
        WireFormat::Table => write_table(&rows, &mut output)?,
        WireFormat::Json => write_json(&rows, &mut output)?,
        WireFormat::Csv => write_csv(&rows, &mut output)?,
        WireFormat::Svg => plot::write_svg(&page(&rows), &mut output)?,
    }
    output.flush()
}

fn name(glyphs: GlyphSet) -> &'static str {
    match glyphs {
        GlyphSet::Quadrant => "quadrant",
        GlyphSet::Sextant => "sextant",
        GlyphSet::Octant => "octant",
        _ => "half",
    }
}

fn write_table(rows: &[GlyphRow], output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "All built-in levels. Errors in thousandths in Oklab after a blur of half a cell.\n"
    )?;
    writeln!(output, "glyphs    fidelity  bytes a frame  error")?;
    for GlyphRow { glyphs, fidelity, bytes, error } in rows {
        let (glyphs, fidelity) = (name(*glyphs), fidelity.to_string());
        writeln!(output, "{glyphs:<8}  {fidelity:<8}  {bytes:>13.0}  {:>5.2}", 1000.0 * error)?;
    }
    Ok(())
}

fn write_json(rows: &[GlyphRow], output: &mut impl Write) -> io::Result<()> {
    let row = |row: &GlyphRow| {
        json!({
            "glyphs": name(row.glyphs),
            "fidelity": row.fidelity.to_string(),
            "mean_bytes": row.bytes,
            "error": row.error,
        })
    };
    let rows: Vec<Value> = rows.iter().map(row).collect();
    serde_json::to_writer_pretty(&mut *output, &rows)?;
    writeln!(output)
}

fn write_csv(rows: &[GlyphRow], output: &mut impl Write) -> io::Result<()> {
    writeln!(output, "glyphs,fidelity,mean_bytes,error")?;
    for GlyphRow { glyphs, fidelity, bytes, error } in rows {
        writeln!(output, "{},{fidelity},{bytes},{error}", name(*glyphs))?;
    }
    Ok(())
}

/// The width and the height of the plot, and its margins.
const PLOT: (f64, f64) = (640.0, 400.0);
const LEFT: f64 = 60.0;
const RIGHT: f64 = 90.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 60.0;
/// The distance between lines of text.
const LINE: f64 = 14.0;
const COLORS: [PlotColor; 4] =
    [PlotColor::Gray, PlotColor::Green, PlotColor::Blue, PlotColor::Orange];
const BYTES: [f64; 5] = [2_000.0, 5_000.0, 10_000.0, 20_000.0, 50_000.0];
const ERRORS: [f64; 6] = [0.004, 0.006, 0.008, 0.012, 0.016, 0.024];

/// Errors against bytes, with a line for each glyph set.
fn page(rows: &[GlyphRow]) -> Page {
    let x_axis = Axis::between(rows.iter().map(|row| row.bytes));
    let y_axis = Axis::between(rows.iter().map(|row| row.error));
    let (right, bottom) = (PLOT.0 - RIGHT, PLOT.1 - BOTTOM);
    let x = |bytes: f64| LEFT + x_axis.share(bytes) * (right - LEFT);
    let y = |error: f64| bottom - y_axis.share(error) * (bottom - TOP);
    let text = |at, align, text: String| Mark::Text { at, align, text };
    let is_inside = |share: f64| share > 0.0 && share < 1.0;
    let mut marks = vec![
        text(
            (LEFT, TOP - LINE),
            Align::Start,
            "Error after a blur, in thousandths in Oklab".into(),
        ),
        text(
            (f64::midpoint(LEFT, right), bottom + 3.0 * LINE),
            Align::Middle,
            "bytes a frame".into(),
        ),
    ];
    for bytes in BYTES.into_iter().filter(|&bytes| is_inside(x_axis.share(bytes))) {
        let (from, to) = ((x(bytes), TOP), (x(bytes), bottom));
        marks.push(Mark::Line { from, to, color: PlotColor::Pale });
        marks.push(text((x(bytes), bottom + 1.5 * LINE), Align::Middle, bytes.to_string()));
    }
    for error in ERRORS.into_iter().filter(|&error| is_inside(y_axis.share(error))) {
        let (from, to) = ((LEFT, y(error)), (right, y(error)));
        marks.push(Mark::Line { from, to, color: PlotColor::Pale });
        let label = format!("{:.0}", 1000.0 * error);
        marks.push(text((LEFT - 8.0, y(error) + 4.0), Align::End, label));
    }
    for (set, color) in rows.chunk_by(|one, other| one.glyphs == other.glyphs).zip(COLORS) {
        let places = || set.iter().map(|row| (x(row.bytes), y(row.error)));
        let segments = places().zip(places().skip(1));
        marks.extend(segments.map(|(from, to)| Mark::Line { from, to, color }));
        marks.extend(places().map(|at| Mark::Dot { at, radius: 5.0, color }));
        if let Some((first, at)) = set.first().zip(places().next()) {
            marks.push(text((at.0 + 12.0, at.1 + 4.0), Align::Start, name(first.glyphs).into()));
        }
    }
    let description = "Mean bytes a frame and error of each glyph set, from right to left at exact, high and low fidelity";
    Page { width: PLOT.0, height: PLOT.1, marks, description: description.into() }
}

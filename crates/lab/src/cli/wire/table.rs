//! The report as a table.

use std::io::{self, Write};

use super::finite;
use crate::wire::{Part, Plan, Report};

pub(crate) fn write(plan: &Plan, report: &Report, output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "{} frames of {}×{} cells, {} a second; bytes a frame.\n",
        report.frames, plan.size.width, plan.size.height, plan.frames_per_second
    )?;
    writeln!(
        output,
        "section       encoder      mean  ratio  median  95th %  largest      µs  zlib 1      µs  zlib 6      µs   PSNR  mean ΔE  largest ΔE"
    )?;
    let Some(first) = report.encoders.first() else { return Ok(()) };
    for index in 0..first.sections.len() {
        for encoder in &report.encoders {
            write_row(&encoder.name, &encoder.sections[index], output)?;
        }
        writeln!(output)?;
    }
    for encoder in &report.encoders {
        write_row(&encoder.name, &encoder.all, output)?;
    }
    let firsts: Vec<String> = report
        .encoders
        .iter()
        .map(|encoder| format!("{} {}", encoder.name, encoder.first_frame))
        .collect();
    writeln!(output, "\nThe first frame, which is in none of these: {}.", firsts.join(", "))
}

fn write_row(encoder: &str, part: &Part, output: &mut impl Write) -> io::Result<()> {
    let ratio = finite(part.ratio).map_or("-".to_owned(), |ratio| format!("{ratio:.3}"));
    let noise = finite(part.seen.signal_to_noise).map_or("exact".to_owned(), |d| format!("{d:.1}"));
    let [fast, usual] = part.compressed;
    writeln!(
        output,
        "{:<12}  {encoder:<7}  {:>8.0}  {ratio:>5}  {:>6}  {:>6}  {:>7}  {:>6.0}  {:>6.0}  {:>6.0}  {:>6.0}  {:>6.0}  {noise:>5}  {:>7.2}  {:>10.1}",
        part.name,
        part.bytes.mean,
        part.bytes.median,
        part.bytes.percentile_95,
        part.bytes.largest,
        part.time.as_secs_f64() * 1e6,
        fast.bytes,
        fast.time.as_secs_f64() * 1e6,
        usual.bytes,
        usual.time.as_secs_f64() * 1e6,
        part.seen.mean_distance,
        part.seen.largest_distance,
    )
}

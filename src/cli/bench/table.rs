//! Two tables for people.

use std::io::{self, Write};

use super::{LINKS, Report, frames_per_second, share_of_stock};
use crate::speed::Scene;

pub(super) fn write(report: &Report, output: &mut impl Write) -> io::Result<()> {
    write_drawing(report, output)?;
    writeln!(output)?;
    write_pipeline(report, output)?;
    let first = report.first_frame.as_secs_f64() * 1e3;
    writeln!(output, "\nThe first frame, from reading the level to the picture: {first:.1} ms.")
}

fn write_drawing(report: &Report, output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "Drawing on one thread: nanoseconds a pixel, beside the loop that tutorials teach and a fill;\n\
         and how many times faster as many threads are as such a picture is drawn with.\n"
    )?;
    writeln!(
        output,
        "scene   picture      ours  classic   fill  classic/ours  ours/fill  threads  faster"
    )?;
    for row in &report.drawing {
        let scene = match row.scene {
            Scene::Planes => "planes",
            Scene::Walls => "walls",
        };
        let size = format!("{}x{}", row.size.width, row.size.height);
        writeln!(
            output,
            "{scene:<6}  {size:<9}  {:>6.2}  {:>7.2}  {:>5.3}  {:>12.1}  {:>9.1}  {:>7}  {:>6.1}",
            row.ours,
            row.classic,
            row.fill,
            row.classic / row.ours,
            row.ours / row.fill,
            row.threads,
            row.ours / row.by_threads,
        )?;
    }
    Ok(())
}

fn write_pipeline(report: &Report, output: &mut impl Write) -> io::Result<()> {
    let [first, second, third] = LINKS;
    writeln!(
        output,
        "From what the player wants to bytes: microseconds and bytes a frame, beside ratatui's own\n\
         encoder, and frames a second over a link of {first}, {second} and {third} Mbit/s.\n"
    )?;
    writeln!(
        output,
        "window  encoder      µs  ratio   bytes  {first:>7}  {second:>7}  {third:>7}"
    )?;
    for row in &report.pipeline {
        let window = format!("{}x{}", row.size.width, row.size.height);
        let [first, second, third] = LINKS.map(|link| frames_per_second(row, link));
        writeln!(
            output,
            "{window:<6}  {:<7}  {:>6.0}  {:>5.2}  {:>6.0}  {first:>7.1}  {second:>7.1}  {third:>7.1}",
            row.encoder,
            row.time.as_secs_f64() * 1e6,
            share_of_stock(report, row),
            row.bytes,
        )?;
    }
    Ok(())
}

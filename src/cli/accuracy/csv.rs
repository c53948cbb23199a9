//! The report as CSV, with a line for each method.

use std::io::{self, Write};

use crate::lab::accuracy::{Report, Row};

pub(super) fn write(report: &Report, output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "method,nanoseconds,lower_quartile,upper_quartile,rays,wrong,worst_distance,mean_distance,\
         worst_texel,mean_texel,wrong_pixels_160x90,wrong_pixels_400x120,front"
    )?;
    report.rows.iter().try_for_each(|row| write_row(row, output))
}

fn write_row(row: &Row, output: &mut impl Write) -> io::Result<()> {
    let Row { method, timing, errors, wrong_pixels: [small, large], is_on_front } = row;
    writeln!(
        output,
        "{method},{:.2},{:.2},{:.2},{},{},{:e},{:e},{:e},{:e},{small},{large},{is_on_front}",
        timing.median,
        timing.lower_quartile,
        timing.upper_quartile,
        errors.rays,
        errors.wrong,
        errors.worst_distance,
        errors.mean_distance,
        errors.worst_texel,
        errors.mean_texel,
    )
}

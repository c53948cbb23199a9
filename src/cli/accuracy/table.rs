//! The report as tables with a plot.

use std::io::{self, Write};

use super::plot;
use crate::lab::accuracy::{Errors, FilterRow, MotionResult, Report, Row, SetRow};

pub(super) fn write(report: &Report, output: &mut impl Write) -> io::Result<()> {
    write_methods(&report.rows, output)?;
    writeln!(output)?;
    plot::write_text(report, output)?;
    writeln!(output)?;
    write_filters(&report.filters, output)?;
    if !report.sets.is_empty() {
        writeln!(output)?;
        write_sets(&report.sets, output)?;
    }
    if !report.motions.is_empty() {
        writeln!(output)?;
        write_motions(&report.motions, output)?;
    }
    Ok(())
}

fn write_methods(rows: &[Row], output: &mut impl Write) -> io::Result<()> {
    let rays = rows.first().map_or(0, |row| row.errors.rays);
    writeln!(
        output,
        "{rays} rays. Nanoseconds a ray: median (quartiles). * nothing is both faster and less wrong.\n"
    )?;
    writeln!(
        output,
        "  {:<12} {:>20} {:>8} {:>19} {:>19} {:>17}",
        "", "", "wrong", "distance, relative", "texels of 64", "wrong pixels in"
    )?;
    writeln!(
        output,
        "  {:<12} {:>20} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8}",
        "method", "ns a ray", "rays", "worst", "rms", "worst", "rms", "160x90", "400x120"
    )?;
    for row in rows {
        let Row { method, timing, errors, wrong_pixels: [small, large], is_on_front } = row;
        let front = if *is_on_front { '*' } else { ' ' };
        let time = format!(
            "{:.1} ({:.1}-{:.1})",
            timing.median, timing.lower_quartile, timing.upper_quartile
        );
        writeln!(
            output,
            "{front} {method:<12} {time:>20} {:>8} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8}",
            share(errors.share_wrong()),
            number(errors.worst_distance),
            number(errors.mean_distance),
            number(errors.worst_texel),
            number(errors.mean_texel),
            share(*small),
            share(*large),
        )?;
    }
    Ok(())
}

fn write_filters(filters: &[FilterRow], output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "Filters: how far a channel, of 256 steps, is from the mean of 64 samples of its pixel; and how\n\
         much it changes, in the mean, from frame to frame of a turn at a ninth of a degree a frame.\n"
    )?;
    writeln!(
        output,
        "  {:<12} {:>26} {:>26}\n  {:<12} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}",
        "", "160x90", "400x120", "filter", "mean", "worst", "shimmer", "mean", "worst", "shimmer"
    )?;
    for FilterRow { name, errors: [small, large] } in filters {
        write!(output, "  {name:<12}")?;
        for errors in [small, large] {
            let (mean, shimmer) = (number(errors.mean), number(errors.shimmer));
            write!(output, " {mean:>8} {:>8} {shimmer:>8}", errors.worst)?;
        }
        writeln!(output)?;
    }
    Ok(())
}

fn write_sets(sets: &[SetRow], output: &mut impl Write) -> io::Result<()> {
    let Some(first) = sets.first() else { return Ok(()) };
    writeln!(
        output,
        "Stiff and extreme sets: wrong rays, and the worst relative error of the distance.\n"
    )?;
    write!(output, "  {:<26} {:>6}", "set", "rays")?;
    first.errors.iter().try_for_each(|(method, _)| write!(output, " {method:>15}"))?;
    writeln!(output)?;
    for set in sets {
        let rays = set.errors.first().map_or(0, |(_, errors)| errors.rays);
        write!(output, "  {:<26} {rays:>6}", set.name)?;
        for (_, errors) in &set.errors {
            let Errors { worst_distance, .. } = errors;
            let cell = format!("{} {}", share(errors.share_wrong()), number(*worst_distance));
            write!(output, " {cell:>15}")?;
        }
        writeln!(output)?;
    }
    Ok(())
}

fn write_motions(motions: &[MotionResult], output: &mut impl Write) -> io::Result<()> {
    writeln!(
        output,
        "Motion: errors at the end, relative to the largest speed and the way at it.\n"
    )?;
    writeln!(
        output,
        "  {:<20} {:>8} {:>8} {:>6} {:>16} {:>10} {:>10} {:>8}",
        "integrator",
        "friction",
        "step, s",
        "steps",
        "speed, from to",
        "velocity",
        "place",
        "ns/step"
    )?;
    for motion in motions {
        let case = motion.case;
        let speeds = format!("{} {}", case.velocity, case.target);
        writeln!(
            output,
            "  {:<20} {:>8} {:>8} {:>6} {speeds:>16} {:>10} {:>10} {:>8.1}",
            motion.integrator.name(),
            number(case.rate),
            number(case.step),
            case.steps,
            number(motion.velocity_error),
            number(motion.place_error),
            motion.nanoseconds,
        )?;
    }
    Ok(())
}

/// A fraction as a percentage; zero is distinguished from a small number.
fn share(share: f64) -> String {
    if share == 0.0 {
        "0".to_owned()
    } else if share < 1e-4 {
        "<.01%".to_owned()
    } else {
        format!("{:.2}%", 100.0 * share)
    }
}

fn number(number: f64) -> String {
    if number == 0.0 {
        "0".to_owned()
    } else if number >= f64::MAX {
        "inf".to_owned()
    } else if (0.01..1000.0).contains(&number) {
        let text = format!("{number:.3}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{number:.1e}")
    }
}

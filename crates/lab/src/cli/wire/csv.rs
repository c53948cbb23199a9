//! The report as CSV, with a line for each section and encoder.

use std::io::{self, Write};

use super::finite;
use crate::wire::Report;

const HEADER: &str = "section,encoder,frames,mean_bytes,ratio,median_bytes,percentile_95_bytes,\
                      largest_bytes,mean_compressed_bytes,mean_nanoseconds,psnr,mean_delta_e,\
                      largest_delta_e,compression_nanoseconds,mean_level_1_bytes,level_1_nanoseconds";

pub(crate) fn write(report: &Report, output: &mut impl Write) -> io::Result<()> {
    writeln!(output, "{HEADER}")?;
    for encoder in &report.encoders {
        for part in encoder.sections.iter().chain([&encoder.all]) {
            let [fast, usual] = part.compressed;
            writeln!(
                output,
                "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}",
                field(&part.name),
                encoder.name,
                part.frames,
                part.bytes.mean,
                number(part.ratio),
                part.bytes.median,
                part.bytes.percentile_95,
                part.bytes.largest,
                usual.bytes,
                part.time.as_nanos(),
                number(part.seen.signal_to_noise),
                part.seen.mean_distance,
                part.seen.largest_distance,
                usual.time.as_nanos(),
                fast.bytes,
                fast.time.as_nanos(),
            )?;
        }
    }
    Ok(())
}

/// A number, or nothing if it is not finite.
fn number(number: f64) -> String {
    finite(number).map(|number| number.to_string()).unwrap_or_default()
}

/// A text, in quotation marks if necessary.
fn field(text: &str) -> String {
    if text.contains(['"', ',']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

//! The report as one JSON object: the script, and the encoders with their sections.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::finite;
use crate::wire::{Part, Plan, Report};

pub(crate) fn write(plan: &Plan, report: &Report, output: &mut impl Write) -> io::Result<()> {
    let encoders: Vec<Value> = report
        .encoders
        .iter()
        .map(|encoder| {
            json!({
                "encoder": encoder.name,
                "first_frame": encoder.first_frame,
                "sections": encoder.sections.iter().map(part).collect::<Vec<_>>(),
                "all": part(&encoder.all),
            })
        })
        .collect();
    let report = json!({
        "cols": plan.size.width,
        "rows": plan.size.height,
        "frames_per_second": plan.frames_per_second,
        "frames": report.frames,
        "encoders": encoders,
    });
    serde_json::to_writer_pretty(&mut *output, &report)?;
    output.write_all(b"\n")
}

fn part(part: &Part) -> Value {
    let [fast, usual] = part.compressed;
    json!({
        "section": part.name,
        "frames": part.frames,
        "bytes": {
            "mean": part.bytes.mean,
            "median": part.bytes.median,
            "percentile_95": part.bytes.percentile_95,
            "largest": part.bytes.largest,
        },
        "ratio": finite(part.ratio),
        "compressed": usual.bytes,
        "compression_nanoseconds": usual.time.as_nanos() as u64,
        "level_1": { "bytes": fast.bytes, "nanoseconds": fast.time.as_nanos() as u64 },
        "nanoseconds": part.time.as_nanos() as u64,
        "psnr": finite(part.seen.signal_to_noise),
        "delta_e": {
            "mean": part.seen.mean_distance,
            "largest": part.seen.largest_distance,
        },
    })
}

//! One object: drawing, the pipeline, and the first frame.

use std::io::{self, Write};

use serde_json::{Map, Value, json};

use super::{LINKS, Report, frames_per_second, share_of_stock};
use crate::speed::{DrawingRow, Scene};
use crate::wire::PipelineRow;

pub(super) fn write(report: &Report, output: &mut impl Write) -> io::Result<()> {
    let value = json!({
        "drawing": report.drawing.iter().map(drawing).collect::<Vec<_>>(),
        "pipeline": report.pipeline.iter().map(|row| pipeline(report, row)).collect::<Vec<_>>(),
        "first_frame_milliseconds": report.first_frame.as_secs_f64() * 1e3,
    });
    serde_json::to_writer_pretty(&mut *output, &value)?;
    output.write_all(b"\n")
}

fn drawing(row: &DrawingRow) -> Value {
    json!({
        "scene": match row.scene {
            Scene::Planes => "planes",
            Scene::Walls => "walls",
        },
        "width": row.size.width,
        "height": row.size.height,
        "threads": row.threads,
        "nanoseconds_a_pixel": {
            "ours": row.ours,
            "by_threads": row.by_threads,
            "classic": row.classic,
            "fill": row.fill,
        },
        "classic_over_ours": row.classic / row.ours,
        "ours_over_fill": row.ours / row.fill,
    })
}

fn pipeline(report: &Report, row: &PipelineRow) -> Value {
    let rate = |link: u32| (link.to_string(), Value::from(frames_per_second(row, link)));
    json!({
        "cols": row.size.width,
        "rows": row.size.height,
        "encoder": row.encoder,
        "frames": row.frames,
        "microseconds": row.time.as_secs_f64() * 1e6,
        "ratio": share_of_stock(report, row),
        "bytes": row.bytes,
        "frames_per_second_over_megabits": LINKS.into_iter().map(rate).collect::<Map<_, _>>(),
    })
}

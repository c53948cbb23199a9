//! The report as one JSON object, with a list or an object for each table.

use std::io::{self, Write};
use std::time::Duration;

use serde_json::{Map, Value, json};

use super::footprint::Footprint;
use super::{LINKS, Report, frames_per_second, share_of_stock};
use crate::speed::{CrowdRow, DrawingRow, MapRow, Scene};
use crate::wire::PipelineRow;

pub(crate) fn write(report: &Report, output: &mut impl Write) -> io::Result<()> {
    let value = json!({
        "drawing": report.drawing.iter().map(drawing).collect::<Vec<_>>(),
        "maps": report.growth.maps.iter().map(map).collect::<Vec<_>>(),
        "things": report.growth.crowds.iter().map(crowd).collect::<Vec<_>>(),
        "pipeline": report.pipeline.iter().map(|row| pipeline(report, row)).collect::<Vec<_>>(),
        "footprint": footprint(&report.footprint),
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

fn map(row: &MapRow) -> Value {
    json!({
        "ground": row.ground.name(),
        "side": row.side,
        "ray": { "nanoseconds": row.ray.seconds * 1e9, "ratio": row.ray.ratio },
        "frame": { "microseconds": row.frame.seconds * 1e6, "ratio": row.frame.ratio },
        "reading_milliseconds": milliseconds(row.loading),
        "bytes_a_cell": row.bytes_a_cell,
    })
}

fn crowd(row: &CrowdRow) -> Value {
    json!({
        "vista": row.vista.name(),
        "things": row.count,
        "frame": { "microseconds": row.frame.seconds * 1e6, "ratio": row.frame.ratio },
    })
}

fn footprint(footprint: &Footprint) -> Value {
    json!({
        "start_milliseconds": footprint.start_up.map(milliseconds),
        "program_bytes": footprint.program,
        "peak_memory_bytes": footprint.memory,
    })
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
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

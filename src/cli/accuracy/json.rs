//! The report as one JSON object: methods, filters, sets and motions.

use std::io::{self, Write};

use serde_json::{Value, json};

use crate::lab::accuracy::{Errors, FilterErrors, Report};

pub(super) fn write(report: &Report, output: &mut impl Write) -> io::Result<()> {
    let methods: Vec<Value> = report
        .rows
        .iter()
        .map(|row| {
            json!({
                "method": row.method,
                "nanoseconds": {
                    "median": row.timing.median,
                    "lower_quartile": row.timing.lower_quartile,
                    "upper_quartile": row.timing.upper_quartile,
                },
                "errors": errors(&row.errors),
                "wrong_pixels": { "160x90": row.wrong_pixels[0], "400x120": row.wrong_pixels[1] },
                "front": row.is_on_front,
            })
        })
        .collect();
    let filters: Vec<Value> = report
        .filters
        .iter()
        .map(|row| {
            let [small, large] = row.errors.map(filter_errors);
            json!({ "filter": row.name, "pictures": { "160x90": small, "400x120": large } })
        })
        .collect();
    let sets: Vec<Value> = report
        .sets
        .iter()
        .map(|set| {
            let by_method = set.errors.iter().map(|(method, all)| (method.clone(), errors(all)));
            json!({ "set": set.name, "methods": by_method.collect::<serde_json::Map<_, _>>() })
        })
        .collect();
    let motions: Vec<Value> = report
        .motions
        .iter()
        .map(|motion| {
            json!({
                "integrator": motion.integrator.name(),
                "rate": motion.case.rate,
                "step": motion.case.step,
                "steps": motion.case.steps,
                "velocity": motion.case.velocity,
                "target": motion.case.target,
                "velocity_error": motion.velocity_error,
                "place_error": motion.place_error,
                "nanoseconds": motion.nanoseconds,
            })
        })
        .collect();
    let report =
        json!({ "methods": methods, "filters": filters, "sets": sets, "motions": motions });
    serde_json::to_writer_pretty(&mut *output, &report)?;
    output.write_all(b"\n")
}

fn errors(errors: &Errors) -> Value {
    json!({
        "rays": errors.rays,
        "wrong": errors.wrong,
        "worst_distance": errors.worst_distance,
        "mean_distance": errors.mean_distance,
        "worst_texel": errors.worst_texel,
        "mean_texel": errors.mean_texel,
    })
}

fn filter_errors(errors: FilterErrors) -> Value {
    json!({ "mean": errors.mean, "worst": errors.worst, "shimmer": errors.shimmer })
}

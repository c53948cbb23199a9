//! `cellcaster-lab bench`: its formats and their contents. Speed is not tested.

use std::fs;

use crate::support::output_of;
use serde_json::Value;

#[test]
fn one_run_reports_and_plots_all_figures() {
    let plot = concat!(env!("CARGO_TARGET_TMPDIR"), "/speed.svg");
    let report = output_of(&["bench", "--seconds", "1", "--format", "json", "--plot", plot]);
    let report: Value = serde_json::from_slice(&report).unwrap();
    has_every_size(&report);
    has_every_map(&report);
    let plot = fs::read_to_string(plot).unwrap();
    for words in ["drawing", "classic", "2073600", "ns/ray", "plain", "4096", "diagonal"] {
        assert!(plot.contains(words), "no {words} in\n{plot}");
    }
}

fn rows<'a>(report: &'a Value, table: &str) -> &'a [Value] {
    report["tables"][table]["rows"].as_array().unwrap()
}

fn is_positive(value: &Value) -> bool {
    value.as_f64().is_some_and(|number| number > 0.0)
}

/// The numbers of a column in the rows whose `key` is `name`.
fn numbers(rows: &[Value], key: &str, name: &str, column: &str) -> Vec<u64> {
    let named = rows.iter().filter(|row| row[key] == name);
    named.map(|row| row[column].as_u64().unwrap()).collect()
}

fn has_every_size(report: &Value) {
    let drawing = rows(report, "drawing");
    let all = &[3840, 9600, 14_400, 24_000, 64_000, 2_073_600][..];
    for (scene, sizes) in [("planes", all), ("walls", &all[..1])] {
        let of_scene: Vec<Value> =
            drawing.iter().filter(|row| row["scene"] == scene).cloned().collect();
        for renderer in ["ours", "classic", "fill"] {
            let pixels = numbers(&of_scene, "renderer", renderer, "pixels");
            assert_eq!(pixels, sizes);
        }
        let threads = numbers(&of_scene, "renderer", "threaded", "threads");
        let pixels = numbers(&of_scene, "renderer", "threaded", "pixels");
        assert!(threads.iter().all(|&count| count > 1), "{threads:?}");
        assert!(pixels.iter().all(|&count| count > 1_000_000), "{pixels:?}");
    }
    for row in drawing {
        for figure in ["time, ns a pixel", "over ours"] {
            assert!(is_positive(&row[figure]), "{figure}: {row}");
        }
    }
}

fn has_every_map(report: &Value) {
    let maps = rows(report, "maps");
    for ground in ["hall", "plain"] {
        let sides = numbers(maps, "ground", ground, "cells");
        assert_eq!(sides, [64, 1024, 4096]);
        let maps: Vec<&Value> = maps.iter().filter(|row| row["ground"] == ground).collect();
        let ratios = (&maps[0]["ray ratio"], &maps[0]["frame ratio"]);
        assert_eq!(ratios, (&1.0.into(), &1.0.into()));
        for row in maps {
            assert!(is_positive(&row["time, ns/ray"]), "{row}");
            assert!(is_positive(&row["time, µs/frame"]), "{row}");
            // One byte is the content of a cell, and another is its distance to solid cells.
            assert!(row["bytes/cell"].as_f64().unwrap() > 2.0, "{row}");
        }
    }
    for hall in ["straight", "diagonal"] {
        let counts = numbers(rows(report, "things"), "hall", hall, "number");
        assert_eq!(counts, [100, 10_000, 100_000]);
    }
}

#[test]
fn the_table_is_readable() {
    let table = String::from_utf8(output_of(&["bench", "--seconds", "1"])).unwrap();
    for word in ["classic", "1920x1080", "ns/ray", "100000"] {
        assert!(table.contains(word), "no {word} in\n{table}");
    }
}

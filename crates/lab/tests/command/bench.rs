//! `cellcaster bench`: its formats and their contents. Speed is not tested.

use std::fs;

use crate::support::{complaint_about, output_of};
use serde_json::Value;

#[test]
fn one_run_gives_all_figures_and_plots_of_them() {
    let plot = concat!(env!("CARGO_TARGET_TMPDIR"), "/speed.svg");
    let report = output_of(&["bench", "--seconds", "1", "--format", "json", "--plot", plot]);
    let report: Value = serde_json::from_slice(&report).unwrap();
    has_every_size(&report);
    has_every_map(&report);
    has_every_encoder(&report);
    has_a_footprint(&report["footprint"]);
    let plot = fs::read_to_string(plot).unwrap();
    for words in ["Drawing", "classic", "3840", "Rays", "plain", "4096", "Pipeline", "stock"] {
        assert!(plot.contains(words), "no {words} in\n{plot}");
    }
}

fn rows(report: &Value, part: &str) -> Vec<Value> {
    report[part].as_array().unwrap().clone()
}

fn is_positive(value: &Value) -> bool {
    value.as_f64().is_some_and(|number| number > 0.0)
}

fn has_every_size(report: &Value) {
    let drawing = rows(report, "drawing");
    let sizes = |scene: &str| {
        let of_scene = drawing.iter().filter(|row| row["scene"] == scene);
        of_scene.map(|row| row["width"].as_u64().unwrap()).collect::<Vec<_>>()
    };
    for scene in ["planes", "walls"] {
        assert_eq!(sizes(scene), [80, 120, 160, 200, 320, 640, 1920, 3840]);
    }
    for row in &drawing {
        for who in ["ours", "by_threads", "classic", "fill"] {
            assert!(is_positive(&row["nanoseconds_a_pixel"][who]), "{who}: {row}");
        }
        let is_small = row["width"].as_u64().unwrap() < 1000;
        assert!(row["threads"].as_u64().is_some_and(|count| count == 1 || !is_small), "{row}");
    }
}

fn has_every_map(report: &Value) {
    let maps = rows(report, "maps");
    for ground in ["hall", "plain"] {
        let maps: Vec<&Value> = maps.iter().filter(|row| row["ground"] == ground).collect();
        let sides: Vec<u64> = maps.iter().map(|row| row["side"].as_u64().unwrap()).collect();
        assert_eq!(sides, [16, 64, 256, 1024, 4096]);
        assert_eq!(
            (&maps[1]["ray"]["ratio"], &maps[1]["frame"]["ratio"]),
            (&1.0.into(), &1.0.into())
        );
        for row in maps {
            assert!(is_positive(&row["ray"]["nanoseconds"]), "{row}");
            assert!(is_positive(&row["frame"]["microseconds"]), "{row}");
            // One byte is the content of a cell, another one is its distance to solid cells.
            assert!(row["bytes_a_cell"].as_f64().unwrap() > 2.0, "{row}");
        }
    }
    let crowds = rows(report, "things");
    for vista in ["straight", "diagonal"] {
        let crowds = crowds.iter().filter(|row| row["vista"] == vista);
        let counts: Vec<u64> = crowds.map(|row| row["things"].as_u64().unwrap()).collect();
        assert_eq!(counts, [100, 10_000, 100_000]);
    }
}

fn has_every_encoder(report: &Value) {
    let pipeline = rows(report, "pipeline");
    for window in pipeline.chunks_exact(4) {
        let encoders: Vec<&str> =
            window.iter().map(|row| row["encoder"].as_str().unwrap()).collect();
        assert_eq!(encoders, ["stock", "exact", "high", "low"]);
        assert_eq!(window[0]["ratio"], 1.0);
        let bytes: Vec<f64> = window.iter().map(|row| row["bytes"].as_f64().unwrap()).collect();
        let [stock, exact, high, low] = bytes[..] else { panic!("{bytes:?}") };
        assert!(stock > exact && exact > high && exact > low, "{bytes:?}");
        for row in window {
            let rate = |link: &str| row["frames_per_second_over_megabits"][link].as_f64().unwrap();
            assert!(0.0 < rate("1") && rate("1") <= rate("10") && rate("10") <= rate("100"));
            assert!(row["frames"].as_u64().unwrap() >= 20 && is_positive(&row["microseconds"]));
        }
    }
    assert_eq!(pipeline.len(), 12);
}

fn has_a_footprint(footprint: &Value) {
    assert!(is_positive(&footprint["start_milliseconds"]));
    assert!(footprint["program_bytes"].as_u64().unwrap() > 1 << 20);
    if cfg!(target_os = "linux") {
        let memory = footprint["peak_memory_bytes"].as_u64().unwrap();
        assert!((1 << 20..1 << 28).contains(&memory), "{memory}");
    }
}

#[test]
fn a_table_is_for_people() {
    let table = String::from_utf8(output_of(&["bench", "--seconds", "1"])).unwrap();
    for word in ["classic/ours", "3840x2160", "200x60", "stock", "Mbit/s", "first frame", "100000"]
    {
        assert!(table.contains(word), "no {word} in\n{table}");
    }
    assert!(table.lines().all(|line| line.chars().count() <= 100), "{table}");
}

#[test]
fn mistakes_are_told() {
    insta::assert_snapshot!(
        [
            complaint_about(&["bench", "cellar"]),
            complaint_about(&["bench", "--seconds", "0"]),
            complaint_about(&["bench", "--format", "svg"]),
            complaint_about(&["bench", "--secnods", "2"]),
            complaint_about(&["bench", "--plot"]),
        ]
        .join("")
    );
}

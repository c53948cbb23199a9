//! `cellcaster bench`: both formats, and what they are about. How fast anything is, is no matter here.
#![cfg(feature = "cli")]

mod support;

use serde_json::Value;
use support::{complaint_about, output_of};

#[test]
fn json_has_every_size_and_every_encoder() {
    let report = output_of(&["bench", "--seconds", "1", "--format", "json"]);
    let report: Value = serde_json::from_slice(&report).unwrap();
    let rows = |part: &str| report[part].as_array().unwrap().clone();
    let drawing = rows("drawing");
    let sizes = |scene: &str| {
        let of_scene = drawing.iter().filter(|row| row["scene"] == scene);
        of_scene.map(|row| row["width"].as_u64().unwrap()).collect::<Vec<_>>()
    };
    for scene in ["planes", "walls"] {
        assert_eq!(sizes(scene), [160, 320, 640, 1920, 3840]);
    }
    let is_positive = |value: &Value| value.as_f64().is_some_and(|number| number > 0.0);
    for row in &drawing {
        for who in ["ours", "by_threads", "classic", "fill"] {
            assert!(is_positive(&row["nanoseconds_a_pixel"][who]), "{who}: {row}");
        }
        let is_small = row["width"].as_u64().unwrap() < 1000;
        assert!(row["threads"].as_u64().is_some_and(|count| count == 1 || !is_small), "{row}");
    }
    let pipeline = rows("pipeline");
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
    assert!(is_positive(&report["first_frame_milliseconds"]));
}

#[test]
fn a_table_is_for_people() {
    let table = String::from_utf8(output_of(&["bench", "--seconds", "1"])).unwrap();
    for word in ["classic/ours", "3840x2160", "200x60", "stock", "Mbit/s", "first frame"] {
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
        ]
        .join("")
    );
}

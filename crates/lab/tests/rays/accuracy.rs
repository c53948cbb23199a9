//! `cellcaster-lab accuracy`: its formats, its results, and the figures of docs/accuracy.md.

use std::collections::BTreeSet;
use std::fs;

use crate::support::{complaint_about, output_of};
use serde_json::Value;

/// A report without times, which is the same in every run.
const QUICK: [&str; 11] = [
    "accuracy",
    "cellar",
    "--part",
    "rays",
    "--rays",
    "40",
    "--rounds",
    "0",
    "--caster",
    "exact",
    "--caster=march:0.1",
];

fn report(format: &str) -> Vec<u8> {
    output_of(&[&QUICK[..], &["--format", format]].concat())
}

fn text(format: &str) -> String {
    String::from_utf8(report(format)).unwrap()
}

fn json(arguments: &[&str]) -> Value {
    let output = output_of(&[&["accuracy", "--format", "json"], arguments].concat());
    serde_json::from_slice(&output).unwrap()
}

fn rows<'a>(report: &'a Value, table: &str) -> &'a [Value] {
    report["tables"][table]["rows"].as_array().unwrap()
}

#[test]
fn the_exact_method_is_always_right() {
    let report = json(&["--part", "rays", "--rays", "20", "--rounds", "1"]);
    for scene in ["rooms", "plain-4096"] {
        let exact = rows(&report, "rays").iter().find(|row| row["scene"] == scene).unwrap();
        assert_eq!((&exact["method"], &exact["wrong rays"]), (&"exact".into(), &0.0.into()));
        assert!(exact["time, ns a ray"]["median"].as_f64().unwrap() > 0.0);
    }
    let sets = rows(&report, "stiff");
    assert!(sets.len() >= 20);
    for set in sets {
        assert_eq!(set["exact"], 0.0, "{set}");
    }
    assert!(sets.iter().any(|set| set["dda"] != 0.0), "a double alone can't order every line");
}

/// Markdown, CSV and SVG contain every row of JSON.
#[test]
fn every_format_contains_every_figure() {
    let (csv, markdown) = (text("csv"), text("markdown"));
    let report: Value = serde_json::from_slice(&report("json")).unwrap();
    let mut figures = 0;
    for row in rows(&report, "rays") {
        let values = row.as_object().unwrap().iter().filter(|(_, value)| !value.is_string());
        figures += values.count();
    }
    let lines: Vec<&str> = csv.lines().collect();
    let of_run = lines.iter().filter(|line| line.starts_with("run,")).count();
    assert_eq!(lines.len() - 1 - of_run, figures);
    assert_eq!(of_run, 4);
    // A comma inside quotes separates nothing.
    let columns =
        |line: &&str| line.split('"').step_by(2).flat_map(|part| part.matches(',')).count();
    let figures_only = lines.iter().filter(|line| !line.starts_with("run,")).map(columns);
    assert_eq!(figures_only.collect::<BTreeSet<usize>>().len(), 1);
    for word in ["exact", "march", "0.1", "wrong rays", "ulp", "rustc"] {
        assert!(markdown.contains(word), "no {word} in\n{markdown}");
    }
    assert_eq!(markdown.lines().filter(|line| line.contains("march")).count(), 1);

    let without_run = |text: &str| -> Vec<String> {
        let lines = text.lines().filter(|line| !line.starts_with("run,"));
        lines.map(str::to_owned).collect()
    };
    let svg = text("svg");
    let description = svg.split_once("<desc>").unwrap().1.split_once("</desc>").unwrap().0;
    assert_eq!(without_run(description), without_run(&csv));
}

#[test]
fn a_plot_has_a_dot_for_each_method_in_each_panel() {
    let plot = |rounds| {
        let arguments = [&QUICK[..], &["--rounds", rounds, "--format", "svg"]].concat();
        String::from_utf8(output_of(&arguments)).unwrap()
    };
    let dots = |plot: &str| plot.matches("<circle").count();
    // Two dots belong to the legend. Without times, there are no points.
    assert_eq!(dots(&plot("0")), 2);
    // Two panels: the time over the mean error, and over the wrong rays. An error of 0 is not on an axis.
    let plot = plot("1");
    assert_eq!(dots(&plot), 2 + 2 + 1);
    assert!(plot.contains("not on the axes: exact"));
    assert!(plot.starts_with("<svg ") && plot.trim_end().ends_with("</svg>"));
}

#[test]
fn one_set_can_be_reported_alone() {
    let report = json(&[
        "--part",
        "rays",
        "--rounds",
        "0",
        "--set",
        "through corners",
        "--caster",
        "exact",
        "--caster",
        "dda",
    ]);
    let [exact, dda] = rows(&report, "rays") else { panic!("{report}") };
    assert_eq!(exact["wrong rays"], 0.0);
    assert!(
        dda["wrong rays"].as_f64().unwrap() > 0.0,
        "a double alone can't tell which line of a corner comes first"
    );
}

#[test]
fn the_motion_uses_the_requested_friction_and_step() {
    let report =
        json(&["--part", "motion", "--rounds", "0", "--friction", "7", "--steps-per-second", "25"]);
    let title = report["tables"]["motion"]["title"].as_str().unwrap();
    assert!(title.contains("a friction of 7 per second"), "{title}");
    let is_players = |row: &&Value| row["rate × step"] == 7.0 / 25.0 && row["step, s"] == "1/25";
    assert_eq!(rows(&report, "motion").iter().filter(is_players).count(), 5);
    let orders: Vec<f64> =
        rows(&report, "orders").iter().filter_map(|row| row["slope, velocity"].as_f64()).collect();
    let rounded: Vec<f64> = orders.iter().map(|order| order.round()).collect();
    assert_eq!(rounded, [1.0, 2.0, 4.0, 1.0]);
}

#[test]
fn a_report_without_times_is_reproducible() {
    assert_eq!(report("json"), report("json"));
}

/// The cells of the tables of a page in Markdown, by the name of the table.
fn tables_of_page(page: &str) -> Vec<(String, Vec<Vec<String>>)> {
    let parts = page.split("<!-- accuracy ").skip(1);
    parts
        .map(|part| {
            let (name, rest) = part.split_once(" -->").unwrap();
            let (block, _) = rest.split_once("<!-- end -->").unwrap();
            (name.to_owned(), cells(block))
        })
        .collect()
}

fn cells(block: &str) -> Vec<Vec<String>> {
    let lines = block.lines().filter(|line| line.starts_with("| "));
    lines
        .map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect())
        .collect()
}

/// Compares the figures of docs/accuracy.md with the figures of the program, except times.
fn assert_page_is_current(part: &str) {
    let page =
        fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/accuracy.md")).unwrap();
    let page = tables_of_page(&page);
    let arguments = ["accuracy", "--part", part, "--rounds", "0", "--format", "markdown"];
    let report = String::from_utf8(output_of(&arguments)).unwrap();
    let mut compared = 0;
    for section in report.split("\n### ").map(|section| section.trim_start_matches("### ")) {
        let name = section.lines().next().unwrap();
        let now = cells(section);
        let (_, kept) =
            page.iter().find(|(other, _)| other == name).expect("the page has this table");
        let is_time: Vec<bool> = now[0].iter().map(|heading| heading.starts_with("time")).collect();
        assert_eq!(kept.len(), now.len(), "{name}: write the page anew by .ci/accuracy");
        for (kept, now) in kept.iter().zip(&now) {
            for ((kept, now), is_time) in kept.iter().zip(now).zip(&is_time) {
                assert!(
                    *is_time || kept == now,
                    "{name}: {kept} is {now}: write the page anew by .ci/accuracy"
                );
                compared += usize::from(!is_time);
            }
        }
    }
    assert!(compared > 50);
}

#[test]
fn the_page_has_the_current_ray_table() {
    assert_page_is_current("rays");
}

#[test]
fn the_page_has_the_current_picture_table() {
    assert_page_is_current("pictures");
}

#[test]
fn the_page_has_the_current_motion_table() {
    assert_page_is_current("motion");
}

#[test]
fn the_page_has_the_current_feature_table() {
    assert_page_is_current("features");
}

#[test]
fn each_mistake_prints_one_sentence() {
    let mistakes: [&[&str]; 13] = [
        &["--set", "nobody's"],
        &["--caster", "ddda"],
        &["--caster", "fixed:99"],
        &["--caster", "dda:3"],
        &["--rays", "0"],
        &["--seed", "-1"],
        &["--format", "gif"],
        &["--castor", "dda"],
        &["--part", "everything"],
        &["--rounds", "1001"],
        &["--friction", "0"],
        &["--steps-per-second", "inf"],
        &["--part", "motion", "--rounds", "0", "--update", "tests/maps/cross.toml"],
    ];
    let complaints: Vec<String> = mistakes
        .into_iter()
        .map(|mistake| {
            let arguments = [&["accuracy"], mistake].concat();
            let complaint = complaint_about(&arguments);
            assert_eq!(complaint.lines().count(), 1, "{complaint}");
            format!("{}\n  {complaint}", arguments.join(" "))
        })
        .collect();
    insta::assert_snapshot!(complaints.concat());
}

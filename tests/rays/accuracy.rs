//! `cellcaster accuracy`: its formats and its results.

use crate::support::{complaint_about, output_of};
use serde_json::Value;

const QUICK: [&str; 8] =
    ["accuracy", "cellar", "--rays", "40", "--caster", "exact", "--caster", "march:0.1"];

fn report(format: &str) -> Vec<u8> {
    output_of(&[&QUICK[..], &["--format", format]].concat())
}

#[test]
fn the_whole_report_finds_the_exact_method_right_about_everything() {
    let report = output_of(&["accuracy", "--rays", "20", "--format", "json"]);
    let report: Value = serde_json::from_slice(&report).unwrap();
    let methods = report["methods"].as_array().unwrap();
    assert!(methods.len() >= 15);
    assert_eq!(
        (&methods[0]["method"], &methods[0]["errors"]["wrong"]),
        (&"exact".into(), &0.into())
    );
    assert_eq!(methods[0]["wrong_pixels"]["160x90"], 0.0);
    assert!(methods.iter().any(|method| method["front"] == true));
    let mean_error = |filter: usize| &report["filters"][filter]["pictures"]["160x90"]["mean"];
    assert!(mean_error(0).as_f64() < mean_error(1).as_f64(), "{}", report["filters"]);
    let sets = report["sets"].as_array().unwrap();
    assert!(sets.len() >= 20);
    for set in sets {
        let exact = &set["methods"]["exact"];
        assert_eq!(exact["wrong"], 0, "{}", set["set"]);
        assert!(exact["worst_distance"].as_f64().unwrap() < 1e-15, "{}", set["set"]);
    }
    assert!(report["motions"].as_array().unwrap().len() >= 24);
}

#[test]
fn a_table_is_for_people() {
    let table = String::from_utf8(report("table")).unwrap();
    for word in ["40 rays", "exact", "march:0.1", "400x120", "nanoseconds a ray", "shimmer"] {
        assert!(table.contains(word), "no {word} in\n{table}");
    }
}

#[test]
fn csv_has_a_line_for_each_method() {
    let csv = String::from_utf8(report("csv")).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 3);
    let columns = |line: &str| line.split(',').count();
    assert!(lines.iter().all(|line| columns(line) == columns(lines[0])));
    assert!(lines[1].starts_with("exact,") && lines[2].starts_with("march:0.1,"));
}

#[test]
fn plots_are_images() {
    let svg = String::from_utf8(report("svg")).unwrap();
    assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"));
    assert_eq!(svg.matches("<circle").count(), 2);
    let png = report("png");
    let reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().unwrap();
    assert_eq!((reader.info().width, reader.info().height), (960, 600));
}

#[test]
fn a_set_can_be_looked_at_alone() {
    let arguments =
        ["accuracy", "--set", "through corners", "--caster", "exact", "--caster", "dda"];
    let csv =
        String::from_utf8(output_of(&[&arguments[..], &["--format", "csv"]].concat())).unwrap();
    let wrong = |line: &str| line.split(',').nth(5).unwrap().parse::<usize>().unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(wrong(lines[1]), 0);
    assert!(wrong(lines[2]) > 0, "a double alone can't tell which line of a corner comes first");
}

#[test]
fn the_same_seed_gives_the_same_errors() {
    let errors = || {
        let report: Value = serde_json::from_slice(&report("json")).unwrap();
        let methods = report["methods"].as_array().unwrap().clone();
        methods.into_iter().map(|method| method["errors"].clone()).collect::<Vec<_>>()
    };
    assert_eq!(errors(), errors());
}

#[test]
fn mistakes_are_one_sentence_each() {
    let mistakes: [&[&str]; 8] = [
        &["--set", "nobody's"],
        &["--caster", "ddda"],
        &["--caster", "fixed:99"],
        &["--caster", "dda:3"],
        &["--rays", "0"],
        &["--seed", "-1"],
        &["--format", "gif"],
        &["--castor", "dda"],
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

//! `cellcaster cast`: one line of output for each ray.

use std::io::{BufRead, BufReader, Write};
use std::process::Stdio;

use crate::support::{lab, run_with_input};

const MAP: &str = "tests/maps/cross.toml";

/// The output for `rays`, of which `wrong` lines are not rays.
fn answers(rays: &str, wrong: usize) -> String {
    let output = run_with_input(&["cast", MAP], rays.as_bytes());
    let complaint = String::from_utf8(output.stderr).unwrap();
    if wrong == 0 {
        assert_eq!((output.status.code(), complaint.as_str()), (Some(0), ""));
    } else {
        assert_eq!((output.status.code(), complaint.lines().count()), (Some(2), 1), "{complaint}");
        assert!(complaint.starts_with(&format!("cellcaster: {wrong} line")), "{complaint}");
    }
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn every_line_gets_an_answer() {
    let rays = [
        "2.5 2.5 1 0",
        "2.5 2.25 -1 0",
        "2.5 2.5 0 -2",
        "2.5 2.5 1 1",
        "2.5 2.5 -3 1",
        "-7 2.5 1 0",
        "-7 2.5 -1 0",
        "2.5 2.5 0 0",
        "2.5 nan 1 0",
        "2.5 2.5 inf 0",
        "2.5 2.5 1",
        "2.5 2.5 1 0 7",
        "2.5 2.5 east 0",
        "",
        "0.1 1e-1 5e-324 1e308",
    ];
    let answers = answers(&(rays.join("\n") + "\n"), 7);
    assert_eq!(answers.lines().count(), rays.len());
    let dialogue: Vec<String> = rays
        .iter()
        .zip(answers.lines())
        .map(|(ray, answer)| format!("{ray}\n  {answer}\n"))
        .collect();
    insta::assert_snapshot!(dialogue.concat());
}

#[test]
fn a_last_line_without_a_newline_counts() {
    assert_eq!(answers("2.5 2.5 1 0", 0).lines().count(), 1);
    assert_eq!(answers("", 0), "");
}

#[test]
fn bytes_that_are_not_text_are_not_a_ray() {
    let output = run_with_input(&["cast", MAP], b"\xff\xfe 1 2 3\n2.5 2.5 1 0\n");
    let answers = String::from_utf8(output.stdout).unwrap();
    assert!(answers.lines().next().unwrap().starts_with(r#"{"error":"#));
    assert!(answers.lines().nth(1).unwrap().starts_with(r#"{"cell":"#));
}

#[test]
fn each_answer_is_written_before_the_next_ray_is_read() {
    let mut child =
        lab(&["cast", MAP]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut rays = child.stdin.take().unwrap();
    let mut hits = BufReader::new(child.stdout.take().unwrap());
    for _ in 0..3 {
        rays.write_all(b"2.5 2.5 1 0\n").unwrap();
        let mut hit = String::new();
        hits.read_line(&mut hit).unwrap();
        assert!(hit.starts_with(r#"{"cell":"#));
    }
    drop(rays);
    assert!(child.wait().unwrap().success());
}

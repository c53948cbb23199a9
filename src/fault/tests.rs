use insta::assert_snapshot;

use super::*;

#[test]
fn a_multi_line_place_is_underlined_on_its_first_line() {
    let text = "grid = '''\r\n####\r\n'''\r\n";
    let fault = Fault::new(7..21, "the grid is small").label("this one").help("draw more");
    assert_snapshot!(Faults::new("a.toml", text, vec![fault]), @r"
    error: the grid is small
     --> a.toml:1:8
      |
    1 | grid = '''
      |        ^^^ this one
      |
      = help: draw more
    ");
}

#[test]
fn faults_are_ordered_by_place() {
    let faults = [7, 0, 3].map(|at| Fault::new(at..at + 1, format!("the byte {at} is bad")));
    assert_snapshot!(Faults::new("a.toml", "one\nänd\n", faults.into()), @r"
    error: the byte 0 is bad
     --> a.toml:1:1
      |
    1 | one
      | ^

    error: the byte 3 is bad
     --> a.toml:1:4
      |
    1 | one
      |    ^

    error: the byte 7 is bad
     --> a.toml:2:3
      |
    2 | änd
      |   ^
    ");
}

#[test]
fn a_long_row_is_cut_around_the_place() {
    let row = format!("{}ä{}", "#".repeat(2000), "#".repeat(2095));
    let report = Faults::new("a.toml", &row, vec![Fault::new(2000..2002, "what is that")]);
    let report = report.to_string();
    assert!(report.contains("a.toml:1:2001") && report.contains("#ä#"), "{report}");
    assert!(report.lines().all(|line| line.len() < 200), "{report}");
}

#[test]
fn an_endless_line_is_not_shown() {
    let text = format!("\n{}", "x".repeat(MAX_LINE + 1));
    let report = Faults::new("a.toml", &text, vec![Fault::new(70..71, "that is much")]);
    assert_snapshot!(report, @r"
    error: that is much
    --> a.toml:2:70
    ");
}

#[test]
fn a_fault_can_be_at_the_end_of_the_text() {
    for text in ["", "a", "a\n", "a\r\n", "ä"] {
        let end = text.len();
        let report = Faults::new("a.toml", text, vec![Fault::new(end..end, "more was due")]);
        assert!(report.to_string().contains("--> a.toml:"), "{report}");
    }
}

#[test]
fn faults_beyond_the_limit_are_counted() {
    let faults: Vec<Fault> = (0..250).map(|at| Fault::new(at..at + 1, "no")).collect();
    let faults = Faults::new("a.toml", &"\n".repeat(250), faults);
    assert_eq!(faults.len(), 250);
    let report = faults.to_string();
    assert_eq!(report.matches("error: no").count(), MAX_REPORTED);
    assert!(report.ends_with("error: 150 more faults in a.toml are not shown"));
}

#[test]
fn a_fault_of_a_whole_file_shows_no_line() {
    let faults = Faults::of_whole_file("a.toml", "a.toml is too large", "make it small");
    assert_snapshot!(faults, @r"
    error: a.toml is too large
     |
     = help: make it small
    ");
}

#[test]
fn control_characters_are_escaped_and_nothing_else_changes() {
    assert_eq!(printable("a\u{1b}[31m\r\n\u{9b}\u{7f}\0"), r"a\u{1b}[31m\r\n\u{9b}\u{7f}\0");
    assert_eq!(printable("\u{202e}live"), r"\u{202e}live");
    for text in ["", r#""it's" C:\maps"#, "Flur – 廊下", "e\u{301}"] {
        assert_eq!(printable(text), text);
    }
}

#[cfg(feature = "terminal")]
#[test]
fn a_path_is_shown_on_one_line() {
    assert_eq!(printable_path(Path::new("/maps\n/\u{1b}c.toml")), r"/maps\n/\u{1b}c.toml");
}

#[cfg(feature = "cli")]
#[test]
fn printing_keeps_line_breaks() {
    assert_eq!(printable_lines("one\ntwo\u{7}\n"), "one\ntwo\\u{7}\n");
}

const KEYS: &[&str] = &["title", "ceiling", "floor", "grid"];

#[test]
fn a_misspelling_has_a_nearest_name() {
    for (slip, name) in
        [("titel", "title"), ("celing", "ceiling"), ("Floor", "floor"), ("gridd", "grid")]
    {
        assert_eq!(nearest(slip, KEYS), Some(name), "{slip}");
    }
}

#[test]
fn an_unrelated_word_has_no_nearest_name() {
    for word in ["", "x", "walls", "ceilinggniliec", &"floor".repeat(1_000_000)] {
        assert_eq!(nearest(word, KEYS), None);
    }
    assert_eq!(nearest("grid", &[]), None);
}

#[test]
fn a_quote_prints_on_one_short_line() {
    assert_eq!(quoted("a\n\u{1b}[31m"), r#""a\n\u{1b}[31m""#);
    assert_eq!(quoted(&"ä".repeat(1000)), format!("\"{}\"…", "ä".repeat(40)));
}

//! The report: each fault with its line.
//!
//! Of a place that spans several lines, only the first is shown: the grid of a map may have
//! thousands. The renderer cuts a long line around the place; if it is too long to be searched, the
//! place is shown without it.

use std::fmt;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use super::Fault;

/// More faults than anybody corrects in one go.
const MOST_FAULTS: usize = 100;
/// In bytes: four times the widest row of a map in the longest characters.
const LONGEST_LINE: usize = 1 << 16;

/// Writes the report on `faults`, which are sorted by place.
pub(crate) fn report(
    f: &mut fmt::Formatter<'_>,
    name: &str,
    text: &str,
    faults: &[Fault],
) -> fmt::Result {
    let mut lines = Lines { text, start: 0, number: 1 };
    let (shown, left_out) = faults.split_at(faults.len().min(MOST_FAULTS));
    for (index, fault) in shown.iter().enumerate() {
        if index > 0 {
            f.write_str("\n\n")?;
        }
        let place = fault.place.clone().map(|place| lines.excerpt(&place));
        f.write_str(&Renderer::plain().render(&[group(name, fault, place)]))?;
    }
    if left_out.is_empty() {
        return Ok(());
    }
    write!(f, "\n\nerror: {} more faults in {name} are not shown", left_out.len())
}

fn group<'a>(name: &'a str, fault: &'a Fault, place: Option<Excerpt<'a>>) -> Group<'a> {
    let mut group = Group::with_title(Level::ERROR.primary_title(&fault.message));
    if let Some(Excerpt { line, number, span }) = place {
        group = if line.len() > LONGEST_LINE {
            let column = line[..span.start].chars().count() + 1;
            group.element(Origin::path(name).line(number).char_column(column))
        } else {
            let label = Some(fault.label.as_str()).filter(|label| !label.is_empty());
            let underline = AnnotationKind::Primary.span(span).label(label);
            group.element(Snippet::source(line).path(name).line_start(number).annotation(underline))
        };
    }
    if !fault.help.is_empty() {
        group = group.element(Level::HELP.message(&fault.help));
    }
    group
}

/// A line, and the bytes of it to underline.
struct Excerpt<'a> {
    line: &'a str,
    number: usize,
    span: Range<usize>,
}

/// The lines of a text, in one pass from its start.
struct Lines<'a> {
    text: &'a str,
    /// The start of the current line.
    start: usize,
    /// The number of the current line, from 1.
    number: usize,
}

impl<'a> Lines<'a> {
    /// The first line of `place`, which does not start before the last place asked for.
    fn excerpt(&mut self, place: &Range<usize>) -> Excerpt<'a> {
        let place_start = boundary_before(self.text, place.start);
        while let Some(length) = self.text[self.start..place_start].find('\n') {
            self.start += length + 1;
            self.number += 1;
        }
        let line = self.text[self.start..].lines().next().unwrap_or_default();
        let start = (place_start - self.start).min(line.len());
        let end = boundary_before(self.text, place.end).saturating_sub(self.start);
        Excerpt { line, number: self.number, span: start..end.clamp(start, line.len()) }
    }
}

/// The last position up to `at` where a character of `text` starts or the text ends.
fn boundary_before(text: &str, at: usize) -> usize {
    let is_boundary = |&at: &usize| text.is_char_boundary(at);
    (0..=at.min(text.len())).rev().find(is_boundary).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use insta::assert_snapshot;

    use super::super::Faults;
    use super::*;

    #[test]
    fn a_place_of_several_lines_is_underlined_on_its_first() {
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
    fn faults_come_in_the_order_of_their_places() {
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
        let text = format!("\n{}", "x".repeat(LONGEST_LINE + 1));
        let report = Faults::new("a.toml", &text, vec![Fault::new(70..71, "that is much")]);
        assert_snapshot!(report, @r"
        error: that is much
        --> a.toml:2:70
        ");
    }

    #[test]
    fn the_end_of_the_text_is_a_place() {
        for text in ["", "a", "a\n", "a\r\n", "ä"] {
            let end = text.len();
            let report = Faults::new("a.toml", text, vec![Fault::new(end..end, "more was due")]);
            assert!(report.to_string().contains("--> a.toml:"), "{report}");
        }
    }

    #[test]
    fn many_faults_are_counted() {
        let faults: Vec<Fault> = (0..250).map(|at| Fault::new(at..at + 1, "no")).collect();
        let faults = Faults::new("a.toml", &"\n".repeat(250), faults);
        assert_eq!(faults.len(), 250);
        let report = faults.to_string();
        assert_eq!(report.matches("error: no").count(), MOST_FAULTS);
        assert!(report.ends_with("error: 150 more faults in a.toml are not shown"));
    }

    #[test]
    fn a_whole_file_has_no_line() {
        let faults = Faults::of_whole_file("a.toml", "a.toml is too large", "make it small");
        assert_snapshot!(faults, @r"
        error: a.toml is too large
         |
         = help: make it small
        ");
    }
}

//! The latest lines of talk, shown for a while at the lower left of the picture. In a large lobby, this is the picture
//! of the liveliest room, so that they cover neither the menu nor a list. A line that is too wide takes several rows.
//!
//! Lines come from the room, from the lobby, from single visitors, and from the host. The session also remembers the
//! last lines of other visitors that it has shown, for reports.

use std::collections::VecDeque;
use std::time::Duration;

use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line as TextLine, Span};
use unicode_width::UnicodeWidthChar;

use super::draw::overhead;
use super::ignored::Ignored;
use crate::accounts::Name;
use crate::line::Line;
use crate::rooms::room::ChatLine;
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::PlayerColor;
use cellcaster::tui::canvas::Canvas;

/// How long a line is shown.
const SHOWN_FOR: Duration = Duration::from_secs(8);
/// The maximum number of lines shown.
const MAX_LINES: usize = 5;
/// The number of earlier lines that a new arrival sees.
const EARLIER: u64 = 2;

/// The number of lines that the session remembers.
const MAX_REMEMBERED: usize = 32;
/// The number of lines in a report.
const MAX_REPORTED: usize = 5;

/// A line that is shown.
#[derive(Clone, Debug)]
pub(crate) struct Remark {
    /// The speaker and, in a room, their colour; `None` for the room and the host.
    by: Option<(String, Option<PlayerColor>)>,
    text: String,
    until: Duration,
    is_of_host: bool,
}

/// The lines on display.
#[derive(Clone, Debug, Default)]
pub(crate) struct Talk {
    /// The number of the last line received from the room; `None` before the first look.
    known: Option<u64>,
    remarks: VecDeque<Remark>,
    /// The last lines of visitors, with their names.
    remembered: VecDeque<(Line, String)>,
    /// The last visitor who wrote to this one.
    correspondent: Option<Line>,
    /// Whether the visitor has switched chat off.
    is_off: bool,
}

impl Talk {
    /// Begins with the lines of another room.
    pub(crate) fn enter_room(&mut self) {
        self.known = None;
    }

    /// Adds the new lines in `said` whose speaker is not ignored.
    pub(crate) fn hear(&mut self, said: &[ChatLine], ignored: &Ignored, now: Duration) {
        let Some(last) = said.last().map(|said| said.number) else { return };
        let known = self.known.unwrap_or(last.saturating_sub(EARLIER));
        self.known = Some(last);
        for said in said.iter().filter(|said| said.number > known) {
            let speaker = said.by.as_ref();
            if speaker.is_some_and(|(name, _)| ignored.contains(name)) {
                continue;
            }
            if let Some((name, _)) = speaker {
                self.remember(name, &said.text);
            }
            let by = speaker.map(|(name, color)| (name.to_string(), Some(*color)));
            self.push(by, said.text.clone(), false, now);
        }
    }

    /// Adds a line of another visitor, to this one alone or to everybody in the lobby.
    pub(crate) fn hear_visitor(
        &mut self,
        from: Line,
        text: &Line,
        is_private: bool,
        now: Duration,
    ) {
        self.remember(&from, text.as_str());
        let mark = if is_private { " (private)" } else { "" };
        self.push(Some((format!("{from}{mark}"), None)), text.to_string(), false, now);
        if is_private {
            self.correspondent = Some(from);
        }
    }

    /// Shows the visitor's own line to another visitor.
    pub(crate) fn told(&mut self, to: &Line, text: &Line, now: Duration) {
        self.push(Some((format!("to {to} (private)"), None)), text.to_string(), true, now);
    }

    /// The last visitor who wrote to this one.
    pub(crate) fn correspondent(&self) -> Option<&Line> {
        self.correspondent.as_ref()
    }

    /// The last lines of a player, oldest first.
    pub(crate) fn lines_of(&self, player: &Line) -> Vec<String> {
        let player = Ignored::new(vec![Name::kept(player.as_str())]);
        let lines = self.remembered.iter().filter(|(name, _)| player.contains(name));
        let lines: Vec<&String> = lines.map(|(_, text)| text).collect();
        let first = lines.len().saturating_sub(MAX_REPORTED);
        lines[first..].iter().map(|&text| text.clone()).collect()
    }

    /// Shows a line from the host, even if chat is off.
    pub(crate) fn hear_host(&mut self, text: String, now: Duration) {
        self.push(None, text, true, now);
    }

    /// Returns true if `said` contains new lines.
    pub(crate) fn is_behind(&self, said: &[ChatLine]) -> bool {
        said.last().is_some_and(|said| self.known != Some(said.number))
    }

    /// Removes expired lines; returns whether there were any.
    pub(crate) fn forget_old(&mut self, now: Duration) -> bool {
        let before = self.remarks.len();
        self.remarks.retain(|remark| remark.until > now);
        self.remarks.len() < before
    }

    /// The time at which the next line expires.
    pub(crate) fn next_end(&self) -> Option<Duration> {
        self.remarks.iter().map(|remark| remark.until).min()
    }

    /// Switches chat on or off.
    pub(crate) fn toggle(&mut self) {
        self.is_off = !self.is_off;
    }

    /// Returns true if chat is shown.
    pub(crate) fn is_on(&self) -> bool {
        !self.is_off
    }

    /// The lines to show, newest last.
    pub(crate) fn shown(&self) -> impl DoubleEndedIterator<Item = &Remark> {
        self.remarks.iter().filter(|remark| !self.is_off || remark.is_of_host)
    }

    fn push(
        &mut self,
        by: Option<(String, Option<PlayerColor>)>,
        text: String,
        is_of_host: bool,
        now: Duration,
    ) {
        self.remarks.push_back(Remark { by, text, until: now + SHOWN_FOR, is_of_host });
        if self.remarks.len() > MAX_LINES {
            self.remarks.pop_front();
        }
    }

    fn remember(&mut self, name: &Line, text: &str) {
        self.remembered.push_back((name.clone(), text.to_owned()));
        if self.remembered.len() > MAX_REMEMBERED {
            self.remembered.pop_front();
        }
    }
}

/// The style of a name without a colour.
const BOLD: Style = Style::new().add_modifier(Modifier::BOLD);
/// The rows at the top of the picture that stay free.
const ROWS_ABOVE: u16 = 3;

/// Draws `remarks`, newest at the bottom, or above the typed line if there is one.
pub(crate) fn draw<'r>(
    canvas: &mut impl Canvas,
    picture: Rect,
    remarks: impl DoubleEndedIterator<Item = &'r Remark>,
    is_typed: bool,
    depth: ColorDepth,
) {
    let bottom = picture.bottom() - u16::from(is_typed);
    let rows = (picture.top() + ROWS_ABOVE..bottom).rev();
    let lines =
        remarks.rev().flat_map(|remark| remark.rows(picture.width, depth).into_iter().rev());
    for (y, line) in rows.zip(lines) {
        let width = (line.width() as u16).min(picture.width);
        canvas.draw_widget(line, Rect { y, width, height: 1, ..picture });
    }
}

impl Remark {
    /// The rows of the remark in this width.
    fn rows(&self, columns: u16, depth: ColorDepth) -> Vec<TextLine<'static>> {
        let (name, style) = match &self.by {
            None => ("", BOLD),
            Some((name, None)) => (name.as_str(), BOLD),
            Some((name, Some(color))) => (name.as_str(), overhead::style(*color, depth)),
        };
        let whole = format!("{name} {}", self.text);
        let rows = rows_of(whole.trim_start(), usize::from(columns.saturating_sub(2)));
        let mut rows = rows.into_iter();
        let first = rows.next().unwrap_or_default();
        let (by, text) = first.split_at(if first.starts_with(name) { name.len() } else { 0 });
        let by = (!by.is_empty()).then(|| Span::styled(format!(" {by}"), style));
        let blank = if by.is_some() { "" } else { " " };
        let first = by.into_iter().chain([Span::raw(format!("{blank}{text} "))]).collect();
        [first].into_iter().chain(rows.map(|row| TextLine::raw(format!(" {row} ")))).collect()
    }
}

/// Divides a text into rows of at most `columns` columns, between words where possible.
fn rows_of(text: &str, columns: usize) -> Vec<&str> {
    let (mut rows, mut rest) = (Vec::new(), text);
    while !rest.is_empty() {
        let mut width = 0;
        let fits = |(_, character): &(usize, char)| {
            width += character.width().unwrap_or(0);
            width > columns
        };
        let end = rest.char_indices().find(fits).map_or(rest.len(), |(end, _)| end);
        // A row takes at least one character, however narrow the picture is.
        let end = end.max(rest.chars().next().map_or(0, char::len_utf8));
        let is_last = end == rest.len();
        let end = rest[..end].rfind(' ').filter(|&blank| blank > 0 && !is_last).unwrap_or(end);
        rows.push(&rest[..end]);
        rest = rest[end..].trim_start();
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(numbers: std::ops::RangeInclusive<u64>) -> Vec<ChatLine> {
        numbers.map(|number| ChatLine { number, by: None, text: format!("{number}") }).collect()
    }

    fn shown(talk: &Talk) -> Vec<&str> {
        talk.shown().map(|remark| remark.text.as_str()).collect()
    }

    #[test]
    fn a_wide_line_is_divided_between_words() {
        let rows = |text, columns| rows_of(text, columns).join("|");
        assert_eq!(rows("Jon anybody for a race?", 12), "Jon anybody|for a race?");
        assert_eq!(rows("Jon anybody", 11), "Jon anybody");
        assert_eq!(rows("0123456789 ab", 4), "0123|4567|89|ab");
        assert_eq!(rows("漢字漢字", 5), "漢字|漢字");
        assert_eq!(rows("漢字", 0), "漢|字");
        assert_eq!(rows("", 7), "");
    }

    #[test]
    fn lines_are_shown_once_and_for_a_while() {
        let at = Duration::from_secs;
        let mut talk = Talk::default();
        let nobody = Ignored::default();
        talk.hear(&said(1..=8), &nobody, at(10));
        assert_eq!(shown(&talk), ["7", "8"]);
        talk.hear(&said(2..=9), &nobody, at(12));
        talk.hear(&said(2..=9), &nobody, at(13));
        assert_eq!(shown(&talk), ["7", "8", "9"]);
        assert!(!talk.is_behind(&said(2..=9)) && talk.is_behind(&said(2..=10)));
        assert_eq!(talk.next_end(), Some(at(18)));
        assert!(talk.forget_old(at(18)));
        assert_eq!(shown(&talk), ["9"]);
        talk.hear(&said(10..=30), &nobody, at(20));
        assert_eq!(shown(&talk), ["26", "27", "28", "29", "30"]);
        talk.toggle();
        talk.hear_host("the host".to_owned(), at(20));
        assert_eq!(shown(&talk), ["the host"]);
    }
}

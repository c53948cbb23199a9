//! The latest chat lines, shown for a while at the lower left of the picture.

use std::collections::VecDeque;
use std::time::Duration;

use ratatui::layout::Rect;
use ratatui::text::{Line as TextLine, Span};

use super::draw::overhead;
use crate::line::Line;
use crate::rooms::room::Said;
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::PlayerColor;
use cellcaster::tui::canvas::Canvas;

/// How long a line is shown.
const SHOWN: Duration = Duration::from_secs(8);
/// The maximum number of lines shown.
const MAX_LINES: usize = 5;
/// The number of earlier lines that a new arrival sees.
const EARLIER: u64 = 2;

/// A line that is shown.
#[derive(Clone, Debug)]
pub(crate) struct Remark {
    /// The speaker; `None` for the room and the host.
    pub(crate) by: Option<(Line, PlayerColor)>,
    pub(crate) text: String,
    until: Duration,
    is_of_host: bool,
}

/// The lines on display.
#[derive(Clone, Debug, Default)]
pub(crate) struct Talk {
    /// The number of the last line received from the room; `None` before the first look.
    known: Option<u64>,
    remarks: VecDeque<Remark>,
    /// Whether the visitor has switched chat off.
    is_off: bool,
}

impl Talk {
    /// Adds the new lines in `said`.
    pub(crate) fn hear(&mut self, said: &[Said], now: Duration) {
        let Some(last) = said.last().map(|said| said.number) else { return };
        let known = self.known.unwrap_or(last.saturating_sub(EARLIER));
        self.known = Some(last);
        for said in said.iter().filter(|said| said.number > known) {
            let (by, text) = (said.by.clone(), said.text.clone());
            self.push(Remark { by, text, until: now + SHOWN, is_of_host: false });
        }
    }

    /// Shows a line from the host, even if chat is off.
    pub(crate) fn hear_host(&mut self, text: String, now: Duration) {
        self.push(Remark { by: None, text, until: now + SHOWN, is_of_host: true });
    }

    /// Returns true if `said` contains new lines.
    pub(crate) fn is_behind(&self, said: &[Said]) -> bool {
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

    fn push(&mut self, remark: Remark) {
        self.remarks.push_back(remark);
        if self.remarks.len() > MAX_LINES {
            self.remarks.pop_front();
        }
    }
}

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
    for (y, remark) in rows.zip(remarks.rev()) {
        let by = remark.by.as_ref();
        let name = by
            .map(|(name, color)| Span::styled(format!(" {name}"), overhead::style(*color, depth)));
        let text = Span::raw(format!(" {} ", remark.text));
        let line = name.into_iter().chain([text]).collect::<TextLine<'_>>();
        let width = (line.width() as u16).min(picture.width);
        canvas.draw_widget(line, Rect { y, width, height: 1, ..picture });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(numbers: std::ops::RangeInclusive<u64>) -> Vec<Said> {
        numbers.map(|number| Said { number, by: None, text: format!("{number}") }).collect()
    }

    fn shown(talk: &Talk) -> Vec<&str> {
        talk.shown().map(|remark| remark.text.as_str()).collect()
    }

    #[test]
    fn lines_are_shown_once_and_for_a_while() {
        let at = Duration::from_secs;
        let mut talk = Talk::default();
        talk.hear(&said(1..=8), at(10));
        assert_eq!(shown(&talk), ["7", "8"]);
        talk.hear(&said(2..=9), at(12));
        talk.hear(&said(2..=9), at(13));
        assert_eq!(shown(&talk), ["7", "8", "9"]);
        assert!(!talk.is_behind(&said(2..=9)) && talk.is_behind(&said(2..=10)));
        assert_eq!(talk.next_end(), Some(at(18)));
        assert!(talk.forget_old(at(18)));
        assert_eq!(shown(&talk), ["9"]);
        talk.hear(&said(10..=30), at(20));
        assert_eq!(shown(&talk), ["26", "27", "28", "29", "30"]);
        talk.toggle();
        talk.hear_host("the host".to_owned(), at(20));
        assert_eq!(shown(&talk), ["the host"]);
    }
}

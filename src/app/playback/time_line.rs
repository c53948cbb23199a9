//! The time line: the row at the bottom of the window with the time, the marks, the length, the
//! speed and the view.

use ratatui::layout::Rect;
use ratatui::style::Color;

use super::recorded::{Mark, MarkKind};
use crate::app::status::whole_seconds;
use crate::color::palette::ColorDepth;
use crate::game::STEP;
use crate::tui::GlyphSet;
use crate::tui::canvas::Canvas;

/// The minimum width of the line itself. Below it, the words to the right are left out.
const MIN_BAR: u16 = 10;

/// The contents of the row.
pub(crate) struct TimeLine<'a> {
    /// The number of steps of the record, and of those that were read.
    pub(crate) steps: u64,
    pub(crate) read: u64,
    pub(crate) is_read: bool,
    pub(crate) marks: &'a [Mark],
    /// The number of steps before the place that is shown.
    pub(crate) step: u64,
    /// The speed, or why nothing moves.
    pub(crate) speed: &'a str,
    /// The name of the view.
    pub(crate) view: &'a str,
}

/// The columns of the line between the words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) struct Bar {
    pub(crate) x: u16,
    pub(crate) y: u16,
    pub(crate) width: u16,
}

impl Bar {
    /// The column that stands for a place in a run of `steps` steps.
    fn column(self, step: u64, steps: u64) -> u16 {
        let last = u64::from(self.width.saturating_sub(1));
        let column = (step.min(steps) * last + steps / 2).checked_div(steps).unwrap_or(0);
        self.x + column as u16
    }

    /// The step that the column at `x` stands for; `None` if the line is not there.
    pub(crate) fn step_at(self, x: u16, y: u16, steps: u64) -> Option<u64> {
        let column = x.checked_sub(self.x).filter(|&column| column < self.width && y == self.y)?;
        Some(steps * u64::from(column) / u64::from(self.width - 1).max(1))
    }
}

impl TimeLine<'_> {
    /// Draws the row, and returns where the line is.
    pub(crate) fn draw(
        &self,
        canvas: &mut impl Canvas,
        area: Rect,
        glyphs: GlyphSet,
        depth: ColorDepth,
    ) -> Bar {
        let Self { steps, step, speed, view, .. } = self;
        let time = |steps: u64| whole_seconds(steps as f64 * STEP).to_string();
        let (left, length) = (time(*step), time(*steps));
        let rights =
            [format!("{length}  {speed:<8}{view:<5}"), format!("{length}  {speed}"), length];
        // The blank columns: at both ends, and beside the line.
        let bar = |right: &String| area.width.saturating_sub((left.len() + right.len()) as u16 + 4);
        let right = rights.iter().find(|right| bar(right) >= MIN_BAR).unwrap_or(&rights[2]);
        let mut write = |x: u16, text: &str| {
            let columns = (x..area.right()).zip(text.chars());
            columns.for_each(|(x, it)| canvas.draw_character(x, area.y, it, [Color::Reset; 2]));
        };
        write(area.x, &" ".repeat(area.width.into()));
        write(area.x + 1, &left);
        let bar = Bar { x: area.x + 2 + left.len() as u16, y: area.y, width: bar(right) };
        write(bar.x + bar.width + 1, right);
        self.draw_bar(canvas, bar, glyphs, depth);
        bar
    }

    fn draw_bar(&self, canvas: &mut impl Canvas, bar: Bar, glyphs: GlyphSet, depth: ColorDepth) {
        let Self { marks, is_read, .. } = self;
        let [passed, read, unread, here] =
            if glyphs.has_blocks() { ['━', '─', '·', '█'] } else { ['=', '-', '.', '#'] };
        let column = |step: u64| bar.column(step, self.steps);
        let (cursor, reader) = (column(self.step), column(self.read));
        for x in bar.x..bar.x + bar.width {
            let part = if x < cursor {
                passed
            } else if x <= reader || *is_read {
                read
            } else {
                unread
            };
            canvas.draw_character(x, bar.y, part, [Color::Reset; 2]);
        }
        // The most important marks are drawn last.
        for kind in MarkKind::ALL {
            for mark in marks.iter().filter(|mark| mark.kind == kind) {
                let colors = [color(kind, depth), Color::Reset];
                canvas.draw_character(column(mark.step), bar.y, kind.name().1, colors);
            }
        }
        if bar.width > 0 {
            canvas.draw_character(cursor, bar.y, here, [Color::Reset; 2]);
        }
    }
}

fn color(kind: MarkKind, depth: ColorDepth) -> Color {
    match (depth, kind) {
        (ColorDepth::Mono, _) => Color::Reset,
        (_, MarkKind::Find | MarkKind::Catch) => Color::Indexed(11),
        (_, MarkKind::Alarm | MarkKind::Death) => Color::Indexed(9),
        (_, MarkKind::End) => Color::Indexed(10),
    }
}

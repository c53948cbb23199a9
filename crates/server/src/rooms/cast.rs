//! The cast of a room: the room from above, for players of asciicasts.
//!
//! Beside each log is a cast as a file (version 2). Only the version that wrote a log can replay it. Every player of
//! asciicasts shows the cast, whatever becomes of the rules: the whole level, an arrow for each member, and their
//! points. Browsers may watch casts, so a cast contains no chat; the log does.
//!
//! The file is drawn while the room runs, four pictures a second. With eight members who walk around in the museum, a
//! minute takes 90 kB and 0.06 s of processor time. A room without members takes no steps, and its cast stands still.
//!
//! Rejected: drawing the cast when the log is complete. The log of a standing room is complete when the server ends,
//! after days whose replay would take minutes. Also rejected: what a member saw, at thirty times the bytes; and
//! compressing the file, to an eleventh, because it could not be shown or searched as it is.

use std::fmt::Write as _;

use cellcaster::app::parts::of_steps;
use cellcaster::color::Rgb;
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::{STEP, STEPS_PER_SECOND};
use cellcaster::terminal::CellWriter;
use cellcaster::tui::canvas::Canvas;
use cellcaster::tui::{GlyphSet, MapMark, Minimap, color_at};
use cellcaster::world::FieldOfView;
use ratatui::backend::Backend;
use ratatui::layout::{Rect, Size};
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span};
use ratatui::widgets::{Paragraph, Wrap};
use serde_json::json;

use crate::rooms::room::{MemberView, RoomView};

/// The number of steps between two pictures.
pub(crate) const INTERVAL: u64 = STEPS_PER_SECOND as u64 / 4;
pub(crate) const SIZE: Size = Size::new(80, 24);
/// The rows below the map for the members.
const MEMBER_ROWS: u16 = 2;
/// Hides the cursor.
const HIDE: &str = "\x1b[?25l";

/// Draws the pictures of a cast.
pub(crate) struct Cast {
    writer: CellWriter<Vec<u8>>,
    /// The number of pictures up to now, including pictures without a change.
    pictures: u64,
}

impl Cast {
    pub(crate) fn new() -> Self {
        Self { writer: CellWriter::new(Vec::new(), SIZE), pictures: 0 }
    }

    /// The first line of the file.
    pub(crate) fn header() -> String {
        let header = json!({ "version": 2, "width": SIZE.width, "height": SIZE.height });
        format!("{header}\n")
    }

    /// The line with the next picture; `None` if the picture has not changed.
    pub(crate) fn line(&mut self, room: &RoomView) -> Option<String> {
        let seconds = (self.pictures * INTERVAL) as f64 * STEP;
        let text = self.next(room);
        (!text.is_empty()).then(|| format!("{}\n", json!([seconds, "o", text])))
    }

    /// The bytes that change the last picture into the next one; for the first picture, all of it. They are right for
    /// every terminal that shows the last picture, whatever was written to it before.
    pub(crate) fn next(&mut self, room: &RoomView) -> String {
        let mut bytes = if self.pictures == 0 { HIDE.into() } else { Vec::new() };
        self.pictures += 1;
        self.writer.forget_pen();
        self.writer.draw_frame(|screen| draw(screen, room));
        // Writing into memory cannot fail.
        _ = Backend::flush(&mut self.writer);
        bytes.append(self.writer.output_mut());
        String::from_utf8_lossy(&bytes).into_owned()
    }
}

fn draw(canvas: &mut impl Canvas, room: &RoomView) {
    let area = canvas.bounds();
    let below = area.height - MEMBER_ROWS;
    let title = Rect { height: 1, ..area };
    let map = Rect { y: 1, height: below - 1, ..area };
    let world = room.game.world();
    let level = if world.title().is_empty() { &room.header.level } else { world.title() };
    let text = format!("{} in {level}, {}", room.header.mode.title(), of_steps(room.step));
    canvas.draw_widget(Line::styled(text, Modifier::BOLD), title);
    draw_map(canvas, map, room, GlyphSet::default(), ColorDepth::default());
    let names = room.members.iter().flat_map(|member| [label(member), Span::raw("  ")]);
    let names = Paragraph::new(names.collect::<Line<'_>>()).wrap(Wrap { trim: true });
    canvas.draw_widget(names, Rect { y: below, height: MEMBER_ROWS, ..area });
}

/// Draws the whole level, and an arrow for each member.
pub(crate) fn draw_map(
    canvas: &mut impl Canvas,
    area: Rect,
    room: &RoomView,
    glyphs: GlyphSet,
    depth: ColorDepth,
) {
    let view = FieldOfView::default();
    let seen = |member: &MemberView| Some(room.game.seen_by(member.player?)?.camera(view));
    let cameras: Vec<_> =
        room.members.iter().filter_map(|it| Some((it.color, seen(it)?))).collect();
    let first = cameras.first().map(|(_, camera)| *camera);
    let camera = first.unwrap_or_else(|| room.game.world().start_camera(view));
    let map = Minimap::new(room.game.world(), &camera).glyphs(glyphs).color_depth(depth);
    map.paint(area, canvas);
    for (color, camera) in &cameras {
        let mark = MapMark { position: camera.position(), heading: camera.heading };
        map.paint_arrow(area, canvas, &mark, color.rgb());
    }
}

/// A member's name in their colour, with their points and how they are.
fn label(member: &MemberView) -> Span<'_> {
    let mut text = member.name.to_string();
    // Writing to a string cannot fail.
    _ = write!(text, " {}", member.points);
    if let Some(emote) = member.emote {
        _ = write!(text, " {}", emote.text());
    }
    Span::styled(text, style(member.color.rgb()))
}

fn style(color: Rgb) -> Style {
    Style::new().fg(color_at(ColorDepth::True, color))
}

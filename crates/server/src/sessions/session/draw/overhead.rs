//! Labels above the heads of nearby players and ghosts.

use glam::DVec2;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::Span;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use crate::rooms::room::looks::FigureLook;
use crate::rooms::room::{MemberView, Mode, Role, RoomView};
use crate::sessions::session::ignored::Ignored;
use crate::sessions::session::stay::SeenGhost;
use cellcaster::app::parts::DrawOptions;
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::{OtherPlayer, PlayerColor, PlayerView};
use cellcaster::render::FrameSize;
use cellcaster::render::Projection;
use cellcaster::tui::canvas::Canvas;
use cellcaster::tui::color_at;
use cellcaster::world::Figure;

/// The distance up to which labels are shown, in cells.
const NEAR: f64 = 8.0;
/// The height of a head above the feet, in cells: of a standing player, of a marked player with the arrow, and of a
/// player lying down.
const HEAD: f64 = 0.7;
const HEAD_MARKED: f64 = 0.95;
const HEAD_DOWN: f64 = 0.3;

/// A label above a head.
struct HeadLabel {
    position: DVec2,
    /// The height of the head, in cells.
    head: f64,
    text: String,
    color: PlayerColor,
}

/// Draws the labels of the other players and of the ghosts that `player` sees nearby.
pub(crate) fn draw(
    canvas: &mut impl Canvas,
    area: Rect,
    options: &DrawOptions,
    player: &PlayerView,
    (room, ignored): (&RoomView, &Ignored),
    ghosts: &[SeenGhost],
) {
    let [columns, rows] = options.glyphs.pixels_per_cell();
    let (width, height) = (u32::from(area.width) * columns, u32::from(area.height) * rows);
    let Some(size) = FrameSize::new(width, height) else { return };
    let camera = player.camera(options.field_of_view);
    let aspect = options.cell_aspect.of_pixels(options.glyphs);
    let projection = Projection::new(&camera, size, aspect);
    let distance = |position: DVec2| position.distance(camera.position());
    let others = player.others().filter(|it| it.is_in_sight && distance(it.position) <= NEAR);
    let others = others.filter_map(|other| HeadLabel::of_member(&other, room, ignored));
    let is_seen = |figure: &Figure| {
        distance(figure.position) <= NEAR && player.sees_figure(figure.position, figure.base)
    };
    let ghosts = ghosts.iter().filter(|ghost| is_seen(&ghost.figure)).map(HeadLabel::of_ghost);
    let mut all: Vec<HeadLabel> = others.chain(ghosts).collect();
    // Sorted from far to near, so that the nearest is drawn last.
    all.sort_by(|one, other| distance(other.position).total_cmp(&distance(one.position)));
    for HeadLabel { position, head, text, color } in all {
        let place = projection.place(position);
        if place.depth > 0.1 {
            let row = projection.row_at(head, place.depth) / f64::from(rows) - 1.0;
            let left = place.column / f64::from(columns) - text.width() as f64 / 2.0;
            let style = style(color, options.depth);
            draw_clipped(canvas, area, [left, row.max(0.0)], &text, style);
        }
    }
}

impl HeadLabel {
    fn of_member(other: &OtherPlayer, room: &RoomView, ignored: &Ignored) -> Option<Self> {
        let member = room.member_of(other.id)?;
        let head = match member.look {
            FigureLook::Marked => HEAD_MARKED,
            _ if other.is_down => HEAD_DOWN,
            _ => HEAD,
        };
        Some(Self {
            position: other.position,
            head: other.feet + head,
            text: label(member, room.header.mode, ignored),
            color: member.color,
        })
    }

    fn of_ghost(seen: &SeenGhost) -> Self {
        let SeenGhost { ghost, color, figure } = *seen;
        let head = figure.base + HEAD;
        Self { position: figure.position, head, text: ghost.label(), color }
    }
}

/// The label of a member: their role, name and, unless they are ignored, their emote.
fn label(member: &MemberView, mode: Mode, ignored: &Ignored) -> String {
    let role = match (member.role, mode) {
        (Role::Seeker, Mode::Tag) => "IT ",
        (Role::Seeker, _) => "seeks: ",
        _ => "",
    };
    let emote = member.emote.filter(|_| !ignored.contains(&member.name));
    let emote = emote.map_or_else(String::new, |emote| format!(" {}", emote.text()));
    format!("{role}{}{emote}", member.name)
}

/// The style of a member's colour on black.
pub(crate) fn style(color: PlayerColor, depth: ColorDepth) -> Style {
    match depth {
        ColorDepth::Mono => Style::new().add_modifier(Modifier::REVERSED),
        depth => {
            let ground = color_at(depth, cellcaster::color::Rgb::BLACK);
            Style::new().fg(color_at(depth, color.rgb())).bg(ground)
        }
    }
}

/// Draws the part of `text` that lies inside `area`. The start may lie outside.
fn draw_clipped(
    canvas: &mut impl Canvas,
    area: Rect,
    [left, row]: [f64; 2],
    text: &str,
    style: Style,
) {
    let limit = f64::from(u16::MAX);
    let [left, row] = [left, row].map(|place| place.clamp(-limit, limit).floor() as i32);
    if row >= i32::from(area.height) {
        return;
    }
    let mut column = left;
    for character in text.chars() {
        let width = character.width().unwrap_or(0) as i32;
        if column >= 0 && column + width <= i32::from(area.width) {
            let place = Rect {
                x: area.x + column as u16,
                y: area.y + row as u16,
                width: width as u16,
                height: 1,
            };
            let mut bytes = [0; 4];
            canvas.draw_widget(Span::styled(&*character.encode_utf8(&mut bytes), style), place);
        }
        column += width;
    }
}

#[cfg(test)]
mod tests {
    use ratatui::buffer::{Buffer, Cell};

    use super::*;

    #[test]
    fn a_name_is_cut_at_the_edges_of_the_picture() {
        let shown = |left: f64, text: &str| -> String {
            let mut buffer = Buffer::empty(Rect::new(0, 0, 10, 2));
            let area = Rect::new(2, 0, 6, 1);
            draw_clipped(&mut buffer, area, [left, 0.0], text, Style::new());
            buffer.content()[..10].iter().map(Cell::symbol).collect()
        };
        assert_eq!(shown(1.0, "Mara"), "   Mara   ");
        assert_eq!(shown(-2.0, "Mara"), "  ra      ");
        assert_eq!(shown(4.2, "Mara"), "      Ma  ");
        assert_eq!(shown(-90.0, "Mara").trim(), "");
        assert_eq!(shown(f64::NAN, "Mara"), "  Mara    ");
        assert_eq!(shown(f64::INFINITY, "Mara").trim(), "");
        assert_eq!(shown(3.0, "日本").trim_end(), "     日");
        assert_eq!(shown(-1.0, "日本").trim_end(), "   本");
    }
}

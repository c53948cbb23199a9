//! Panels about members: the list of members, and the standings of a round.

use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span, Text};
use unicode_width::UnicodeWidthStr;

use super::overhead::style;
use super::seconds_left;
use crate::rooms::room::{Catalog, Finish, MemberView, Mode, NAME_COLUMNS, Role, RoomView};
use cellcaster::app::parts::{message, of_steps, whole_seconds};
use cellcaster::color::palette::ColorDepth;
use cellcaster::tui::canvas::Canvas;

/// Draws the list of members with their points.
pub(crate) fn draw_members(
    canvas: &mut impl Canvas,
    picture: Rect,
    room: &RoomView,
    catalog: &Catalog,
    depth: ColorDepth,
) {
    let header = &room.header;
    let place = Line::raw(format!("{}  points", catalog.title(&header.level))).right_aligned();
    let members = room.members.iter().map(|member| {
        let role = role(member, header.mode);
        Line::from_iter([
            name(member, depth),
            Span::raw(format!(" {role:<6} {:>3}", member.points)),
        ])
    });
    let lines: Vec<Line> = [place].into_iter().chain(members).collect();
    let title = format!("{} {}/{}", header.mode.title(), room.members.len(), header.mode.most());
    panel(canvas, picture, &title, lines);
}

/// Draws the standings of a finished round.
pub(crate) fn draw_standings(
    canvas: &mut impl Canvas,
    picture: Rect,
    room: &RoomView,
    depth: ColorDepth,
) {
    let width = if room.standings.iter().all(|it| it.steps.is_some()) { 7 } else { 14 };
    let places = room.standings.iter().enumerate().filter_map(|(index, standing)| {
        let member = room.member(standing.member)?;
        let all = member.points.saturating_add(standing.points);
        let place = member.finish.map_or(index + 1, |finish| finish.place);
        let place = standing.steps.map_or_else(String::new, |_| format!("{place}."));
        let steps = standing.steps.map(of_steps);
        let steps = steps.unwrap_or_else(|| "did not finish".to_owned());
        let gained = format!("+{}", standing.points);
        let text = format!(" {steps:>width$} {gained:>3} {all:>3}");
        let place = Span::raw(format!("{place:<3}"));
        Some(Line::from_iter([place, name(member, depth), Span::raw(text)]))
    });
    let head = Line::raw(format!("{}   round  all", counted(room.header.mode))).right_aligned();
    let next = whole_seconds(seconds_left(room).unwrap_or(0) as f64);
    let next = Line::raw(format!("next round in {next}")).centered();
    let lines: Vec<Line> = [head].into_iter().chain(places).chain([next]).collect();
    panel(canvas, picture, "the round is over", lines);
}

/// Draws a panel with as many lines as fit.
fn panel(canvas: &mut impl Canvas, picture: Rect, title: &str, mut lines: Vec<Line>) {
    lines.truncate(usize::from(picture.height.saturating_sub(2)).max(1));
    message(canvas, picture, title, Text::from(lines));
}

/// The meaning of the times in the standings.
const fn counted(mode: Mode) -> &'static str {
    match mode {
        Mode::Tag => "time as \"it\"",
        Mode::Hide => "time hidden",
        Mode::Race | Mode::Together | Mode::Alone | Mode::Roam => "time to the exit",
    }
}

/// The name in the member's colour, padded to the width of the widest possible name.
fn name(member: &MemberView, depth: ColorDepth) -> Span<'static> {
    let blanks = NAME_COLUMNS.saturating_sub(member.name.as_str().width());
    let style = match depth {
        ColorDepth::Mono => Style::new(),
        depth => style(member.color, depth),
    };
    Span::styled(format!("{}{:blanks$}", member.name, ""), style)
}

fn role(member: &MemberView, mode: Mode) -> String {
    let role = match (member.role, mode) {
        _ if member.is_away => "away",
        (Role::Seeker, Mode::Tag) => "is it",
        (Role::Seeker, _) => "seeks",
        (Role::Done, Mode::Race) => return member.finish.map_or_else(String::new, Finish::ordinal),
        (Role::Done, _) => "is out",
        (Role::Player, Mode::Hide) => "hides",
        (Role::Player, _) => "",
    };
    role.to_owned()
}

//! Panels about members: the list of members, and the standings of a round.

use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line, Span, Text};
use unicode_width::UnicodeWidthStr;

use super::overhead::style;
use super::seconds_left;
use crate::rooms::invitation::RoomCode;
use crate::rooms::room::{
    Catalog, MemberView, Mode, NAME_COLUMNS, Role, RoomView, Standing, ordinal,
};
use cellcaster::app::parts::{message, of_steps, whole_seconds};
use cellcaster::color::palette::ColorDepth;
use cellcaster::tui::canvas::Canvas;

/// Draws the list of members with their points, and the code of a private room.
pub(crate) fn draw_members(
    canvas: &mut impl Canvas,
    picture: Rect,
    (room, code): (&RoomView, Option<RoomCode>),
    catalog: &Catalog,
    depth: ColorDepth,
) {
    let header = &room.header;
    let place = Line::raw(format!("{}  points", catalog.title(&header.level))).right_aligned();
    let mut members: Vec<&MemberView> = room.members.iter().collect();
    members.sort_by_key(|member| member.place);
    let members = members.into_iter().map(|member| {
        let role = role(member, header.mode);
        let width = if header.mode == Mode::Race { 11 } else { 6 };
        Line::from_iter([
            name(member, depth),
            Span::raw(format!(" {role:<width$} {:>3}", member.points)),
        ])
    });
    let code = code.map(|code| Line::raw(format!("invitation code {code}")).centered());
    let lines: Vec<Line> = [place].into_iter().chain(members).chain(code).collect();
    let title = format!("{} {}/{}", header.mode.title(), room.members.len(), header.mode.most());
    panel(canvas, picture, &title, lines);
}

/// The number of columns that the panel of standings needs, including its border.
const STANDINGS_COLUMNS: u16 = 3 + NAME_COLUMNS as u16 + 16 + 2 * 2;
/// The minimum number of columns for a replay beside the standings.
const REPLAY_COLUMNS: u16 = 24;
/// The minimum number of rows for a podium above the standings.
const PODIUM_ROWS: u16 = 18;
/// The number of columns of a step of the podium.
const STEP_COLUMNS: usize = 11;

/// The part of the picture that is free beside the standings; the whole picture if that is too narrow. Then the
/// standings cover its middle.
pub(crate) fn beside_standings(picture: Rect) -> Rect {
    match picture.width.checked_sub(STANDINGS_COLUMNS) {
        Some(width) if width >= REPLAY_COLUMNS => {
            Rect { x: picture.x + STANDINGS_COLUMNS, width, ..picture }
        }
        _ => picture,
    }
}

/// Draws the standings of a finished round, on the left if there is a replay beside them.
pub(crate) fn draw_standings(
    canvas: &mut impl Canvas,
    picture: Rect,
    room: &RoomView,
    depth: ColorDepth,
) {
    let places = room.standings.iter().filter_map(|standing| {
        let member = room.member(standing.member)?;
        let all = member.points.saturating_add(standing.points);
        let place =
            standing.steps.map_or_else(String::new, |_| format!("{}.", place(room, standing)));
        let steps = standing.steps.map(of_steps);
        let steps = steps.unwrap_or_else(|| "no time".to_owned());
        let gained = format!("+{}", standing.points);
        let text = format!(" {steps:>7} {gained:>3} {all:>3}");
        let place = Span::raw(format!("{place:<3}"));
        Some(Line::from_iter([place, name(member, depth), Span::raw(text)]))
    });
    let head = Line::raw(format!("{}  round all", counted(room.header.mode))).right_aligned();
    let next = whole_seconds(seconds_left(room).unwrap_or(0) as f64);
    let next = Line::raw(format!("next round in {next}")).centered();
    let podium = if picture.height >= PODIUM_ROWS { podium(room, depth) } else { Vec::new() };
    let lines = podium.into_iter().chain([head]).chain(places).chain([next]).collect();
    let free = beside_standings(picture);
    let place = match room.replay {
        Some(_) if free != picture => Rect { width: picture.width - free.width, ..picture },
        _ => picture,
    };
    panel(canvas, place, "the round is over", lines);
}

/// The place in the standings, from 1. Members with equal points share a place.
fn place(room: &RoomView, standing: &Standing) -> usize {
    room.standings.iter().filter(|other| other.points > standing.points).count() + 1
}

/// The podium: the first three, each on a step as high as their place is good. Empty unless two have a result.
fn podium(room: &RoomView, depth: ColorDepth) -> Vec<Line<'static>> {
    let first = room.standings.iter().take(3).filter(|standing| standing.steps.is_some());
    let first: Vec<_> =
        first.filter_map(|it| Some((place(room, it), room.member(it.member)?))).collect();
    if first.len() < 2 {
        return Vec::new();
    }
    // The second stands on the left of the first, and the third on the right.
    let steps = [1, 0, 2].map(|index| first.get(index));
    let row = |row: usize| {
        let cell = |step: Option<&(usize, &MemberView)>| match step {
            Some((place, member)) if row == *place => label(member, depth),
            Some((place, member)) if row > *place => {
                let text = if row == place + 1 { place.to_string() } else { String::new() };
                let style = style(member.color, depth).add_modifier(Modifier::REVERSED);
                Span::styled(format!("{text:^STEP_COLUMNS$}"), style)
            }
            _ => Span::raw(" ".repeat(STEP_COLUMNS)),
        };
        steps.into_iter().map(cell).collect::<Line<'_>>().centered()
    };
    (1..=4).map(row).chain([Line::default()]).collect()
}

/// A name in the middle of a step of the podium, shortened to its width.
fn label(member: &MemberView, depth: ColorDepth) -> Span<'static> {
    let short = crate::line::Line::of(member.name.as_str(), STEP_COLUMNS - 1);
    let short = short.map_or_else(String::new, |line| line.to_string());
    let blanks = STEP_COLUMNS.saturating_sub(short.width());
    let (left, right) = (blanks / 2, blanks - blanks / 2);
    Span::styled(format!("{:left$}{short}{:right$}", "", ""), name_style(member, depth))
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
    Span::styled(format!("{}{:blanks$}", member.name, ""), name_style(member, depth))
}

fn name_style(member: &MemberView, depth: ColorDepth) -> Style {
    match depth {
        ColorDepth::Mono => Style::new(),
        depth => style(member.color, depth),
    }
}

fn role(member: &MemberView, mode: Mode) -> String {
    let role = match (member.role, mode) {
        _ if member.is_away => "away",
        (Role::Seeker, Mode::Tag) => "is it",
        (Role::Seeker, _) => "seeks",
        (_, Mode::Race) => return place_in_race(member),
        (Role::Done, _) => "is out",
        (Role::Player, Mode::Hide) => "hides",
        (Role::Player, _) => "",
    };
    role.to_owned()
}

/// The place of a racer, with the time of a racer who has finished.
fn place_in_race(member: &MemberView) -> String {
    let time = member.finish.map_or_else(String::new, |finish| format!(" {:>6}", finish.time()));
    member.place.map_or_else(String::new, |place| format!("{}{time}", ordinal(place)))
}

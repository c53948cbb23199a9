//! The status line in a room.

use std::fmt;

use ratatui::layout::Rect;

use crate::rooms::room::{MemberView, Mode, Phase, Role, RoomView, ordinal};
use crate::sessions::session::stay::{Stay, run_seconds, seconds_left};
use crate::sessions::session::ui::Ui;
use cellcaster::app::parts::{HealthSigns, Part, StatusLine, whole_seconds};
use cellcaster::game::{Outcome, PlayerView};
use cellcaster::tui::canvas::Canvas;

impl Ui {
    /// Draws the mode, the time, the state of the player shown, and the name of a watched member.
    pub(crate) fn draw_room_status(
        &mut self,
        canvas: &mut impl Canvas,
        area: Rect,
        room: &RoomView,
    ) {
        let signs = HealthSigns::for_picture(self.glyphs(), self.depth());
        let Self { stay, status, host, controls, pointer, bindings, .. } = self;
        let stats = self.stats.as_ref().filter(|_| self.shows_stats);
        let Some(stay) = stay else { return };
        let seen = stay.seen_through(room);
        status.rewrite(|line| {
            let mission = seen.filter(|_| room.game.is_mission());
            // Without guards, tools have no use, and health matters only once it is reduced.
            let is_safe = |player: &PlayerView| {
                let health = player.health();
                !room.header.mode.has_guards() && health.points == health.most
            };
            if let Some((_, player)) = mission.filter(|(_, player)| !is_safe(player)) {
                line.write_vitals(&room.game, &player, signs)?;
            }
            write_round(line, room)?;
            line.both(Part::Level, format_args!("{}", host.catalog.title(&room.header.level)))?;
            if stay.member.is_some() {
                let is_lit = mission.is_some_and(|(_, player)| player.lamp_is_lit());
                line.write_modes(controls.toggles, pointer.is_on(), is_lit)?;
            }
            if let Some((member, player)) = seen {
                line.write_keys(player.keys())?;
                write_notice(line, stay, room, member, &player)?;
            }
            if let Some(stats) = stats {
                line.write_stats(stats)?;
            }
            if let Some(seconds) = run_seconds(room) {
                line.both(Part::Time, format_args!("{}", whole_seconds(seconds as f64)))?;
            }
            let (here, most) = (room.members.len(), room.header.mode.most());
            line.both(Part::Seen, format_args!("{here}/{most} here"))?;
            line.write_help(bindings)
        });
        canvas.draw_widget(&*status, area);
    }
}

/// Writes the mode and the remaining time.
fn write_round(line: &mut StatusLine, room: &RoomView) -> fmt::Result {
    let mode = room.header.mode.title();
    match seconds_left(room) {
        Some(seconds) => {
            let time = whole_seconds(seconds as f64);
            line.both(Part::Title, format_args!("{mode} {time}"))
        }
        None => line.both(Part::Title, format_args!("{mode}")),
    }
}

/// Writes the most important notice for the player.
fn write_notice(
    line: &mut StatusLine,
    stay: &Stay,
    room: &RoomView,
    member: &MemberView,
    player: &PlayerView,
) -> fmt::Result {
    let own_finish = stay.member.and_then(|id| finish(room.member(id)?, room.header.mode));
    if stay.member != Some(member.id) {
        let own = own_finish.map_or_else(String::new, |finish| format!("{finish} · "));
        let [short, long] = line.forms(Part::Notice);
        let place = place(room, member).filter(|_| own.is_empty());
        let place = place.map_or_else(String::new, |place| format!(", {place}"));
        *short = format!("{own}watching {}", member.name);
        *long = format!("{short}{place} · Tab: the next member");
        return Ok(());
    }
    match player.outcome() {
        Outcome::Dead { cause } => {
            let effect = if stay.dies_for_good { "begins again" } else { "goes on" };
            let [short, long] = line.forms(Part::Notice);
            *short = format!("Enter {effect}");
            *long = format!("killed by {cause} · Enter {effect}");
            Ok(())
        }
        _ if player.message().is_some() => {
            line.both(Part::Notice, format_args!("{}", player.message().unwrap_or_default()))
        }
        Outcome::Won => line.both(Part::Notice, format_args!("{}", own_finish.unwrap_or_default())),
        Outcome::Playing => {
            let [short, long] = line.forms(Part::Notice);
            *long = task(room, member);
            short.clone_from(long);
            if let Some(place) = place(room, member) {
                *long = format!("{place} · {long}");
                *short = place;
            }
            Ok(())
        }
    }
}

/// The text of a member's finish.
fn finish(member: &MemberView, mode: Mode) -> Option<String> {
    let finish = member.finish?;
    Some(match mode {
        Mode::Race => finish.to_string(),
        _ => format!("out, {}", finish.time()),
    })
}

/// The place of a racer among several who has not finished.
fn place(room: &RoomView, member: &MemberView) -> Option<String> {
    let place = member.place.filter(|_| room.members.len() > 1)?;
    Some(format!("{} of {}", ordinal(place), room.members.len().max(place)))
}

/// The text of a member's current task.
fn task(room: &RoomView, member: &MemberView) -> String {
    let it = || room.members.iter().find(|member| member.role == Role::Seeker);
    match (room.header.mode, room.phase, member.role) {
        (_, Phase::Over { .. }, _) => "the round is over".to_owned(),
        (_, Phase::Waiting, _) => "waiting for a second player".to_owned(),
        (Mode::Tag | Mode::Race, Phase::Countdown { .. }, _) => "get ready".to_owned(),
        (Mode::Tag, _, Role::Seeker) => "you are it".to_owned(),
        (Mode::Tag, _, _) => it().map_or_else(String::new, |it| format!("{} is it", it.name)),
        (Mode::Hide, _, Role::Seeker) => "you seek".to_owned(),
        (Mode::Hide, Phase::Countdown { .. }, _) => "hide".to_owned(),
        (Mode::Hide, ..) => "stay hidden".to_owned(),
        (Mode::Race | Mode::Together, Phase::Playing { .. }, _) if seconds_left(room).is_some() => {
            let left = whole_seconds(seconds_left(room).unwrap_or_default() as f64);
            let what = if room.header.mode == Mode::Race { "race" } else { "level" };
            format!("the {what} ends in {left}")
        }
        (Mode::Race, ..) => "be first at the exit".to_owned(),
        (Mode::Together | Mode::Alone | Mode::Roam, ..) => String::new(),
    }
}

//! Lines of chat, and the commands that begin with `/`.
//!
//! A line that begins with `/` is never chat: an unknown command is answered with the list of commands.

use std::time::Duration;

use unicode_width::UnicodeWidthStr;

use super::line_entry::LineEntry;
use super::messages::{Moderation, SessionRequest};
use super::pages::Page;
use super::ui::Ui;
use crate::accounts::AccountSettings;
use crate::line::Line;
use crate::rooms::room::{CHAT_COLUMNS, Command, NAME_COLUMNS};

const COMMANDS: &str = "Commands: /tell, /reply, /players, /ignore, /unignore, /report";
const MODERATORS_COMMANDS: &str = ", /mute, /unmute, /kick";
const WATCHES: &str = "Watchers can't talk in the room; /tell NAME TEXT writes to a player.";

/// The visitors on the pages about players.
#[derive(Clone, Debug, Default)]
pub(crate) struct Players {
    /// The other visitors in the room or in the lobby; `None` until they arrive.
    pub(crate) names: Option<std::sync::Arc<[Line]>>,
    /// Whether the visitor is a moderator.
    pub(crate) moderates: bool,
    /// The player on the page about one player.
    pub(crate) chosen: Option<Line>,
}

impl Ui {
    /// Opens the line of chat with this text in it.
    pub(crate) fn open_chat(&mut self, text: &str) {
        self.entry = LineEntry::beginning(text, columns_of(text));
        self.open(Page::Chat);
    }

    /// Opens the list of players.
    pub(crate) fn open_players(&mut self) {
        self.players.names = None;
        self.ask(SessionRequest::Players);
        self.open(Page::Players);
    }

    /// Shows the room or, outside of rooms, the lobby.
    pub(crate) fn show_home(&mut self) {
        self.show(if self.stay.is_some() { Page::Room } else { Page::Lobby });
    }

    /// Sends a line of chat, or carries out a command.
    pub(crate) fn submit_line(&mut self, line: Line) {
        if let Some(text) = line.as_str().strip_prefix('/') {
            if let Err(sentence) = self.run_command(text) {
                self.advise(sentence);
            }
            return;
        }
        match &self.stay {
            Some(stay) if stay.member.is_none() => self.advise(WATCHES.to_owned()),
            Some(_) => self.ask(SessionRequest::Command(Command::Say(line))),
            None => self.ask(SessionRequest::Say(line)),
        }
    }

    /// Shows a sentence with the lines of chat, even if chat is off.
    pub(crate) fn advise(&mut self, sentence: String) {
        self.talk.hear_host(sentence, self.now);
        self.is_stale = true;
    }

    /// Carries out a command without its `/`.
    fn run_command(&mut self, text: &str) -> Result<(), String> {
        let (verb, rest) = word(text);
        let (name, after) = word(rest);
        let name = || Line::of(name, NAME_COLUMNS).filter(|line| line.as_str() == name);
        let text = || Line::of(after, CHAT_COLUMNS);
        match verb {
            "tell" => {
                let line = name().zip(text()).ok_or("Write /tell NAME TEXT.")?;
                let (to, text) = line;
                self.ask(SessionRequest::Tell { to, text });
            }
            "reply" => {
                let text = Line::of(rest, CHAT_COLUMNS).ok_or("Write /reply TEXT.")?;
                let to = self.talk.correspondent().cloned();
                let to = to.ok_or("Nobody has written to you; write /tell NAME TEXT.")?;
                self.ask(SessionRequest::Tell { to, text });
            }
            "players" => self.open_players(),
            "ignore" => self.ignore(&name().ok_or("Write /ignore NAME.")?),
            "unignore" => self.stop_ignoring(&name().ok_or("Write /unignore NAME.")?),
            "report" => {
                let player = name().ok_or("Write /report NAME, and the reason if you like.")?;
                let lines = self.talk.lines_of(&player);
                self.ask(SessionRequest::Report { player, reason: text(), lines });
            }
            "mute" | "unmute" | "kick" => {
                let (act, reason, usage) = act(verb, after);
                let (player, act) = name().zip(act).ok_or(usage)?;
                let reason = Line::of(reason, CHAT_COLUMNS);
                self.ask(SessionRequest::Moderate { player, act, reason });
            }
            _ => {
                let more = if self.players.moderates { MODERATORS_COMMANDS } else { "" };
                return Err(format!("{COMMANDS}{more}."));
            }
        }
        Ok(())
    }

    /// Ignores a player from now on.
    pub(crate) fn ignore(&mut self, player: &Line) {
        if !self.ignored.add(player) {
            let most = AccountSettings::MAX_IGNORED;
            return self.advise(format!("You ignore {most} players; /unignore NAME ends one."));
        }
        self.save_settings();
        self.advise(format!("You ignore {player}; /unignore {player} ends it."));
    }

    /// Shows the talk of a player again.
    pub(crate) fn stop_ignoring(&mut self, player: &Line) {
        if !self.ignored.remove(player) {
            return self.advise(format!("You do not ignore {player}."));
        }
        self.save_settings();
        self.advise(format!("You no longer ignore {player}."));
    }
}

/// A moderator's act, the reason, and how to write the command. `after` is the text after the player's name. The act is
/// `None` if the time of a mute is missing.
fn act<'t>(verb: &str, after: &'t str) -> (Option<Moderation>, &'t str, &'static str) {
    match verb {
        "mute" => {
            let (time, reason) = word(after);
            let times = [("10m", 10), ("1h", 60), ("1d", 24 * 60)];
            let minutes = times.into_iter().find(|it| it.0 == time).map(|it| it.1);
            let act = minutes.map(|minutes| Moderation::Mute(Duration::from_mins(minutes)));
            (act, reason, "Write /mute NAME and 10m, 1h or 1d.")
        }
        "unmute" => (Some(Moderation::Unmute), "", "Write /unmute NAME."),
        _ => (Some(Moderation::Kick), after, "Write /kick NAME, and the reason if you like."),
    }
}

/// The width of the line of chat in columns, if it contains `text`. The text after a command and a name may be as wide
/// as a line of chat.
pub(crate) fn columns_of(text: &str) -> usize {
    let words = match word(text).0 {
        verb if !verb.starts_with('/') => 0,
        "/reply" => 1,
        _ => 2,
    };
    let before = text.split_inclusive(' ').take(words).map(UnicodeWidthStr::width).sum::<usize>();
    before.min(NAME_COLUMNS + CHAT_COLUMNS) + CHAT_COLUMNS
}

/// The first word of a text, and the rest.
fn word(text: &str) -> (&str, &str) {
    text.split_once(' ').unwrap_or((text, ""))
}

//! What is said in a room.

use std::fmt;

use super::{Finish, MemberId, Mode, Room, Said};
use crate::sessions::line::Line;
use cellcaster::app::parts::of_steps;
use cellcaster::game::PlayerColor;

/// How many lines a room remembers.
pub(crate) const SAID: usize = 8;

impl Room {
    pub(crate) fn say(&mut self, id: MemberId, text: String) {
        let member = self.members.iter().find(|member| member.id == id);
        if let Some(by) = member.map(|member| (member.name.clone(), member.color)) {
            self.remember(Some(by), text);
        }
    }

    pub(crate) fn announce(&mut self, text: String) {
        self.remember(None, text);
    }

    /// Tells all that a member has reached the exit.
    pub(crate) fn announce_finish(&mut self, id: MemberId) {
        let Some(finish) = self.round.finish(id) else { return };
        let Some(member) = self.members.iter().find(|member| member.id == id) else { return };
        match self.header.mode {
            Mode::Race => self.announce(format!("{} finished {finish}.", member.name)),
            Mode::Together => {
                self.announce(format!("{} is out after {}.", member.name, finish.time()));
            }
            Mode::Roam | Mode::Alone | Mode::Tag | Mode::Hide => {}
        }
    }

    fn remember(&mut self, by: Option<(Line, PlayerColor)>, text: String) {
        self.said_count += 1;
        self.said.push_back(Said { number: self.said_count, by, text });
        if self.said.len() > SAID {
            self.said.pop_front();
        }
    }
}

impl Finish {
    /// The place as people say it: 1st, 2nd and so on.
    pub(crate) fn ordinal(self) -> String {
        let ending = match (self.place % 10, self.place % 100) {
            (_, 11..=13) => "th",
            (1, _) => "st",
            (2, _) => "nd",
            (3, _) => "rd",
            _ => "th",
        };
        format!("{}{ending}", self.place)
    }

    /// The time to the exit.
    pub(crate) fn time(self) -> String {
        of_steps(self.steps)
    }
}

impl fmt::Display for Finish {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.ordinal(), self.time())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_ordinals() {
        let finish = |place| Finish { place, steps: 231 }.to_string();
        let told = [1, 2, 3, 4, 11, 12, 13, 21, 112].map(finish);
        let expected = ["1st", "2nd", "3rd", "4th", "11th", "12th", "13th", "21st", "112th"];
        assert_eq!(told, expected.map(|place| format!("{place}, 0:03.8")));
    }
}

//! What is said in a room.

use super::{MemberId, Room, Said};
use crate::game::PlayerColor;
use crate::server::line::Line;

/// How many lines a room remembers.
pub(super) const SAID: usize = 8;

impl Room {
    pub(super) fn say(&mut self, id: MemberId, text: String) {
        let member = self.members.iter().find(|member| member.id == id);
        if let Some(by) = member.map(|member| (member.name.clone(), member.color)) {
            self.remember(Some(by), text);
        }
    }

    pub(super) fn announce(&mut self, text: String) {
        self.remember(None, text);
    }

    fn remember(&mut self, by: Option<(Line, PlayerColor)>, text: String) {
        self.said_count += 1;
        self.said.push_back(Said { number: self.said_count, by, text });
        if self.said.len() > SAID {
            self.said.pop_front();
        }
    }
}

//! Tests of sessions: clients with terminal emulators and one room, in simulated time.

mod bytes;
mod daily;
mod ghosts;
mod home;
mod lag;
mod lobby;
mod pages;
mod pictures;
mod playback;
mod private;
mod room;
mod talk;

use super::*;
use crate::rooms::room::{MemberId, Mode};
use crate::simulation::{ENTER, ESCAPE, HALL, ROOM, Rig, RigOptions, Speaks, catalog, line};
use cellcaster::terminal::CellWriter;
use cellcaster::world::FieldOfView;

impl Session {
    /// The visitor's number as a member.
    pub(crate) fn member(&self) -> Option<MemberId> {
        self.ui.stay.as_ref()?.member
    }

    /// Returns true if the terminal shows the current picture in full.
    pub(crate) fn is_settled(&self, room: Option<&RoomView>) -> bool {
        !self.ui.is_stale(room) && self.protocol.is_settled()
    }

    /// Describes what the next frame is waiting for.
    pub(crate) fn wait(&self, room: Option<&RoomView>) -> String {
        let Self { protocol, ui, ending, pace, .. } = self;
        let (is_ready, is_settled) = (protocol.is_ready(ui.now), protocol.is_settled());
        let (is_stale, sent) = (ui.is_stale(room), protocol.frames_sent());
        let (now, answered) = (ui.now, protocol.frames_answered());
        format!(
            "ready {is_ready}, settled {is_settled}, stale {is_stale}, at {now:?}, {pace:?}, \
             {sent} frames, {answered} answered, {ending:?}"
        )
    }

    /// The bytes that draw the current picture on an empty terminal.
    pub(crate) fn whole_picture(&mut self, room: Option<&RoomView>) -> Vec<u8> {
        let size = self.protocol.size();
        let size = ratatui::layout::Size::new(size.columns, size.rows);
        let mut writer = CellWriter::new(Vec::new(), size);
        writer.set_ascii(self.ui.is_ascii());
        writer.draw_frame(|screen| self.ui.draw(screen, room));
        _ = ratatui::backend::Backend::flush(&mut writer);
        std::mem::take(writer.output_mut())
    }
}

impl Rig {
    fn page(&self, index: usize) -> super::pages::Page {
        self.session(index, |session, _| session.ui.page())
    }
}

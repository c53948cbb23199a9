//! The screen of a member in a replayed room.

use std::sync::Arc;
use std::time::Duration;

use ratatui::buffer::Buffer;
use ratatui::layout::Size;

use super::endings::IdleLimits;
use super::messages::{Profile, SessionContext, SessionEvent};
use super::ui::Ui;
use crate::accounts::Day;
use crate::line::Line;
use crate::rooms::room::{Catalog, MemberId, RoomView};
use crate::rooms::summary::RoomId;
use cellcaster::app::Configuration;
use cellcaster::app::store::Preferences;

/// The screen of a member in a terminal with half blocks and 24-bit colours.
pub(crate) struct ReplayedScreen {
    ui: Ui,
    picture: Buffer,
}

impl ReplayedScreen {
    /// The screen of `member`, as their session shows it with the usual settings.
    pub(crate) fn new(member: MemberId, name: Line, catalog: Arc<Catalog>, size: Size) -> Self {
        let mut ui = ui(name, catalog, (Preferences::default(), Configuration::default()));
        ui.notify(SessionEvent::Entered { room: RoomId(0), member: Some(member), code: None });
        Self { ui, picture: Buffer::empty(size.into()) }
    }

    /// The picture of `room` at `now`.
    pub(crate) fn draw(&mut self, room: &RoomView, now: Duration) -> &Buffer {
        let Self { ui, picture } = self;
        ui.now = now;
        ui.look_at(room, now);
        ui.requests.clear();
        picture.reset();
        ui.draw(picture, Some(room));
        if let Some(stay) = &mut ui.stay {
            stay.drawn(room, ui.field_of_view, false);
        }
        picture
    }
}

/// The user interface of somebody on this machine.
pub(crate) fn ui(
    name: Line,
    catalog: Arc<Catalog>,
    (preferences, configuration): (Preferences, Configuration),
) -> Ui {
    let identity = Profile {
        has_account: false,
        name: name.clone(),
        is_named: true,
        preferences,
        ignored: Vec::new(),
        configuration,
    };
    let host = SessionContext {
        name,
        message: None,
        notice: None,
        compresses: true,
        ascii_locale: None,
        catalog,
        today: Day::default(),
        frame_time: Duration::ZERO,
        idle: IdleLimits { in_room: Duration::MAX, elsewhere: Duration::MAX },
        has_recordings: false,
    };
    Ui::new(identity, host, false, Duration::ZERO)
}

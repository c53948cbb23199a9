//! The parts of the program that the sessions of a server use, too.

pub use super::banner::draw as draw_banner;
pub use super::bindings::Action;
pub use super::clock::Clock;
pub use super::controls::{Controls, KeyContext};
pub use super::detection::Detection;
pub use super::draw_options::DrawOptions;
pub use super::help::HelpScroll;
pub use super::map_panel::MapPanel;
pub use super::menu::{Menu, Selection, changes_by};
pub use super::mouse::Pointer;
pub use super::overlay::Overlay;
pub use super::panels::{
    is_too_small, leaving, message, picture_and_status, time, too_small, whole_seconds,
};
pub use super::question::{PendingKey, is_answerable};
pub use super::settings_screen::{COLORS, CORRECTIONS, GLYPHS, after, name, on_or_off, with_card};
pub use super::stats::{Meter, Stats};
pub use super::status::{Part, StatusLine, hint};
pub use super::vitals::HealthSigns;
pub use super::watch::Watch;

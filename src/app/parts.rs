//! The parts of the program that the sessions of a server use, too.

pub use super::banner::draw as draw_banner;
pub use super::bindings::Action;
pub use super::controls::Clock;
pub use super::controls::{Controls, KeyContext};
pub use super::detection::Detection;
pub use super::help::HelpScroll;
pub use super::map_panel::MapPanel;
pub use super::menu::{Menu, Selection, changes_by};
pub use super::mouse::Pointer;
pub use super::page::{Effect, Kind, Page, Pages, PendingKey, is_answerable};
pub use super::panels::{is_too_small, leaving, message, picture_and_status, too_small};
pub use super::picture::DrawOptions;
pub use super::picture::Overlay;
pub use super::setting::{Choice, Field, Setting, Value};
pub use super::settings_page::with_card;
pub use super::stats::{Meter, Stats};
pub use super::status::HealthSigns;
pub use super::status::{Part, StatusLine, hint};
pub use super::steps::Watch;
pub use super::time::{of_steps, tenths, whole_seconds};

//! The parts of the program that the sessions of a server use, too.

pub(crate) use super::banner::draw as draw_banner;
pub(crate) use super::bindings::Action;
pub(crate) use super::controls::Clock;
pub(crate) use super::controls::{Controls, KeyContext};
pub(crate) use super::detection::Detection;
pub(crate) use super::help::HelpScroll;
pub(crate) use super::map_panel::MapPanel;
pub(crate) use super::menu::{Menu, Selection, changes_by};
pub(crate) use super::mouse::Pointer;
pub(crate) use super::page::{PendingKey, is_answerable};
pub(crate) use super::panels::{is_too_small, leaving, message, picture_and_status, too_small};
pub(crate) use super::picture::DrawOptions;
pub(crate) use super::picture::Overlay;
pub(crate) use super::setting::Value;
pub(crate) use super::settings_page::with_card;
pub(crate) use super::stats::{Meter, Stats};
pub(crate) use super::status::HealthSigns;
pub(crate) use super::status::{Part, StatusLine, hint};
pub(crate) use super::steps::Watch;
pub(crate) use super::time::{of_steps, whole_seconds};

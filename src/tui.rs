//! Ratatui widgets for levels and maps, and the state of held keys.
//!
//! [`FirstPerson`] shows a grid or bodies through a camera, and [`Minimap`] shows a map from above.
//! Both fill any given area, and depend on neither keys nor escape sequences. [`HeldKeys`] tracks
//! which keys are held, for keys of any type; [`wanted()`] converts them to the intents of a
//! [`Game`](crate::game::Game).
//!
//! ```
//! use cellcaster::tui::{FirstPerson, Minimap, View};
//! use cellcaster::world::FieldOfView;
//! use ratatui::layout::{Constraint, Layout};
//!
//! let world = cellcaster::map::builtin::LEVELS[0].world()?;
//! let camera = world.start_camera(FieldOfView::default());
//! let mut view = View::default();
//!
//! let draw = |frame: &mut ratatui::Frame| {
//!     let panels = [Constraint::Fill(1), Constraint::Length(24)];
//!     let [picture, map] = Layout::horizontal(panels).areas(frame.area());
//!     frame.render_stateful_widget(FirstPerson::new(&world, &camera), picture, &mut view);
//!     frame.render_widget(Minimap::new(&world, &camera).seen(view.distances()), map);
//! };
//! # let mut terminal = ratatui::Terminal::new(ratatui::backend::TestBackend::new(80, 24))?;
//! # terminal.draw(draw)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod ascii;
pub(crate) mod blocks;
pub mod canvas;
mod correction;
mod first_person;
mod glyphs;
pub(crate) mod held;
mod minimap;
pub(crate) mod pixels;

pub use self::correction::Correction;
pub use self::first_person::{FirstPerson, View};
pub use self::glyphs::{CellAspect, GlyphSet, color_at, rgb_of};
pub use self::held::{CHORD, HeldKeys, Hold, LINGER, Press, tap_steps, wanted};
#[cfg(feature = "terminal")]
pub(crate) use self::minimap::legend;
pub use self::minimap::{Explored, MapMark, Minimap};

#[cfg(test)]
mod tests;

//! A tour of three rooms: a list of them, and the view and the map of the chosen one.
//!
//! `cargo run` shows it, and `cargo test` compares it with the grids in `src/grids`.

use std::error::Error;

use cellcaster::fault::Faults;
use cellcaster::map;
use cellcaster::tui::{FirstPerson, Minimap, View};
use cellcaster::world::{Camera, FieldOfView, World};
use ratatui::Frame;
use ratatui::crossterm::event::{self, KeyCode};
use ratatui::layout::{Constraint, Layout};
use ratatui::style::{Color, Stylize};
use ratatui::widgets::{Block, List, ListState};

const ROOMS: [(&str, &str); 3] = [
    ("Hall", include_str!("../maps/hall.toml")),
    ("Columns", include_str!("../maps/columns.toml")),
    ("Garden", include_str!("../maps/garden.toml")),
];

struct Tour {
    rooms: ListState,
    world: World,
    camera: Camera,
    view: View,
}

impl Tour {
    /// A tour that begins in the room with this index.
    fn new(room: usize) -> Result<Self, Faults> {
        let world = map::parse_str(ROOMS[room].1)?;
        let camera = world.start_camera(FieldOfView::default());
        let rooms = ListState::default().with_selected(Some(room));
        Ok(Self { rooms, world, camera, view: View::default() })
    }

    fn draw(&mut self, frame: &mut Frame) {
        let panels = [Constraint::Length(12), Constraint::Fill(1), Constraint::Length(20)];
        let [rooms, picture, map] = Layout::horizontal(panels).areas(frame.area());
        let names = List::new(ROOMS.map(|(name, _)| name))
            .highlight_style(Color::Yellow)
            .highlight_symbol("> ");
        let names = names.block(Block::bordered().title("Rooms").title_bottom("q quits".dim()));
        frame.render_stateful_widget(names, rooms, &mut self.rooms);
        let view = FirstPerson::new(&self.world, &self.camera);
        frame.render_stateful_widget(view, picture, &mut self.view);
        let seen = Minimap::new(&self.world, &self.camera).seen(self.view.distances());
        frame.render_widget(seen, map);
    }

    /// Handles a key. Returns false for the key that quits.
    fn press(&mut self, key: KeyCode) -> Result<bool, Faults> {
        let room = self.rooms.selected().unwrap_or_default();
        match key {
            KeyCode::Up => *self = Self::new(room.saturating_sub(1))?,
            KeyCode::Down => *self = Self::new((room + 1).min(ROOMS.len() - 1))?,
            KeyCode::Left => self.camera.heading = self.camera.heading.turned(-0.1),
            KeyCode::Right => self.camera.heading = self.camera.heading.turned(0.1),
            KeyCode::Char('q') => return Ok(false),
            _ => {}
        }
        Ok(true)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut tour = Tour::new(0)?;
    ratatui::run(|terminal| {
        loop {
            terminal.draw(|frame| tour.draw(frame))?;
            if let Some(key) = event::read()?.as_key_press_event()
                && !tour.press(key.code)?
            {
                return Ok(());
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use cellcaster::testing::{CellGrid, Tolerance, assert_grid};

    use super::*;

    /// The screen after these keys.
    fn after(keys: &[KeyCode]) -> CellGrid {
        let mut tour = Tour::new(0).unwrap();
        for &key in keys {
            assert!(tour.press(key).unwrap());
        }
        CellGrid::drawn(64, 12, |frame| tour.draw(frame))
    }

    #[test]
    fn the_tour_begins_in_the_hall() {
        assert_grid!(after(&[]), "hall");
    }

    #[test]
    fn up_and_down_choose_a_room() {
        assert_grid!(after(&[KeyCode::Down]), "columns");
        assert_eq!(after(&[KeyCode::Down, KeyCode::Up]), after(&[]));
        assert_eq!(after(&[KeyCode::Down; 9]), after(&[KeyCode::Down; 2]));
    }

    #[test]
    fn left_and_right_turn() {
        assert_grid!(after(&[KeyCode::Right; 5]), "hall_to_the_right");
        // Turning back rounds the heading, which may move an edge by a pixel.
        let tolerance = Tolerance { cells: 4, ..Tolerance::default() };
        assert_grid!(after(&[KeyCode::Right, KeyCode::Left]), "hall", tolerance);
    }

    #[test]
    fn q_quits() {
        assert!(!Tour::new(0).unwrap().press(KeyCode::Char('q')).unwrap());
    }
}

//! A ratatui program that shows a level beside its map. The arrow keys turn; any other key quits.

use cellcaster::map::builtin;
use cellcaster::tui::{FirstPerson, Minimap, View};
use cellcaster::world::FieldOfView;
use ratatui::crossterm::event::{self, Event, KeyCode};
use ratatui::layout::{Constraint, Layout};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let world = builtin::LEVELS[0].world()?;
    let mut camera = world.start_camera(FieldOfView::default());
    let mut view = View::default();
    let mut terminal = ratatui::init();
    loop {
        terminal.draw(|frame| {
            let panels = [Constraint::Fill(1), Constraint::Length(40)];
            let [picture, map] = Layout::horizontal(panels).areas(frame.area());
            frame.render_stateful_widget(FirstPerson::new(&world, &camera), picture, &mut view);
            frame.render_widget(Minimap::new(&world, &camera).seen(view.distances()), map);
        })?;
        let Event::Key(key) = event::read()? else { continue };
        camera.heading = match key.code {
            KeyCode::Left => camera.heading.turned(-0.1),
            KeyCode::Right => camera.heading.turned(0.1),
            _ => break,
        };
    }
    ratatui::restore();
    Ok(())
}

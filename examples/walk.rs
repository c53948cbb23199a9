//! A ratatui program for walking through a level, in any terminal. W and S walk, the arrow keys
//! turn, and any other key quits.

use std::time::{Duration, Instant};

use cellcaster::game::{Game, Intent, STEP};
use cellcaster::map::builtin;
use cellcaster::tui::{FirstPerson, HeldKeys, Press, View, tap_steps, wanted};
use cellcaster::world::FieldOfView;
use ratatui::crossterm::event::{self, Event, KeyCode};

const KEYS: [(KeyCode, Intent); 4] = [
    (KeyCode::Char('w'), Intent::Forward),
    (KeyCode::Char('s'), Intent::Back),
    (KeyCode::Left, Intent::TurnLeft),
    (KeyCode::Right, Intent::TurnRight),
];

fn intent(code: KeyCode) -> Option<Intent> {
    KEYS.iter().find(|(key, _)| *key == code).map(|&(_, intent)| intent)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut game = Game::new(builtin::LEVELS[0].world()?);
    let (mut view, mut held) = (View::default(), HeldKeys::default());
    let mut terminal = ratatui::init();
    let (start, step) = (Instant::now(), Duration::from_secs_f64(STEP));
    'steps: for number in 1.. {
        let now = step * number;
        while event::poll(now.saturating_sub(start.elapsed()))? {
            let Event::Key(key) = event::read()? else { continue };
            let Some(wish) = intent(key.code) else { break 'steps };
            let opposes = |other| intent(other).is_some_and(|other| wish.opposes(other));
            let press = held.press(key.code, tap_steps(wish), start.elapsed(), opposes);
            if press == Press::Fresh {
                held.release_lingering(|other| intent(other).is_some_and(Intent::turns));
            }
        }
        held.advance(now);
        game.step(wanted(held.iter().filter_map(|(key, hold)| Some((intent(key)?, hold)))));
        held.step();
        let camera = game.camera(FieldOfView::default());
        terminal.draw(|frame| {
            let picture = FirstPerson::new(game.world(), &camera);
            frame.render_stateful_widget(picture, frame.area(), &mut view);
        })?;
    }
    ratatui::restore();
    Ok(())
}

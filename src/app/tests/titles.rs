//! The title and its menus, controlled by keys.

use super::missions::own_map;
use super::*;
use crate::app::{InitialState, Offers};
use crate::map::builtin;

const ENTER: Key = Key::Enter;

fn title() -> Rig {
    let maps = || vec![own_map("bad.toml", "grid = 3"), own_map("pit.toml", PIT)];
    let offers = Offers { maps: Some(Box::new(maps)), ..Offers::default() };
    titled(offers, Store::in_memory())
}

pub(crate) fn titled(offers: Offers, store: Store) -> Rig {
    let settings = Settings { frame_time: Duration::from_secs(1) / 30, ..Settings::default() };
    let app = App::opened(InitialState::Title(offers), settings, store);
    let mut rig = Rig::of(app, Some((500, 30)));
    rig.wait(100);
    rig
}

impl Rig {
    /// Selects the entry called `label`, and chooses it.
    #[track_caller]
    pub(crate) fn choose(&mut self, label: &str) {
        let choice = |rig: &Rig| rig.app.pages.menu.label();
        let first = choice(self);
        while choice(self).as_deref() != Some(label) {
            self.tap(Key::Down, 30);
            self.wait(300);
            assert_ne!(choice(self), first, "there is no {label}");
        }
        self.tap(ENTER, 30);
        self.wait(300);
    }
}

#[test]
fn a_level_plays_itself_behind_the_title() {
    let mut rig = title();
    assert_eq!(rig.app.screen(), AppScreen::Title);
    let before = rig.app.game.elapsed();
    rig.wait(1000);
    assert!((rig.app.game.elapsed() - before - 1.0).abs() < 0.05);
    assert!(rig.app.is_stale());
    // Game keys do not reach the level behind the title.
    let mut other = title();
    other.wait(1000);
    for key in [Key::Left, Key::Char('d'), Key::Char('e'), Key::Char('g'), Key::Char('m')] {
        rig.press(key);
    }
    rig.wait(1000);
    other.wait(1000);
    assert_eq!(rig.app.game.grid(), other.app.game.grid());
}

#[test]
fn a_new_game_starts_at_the_chosen_difficulty_and_returns_to_title() {
    let mut rig = title();
    rig.choose("New game");
    assert_eq!(rig.app.screen(), AppScreen::NewGame);
    rig.choose("Hard");
    assert_eq!((rig.app.screen(), rig.app.difficulty), (AppScreen::Playing, Difficulty::Hard));
    assert_eq!(rig.app.game.title(), "Cellar");
    rig.tap(Key::Char('p'), 30);
    rig.wait(300);
    rig.choose("Leave to the title");
    assert_eq!(rig.app.screen(), AppScreen::Title);
    assert!(rig.app.demo.is_some());
}

#[test]
fn escape_and_backspace_go_back_one_screen_and_the_selection_stays() {
    let mut rig = title();
    for back in [Key::Escape, Key::Backspace] {
        rig.choose("Levels");
        assert_eq!(rig.app.screen(), AppScreen::Levels);
        rig.tap(Key::Char('?'), 30);
        assert_eq!(rig.app.screen(), AppScreen::Help);
        rig.wait(300);
        rig.tap(back, 30);
        assert_eq!(rig.app.screen(), AppScreen::Levels);
        rig.wait(700);
        rig.tap(back, 30);
        assert_eq!(rig.app.screen(), AppScreen::Title);
        assert_eq!(rig.app.pages.menu.label().as_deref(), Some("Levels"));
        rig.wait(700);
    }
    assert!(!rig.app.has_left);
    rig.tap(Key::Escape, 30);
    assert!(rig.app.has_left);
}

#[test]
fn a_digit_chooses_and_its_repetition_does_not() {
    let mut rig = title();
    rig.tap(Key::Char('2'), 30);
    rig.wait(700);
    assert_eq!(rig.app.screen(), AppScreen::Levels);
    rig.tap(Key::Char('2'), 30);
    rig.wait(700);
    assert_eq!(
        (rig.app.screen(), rig.app.levels.number.to_string()),
        (AppScreen::Playing, format!("level 2 of {}", builtin::LEVELS.len()))
    );

    let mut rig = title();
    rig.press(ENTER);
    rig.wait(3000);
    assert_eq!(rig.app.screen(), AppScreen::NewGame, "the held key chooses no difficulty");
}

#[test]
fn the_players_own_map_is_played_or_its_faults_are_shown() {
    let mut rig = title();
    rig.choose("My maps");
    rig.choose("bad.toml");
    assert_eq!(rig.app.screen(), AppScreen::Maps);
    let mut buffer = ratatui::buffer::Buffer::empty(ratatui::layout::Rect::new(0, 0, 80, 24));
    rig.app.draw(&mut buffer);
    let text: String = buffer.content().iter().map(ratatui::buffer::Cell::symbol).collect();
    assert!(text.contains("it:1: "), "{text}");
    rig.choose("pit.toml");
    assert_eq!(rig.app.screen(), AppScreen::Playing);
    rig.tap(Key::Char('p'), 30);
    rig.wait(300);
    let before = rig.position();
    rig.choose("Continue");
    rig.press(W);
    rig.wait(500);
    assert_ne!(rig.position(), before);
    rig.release(W);
    rig.wait(1000);
    rig.tap(Key::Char('p'), 30);
    rig.wait(300);
    rig.choose("Restart the level");
    assert_eq!((rig.app.screen(), rig.position()), (AppScreen::Playing, before));
}

#[test]
fn the_exit_of_a_level_leads_to_the_next_level() {
    let way_out = |title: &str| {
        let text = include_str!("../../../tests/maps/way_out.toml");
        Level::from(parse_str(&text.replace("Way out", title)).unwrap())
    };
    let levels = Levels::new(way_out("First"), [way_out("Second")].into_iter()).numbered(1, 2);
    let mut rig = Rig::of(App::new(levels, Settings::default()), Some((500, 30)));
    for (title, number) in [("First", "level 1 of 2"), ("Second", "level 2 of 2")] {
        assert_eq!(
            (rig.app.game.title(), rig.app.levels.number.to_string()),
            (title, number.to_owned())
        );
        rig.press(W);
        rig.wait(1500);
        rig.release(W);
        assert_eq!(rig.app.screen(), AppScreen::LevelDone);
        rig.wait(1000);
        rig.tap(ENTER, 30);
        rig.wait(300);
    }
    assert_eq!(rig.app.screen(), AppScreen::End);
}

#[test]
fn the_first_title_picture_loads_one_level_and_lists_no_maps() {
    use std::cell::Cell;
    use std::rc::Rc;
    let searches = Rc::new(Cell::new(0));
    let counted = Rc::clone(&searches);
    let find = move || {
        counted.set(counted.get() + 1);
        Vec::new()
    };
    let offers = Offers { maps: Some(Box::new(find)), ..Offers::default() };
    let mut rig = titled(offers, Store::in_memory());
    missions::text(&mut rig.app, 80, 24);
    assert_eq!(searches.get(), 0);
    assert!(rig.app.own_maps.is_empty() && rig.app.ghost.is_none());
    // Only the level behind the title has been created.
    assert!(
        rig.app.levels.stage.begin(Difficulty::Normal).is_some_and(|game| game.grid().is_none())
    );
    rig.choose("My maps");
    assert_eq!(searches.get(), 1);
}

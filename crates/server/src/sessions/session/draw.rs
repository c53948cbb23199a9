//! Drawing a visitor's screen.

mod ceremony;
mod lobby;
mod members;
pub(crate) mod overhead;
mod room_status;

use std::borrow::Cow;
use std::cell::Cell;

use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::{Line, Text};
use ratatui::widgets::Block;

use super::ceremony::finishers;
use super::pages::Page;
use super::playback::KEYS;
use super::stay::{SeenGhost, seconds_left};
use super::talk;
use super::ui::Ui;
use crate::line;
use crate::rooms::cast;
use crate::rooms::room::{Phase, RoomView};
use cellcaster::app::parts::{
    DrawOptions, Menu, Overlay, PLAYER_HELP, Perspective, is_too_small, leaving, message,
    picture_and_status, too_small, whole_seconds,
};
use cellcaster::color::palette::ColorDepth;
use cellcaster::render::Filter;
use cellcaster::tui::canvas::Canvas;
use cellcaster::tui::{GlyphSet, View};
use cellcaster::world::{Figure, World};

/// The keys in a room that bindings cannot change.
const ROOM_KEYS: [&str; 5] = [
    "In a room: Enter or / talks, ; hides chat, 1 shows an emote,",
    "Tab lists the members, or watches the next; 7 lists the players here.",
    "In the lobby: / talks. /tell NAME TEXT writes to a player anywhere.",
    "The daily level changes at midnight UTC; results count on its day.",
    "\"It\" and seekers glow. A red edge: you are one.",
];
/// Advice for a link that may make pictures coarse.
pub(crate) const COMPRESSION: &str = "On a slow link, ssh -C makes pictures finer.";

/// Draws with the renderer that all pictures on this thread share. It takes half a megabyte in a level with steps, and
/// keeps no state from one picture to the next.
pub(crate) fn with_view<T>(draw: impl FnOnce(&mut View) -> T) -> T {
    thread_local!(static VIEW: Cell<Option<View>> = const { Cell::new(None) });
    let mut view = VIEW.take().unwrap_or_default();
    let drawn = draw(&mut view);
    VIEW.set(Some(view));
    drawn
}

impl Ui {
    /// Draws the current page, with `room` as the latest snapshot of the visitor's room, or of the liveliest one.
    pub(crate) fn draw(&mut self, canvas: &mut impl Canvas, room: Option<&RoomView>) {
        let area = canvas.bounds();
        if is_too_small(area) {
            return too_small(canvas);
        }
        let rows = u16::from(self.playback.is_some());
        let [above, below] = [area.height - rows, rows];
        let [picture, status] = picture_and_status(Rect { height: above, ..area });
        let (glyphs, depth) = (self.glyphs(), self.depth());
        if let Some(playback) = &mut self.playback {
            let line = Rect { y: area.y + above, height: below, ..area };
            playback.player.draw_time_line(canvas, line, glyphs, depth);
        }
        match (self.stay.is_some(), room) {
            (true, Some(room)) => {
                self.draw_room(canvas, picture, room);
                self.draw_room_status(canvas, status, room);
                self.draw_panel(canvas, picture);
            }
            _ => self.draw_lobby(canvas, picture, status, room),
        }
        if self.idle.is_warned() {
            let is_member = self.stay.as_ref().is_some_and(|stay| stay.member.is_some());
            let end = if is_member { "you leave the room" } else { "this session ends" };
            notice(canvas, picture, &format!("Still there? Press a key, or {end} soon."));
        }
    }

    /// Draws the page's panel over the picture.
    fn draw_panel(&mut self, canvas: &mut impl Canvas, area: Rect) {
        match self.page() {
            Page::Name => self.draw_name(canvas, area),
            Page::Code => self.draw_code(canvas, area),
            Page::Help => {
                let lines = if self.playback.is_some() {
                    [&PLAYER_HELP[..], &KEYS].concat()
                } else {
                    ROOM_KEYS.to_vec()
                };
                let lines: Vec<String> = lines.into_iter().map(str::to_owned).collect();
                let (keys, notes) = ((&lines[..], &self.bindings), self.help_notes());
                self.pages.help.draw(canvas, area, keys, notes.into_iter());
            }
            Page::Leaving => leaving(canvas, area, &self.bindings, "ends the session"),
            Page::Room => {}
            Page::Chat => self.draw_chat_entry(canvas, area),
            _ => self.pages.menu.draw(canvas, area),
        }
    }

    fn draw_name(&self, canvas: &mut impl Canvas, area: Rect) {
        let identity = &self.identity;
        let about = match (identity.has_account, identity.is_named) {
            (true, true) => "Welcome back. Your key is your account.",
            (true, false) => "Your key is your account. Choose a name for it.",
            (false, _) => "You are a guest. With a key, your results rank.",
        };
        let about = self.host.notice.as_ref().map_or(about, line::Line::as_str);
        let note = self.note.clone().unwrap_or_else(|| about.to_owned());
        self.draw_entry(canvas, area, "your name", &note);
    }

    fn draw_code(&self, canvas: &mut impl Canvas, area: Rect) {
        let about = "The menu of a private room shows its code.";
        self.draw_entry(canvas, area, "enter a code", about);
    }

    /// Draws a panel with the line that is being typed.
    fn draw_entry(&self, canvas: &mut impl Canvas, area: Rect, title: &str, about: &str) {
        let room = usize::from(area.width.saturating_sub(6));
        let entry = self.entry.shown(room);
        let mut menu: Menu<()> = Menu::new(title).line(about).entry(entry, ());
        menu.draw(canvas, area);
    }

    /// The notes on the link and the terminal for the help page.
    fn help_notes(&self) -> Vec<String> {
        let compression = self.wants_compression.then(|| COMPRESSION.to_owned());
        compression.into_iter().chain(self.detection.lines()).collect()
    }

    /// Draws the line of chat that is being typed.
    fn draw_chat_entry(&self, canvas: &mut impl Canvas, picture: Rect) {
        const PROMPT: &str = " say: ";
        let room = usize::from(picture.width).saturating_sub(PROMPT.len());
        let line = Line::raw(format!("{PROMPT}{}", self.entry.shown(room)));
        let area = Rect { y: picture.bottom() - 1, height: 1, ..picture };
        canvas.draw_widget(line.style(Style::new().add_modifier(Modifier::REVERSED)), area);
    }

    fn draw_room(&mut self, canvas: &mut impl Canvas, area: Rect, room: &RoomView) {
        let (options, page) = (self.draw_options(), self.page());
        let depth = options.depth;
        let preferences = self.identity.preferences;
        let player = self.playback.as_ref().map(|playback| &playback.player);
        if player.is_some_and(|player| player.perspective() == Perspective::Above) {
            return cast::draw_map(canvas, area, room, options.glyphs, depth);
        }
        let free = player.and_then(|player| player.camera(options.field_of_view));
        let Some(stay) = &mut self.stay else { return };
        if let Some(camera) = free {
            let world = with_figures(room.game.world(), room.figures(), &[]);
            let seconds = room.game.elapsed();
            return with_view(|view| {
                options.draw(&*world, &camera, seconds, canvas, area, view);
            });
        }
        let shows_standings =
            matches!(room.phase, Phase::Over { .. }) && matches!(page, Page::Room | Page::Chat);
        let seen_through = stay.seen_through(room);
        if let Some((name, moment)) = room.replayed() {
            let place = if shows_standings { members::beside_standings(area) } else { area };
            let mut world = room.game.world().clone();
            world.set_figures(moment.figures.iter().copied());
            let (camera, seconds) = (stay.camera(room, options.field_of_view), room.game.elapsed());
            stay.next_change = with_view(|view| {
                options.draw(&world, &camera, seconds, canvas, place, view);
                view.next_change()
            });
            notice(canvas, place, &format!("the last seconds of {name}"));
        } else if seen_through.is_some_and(|(member, _)| member.is_blind) {
            draw_darkness(canvas, area, room, depth);
            ceremony::draw_edge(canvas, area, stay.edge(room), depth);
        } else {
            let camera = stay.camera(room, options.field_of_view);
            let flash = seen_through.and_then(|(_, player)| player.flash());
            let flash = flash.map(|flash| (flash, camera.heading));
            let options = DrawOptions { flash, ..options };
            let (game, seconds) = (&room.game, room.game.elapsed());
            let own = stay.own_color(room);
            let ghosts: Vec<SeenGhost> = stay.ghosts.seen(room, own, preferences.ghost).collect();
            let world = with_figures(game.world(), room.figures(), &ghosts);
            let (edge, map) = (stay.edge(room), &mut stay.map);
            stay.next_change = with_view(|view| {
                options.draw(&*world, &camera, seconds, canvas, area, view);
                ceremony::draw_edge(canvas, area, edge, depth);
                let Some((_, player)) = seen_through else { return view.next_change() };
                let (player, ignored) = (&player, &self.ignored);
                overhead::draw(canvas, area, &options, player, (room, ignored), &ghosts);
                if let Some(overlay) = Overlay::new(game, player.id(), &options, preferences) {
                    let map = overlay.draw_map(canvas, area, map, view, None);
                    overlay.draw_hud(canvas, area, map, page == Page::Room);
                }
                view.next_change()
            });
        }
        if page == Page::Room || page == Page::Chat {
            ceremony::draw_finishers(canvas, area, &finishers(room), depth);
            if let Some(text) = stay.large(room) {
                ceremony::draw_large(canvas, area, &text, depth);
            }
        }
        if shows_standings {
            members::draw_standings(canvas, area, room, depth);
        } else if stay.shows_members && page == Page::Room {
            members::draw_members(canvas, area, (room, stay.code), &self.host.catalog, depth);
        }
        talk::draw(canvas, area, self.talk.shown(), page == Page::Chat, depth);
        if let Some(draining) = self.draining {
            notice(canvas, area, &draining.sentence(self.now));
        }
    }
}

/// Display options: the visitor's choices, or else the best that the terminal supports.
impl Ui {
    pub(crate) fn glyphs(&self) -> GlyphSet {
        let best = if self.has_ascii_only { GlyphSet::Ascii } else { self.terminal.glyphs };
        self.identity.preferences.glyphs.unwrap_or(best)
    }

    pub(crate) fn depth(&self) -> ColorDepth {
        self.identity.preferences.colors.unwrap_or(self.terminal.depth)
    }

    /// Returns true if only ASCII is sent: the terminal shows nothing else, and the visitor has not chosen blocks.
    pub(crate) fn is_ascii(&self) -> bool {
        self.has_ascii_only && !self.glyphs().has_blocks()
    }

    fn draw_options(&self) -> DrawOptions {
        let preferences = &self.identity.preferences;
        DrawOptions {
            glyphs: self.glyphs(),
            depth: self.depth(),
            shade_ink: self.terminal.shade_ink,
            cell_aspect: self.terminal.aspect.unwrap_or_default(),
            filter: Filter::default(),
            correction: preferences.correction,
            field_of_view: self.field_of_view,
            flash: None,
            marks_middle: preferences.crosshair,
        }
    }
}

/// The world with `figures` in place of its own, if there are any, and the figures of `ghosts`. The world is
/// copied then, because the room and other sessions share it.
fn with_figures<'w>(
    world: &'w World,
    figures: Option<Vec<Figure>>,
    ghosts: &[SeenGhost],
) -> Cow<'w, World> {
    let mut world = Cow::Borrowed(world);
    if figures.is_some() || !ghosts.is_empty() {
        let mut figures = figures.unwrap_or_else(|| world.figures().to_vec());
        figures.extend(ghosts.iter().map(|ghost| ghost.figure));
        world.to_mut().set_figures(figures.into_iter());
    }
    world
}

/// Draws the blank view of seekers who wait.
fn draw_darkness(canvas: &mut impl Canvas, area: Rect, room: &RoomView, depth: ColorDepth) {
    let style = match depth {
        ColorDepth::Mono => Style::new(),
        _ => Style::new().bg(Color::Black).fg(Color::Gray),
    };
    canvas.draw_widget(Block::new().style(style), area);
    let left = whole_seconds(seconds_left(room).unwrap_or(0) as f64);
    let text = format!("The others are hiding.\nYou can see again in {left}.");
    message(canvas, area, "you seek", Text::from(text).centered());
}

/// Draws a sentence in the top row of the picture.
fn notice(canvas: &mut impl Canvas, picture: Rect, text: &str) {
    let line = Line::raw(format!(" {text} "));
    let width = (line.width() as u16).min(picture.width);
    let area = Rect { x: picture.x + (picture.width - width) / 2, width, height: 1, ..picture };
    canvas.draw_widget(line.style(Style::new().add_modifier(Modifier::REVERSED)), area);
}

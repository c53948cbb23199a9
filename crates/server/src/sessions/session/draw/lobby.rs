//! Drawing the pages outside of a room.
//!
//! In a large window they are a place: the menu at the left, and beside it a picture of the liveliest room, the
//! board of today's daily level, and the visitors who are here. In a small window only the page's panel is shown. The last row
//! above the status line stays free for a line that is being typed.

use std::mem;

use ratatui::layout::{Margin, Rect};
use ratatui::text::{Line as TextLine, Text};
use unicode_width::UnicodeWidthStr;

use super::with_view;
use crate::accounts::printable;
use crate::line::Line;
use crate::rooms::room::{Mode, RoomView};
use crate::rooms::summary::RoomSummary;
use crate::sessions::session::lobby::seen_through;
use crate::sessions::session::pages::{Choice, Page};
use crate::sessions::session::talk;
use crate::sessions::session::ui::Ui;
use cellcaster::app::parts::{
    DrawOptions, Menu, Page as _, PageKind, draw_banner, framed, hint, panel, wrapped,
};
use cellcaster::tui::canvas::Canvas;

/// The minimum height, in rows, for a banner above a single panel.
const MIN_WITH_BANNER: u16 = 20;
/// The smallest picture area in which the lobby is a place.
const MIN_COLUMNS: u16 = 72;
const MIN_ROWS: u16 = 20;
/// The greatest width and height of the place below the banner, which bound the cost of the picture.
const MAX_PLACE: [u16; 2] = [140, 40];
/// The height from which the banner has its largest letters.
const MIN_WITH_LARGE_BANNER: u16 = 34;
/// The height of a banner with small letters.
const SMALL_BANNER: u16 = 10;
/// The maximum number of rows for the messages of the lobby.
const MAX_MESSAGE_ROWS: usize = 4;
/// The least and the greatest width of the menu's column.
const MENU_COLUMNS: [u16; 2] = [34, 40];
/// The rows that the longest menu needs: with seven entries for rooms, and a border.
const MENU_ROWS: u16 = 18;
/// The least height of the panels below the picture.
const LEAST_FOOT: u16 = 6;
/// The greatest number of visitors whose names are shown.
const MAX_NAMES: usize = 12;

/// The parts of the lobby.
struct LobbyAreas {
    /// Everything below the banner, except for the free row.
    all: Rect,
    menu: Rect,
    picture: Rect,
    board: Rect,
    visitors: Rect,
}

impl LobbyAreas {
    /// The parts of the area below the banner.
    fn of(below: Rect) -> Self {
        let [width, height] = MAX_PLACE;
        let (width, height) = (width.min(below.width), height.min(below.height - 1));
        let all = Rect { x: below.x + (below.width - width) / 2, width, height, ..below };
        let [least, most] = MENU_COLUMNS;
        let menu = Rect { width: (all.width * 3 / 7).clamp(least, most), ..all };
        let x = menu.right() + 1;
        let beside = Rect { x, width: all.right() - x, ..all };
        let spare = all.height.saturating_sub(MENU_ROWS);
        if spare >= LEAST_FOOT {
            let height = spare.min(MAX_NAMES as u16 + 3);
            let menu = Rect { height: all.height - height, ..menu };
            let visitors = Rect { y: menu.bottom(), height, ..menu };
            let [picture, board] = split(beside, LEAST_FOOT);
            return Self { all, menu, picture, board, visitors };
        }
        let [picture, foot] = split(beside, (beside.height * 2 / 5).max(LEAST_FOOT));
        let board = Rect { width: foot.width / 2, ..foot };
        let visitors = Rect { x: board.right(), width: foot.width - board.width, ..foot };
        Self { all, menu, picture, board, visitors }
    }
}

/// `area` without its last `height` rows, and these rows.
fn split(area: Rect, height: u16) -> [Rect; 2] {
    let above = Rect { height: area.height - height, ..area };
    [above, Rect { y: above.bottom(), height, ..area }]
}

impl Ui {
    /// Draws a page outside of a room, with `room` as the snapshot of the liveliest room.
    pub(crate) fn draw_lobby(
        &mut self,
        canvas: &mut impl Canvas,
        picture: Rect,
        status: Rect,
        room: Option<&RoomView>,
    ) {
        let text = match self.page() {
            Page::Name => "type a name, Enter saves it",
            Page::Code => "type the code, Enter, Esc",
            Page::Lobby => "up and down, Enter, Esc, / talks",
            _ => "up and down, Enter, Esc",
        };
        canvas.draw_widget(hint(text), status);
        let is_large = picture.width >= MIN_COLUMNS && picture.height >= MIN_ROWS;
        self.lobby.has_picture = is_large && self.page() != Page::Name;
        if self.lobby.has_picture {
            self.draw_place(canvas, picture, room);
        } else {
            self.draw_pages(canvas, picture);
        }
        let (page, depth) = (self.page(), self.depth());
        if page != Page::Name && !is_large {
            talk::draw(canvas, picture, self.talk.shown(), page == Page::Chat, depth);
        }
        if page == Page::Chat {
            self.draw_panel(canvas, picture);
        }
    }

    /// Draws the page's panel alone.
    fn draw_pages(&mut self, canvas: &mut impl Canvas, picture: Rect) {
        let below = if picture.height >= MIN_WITH_BANNER {
            draw_banner(canvas, picture, self.glyphs(), self.depth())
        } else {
            picture
        };
        if self.page() == Page::Lobby {
            let below = self.draw_messages(canvas, below);
            self.draw_entries(|menu| menu.draw(canvas, below));
        } else if self.page() != Page::Chat {
            self.draw_panel(canvas, below);
        }
    }

    fn draw_place(&mut self, canvas: &mut impl Canvas, area: Rect, room: Option<&RoomView>) {
        let is_high = area.height >= MIN_WITH_LARGE_BANNER;
        let height = if is_high { area.height } else { SMALL_BANNER };
        let band = Rect { height, ..area };
        let below = draw_banner(canvas, band, self.glyphs(), self.depth());
        let below = Rect { height: area.bottom() - below.y, ..below };
        let below = self.draw_messages(canvas, below);
        let areas = LobbyAreas::of(below);
        self.draw_live_picture(canvas, areas.picture, room);
        let inside = areas.picture.inner(Margin::new(1, 1));
        talk::draw(canvas, inside, self.talk.shown(), false, self.depth());
        self.draw_short_board(canvas, areas.board);
        self.draw_visitors(canvas, areas.visitors);
        let page = self.page();
        match page.kind() {
            PageKind::Menu { .. } if page == Page::Lobby => {
                let room = areas.menu;
                self.draw_entries(|menu| menu.draw_in_corner(canvas, room, room.width));
            }
            PageKind::Menu { .. } => {
                self.pages.menu.draw_in_corner(canvas, areas.all, areas.menu.width);
            }
            _ if page == Page::Chat => {
                let mut menu = self.menu_of(Page::Lobby);
                menu.take_text();
                menu.draw_in_corner(canvas, areas.menu, areas.menu.width);
            }
            _ => self.draw_panel(canvas, areas.all),
        }
    }

    /// Draws the menu without its text, which is among the messages.
    fn draw_entries(&mut self, draw: impl FnOnce(&mut Menu<Choice>)) {
        let menu = &mut self.pages.menu;
        let text = menu.take_text();
        draw(menu);
        *menu = mem::take(menu).lines(text);
    }

    /// Draws the messages of the lobby at the top of `area`, and returns the area below them.
    fn draw_messages(&self, canvas: &mut impl Canvas, area: Rect) -> Rect {
        let columns = usize::from(area.width - 2);
        let lines = self.lobby_lines();
        let most = MAX_MESSAGE_ROWS.min(usize::from(area.height / 4));
        let lines = lines.iter().flat_map(|line| wrapped(line, columns)).take(most);
        let lines: Vec<TextLine> = lines.map(|line| TextLine::raw(line).centered()).collect();
        let height = lines.len() as u16;
        canvas.draw_widget(Text::from(lines), Rect { height, ..area });
        Rect { y: area.y + height, height: area.height - height, ..area }
    }

    /// Draws the liveliest room, or else the level of the offered room.
    fn draw_live_picture(&mut self, canvas: &mut impl Canvas, area: Rect, room: Option<&RoomView>) {
        self.lobby.next_change = None;
        let options = DrawOptions { marks_middle: false, ..self.draw_options() };
        let seen = room.and_then(|room| Some((room, seen_through(room)?.1)));
        if let Some((room, player)) = seen {
            let header = &room.header;
            let level = self.host.catalog.title(&header.level);
            let title = format!("{} in {level}", header.mode.title());
            let inside = framed(canvas, area, &title);
            let camera = player.camera(options.field_of_view);
            let (world, seconds) = (room.game.world(), room.game.elapsed());
            self.lobby.next_change = with_view(|view| {
                options.draw(world, &camera, seconds, canvas, inside, view);
                view.next_change()
            });
            let names: Vec<&Line> = room.members.iter().map(|member| &member.name).collect();
            draw_caption(canvas, area, &names_within(&names, area.width.saturating_sub(2)));
        } else {
            let offer = self.offer(&self.rooms_by_life());
            let inside = framed(canvas, area, &self.level_title(offer));
            let world = self.level_name(offer).and_then(|level| self.host.catalog.world(&level));
            if let Some(world) = world {
                let camera = world.start_camera(options.field_of_view);
                with_view(|view| options.draw(&*world, &camera, 0.0, canvas, inside, view));
            }
            draw_caption(canvas, area, "nobody is walking");
        }
    }

    /// Draws the best entries of today's daily level.
    fn draw_short_board(&self, canvas: &mut impl Canvas, area: Rect) {
        let columns = usize::from(area.width.saturating_sub(4));
        let rows = self.best_of_today();
        let rows = rows.iter().map(|(name, time)| TextLine::raw(apart(name, time, columns)));
        let lines: Vec<TextLine> = rows.collect();
        panel(canvas, area, &self.host.today.title(), lines.into());
    }

    /// Draws the names of the visitors, each with the room.
    fn draw_visitors(&self, canvas: &mut impl Canvas, area: Rect) {
        let columns = usize::from(area.width.saturating_sub(4));
        let rows = usize::from(area.height.saturating_sub(2));
        let players = self.rooms.iter().flat_map(|room| {
            let columns = |name: &Line| columns.saturating_sub(name.as_str().width());
            let place = move |name| self.place_of(room, columns(name));
            room.members.iter().map(move |name| (name.as_str(), place(name)))
        });
        let onlookers = &self.lobby.onlookers;
        let others = onlookers.first.iter().map(|(name, watched)| {
            let place = if watched.is_some() { "watches" } else { "lobby" };
            (name.as_str(), place.to_owned())
        });
        let playing: usize = self.rooms.iter().map(|room| room.members.len()).sum();
        let count = playing + onlookers.count;
        let most = if count <= rows.min(MAX_NAMES) {
            count
        } else {
            rows.saturating_sub(1).min(MAX_NAMES)
        };
        let shown = players.chain(others).take(most);
        let lines = shown.map(|(name, place)| apart(name, &place, columns));
        let mut lines: Vec<TextLine> = lines.map(TextLine::raw).collect();
        let more = count - lines.len();
        if more > 0 {
            lines.push(TextLine::raw(format!("and {more} more")));
        }
        panel(canvas, area, "here", lines.into());
    }

    /// The longest text that says where the members of a room are and fits into `columns` with a gap. The mode and the
    /// level of a private room stay private.
    fn place_of(&self, room: &RoomSummary, columns: usize) -> String {
        let mode = if room.mode == Mode::Alone { "Alone" } else { room.mode.title() };
        if room.code.is_some() {
            return "in private".to_owned();
        }
        // This host may not have the map of a room on another host.
        if !self.host.catalog.has(&room.level) {
            return mode.to_owned();
        }
        let level = self.host.catalog.title(&room.level);
        let forms = [format!("{mode} in {level}"), level.into_owned()];
        let fitting = forms.into_iter().find(|form| form.width() + 2 <= columns);
        fitting.unwrap_or_else(|| mode.to_owned())
    }
}

/// Draws a caption on the lower border of a frame.
fn draw_caption(canvas: &mut impl Canvas, frame: Rect, text: &str) {
    let text = printable(text, usize::from(frame.width - 2));
    let width = text.width() as u16;
    let area = Rect { x: frame.right() - 1 - width, y: frame.bottom() - 1, width, height: 1 };
    canvas.draw_widget(TextLine::raw(text), area);
}

/// As many of `names` as fit into `columns`, and the number of the others.
fn names_within(names: &[&Line], columns: u16) -> String {
    let text = |count: usize| {
        let shown: Vec<&str> = names.iter().take(count).map(|name| name.as_str()).collect();
        match names.len() - count {
            0 => shown.join(", "),
            more => format!("{} and {more} more", shown.join(", ")),
        }
    };
    let counts = (1..=names.len()).rev();
    counts.map(text).find(|text| text.width() <= usize::from(columns)).unwrap_or_default()
}

/// `left` and `right` at both ends of `columns` columns. `left` keeps most of the width.
fn apart(left: &str, right: &str, columns: usize) -> String {
    let left = printable(left, columns);
    let room = columns.saturating_sub(left.width() + 2);
    let right = if room < 3 { String::new() } else { printable(right, room) };
    let gap = columns.saturating_sub(left.width() + right.width());
    format!("{left}{:gap$}{right}", "")
}

//! The pages of a session, their menus, and the effects of menu entries.
//!
//! Outside of a room, the pages lead from the name to the lobby, to a room's card, and into the room. On each
//! page, the usual choice is selected, so Enter alone leads to a first walk. Escape goes back. Before the
//! session ends, the visitor is asked to confirm.

use std::time::{Duration, SystemTime};

use super::commands::Players;
use super::draw::COMPRESSION;
use super::line_entry::LineEntry;
use super::messages::{Moderation, RecordWish, RoomEntry, SessionRequest};
use super::ui::Ui;
use crate::line::Line;
use crate::rooms::directory::RoomRefusal;
use crate::rooms::room::{Command, Emote, Mode};
use crate::rooms::summary::{RoomId, RoomRequest, RoomSummary};
use cellcaster::app::parts::{self, Action, Choice as _, Menu, PageKind, of_steps};
use cellcaster::game::Intent;
use cellcaster::terminal::Key;
use cellcaster::world::Difficulty;

/// The number of rooms listed in the lobby. If there are more, another page lists all of them.
const ROOMS_IN_LOBBY: usize = 5;
/// The widest invitation code that can be typed, with blanks.
const CODE_COLUMNS: usize = 12;
/// The entries of the lobby after the rooms, each with the key that chooses it there. None of the keys selects an entry
/// with a usual set of keys.
const LOBBY_ENTRIES: [(char, &str, Choice); 10] = [
    ('o', "Open a room", Choice::Open(Page::Modes)),
    // Its label is the day.
    ('d', "", Choice::Open(Page::Daily)),
    ('l', Mode::Alone.title(), Choice::Open(Page::Levels(Mode::Alone))),
    ('b', "Board", Choice::Open(Page::Boards)),
    ('r', "Recordings", Choice::Recordings),
    ('c', "Enter a code", Choice::Open(Page::Code)),
    ('t', "Settings", Choice::Open(Page::Settings)),
    ('?', "Help", Choice::Open(Page::Help)),
    ('p', "Players and talk", Choice::Players),
    ('q', "Leave", Choice::Open(Page::Leaving)),
];
/// The modes in which the daily level can be played: the modes that end at its exit.
const DAILY_MODES: [Mode; 3] = [Mode::Alone, Mode::Race, Mode::Together];
/// The level for the first walk.
const FIRST_LEVEL: &str = "museum";

/// A page, which determines the effect of keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Page {
    /// The visitor types a name.
    Name,
    Lobby,
    /// All rooms.
    Rooms,
    /// Today's daily level: its best results, its rooms, and the modes in which it can be played.
    Daily,
    /// A choice of the mode of a new room.
    Modes,
    /// A choice of the level of a new room.
    Levels(Mode),
    /// A choice of the level whose board is shown.
    Boards,
    Board,
    /// The visitor types the code of a private room.
    Code,
    /// A description of a room, before the visitor enters it.
    Card(RoomTarget),
    /// The recordings of rooms.
    Recordings,
    /// The driver has been asked for the room or the record.
    Entering,
    Settings,
    Help,
    /// The question whether to end the session.
    Leaving,
    /// The room itself, where keys control the player.
    Room,
    /// The visitor types a line of chat.
    Chat,
    Emotes,
    /// More actions in a room.
    RoomMenu,
    /// The other visitors in the room or in the lobby.
    Players,
    /// The actions towards the chosen player.
    Player,
    /// A choice of the time for which the chosen player is muted.
    Mute,
}

/// The effect of a menu entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Choice {
    /// Opens a page.
    Open(Page),
    /// Enters or watches the room on the card.
    Enter { watches: bool },
    /// Shows the board of a level.
    Board(LevelChoice),
    /// Lists the recordings of rooms.
    Recordings,
    /// Shows the recording with this index.
    Recording(usize),
    /// Shows the run in this row of the board.
    Run(usize),
    /// Changes whether the new room is private.
    ChangePrivacy,
    /// Changes the setting in this row of the settings page.
    Change(usize),
    /// Returns to the previous page.
    Back,
    /// Shows an emote to everybody.
    Emote(Emote),
    /// Lists the players.
    Players,
    /// Opens the page about the player with this index.
    Player(usize),
    /// Types a line to the room or the lobby.
    Talk,
    /// Types a line to the chosen player.
    Write,
    /// Ignores the chosen player, or stops ignoring them.
    Ignore,
    /// Types the reason of a report about the chosen player.
    Report,
    /// Carries out an act of a moderator against the chosen player.
    Moderate(Moderation),
    /// Asks to restart the round.
    Again,
    /// Leaves the room.
    LeaveRoom,
}

/// A room to enter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RoomTarget {
    /// A room on the list.
    Existing(RoomId),
    /// A new room.
    New { mode: Mode, level: LevelChoice, difficulty: Difficulty },
}

/// A level that a visitor chooses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LevelChoice {
    /// The level with this index in the catalog.
    Listed(usize),
    /// Today's daily level.
    Daily,
}

impl parts::Page for Page {
    fn kind(self) -> PageKind {
        match self {
            Self::Name | Self::Code | Self::Room | Self::Chat => PageKind::Bare,
            Self::Help => PageKind::Help,
            Self::Leaving => PageKind::Leaving,
            Self::Settings | Self::Levels(_) | Self::Board | Self::Card(RoomTarget::New { .. }) => {
                PageKind::Menu { has_values: true }
            }
            _ => PageKind::Menu { has_values: false },
        }
    }
}

impl Page {
    /// Returns true if the visitor types a line on this page.
    pub(crate) fn is_typed_in(self) -> bool {
        matches!(self, Self::Name | Self::Code | Self::Chat)
    }
}

impl Ui {
    pub(crate) fn page(&self) -> Page {
        self.pages.page()
    }

    /// Shows `page`, with no way back.
    pub(crate) fn show(&mut self, page: Page) {
        self.leave_page(page);
        self.pages.show(page, self.menu_of(page), self.now);
    }

    /// Opens `page` on top of the current one.
    pub(crate) fn open(&mut self, page: Page) {
        self.leave_page(page);
        self.pages.open(page, self.menu_of(page), self.now);
    }

    /// Returns to the page from which this one was opened.
    pub(crate) fn close(&mut self) {
        let home = if self.stay.is_some() { Page::Room } else { Page::Lobby };
        self.pages.close(home, self.now);
        self.renew_menu();
    }

    /// Rebuilds the menu after a change of something that it shows.
    pub(crate) fn renew_menu(&mut self) {
        self.pages.renew(self.menu_of(self.page()));
        self.is_stale = true;
    }

    fn leave_page(&mut self, next: Page) {
        if self.page() == Page::Room && next != Page::Room {
            self.release_keys();
        }
        self.is_stale = true;
    }
}

impl Ui {
    /// Carries out the selected entry.
    pub(crate) fn choose(&mut self) {
        if let Some(choice) = self.pages.menu.choice() {
            self.carry_out_choice(choice);
        }
    }

    /// Carries out a choice.
    pub(crate) fn carry_out_choice(&mut self, choice: Choice) {
        match choice {
            Choice::Open(page) => {
                self.is_private = false;
                if page == Page::Code {
                    self.entry = LineEntry::beginning("", CODE_COLUMNS);
                }
                self.open(page);
            }
            Choice::Enter { watches } => self.enter_room(watches),
            Choice::Board(level) => {
                (self.board.level, self.board.day) = (level, self.host.today);
                self.ask_for_board();
                self.open(Page::Board);
            }
            Choice::Recordings => {
                self.recordings = None;
                self.ask(SessionRequest::Recordings);
                self.open(Page::Recordings);
            }
            Choice::Recording(index) => {
                let row = self.recordings.as_ref().and_then(|rows| rows.get(index));
                if let Some(name) = row.map(|row| row.name.clone()) {
                    self.ask_for_record(RecordWish::Room(name));
                }
            }
            Choice::Run(index) => {
                let row = self.board.rows.as_ref().and_then(|rows| rows.get(index));
                let name = row.map(|row| row.name.clone());
                if let Some(((level, difficulty), name)) = self.asked_board().zip(name) {
                    self.ask_for_record(RecordWish::Run { level, difficulty, name });
                }
            }
            Choice::ChangePrivacy => self.change_privacy(),
            Choice::Change(row) => self.change_setting(row, true),
            Choice::Back => self.close(),
            Choice::Emote(emote) => {
                self.ask(SessionRequest::Command(Command::Emote(emote)));
                self.show(Page::Room);
            }
            Choice::Players => self.open_players(),
            Choice::Player(index) => {
                let names = self.players.names.as_ref();
                self.players.chosen = names.and_then(|names| names.get(index).cloned());
                self.open(Page::Player);
            }
            Choice::Talk => self.type_line(""),
            Choice::Write | Choice::Ignore | Choice::Report | Choice::Moderate(_) => {
                if let Some(player) = self.players.chosen.clone() {
                    self.act_on_player(choice, player);
                }
            }
            Choice::Again => {
                self.ask(SessionRequest::Command(Command::Again));
                self.show(Page::Room);
            }
            Choice::LeaveRoom => self.leave_by_request(),
        }
    }

    fn ask_for_record(&mut self, wish: RecordWish) {
        self.record_from = self.page();
        self.ask(SessionRequest::Record(wish));
        self.open(Page::Entering);
    }

    /// Carries out a choice about a player.
    fn act_on_player(&mut self, choice: Choice, player: Line) {
        match choice {
            Choice::Write => self.type_line(&format!("/tell {player} ")),
            Choice::Report => self.type_line(&format!("/report {player} ")),
            Choice::Ignore => {
                if self.ignored.contains(&player) {
                    self.stop_ignoring(&player);
                } else {
                    self.ignore(&player);
                }
                self.renew_menu();
            }
            Choice::Moderate(act) => {
                self.ask(SessionRequest::Moderate { player, act, reason: None });
                self.show_home();
            }
            _ => {}
        }
    }

    /// Opens the line of chat, from which the visitor returns to the room or the lobby.
    fn type_line(&mut self, text: &str) {
        self.show_home();
        self.open_chat(text);
    }

    fn enter_room(&mut self, watches: bool) {
        let Page::Card(target) = self.page() else { return };
        let way = match target {
            RoomTarget::Existing(room) if watches => RoomEntry::Watch(room),
            RoomTarget::Existing(room) => RoomEntry::Enter(room),
            RoomTarget::New { mode, level, difficulty } => {
                let Some(level) = self.chosen_level(level) else { return };
                let request = RoomRequest { level, mode, difficulty };
                RoomEntry::Open { request, is_private: self.is_private }
            }
        };
        self.ask(SessionRequest::Go(way));
        self.open(Page::Entering);
    }

    /// Opens the new room on the card to everybody, or to invited visitors only.
    pub(crate) fn change_privacy(&mut self) {
        self.is_private ^= true;
        self.renew_menu();
    }

    /// Requests the board of the chosen level.
    pub(crate) fn ask_for_board(&mut self) {
        self.board.rows = None;
        if let Some((level, difficulty)) = self.asked_board() {
            self.ask(SessionRequest::Board { level, difficulty });
        }
    }

    /// The level and the difficulty of the chosen board.
    pub(crate) fn asked_board(&self) -> Option<(String, Difficulty)> {
        match self.board.level {
            LevelChoice::Daily => Some((self.board.day.level(), Difficulty::Normal)),
            level @ LevelChoice::Listed(_) => {
                Some((self.chosen_level(level)?, self.identity.preferences.difficulty))
            }
        }
    }

    /// Leaves the room at the visitor's request.
    pub(crate) fn leave_by_request(&mut self) {
        self.ask(SessionRequest::Leave);
        self.leave_room(None);
    }

    /// Records that the visitor has left the room, and returns to the lobby.
    pub(crate) fn leave_room(&mut self, sentence: Option<String>) {
        self.stay = None;
        self.lobby.begin();
        self.note = sentence;
        self.ask(SessionRequest::Rooms);
        self.show(Page::Lobby);
    }
}

impl Ui {
    /// The entry of the lobby that `key` chooses, besides the digits.
    pub(crate) fn lobby_choice(&self, key: Key) -> Option<Choice> {
        let is_chosen = |entry: &&(char, &str, Choice)| Key::Char(entry.0) == key;
        let entry = LOBBY_ENTRIES.iter().find(is_chosen).filter(|entry| self.has(entry.2))?;
        (self.page() == Page::Lobby).then_some(entry.2)
    }

    /// The menu of `page`; empty if the page has none.
    pub(crate) fn menu_of(&self, page: Page) -> Menu<Choice> {
        match page {
            Page::Lobby => self.lobby_menu(),
            Page::Rooms => self.rooms_menu(),
            Page::Daily => self.daily_menu(),
            Page::Modes => modes_menu(),
            Page::Levels(mode) => self.levels_menu(mode),
            Page::Boards => self.boards_menu(),
            Page::Board => self.board_menu(),
            Page::Recordings => self.recordings_menu(),
            Page::Card(target) => self.card_menu(target),
            Page::Entering => Menu::new("").line("Going in…"),
            Page::Settings => self.settings_menu(),
            Page::Emotes => emotes_menu(),
            Page::RoomMenu => self.room_menu(),
            Page::Players => self.players_menu(),
            Page::Player => self.player_menu(),
            Page::Mute => self.mute_menu(),
            _ => Menu::new(""),
        }
    }

    fn lobby_menu(&self) -> Menu<Choice> {
        let menu = Menu::new(self.host.name.as_str()).lines(self.lobby_lines());
        let rooms = self.rooms_by_life();
        let offer = self.offer(&rooms);
        let others = rooms.iter().map(|room| RoomTarget::Existing(room.id));
        let others = others.filter(|&target| target != offer).take(ROOMS_IN_LOBBY);
        let cards = [offer].into_iter().chain(others).map(|target| {
            let (label, value) = self.label_of(target);
            (label, value, Choice::Open(Page::Card(target)))
        });
        let all = (rooms.len() > ROOMS_IN_LOBBY)
            .then(|| ("All rooms".to_owned(), rooms.len().to_string(), Choice::Open(Page::Rooms)));
        // There are at most seven, and digits choose the first nine entries of a menu.
        let menu =
            (1..).zip(cards.chain(all)).fold(menu, |menu, (digit, (label, value, choice))| {
                menu.entry_with(label, format!("{value}  {digit}"), choice)
            });
        let daily = self.host.today.title();
        let entries = LOBBY_ENTRIES.into_iter().filter(|(_, _, choice)| self.has(*choice));
        entries.fold(menu, |menu, (key, label, choice)| {
            let label = if choice == Choice::Open(Page::Daily) { &daily } else { label };
            let shown = Some(key).filter(|&key| !self.selects(key));
            menu.entry_with(label, shown.map_or(String::new(), String::from), choice)
        })
    }

    /// Whether the lobby has an entry.
    fn has(&self, choice: Choice) -> bool {
        choice != Choice::Recordings || self.host.has_recordings
    }

    /// Returns true if a key selects an entry, because the visitor walks with it.
    fn selects(&self, key: char) -> bool {
        let walks = [Intent::Forward, Intent::Back].map(|intent| Some(Action::Want(intent)));
        walks.contains(&self.bindings.action(Key::Char(key)))
    }

    /// The messages that the lobby shows.
    pub(crate) fn lobby_lines(&self) -> Vec<String> {
        let [notice, message] = [&self.host.notice, &self.host.message];
        let lines = [
            self.note.clone(),
            self.draining.map(|draining| draining.sentence(self.now)),
            notice.as_ref().map(ToString::to_string),
            message.as_ref().map(ToString::to_string),
            self.wants_compression.then(|| COMPRESSION.to_owned()),
        ];
        lines.into_iter().flatten().collect()
    }

    /// The multiplayer rooms that are open to everybody and whose levels this host has, by number of members in
    /// descending order, full rooms last.
    pub(crate) fn rooms_by_life(&self) -> Vec<&RoomSummary> {
        let is_offered = |room: &&RoomSummary| {
            let is_open = room.mode != Mode::Alone && room.code.is_none();
            is_open && self.host.catalog.has(&room.level)
        };
        let mut rooms: Vec<&RoomSummary> = self.rooms.iter().filter(is_offered).collect();
        let life = |room: &RoomSummary| std::cmp::Reverse(room.members.len());
        rooms.sort_by_key(|room| (room.is_full(), life(room), room.mode, room.id));
        rooms
    }

    /// The offered room: the room with the most members that is not full, or else a new room.
    pub(crate) fn offer(&self, rooms: &[&RoomSummary]) -> RoomTarget {
        let open = rooms.first().filter(|room| !room.is_full());
        open.map_or_else(|| self.first_walk(), |room| RoomTarget::Existing(room.id))
    }

    fn first_walk(&self) -> RoomTarget {
        let names = &self.host.catalog.names;
        let level = names.iter().position(|name| name == FIRST_LEVEL).unwrap_or(0);
        RoomTarget::New {
            mode: Mode::Roam,
            level: LevelChoice::Listed(level),
            difficulty: self.identity.preferences.difficulty,
        }
    }

    /// The label and the value of a room's menu entry.
    fn label_of(&self, target: RoomTarget) -> (String, String) {
        let catalog = &self.host.catalog;
        match target {
            RoomTarget::Existing(id) => {
                let Some(room) = self.room(id) else { return Default::default() };
                let label = format!("{} in {}", room.mode.title(), catalog.title(&room.level));
                (label, members_of(room))
            }
            RoomTarget::New { mode, .. } => {
                let label = format!("{} in {}", mode.title(), self.level_title(target));
                (label, "new".to_owned())
            }
        }
    }

    /// The title of a room's level.
    pub(crate) fn level_title(&self, target: RoomTarget) -> String {
        let name = self.level_name(target);
        name.map_or(String::new(), |name| self.host.catalog.title(&name).into_owned())
    }

    fn rooms_menu(&self) -> Menu<Choice> {
        let rooms = self.rooms_by_life();
        let menu = rooms.into_iter().fold(Menu::new("all rooms"), |menu, room| {
            let target = RoomTarget::Existing(room.id);
            let (label, value) = self.label_of(target);
            menu.entry_with(label, value, Choice::Open(Page::Card(target)))
        });
        menu.entry("Back", Choice::Back)
    }

    fn daily_menu(&self) -> Menu<Choice> {
        let best = self.best_of_today().into_iter();
        let menu = Menu::new(self.host.today.title())
            .line("The same level for everybody, until midnight UTC.")
            .lines(best.map(|(name, time)| format!("{name} {time}").trim_end().to_owned()));
        let level = self.host.today.level();
        let rooms = self.rooms_by_life().into_iter().filter(|room| room.level == level);
        let menu = rooms.take(ROOMS_IN_LOBBY).fold(menu, |menu, room| {
            let card = Choice::Open(Page::Card(RoomTarget::Existing(room.id)));
            menu.entry_with(room.mode.title(), members_of(room), card)
        });
        let menu = DAILY_MODES.into_iter().fold(menu, |menu, mode| {
            let (level, difficulty) = (LevelChoice::Daily, Difficulty::Normal);
            let card = Page::Card(RoomTarget::New { mode, level, difficulty });
            menu.entry_with(mode.title(), "new", Choice::Open(card))
        });
        menu.entry("Board", Choice::Board(LevelChoice::Daily)).entry("Back", Choice::Back)
    }

    fn levels_menu(&self, mode: Mode) -> Menu<Choice> {
        let difficulty = self.identity.preferences.difficulty;
        let menu = Menu::new(mode.title());
        let menu = if mode.has_guards() {
            menu.line(format!("On {}; left and right change the difficulty.", difficulty.name()))
        } else {
            menu
        };
        self.each_level(menu, mode, |level| {
            Choice::Open(Page::Card(RoomTarget::New { mode, level, difficulty }))
        })
    }

    fn boards_menu(&self) -> Menu<Choice> {
        let daily = Choice::Board(LevelChoice::Daily);
        let menu = Menu::new("board").entry(self.host.today.title(), daily);
        self.each_level(menu, Mode::Alone, Choice::Board)
    }

    /// Adds an entry to `menu` for each level that suits the mode.
    fn each_level(
        &self,
        menu: Menu<Choice>,
        mode: Mode,
        choice: impl Fn(LevelChoice) -> Choice,
    ) -> Menu<Choice> {
        let catalog = &self.host.catalog;
        let levels = catalog.names.iter().enumerate();
        levels.filter(|(_, name)| catalog.suits(name, mode)).fold(menu, |menu, (index, name)| {
            menu.entry(catalog.title(name), choice(LevelChoice::Listed(index)))
        })
    }

    fn board_menu(&self) -> Menu<Choice> {
        let Some((level, difficulty)) = self.asked_board() else { return Menu::default() };
        let menu = Menu::new(self.host.catalog.title(&level)).line(match self.board.level {
            LevelChoice::Daily => "Left and right change the day.".to_owned(),
            LevelChoice::Listed(_) => {
                format!("On {}; left and right change the difficulty.", difficulty.name())
            }
        });
        match &self.board.rows {
            None => menu.line("…"),
            Some(rows) if rows.is_empty() => menu.line("Nobody has won it yet."),
            Some(rows) => rows.iter().enumerate().fold(menu, |menu, (index, row)| {
                let own = if row.is_own { " (you)" } else { "" };
                let label = format!("{:>2}. {}{own}", index + 1, row.name);
                let value = format!("{}  {}", row.rank.name(), of_steps(row.steps));
                menu.entry_with(label, value, Choice::Run(index))
            }),
        }
        .entry("Back", Choice::Back)
    }

    fn recordings_menu(&self) -> Menu<Choice> {
        let menu = Menu::new("recordings");
        let catalog = &self.host.catalog;
        match &self.recordings {
            None => menu.line("…"),
            Some(rows) if rows.is_empty() => menu.line("There is none yet."),
            Some(rows) => rows.iter().enumerate().fold(menu, |menu, (index, row)| {
                let label = format!("{} in {}", row.mode.title(), catalog.title(&row.level));
                let age = SystemTime::now().duration_since(row.ended).unwrap_or_default();
                menu.entry_with(label, ago(age), Choice::Recording(index))
            }),
        }
        .entry("Back", Choice::Back)
    }

    fn card_menu(&self, target: RoomTarget) -> Menu<Choice> {
        let back = |menu: Menu<Choice>| menu.entry("Back", Choice::Back);
        let (mode, who, is_full) = match target {
            RoomTarget::New { mode, .. } => (mode, None, false),
            RoomTarget::Existing(id) => match self.room(id) {
                None => return back(Menu::new("").line("The room is closed.")),
                Some(room) if !self.host.catalog.has(&room.level) => {
                    return back(Menu::new("").line(RoomRefusal::NoLevel.to_string()));
                }
                Some(room) => (room.mode, Some(who_is_here(room)), room.is_full()),
            },
        };
        let menu = Menu::new(mode.title());
        let keys = "Arrows walk, Enter talks, ? helps.";
        let alone = "Arrows walk, ? helps.";
        let is_alone = mode == Mode::Alone;
        let guest = "You are a guest: with a key, your results go on the board.";
        let lines = [
            Some(self.level_title(target)),
            Some(mode.about().to_owned()),
            who,
            Some(if is_alone { alone } else { keys }.to_owned()),
            (is_alone && !self.identity.has_account).then(|| guest.to_owned()),
        ];
        let menu = lines.into_iter().flatten().fold(menu, Menu::line);
        let [enters, watches] = [false, true].map(|watches| Choice::Enter { watches });
        back(match target {
            RoomTarget::New { mode: Mode::Alone, .. } => menu.entry("Go in", enters),
            RoomTarget::New { .. } => {
                let privacy = if self.is_private { "invited visitors" } else { "everybody" };
                menu.entry("Go in", enters).entry_with("Open to", privacy, Choice::ChangePrivacy)
            }
            RoomTarget::Existing(_) if is_full => menu.entry("Watch (full)", watches),
            RoomTarget::Existing(_) => menu.entry("Go in", enters).entry("Watch", watches),
        })
    }

    fn room_menu(&self) -> Menu<Choice> {
        let is_member = self.stay.as_ref().is_some_and(|stay| stay.member.is_some());
        let menu = Menu::new("room").line("The room goes on meanwhile.");
        let code = self.stay.as_ref().and_then(|stay| stay.code);
        let menu = menu.lines(code.map(|code| format!("Others can join with the code {code}.")));
        let menu = menu.entry("Go on", Choice::Back);
        let menu = if is_member { menu.entry("Restart the round", Choice::Again) } else { menu };
        menu.entry("Settings", Choice::Open(Page::Settings))
            .entry("Help", Choice::Open(Page::Help))
            .entry_with("Players", "7", Choice::Players)
            .entry_with("Leave the room", "q", Choice::LeaveRoom)
    }
}

/// The pages about players.
impl Ui {
    fn players_menu(&self) -> Menu<Choice> {
        let menu = match &self.players.names {
            None => Menu::new("players").line("…"),
            Some(names) if names.is_empty() => Menu::new("players").line("Nobody else is here."),
            Some(_) => Menu::new("players"),
        };
        let names = self.players.names.iter().flat_map(|names| names.iter()).enumerate();
        let menu = names.fold(menu, |menu, (index, name)| {
            let value = if self.ignored.contains(name) { "ignored" } else { "" };
            menu.entry_with(name.as_str(), value, Choice::Player(index))
        });
        menu.entry_with("Talk", "/", Choice::Talk).entry("Back", Choice::Back)
    }

    fn player_menu(&self) -> Menu<Choice> {
        let Players { chosen, moderates, .. } = &self.players;
        let Some(player) = chosen else { return Menu::new("").entry("Back", Choice::Back) };
        let is_ignored = self.ignored.contains(player);
        let menu = Menu::new(player.as_str())
            .entry("Write", Choice::Write)
            .entry(if is_ignored { "Stop ignoring" } else { "Ignore" }, Choice::Ignore)
            .entry("Report", Choice::Report);
        let menu = if *moderates {
            menu.entry("Mute", Choice::Open(Page::Mute))
                .entry("Unmute", Choice::Moderate(Moderation::Unmute))
                .entry("Kick", Choice::Moderate(Moderation::Kick))
        } else {
            menu
        };
        menu.entry("Back", Choice::Back)
    }

    fn mute_menu(&self) -> Menu<Choice> {
        let name = self.players.chosen.as_ref().map_or("", Line::as_str);
        let times = [("10 minutes", 10), ("1 hour", 60), ("1 day", 24 * 60)];
        let menu = Menu::new(format!("mute {name} for"));
        let menu = times.into_iter().fold(menu, |menu, (label, minutes)| {
            let act = Moderation::Mute(Duration::from_mins(minutes));
            menu.entry(label, Choice::Moderate(act))
        });
        menu.entry("Back", Choice::Back)
    }
}

/// The age of a recording.
fn ago(age: Duration) -> String {
    match age.as_secs() / 60 {
        minutes @ 0..60 => format!("{minutes} min ago"),
        minutes @ 60..2880 => format!("{} h ago", minutes / 60),
        minutes => format!("{} days ago", minutes / 1440),
    }
}

/// The number of a room's members, of the number that it admits.
fn members_of(room: &RoomSummary) -> String {
    format!("{}/{}", room.members.len(), room.mode.most())
}

/// A sentence with the names of a room's members and the numbers of watchers and browsers.
fn who_is_here(room: &RoomSummary) -> String {
    let counts = [(room.watchers, "watcher"), (room.browsers, "browser")];
    let counts = counts.into_iter().filter(|(count, _)| *count > 0);
    let counts: Vec<String> = counts
        .map(|(count, what)| format!("{count} {what}{}", if count == 1 { "" } else { "s" }))
        .collect();
    let watchers =
        if counts.is_empty() { String::new() } else { format!(" {}.", counts.join(", ")) };
    let names: Vec<&str> = room.members.iter().map(Line::as_str).collect();
    if names.is_empty() {
        return format!("Nobody is here yet.{watchers}");
    }
    format!("Here: {}.{watchers}", names.join(", "))
}

fn modes_menu() -> Menu<Choice> {
    let modes = Mode::ALL.into_iter().filter(|&mode| mode != Mode::Alone);
    modes.fold(Menu::new("open a room"), |menu, mode| {
        let members = match mode.fewest() {
            1 => format!("up to {}", mode.most()),
            fewest => format!("{fewest} to {}", mode.most()),
        };
        menu.entry_with(mode.title(), members, Choice::Open(Page::Levels(mode)))
    })
}

fn emotes_menu() -> Menu<Choice> {
    (1..).zip(Emote::ALL).fold(Menu::new("show"), |menu, (number, &(emote, _, text))| {
        menu.entry_with(text, number.to_string(), Choice::Emote(emote))
    })
}

//! Sessions with terminal emulators and one room, in simulated time.

mod bytes;
mod driver;
mod ghosts;
mod home;
mod lag;
mod pages;
mod pictures;
mod room;
mod seeds;

#[path = "../../../tests/support/emulator.rs"]
mod emulator;

use std::sync::Arc;
use std::time::Duration;

use self::emulator::{Emulator, Speaks};
use super::*;
use crate::app::Configuration;
use crate::color::palette::ColorDepth;
use crate::game::PlayerColor;
use crate::map;
use crate::server::ghost::Ghost;
use crate::server::line::Line;
use crate::server::room::{Catalog, Deed, Entry, Header, MemberId, Mode, NAME_COLUMNS, Room};
use crate::server::summary::{RoomId, RoomSummary};
use crate::store::Preferences;
use crate::store::host::AccountSettings;
use crate::terminal::Detected;
use crate::world::{Difficulty, FieldOfView};

const HALL: &str = r##"
title = "The Hall"
grid = '''
###############
#@............#
#.............#
#.............#
#............>#
###############
'''
[tiles]
"#" = { wall = "#808080" }
[things]
"@" = { start = 0 }
">" = { exit = true }
"##;

const ROOM: RoomId = RoomId(7);
const ENTER: &str = "\r";
const ESCAPE: &str = "\x1b";

/// A visitor with a terminal.
struct Visitor {
    session: Session,
    emulator: Emulator,
    member: Option<MemberId>,
    is_inside: bool,
    /// Whether the terminal's answers arrive.
    answers: bool,
    /// The answers that are under way, and when they arrive.
    under_way: Vec<(Duration, Vec<u8>)>,
    latency: Duration,
    bytes: usize,
    /// The pictures that were drawn, whether they differ or not.
    pictures: u64,
    wants: Vec<(u64, u64)>,
    /// How often the bell has rung.
    bells: usize,
    saved: Option<AccountSettings>,
    /// All that was sent, frame by frame.
    sent: Vec<Vec<u8>>,
}

/// A host with one room.
struct Rig {
    now: Duration,
    catalog: Arc<Catalog>,
    room: Room,
    /// What the members did in this round, in the order in which it took effect.
    log: Vec<Entry>,
    visitors: Vec<Visitor>,
    /// The runs that walk along.
    ghosts: Arc<[Ghost]>,
}

fn line(text: &str) -> Line {
    Line::of(text, NAME_COLUMNS).unwrap()
}

impl Rig {
    fn new(mode: Mode) -> Self {
        let mut catalog = Catalog::default();
        for name in ["museum", "hall"] {
            catalog.add(name, map::parse(HALL, name, &map::NoFiles).unwrap());
        }
        let catalog = Arc::new(catalog);
        let header = Header::new("hall", mode, Difficulty::Normal, 7);
        let room = Room::new(&catalog, header).unwrap();
        let now = Duration::from_secs(1);
        let ghosts = Arc::from([]);
        Self { now, catalog, room, log: Vec::new(), visitors: Vec::new(), ghosts }
    }

    /// Adds a visitor whose terminal has no colours, and returns their index.
    fn visitor(&mut self, name: &str, (columns, rows): (u16, u16), speaks: Speaks) -> usize {
        self.visitor_with(name, (columns, rows), speaks, ColorDepth::Mono)
    }

    fn visitor_with(
        &mut self,
        name: &str,
        (columns, rows): (u16, u16),
        speaks: Speaks,
        depth: ColorDepth,
    ) -> usize {
        let environment = |name: &str| (name == "TERM").then(|| "xterm-256color".to_owned());
        let mut options = Options::from_environment(environment);
        options.color_depth = Detected::Certain(depth);
        options.is_ascii = depth == ColorDepth::Mono;
        options.is_remote = true;
        let identity = Identity {
            has_account: false,
            name: line(name),
            is_named: false,
            preferences: Preferences::default(),
            configuration: Configuration::default(),
        };
        let host = HostFacts {
            name: line("play.example.org"),
            message: Some(line("Be kind.")),
            notice: None,
            compresses: true,
            ascii_locale: None,
            catalog: Arc::clone(&self.catalog),
            idle: IdleLimits::default(),
            frame_time: Duration::from_millis(33),
        };
        let size = WindowSize::of_cells(columns, rows);
        let session = Session::new(identity, options, size, host, self.now);
        self.visitors.push(Visitor {
            session,
            emulator: Emulator::new(columns.max(1), rows.max(1), speaks),
            member: None,
            is_inside: false,
            answers: true,
            under_way: Vec::new(),
            latency: Duration::ZERO,
            bytes: 0,
            pictures: 0,
            wants: Vec::new(),
            bells: 0,
            saved: None,
            sent: Vec::new(),
        });
        self.pump(300);
        self.visitors.len() - 1
    }

    /// A visitor who is in the room.
    fn member(&mut self, name: &str, size: (u16, u16), speaks: Speaks) -> usize {
        let index = self.visitor(name, size, speaks);
        for _ in 0..3 {
            self.press(index, ENTER);
        }
        assert!(self.visitors[index].member.is_some(), "{}", self.text(index));
        index
    }

    /// Types bytes, and lets half a second pass.
    fn press(&mut self, index: usize, bytes: &str) {
        self.send(index, bytes);
        self.pump(500);
    }

    fn send(&mut self, index: usize, bytes: &str) {
        let now = self.now;
        self.visitors[index].session.receive(bytes.as_bytes(), now);
        self.serve(index);
    }

    /// Lets that many milliseconds pass.
    fn pump(&mut self, milliseconds: u64) {
        let end = self.now + Duration::from_millis(milliseconds);
        while self.now < end {
            self.now += Duration::from_nanos(16_666_667);
            self.step();
        }
    }

    fn step(&mut self) {
        (0..self.visitors.len()).for_each(|index| self.serve(index));
        self.room.advance();
        if self.room.is_over() {
            self.room.begin_next();
            self.log.clear();
        }
        (0..self.visitors.len()).for_each(|index| self.show(index));
    }

    /// What the visitor's screen shows.
    fn text(&self, index: usize) -> String {
        let screen = self.visitors[index].emulator.screen();
        let (_, columns) = screen.size();
        let rows = screen.rows(0, columns.get()).map(|row| row.trim_end().to_owned() + "\n");
        rows.collect()
    }

    fn position(&self, index: usize) -> glam::DVec2 {
        let view = self.room.view();
        let member = view.member(self.visitors[index].member.unwrap()).unwrap();
        let player = view.game.seen_by(member.player.unwrap()).unwrap();
        player.camera(FieldOfView::default()).position()
    }

    fn page(&self, index: usize) -> page::Page {
        self.visitors[index].session.visit.page
    }
}

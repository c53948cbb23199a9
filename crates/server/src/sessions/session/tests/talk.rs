//! Visitors write to each other, ignore and report each other, and moderators mute them.

use super::*;
use crate::accounts::AccountKey;
use crate::config::Config;
use crate::sessions::session::pages::Page;
use crate::simulation::guest;
use crate::ssh::Visitor;
use cellcaster::color::palette::ColorDepth;

fn key(number: u8) -> AccountKey {
    AccountKey::new([number; 32])
}

impl Rig {
    /// Connects a visitor with an address of their own; returns their index on the page for the name.
    fn stranger(&mut self, name: &str, address: u8, key: Option<AccountKey>) -> usize {
        let peer = ([192, 0, 2, address], 22).into();
        let index = self.connect(
            Visitor { peer, key, ..guest(name, (80, 24)) },
            Speaks::Plain,
            ColorDepth::Mono,
        );
        self.pump(300);
        index
    }

    /// Connects a visitor who stays in the lobby.
    fn in_lobby(&mut self, name: &str, address: u8) -> usize {
        let index = self.stranger(name, address, None);
        self.press(index, ENTER);
        assert_eq!(self.page(index), Page::Lobby, "{}", self.text(index));
        index
    }

    /// Connects a visitor who enters the room.
    fn in_room(&mut self, name: &str, address: u8, key: Option<AccountKey>) -> usize {
        let index = self.stranger(name, address, key);
        for _ in 0..3 {
            self.press(index, ENTER);
        }
        assert_eq!(self.page(index), Page::Room, "{}", self.text(index));
        index
    }

    /// Types a line of chat, and lets the limit of lines recover.
    fn say(&mut self, index: usize, line: &str) {
        self.press(index, "/");
        assert_eq!(self.page(index), Page::Chat, "{}", self.text(index));
        self.press(index, &format!("{line}\r"));
        self.pump(500);
    }

    /// Types a line of chat, after which a visitor reads a text.
    fn answers(&mut self, (from, line): (usize, &str), (to, text): (usize, &str)) {
        self.say(from, line);
        self.shows(to, text);
    }

    fn shows(&self, index: usize, text: &str) {
        assert!(self.text(index).contains(text), "{text}\n{}", self.text(index));
    }

    fn hides(&self, index: usize, text: &str) {
        assert!(!self.text(index).contains(text), "{text}\n{}", self.text(index));
    }

    fn moderated_by(&self, moderators: &[AccountKey]) {
        let config = self.live.get();
        let moderators = moderators.to_vec();
        self.live.replace(Config { moderators, ..(*config).clone() });
    }

    fn lines_in_log(&self) -> Vec<String> {
        self.view().said.iter().map(|said| said.text.clone()).collect()
    }
}

/// A room with these visitors, who have no accounts.
fn in_a_room<const N: usize>(names: [&str; N]) -> (Rig, [usize; N]) {
    let mut rig = Rig::new(Mode::Roam);
    let mut addresses = 1..;
    let visitors = names.map(|name| rig.in_room(name, addresses.next().unwrap(), None));
    (rig, visitors)
}

#[test]
fn a_visitor_in_a_room_and_one_in_the_lobby_write_to_each_other() {
    let (mut rig, [mara]) = in_a_room(["Mara"]);
    let jon = rig.in_lobby("Jon", 2);
    let kim = rig.in_lobby("Kim", 3);
    rig.answers(
        (mara, "/tell JON come in, the water is warm"),
        (jon, "Mara (private) come in, the water is warm"),
    );
    rig.shows(mara, "to JON (private) come in");
    rig.hides(kim, "come in");
    rig.answers((jon, "/reply where are you?"), (mara, "Jon (private) where are you?"));
    rig.hides(kim, "where are you?");
    assert!(rig.lines_in_log().iter().all(|line| !line.contains("water")));
    rig.answers((jon, "/tell Nobody1 hello"), (jon, "Nobody here is called Nobody1."));
    rig.pump(9_000);
    rig.hides(mara, "where are you?");
}

#[test]
fn lines_in_the_lobby_reach_everybody_there_and_nobody_else() {
    let mut rig = Rig::new(Mode::Roam);
    let [jon, kim] = [("Jon", 2), ("Kim", 3)].map(|(name, last)| rig.in_lobby(name, last));
    let mara = rig.in_room("Mara", 1, None);
    let naming = rig.stranger("Ada", 4, None);
    rig.say(jon, "anybody for a race?");
    for index in [jon, kim] {
        rig.shows(index, "Jon anybody for a race?");
        assert_eq!(rig.page(index), Page::Lobby);
    }
    for index in [mara, naming] {
        rig.hides(index, "anybody");
    }
    rig.press(kim, "/");
    rig.press(kim, ESCAPE);
    assert_eq!(rig.page(kim), Page::Lobby);
}

#[test]
fn a_flood_of_lines_is_limited() {
    let mut rig = Rig::new(Mode::Roam);
    let [jon, kim] = [("Jon", 2), ("Kim", 3)].map(|(name, last)| rig.in_lobby(name, last));
    let flood: Vec<String> = (1..=9).map(|number| format!("/line {number}\r")).collect();
    rig.press(jon, &flood.concat());
    rig.shows(kim, "line 5");
    rig.hides(kim, "line 6");
    rig.press(jon, "/more\r");
    rig.shows(jon, "Not so fast: wait a second.");
}

#[test]
fn an_ignored_player_is_not_heard_until_the_visitor_stops_ignoring_them() {
    let (mut rig, [mara, jon]) = in_a_room(["Mara", "Jon"]);
    rig.answers((mara, "/ignore JON"), (mara, "You ignore JON"));
    rig.say(jon, "you are slow");
    rig.say(jon, "/tell Mara do you hear me?");
    rig.press(jon, "1");
    rig.press(jon, "4");
    for text in ["you are slow", "do you hear me?", "laughs"] {
        rig.hides(mara, text);
    }
    rig.say(mara, "/unignore jon");
    rig.pump(2_000);
    rig.answers((jon, "sorry"), (mara, "Jon sorry"));
    rig.hides(mara, "you are slow");
}

#[test]
fn the_ignored_players_of_an_account_are_kept() {
    let mut rig = Rig::new(Mode::Roam);
    let jon = rig.in_room("Jon", 2, None);
    let mara = rig.in_room("Mara", 1, Some(key(1)));
    rig.say(mara, "/ignore Jon");
    rig.clients[mara].cut();
    rig.pump(500);
    let mara = rig.in_room("Mara", 1, Some(key(1)));
    rig.say(jon, "still here");
    rig.hides(mara, "still here");
}

#[test]
fn the_list_of_ignored_players_is_bounded() {
    let (mut rig, [mara]) = in_a_room(["Mara"]);
    for number in 0..32 {
        rig.say(mara, &format!("/ignore player{number}x"));
    }
    rig.hides(mara, "ends one.");
    rig.say(mara, "/ignore Jon");
    rig.shows(mara, "You ignore 32 players; /unignore NAME ends one.");
}

#[test]
fn an_unknown_command_is_explained_and_never_said() {
    let (mut rig, [mara]) = in_a_room(["Mara"]);
    let before = rig.lines_in_log();
    for (line, sentence) in [
        ("/tel Jon my secret", "Commands: /tell, /reply, /players, /ignore, /unignore, /report."),
        ("/", "Commands: /tell"),
        ("/tell Jon", "Write /tell NAME TEXT."),
        // No name is that long, and the beginning may be the name of another player.
        ("/tell amber-fox-with-a-long-tail my secret", "Write /tell NAME TEXT."),
        ("/reply hello", "Nobody has written to you"),
        ("/mute Jon 5m", "Write /mute NAME and 10m, 1h or 1d."),
        ("/mute Jon 10m", "Only moderators of this host can do that."),
        ("/kick Jon", "Only moderators of this host can do that."),
    ] {
        rig.answers((mara, line), (mara, sentence));
        rig.pump(1_000);
    }
    assert_eq!(rig.lines_in_log(), before);
}

#[test]
fn a_private_line_is_as_long_as_a_line_of_chat() {
    let (mut rig, [mara, jon]) = in_a_room(["Mara", "Jon"]);
    let longest = "0123456789".repeat(6);
    for (to, from, command) in [(jon, mara, "/tell Jon"), (mara, jon, "/reply")] {
        rig.answers(
            (from, &format!("{command} {longest}x")),
            (to, &format!("(private) {longest}")),
        );
        rig.hides(to, "9x");
        rig.answers((from, &format!("{longest}y")), (to, &longest));
        rig.hides(to, "9y");
    }
}

#[test]
fn the_help_names_the_keys_of_talk() {
    let (mut rig, [mara]) = in_a_room(["Mara"]);
    rig.press(mara, "?");
    rig.press(mara, "\x1b[F");
    for text in ["7 lists the players here", "/tell NAME TEXT writes to a player anywhere."] {
        rig.shows(mara, text);
    }
}

#[test]
fn a_player_is_chosen_from_the_list() {
    let (mut rig, [mara, jon]) = in_a_room(["Mara", "Jon"]);
    let watcher = rig.in_lobby("Kim", 3);
    rig.press(watcher, ENTER);
    rig.press(watcher, "2");
    assert_eq!(rig.page(watcher), Page::Room, "{}", rig.text(watcher));
    rig.press(mara, "7");
    for name in ["Jon", "Kim"] {
        rig.shows(mara, name);
    }
    rig.press(mara, ENTER);
    for entry in ["Write", "Ignore", "Report"] {
        rig.shows(mara, entry);
    }
    rig.hides(mara, "Kick");
    rig.press(mara, ENTER);
    rig.press(mara, "hello\r");
    assert_eq!(rig.page(mara), Page::Room);
    rig.shows(jon, "Mara (private) hello");
    // A watcher can write to players, but not to the room.
    rig.answers((watcher, "faster!"), (watcher, "Watchers can't talk in the room"));
    rig.answers((watcher, "/tell Mara faster!"), (mara, "Kim (private) faster!"));
    rig.press(mara, "7");
    rig.press(mara, ENTER);
    rig.press(mara, "2");
    rig.shows(mara, "Stop ignoring");
}

#[test]
fn the_lobby_lists_who_is_in_it() {
    let mut rig = Rig::new(Mode::Roam);
    let jon = rig.in_lobby("Jon", 2);
    rig.in_lobby("Kim", 3);
    rig.in_room("Mara", 1, None);
    rig.press(jon, "9");
    assert_eq!(rig.page(jon), Page::Players, "{}", rig.text(jon));
    rig.shows(jon, "Kim");
    // The panel beside the menu shows her, but the menu does not.
    rig.hides(jon, "|   Mara");
    // Below the players, an entry opens the line of chat.
    rig.press(jon, "2");
    rig.press(jon, "hello, lobby\r");
    rig.shows(jon, "Jon hello, lobby");
    assert_eq!(rig.page(jon), Page::Lobby);
}

#[test]
fn reports_reach_moderators_and_are_limited() {
    let mut rig = Rig::new(Mode::Roam);
    let mara = rig.in_room("Mara", 1, Some(key(1)));
    rig.moderated_by(&[key(1)]);
    let jon = rig.in_room("Jon", 2, None);
    let kim = rig.in_room("Kim", 3, None);
    rig.say(jon, "you are slow");
    rig.answers((kim, "/report jon insults"), (mara, "Kim reports jon: insults"));
    rig.shows(kim, "You have reported jon to this host.");
    rig.hides(jon, "reports");
    rig.answers((kim, "/report Nobody1"), (kim, "Nobody here is called Nobody1."));
    for _ in 0..3 {
        rig.say(kim, "/report jon");
    }
    rig.shows(kim, "You have reported several players; wait half a minute.");
}

#[test]
fn a_player_muted_by_a_moderator_is_not_heard_and_can_play() {
    let mut rig = Rig::new(Mode::Roam);
    let mara = rig.in_room("Mara", 1, Some(key(1)));
    let jon = rig.in_room("Jon", 2, None);
    let kim = rig.in_lobby("Kim", 3);
    rig.moderated_by(&[key(1)]);
    rig.press(mara, "7");
    rig.press(mara, ENTER);
    for entry in ["Mute", "Unmute", "Kick"] {
        rig.shows(mara, entry);
    }
    rig.press(mara, "4");
    rig.press(mara, "2");
    rig.shows(mara, "Jon is muted for 1h.");
    rig.pump(9_000);
    let before = rig.lines_in_log();
    let muted = "The moderator Mara has muted you for ";
    for line in ["you are slow", "/tell Kim you are slow"] {
        rig.answers((jon, line), (jon, muted));
        rig.pump(1_000);
    }
    rig.press(jon, "1");
    rig.press(jon, "4");
    assert_eq!(rig.lines_in_log(), before);
    rig.hides(kim, "slow");
    let start = rig.position(jon).x;
    rig.press(jon, "w");
    assert!(rig.position(jon).x > start);

    // Neither the lobby, nor another name, nor a new session ends the mute.
    rig.press(jon, "q");
    rig.press(jon, "q");
    assert_eq!(rig.page(jon), Page::Lobby);
    rig.answers((jon, "kim is slow"), (jon, muted));
    rig.hides(kim, "kim is slow");
    rig.clients[jon].cut();
    let jon = rig.in_room("Ben", 2, None);
    rig.say(jon, "me again");
    assert!(!rig.lines_in_log().contains(&"me again".to_owned()));
    rig.answers((mara, "/unmute ben"), (mara, "ben may talk again."));
    rig.answers((jon, "thank you"), (mara, "Ben thank you"));
    rig.answers((mara, "/unmute ben"), (mara, "ben is not muted."));
}

#[test]
fn a_player_with_a_key_is_muted_by_key() {
    let mut rig = Rig::new(Mode::Roam);
    let mara = rig.in_room("Mara", 1, Some(key(1)));
    let jon = rig.in_room("Jon", 2, Some(key(2)));
    let kim = rig.in_room("Kim", 2, None);
    rig.moderated_by(&[key(1)]);
    rig.clients[jon].cut();
    rig.pump(500);
    // The player has gone meanwhile.
    rig.answers((mara, "/mute JON 10m insults"), (mara, "JON is muted for 10m."));
    let jon = rig.in_room("Jon", 4, Some(key(2)));
    rig.answers((jon, "you are slow"), (jon, "The moderator Mara has muted you for 10m: insults"));
    rig.answers((kim, "good evening"), (mara, "Kim good evening"));
}

#[test]
fn a_moderator_ends_a_session_until_a_reload_ends_their_rights() {
    let mut rig = Rig::new(Mode::Roam);
    let mara = rig.in_room("Mara", 1, Some(key(1)));
    let [jon, kim] = [("Jon", 2), ("Kim", 3)].map(|(name, last)| rig.in_room(name, last, None));
    rig.moderated_by(&[key(1)]);
    rig.say(mara, "/kick jon let others play");
    rig.pump(500);
    rig.shows(jon, "The moderator Mara has ended your session: let others play");
    assert!(rig.is_over(jon));
    rig.moderated_by(&[]);
    rig.answers((mara, "/kick kim"), (mara, "Only moderators of this host can do that."));
    assert!(!rig.is_over(kim));
}

//! `cellcaster-server admin`.

use std::fs;
use std::io::{Read, Write};
use std::os::unix::fs::PermissionsExt;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::process::Output;

use cellcaster_server::accounts::{AccountKey, HostStore, Name, UnixTime};
use serde_json::{Value, json};

use crate::running::Running;
use crate::support::server;
use crate::transport::{TIMEOUT, folder};

fn admin(folder: &Path, arguments: &[&str]) -> Output {
    server(&["admin"]).args(arguments).args(["--data"]).arg(folder).output().unwrap()
}

/// Runs `admin`, asserts success, and returns its output.
fn written(folder: &Path, arguments: &[&str]) -> String {
    let output = admin(folder, arguments);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), error.as_str()), (Some(0), ""), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Runs `admin`, asserts failure, and returns the error message.
fn complaint(folder: &Path, arguments: &[&str]) -> String {
    let output = admin(folder, arguments);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?} {error}");
    assert_eq!(error.lines().count(), 1, "{error}");
    error
}

/// A document of JSON with a list.
fn list(text: &str) -> Vec<Value> {
    serde_json::from_str(text).unwrap()
}

#[test]
fn operators_see_visitors_talk_to_them_and_end_their_sessions() {
    let running = Running::start("", "text");
    assert_eq!(running.admin_says(&["who"]), "nobody is online\n");
    running.admin_says(&["rooms"]);
    let mut visitor = running.visitor();
    running.wait_for_visitors(1);
    let who = running.admin_says(&["who"]);
    assert!(who.contains("127.0.0.1") && who.contains("guest"), "{who}");
    let who = list(&running.admin_says(&["who", "--format", "json"]));
    let keys = ["address", "host", "key", "name", "room", "seconds", "session"];
    assert_eq!(who[0].as_object().unwrap().keys().collect::<Vec<_>>(), keys);
    assert_eq!((&who[0]["address"], &who[0]["key"]), (&json!("127.0.0.1"), &Value::Null));
    let rooms = list(&running.admin_says(&["rooms", "--format", "json"]));
    let keys = ["difficulty", "is_private", "level", "members", "mode", "most", "room", "watchers"];
    assert_eq!(rooms[0].as_object().unwrap().keys().collect::<Vec<_>>(), keys);
    assert_eq!(running.admin_says(&["say", "closing \u{1b}[31msoon"]), "said to 1 visitor\n");
    visitor.wait_for("closing [31msoon");
    let kick = ["kick", "--address", "127.0.0.0/8", "--reason", "repairs"];
    assert_eq!(running.admin_says(&kick), "ended 1 session\n");
    visitor.wait_for("ended your session: repairs");
    visitor.wait_for_end();
    running.wait_for_visitors(0);
    for said in ["admin: said", "admin: removed who=\"127.0.0.0/8\" count=1"] {
        assert!(running.log().contains(said), "{}", running.log());
    }
    assert!(!running.log().contains("closing"), "{}", running.log());
    assert!(complaint(&running.folder, &["hosts"]).contains("this host is not in a cluster"));
}

#[test]
fn one_of_several_sessions_can_be_kicked() {
    let running = Running::start("", "text");
    let first = running.visitor();
    running.wait_for_visitors(1);
    let mut second = running.visitor();
    running.wait_for_visitors(2);
    let who = running.admin_says(&["who"]);
    assert!(who.starts_with("session "), "{who}");
    let sessions: Vec<&str> =
        who.lines().skip(1).map(|line| line.split(' ').next().unwrap()).collect();
    assert_eq!(running.admin_says(&["kick", "--session", sessions[1]]), "ended 1 session\n");
    second.wait_for("ended your session");
    second.wait_for_end();
    running.wait_for_visitors(1);
    assert!(running.admin_says(&["who"]).contains(sessions[0]), "{sessions:?}");
    let said = complaint(&running.folder, &["kick", "--session", sessions[1]]);
    assert!(said.contains("no session matches"), "{said}");
    first.send("x");
}

#[test]
fn a_ban_ends_sessions_and_is_stored() {
    let running = Running::start("", "text");
    let mut visitor = running.visitor();
    running.wait_for_visitors(1);
    let said =
        running.admin_says(&["ban", "--address", "127.0.0.1", "--for", "7d", "--reason", "floods"]);
    assert_eq!(said, "banned 127.0.0.1/32 for 7d; ended 1 session\n");
    visitor.wait_for("You are banned from this host: floods");
    visitor.wait_for_end();
    let bans = running.admin_says(&["bans"]);
    // A second later, the remaining time is less than seven days.
    let has_time = bans.contains("7d") || bans.contains("6d 23h");
    assert!(has_time && bans.contains("127.0.0.1/32") && bans.contains("floods"), "{bans}");
}

#[test]
fn bans_work_while_no_server_runs() {
    let folder = folder();
    let mut store = HostStore::open(&folder).unwrap();
    let (key, now) = (AccountKey::new([1; 32]), UnixTime::new(1_795_300_000));
    store.create_account(None, &key, &Name::new("Ada").unwrap(), now).unwrap();
    drop(store);
    assert_eq!(written(&folder, &["bans"]), "nobody is banned\n");
    assert_eq!(written(&folder, &["bans", "--format", "json"]), "[]\n");
    // A ban on a name includes the key of its account.
    let said = written(&folder, &["ban", "ADA", "--reason", "'; DROP TABLE bans; --"]);
    assert_eq!(said, format!("banned ADA and {key} forever; no server runs\n"));
    written(&folder, &["ban", "--key", &AccountKey::new([2; 32]).to_string(), "--for", "30m"]);
    let bans = written(&folder, &["bans"]);
    assert_eq!(bans.lines().count(), 4, "{bans}");
    assert!(bans.contains("'; DROP TABLE bans; --"), "{bans}");
    let bans = list(&written(&folder, &["bans", "--format", "json"]));
    let of = |kind: &str| bans.iter().find(|ban| ban["kind"] == kind).unwrap();
    assert_eq!((&of("name")["banned"], &of("name")["until"]), (&json!("ADA"), &Value::Null));
    assert_eq!(of("name")["reason"], "'; DROP TABLE bans; --");
    assert!(of("key")["made"].as_u64() > Some(1_700_000_000), "{bans:?}");
    let said = written(&folder, &["unban", "ada"]);
    assert_eq!(said, format!("ada and {key} may come back\n"));
    assert!(complaint(&folder, &["unban", "ada"]).contains("there is no such ban"));
    assert_eq!(written(&folder, &["bans"]).lines().count(), 2);
}

#[test]
fn mistakes_are_explained_in_a_sentence() {
    let folder = folder();
    for (arguments, said) in [
        (&["who"][..], "no server runs with the data folder"),
        (&["rooms"], "no server runs"),
        (&["hosts"], "no server runs"),
        (&["kick", "ada"], "no server runs"),
        (&["drain"], "no server runs"),
        (&["say", "hello"], "no server runs"),
        (&["bans"], "contains no store of a host"),
        (&["mutes"], "contains no store of a host"),
        (&["mute", "ada"], "contains no store of a host"),
        (&["ban", "ada"], "contains no store of a host"),
        (&[], "admin takes one of who, rooms"),
        (&["whom"], "\"whom\" is not a command"),
        (&["say"], "say needs <TEXT>"),
        (&["kick"], "--session <ID>>; "),
        (&["kick", "ada", "--address", "::1"], " cannot be combined with "),
        (&["kick", "--session", "7"], "--session takes a session id from"),
        (&["kick", "--session", "3f9a-7"], "no server runs"),
        (&["ban"], "--address <RANGE>>; "),
        (&["mute"], "--session <ID>>; "),
        (&["unmute", "--session", "3f9a-7"], "unknown option --session"),
        (&["ban", "--session", "3f9a-7"], "unknown option --session"),
        (&["who", "--session", "3f9a-7"], "unknown option --session"),
        (&["who", "ada"], "\"ada\" is one argument too many"),
        (&["unban", "ada", "--for", "7d"], "unknown option --for"),
        (&["bans", "--reason", "x"], "unknown option --reason"),
        (&["ban", "ada", "--for", "7"], "--for takes a number with m, h, d or w"),
        (&["ban", "--key", "ada"], "--key takes a fingerprint"),
        (&["ban", "--address", "ada"], "--address takes an address, or a range"),
    ] {
        let sentence = complaint(&folder, arguments);
        assert!(sentence.contains(said), "{arguments:?}: {sentence}");
    }
    assert!(!folder.join("host.db").exists());
}

/// The response of a server's admin socket to `line`.
fn answer(folder: &Path, line: &[u8]) -> String {
    let mut stream = UnixStream::connect(folder.join("admin.sock")).unwrap();
    stream.set_read_timeout(Some(TIMEOUT)).unwrap();
    _ = stream.write_all(line);
    let mut answer = String::new();
    _ = stream.read_to_string(&mut answer);
    answer
}

#[test]
fn the_socket_is_private_and_its_requests_are_bounded() {
    let running = Running::start("", "text");
    let mode = fs::metadata(running.folder.join("admin.sock")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    for line in [b"\n".as_slice(), b"who\n", b"{\"do\":\"shell\"}\n", b"\xff\xfe\n", &[b'['; 9000]]
    {
        let answer = answer(&running.folder, line);
        assert!(answer.is_empty() || answer.contains("\"fault\":\""), "{answer}");
    }
    let who = answer(&running.folder, b"{\"do\":\"who\"}\n");
    assert!(who.contains("\"visitors\":[]") && who.contains("\"fault\":null"), "{who}");
}

#[test]
fn a_folder_is_locked_until_its_server_ends_or_is_killed() {
    let mut running = Running::start("", "text");
    let second =
        server(&["--listen", "127.0.0.1:0", "--data"]).arg(&running.folder).output().unwrap();
    let error = String::from_utf8(second.stderr).unwrap();
    assert_eq!(second.status.code(), Some(2));
    assert!(error.contains("another server already uses the data folder"), "{error}");
    running.signal(rustix::process::Signal::KILL);
    running.wait_for_end();
    assert!(running.folder.join("admin.sock").exists());
    assert!(complaint(&running.folder, &["who"]).contains("no server runs"));
    running.restart();
    assert_eq!(running.admin_says(&["who"]), "nobody is online\n");
    running.signal(rustix::process::Signal::TERM);
    assert_eq!(running.wait_for_end(), Some(0));
    assert!(!running.folder.join("admin.sock").exists());
}

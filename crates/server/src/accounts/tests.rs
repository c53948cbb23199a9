//! The behaviour of a store in each database.

#[cfg(all(unix, feature = "system-tests"))]
mod alike;
mod file;
mod known;
mod lease;
#[cfg(all(unix, feature = "system-tests"))]
mod postgres;
#[cfg(all(unix, feature = "system-tests"))]
#[path = "../../tests/support/postgres_server.rs"]
mod postgres_server;
mod presence;
mod rate;
mod waiting;

use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;
use std::{env, fs};

use proptest::prelude::*;

use super::store::Database;
use super::*;
use cellcaster::app::store::Preferences;
use cellcaster::game::{Rank, Share, Tally};
use cellcaster::world::Difficulty;

/// A folder that is removed at the end of a test.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("cellcaster-host-{}-{number}", std::process::id());
        Self(env::temp_dir().join(name))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        _ = fs::remove_dir_all(&self.0);
    }
}

/// Runs a test with each kind of store.
fn with_each(test: impl Fn(&mut HostStore)) {
    test(&mut HostStore::in_memory());
    let folder = Folder::new();
    test(&mut HostStore::open(&folder.0).unwrap());
    #[cfg(all(unix, feature = "system-tests"))]
    test(&mut on_server());
}

/// A store in the database that all tests share.
#[cfg(all(unix, feature = "system-tests"))]
fn on_server() -> HostStore {
    HostStore::connect(&postgres_server::PostgresServer::shared().address()).unwrap()
}

/// Runs a test of leases or visits with each kind of store in which a test can let time pass.
fn with_each_clock(test: impl Fn(&mut HostStore)) {
    test(&mut HostStore::in_memory());
    #[cfg(all(unix, feature = "system-tests"))]
    test(&mut on_server());
}

/// Lets time pass for a store.
fn wait(store: &mut HostStore, time: Duration) {
    match store.database {
        Database::File(_) => store.pass(time),
        _ => std::thread::sleep(time),
    }
}

const DAY: u64 = 24 * 60 * 60;

fn at(day: u64) -> UnixTime {
    UnixTime::new(1_795_300_000 + day * DAY)
}

fn key(number: u8) -> AccountKey {
    AccountKey::new([number; 32])
}

fn name(text: &str) -> Name {
    Name::new(text).unwrap()
}

fn board(level: &str) -> LevelBoard {
    LevelBoard::new(level, Difficulty::Hard).unwrap()
}

fn run(level: &str, steps: u64, rank: Rank) -> VerifiedRun {
    let tally = Tally {
        steps,
        treasure: Share { found: 2, total: 3 },
        secrets: Share { found: 0, total: 1 },
        alarms: 4,
        deaths: 5,
        stunned: 6,
        taken_back: 0,
    };
    VerifiedRun::made_up(board(level), tally, rank, &format!("{steps} steps; '\"\u{1F600}"))
}

#[test]
fn each_key_has_one_account() {
    with_each(|store| {
        assert_eq!(store.account(&key(1)).unwrap(), None);
        let ada = store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
        let bob = store.create_account(None, &key(2), &name("Bob"), at(1)).unwrap();
        assert_ne!(ada.id, bob.id);
        assert_eq!(store.account(&key(1)).unwrap(), Some(ada.clone()));
        assert_eq!(
            store.create_account(None, &key(1), &name("Eve"), at(1)),
            Err(AccountRefusal::KeyKnown)
        );
        store.note_visit(ada.id, at(3)).unwrap();
        let seen = Account { seen_at: at(3), ..ada };
        assert_eq!(store.account(&key(1)).unwrap(), Some(seen.clone()));
        assert_eq!(store.account_named(&name("aDA")).unwrap(), Some(seen));
        assert_eq!(store.account_named(&name("Eve")).unwrap(), None);
    });
}

#[test]
fn a_name_belongs_to_one_account() {
    with_each(|store| {
        store.create_account(None, &key(1), &name("Bill"), at(0)).unwrap();
        for other in ["Bill", "bILL", "BiIl", "bi11"] {
            let refused = store.create_account(None, &key(2), &name(other), at(0));
            assert_eq!(refused, Err(AccountRefusal::NameTaken), "{other}");
        }
        store.create_account(None, &key(2), &name("Will"), at(0)).unwrap();
    });
}

#[test]
fn names_can_be_changed_after_a_while_and_stay_reserved() {
    with_each(|store| {
        let ada = store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
        let next = at(7);
        let early = store.rename(ada.id, &name("Eve"), UnixTime::new(next.seconds() - 1));
        assert_eq!(early, Err(AccountRefusal::TooEarly { next }));
        let eve = store.rename(ada.id, &name("Eve"), next).unwrap();
        assert_eq!(eve, Account { name: name("Eve"), named_at: next, ..ada.clone() });
        assert_eq!(store.account(&key(1)).unwrap(), Some(eve));
        assert_eq!(store.account_named(&name("Ada")).unwrap(), None);
        // No other account can take the old name for a while, but the account itself can go back to
        // it.
        let taken = store.create_account(None, &key(2), &name("ADA"), at(36));
        assert_eq!(taken, Err(AccountRefusal::NameTaken));
        store.rename(ada.id, &name("ada"), at(14)).unwrap();
        store.rename(ada.id, &name("Eve"), at(21)).unwrap();
        assert_eq!(
            store.create_account(None, &key(2), &name("Ada"), at(50)),
            Err(AccountRefusal::NameTaken)
        );
        store.create_account(None, &key(2), &name("Ada"), at(51)).unwrap();
        let back = store.rename(ada.id, &name("Ada"), at(60));
        assert_eq!(back, Err(AccountRefusal::NameTaken));
    });
}

#[test]
fn settings_are_stored_per_account() {
    with_each(|store| {
        let ada = store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap().id;
        assert_eq!(store.settings(ada).unwrap(), AccountSettings::default());
        let preferences = Preferences {
            bell: true,
            ghost: false,
            difficulty: Difficulty::Hard,
            ..Preferences::default()
        };
        let configuration = "glyphs = \"ascii\" # '; DROP TABLE settings; --\n".to_owned();
        let ignored = vec![name("Rude"), name("アダ")];
        let settings = AccountSettings { preferences, configuration, ignored };
        store.set_settings(ada, &settings).unwrap();
        assert_eq!(store.settings(ada).unwrap(), settings);
        let configuration = "#".repeat(AccountSettings::MAX_BYTES + 1);
        let long = AccountSettings { configuration, ..AccountSettings::default() };
        assert!(store.set_settings(ada, &long).is_err());
        let ignored = vec![name("Rude"); AccountSettings::MAX_IGNORED + 1];
        let long = AccountSettings { ignored, ..AccountSettings::default() };
        assert!(store.set_settings(ada, &long).is_err());
        assert_eq!(store.settings(ada).unwrap(), settings);
    });
}

#[test]
fn a_ban_applies_until_it_ends() {
    let ban = |target, until| Ban {
        scope: BanScope::Visit,
        target,
        until,
        reason: "it's \"no\"; -- \u{1F600}".to_owned(),
        by: "O'Hara".to_owned(),
        made_at: at(0),
    };
    with_each(|store| {
        let range = || BanTarget::Addresses(AddressPrefix::parse("192.0.2.0/24").unwrap());
        let bans = [
            ban(BanTarget::Key(key(1)), None),
            ban(BanTarget::Name(name("Rude")), Some(at(2))),
            ban(range(), Some(at(1))),
        ];
        for ban in &bans {
            store.ban(ban).unwrap();
        }
        assert_eq!(store.bans(BanScope::Visit, at(0)).unwrap(), bans);
        assert_eq!(store.bans(BanScope::Visit, at(1)).unwrap(), bans[..2]);
        let rude = name("rude");
        let address = Some("::ffff:192.0.2.9".parse().unwrap());
        let visitor = Identity { address, name: Some(&rude), ..Identity::default() };
        assert_eq!(store.ban_of(&visitor, at(0)).unwrap().as_ref(), Some(&bans[1]));
        let visitor = Identity { address, key: Some(&key(1)), name: Some(&rude) };
        assert_eq!(store.ban_of(&visitor, at(0)).unwrap().as_ref(), Some(&bans[0]));
        assert_eq!(store.ban_of(&Identity::default(), at(0)).unwrap(), None);
        // Nobody can take a banned name.
        assert_eq!(
            store.create_account(None, &key(3), &rude, at(1)),
            Err(AccountRefusal::NameBanned)
        );
        store.create_account(None, &key(3), &rude, at(2)).unwrap();
        // A later ban replaces the earlier one.
        let longer = ban(range(), None);
        store.ban(&longer).unwrap();
        assert_eq!(store.bans(BanScope::Visit, at(0)).unwrap(), [&bans[..2], &[longer]].concat());
        assert!(store.unban(BanScope::Visit, &BanTarget::Name(name("RUDE"))).unwrap());
        assert!(
            store.unban(BanScope::Visit, &range()).unwrap()
                && !store.unban(BanScope::Visit, &range()).unwrap()
        );
        assert_eq!(store.bans(BanScope::Visit, at(0)).unwrap(), bans[..1]);
    });
}

#[test]
fn a_mute_is_not_a_ban_from_the_host() {
    with_each(|store| {
        let [mute, ban] = [BanScope::Talk, BanScope::Visit].map(|scope| Ban {
            scope,
            target: BanTarget::Key(key(1)),
            until: Some(at(1)),
            reason: String::new(),
            by: "root".to_owned(),
            made_at: at(0),
        });
        let visitor = Identity { key: Some(&key(1)), ..Identity::default() };
        store.ban(&mute).unwrap();
        assert_eq!(store.ban_of(&visitor, at(0)).unwrap(), None);
        store.ban(&ban).unwrap();
        assert_eq!(store.bans(BanScope::Talk, at(0)).unwrap(), std::slice::from_ref(&mute));
        assert_eq!(store.bans(BanScope::Talk, at(1)).unwrap(), []);
        assert!(store.unban(BanScope::Visit, &ban.target).unwrap());
        assert_eq!(store.bans(BanScope::Talk, at(0)).unwrap(), [mute]);
        assert!(store.unban(BanScope::Talk, &ban.target).unwrap());
        assert!(!store.unban(BanScope::Talk, &ban.target).unwrap());
    });
}

#[test]
fn boards_list_the_best_run_of_each_account() {
    with_each(|store| {
        let [ada, bob, eve] = [(1, "Ada"), (2, "Bob"), (3, "Eve")].map(|(number, text)| {
            store.create_account(None, &key(number), &name(text), at(0)).unwrap().id
        });
        let mut record = |account, level, steps, rank, day| {
            let improved = store.record(account, &run(level, steps, rank), at(day)).unwrap();
            (improved.time, improved.rank)
        };
        assert_eq!(record(ada, "cellar", 300, Rank::Thief, 1), (true, true));
        assert_eq!(record(ada, "cellar", 300, Rank::Thief, 2), (false, false));
        assert_eq!(record(ada, "cellar", 400, Rank::Ghost, 3), (false, true));
        assert_eq!(record(bob, "cellar", 250, Rank::Burglar, 4), (true, true));
        assert_eq!(record(ada, "cellar", 250, Rank::Burglar, 5), (true, false));
        assert_eq!(record(eve, "cellar", 999, Rank::Shadow, 6), (true, true));
        assert_eq!(record(eve, "museum", 10, Rank::Shadow, 6), (true, true));
        let scores = store.level_scores(&board("cellar"), 9).unwrap();
        let shown = scores
            .iter()
            .map(|score| (score.name.as_str(), score.tally.steps, score.rank, score.verified_at));
        assert_eq!(
            shown.collect::<Vec<_>>(),
            [
                ("Bob", 250, Rank::Burglar, at(4)),
                ("Ada", 250, Rank::Ghost, at(5)),
                ("Eve", 999, Rank::Shadow, at(6)),
            ]
        );
        assert_eq!(scores[0].tally, run("cellar", 250, Rank::Burglar).tally());
        assert_eq!(store.level_scores(&board("cellar"), 1).unwrap(), scores[..1]);
        assert_eq!(store.level_scores(&board("prison"), 9).unwrap(), []);
        assert_eq!(store.level_boards().unwrap(), [board("cellar"), board("museum")]);
        let bests = store.bests(eve).unwrap();
        let bests: Vec<_> =
            bests.iter().map(|(board, best)| (board.clone(), best.tally.steps)).collect();
        assert_eq!(bests, [(board("cellar"), 999), (board("museum"), 10)]);
        let script = store.script(ada, &board("cellar")).unwrap();
        assert_eq!(script.as_deref(), Some(run("cellar", 250, Rank::Thief).script()));
        assert_eq!(store.script(bob, &board("museum")).unwrap(), None);
    });
}

#[test]
fn boards_of_daily_levels_are_kept_for_a_week() {
    with_each_clock(|store| {
        let now = match store.database {
            Database::File(_) => UnixTime::new(1_000_000_000),
            _ => UnixTime::now(),
        };
        let ada = store.create_account(None, &key(1), &name("Ada"), now).unwrap().id;
        let daily = |days| LevelBoard::new(&Day::of(now).before(days).level(), Difficulty::Normal);
        for days in 0..=8 {
            let run = run("cellar", 100, Rank::Thief);
            let run = VerifiedRun::made_up(daily(days).unwrap(), run.tally(), run.rank(), "x");
            store.record(ada, &run, now).unwrap();
        }
        store.record(ada, &run("daily-0123456789abcdef", 100, Rank::Thief), now).unwrap();
        assert_eq!(store.forget_dailies().unwrap(), 2);
        assert_eq!(store.forget_dailies().unwrap(), 0);
        let kept = (0..=6).rev().filter_map(daily);
        let kept = [board("daily-0123456789abcdef")].into_iter().chain(kept);
        assert_eq!(store.level_boards().unwrap(), kept.collect::<Vec<_>>());
    });
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn account_names_never_look_alike(texts in prop::collection::vec(
        "[a-cA-CIl1iOo0аАсС]{2,4}", 2..60
    )) {
        let mut store = HostStore::in_memory();
        let mut accepted: Vec<Name> = Vec::new();
        for (number, text) in (1_u8..).zip(&texts) {
            let Ok(name) = Name::new(text) else { continue };
            if store.create_account(None, &key(number), &name, at(0)).is_ok() {
                let skeleton = |name: &Name| -> String {
                    unicode_security::skeleton(name.as_str()).collect()
                };
                prop_assert!(accepted.iter().all(|other| skeleton(other) != skeleton(&name)));
                accepted.push(name);
            }
        }
    }
}

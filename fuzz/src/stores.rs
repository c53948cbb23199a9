//! The stores of a host, side by side: both answer alike, whatever is asked of them.

use std::cell::RefCell;
use std::fmt::Debug;

use cellcaster::game::{Rank, Rules, Share, Tally};
use cellcaster_server::accounts::{
    AccountId, AccountKey, AccountSettings, AddressPrefix, Ban, BanTarget, DailyTry, Day,
    HostStore, LevelBoard, MemoryStore, Name, SqliteStore, UnixTime, VerifiedDescent,
    VerifiedLevel,
};
use cellcaster::app::store::{Preferences, Reached};
use cellcaster::world::Difficulty;

use crate::bytes::Bytes;

const NAMES: [&str; 9] =
    ["Ada", "ADA", "Bill", "BiIl", "Eve", "\u{421}\u{421}\u{421}\u{420}", "cccp", "rn", "m1ll"];
const LEVELS: [&str; 3] = ["cellar", "museum", "observatory"];
const TEXTS: [&str; 5] = ["", "'; drop table account; --", "\0", "\u{1F600}", "fps = 60\n"];
const DAY: u64 = 24 * 60 * 60;
const MOST_CALLS: usize = 60;

thread_local! {
    // Its tables are made once: that takes longer than most inputs.
    static FILE: RefCell<SqliteStore> = RefCell::new(SqliteStore::in_memory());
}

/// Asks both stores the same.
pub fn run(data: &[u8]) {
    let mut choices = Bytes::new(data);
    let choices = &mut choices;
    FILE.with_borrow_mut(|file| {
        file.clear();
        compare(file, &mut MemoryStore::default(), choices);
    });
}

fn compare(file: &mut dyn HostStore, memory: &mut dyn HostStore, choices: &mut Bytes) {
    let mut file = Asked { store: file, tries: Vec::new() };
    let mut memory = Asked { store: memory, tries: Vec::new() };
    let mut accounts: Vec<AccountId> = Vec::new();
    let mut now = UnixTime::new(1_795_300_000);
    for _ in 0..MOST_CALLS {
        if choices.is_empty() {
            break;
        }
        now = now.after(choices.pick(&[0, 0, 1, 8, 31, 365]) * DAY);
        let call = Call::new(choices, &accounts);
        assert_eq!(file.answer(&call, now), memory.answer(&call, now), "{call:?}");
        if let Call::Create(key, _) = &call
            && let Ok(Some(account)) = file.store.account(key)
            && !accounts.contains(&account.id)
        {
            accounts.push(account.id);
        }
    }
    let [file, memory] = [file, memory].map(|asked| shown(asked.store, &accounts, now));
    assert_eq!(file, memory);
}

/// A store, and the daily runs that it has begun.
struct Asked<'a> {
    store: &'a mut dyn HostStore,
    tries: Vec<DailyTry>,
}

/// Something that is asked of a store.
#[derive(Debug)]
enum Call {
    Create(AccountKey, Name),
    Rename(AccountId, Name),
    Visit(AccountId),
    Set(AccountId, AccountSettings),
    Ban(BanTarget, Option<u64>, String),
    Unban(BanTarget),
    Record(AccountId, VerifiedLevel),
    BeginDaily(AccountId, Day),
    /// For the run that was begun as that one.
    RecordDaily(usize, VerifiedDescent),
}

impl Call {
    fn new(choices: &mut Bytes, accounts: &[AccountId]) -> Self {
        let key = AccountKey::new([choices.byte() % 8; 32]);
        let name = any_name(choices);
        let what = choices.below(12);
        let Some(&account) = accounts.get(choices.below(accounts.len().max(1))) else {
            return Self::Create(key, name);
        };
        match what {
            0..2 => Self::Create(key, name),
            2 => Self::Rename(account, name),
            3 => Self::Visit(account),
            4 => {
                let preferences = Preferences { bell: choices.flag(), ..Preferences::default() };
                let mut configuration = choices.pick(&TEXTS).to_owned();
                if choices.below(16) == 1 {
                    configuration = "#".repeat(AccountSettings::MOST_BYTES + choices.below(2));
                }
                Self::Set(account, AccountSettings { preferences, configuration })
            }
            5 => {
                let days = choices.flag().then(|| choices.byte().into());
                Self::Ban(target(choices, key, name), days, choices.pick(&TEXTS).to_owned())
            }
            6 => Self::Unban(target(choices, key, name)),
            7..9 => Self::Record(account, run_of(choices)),
            9..11 => Self::BeginDaily(account, day(choices)),
            _ => {
                let day = day(choices);
                let rules = Rules { difficulty: Difficulty::Normal, seed: day.number().into() };
                let reached = Reached {
                    floors: choices.below(5) as u32,
                    treasure: choices.double_word(),
                    steps: choices.double_word().into(),
                };
                Self::RecordDaily(
                    choices.byte().into(),
                    VerifiedDescent::made_up(rules, reached, "4 s forward\n"),
                )
            }
        }
    }
}

impl Asked<'_> {
    /// The answer to a call. What the store says about a failure is its own.
    fn answer(&mut self, call: &Call, now: UnixTime) -> String {
        fn text<T: Debug, E>(answer: Result<T, E>) -> String {
            answer.map_or("failure".to_owned(), |answer| format!("{answer:?}"))
        }
        let Self { store, tries } = self;
        match call {
            Call::Create(key, name) => format!("{:?}", store.create_account(key, name, now)),
            Call::Rename(account, name) => format!("{:?}", store.rename(*account, name, now)),
            Call::Visit(account) => text(store.note_visit(*account, now)),
            Call::Set(account, settings) => text(store.set_settings(*account, settings)),
            Call::Ban(target, days, reason) => {
                let until = days.map(|days| now.after(days * DAY));
                let (reason, by) = (reason.clone(), reason.clone());
                text(store.ban(&Ban { target: target.clone(), until, reason, by, made_at: now }))
            }
            Call::Unban(target) => text(store.unban(target)),
            Call::Record(account, run) => text(store.record(*account, run, now)),
            Call::BeginDaily(account, day) => {
                let begun = store.begin_daily(*account, *day, now);
                let answer = format!("{:?}", begun.as_ref().ok());
                tries.extend(begun.ok().flatten());
                answer
            }
            Call::RecordDaily(index, run) if !tries.is_empty() => {
                text(store.record_daily(&tries[index % tries.len()], run, now))
            }
            Call::RecordDaily(..) => String::new(),
        }
    }
}

/// Everything that a store shows.
fn shown(store: &mut dyn HostStore, accounts: &[AccountId], now: UnixTime) -> Vec<String> {
    let mut shown = vec![format!("{:?}", store.bans(now)), format!("{:?}", store.level_boards())];
    for &account in accounts {
        shown.push(format!("{:?} {:?}", store.settings(account), store.bests(account)));
        let scripts = LEVELS.map(|level| format!("{:?}", store.script(account, &board(level))));
        shown.extend(scripts);
    }
    let names = NAMES.iter().filter_map(|text| Name::new(text).ok());
    shown.extend(names.map(|name| format!("{:?}", store.account_named(&name))));
    shown.extend(LEVELS.map(|level| format!("{:?}", store.level_scores(&board(level), 3))));
    shown
}

fn board(level: &str) -> LevelBoard {
    LevelBoard::new(level, Difficulty::Hard).expect("it is built in")
}

fn any_name(choices: &mut Bytes) -> Name {
    let written: String = (0..2 + choices.below(3))
        .map(|_| choices.pick(&['a', 'A', 'l', 'I', '1', 'o', '0', '\u{430}', 'é']))
        .collect();
    let known = choices.pick(&NAMES);
    let text = if choices.below(4) == 0 { &written } else { known };
    Name::new(text).or_else(|_| Name::new("Ada")).expect("Ada is a name")
}

fn target(choices: &mut Bytes, key: AccountKey, name: Name) -> BanTarget {
    match choices.below(3) {
        0 => BanTarget::Name(name),
        1 => BanTarget::Key(key),
        _ => {
            let address = [choices.byte() & 3, 0, 0, choices.byte() & 3].into();
            BanTarget::Addresses(
                AddressPrefix::new(address, choices.byte() % 33).expect("32 at most"),
            )
        }
    }
}

fn run_of(choices: &mut Bytes) -> VerifiedLevel {
    let tally = Tally {
        steps: choices.below(5) as u64 + 1,
        treasure: Share { found: choices.below(3) as u32, total: 3 },
        secrets: Share { found: 0, total: 1 },
        alarms: choices.double_word(),
        deaths: 5,
        stunned: 6,
    };
    let rank = choices.pick(&Rank::ALL);
    VerifiedLevel::made_up(board(choices.pick(&LEVELS)), tally, rank, choices.pick(&TEXTS))
}

fn day(choices: &mut Bytes) -> Day {
    Day::from_number(choices.pick(&[20_261_122, 20_261_123, 20_270_228])).expect("a day")
}

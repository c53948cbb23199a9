//! Rows of a host's store, as another program or a damaged disk may have left them.
//!
//! The input consists of rows: a byte for the table, and for each column a byte for the kind of its
//! value. The store is read and changed with these rows in every way. Each operation succeeds, or
//! fails with a sentence.

use std::cell::RefCell;

use cellcaster::game::{Rank, Share, Tally};
use cellcaster::world::Difficulty;
use cellcaster_server::accounts::{
    AccountKey, AccountSettings, BanScope, BanTarget, ColumnValue, HostStore, LevelBoard, Name,
    UnixTime, VerifiedRun,
};

use crate::bytes::Bytes;

const MAX_ROWS: usize = 24;
/// The largest number of columns in a table.
const COLUMNS: usize = 14;
const WORDS: [&str; 16] = [
    "",
    "Ada",
    "ada",
    "cellar",
    "museum",
    "normal",
    "hard",
    "gold",
    "visit",
    "name",
    "key",
    "addresses",
    "10.0.0.0/8",
    "talk",
    "true",
    "fps = 60\n",
];
const NUMBERS: [i64; 12] = [
    0,
    1,
    -1,
    2,
    60,
    20_261_122,
    1_795_300_000,
    u32::MAX as i64,
    1 << 53,
    i64::MAX,
    i64::MIN,
    20_261_399,
];

thread_local! {
    static STORE: RefCell<HostStore> = RefCell::new(HostStore::in_memory());
}

/// Puts the rows into a store, and uses all of its operations.
pub fn run(data: &[u8]) {
    let mut choices = Bytes::new(data);
    STORE.with_borrow_mut(|store| {
        store.clear();
        for _ in 0..MAX_ROWS {
            if choices.is_empty() {
                break;
            }
            let table = choices.byte().into();
            let row: Vec<ColumnValue> = (0..COLUMNS).map_while(|_| value(&mut choices)).collect();
            store.put(table, &row);
        }
        use_all(store);
    });
}

/// The next value of a row; `None` at its end.
fn value(choices: &mut Bytes) -> Option<ColumnValue> {
    Some(match choices.below(8) {
        0 => return None,
        1 => ColumnValue::Null,
        2 => ColumnValue::Integer(choices.byte().into()),
        3 => ColumnValue::Integer(choices.pick(&NUMBERS)),
        4 => ColumnValue::Text(choices.pick(&WORDS).to_owned()),
        5 => {
            let length = choices.below(40);
            ColumnValue::Text(String::from_utf8_lossy(choices.take(length)).into_owned())
        }
        6 => ColumnValue::Blob(vec![choices.byte() % 4; 32]),
        _ => {
            let length = choices.below(40);
            ColumnValue::Blob(choices.take(length).to_owned())
        }
    })
}

fn use_all(store: &mut HostStore) {
    let now = UnixTime::new(1_795_300_000);
    let name = Name::new("Ada").expect("it is a name");
    let board = LevelBoard::new("cellar", Difficulty::Normal).expect("it is built in");
    let share = Share { found: 1, total: 2 };
    let tally = Tally {
        steps: 7,
        treasure: share,
        secrets: share,
        alarms: 1,
        deaths: 2,
        stunned: 3,
        taken_back: 0,
    };
    let run = VerifiedRun::made_up(board.clone(), tally, Rank::ALL[0], "4 s forward\n");
    check(store.bans(BanScope::Visit, now));
    check(store.bans(BanScope::Talk, now));
    check(store.level_boards());
    check(store.level_scores(&board, 10));
    check(store.account_named(&name));
    for byte in 0..2 {
        let key = AccountKey::new([byte; 32]);
        _ = store.create_account(None, &key, &name, now);
        let Ok(Some(account)) = store.account(&key) else { continue };
        let account = account.id;
        check(store.settings(account));
        check(store.bests(account));
        check(store.script(account, &board));
        check(store.record(account, &run, now));
        check(store.set_settings(account, &AccountSettings::default()));
        check(store.note_visit(account, now));
        _ = store.rename(account, &name, now);
    }
    check(store.unban(BanScope::Visit, &BanTarget::Name(name)));
}

/// Checks that a failure has a sentence.
fn check<T>(answer: Result<T, impl std::fmt::Display>) {
    if let Err(failure) = answer {
        assert!(!failure.to_string().is_empty());
    }
}

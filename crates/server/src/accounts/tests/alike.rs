//! Both databases give the same answers to all calls.

use std::fmt::Write;

use proptest::prelude::*;

use super::*;

/// A call to a store.
#[derive(Clone, Debug)]
enum Call {
    Create(u8, usize),
    /// From one of two networks. Each may create one account at once, and one in an hour.
    CreateFrom(u8, u8, usize),
    Rename(i64, usize),
    Visit(i64),
    Set(i64, bool, String),
    Ban(usize, Option<u64>, String),
    Unban(usize),
    Record(i64, usize, u64, usize),
}

const NAMES: [&str; 7] = ["Ada", "ADA", "Bill", "BiIl", "Eve", "СССР", "cccp"];
const LEVELS: [&str; 3] = ["cellar", "museum", "observatory"];

fn target(index: usize) -> BanTarget {
    match index {
        0..7 => BanTarget::Name(name(NAMES[index])),
        7 | 8 => BanTarget::Key(key(index as u8 - 6)),
        _ => BanTarget::Addresses(AddressPrefix::parse("2001:db8::/32").unwrap()),
    }
}

fn scope(index: usize) -> BanScope {
    if index.is_multiple_of(3) { BanScope::Talk } else { BanScope::Visit }
}

/// A text as stores receive it, without U+0000.
fn text() -> impl Strategy<Value = String> {
    any::<String>().prop_map(|text| text.replace('\0', ""))
}

/// Calls, each with the days that pass before it.
fn calls() -> impl Strategy<Value = Vec<(u64, Call)>> {
    let account = || 1..4_i64;
    let call = prop_oneof![
        4 => (1..4_u8, 0..NAMES.len()).prop_map(|(key, name)| Call::Create(key, name)),
        4 => (0..2_u8, 1..4_u8, 0..NAMES.len())
            .prop_map(|(network, key, name)| Call::CreateFrom(network, key, name)),
        3 => (account(), 0..NAMES.len()).prop_map(|(id, name)| Call::Rename(id, name)),
        1 => account().prop_map(Call::Visit),
        1 => (account(), any::<bool>(), text())
            .prop_map(|(id, bell, text)| Call::Set(id, bell, text)),
        1 => (0..10_usize, prop::option::of(0..20_u64), text())
            .prop_map(|(target, days, reason)| Call::Ban(target, days, reason)),
        1 => (0..10_usize).prop_map(Call::Unban),
        4 => (account(), 0..LEVELS.len(), 1..5_u64, 0..4_usize)
            .prop_map(|(id, level, steps, rank)| Call::Record(id, level, steps, rank)),
    ];
    prop::collection::vec((prop_oneof![Just(0), Just(8), Just(31)], call), 1..40)
}

/// The answer of a store. The sentence of a failure is left out, because it differs between stores.
fn answer(store: &mut HostStore, call: &Call, now: UnixTime) -> String {
    let of_failure = |_: StoreFailure| "failure";
    match call {
        Call::Create(number, text) => {
            format!("{:?}", store.create_account(None, &key(*number), &name(NAMES[*text]), now))
        }
        Call::CreateFrom(network, number, text) => {
            let rate = AccountRate { per_hour: 1, at_once: 1 };
            let origin = Origin::new([192, 0, *network, 7].into(), rate);
            let (key, name) = (key(*number), name(NAMES[*text]));
            format!("{:?}", store.create_account(Some(&origin), &key, &name, now))
        }
        Call::Rename(id, text) => {
            format!("{:?}", store.rename(AccountId(*id), &name(NAMES[*text]), now))
        }
        Call::Visit(id) => format!("{:?}", store.note_visit(AccountId(*id), now)),
        Call::Set(id, bell, text) => {
            let preferences = Preferences { bell: *bell, ..Preferences::default() };
            let settings = AccountSettings {
                preferences,
                configuration: text.clone(),
                ignored: vec![name(NAMES[*id as usize % NAMES.len()])],
            };
            format!("{:?}", store.set_settings(AccountId(*id), &settings).map_err(of_failure))
        }
        Call::Ban(index, days, reason) => {
            let until = days.map(|days| now.after(days * DAY));
            let (reason, by) = (reason.clone(), reason.clone());
            let scope = scope(*index);
            let ban = Ban { scope, target: target(*index), until, reason, by, made_at: now };
            format!("{:?}", store.ban(&ban))
        }
        Call::Unban(index) => format!("{:?}", store.unban(scope(*index), &target(*index))),
        Call::Record(id, level, steps, rank) => {
            let run = run(LEVELS[*level], *steps, Rank::ALL[*rank]);
            format!("{:?}", store.record(AccountId(*id), &run, now).map_err(of_failure))
        }
    }
}

/// The whole visible content of a store.
fn shown(store: &mut HostStore, now: UnixTime) -> String {
    let mut shown = format!("{:?}", store.level_boards());
    for scope in [BanScope::Visit, BanScope::Talk] {
        _ = write!(shown, "{:?}", store.bans(scope, now));
    }
    for number in 1..4 {
        let id = AccountId(number.into());
        let (account, settings) = (store.account(&key(number)), store.settings(id));
        _ = write!(shown, "{account:?} {settings:?} {:?}", store.bests(id));
        shown += &LEVELS.map(|level| format!("{:?}", store.script(id, &board(level)))).concat();
    }
    shown += &NAMES.map(|text| format!("{:?}", store.account_named(&name(text)))).concat();
    shown + &LEVELS.map(|level| format!("{:?}", store.level_scores(&board(level), 2))).concat()
}

proptest! {
    // Each case has tables of its own.
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn a_server_answers_like_a_file(calls in calls()) {
        let (mut server, mut file, mut day) = (on_server(), HostStore::in_memory(), 0);
        for (days, call) in calls {
            day += days;
            let answers = [&mut server, &mut file].map(|store| answer(store, &call, at(day)));
            prop_assert_eq!(&answers[0], &answers[1], "{:?}", call);
        }
        prop_assert_eq!(shown(&mut server, at(day)), shown(&mut file, at(day)));
    }
}

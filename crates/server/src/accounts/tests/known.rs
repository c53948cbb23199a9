//! Players and bans that a host remembers.

use super::*;
use crate::accounts::known::KnownPlayers;

const DATABASE: &str = "the database \"games\" at db";

fn account(number: i64) -> Account {
    let id = AccountId(number);
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&number.to_le_bytes());
    let key = AccountKey::new(bytes);
    let name = name(&format!("Mara{number}"));
    Account { id, key, name, named_at: second(0), created_at: second(0), seen_at: second(0) }
}

fn second(number: u64) -> UnixTime {
    UnixTime::new(1_795_300_000 + number)
}

fn settings(configuration: &str) -> AccountSettings {
    AccountSettings { configuration: configuration.to_owned(), ..AccountSettings::default() }
}

fn ban(target: BanTarget, until: Option<UnixTime>) -> Ban {
    Ban {
        scope: BanScope::Visit,
        target,
        until,
        reason: "insults".to_owned(),
        by: "op".to_owned(),
        made_at: second(0),
    }
}

#[test]
fn players_and_bans_are_remembered_after_a_restart() {
    let folder = Folder::new();
    fs::create_dir_all(&folder.0).unwrap();
    let (mut known, sentence) = KnownPlayers::open(&folder.0, DATABASE);
    assert_eq!(sentence, None);
    let (mara, jon) = (account(1), account(2));
    known.note(&mara, &settings("glyphs = \"ascii\""), second(5));
    known.note(&jon, &settings(""), second(5));
    known.note_settings(&jon.key, &settings("mouse = false"));
    let bans =
        [ban(BanTarget::Key(jon.key), None), ban(BanTarget::Name(name("Rude")), Some(second(9)))];
    known.note_bans(&bans);
    known.save().unwrap();
    let (known, sentence) = KnownPlayers::open(&folder.0, DATABASE);
    assert_eq!(sentence, None);
    let (player, in_force) = known.find(&mara.key, second(6)).unwrap();
    assert_eq!((player.account, player.settings), (mara, settings("glyphs = \"ascii\"")));
    assert_eq!(in_force, bans);
    let (player, in_force) = known.find(&jon.key, second(9)).unwrap();
    assert_eq!((player.settings, in_force.as_slice()), (settings("mouse = false"), &bans[..1]));
    assert_eq!(known.find(&account(3).key, second(6)), None);
    let (other, _) = KnownPlayers::open(&folder.0, "the database \"games\" at other");
    assert_eq!(other.find(&player.account.key, second(6)), None);
}

#[test]
fn a_player_is_forgotten_when_the_name_may_belong_to_another() {
    let (mut known, _) = KnownPlayers::open(&Folder::new().0, DATABASE);
    let mara = account(1);
    known.note(&mara, &settings(""), second(5));
    assert!(known.find(&mara.key, second(5).after(NAME_HELD - 1)).is_some());
    assert!(known.find(&mara.key, second(5).after(NAME_HELD)).is_none());
    known.note(&mara, &settings(""), second(6));
    known.forget(&mara.key);
    assert!(known.find(&mara.key, second(6)).is_none());
}

#[test]
fn the_file_is_bounded_and_the_longest_unseen_players_are_forgotten() {
    let folder = Folder::new();
    fs::create_dir_all(&folder.0).unwrap();
    let (mut known, _) = KnownPlayers::open(&folder.0, DATABASE);
    let long = "#".repeat(AccountSettings::MAX_BYTES);
    for number in 1..=2100 {
        known.note(&account(number), &settings(""), second(number as u64));
    }
    assert!(known.find(&account(100).key, second(2100)).is_none());
    assert!(known.find(&account(101).key, second(2100)).is_some());
    for number in 1..=300 {
        known.note(&account(number), &settings(&long), second(3000 + number as u64));
    }
    known.save().unwrap();
    assert!(known.find(&account(300).key, second(3300)).is_some());
    assert!(known.find(&account(1).key, second(3300)).is_none());
    let bytes = fs::metadata(folder.0.join("known_players")).unwrap().len();
    assert!((3 << 20..=4 << 20).contains(&bytes), "{bytes}");
    // Bans are never dropped for players.
    let bans: Vec<Ban> = (0..40_000).map(|_| ban(BanTarget::Name(name("Rude")), None)).collect();
    known.note_bans(&bans);
    known.save().unwrap();
    assert!(known.find(&account(300).key, second(3300)).is_none());
}

#[test]
fn a_damaged_file_is_reported_and_replaced() {
    let folder = Folder::new();
    fs::create_dir_all(&folder.0).unwrap();
    fs::write(folder.0.join("known_players"), "{\"database\":").unwrap();
    let (mut known, sentence) = KnownPlayers::open(&folder.0, DATABASE);
    let sentence = sentence.unwrap();
    assert!(sentence.contains("known_players is damaged"), "{sentence}");
    known.note(&account(1), &settings(""), second(5));
    known.save().unwrap();
    assert_eq!(KnownPlayers::open(&folder.0, DATABASE).1, None);
}

proptest! {
    #[test]
    fn no_file_panics(player in "[ -~]{0,40}", number: u64, bytes: Vec<u8>) {
        let folder = Folder::new();
        fs::create_dir_all(&folder.0).unwrap();
        let key = AccountKey::new([1; 32]);
        let entry = serde_json::json!({
            "account": {
                "id": 7, "key": key, "name": player, "named_at": number, "created_at": 0, "seen_at": 0,
            },
            "settings": { "preferences": {}, "configuration": player, "ignored": [player] },
            "confirmed_at": number,
        });
        let bans = [serde_json::json!({
            "scope": "Visit", "target": { "name": player }, "until": number, "reason": "", "by": "",
            "made_at": 0,
        })];
        let players = serde_json::json!({ key.to_string(): entry });
        let content = serde_json::json!({ "database": DATABASE, "bans": bans, "players": players });
        for (content, is_known) in [(content.to_string().into_bytes(), true), (bytes, false)] {
            fs::write(folder.0.join("known_players"), content).unwrap();
            let found = KnownPlayers::open(&folder.0, DATABASE).0.find(&key, second(0));
            prop_assert!(found.is_none() || is_known);
        }
    }
}

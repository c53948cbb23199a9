//! The players that a host remembers, so that they can play while its database is away, in the file
//! `known_players` of the host's data folder.
//!
//! Rules:
//!
//! - **The database is asked first.** The host falls back on this memory only if the database does not answer.
//! - **A name stays unique.** A player is forgotten [`NAME_HELD`] after the database last confirmed the name. A name
//!   that was changed on another host stays reserved for the account for that long.
//! - **Bans stay in force.** The memory contains all bans of the last answer. If they do not fit into the file, it
//!   contains no players.
//! - **The number of an account serves only to mark the player's own results.** Changes look the account up by its
//!   key, because the database may have been replaced.
//! - **Memory and file are bounded.** The player who was confirmed the longest ago makes room. The file is replaced
//!   atomically. If it cannot be read, or belongs to another database, the memory starts empty.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use cellcaster::app::store::Preferences;
use cellcaster::app::store::private;
use serde::{Deserialize, Serialize};

use super::waiting::{failure, replace};
use super::{
    Account, AccountId, AccountKey, AccountSettings, Ban, BanScope, BanTarget, NAME_HELD, Name,
    StoreFailure, UnixTime,
};

/// The most players that are remembered.
const MAX_PLAYERS: usize = 2000;
/// The most bytes of the file. A player takes about 500, with many settings of their own 17,000.
const MAX_BYTES: usize = 4 << 20;

/// The remembered players, and the bans.
#[derive(Debug)]
pub struct KnownPlayers {
    file: PathBuf,
    /// The name of the database, without a password.
    database: String,
    bans: Vec<Ban>,
    players: BTreeMap<AccountKey, KnownPlayer>,
    /// The bytes of the players and the bans in the file. Counting all of them at each login took longer the more
    /// players were known.
    bytes: usize,
    is_saved: bool,
}

/// A player, as the database described them at a login.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct KnownPlayer {
    pub(crate) account: Account,
    pub(crate) settings: AccountSettings,
    /// When the database confirmed the name.
    confirmed_at: UnixTime,
}

#[derive(Serialize, Deserialize)]
struct FileContent {
    database: String,
    bans: Vec<BanEntry>,
    players: Vec<PlayerEntry>,
}

#[derive(Serialize, Deserialize)]
struct BanEntry {
    kind: String,
    target: String,
    until: Option<u64>,
    reason: String,
    by: String,
    made_at: u64,
}

#[derive(Serialize, Deserialize)]
struct PlayerEntry {
    key: String,
    account: i64,
    name: String,
    named_at: u64,
    created_at: u64,
    seen_at: u64,
    preferences: Preferences,
    configuration: String,
    ignored: Vec<String>,
    confirmed_at: u64,
}

impl KnownPlayers {
    /// Reads the players of `database` that are remembered in a folder. Also returns a sentence if the file cannot be
    /// read.
    pub fn open(folder: &Path, database: &str) -> (Self, Option<String>) {
        let file = folder.join("known_players");
        let mut bytes = Vec::new();
        let content = match private::open(&file) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(failure(&file, &error).to_string()),
            Ok(found) => match found.take(2 * MAX_BYTES as u64).read_to_end(&mut bytes) {
                Err(error) => Err(failure(&file, &error).to_string()),
                Ok(_) => serde_json::from_slice::<FileContent>(&bytes)
                    .map(Some)
                    .map_err(|error| format!("{} is damaged: {error}", file.display())),
            },
        };
        let (content, sentence) = match content {
            Ok(content) => (content, None),
            Err(fault) => {
                let sentence = format!("{fault}; players are remembered again as they log in");
                (None, Some(sentence))
            }
        };
        let database = database.to_owned();
        let content = content.filter(|content| content.database == database);
        let (bans, players) = content.map_or_else(Default::default, |it| (it.bans, it.players));
        let bans: Vec<Ban> = bans.into_iter().filter_map(BanEntry::ban).collect();
        let bytes = bytes_of(&bans);
        let mut known =
            Self { file, database, bans, players: BTreeMap::new(), bytes, is_saved: true };
        players.into_iter().filter_map(PlayerEntry::player).for_each(|player| known.add(player));
        known.make_room();
        (known, sentence)
    }

    /// Remembers an account that the database has just confirmed.
    pub(crate) fn note(&mut self, account: &Account, settings: &AccountSettings, now: UnixTime) {
        let (account, settings) = (account.clone(), settings.clone());
        self.insert(KnownPlayer { account, settings, confirmed_at: now });
    }

    /// Remembers the name of an account that the database has just changed. The settings stay.
    pub(crate) fn note_name(&mut self, account: &Account, now: UnixTime) {
        let known = self.players.get(&account.key);
        let settings = known.map(|player| player.settings.clone()).unwrap_or_default();
        self.note(account, &settings, now);
    }

    /// Remembers settings that the database has just stored.
    pub(crate) fn note_settings(&mut self, key: &AccountKey, settings: &AccountSettings) {
        if let Some(player) = self.players.get(key) {
            self.insert(KnownPlayer { settings: settings.clone(), ..player.clone() });
        }
    }

    /// Forgets a key for which the database has just found no account.
    pub(crate) fn forget(&mut self, key: &AccountKey) {
        self.is_saved &= !self.remove(key);
    }

    /// Remembers all bans of the database.
    pub(crate) fn note_bans(&mut self, bans: &[Ban]) {
        if self.bans != bans {
            self.bytes = self.bytes - bytes_of(&self.bans) + bytes_of(bans);
            self.bans = bans.to_vec();
            self.is_saved = false;
            self.make_room();
        }
    }

    /// The player with a key, if the name is still reserved for them, and the bans in force.
    pub(crate) fn find(&self, key: &AccountKey, now: UnixTime) -> Option<(KnownPlayer, Vec<Ban>)> {
        let player = self.players.get(key)?;
        if player.confirmed_at.after(NAME_HELD) <= now {
            return None;
        }
        let bans = self.bans.iter().filter(|ban| ban.is_in_force(now)).cloned();
        Some((player.clone(), bans.collect()))
    }

    /// Updates the file.
    ///
    /// # Errors
    /// If it can't be written. The memory stays.
    pub fn save(&mut self) -> Result<(), StoreFailure> {
        if !self.is_saved {
            let content = FileContent {
                database: self.database.clone(),
                bans: self.bans.iter().map(BanEntry::of).collect(),
                players: self.players.values().map(PlayerEntry::of).collect(),
            };
            // Texts and numbers always have a form in JSON.
            let content = serde_json::to_vec(&content).unwrap_or_default();
            replace(&self.file, &content).map_err(|error| failure(&self.file, &error))?;
            self.is_saved = true;
        }
        Ok(())
    }

    fn insert(&mut self, player: KnownPlayer) {
        self.add(player);
        self.is_saved = false;
        self.make_room();
    }

    fn add(&mut self, player: KnownPlayer) {
        self.remove(&player.account.key);
        self.bytes += player.bytes();
        self.players.insert(player.account.key, player);
    }

    /// Returns true if the player was known.
    fn remove(&mut self, key: &AccountKey) -> bool {
        let removed = self.players.remove(key);
        self.bytes -= removed.as_ref().map_or(0, KnownPlayer::bytes);
        removed.is_some()
    }

    /// Forgets players until the rest fits beside the bans.
    fn make_room(&mut self) {
        while self.players.len() > MAX_PLAYERS || self.bytes > MAX_BYTES {
            let oldest = self.players.values().min_by_key(|player| player.confirmed_at);
            let Some(oldest) = oldest.map(|player| player.account.key) else { return };
            self.remove(&oldest);
        }
    }
}

/// The bytes of an entry in the file without its texts.
const ENTRY_BYTES: usize = 400;

fn bytes_of(bans: &[Ban]) -> usize {
    bans.iter().map(|ban| ENTRY_BYTES + ban.reason.len() + ban.by.len()).sum()
}

impl KnownPlayer {
    fn bytes(&self) -> usize {
        let preferences = serde_json::to_string(&self.settings.preferences);
        let preferences = preferences.map_or(0, |text| text.len());
        let ignored: usize = self.settings.ignored.iter().map(|name| name.as_str().len()).sum();
        ENTRY_BYTES + preferences + self.settings.configuration.len() + ignored
    }
}

impl PlayerEntry {
    fn of(player: &KnownPlayer) -> Self {
        let KnownPlayer { account, settings, confirmed_at } = player;
        Self {
            key: account.key.to_string(),
            account: account.id.0,
            name: account.name.as_str().to_owned(),
            named_at: account.named_at.seconds(),
            created_at: account.created_at.seconds(),
            seen_at: account.seen_at.seconds(),
            preferences: settings.preferences,
            configuration: settings.configuration.clone(),
            ignored: settings.ignored.iter().map(|name| name.as_str().to_owned()).collect(),
            confirmed_at: confirmed_at.seconds(),
        }
    }

    fn player(self) -> Option<KnownPlayer> {
        let account = Account {
            id: AccountId(self.account),
            key: AccountKey::parse(&self.key)?,
            name: Name::kept(&self.name),
            named_at: UnixTime::new(self.named_at),
            created_at: UnixTime::new(self.created_at),
            seen_at: UnixTime::new(self.seen_at),
        };
        let settings = AccountSettings {
            preferences: self.preferences,
            configuration: self.configuration,
            ignored: self.ignored.iter().map(|name| Name::kept(name)).collect(),
        };
        settings.checked().ok()?;
        let confirmed_at = UnixTime::new(self.confirmed_at);
        Some(KnownPlayer { account, settings, confirmed_at })
    }
}

impl BanEntry {
    fn of(ban: &Ban) -> Self {
        let (kind, target) = ban.target.parts();
        Self {
            kind: kind.to_owned(),
            target,
            until: ban.until.map(UnixTime::seconds),
            reason: ban.reason.clone(),
            by: ban.by.clone(),
            made_at: ban.made_at.seconds(),
        }
    }

    fn ban(self) -> Option<Ban> {
        Some(Ban {
            scope: BanScope::Visit,
            target: BanTarget::of_parts(&self.kind, &self.target)?,
            until: self.until.map(UnixTime::new),
            reason: self.reason,
            by: self.by,
            made_at: UnixTime::new(self.made_at),
        })
    }
}

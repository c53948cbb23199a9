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
//! - **Memory and file are bounded.** The player who was confirmed the longest ago makes room, in memory by the number
//!   of players, in the file also by its bytes. The file is replaced atomically. If it cannot be read, or belongs to
//!   another database, the memory starts empty.

use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::mem;
use std::path::{Path, PathBuf};

use cellcaster::app::store::private;
use serde::{Deserialize, Serialize};

use super::waiting::{failure, replace};
use super::{Account, AccountKey, AccountSettings, Ban, NAME_HELD, StoreFailure, UnixTime};

/// The most players that are remembered.
const MAX_PLAYERS: usize = 2000;
/// The most bytes of the file. A player takes about 500, with many settings of their own 17,000.
const MAX_BYTES: usize = 4 << 20;

/// The remembered players, and the bans: the content of the file.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct KnownPlayers {
    #[serde(skip)]
    file: PathBuf,
    /// The name of the database, without a password.
    database: String,
    bans: Vec<Ban>,
    players: BTreeMap<AccountKey, KnownPlayer>,
    #[serde(skip)]
    is_saved: bool,
}

/// A player, as the database described them at a login.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct KnownPlayer {
    pub(crate) account: Account,
    pub(crate) settings: AccountSettings,
    /// When the database confirmed the name.
    confirmed_at: UnixTime,
}

impl KnownPlayers {
    /// Reads the players of `database` that are remembered in a folder. Also returns a sentence if the file cannot be
    /// read.
    pub fn open(folder: &Path, database: &str) -> (Self, Option<String>) {
        let file = folder.join("known_players");
        let read = match private::read(&file, 2 * MAX_BYTES as u64) {
            Ok(content) => serde_json::from_slice::<Self>(&content)
                .map_err(|error| format!("{} is damaged: {error}", file.display())),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(Self::default()),
            Err(error) => Err(failure(&file, &error).to_string()),
        };
        let sentence = read.as_ref().err();
        let sentence =
            sentence.map(|fault| format!("{fault}; players are remembered again as they log in"));
        let known = read.unwrap_or_default();
        let mut known = if known.database == database { known } else { Self::default() };
        known
            .players
            .retain(|key, player| player.account.key == *key && player.settings.checked().is_ok());
        known.make_room();
        (Self { file, database: database.to_owned(), is_saved: true, ..known }, sentence)
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
        self.is_saved &= self.players.remove(key).is_none();
    }

    /// Remembers all bans of the database.
    pub(crate) fn note_bans(&mut self, bans: &[Ban]) {
        if self.bans != bans {
            self.bans = bans.to_vec();
            self.is_saved = false;
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

    /// Updates the file. Players who do not fit into it are forgotten.
    ///
    /// # Errors
    /// If it can't be written. The memory stays.
    pub fn save(&mut self) -> Result<(), StoreFailure> {
        if !self.is_saved {
            self.make_room();
            replace(&self.file, &json(self)).map_err(|error| failure(&self.file, &error))?;
            self.is_saved = true;
        }
        Ok(())
    }

    fn insert(&mut self, player: KnownPlayer) {
        self.players.insert(player.account.key, player);
        self.is_saved = false;
        if self.players.len() > MAX_PLAYERS {
            let oldest = self.players.values().min_by_key(|player| player.confirmed_at);
            oldest.map(|player| player.account.key).inspect(|key| _ = self.players.remove(key));
        }
    }

    /// Forgets the players who were confirmed the longest ago, until the others fit into the file beside the bans.
    fn make_room(&mut self) {
        let mut room = MAX_BYTES.saturating_sub(json(&self.bans).len());
        let mut players: Vec<KnownPlayer> = mem::take(&mut self.players).into_values().collect();
        players.sort_by_key(|player| Reverse(player.confirmed_at));
        players.truncate(MAX_PLAYERS);
        let fitting = players.into_iter().map_while(|player| {
            room = room.checked_sub(json(&player).len() + KEY_BYTES)?;
            Some((player.account.key, player))
        });
        self.players = fitting.collect();
    }
}

/// The bytes of a key before its player in the file.
const KEY_BYTES: usize = 64;

fn json(value: &impl Serialize) -> Vec<u8> {
    // Texts and numbers always have a form in JSON.
    serde_json::to_vec(value).unwrap_or_default()
}

//! A store in memory.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};

use super::score::with_run;
use super::{
    Account, AccountId, AccountKey, AccountSettings, AddressPrefix, Ban, BanTarget, DailyScore,
    DailyTry, Day, HostStore, Identity, LevelBoard, LevelScore, NAME_HELD, Name, Origin,
    RENAME_WAIT, Refusal, StoreFailure, UnixTime, VerifiedDescent, VerifiedLevel,
};
use cellcaster::app::store::{Best, Improved, Reached};

/// A store that ends with the program.
///
/// ```
/// use cellcaster_server::accounts::{AccountKey, HostStore, MemoryStore, Name, UnixTime};
///
/// let mut store = MemoryStore::default();
/// let (key, now) = (AccountKey::new([1; 32]), UnixTime::new(0));
/// let account = store.create_account(&key, &Name::new("Ada")?, now)?;
/// assert_eq!(store.account(&key)?, Some(account));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct MemoryStore {
    /// In the order of their numbers.
    accounts: Vec<Account>,
    settings: BTreeMap<AccountId, AccountSettings>,
    /// By the keys of names.
    names: BTreeMap<String, NameOwner>,
    bans: Vec<Ban>,
    /// When each network has its whole allowance of accounts again.
    rates: BTreeMap<AddressPrefix, i64>,
    results: BTreeMap<AccountId, Vec<Kept>>,
    dailies: BTreeMap<(Day, AccountId), Daily>,
}

/// Whose a name is.
#[derive(Clone, Debug)]
struct NameOwner {
    account: AccountId,
    /// `None` while it is in use.
    held_until: Option<UnixTime>,
}

/// The best results of an account on a board.
#[derive(Clone, Debug)]
struct Kept {
    board: LevelBoard,
    best: Best,
    script: String,
    verified_at: UnixTime,
}

#[derive(Clone, Debug, Default)]
struct Daily {
    reached: Reached,
    verified_at: UnixTime,
}

impl MemoryStore {
    fn find(&mut self, id: AccountId) -> Option<&mut Account> {
        self.accounts.iter_mut().find(|account| account.id == id)
    }

    fn existing(&mut self, id: AccountId) -> Result<&mut Account, StoreFailure> {
        self.find(id).ok_or_else(|| StoreFailure::new("there is no such account"))
    }

    /// Refuses a name that is banned, or belongs to another account.
    fn check_name(&mut self, id: AccountId, name: &Name, now: UnixTime) -> Result<(), Refusal> {
        let identity = Identity { name: Some(name), ..Identity::default() };
        if self.ban_of(&identity, now)?.is_some() {
            return Err(Refusal::NameBanned);
        }
        let is_held = |owner: &NameOwner| owner.held_until.is_none_or(|until| now < until);
        let owners = name.keys().into_iter().filter_map(|key| self.names.get(&key));
        if { owners }.any(|owner| owner.account != id && is_held(owner)) {
            return Err(Refusal::NameTaken);
        }
        Ok(())
    }

    /// Takes the keys of a name for an account, and releases those that it had.
    fn take_name(&mut self, id: AccountId, name: &Name, now: UnixTime) {
        let own = self.names.values_mut().filter(|owner| owner.account == id);
        for owner in own.filter(|owner| owner.held_until.is_none()) {
            owner.held_until = Some(now.after(NAME_HELD));
        }
        for key in name.keys() {
            self.names.insert(key, NameOwner { account: id, held_until: None });
        }
    }
}

impl HostStore for MemoryStore {
    fn account(&mut self, key: &AccountKey) -> Result<Option<Account>, StoreFailure> {
        Ok(self.accounts.iter().find(|account| account.key == *key).cloned())
    }

    fn account_named(&mut self, name: &Name) -> Result<Option<Account>, StoreFailure> {
        let alike = self.accounts.iter().filter(|account| account.name.looks_like(name));
        Ok(alike.min_by_key(|account| (account.name != *name, account.id)).cloned())
    }

    fn create_account_from(
        &mut self,
        origin: Option<&Origin>,
        key: &AccountKey,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, Refusal> {
        if self.account(key)?.is_some() {
            return Err(Refusal::KeyKnown);
        }
        let id = AccountId(self.accounts.len() as i64 + 1);
        self.check_name(id, name, now)?;
        if let Some(origin) = origin {
            let whole_at = origin.count(self.rates.get(&origin.network).copied(), now)?;
            self.rates.insert(origin.network, whole_at);
        }
        self.take_name(id, name, now);
        let (key, name) = (*key, name.clone());
        let account = Account { id, key, name, named_at: now, created_at: now, seen_at: now };
        self.accounts.push(account.clone());
        Ok(account)
    }

    fn rename(
        &mut self,
        account: AccountId,
        name: &Name,
        now: UnixTime,
    ) -> Result<Account, Refusal> {
        let next = self.find(account).ok_or(Refusal::NoAccount)?.named_at.after(RENAME_WAIT);
        if now < next {
            return Err(Refusal::TooEarly { next });
        }
        self.check_name(account, name, now)?;
        self.take_name(account, name, now);
        let account = self.existing(account)?;
        (account.name, account.named_at) = (name.clone(), now);
        Ok(account.clone())
    }

    fn note_visit(&mut self, account: AccountId, now: UnixTime) -> Result<(), StoreFailure> {
        if let Some(account) = self.find(account) {
            account.seen_at = now;
        }
        Ok(())
    }

    fn settings(&mut self, account: AccountId) -> Result<AccountSettings, StoreFailure> {
        Ok(self.settings.get(&account).cloned().unwrap_or_default())
    }

    fn set_settings(
        &mut self,
        account: AccountId,
        settings: &AccountSettings,
    ) -> Result<(), StoreFailure> {
        self.existing(account)?;
        self.settings.insert(account, settings.checked()?.clone());
        Ok(())
    }

    fn ban(&mut self, ban: &Ban) -> Result<(), StoreFailure> {
        self.unban(&ban.target)?;
        self.bans.push(ban.clone());
        Ok(())
    }

    fn unban(&mut self, target: &BanTarget) -> Result<bool, StoreFailure> {
        let before = self.bans.len();
        self.bans.retain(|ban| !ban.target.is_same(target));
        Ok(self.bans.len() < before)
    }

    fn bans(&mut self, now: UnixTime) -> Result<Vec<Ban>, StoreFailure> {
        Ok(self.bans.iter().filter(|ban| ban.is_in_force(now)).cloned().collect())
    }

    fn record(
        &mut self,
        account: AccountId,
        run: &VerifiedLevel,
        now: UnixTime,
    ) -> Result<Improved, StoreFailure> {
        self.existing(account)?;
        let kept = self.results.entry(account).or_default();
        let known = kept.iter_mut().find(|kept| kept.board == *run.board());
        let (best, improved) = with_run(known.as_ref().map(|kept| kept.best), run);
        match known {
            None => {
                let (board, script) = (run.board().clone(), run.script().to_owned());
                kept.push(Kept { board, best, script, verified_at: now });
            }
            Some(known) => {
                known.best = best;
                if improved.time {
                    (known.script, known.verified_at) = (run.script().to_owned(), now);
                }
            }
        }
        Ok(improved)
    }

    fn begin_daily(
        &mut self,
        account: AccountId,
        day: Day,
        _now: UnixTime,
    ) -> Result<Option<DailyTry>, StoreFailure> {
        self.existing(account)?;
        if self.dailies.contains_key(&(day, account)) {
            return Ok(None);
        }
        self.dailies.insert((day, account), Daily::default());
        Ok(Some(DailyTry { account, day }))
    }

    fn record_daily(
        &mut self,
        daily: &DailyTry,
        run: &VerifiedDescent,
        now: UnixTime,
    ) -> Result<bool, StoreFailure> {
        let known = self.dailies.get_mut(&(daily.day, daily.account));
        let Some(known) = known.filter(|_| run.day() == Some(daily.day)) else { return Ok(false) };
        let is_farther = known.reached < run.reached();
        if is_farther {
            *known = Daily { reached: run.reached(), verified_at: now };
        }
        Ok(is_farther)
    }

    fn bests(&mut self, account: AccountId) -> Result<Vec<(LevelBoard, Best)>, StoreFailure> {
        let kept = self.results.get(&account).into_iter().flatten();
        let mut bests: Vec<_> = kept.map(|kept| (kept.board.clone(), kept.best)).collect();
        bests.sort_by(|(one, _), (other, _)| one.cmp(other));
        Ok(bests)
    }

    fn level_boards(&mut self) -> Result<Vec<LevelBoard>, StoreFailure> {
        let boards = self.results.values().flatten().map(|kept| kept.board.clone());
        let boards: BTreeSet<LevelBoard> = boards.collect();
        Ok(boards.into_iter().collect())
    }

    fn level_scores(
        &mut self,
        board: &LevelBoard,
        most: usize,
    ) -> Result<Vec<LevelScore>, StoreFailure> {
        let mut scores = Vec::new();
        for account in &self.accounts {
            let kept = self.results.get(&account.id).into_iter().flatten();
            scores.extend(kept.filter(|kept| kept.board == *board).map(|kept| LevelScore {
                account: account.id,
                name: account.name.clone(),
                tally: kept.best.tally,
                rank: kept.best.rank,
                verified_at: kept.verified_at,
            }));
        }
        scores.sort_by_key(|score| (score.tally.steps, score.verified_at, score.account));
        scores.truncate(most);
        Ok(scores)
    }

    fn daily_scores(&mut self, day: Day, most: usize) -> Result<Vec<DailyScore>, StoreFailure> {
        let mut scores = Vec::new();
        for account in &self.accounts {
            let daily = self.dailies.get(&(day, account.id)).filter(|it| it.reached.floors > 0);
            scores.extend(daily.map(|daily| DailyScore {
                account: account.id,
                name: account.name.clone(),
                reached: daily.reached,
                verified_at: daily.verified_at,
            }));
        }
        scores.sort_by_key(|score| (Reverse(score.reached), score.verified_at, score.account));
        scores.truncate(most);
        Ok(scores)
    }

    fn script(
        &mut self,
        account: AccountId,
        board: &LevelBoard,
    ) -> Result<Option<String>, StoreFailure> {
        let mut kept = self.results.get(&account).into_iter().flatten();
        Ok(kept.find(|kept| kept.board == *board).map(|kept| kept.script.clone()))
    }
}

//! Who visitors are: accounts, guests, bans, and names.

use std::sync::{Arc, Mutex};

use super::{Shared, unix_time};
use crate::accounts::{
    Account, AccountId, AccountKey, AccountSettings, Ban, BanTarget, HostStore, Identity, Name,
    Origin, Refusal, StoreFailure,
};
use crate::lock::locked;
use crate::ops::logging::events;
use crate::rooms::room::NAME_COLUMNS;
use crate::sessions::line::Line;
use crate::ssh::{Departure, Visitor};

/// What the store knows of a visitor.
#[derive(Debug)]
pub(crate) struct Known {
    /// The key; `None` for a guest.
    pub(crate) key: Option<AccountKey>,
    /// The account; `None` for a guest, and before the name is chosen.
    pub(crate) account: Option<Account>,
    pub(crate) settings: AccountSettings,
    /// The name that is offered.
    pub(crate) offer: Name,
}

/// Names of visitors who have no account, while they are here.
#[derive(Clone, Debug, Default)]
pub(crate) struct NamesInUse(Arc<Mutex<Vec<Name>>>);

/// A name that is in use until this is dropped.
#[derive(Debug)]
pub(crate) struct NameInUse {
    name: Name,
    names: NamesInUse,
}

/// What a visitor is told whom the store cannot find now.
pub(crate) const NOT_KNOWN: &str = "The host can't look you up now; try again later.";
/// What a visitor is told whose name cannot be kept.
const NOT_NOW: &str = "The host can't keep this now; try again later.";

impl Shared {
    /// What the store knows of a visitor, or a sentence why they may not play.
    pub(crate) async fn log_in(&self, visitor: &Visitor) -> Result<Known, (String, Departure)> {
        let key = visitor.key;
        let address = visitor.peer.ip();
        let answer = self.store.call(move |store| {
            let now = unix_time();
            let account = key.map(|key| store.account(&key)).transpose()?.flatten();
            let name = account.as_ref().map(|account| &account.name);
            let identity = Identity { address: Some(address), key: key.as_ref(), name };
            let ban = store.ban_of(&identity, now)?;
            let settings = match &account {
                Some(account) => {
                    store.note_visit(account.id, now)?;
                    store.settings(account.id)?
                }
                None => AccountSettings::default(),
            };
            Ok::<_, StoreFailure>((ban, account, settings))
        });
        let (ban, account, settings) = match answer.await {
            Ok(Ok(known)) => known,
            failed => {
                self.metrics.store_errors.inc();
                events::store_failed(format!("{failed:?}"));
                return Err((NOT_KNOWN.to_owned(), Departure::FAILED));
            }
        };
        if let Some(ban) = ban {
            events::banned_visitor(address, &ban.target);
            return Err((banned(&ban), Departure::REFUSED));
        }
        let offer = match &account {
            Some(account) => account.name.clone(),
            None => self.offer(&visitor.user),
        };
        Ok(Known { key, account, settings, offer })
    }

    /// A name for somebody new: that of their user name, if it can be one.
    fn offer(&self, user: &str) -> Name {
        let own = Name::new(user).ok().filter(|name| !self.names.has(name));
        own.unwrap_or_else(|| Name::of_guest(self.guest_number()))
    }
}

/// The name that a visitor wants, once it is theirs.
pub(crate) fn choose_name(
    store: &mut dyn HostStore,
    origin: &Origin,
    key: Option<AccountKey>,
    account: Option<AccountId>,
    name: &Name,
) -> Result<Option<Account>, String> {
    let now = unix_time();
    let sentence = |refusal: Refusal| refusal.to_string();
    match (key, account) {
        (_, Some(account)) => store.rename(account, name, now).map(Some).map_err(sentence),
        (Some(key), None) => {
            let account = store.create_account_from(Some(origin), &key, name, now);
            account.map(Some).map_err(sentence)
        }
        (None, None) => match guest_may_use(store, name) {
            Ok(true) => Ok(None),
            Ok(false) => Err(Refusal::NameTaken.to_string()),
            Err(_) => Err(NOT_NOW.to_owned()),
        },
    }
}

fn guest_may_use(store: &mut dyn HostStore, name: &Name) -> Result<bool, StoreFailure> {
    let is_taken = store.account_named(name)?.is_some();
    let identity = Identity { name: Some(name), ..Identity::default() };
    Ok(!is_taken && store.ban_of(&identity, unix_time())?.is_none())
}

fn banned(ban: &Ban) -> String {
    let what = match ban.target {
        BanTarget::Key(_) => "Your key is",
        BanTarget::Name(_) => "Your name is",
        BanTarget::Addresses(_) => "Your network is",
    };
    match Line::of(&ban.reason, 200) {
        Some(reason) => format!("{what} banned from this server: {reason}"),
        None => format!("{what} banned from this server."),
    }
}

/// A name as lines have it.
pub(crate) fn line(name: &Name) -> Line {
    // A name is printable, and fits.
    Line::of(name.as_str(), NAME_COLUMNS).unwrap_or_else(|| Line::of("guest", 5).expect("a line"))
}

impl NamesInUse {
    /// Reserves a name; `None` if somebody uses one that looks like it.
    pub(crate) fn reserve(&self, name: &Name) -> Option<NameInUse> {
        let is_free = locked(&self.0, |names| {
            let is_free = !names.iter().any(|other| other.looks_like(name));
            if is_free {
                names.push(name.clone());
            }
            is_free
        });
        is_free.then(|| NameInUse { name: name.clone(), names: self.clone() })
    }

    fn has(&self, name: &Name) -> bool {
        locked(&self.0, |names| names.iter().any(|other| other.looks_like(name)))
    }
}

impl Drop for NameInUse {
    fn drop(&mut self) {
        locked(&self.names.0, |names| {
            if let Some(index) = names.iter().position(|name| *name == self.name) {
                names.swap_remove(index);
            }
        });
    }
}

//! The start of a visit: the account, bans, names, cluster-wide limits, and the terminal.
//!
//! While the database is away, a host lets in the players that it [remembers](KnownPlayers), unless a remembered ban
//! applies to them. In a cluster, their visits then count on their host alone.

use std::net::IpAddr;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, Weak};
use std::time::Duration;

use tokio::time::sleep;

use super::Shared;
use super::talk::read_mutes;
use crate::accounts::known::KnownPlayer;
use crate::accounts::{
    Account, AccountKey, AccountRefusal, AccountSettings, Ban, BanScope, BanTarget, HostStore,
    Identity, KnownPlayers, Name, Origin, StoreFailure, UnixTime, applying,
};
use crate::cluster::{CountedVisit, NewVisit, VisitRefusal};
use crate::line::Line;
use crate::lock::locked;
use crate::logging;
use crate::rooms::room::NAME_COLUMNS;
use crate::ssh::{Departure, Visitor};
use cellcaster::terminal::{SessionOptions, locale_without_utf8};

/// The account data of a visitor.
#[derive(Debug)]
pub(crate) struct AccountData {
    /// The key; `None` for a guest.
    pub(crate) key: Option<AccountKey>,
    /// The account; `None` for a guest, and before a name is chosen.
    pub(crate) account: Option<Account>,
    pub(crate) settings: AccountSettings,
    /// The name offered to the visitor.
    pub(crate) offer: Name,
    /// Whether the database was away, and the host remembers the player.
    pub(crate) is_remembered: bool,
}

/// Shown to a visitor while the store or the cluster cannot be reached.
const NOT_KNOWN: &str = "The host can't look you up now; try again later.";
/// Shown to a visitor whose name cannot be stored.
const NOT_NOW: &str = "The host can't save this now; try again later.";

impl Shared {
    /// Looks up a visitor. On failure, returns the sentence that tells them why they may not play, and their
    /// departure.
    pub(crate) async fn log_in(
        &self,
        visitor: &Visitor,
    ) -> Result<AccountData, (String, Departure)> {
        let key = visitor.key;
        let address = visitor.peer.ip();
        let (known, visitors) = (self.known.clone(), self.visitors.clone());
        let answer = self.store.call(move |store| {
            let found = look_up(store, known.as_deref(), address, key)?;
            if found.failure.is_none() {
                read_mutes(store, &visitors)?;
            }
            Ok::<_, StoreFailure>(found)
        });
        let failed = |failure: String| {
            self.metrics.store_errors.inc();
            logging::store_failed(failure);
        };
        let LookedUp { ban, account, settings, failure } = match answer.await {
            Ok(Ok(found)) => found,
            answer => {
                failed(format!("{answer:?}"));
                return Err((NOT_KNOWN.to_owned(), Departure::FAILED));
            }
        };
        let is_remembered = failure.is_some();
        if let Some(failure) = failure {
            failed(failure.to_string());
        }
        if let Some(ban) = ban {
            logging::banned_visitor(address, &ban.target);
            return Err((banned(&ban), Departure::REFUSED));
        }
        let offer = match &account {
            Some(account) => account.name.clone(),
            None => self.offer(&visitor.user),
        };
        Ok(AccountData { key, account, settings, offer, is_remembered })
    }

    /// A name to offer to a new visitor: their user name, if it is valid and free, or else a guest name.
    fn offer(&self, user: &str) -> Name {
        let own = Name::new(user).ok().filter(|name| !self.visitors.has_guest(name));
        own.unwrap_or_else(|| Name::of_guest(self.next_guest.fetch_add(1, Ordering::Relaxed)))
    }
}

/// The result of looking a visitor up.
#[derive(Debug)]
struct LookedUp {
    ban: Option<Ban>,
    account: Option<Account>,
    settings: AccountSettings,
    /// The failure of the database, if the host remembers the player.
    failure: Option<StoreFailure>,
}

/// Looks a visitor up in the store or, while it is away, among the players in `known`.
fn look_up(
    store: &mut HostStore,
    known: Option<&Mutex<KnownPlayers>>,
    address: IpAddr,
    key: Option<AccountKey>,
) -> Result<LookedUp, StoreFailure> {
    let now = UnixTime::now();
    let (bans, found, failure) = match (look_up_in(store, key, now), known, key) {
        (Ok((bans, found)), known, _) => {
            if let Some(known) = known {
                locked(known, |known| {
                    known.note_bans(&bans);
                    match (&found, &key) {
                        (Some((account, settings)), _) => known.note(account, settings, now),
                        (None, Some(key)) => known.forget(key),
                        (None, None) => {}
                    }
                });
            }
            (bans, found, None)
        }
        (Err(failure @ StoreFailure::Away(_)), Some(known), Some(key)) => {
            let Some((player, bans)) = locked(known, |known| known.find(&key, now)) else {
                return Err(failure);
            };
            let KnownPlayer { account, settings, .. } = player;
            (bans, Some((account, settings)), Some(failure))
        }
        (Err(failure), ..) => return Err(failure),
    };
    let name = found.as_ref().map(|(account, _)| &account.name);
    let identity = Identity { address: Some(address), key: key.as_ref(), name };
    let ban = applying(&bans, &identity).cloned();
    let (account, settings) = found.unzip();
    Ok(LookedUp { ban, account, settings: settings.unwrap_or_default(), failure })
}

/// The bans in force, and the account of a key with its settings.
type Found = (Vec<Ban>, Option<(Account, AccountSettings)>);

fn look_up_in(
    store: &mut HostStore,
    key: Option<AccountKey>,
    now: UnixTime,
) -> Result<Found, StoreFailure> {
    let bans = store.bans(BanScope::Visit, now)?;
    let account = key.map(|key| store.account(&key)).transpose()?.flatten();
    let found = account.map(|account| {
        store.note_visit(account.id, now)?;
        let settings = store.settings(account.id)?;
        Ok::<_, StoreFailure>((account, settings))
    });
    Ok((bans, found.transpose()?))
}

/// The interval between two times at which the host learns of new bans and saves the known players.
const REMEMBER_INTERVAL: Duration = Duration::from_mins(1);

/// Keeps the known players and the bans up to date for as long as the host exists.
pub(crate) async fn remember_all(shared: Weak<Shared>, known: Arc<Mutex<KnownPlayers>>) {
    loop {
        sleep(REMEMBER_INTERVAL).await;
        let Some(shared) = shared.upgrade() else { return };
        let known = Arc::clone(&known);
        shared.store.run(move |store| {
            if let Ok(bans) = store.bans(BanScope::Visit, UnixTime::now()) {
                locked(&known, |known| known.note_bans(&bans));
            }
            save(&known);
        });
    }
}

/// Saves the known players.
pub(crate) fn save(known: &Mutex<KnownPlayers>) {
    if let Err(failure) = locked(known, KnownPlayers::save) {
        logging::store_failed(failure);
    }
}

/// Assigns the requested name to a visitor.
pub(crate) fn choose_name(
    store: &mut HostStore,
    origin: &Origin,
    key: Option<AccountKey>,
    account: Option<Account>,
    name: &Name,
) -> Result<Option<Account>, String> {
    let now = UnixTime::now();
    let sentence = |refusal: AccountRefusal| refusal.to_string();
    match (key, account) {
        (_, Some(account)) => {
            let renamed = store.of_key(&account.key).map_err(AccountRefusal::Failed);
            let renamed = renamed.and_then(|id| store.rename(id, name, now));
            renamed.map(Some).map_err(sentence)
        }
        (Some(key), None) => {
            let account = store.create_account(Some(origin), &key, name, now);
            account.map(Some).map_err(sentence)
        }
        (None, None) => match guest_may_use(store, name) {
            Ok(true) => Ok(None),
            Ok(false) => Err(AccountRefusal::NameTaken.to_string()),
            Err(_) => Err(NOT_NOW.to_owned()),
        },
    }
}

fn guest_may_use(store: &mut HostStore, name: &Name) -> Result<bool, StoreFailure> {
    let is_taken = store.account_named(name)?.is_some();
    let identity = Identity { name: Some(name), ..Identity::default() };
    Ok(!is_taken && store.ban_of(&identity, UnixTime::now())?.is_none())
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

/// A name as a line.
pub(crate) fn line(name: &Name) -> Line {
    // This cannot fail, because a name is printable and short enough.
    Line::of(name.as_str(), NAME_COLUMNS).unwrap_or_else(|| Line::of("guest", 5).expect("a line"))
}

impl Shared {
    /// Counts a visit across all hosts of a cluster. On failure, returns the sentence that tells the visitor
    /// why they may not play, and their departure.
    pub(crate) async fn begin_visit(
        &self,
        visitor: &Visitor,
        key: Option<AccountKey>,
        is_remembered: bool,
    ) -> Result<Option<CountedVisit>, (String, Departure)> {
        let Some(rooms) = &self.cluster else { return Ok(None) };
        let limits = self.config.get().admission();
        let new_visit = NewVisit {
            key,
            per_key: limits.per_key,
            address: visitor.peer.ip(),
            per_address: limits.per_address,
        };
        match rooms.visits().begin(new_visit).await {
            Ok(visit) => Ok(Some(visit)),
            Err(VisitRefusal::TooMany(reason)) => {
                let refusal = Some(reason);
                Err((reason.sentence(&limits), Departure { refusal, ..Departure::REFUSED }))
            }
            Err(VisitRefusal::NotNow(failure)) => {
                self.metrics.store_errors.inc();
                logging::store_failed(failure);
                let failed = || (NOT_KNOWN.to_owned(), Departure::FAILED);
                is_remembered.then_some(None).ok_or_else(failed)
            }
        }
    }
}

/// The properties of a visitor's terminal, as described by their client.
pub(crate) fn terminal_options(visitor: &Visitor) -> SessionOptions {
    SessionOptions {
        is_remote: true,
        is_ascii: ascii_locale(visitor).is_some(),
        ..SessionOptions::from_environment(|name| variable(visitor, name))
    }
}

/// The locale setting that restricts the visitor to ASCII. `None` for UTF-8, and if their client sends no locale.
pub(crate) fn ascii_locale(visitor: &Visitor) -> Option<String> {
    locale_without_utf8(|name| variable(visitor, name))
}

/// A sentence for a visitor whose terminal cannot show the game.
pub(crate) fn terminal_refusal(visitor: &Visitor) -> Option<String> {
    let term = terminal_options(visitor).teletype?;
    Some(format!(
        "TERM is {term}, and the game needs a terminal that can move its cursor. Set TERM to your terminal's \
         name, such as xterm-256color."
    ))
}

fn variable(visitor: &Visitor, name: &str) -> Option<String> {
    match name {
        "TERM" => Some(visitor.term.clone()),
        _ => visitor.environment.get(name).cloned(),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::net::SocketAddr;

    use super::*;
    use cellcaster::color::palette::ColorDepth;
    use cellcaster::terminal::WindowSize;

    fn visitor(term: &str, variables: &str) -> Visitor {
        let pairs = variables.split_whitespace().filter_map(|pair| pair.split_once('='));
        let environment: BTreeMap<String, String> =
            pairs.map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
        Visitor {
            peer: SocketAddr::from(([192, 0, 2, 1], 50_000)),
            key: None,
            notice: None,
            user: "ann".to_owned(),
            term: term.to_owned(),
            environment,
            size: WindowSize::of_cells(80, 24),
            compresses: false,
        }
    }

    #[test]
    fn the_client_locale_decides_on_ascii() {
        for (variables, setting) in [
            ("", None),
            ("LANG=en_GB.UTF-8 LC_TIME=C", None),
            ("LANG=C", Some("LANG=C")),
            ("LANG=en_GB.UTF-8 LC_ALL=C", Some("LC_ALL=C")),
            ("LANG=C LC_CTYPE=C.UTF-8", None),
        ] {
            let visitor = visitor("xterm-256color", variables);
            assert_eq!(ascii_locale(&visitor).as_deref(), setting, "{variables}");
            assert_eq!(terminal_options(&visitor).is_ascii, setting.is_some(), "{variables}");
        }
    }

    #[test]
    fn only_terminals_without_cursor_motion_are_refused() {
        for term in ["dumb", "unknown", "tty33"] {
            assert!(
                terminal_refusal(&visitor(term, "")).is_some_and(|it| it.contains(term)),
                "{term}"
            );
        }
        for term in ["", "linux", "vt100", "no-such", "xterm-256color"] {
            assert_eq!(terminal_refusal(&visitor(term, "")), None, "{term}");
        }
    }

    #[test]
    fn a_linux_console_gets_no_queries_that_it_would_print() {
        let options = terminal_options(&visitor("linux", ""));
        assert!(!options.probe_extensions && !options.ask_for_version && !options.is_ascii);
        assert_eq!(options.color_depth.depth(), ColorDepth::Indexed16);
    }
}

//! Bans, in the store of a host.

use std::env;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use super::table::{table, time as shown_time};
use super::{Error, RunningHost, sessions};
use crate::accounts::{Ban, BanTarget, HostStore, UnixTime};
use crate::cli::host_store::{Database, failed};
use crate::ops::admin::{AdminFailure, AdminReply, AdminRequest, Target};

/// Bans, and ends the sessions to which the ban applies.
pub(crate) fn ban(
    host: &mut RunningHost<'_>,
    database: &Database,
    target: &Target,
    time: Option<Duration>,
    reason: &str,
) -> Result<String, Error> {
    let mut store = open(database)?;
    let now = now();
    let targets = targets(&mut store, target)?;
    for target in &targets {
        let ban = Ban {
            target: target.clone(),
            until: time.map(|time| now.after(time.as_secs())),
            reason: reason.to_owned(),
            by: operator(),
            made_at: now,
        };
        store.ban(&ban).map_err(failed)?;
    }
    let removed = remove(host, &targets, reason)?;
    let whom: Vec<String> = targets.iter().map(shown).collect();
    let time =
        time.map_or("for ever".to_owned(), |time| format!("for {}", shown_time(time.as_secs())));
    let ended = match removed {
        None => "no server runs".to_owned(),
        Some(count) => format!("ended {}", sessions(count)),
    };
    Ok(format!("banned {} {time}; {ended}\n", whom.join(" and ")))
}

/// Ends the bans of a target.
pub(crate) fn unban(database: &Database, target: &Target) -> Result<String, Error> {
    let mut store = open(database)?;
    let mut ended = Vec::new();
    for target in targets(&mut store, target)? {
        if store.unban(&target).map_err(failed)? {
            ended.push(shown(&target));
        }
    }
    if ended.is_empty() {
        return Err(Error::mistake(
            "there is no such ban; \"cellcaster-server admin bans\" lists them",
        ));
    }
    Ok(format!("{} may come back\n", ended.join(" and ")))
}

/// The bans in force.
pub(crate) fn list(database: &Database) -> Result<String, Error> {
    let mut store = database.open_to_read()?;
    let now = now();
    let bans = store.bans(now).map_err(failed)?;
    if bans.is_empty() {
        return Ok("nobody is banned\n".to_owned());
    }
    let left = |ban: &Ban| match ban.until {
        None => "ever".to_owned(),
        Some(until) => shown_time(until.seconds().saturating_sub(now.seconds())),
    };
    let ago = |ban: &Ban| shown_time(now.seconds().saturating_sub(ban.made_at.seconds()));
    Ok(table(
        ["banned", "for", "made", "by", "reason"],
        bans.iter().map(|ban| {
            let made = format!("{} ago", ago(ban));
            [shown(&ban.target), left(ban), made, ban.by.clone(), ban.reason.clone()]
        }),
    ))
}

/// The target of a ban; for a name, also the key of the account that has it.
fn targets(store: &mut HostStore, target: &Target) -> Result<Vec<BanTarget>, Error> {
    let target = target.to_ban().map_err(Error::mistake)?;
    let account = match &target {
        BanTarget::Name(name) => store.account_named(name).map_err(failed)?,
        BanTarget::Key(_) | BanTarget::Addresses(_) => None,
    };
    Ok([target].into_iter().chain(account.map(|account| BanTarget::Key(account.key))).collect())
}

/// Ends the sessions of `targets`, and returns their number; `None` if no server runs.
fn remove(
    host: &mut RunningHost<'_>,
    targets: &[BanTarget],
    reason: &str,
) -> Result<Option<usize>, Error> {
    let mut removed = 0;
    for target in targets {
        let target = match target {
            BanTarget::Key(key) => Target::Key(key.to_string()),
            BanTarget::Name(name) => Target::Name(name.as_str().to_owned()),
            BanTarget::Addresses(range) => Target::Address(range.to_string()),
        };
        let request = AdminRequest::Remove { target, reason: reason.to_owned(), banned: true };
        match host.answers(&request) {
            Ok(AdminReply::Count(count)) => removed = count.max(removed),
            Err(AdminFailure::NoServer(_)) => return Ok(None),
            Ok(_) => {}
            Err(failure) => return Err(failure.into()),
        }
    }
    Ok(Some(removed))
}

/// The store, which is not made if there is none.
fn open(database: &Database) -> Result<HostStore, Error> {
    database.open_to_read()?;
    database.open().map_err(failed)
}

/// Who bans: the user who calls, also through `sudo`.
fn operator() -> String {
    let names = ["SUDO_USER", "USER", "LOGNAME"].into_iter().filter_map(|name| env::var(name).ok());
    names.into_iter().find(|name| !name.is_empty()).unwrap_or_else(|| "console".to_owned())
}

fn shown(target: &BanTarget) -> String {
    match target {
        BanTarget::Key(key) => key.to_string(),
        BanTarget::Name(name) => name.as_str().to_owned(),
        BanTarget::Addresses(range) => range.to_string(),
    }
}

fn now() -> UnixTime {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    UnixTime::new(since.as_secs())
}

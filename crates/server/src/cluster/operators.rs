//! Requests of an operator, which one host passes on to all hosts of the cluster.
//!
//! # Rules
//!
//! - A host asks the others over the bus, and waits until all present hosts have answered, but at most for
//!   [`TIMEOUT`]. The database lists the present hosts.
//! - A host answers only for itself, with at most [`MAX_ROWS`] visitors, so that the bus accepts the answer as a
//!   message.
//! - Only some requests go to the other hosts. Only a host's own operator can end it.
//!
//! Rejected: one host that every operator asks. It would have to be found, and replaced.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use serde::{Deserialize, Serialize};
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep, timeout, timeout_at};

use super::directory::SharedRooms;
use super::host::shown_name;
use crate::accounts::HostRow;
use crate::admin::{AdminReply, AdminRequest, HostInfo};
use cellcaster::app::store::name_in_map_key;

/// The time limit for the answers of other hosts.
const TIMEOUT: Duration = Duration::from_secs(2);
/// The time limit for the database to list the hosts.
const DATABASE_TIMEOUT: Duration = Duration::from_secs(1);
/// The pause before a bus that did not answer is asked again.
const RETRY_INTERVAL: Duration = Duration::from_secs(1);
/// The most visitors in a host's answer. Each takes about 250 bytes, and NATS accepts a megabyte.
const MAX_ROWS: usize = 2_000;

/// The answers of the other hosts.
#[derive(Default)]
struct OtherHosts {
    /// The replies by the names of the hosts.
    replies: BTreeMap<String, AdminReply>,
    /// The reasons why an answer may be missing or incomplete.
    remarks: Vec<String>,
}

/// A host's question to the others.
#[derive(Serialize, Deserialize)]
struct Question {
    from: String,
    request: AdminRequest,
}

/// A host's answer.
#[derive(Serialize, Deserialize)]
struct HostAnswer {
    host: String,
    reply: AdminReply,
}

impl SharedRooms {
    /// The name of this host, which is unique among all starts of all hosts.
    fn own_name(&self) -> &str {
        &self.context().notice.name
    }

    /// This host's information about itself.
    pub(crate) fn own_info(&self) -> HostInfo {
        let context = self.context();
        HostInfo {
            visitors: context.visitors.count(),
            rooms: Some(context.leases.rooms().into_iter().map(|room| room.0).collect()),
            maps: Some(context.rooms.catalog().map_keys().map(str::to_owned).collect()),
            ..info(&HostRow { notice: context.notice.clone(), ago: Duration::ZERO })
        }
    }

    /// Asks the other hosts, and merges their answers with the answer of this host.
    pub(crate) async fn merged(&self, own: AdminReply, request: &AdminRequest) -> AdminReply {
        let (rows, OtherHosts { replies, remarks }) = self.ask_others(request).await;
        let mut all = AdminReply { remarks, ..AdminReply::default() };
        // A host that has not answered is listed with its information from the database.
        let mut hosts: BTreeMap<String, HostInfo> = match request {
            AdminRequest::Hosts => {
                rows.iter().map(|it| (it.notice.name.clone(), info(it))).collect()
            }
            _ => BTreeMap::new(),
        };
        for (name, reply) in [(self.own_name().to_owned(), own)].into_iter().chain(replies) {
            all.count += reply.count;
            all.visitors.extend(reply.visitors);
            let seconds = hosts.get(&name).map_or(0, |known| known.seconds);
            let answers = reply.hosts.into_iter();
            hosts.extend(answers.map(|it| (name.clone(), HostInfo { seconds, ..it })));
        }
        all.remarks.extend(hosts.values().filter_map(|host| self.map_difference(host)));
        all.hosts = hosts.into_values().collect();
        all
    }

    /// Asks the other hosts. Also returns the hosts that the database lists.
    async fn ask_others(&self, request: &AdminRequest) -> (Vec<HostRow>, OtherHosts) {
        let context = self.context();
        let question = Question { from: self.own_name().to_owned(), request: request.clone() };
        let question = serde_json::to_vec(&question).unwrap_or_default();
        let end = Instant::now() + TIMEOUT;
        let (hosts, answers) = tokio::join!(
            timeout(DATABASE_TIMEOUT, context.visits.hosts()),
            context.bus.ask_hosts(question),
        );
        let mut others = OtherHosts::default();
        let Some(rows) = hosts.ok().flatten() else {
            let remark = "the database did not list the hosts";
            others.remarks.push(remark.to_owned());
            others.hear(answers.ok(), end, None).await;
            return (Vec::new(), others);
        };
        let names = rows.iter().map(|row| row.notice.name.as_str());
        let there: BTreeSet<&str> = names.filter(|name| *name != self.own_name()).collect();
        others.hear(answers.ok(), end, Some(&there)).await;
        let silent = there.iter().filter(|name| !others.replies.contains_key(**name));
        let silent = silent.map(|name| format!("host {} did not answer", shown_name(name)));
        others.remarks.extend(silent);
        (rows, others)
    }

    /// A sentence about the differences between a host's maps and this host's maps. `None` if there are none, or if the
    /// host did not answer.
    fn map_difference(&self, host: &HostInfo) -> Option<String> {
        let own = self.context().rooms.catalog().map_keys().collect();
        let theirs = host.maps.as_ref()?.iter().map(String::as_str).collect();
        let difference = difference(&own, &theirs)?;
        let (own, other) = (shown_name(self.own_name()), &host.host);
        Some(format!("host {other} has different maps from host {own}: it {difference}"))
    }

    /// Warns about hosts with other maps, once this host has started.
    pub(crate) async fn compare_maps(self) {
        sleep(RETRY_INTERVAL).await;
        let (_, others) = self.ask_others(&AdminRequest::Hosts).await;
        let hosts = others.replies.values().flat_map(|reply| &reply.hosts);
        for difference in hosts.filter_map(|host| self.map_difference(host)) {
            tracing::warn!("{difference}; this host does not list its rooms in those maps");
        }
    }

    /// Answers the requests of other hosts, again and again.
    pub(crate) async fn answer_others(
        self,
        answer: impl Fn(&AdminRequest) -> AdminReply + Send + Sync,
    ) {
        loop {
            if let Ok(mut requests) = self.context().bus.host_requests().await {
                while let Some(request) = requests.recv().await {
                    if let Some(bytes) = self.answer_to(&request.bytes, &answer) {
                        _ = request.reply.send(bytes);
                    }
                }
            }
            sleep(RETRY_INTERVAL).await;
        }
    }

    /// The answer to another host; `None` for a request that this host does not answer.
    fn answer_to(
        &self,
        bytes: &[u8],
        answer: impl Fn(&AdminRequest) -> AdminReply,
    ) -> Option<Vec<u8>> {
        let Question { from, request } = serde_json::from_slice(bytes).ok()?;
        if from == self.own_name() || !request.is_for_all_hosts() {
            return None;
        }
        let reply = bounded(answer(&request), shown_name(self.own_name()));
        serde_json::to_vec(&HostAnswer { host: self.own_name().to_owned(), reply }).ok()
    }
}

impl OtherHosts {
    /// Waits for answers until `end`, or until all hosts in `there` have answered.
    async fn hear(
        &mut self,
        answers: Option<mpsc::Receiver<Vec<u8>>>,
        end: Instant,
        there: Option<&BTreeSet<&str>>,
    ) {
        let Some(mut answers) = answers else {
            return self.remarks.push("the cluster's bus does not answer".to_owned());
        };
        let has_all = |replies: &BTreeMap<String, AdminReply>| {
            there.is_some_and(|there| there.iter().all(|name| replies.contains_key(*name)))
        };
        while !has_all(&self.replies) {
            let Ok(Some(bytes)) = timeout_at(end, answers.recv()).await else { return };
            let Ok(HostAnswer { host, reply }) = serde_json::from_slice(&bytes) else { continue };
            self.remarks.extend(reply.remarks.iter().cloned());
            if let Some(sentence) = &reply.fault {
                self.remarks.push(format!("host {}: {sentence}", shown_name(&host)));
            }
            self.replies.insert(host, reply);
        }
    }
}

/// A host's information in the database, which does not include its rooms.
fn info(row: &HostRow) -> HostInfo {
    HostInfo {
        host: shown_name(&row.notice.name).to_owned(),
        address: row.notice.address.clone(),
        version: row.notice.version.clone(),
        visitors: row.notice.load as usize,
        rooms: None,
        seconds: row.ago.as_secs(),
        maps: None,
    }
}

/// The differences of another host's maps from this host's maps, by their keys, in words that follow "it". `None` if
/// there are none.
fn difference(own: &BTreeSet<&str>, theirs: &BTreeSet<&str>) -> Option<String> {
    let names = |keys: &BTreeSet<&str>, others: &BTreeSet<&str>| -> BTreeSet<String> {
        let names = keys.difference(others).map(|key| name_in_map_key(key).unwrap_or(key));
        names.map(str::to_owned).collect()
    };
    let (lacking, more) = (names(own, theirs), names(theirs, own));
    let list = |what: &str, names: Vec<&String>, end: &str| {
        let names: Vec<&str> = names.into_iter().map(String::as_str).collect();
        (!names.is_empty()).then(|| format!("{what} {}{end}", names.join(", ")))
    };
    let parts = [
        list("has a different text of", lacking.intersection(&more).collect(), ""),
        list("lacks", lacking.difference(&more).collect(), ""),
        list("has", more.difference(&lacking).collect(), " in addition"),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| parts.join("; it "))
}

/// Shortens a reply so that the bus accepts it.
fn bounded(mut reply: AdminReply, host: &str) -> AdminReply {
    let more = reply.visitors.len().saturating_sub(MAX_ROWS);
    if more > 0 {
        reply.visitors.truncate(MAX_ROWS);
        reply.remarks.push(format!("host {host} has {more} more visitors"));
    }
    reply
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::app::store::map_key;

    fn told(own: &[(&str, &str)], theirs: &[(&str, &str)]) -> Option<String> {
        let keys = |maps: &[(&str, &str)]| -> Vec<String> {
            maps.iter().map(|(name, text)| map_key(name, text)).collect()
        };
        let (own, theirs) = (keys(own), keys(theirs));
        let [own, theirs] = [&own, &theirs].map(|keys| keys.iter().map(String::as_str).collect());
        difference(&own, &theirs)
    }

    #[test]
    fn differing_maps_are_listed_by_name() {
        let moss = ("moss-2", "a");
        assert_eq!(told(&[], &[]), None);
        assert_eq!(told(&[moss], &[moss]), None);
        let difference = told(
            &[moss, ("fern", "a"), ("hall", "a")],
            &[("moss-2", "b"), ("hall", "a"), ("cave", "a")],
        );
        let expected = "has a different text of moss-2; it lacks fern; it has cave in addition";
        assert_eq!(difference.as_deref(), Some(expected));
    }
}

//! Requests of one host's operator that concern all hosts.

use std::net::IpAddr;
use std::time::Duration;

use tokio::runtime::Builder;
use tokio::sync::watch;
use tokio::time::{Instant, sleep};

use super::{ClusterRun, HOSTS};
use crate::accounts::{AccountKey, BanTarget, Name};
use crate::admin::{AdminReply, AdminRequest, Target};
use crate::operator::Operator;
use crate::visitors::{Notice, Presence, VisitorRow};

/// Hosts with a visitor each, called `p0` and so on, and their operators.
struct Hosts {
    run: ClusterRun,
    operators: Vec<Operator>,
    visitors: Vec<Presence>,
}

impl Hosts {
    async fn start() -> Self {
        let run = ClusterRun::new(7);
        let (mut operators, mut visitors) = (Vec::new(), Vec::new());
        for (index, host) in run.hosts.iter().enumerate() {
            let (own, cluster) = (host.visitors.clone(), Some(host.shared.clone()));
            let operator = Operator::new(own, Vec::new, watch::Sender::default(), cluster);
            tokio::spawn(operator.clone().answer_others());
            operators.push(operator);
            let visitor = host.visitors.arrive(IpAddr::from([192, 0, 2, index as u8]), None);
            visitor.set_name(&format!("p{index}"));
            visitors.push(visitor);
        }
        sleep(Duration::from_secs(2)).await;
        Self { run, operators, visitors }
    }

    /// The answer to the operator of the first host.
    async fn answer(&self, request: AdminRequest) -> AdminReply {
        let asked_at = Instant::now();
        let reply = self.operators[0].answer(&request).await;
        assert!(asked_at.elapsed() < Duration::from_secs(4), "{:?}", asked_at.elapsed());
        reply
    }

    /// The names of the visitors with their hosts, and the remarks.
    async fn who(&self) -> (Vec<String>, Vec<String>) {
        let reply = self.answer(AdminRequest::Who).await;
        let who = |row: VisitorRow| format!("{} {}", row.name.unwrap(), row.host.unwrap());
        (reply.visitors.into_iter().map(who).collect(), reply.remarks)
    }
}

fn run(test: impl AsyncFnOnce(Hosts)) {
    let runtime = Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
    runtime.block_on(async { test(Hosts::start().await).await });
}

fn remove(name: &str) -> AdminRequest {
    let target = Target::Visitors(BanTarget::Name(Name::kept(name)));
    AdminRequest::Remove { target, reason: String::new(), banned: true, moderator: None }
}

#[test]
fn operators_see_and_reach_visitors_on_all_hosts() {
    run(async |mut hosts| {
        let everybody = ["p0 host:0", "p1 host:1", "p2 host:2"].map(str::to_owned).to_vec();
        assert_eq!(hosts.who().await, (everybody, vec![]));
        let say = AdminRequest::Say { text: "hello".to_owned() };
        assert_eq!(hosts.answer(say).await, AdminReply::of_count(HOSTS));
        for visitor in &mut hosts.visitors {
            assert_eq!(visitor.notice().await, Notice::Said("hello".to_owned()));
        }
        assert_eq!(hosts.answer(remove("P2")).await, AdminReply::of_count(1));
        assert!(matches!(hosts.visitors[2].notice().await, Notice::Removed(_)));
        // A faulty request is faulty on every host, so the first host does not ask the others.
        let say = AdminRequest::Say { text: "\u{1b}".to_owned() };
        let fault = hosts.operators[0].answer(&say).await;
        assert!(fault.fault.is_some(), "{fault:?}");
        // A drain ends only one host.
        assert_eq!(hosts.operators[0].answer(&AdminRequest::Drain).await, AdminReply::of_count(1));
    });
}

#[test]
fn the_host_list_includes_unresponsive_hosts() {
    run(async |hosts| {
        hosts.run.world.set(2, |link| link.is_cut = true);
        let AdminReply { hosts: rows, remarks, .. } = hosts.answer(AdminRequest::Hosts).await;
        assert_eq!(remarks, ["host host:2 did not answer"]);
        let shown: Vec<_> =
            rows.iter().map(|row| (row.host.as_str(), row.visitors, row.rooms.clone())).collect();
        let expected =
            [("host:0", 1, Some(vec![])), ("host:1", 1, Some(vec![])), ("host:2", 1, None)];
        assert_eq!(shown, expected);
        assert!(rows.iter().all(|row| row.seconds < 5 && row.address.ends_with(".org:2222")));
        // A host that has ended is no longer present.
        hosts.run.hosts[1].shared.end().await;
        sleep(Duration::from_secs(1)).await;
        hosts.run.world.set(2, |link| link.is_cut = false);
        let AdminReply { hosts: rows, remarks, .. } = hosts.answer(AdminRequest::Hosts).await;
        assert!(
            remarks.is_empty() && rows.iter().filter(|row| row.seconds < 5).count() == rows.len()
        );
    });
}

#[test]
fn operators_see_partial_results_without_the_bus_or_the_database() {
    run(async |hosts| {
        hosts.run.world.set(0, |link| link.has_no_database = true);
        let (rows, remarks) = hosts.who().await;
        assert_eq!((rows.len(), remarks.len()), (HOSTS, 1), "{remarks:?}");
        assert!(remarks[0].contains("the database did not list"), "{remarks:?}");
        hosts.run.world.set(0, |link| (link.has_no_database, link.is_cut) = (false, true));
        sleep(Duration::from_secs(2)).await;
        let (rows, remarks) = hosts.who().await;
        assert_eq!((rows.len(), remarks.len()), (1, HOSTS), "{remarks:?}");
        assert!(remarks[0].contains("the cluster's bus"), "{remarks:?}");
    });
}

#[test]
fn a_host_reply_limits_its_visitors_to_fit_in_a_message() {
    run(async |hosts| {
        let key = Some(AccountKey::new([255; 32]));
        let crowd: Vec<Presence> = (0..2_010)
            .map(|number| {
                let address = format!("2001:db8:ffff:ffff:ffff:ffff:ffff:{number:x}").parse();
                let visitor = hosts.run.hosts[1].visitors.arrive(address.unwrap(), key);
                visitor
                    .set_name("\u{4e00}\u{4e01}\u{4e02}\u{4e03}\u{4e04}\u{4e05}\u{4e06}\u{4e07}");
                visitor.set_room(Some("room 4294967295".to_owned()));
                visitor
            })
            .collect();
        let (rows, remarks) = hosts.who().await;
        assert_eq!(
            (rows.len(), remarks),
            (2_002, vec!["host host:1 has 11 more visitors".to_owned()])
        );
        let answer = serde_json::to_vec(&hosts.operators[1].answer(&AdminRequest::Who).await);
        let bytes = answer.unwrap().len();
        assert!(bytes < 1_000_000, "{bytes} bytes");
        drop(crowd);
    });
}

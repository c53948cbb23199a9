//! The answers of all hosts of a cluster as one.

use super::{AdminReply, HostInfo, VisitorRow};
use crate::cluster::{OtherHosts, SharedRooms};

/// The answer of this host with those of the others.
pub(crate) fn merged(cluster: &SharedRooms, own: AdminReply, others: OtherHosts) -> AdminReply {
    let OtherHosts { replies, silent, seconds, mut remarks } = others;
    let own_name = cluster.own_name().to_owned();
    let reply = match own {
        AdminReply::Count(count) => AdminReply::Count(count + counts(replies.into_values())),
        AdminReply::Visitors(rows) => {
            let rows = rows.into_iter().chain(visitors(replies.into_values()));
            AdminReply::Visitors(rows.collect())
        }
        AdminReply::Hosts(rows) => {
            let own = rows.into_iter().map(|row| (own_name.clone(), row));
            let others = replies.into_iter().flat_map(|(name, reply)| {
                hosts(reply).into_iter().map(move |row| (name.clone(), row))
            });
            let rows = own.chain(others).map(|(name, row)| {
                let seconds = seconds.get(&name).copied().unwrap_or_default();
                HostInfo { seconds, ..row }
            });
            let mut rows: Vec<HostInfo> = rows.chain(silent.into_values()).collect();
            rows.sort_by(|one, other| one.host.cmp(&other.host));
            let differences = rows.iter().filter_map(|row| cluster.map_difference(row));
            remarks.extend(differences);
            AdminReply::Hosts(rows)
        }
        other => other,
    };
    AdminReply::AllHosts { reply: Box::new(reply), remarks }
}

fn counts(replies: impl Iterator<Item = AdminReply>) -> usize {
    replies.map(|reply| if let AdminReply::Count(count) = reply { count } else { 0 }).sum()
}

fn visitors(replies: impl Iterator<Item = AdminReply>) -> impl Iterator<Item = VisitorRow> {
    replies.flat_map(|reply| match reply {
        AdminReply::Visitors(rows) => rows,
        _ => Vec::new(),
    })
}

fn hosts(reply: AdminReply) -> Vec<HostInfo> {
    if let AdminReply::Hosts(rows) = reply { rows } else { Vec::new() }
}

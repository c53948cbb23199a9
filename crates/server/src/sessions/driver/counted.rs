//! The limits of connections that hold on all hosts of a cluster together.

use super::Shared;
use super::account::NOT_KNOWN;
use crate::accounts::AccountKey;
use crate::cluster::{CountedVisit, NewVisit, VisitRefusal};
use crate::ops::logging::events;
use crate::ssh::{Departure, Visitor};

impl Shared {
    /// Counts a visitor on all hosts, or tells why they may not play, and how they depart.
    pub(crate) async fn begin_visit(
        &self,
        visitor: &Visitor,
        key: Option<AccountKey>,
    ) -> Result<Option<CountedVisit>, (String, Departure)> {
        let Some(rooms) = &self.cluster else { return Ok(None) };
        let limits = self.config.get().admission;
        let new_visit = NewVisit {
            key,
            per_key: limits.per_key,
            address: visitor.peer.ip(),
            per_address: limits.per_address,
        };
        rooms.visits().begin(new_visit).await.map(Some).map_err(|refusal| match refusal {
            VisitRefusal::TooMany(reason) => {
                let refusal = Some(reason);
                (reason.sentence(&limits), Departure { refusal, ..Departure::REFUSED })
            }
            VisitRefusal::NotNow(failure) => {
                self.metrics.store_errors.inc();
                events::store_failed(failure);
                (NOT_KNOWN.to_owned(), Departure::FAILED)
            }
        })
    }
}

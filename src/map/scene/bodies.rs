//! The bodies of a map, and how many there may be.
//!
//! Among bodies whose boxes overlap, no order makes the nearest one cheaper to find: a ray that meets
//! them is tested against each. The number of overlapping pairs is limited, and with it the number of
//! tests: 141 bodies in one place overlap in 9,870 pairs. A lower limit on the number of bodies was
//! refused, since a thousand bodies side by side take a few tests each.

use std::ops::Range;

use crate::fault::Fault;
use crate::space::Body;

/// The largest number of bodies.
const MOST_BODIES: usize = 1000;
/// The largest number of pairs of bodies that overlap.
const MOST_PAIRS: usize = 10_000;

/// The bodies of a map so far.
#[derive(Debug, Default)]
pub(crate) struct Bodies {
    list: Vec<Body>,
    pairs: usize,
}

impl Bodies {
    /// Adds `body`, which the map describes at `place`.
    ///
    /// # Errors
    /// The fault of a body that is one too many.
    pub(crate) fn add(&mut self, body: Body, place: Range<usize>) -> Result<(), Fault> {
        if self.list.len() == MOST_BODIES {
            return Err(Fault::new(place, format!("a map has {MOST_BODIES} bodies at most"))
                .label("this is one too many")
                .help("leave some out, or make two maps of it"));
        }
        let before = self.list.iter();
        self.pairs += before.filter(|other| other.shape.overlaps(&body.shape)).count();
        if self.pairs > MOST_PAIRS {
            let message = format!("more than {MOST_PAIRS} pairs of bodies overlap");
            return Err(Fault::new(place, message)
                .label("with this body")
                .help("leave out bodies that others hide, or move them apart"));
        }
        self.list.push(body);
        Ok(())
    }

    pub(crate) fn into_list(self) -> Vec<Body> {
        self.list
    }
}

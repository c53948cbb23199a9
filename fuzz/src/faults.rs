//! Checks that apply to all reports of faults.

use cellcaster::fault::Faults;

/// The largest number of bytes of a report, for each fault in it.
const MAX_BYTES: usize = 16 << 10;

/// Checks that there is a fault, and that its report is bounded.
pub(crate) fn check_faults(faults: &Faults) {
    assert!(faults.len() > 0, "refused without a fault");
    let length = faults.to_string().len();
    assert!(length <= MAX_BYTES * (1 + faults.len()), "a report of {length} bytes");
    assert!(!faults.summary().is_empty());
}

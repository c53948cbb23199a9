//! Sorting for code in which speed does not matter.
//!
//! The standard library's sort is compiled again for each type and each comparison, at seven kilobytes each.
//! This module compiles one sort, of indices, for all types. Collecting into a set or a map also compiles the
//! standard library's sort. Small collections are therefore filled item by item instead.

use std::cmp::Ordering;

/// Sorts `items` by `compare`. Equal items keep their order.
pub(crate) fn by<T>(items: &mut [T], compare: impl Fn(&T, &T) -> Ordering) {
    let order = order(items.len(), &|one, other| compare(&items[one], &items[other]));
    put_in_order(items, order);
}

/// Sorts `items` by their keys. Items with equal keys keep their order.
pub(crate) fn by_key<T, K: Ord>(items: &mut [T], key: impl Fn(&T) -> K) {
    by(items, |one, other| key(one).cmp(&key(other)));
}

/// Collects `items` one by one.
pub(crate) fn gathered<T, C: Default + Extend<T>>(items: impl IntoIterator<Item = T>) -> C {
    let mut gathered = C::default();
    gathered.extend(items);
    gathered
}

/// The indices of `count` items, sorted by `compare`, which compares two items by their indices.
fn order(count: usize, compare: &dyn Fn(usize, usize) -> Ordering) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_unstable_by(|&one, &other| compare(one, other).then(one.cmp(&other)));
    order
}

/// Moves the item at index `order[place]` to `place`, for each place.
fn put_in_order<T>(items: &mut [T], mut order: Vec<usize>) {
    for first in 0..items.len() {
        let mut place = first;
        while order[place] != first {
            let from = order[place];
            items.swap(place, from);
            order[place] = place;
            place = from;
        }
        order[place] = place;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn items_sort_as_in_the_standard_library(
            items in prop::collection::vec((0..9_u8, any::<u8>()), 0..50),
        ) {
            let (mut sorted, mut expected) = (items.clone(), items);
            by_key(&mut sorted, |item| item.0);
            expected.sort_by_key(|item| item.0);
            prop_assert_eq!(&sorted, &expected);
            by(&mut sorted, |one, other| other.cmp(one));
            expected.sort_by(|one, other| other.cmp(one));
            prop_assert_eq!(sorted, expected);
        }
    }
}

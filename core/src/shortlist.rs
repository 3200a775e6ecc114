//! The best few of many: bounded lists that stay sorted.

use heapless::Vec;

/// Inserts `item` into a list sorted by rising `key`, behind items with an equal key. A full list drops its last item; an
/// item that would come after that one is not inserted. Returns the place of `item`, `None` where it is not inserted.
pub fn keep<T, K: PartialOrd, const N: usize>(
    list: &mut Vec<T, N>,
    item: T,
    key: impl Fn(&T) -> K,
) -> Option<usize> {
    let own = key(&item);
    let place = list.partition_point(|other| key(other) <= own);
    if place == N {
        return None;
    }
    if list.is_full() {
        list.pop();
    }
    // There is room now, so the insertion cannot fail.
    list.insert(place, item).ok().map(|()| place)
}

/// The `N` items with the smallest keys, smallest first; of equals the first come first.
pub fn smallest<T, K: PartialOrd, const N: usize>(
    items: impl IntoIterator<Item = T>,
    key: impl Fn(&T) -> K,
) -> Vec<T, N> {
    let mut list = Vec::new();
    for item in items {
        keep(&mut list, item, &key);
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_smallest_are_the_head_of_the_sorted_list(
            keys in proptest::collection::vec(0u8..9, 0..40)
        ) {
            let items = keys.iter().copied().enumerate();
            let mut sorted: std::vec::Vec<(usize, u8)> = items.clone().collect();
            sorted.sort_by_key(|&(_, key)| key);
            sorted.truncate(7);
            let kept: Vec<(usize, u8), 7> = smallest(items, |&(_, key)| key);
            prop_assert_eq!(&kept[..], &sorted[..]);
        }
    }
}

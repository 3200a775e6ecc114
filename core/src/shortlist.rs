//! The best few of many: bounded lists that stay sorted.

use core::mem::swap;

use heapless::{Vec, VecView};

/// Inserts `item` into a list sorted by rising `key`, behind items with an equal key. A full list drops its last item; an
/// item that would come after that one is not inserted. Returns the place of `item`, `None` where it is not inserted.
pub fn keep<T, K: PartialOrd>(
    list: &mut VecView<T>,
    item: T,
    key: impl Fn(&T) -> K,
) -> Option<usize> {
    let own = key(&item);
    let place = list.partition_point(|other| key(other) <= own);
    if list.is_full() {
        if place == list.len() {
            return None;
        }
        list.pop();
    }
    // There is room now. The last goes before all that are to come behind it.
    list.push(item).ok()?;
    if let Some((first, rest)) = list.get_mut(place..)?.split_first_mut() {
        for other in rest {
            swap(first, other);
        }
    }
    Some(place)
}

/// Takes the item at a place out of a list, whose others stay in order; nothing where there is none.
pub fn take_out<T, const N: usize>(list: &mut Vec<T, N>, place: usize) -> Option<T> {
    let (last, rest) = list.get_mut(place..)?.split_last_mut()?;
    for other in rest.iter_mut().rev() {
        swap(last, other);
    }
    list.pop()
}

/// The first items, as many as there is room for.
pub fn first_of<T, const N: usize>(items: impl IntoIterator<Item = T>) -> Vec<T, N> {
    let mut list = Vec::new();
    for item in items {
        if list.push(item).is_err() {
            break;
        }
    }
    list
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

    properties! {
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

    #[test]
    fn what_is_taken_out_leaves_the_others_in_order() {
        for place in 0..6 {
            let mut list: Vec<usize, 5> = first_of(0..9);
            assert_eq!(list, [0, 1, 2, 3, 4]);
            let taken = take_out(&mut list, place);
            assert_eq!(taken, (place < 5).then_some(place));
            assert!(list.iter().copied().eq((0..5).filter(|&k| k != place)));
        }
    }
}

//! Borrowed working memory, and the one error for too little of it.

use thiserror::Error;

/// A borrowed slice is too short. A longer one is never an error.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{needed} {what} are needed as working memory but {given} were given")]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct TooLittleMemory {
    /// What the slice holds, in the plural.
    pub what: &'static str,
    /// The length that is needed.
    pub needed: usize,
    /// The length that was given.
    pub given: usize,
}

/// Refuses a length that is too short.
///
/// # Errors
/// [`TooLittleMemory`] with these numbers.
pub fn check_length(
    what: &'static str,
    needed: usize,
    given: usize,
) -> Result<(), TooLittleMemory> {
    if given >= needed {
        return Ok(());
    }
    Err(TooLittleMemory {
        what,
        needed,
        given,
    })
}

/// The first `needed` of a slice.
///
/// # Errors
/// [`TooLittleMemory`] where there are fewer.
pub fn first<'m, T>(
    what: &'static str,
    needed: usize,
    memory: &'m mut [T],
) -> Result<&'m mut [T], TooLittleMemory> {
    let given = memory.len();
    memory.get_mut(..needed).ok_or(TooLittleMemory {
        what,
        needed,
        given,
    })
}

/// Makes room for `needed` values at least of working memory, of which nothing stays where it has to be made: the old is let go of before as much
/// as is needed is asked for, so that there are never two, and none is larger than that.
#[cfg(feature = "alloc")]
pub fn grow<T: Clone + Default>(room: &mut alloc::vec::Vec<T>, needed: usize) {
    if needed > room.len() {
        *room = alloc::vec::Vec::new();
        room.reserve_exact(needed);
        room.resize(needed, T::default());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(feature = "alloc")]
    #[test]
    fn memory_that_grows_is_as_long_as_it_has_to_be() {
        let mut room: std::vec::Vec<u8> = std::vec::Vec::new();
        for needed in [5, 100, 101, 7] {
            grow(&mut room, needed);
            let least = needed.max(if needed == 7 { 101 } else { 0 });
            assert_eq!([room.len(), room.capacity()], [least; 2]);
        }
    }

    #[test]
    fn what_is_too_short_is_named() {
        let short = check_length("words", 8, 7).expect_err("too short");
        assert_eq!(
            std::format!("{short}"),
            "8 words are needed as working memory but 7 were given"
        );
        assert_eq!(check_length("words", 8, 9), Ok(()));
        let mut room = [1, 2, 3];
        assert_eq!(first("words", 2, &mut room), Ok(&mut [1, 2][..]));
        assert!(first("words", 4, &mut room).is_err());
    }
}

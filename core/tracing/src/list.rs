//! A list in borrowed memory.

use crate::error::TracingError;

/// Elements at the beginning of a borrowed slice.
#[derive(Debug)]
pub struct List<'a, T> {
    places: &'a mut [T],
    used: usize,
}

impl<'a, T: Copy> List<'a, T> {
    /// An empty list with as many places as `places` has.
    #[must_use]
    pub fn new(places: &'a mut [T]) -> Self {
        Self { places, used: 0 }
    }

    /// Puts an element at the end.
    ///
    /// # Errors
    /// [`TracingError::TooLong`] where all places are taken.
    pub fn push(&mut self, element: T) -> Result<(), TracingError> {
        let most = self.places.len();
        let place = self.places.get_mut(self.used);
        *place.ok_or(TracingError::TooLong(most))? = element;
        self.used += 1;
        Ok(())
    }

    /// Leaves only the first `length` elements.
    pub fn truncate(&mut self, length: usize) {
        self.used = self.used.min(length);
    }

    /// Leaves nothing.
    pub fn clear(&mut self) {
        self.used = 0;
    }

    /// The elements.
    #[must_use]
    pub fn as_slice(&self) -> &[T] {
        self.places.get(..self.used).unwrap_or_default()
    }

    /// The elements, to be changed.
    #[must_use]
    pub fn as_mut_slice(&mut self) -> &mut [T] {
        self.places.get_mut(..self.used).unwrap_or_default()
    }

    /// The elements, for as long as the memory is borrowed.
    #[must_use]
    pub fn into_slice(self) -> &'a mut [T] {
        self.places.get_mut(..self.used).unwrap_or_default()
    }

    /// Number of elements.
    #[must_use]
    pub fn len(&self) -> usize {
        self.used
    }

    /// Whether there is no element.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.used == 0
    }

    /// Keeps the elements for which `keep` is true, in their order.
    pub fn retain(&mut self, mut keep: impl FnMut(&T) -> bool) {
        let mut kept = 0;
        for at in 0..self.used {
            let element = self.places[at];
            if keep(&element) {
                self.places[kept] = element;
                kept += 1;
            }
        }
        self.used = kept;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_is_no_longer_than_its_memory() {
        let mut places = [0; 3];
        let mut list = List::new(&mut places);
        for k in 1..=3 {
            assert_eq!(list.push(k), Ok(()));
        }
        assert_eq!(list.push(4), Err(TracingError::TooLong(3)));
        list.retain(|k| k % 2 == 1);
        assert_eq!(list.as_slice(), [1, 3]);
        list.truncate(1);
        assert_eq!((list.len(), list.is_empty()), (1, false));
        list.clear();
        assert!(list.into_slice().is_empty());
    }
}

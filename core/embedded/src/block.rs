//! One piece of borrowed memory, cut into what is worked in.
#![expect(
    unsafe_code,
    reason = "memory that comes as bytes is made a list of other values by its address alone"
)]

use core::mem::MaybeUninit;
use core::slice;

/// What every address in a block is a multiple of.
pub(crate) type Unit = u64;

/// Memory that was not handed out yet.
pub(crate) struct Block<'m> {
    rest: &'m mut [MaybeUninit<Unit>],
}

impl<'m> Block<'m> {
    pub(crate) fn new(memory: &'m mut [MaybeUninit<Unit>]) -> Self {
        Self { rest: memory }
    }

    /// The next units, as they are.
    fn units(&mut self, count: usize) -> Option<&'m mut [MaybeUninit<Unit>]> {
        let (own, rest) = core::mem::take(&mut self.rest).split_at_mut_checked(count)?;
        self.rest = rest;
        Some(own)
    }

    /// A value; it is never dropped.
    pub(crate) fn put<T>(&mut self, make: fn() -> T) -> Option<&'m mut T> {
        const { assert!(align_of::<T>() <= align_of::<Unit>()) };
        let place = self.units(units_for::<T>(1)?)?.as_mut_ptr();
        // SAFETY: there is room for it by `units_for`, at a place that suits it by the assertion; nothing else reaches the units,
        // which were split off for as long as 'm lasts.
        let place = unsafe { &mut *place.cast::<MaybeUninit<T>>() };
        Some(made(place, make))
    }

    /// A list of `count` values, all of them `fill`; `None` where there is too little left.
    pub(crate) fn take<T: Copy>(&mut self, count: usize, fill: T) -> Option<&'m mut [T]> {
        const { assert!(align_of::<T>() <= align_of::<Unit>()) };
        let first = self.units(units_for::<T>(count)?)?.as_mut_ptr().cast::<T>();
        for number in 0..count {
            // SAFETY: there is room for `count` values by `units_for`, at a place that suits them by the assertion above.
            unsafe { first.add(number).write(fill) };
        }
        // SAFETY: all `count` values were written; nothing else reaches the units, which were split off for as long as 'm lasts.
        Some(unsafe { slice::from_raw_parts_mut(first, count) })
    }
}

/// Makes a value where it stays: by itself, so that the compiler need not make it on the stack and move it.
#[inline(never)]
fn made<T>(place: &mut MaybeUninit<T>, make: fn() -> T) -> &mut T {
    place.write(make())
}

/// How many units hold `count` values.
pub(crate) fn units_for<T>(count: usize) -> Option<usize> {
    let bytes = size_of::<T>().checked_mul(count)?;
    Some(bytes.div_ceil(size_of::<Unit>()))
}

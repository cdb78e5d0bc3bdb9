//! Writing to distinct elements of one slice from several threads.

use std::marker::PhantomData;

/// A slice whose elements several threads write, each element by at most one of them.
pub struct Scatter<'a, T> {
    pointer: *mut T,
    length: usize,
    slice: PhantomData<&'a mut [T]>,
}

// SAFETY: `slot` is unsafe, and its contract forbids two threads at one element.
unsafe impl<T: Send> Sync for Scatter<'_, T> {}

impl<'a, T> Scatter<'a, T> {
    /// Borrows a slice for scattered writes.
    pub fn new(slice: &'a mut [T]) -> Self {
        Self {
            pointer: slice.as_mut_ptr(),
            length: slice.len(),
            slice: PhantomData,
        }
    }

    /// True if there are no elements.
    #[inline(always)]
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Element `index`.
    ///
    /// # Safety
    /// While the reference lives, nobody else may ask for the same `index`.
    ///
    /// # Panics
    /// If `index` is out of range.
    #[inline(always)]
    #[allow(clippy::mut_from_ref, reason = "the contract of this type")]
    #[must_use]
    pub unsafe fn slot(&self, index: usize) -> &mut T {
        assert!(index < self.length, "element {index} of {}", self.length);
        // SAFETY: in range, and unique by this function's contract.
        unsafe { &mut *self.pointer.add(index) }
    }

    /// The value of element `index`.
    ///
    /// # Safety
    /// Nobody may write it meanwhile.
    ///
    /// # Panics
    /// If `index` is out of range.
    #[inline(always)]
    #[must_use]
    pub unsafe fn read(&self, index: usize) -> T
    where
        T: Copy,
    {
        assert!(index < self.length, "element {index} of {}", self.length);
        // SAFETY: in range, and at rest by this function's contract.
        unsafe { self.pointer.add(index).read() }
    }
}

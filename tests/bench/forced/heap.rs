//! The greatest memory in use, by an allocator that counts.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicIsize, Ordering};

struct Counting;

static IN_USE: AtomicIsize = AtomicIsize::new(0);
static GREATEST: AtomicIsize = AtomicIsize::new(0);

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn changed(bytes: isize) {
    let now = IN_USE.fetch_add(bytes, Ordering::Relaxed) + bytes;
    GREATEST.fetch_max(now, Ordering::Relaxed);
}

#[allow(unsafe_code)] // SAFETY: all is done by the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        changed(layout.size().cast_signed());
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        changed(-layout.size().cast_signed());
        unsafe { System.dealloc(place, layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        changed(size.cast_signed() - layout.size().cast_signed());
        unsafe { System.realloc(place, layout, size) }
    }
}

/// Counts from here on.
pub fn begin() {
    IN_USE.store(0, Ordering::Relaxed);
    GREATEST.store(0, Ordering::Relaxed);
}

/// Bytes that are in use beyond what was at [`begin`]; below zero where more has been freed.
#[allow(dead_code)] // Each crate that has this file uses a part of it.
pub fn in_use() -> isize {
    IN_USE.load(Ordering::Relaxed)
}

/// Bytes that were in use at once since [`begin`], beyond what was then.
pub fn greatest() -> usize {
    GREATEST.load(Ordering::Relaxed).cast_unsigned()
}

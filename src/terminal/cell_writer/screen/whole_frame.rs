//! Whole frames: the targets begin blank, and those before them tell which rows have changed.

use std::cell;

use super::super::packed_cell::PackedCell;
use super::Screen;
use crate::terminal::thread_memory;

thread_local! {
    /// The memory of the targets before a frame.
    static BEFORE: cell::Cell<Vec<PackedCell>> = const { cell::Cell::new(Vec::new()) };
}

impl Screen {
    /// Begins a whole frame, with blank targets.
    pub(crate) fn begin_frame(&mut self) {
        self.targets_before = thread_memory::take(&BEFORE);
        let (count, capacity) = (self.targets.len(), self.targets.capacity());
        if self.targets_before.capacity() != capacity {
            self.targets_before = Vec::with_capacity(capacity);
        }
        std::mem::swap(&mut self.targets, &mut self.targets_before);
        self.targets.clear();
        self.targets.resize(count, PackedCell::BLANK);
    }

    /// Ends a whole frame: rows whose targets differ from those before it have changed.
    pub(crate) fn end_frame(&mut self) {
        let width = self.width.max(1);
        let rows = self.targets.chunks(width).zip(self.targets_before.chunks(width));
        for (changed, (targets, before)) in self.changed.iter_mut().zip(rows) {
            *changed |= targets != before;
        }
        thread_memory::put_back(&BEFORE, std::mem::take(&mut self.targets_before));
    }
}

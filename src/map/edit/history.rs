//! The history of a text: every step can be undone and done again.

use std::collections::VecDeque;

/// The bytes that all steps together may hold. The oldest steps are forgotten above it. Drawing a cell takes two bytes,
/// so a level can be drawn many times over.
const MAX_BYTES: usize = 64 << 20;

/// The steps that led to a text, and the steps that were undone.
#[derive(Clone, Debug, Default)]
pub(crate) struct History {
    done: VecDeque<Replacement>,
    undone: Vec<Replacement>,
    /// The bytes of the steps in `done`.
    bytes: usize,
}

/// The one range in which two texts differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Replacement {
    /// The first byte.
    at: usize,
    old: String,
    new: String,
}

impl History {
    /// Adds the step from `old` to `new`. If it `joins`, both the last step and this one become one step.
    pub(crate) fn push(&mut self, old: &str, new: &str, joins: bool) {
        self.undone.clear();
        let last = if joins { self.pop() } else { None };
        let step = match last {
            Some(last) => Replacement::between(&last.undone_in(old), new),
            None => Replacement::between(old, new),
        };
        self.bytes += step.size();
        self.done.push_back(step);
        while self.bytes > MAX_BYTES && self.done.len() > 1 {
            self.bytes -= self.done.pop_front().map_or(0, |oldest| oldest.size());
        }
    }

    /// The text before the last step, and the first byte that differs.
    pub(crate) fn undo(&mut self, text: &str) -> Option<(String, usize)> {
        let step = self.pop()?;
        let (before, at) = (step.undone_in(text), step.at);
        self.undone.push(step);
        Some((before, at))
    }

    /// The text after the step that was undone last, and the first byte that differs.
    pub(crate) fn redo(&mut self, text: &str) -> Option<(String, usize)> {
        let step = self.undone.pop()?;
        let (after, at) = (step.done_in(text), step.at);
        self.bytes += step.size();
        self.done.push_back(step);
        Some((after, at))
    }

    fn pop(&mut self) -> Option<Replacement> {
        let step = self.done.pop_back()?;
        self.bytes -= step.size();
        Some(step)
    }
}

impl Replacement {
    /// The replacement that makes `new` of `old`.
    fn between(old: &str, new: &str) -> Self {
        let (head, tail) = common_ends(old, new);
        let middle = |text: &str| text[head..text.len() - tail].to_owned();
        Self { at: head, old: middle(old), new: middle(new) }
    }

    fn done_in(&self, text: &str) -> String {
        with_replaced(text, self.at, self.old.len(), &self.new)
    }

    fn undone_in(&self, text: &str) -> String {
        with_replaced(text, self.at, self.new.len(), &self.old)
    }

    fn size(&self) -> usize {
        size_of::<Self>() + self.old.len() + self.new.len()
    }
}

fn with_replaced(text: &str, at: usize, length: usize, by: &str) -> String {
    [&text[..at], by, &text[at + length..]].concat()
}

/// The numbers of bytes that two texts have in common at the beginning and, after these, at the end. Both are whole
/// characters.
pub(crate) fn common_ends(one: &str, other: &str) -> (usize, usize) {
    let shorter = one.len().min(other.len());
    let mut head = one.bytes().zip(other.bytes()).take_while(|(a, b)| a == b).count();
    while !one.is_char_boundary(head) {
        head -= 1;
    }
    let from_end = one.bytes().rev().zip(other.bytes().rev()).take(shorter - head);
    let mut tail = from_end.take_while(|(a, b)| a == b).count();
    while !one.is_char_boundary(one.len() - tail) {
        tail -= 1;
    }
    (head, tail)
}

//! Frames and requests that have not been answered.

use std::collections::VecDeque;
use std::time::Duration;

/// A request to the terminal, after a frame or alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Request {
    /// None: the terminal does not answer.
    Nothing,
    /// For its status.
    Status,
    /// For its attributes, which every terminal answers.
    Fence,
}

/// A frame that was sent, or a request alone, of no bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sent {
    pub(super) at: Duration,
    pub(super) bytes: usize,
    pub(super) request: Request,
}

/// What was sent and not answered, oldest first.
#[derive(Debug, Default)]
pub(super) struct InFlight(VecDeque<Sent>);

impl InFlight {
    pub(super) fn push(&mut self, sent: Sent) {
        self.0.push_back(sent);
    }

    pub(super) fn oldest(&self) -> Option<Sent> {
        self.0.front().copied()
    }

    /// Removes the oldest.
    pub(super) fn pop(&mut self) {
        self.0.pop_front();
    }

    /// Removes the fences that are older than all else.
    pub(super) fn pop_fences(&mut self) {
        while self.oldest().is_some_and(|sent| sent.request == Request::Fence) {
            self.pop();
        }
    }

    /// How many are older than the oldest fence; `None` where there is no fence.
    pub(super) fn before_fence(&self) -> Option<usize> {
        self.0.iter().position(|sent| sent.request == Request::Fence)
    }

    /// Removes the oldest fence and all before it; returns the fence.
    pub(super) fn pop_through_fence(&mut self) -> Option<Sent> {
        let place = self.before_fence()?;
        self.0.drain(..=place).next_back()
    }

    /// Removes all.
    pub(super) fn drain(&mut self) -> impl Iterator<Item = Sent> {
        self.0.drain(..)
    }

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(super) fn len(&self) -> usize {
        self.0.len()
    }

    /// How many are frames.
    pub(super) fn frames(&self) -> usize {
        self.0.iter().filter(|sent| sent.bytes > 0).count()
    }

    pub(super) fn bytes(&self) -> usize {
        self.0.iter().map(|sent| sent.bytes).sum()
    }
}

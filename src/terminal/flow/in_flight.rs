//! Unanswered frames and requests.

use std::collections::VecDeque;
use std::time::Duration;

/// A request to the terminal, after a frame or alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Request {
    /// No request, since the terminal does not answer.
    Nothing,
    /// A request for the terminal's status.
    Status,
    /// A request for the terminal's attributes, which every terminal answers.
    Fence,
}

/// A sent frame, or a request alone, which counts 0 bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sent {
    pub(crate) at: Duration,
    pub(crate) bytes: usize,
    pub(crate) request: Request,
}

/// The unanswered frames and requests, oldest first.
#[derive(Debug, Default)]
pub(crate) struct InFlight(VecDeque<Sent>);

impl InFlight {
    pub(crate) fn push(&mut self, sent: Sent) {
        self.0.push_back(sent);
    }

    pub(crate) fn oldest(&self) -> Option<Sent> {
        self.0.front().copied()
    }

    /// Removes the oldest entry.
    pub(crate) fn pop(&mut self) {
        self.0.pop_front();
    }

    /// Removes the fences at the front.
    pub(crate) fn pop_fences(&mut self) {
        while self.oldest().is_some_and(|sent| sent.request == Request::Fence) {
            self.pop();
        }
    }

    /// The number of entries before the oldest fence; `None` if there is no fence.
    pub(crate) fn before_fence(&self) -> Option<usize> {
        self.0.iter().position(|sent| sent.request == Request::Fence)
    }

    /// Removes the oldest fence and all entries before it; returns the fence.
    pub(crate) fn pop_through_fence(&mut self) -> Option<Sent> {
        let place = self.before_fence()?;
        self.0.drain(..=place).next_back()
    }

    /// Removes all entries.
    pub(crate) fn drain(&mut self) -> impl Iterator<Item = Sent> {
        self.0.drain(..)
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// The number of frames.
    pub(crate) fn frames(&self) -> usize {
        self.0.iter().filter(|sent| sent.bytes > 0).count()
    }

    pub(crate) fn bytes(&self) -> usize {
        self.0.iter().map(|sent| sent.bytes).sum()
    }
}

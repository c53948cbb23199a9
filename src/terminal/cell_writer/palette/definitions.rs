//! The choice of colours for entries of the palette.

use super::super::bytes::Bytes;
use super::super::ink::{Ink, Price};
use super::super::packed_cell::PackedCell;
use super::super::screen::Screen;
use super::super::style::{Kind, Shade, Style};
use super::{Count, Palette, entry_place, place};
use crate::color::lab::PackedLab;
use crate::terminal::sequence;

/// The approximate number of bytes that a use of an entry saves.
const SPARED: f32 = 8.0;
/// The number of half cells in a frame that must use a colour for it to be defined: in an exact
/// frame, and in an inexact one, where most of them are kept. In the latter, the savings must be as
/// large as those of this number of full uses.
const LEAST_USES: f32 = 2.0;
const LEAST_USES_INEXACT: f32 = 4.0;
/// The number of definitions in one sequence: some terminals accept at most sixteen parameters.
const AT_ONCE: usize = 7;

impl Palette {
    /// Begins a frame, on a terminal with this `style`: counts the shown colours and the targets'
    /// colours, row by row, and defines the frequent ones.
    ///
    /// Returns the definitions, if there are any. The caller must give them back with
    /// [`Palette::keep`].
    pub(crate) fn begin_frame(
        &mut self,
        screen: &Screen,
        style: Option<Style>,
        price: Option<Price>,
    ) -> Option<Bytes> {
        if !self.is_on || self.quantizer.is_some() {
            return None;
        }
        self.frame += 1;
        self.is_shown.fill(false);
        for count in &mut self.counts {
            count.count /= 2;
        }
        let told = style.map(|style| [style.foreground, style.background]);
        told.into_iter().flatten().for_each(|shade| self.note_shown(shade));
        for style in screen.intricate_styles() {
            self.note_shown(style.foreground);
            self.note_shown(style.background);
        }
        for (shown, targets) in screen.rows() {
            let mut last = PackedCell::UNKNOWN;
            for (&shown, &target) in shown.iter().zip(targets) {
                if shown != last {
                    shown.colors().into_iter().for_each(|shade| self.note_shown(shade));
                    last = shown;
                }
                if shown != target {
                    target.colors().into_iter().for_each(|shade| self.note_wanted(shade));
                }
            }
        }
        let mut definitions = std::mem::take(&mut self.definitions);
        definitions.clear();
        self.define_frequent(price, &mut definitions);
        if definitions.is_empty() {
            self.definitions = definitions;
            return None;
        }
        Some(definitions)
    }

    /// Keeps the memory of definitions for the next ones.
    pub(crate) fn keep(&mut self, definitions: Bytes) {
        self.definitions = definitions;
    }

    #[inline]
    fn note_shown(&mut self, shade: Shade) {
        if let Some(entry) = self.entry(shade) {
            self.is_shown[usize::from(entry)] = true;
        }
    }

    #[inline]
    fn note_wanted(&mut self, shade: Shade) {
        if let Some(entry) = self.entry(shade) {
            self.wanted_at[usize::from(entry)] = self.frame;
            return;
        }
        let known = &mut self.counts[place(shade)];
        if known.shade == shade {
            known.count = known.count.saturating_add(2);
        } else if known.count < 2 {
            *known = Count { shade, count: 2 };
        } else {
            known.count -= 1;
        }
    }

    /// Whether the definition of a colour with this number of uses saves more bytes than it takes,
    /// compared with the entry that is now nearest to the colour.
    fn is_worth_defining(&mut self, Count { shade, count }: Count, price: Option<Price>) -> bool {
        let Kind::Rgb(channels) = shade.kind() else { return false };
        // Each unit is half a use.
        let uses = f32::from(count) * 0.5;
        let Some(price) = price else { return uses >= LEAST_USES };
        if uses < LEAST_USES_INEXACT {
            return false;
        }
        let wanted = Ink { lab: PackedLab::of(channels).components(), shade };
        let spared = self.nearest(wanted).map_or(SPARED, |near| {
            let near = self.ink(near);
            price.of(near, wanted).min(SPARED)
        });
        uses * spared >= LEAST_USES_INEXACT * SPARED
    }

    /// Defines the most frequent colours, as far as that saves bytes and there are free entries.
    fn define_frequent(&mut self, price: Option<Price>, bytes: &mut Bytes) {
        let mut frequent = std::mem::take(&mut self.frequent);
        frequent.clear();
        for index in 0..self.counts.len() {
            let count = self.counts[index];
            if count.count >= 2 && self.is_worth_defining(count, price) {
                frequent.push(count);
            }
        }
        self.frequent = frequent;
        if self.frequent.is_empty() {
            return;
        }
        let (is_shown, wanted_at, frame) = (&self.is_shown, &self.wanted_at, self.frame);
        let is_free =
            |entry: &u8| !is_shown[usize::from(*entry)] && wanted_at[usize::from(*entry)] < frame;
        self.free.clear();
        self.free.extend(sequence::PALETTE.filter(is_free));
        self.free.sort_unstable_by_key(|&entry| (wanted_at[usize::from(entry)], entry));
        self.frequent.sort_unstable_by_key(|count| (u16::MAX - count.count, count.shade.in_bits()));
        let (entries, colors, is_shown) = (&self.entries, &self.colors, &self.is_shown);
        // Each place refers to one entry; while that is shown, it must not be replaced.
        let is_told_of = |shade: Shade| {
            let entry = usize::from(entries[entry_place(shade)]);
            is_shown[entry] && colors[entry] != Shade::DEFAULT
        };
        self.frequent.retain(|count| !is_told_of(count.shade));
        let definitions = self.free.len().min(self.frequent.len());
        let mut sent = Definitions::begin(bytes);
        for at in 0..definitions {
            let (entry, Count { shade, .. }) = (self.free[at], self.frequent[at]);
            let Kind::Rgb(channels) = shade.kind() else { continue };
            sent.push(entry, channels);
            self.define(entry, shade, channels);
        }
        sent.end();
    }

    fn define(&mut self, entry: u8, shade: Shade, channels: [u8; 3]) {
        // The previous entry at this place can no longer be found.
        let forgotten = usize::from(self.entries[entry_place(shade)]);
        if entry_place(self.colors[forgotten]) == entry_place(shade) {
            self.colors[forgotten] = Shade::DEFAULT;
            self.labs.iter_mut().for_each(|labs| labs[forgotten] = 1e9);
        }
        let index = usize::from(entry);
        self.colors[index] = shade;
        for (labs, component) in self.labs.iter_mut().zip(PackedLab::of(channels).components()) {
            labs[index] = component;
        }
        self.entries[entry_place(shade)] = entry;
        self.wanted_at[index] = self.frame;
        self.counts[place(shade)] = Count { shade: Shade::DEFAULT, count: 0 };
    }
}

/// Writes definitions of entries, several in each sequence.
pub(crate) struct Definitions<'a> {
    bytes: &'a mut Bytes,
    count: usize,
}

impl<'a> Definitions<'a> {
    pub(crate) fn begin(bytes: &'a mut Bytes) -> Self {
        Self { bytes, count: 0 }
    }

    pub(crate) fn push(&mut self, entry: u8, channels: [u8; 3]) {
        if self.count.is_multiple_of(AT_ONCE) {
            self.end_sequence();
            self.bytes.push_text(b"\x1b]4");
        }
        self.count += 1;
        push_definition(entry, channels, self.bytes);
    }

    pub(crate) fn end(mut self) {
        self.end_sequence();
    }

    fn end_sequence(&mut self) {
        if self.count > 0 {
            self.bytes.push_text(b"\x07");
        }
    }
}

/// `;n;#rrggbb`.
fn push_definition(entry: u8, channels: [u8; 3], bytes: &mut Bytes) {
    const DIGITS: &[u8; 16] = b"0123456789abcdef";
    let decimal = [b'0' + entry / 100, b'0' + entry / 10 % 10, b'0' + entry % 10];
    let digits = &decimal[usize::from(entry < 100)..];
    bytes.push_text(b";");
    bytes.push_text(digits);
    bytes.push_text(b";#");
    for channel in channels {
        bytes.push_text(&[channel >> 4, channel & 15].map(|digit| DIGITS[usize::from(digit)]));
    }
}

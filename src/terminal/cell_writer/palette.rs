//! Frequent colours as entries of the terminal's palette.
//!
//! A colour takes up to sixteen bytes as parameters, and an entry of the palette eight at most. So frequent
//! colours are defined as entries (OSC 4) before they are used. An entry is defined anew only where no
//! cell shows its colour, nor does the terminal draw in it: what is on the screen never changes with it.
//!
//! Whether a cell was told its colour as an entry is not noted down: what shows an entry's colour counts
//! as showing the entry, which needs no memory for each cell, and is never wrong.

use super::bytes::Bytes;
use super::ink::{Ink, Price};
use super::lab::Lab;
use super::look::Look;
use super::screen::Screen;
use super::style::{Kind, Shade, Style};
use crate::terminal::sequence;

/// What the terminal's palette holds, as far as it was defined here.
#[derive(Debug)]
pub(super) struct Palette {
    /// Whether it may be defined.
    is_on: bool,
    /// The colour of each entry; the terminal's own for those that have not been defined.
    colors: Vec<Shade>,
    /// Where those lie in L\*a\*b\*, component by component.
    labs: [Vec<f32>; 3],
    /// The entry that may hold a colour, by the hash of it. Of two colours with one hash, one has an entry.
    entries: Vec<u8>,
    /// How often colours were wanted of late that no entry holds, by the hash.
    counts: Vec<Count>,
    /// The entry that is nearest to a colour, by the hash of that.
    nearest: Vec<Near>,
    /// The number of the frame.
    frame: u32,
    /// In which frame an entry's colour was wanted last.
    wanted_at: Vec<u32>,
    /// Whether a cell shows an entry's colour.
    is_shown: Vec<bool>,
    frequent: Vec<Count>,
    free: Vec<u8>,
    definitions: Bytes,
}

/// How often a colour was wanted of late; the older, the less it counts.
#[derive(Clone, Copy, Debug)]
struct Count {
    shade: Shade,
    count: u16,
}

/// What was found nearest to a colour, and when.
#[derive(Clone, Copy, Debug)]
struct Near {
    shade: Shade,
    color: Shade,
    entry: u8,
    found_at: u32,
}

/// A colour that may be told for another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Telling {
    pub(super) ink: Ink,
    /// As parameters.
    pub(super) bytes: f32,
    /// What it is worth, in bytes, that it is off.
    pub(super) error: f32,
}

impl Telling {
    /// Both.
    #[inline]
    pub(super) fn cost(self) -> f32 {
        self.bytes + self.error
    }
}

const ENTRIES: usize = 256;
/// So many bits of a hash tell where the entry of a colour is looked up, and where all else.
const ENTRY_PLACE_BITS: u32 = 13;
const PLACE_BITS: u32 = 11;
/// About how many bytes a use of an entry spares.
const SPARED: f32 = 8.0;
/// A colour is defined that was wanted by so many halves of cells, in a frame that is exact; and in one that
/// is not, where most of them are left as they are, where it spares as much as so many.
const LEAST_USES: f32 = 2.0;
const LEAST_USES_INEXACT: f32 = 4.0;
/// For so many frames, what was found nearest is not looked for anew.
const KNOWN_FOR: u32 = 8;
/// So many definitions are in one sequence: there are terminals that take sixteen parameters at most.
const AT_ONCE: usize = 7;

impl Palette {
    /// Whether entries may be defined from now on. What was defined before is forgotten.
    pub(super) fn set_on(&mut self, is_on: bool) {
        *self = Self { is_on, ..Self::default() };
    }

    /// Whether entries may be defined.
    pub(super) fn is_on(&self) -> bool {
        self.is_on
    }

    /// As [`Palette::set_on`], as it is.
    pub(super) fn forget(&mut self) {
        self.set_on(self.is_on);
    }

    /// The entry that holds a colour.
    #[inline]
    fn entry(&self, shade: Shade) -> Option<u8> {
        let entry = self.entries[entry_place(shade)];
        (self.colors[usize::from(entry)] == shade && shade != Shade::DEFAULT).then_some(entry)
    }

    /// How a colour is told to the terminal.
    #[inline]
    pub(super) fn told(&self, shade: Shade) -> Shade {
        if self.is_on { self.entry_or_itself(shade) } else { shade }
    }

    fn entry_or_itself(&self, shade: Shade) -> Shade {
        match shade.kind() {
            // It may have been defined to be another.
            Kind::Indexed(index @ 16..) => Shade::rgb(standard(index)),
            _ => self.entry(shade).map_or(shade, Shade::indexed),
        }
    }

    /// What is best told for `wanted`.
    #[inline]
    pub(super) fn telling(&mut self, wanted: Ink, price: Price) -> Telling {
        let exact = Telling { ink: wanted, bytes: wanted.bytes(), error: 0.0 };
        if self.is_on { self.best_telling(exact, price) } else { exact }
    }

    fn best_telling(&mut self, exact: Telling, price: Price) -> Telling {
        let wanted = exact.ink;
        if let Some(entry) = self.entry(wanted.shade) {
            return Telling { bytes: Shade::indexed(entry).bytes() as f32, ..exact };
        }
        let Some(near) = self.nearest(wanted) else { return exact };
        let ink = self.ink(near);
        let bytes = Shade::indexed(near).bytes() as f32;
        let error = price.of(ink, wanted);
        if bytes + error < exact.bytes { Telling { ink, bytes, error } } else { exact }
    }

    /// An entry that was the nearest to a colour of late.
    fn nearest(&mut self, wanted: Ink) -> Option<u8> {
        let place = place(wanted.shade);
        let known = self.nearest[place];
        let is_known = known.shade == wanted.shade
            && self.frame - known.found_at < KNOWN_FOR
            && self.colors[usize::from(known.entry)] == known.color;
        if is_known {
            return (known.color != Shade::DEFAULT).then_some(known.entry);
        }
        let [ls, as_, bs] = &self.labs;
        let mut squares = [0.0_f32; ENTRIES];
        let [l, a, b] = wanted.lab;
        for (square, ((&one, &two), &three)) in squares.iter_mut().zip(ls.iter().zip(as_).zip(bs)) {
            let (l, a, b) = (one - l, two - a, three - b);
            *square = l * l + a * a + b * b;
        }
        let mut entry = 0;
        for (index, square) in squares.iter().enumerate() {
            if *square < squares[entry] {
                entry = index;
            }
        }
        let color = self.colors[entry];
        self.nearest[place] =
            Near { shade: wanted.shade, color, entry: entry as u8, found_at: self.frame };
        (color != Shade::DEFAULT).then_some(entry as u8)
    }

    /// Begins a frame, on a terminal that draws in `style`: takes note of what its cells show and what they are
    /// to show, row by row, and defines what is frequent.
    ///
    /// Yields the definitions, if there are any, which are to be given back with [`Palette::keep`].
    pub(super) fn begin_frame(
        &mut self,
        screen: &Screen,
        style: Option<Style>,
        price: Option<Price>,
    ) -> Option<Bytes> {
        if !self.is_on {
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
        for (shown, looks) in screen.rows() {
            let mut last = Look::UNKNOWN;
            for (&shown, &look) in shown.iter().zip(looks) {
                if shown != last {
                    shown.colors().into_iter().for_each(|shade| self.note_shown(shade));
                    last = shown;
                }
                if shown != look {
                    look.colors().into_iter().for_each(|shade| self.note_wanted(shade));
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

    /// Keeps the memory of definitions.
    pub(super) fn keep(&mut self, definitions: Bytes) {
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

    /// Whether to define a colour that was wanted so often spares more bytes than it takes, beside what is
    /// nearest to it so far.
    fn is_worth_defining(&mut self, Count { shade, count }: Count, price: Option<Price>) -> bool {
        let Kind::Rgb(channels) = shade.kind() else { return false };
        // Each unit is half a use.
        let uses = f32::from(count) * 0.5;
        let Some(price) = price else { return uses >= LEAST_USES };
        if uses < LEAST_USES_INEXACT {
            return false;
        }
        let wanted = Ink { lab: Lab::of(channels).components(), shade };
        let spared = self.nearest(wanted).map_or(SPARED, |near| {
            let near = self.ink(near);
            price.of(near, wanted).min(SPARED)
        });
        uses * spared >= LEAST_USES_INEXACT * SPARED
    }

    /// The colour of an entry.
    fn ink(&self, entry: u8) -> Ink {
        let index = usize::from(entry);
        let lab = [0, 1, 2].map(|component| self.labs[component][index]);
        Ink { lab, shade: self.colors[index] }
    }

    /// Defines the colours that were wanted most, as far as that is worth it and there are entries for them.
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
        // Each place tells of one entry: where that is shown, it must go on to.
        let is_told_of = |shade: Shade| {
            let entry = usize::from(entries[entry_place(shade)]);
            is_shown[entry] && colors[entry] != Shade::DEFAULT
        };
        self.frequent.retain(|count| !is_told_of(count.shade));
        let definitions = self.free.len().min(self.frequent.len());
        for at in 0..definitions {
            let (entry, Count { shade, .. }) = (self.free[at], self.frequent[at]);
            let Kind::Rgb(channels) = shade.kind() else { continue };
            bytes.push_text(if at % AT_ONCE == 0 { b"\x1b]4" } else { b"" });
            push_definition(entry, channels, bytes);
            bytes.push_text(if (at + 1) % AT_ONCE == 0 || at + 1 == definitions {
                b"\x07"
            } else {
                b""
            });
            self.define(entry, shade, channels);
        }
    }

    fn define(&mut self, entry: u8, shade: Shade, channels: [u8; 3]) {
        // Of the one that this place has told of, nobody knows any more.
        let forgotten = usize::from(self.entries[entry_place(shade)]);
        if entry_place(self.colors[forgotten]) == entry_place(shade) {
            self.colors[forgotten] = Shade::DEFAULT;
            self.labs.iter_mut().for_each(|labs| labs[forgotten] = 1e9);
        }
        let index = usize::from(entry);
        self.colors[index] = shade;
        for (labs, component) in self.labs.iter_mut().zip(Lab::of(channels).components()) {
            labs[index] = component;
        }
        self.entries[entry_place(shade)] = entry;
        self.wanted_at[index] = self.frame;
        self.counts[place(shade)] = Count { shade: Shade::DEFAULT, count: 0 };
    }
}

impl Default for Palette {
    fn default() -> Self {
        let places = 1 << PLACE_BITS;
        let shade = Shade::DEFAULT;
        Self {
            is_on: false,
            colors: vec![shade; ENTRIES],
            labs: std::array::from_fn(|_| vec![1e9; ENTRIES]),
            entries: vec![0; 1 << ENTRY_PLACE_BITS],
            counts: vec![Count { shade, count: 0 }; places],
            nearest: vec![Near { shade, color: shade, entry: 0, found_at: 0 }; places],
            frame: KNOWN_FOR,
            wanted_at: vec![0; ENTRIES],
            is_shown: vec![false; ENTRIES],
            frequent: Vec::with_capacity(places),
            free: Vec::with_capacity(ENTRIES),
            definitions: Bytes::default(),
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

/// Where the entry of a colour is looked up.
#[inline]
fn entry_place(shade: Shade) -> usize {
    (shade.in_bits().wrapping_mul(0x9E37_79B1) >> (u32::BITS - ENTRY_PLACE_BITS)) as usize
}

/// Where all else about a colour is looked up. Colours that share the place of their entries share this one,
/// too.
#[inline]
fn place(shade: Shade) -> usize {
    (shade.in_bits().wrapping_mul(0x9E37_79B1) >> (u32::BITS - PLACE_BITS)) as usize
}

/// The colour that xterm gives an entry from the sixteenth on: a cube of six levels a side, and a ramp of
/// greys.
fn standard(index: u8) -> [u8; 3] {
    let level = |step: u8| if step == 0 { 0 } else { 55 + 40 * step };
    match index.saturating_sub(16) {
        cube @ 0..216 => [level(cube / 36), level(cube / 6 % 6), level(cube % 6)],
        grey => [8 + 10 * (grey - 216); 3],
    }
}

//! Frequent colours as entries of the terminal's palette.
//!
//! The parameters of a colour take up to sixteen bytes, those of a palette entry at most eight. So
//! frequent colours are defined as entries (OSC 4) before they are used. An entry is redefined only
//! if no cell shows its colour and the terminal's style does not use it, so that a definition never
//! changes the screen.
//!
//! The model does not record whether a cell was sent its colour as an entry. Every cell with the
//! colour of an entry counts as showing the entry. This takes no memory for each cell and is always
//! safe.
//!
//! A palette without definitions, as of most terminals, has no memory; one with them has 75 KB.
//! A terminal without 24-bit colours shows all colours as entries, by a [`Quantizer`].

use super::bytes::{Bytes, Definitions};
use super::ink::{self, Ink, Price, Telling};
use super::packed_cell::PackedCell;
use super::quantizer::Quantizer;
use super::screen::Screen;
use super::style::{Kind, Shade, Style};
use crate::color::palette;
use crate::terminal::sequence;

/// The known entries of the terminal's palette.
#[derive(Debug, Default)]
pub(crate) struct Palette {
    /// Whether entries may be defined.
    is_on: bool,
    /// The colour of each entry; [`Shade::DEFAULT`] for undefined ones.
    colors: Vec<Shade>,
    /// Those colours in L\*a\*b\*, component by component.
    labs: [Vec<f32>; 3],
    /// The entry that may hold a colour, by the colour's hash. Of several colours with one hash,
    /// one has an entry.
    entries: Vec<u8>,
    /// The numbers of recent uses of colours without an entry, by hash.
    counts: Vec<Count>,
    /// The entry nearest to a colour, by the colour's hash.
    nearest: Vec<Near>,
    /// The number of the frame.
    frame: u32,
    /// The number of the frame in which an entry's colour was last used.
    wanted_at: Vec<u32>,
    /// Whether a cell shows an entry's colour.
    is_shown: Vec<bool>,
    frequent: Vec<Count>,
    free: Vec<u8>,
    definitions: Bytes,
    /// Replaces all colours by entries, on a terminal without 24-bit colours.
    quantizer: Option<Box<Quantizer>>,
}

/// The number of recent uses of a colour; older ones count less.
#[derive(Clone, Copy, Debug)]
struct Count {
    shade: Shade,
    count: u16,
}

/// The entry nearest to a colour, and the number of the frame of the search.
#[derive(Clone, Copy, Debug)]
struct Near {
    shade: Shade,
    color: Shade,
    entry: u8,
    found_at: u32,
}

const ENTRIES: usize = 256;
/// The numbers of bits of the hashes that give the place of a colour's entry, and of its other data. Colours whose
/// entries have the same place have the same place for their other data, too.
const ENTRY_PLACE_BITS: u32 = 13;
const PLACE_BITS: u32 = 11;
/// The number of frames for which a nearest entry is not searched again.
const KNOWN_FOR: u32 = 8;

impl Palette {
    /// Sets whether entries may be defined, and forgets all definitions.
    pub(crate) fn set_on(&mut self, is_on: bool) {
        *self = if is_on { Self::on() } else { Self::default() };
    }

    /// Sets that all colours are told as entries, and forgets all definitions.
    pub(crate) fn set_quantizing(&mut self) {
        let quantizer = Some(Box::new(Quantizer::new()));
        *self = Self { is_on: true, quantizer, ..Self::default() };
    }

    /// Whether all colours are told as entries.
    pub(crate) fn is_quantizing(&self) -> bool {
        self.quantizer.is_some()
    }

    /// Replaces the colours of all targets by entries, if all colours are told as entries.
    /// Returns the definitions of entries that the terminal must receive before them.
    pub(crate) fn quantize(&mut self, screen: &mut Screen) -> Option<Bytes> {
        let mut definitions = Bytes::default();
        self.quantizer.as_mut()?.quantize(screen, &mut definitions);
        (!definitions.is_empty()).then_some(definitions)
    }

    /// Whether entries may be defined.
    pub(crate) fn is_on(&self) -> bool {
        self.is_on
    }

    /// Forgets all definitions.
    pub(crate) fn forget(&mut self) {
        if self.quantizer.is_some() {
            self.set_quantizing();
        } else {
            self.set_on(self.is_on);
        }
    }

    /// The entry that holds a colour.
    #[inline]
    fn entry(&self, shade: Shade) -> Option<u8> {
        let entry = self.entries[entry_place(shade)];
        (self.colors[usize::from(entry)] == shade && shade != Shade::DEFAULT).then_some(entry)
    }

    /// The shade to send to the terminal for a colour.
    #[inline]
    pub(crate) fn told(&self, shade: Shade) -> Shade {
        if self.is_on { self.entry_or_itself(shade) } else { shade }
    }

    fn entry_or_itself(&self, shade: Shade) -> Shade {
        if let Some(quantizer) = &self.quantizer {
            return quantizer.told(shade).map_or(shade, |(_, entry)| Shade::indexed(entry));
        }
        match shade.kind() {
            // The entry with this index may have been redefined.
            Kind::Indexed(index @ 16..) => Shade::rgb(palette::of_256(index).channels()),
            _ => self.entry(shade).map_or(shade, Shade::indexed),
        }
    }

    /// The cheapest colour to send for `wanted`, whose own parameters take this number of bytes.
    #[inline]
    pub(crate) fn telling(&mut self, wanted: Ink, bytes: f32, price: Price) -> Telling {
        let mut telling = Telling { ink: wanted, bytes, error: 0.0 };
        if self.is_on {
            self.shorten(&mut telling, price);
        }
        telling
    }

    /// Replaces the colour by an entry if that costs less.
    #[inline(never)]
    fn shorten(&mut self, telling: &mut Telling, price: Price) {
        if let Some(quantizer) = &mut self.quantizer {
            return quantizer.telling(telling, price);
        }
        let wanted = telling.ink;
        if let Some(entry) = self.entry(wanted.shade) {
            telling.bytes = Shade::indexed(entry).bytes() as f32;
            return;
        }
        let Some(near) = self.nearest(wanted) else { return };
        let ink = self.ink(near);
        let bytes = Shade::indexed(near).bytes() as f32;
        let error = price.of(ink, wanted);
        if bytes + error < telling.bytes {
            *telling = Telling { ink, bytes, error };
        }
    }

    /// The nearest entry to a colour, possibly from one of the last [`KNOWN_FOR`] frames.
    fn nearest(&mut self, wanted: Ink) -> Option<u8> {
        let place = wanted.shade.hash(PLACE_BITS);
        let known = self.nearest[place];
        let is_known = known.shade == wanted.shade
            && self.frame - known.found_at < KNOWN_FOR
            && self.colors[usize::from(known.entry)] == known.color;
        if is_known {
            return (known.color != Shade::DEFAULT).then_some(known.entry);
        }
        let (entry, _) = ink::nearest(&self.labs, wanted.lab);
        let color = self.colors[usize::from(entry)];
        self.nearest[place] = Near { shade: wanted.shade, color, entry, found_at: self.frame };
        (color != Shade::DEFAULT).then_some(entry)
    }

    /// A palette whose entries may be defined.
    fn on() -> Self {
        let places = 1 << PLACE_BITS;
        let shade = Shade::DEFAULT;
        Self {
            is_on: true,
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
            quantizer: None,
        }
    }

    /// The colour of an entry.
    fn ink(&self, entry: u8) -> Ink {
        let index = usize::from(entry);
        let lab = [0, 1, 2].map(|component| self.labs[component][index]);
        Ink { lab, shade: self.colors[index] }
    }
}

/// The place of a colour's entry.
#[inline]
fn entry_place(shade: Shade) -> usize {
    shade.hash(ENTRY_PLACE_BITS)
}

/// The approximate number of bytes that a use of an entry saves.
const SPARED: f32 = 8.0;
/// The number of half cells in a frame that must use a colour for it to be defined: in an exact
/// frame, and in an inexact one, where most of them are kept. In the latter, the savings must be as
/// large as those of this number of full uses.
const LEAST_USES: f32 = 2.0;
const LEAST_USES_INEXACT: f32 = 4.0;

impl Palette {
    /// Begins a frame, on a terminal with this `style`: counts the shown colours and the targets'
    /// colours, row by row, and defines the frequent ones.
    ///
    /// Returns whether there are [definitions](Palette::definitions).
    pub(crate) fn begin_frame(
        &mut self,
        screen: &Screen,
        style: Option<Style>,
        price: Option<Price>,
    ) -> bool {
        if !self.is_on || self.quantizer.is_some() {
            return false;
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
        self.definitions = definitions;
        !self.definitions.is_empty()
    }

    /// The definitions of this frame, which the terminal must receive before it.
    pub(crate) fn definitions(&self) -> &[u8] {
        self.definitions.as_slice()
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
        let known = &mut self.counts[shade.hash(PLACE_BITS)];
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
        if !shade.is_rgb() {
            return false;
        }
        // Each unit is half a use.
        let uses = f32::from(count) * 0.5;
        let Some(price) = price else { return uses >= LEAST_USES };
        if uses < LEAST_USES_INEXACT {
            return false;
        }
        let wanted = Ink::new(shade);
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
            self.define(entry, shade);
        }
        sent.end();
    }

    fn define(&mut self, entry: u8, shade: Shade) {
        // The previous entry at this place can no longer be found.
        let forgotten = usize::from(self.entries[entry_place(shade)]);
        if entry_place(self.colors[forgotten]) == entry_place(shade) {
            self.colors[forgotten] = Shade::DEFAULT;
            self.labs.iter_mut().for_each(|labs| labs[forgotten] = 1e9);
        }
        let index = usize::from(entry);
        self.colors[index] = shade;
        for (labs, component) in self.labs.iter_mut().zip(Ink::new(shade).lab) {
            labs[index] = component;
        }
        self.entries[entry_place(shade)] = entry;
        self.wanted_at[index] = self.frame;
        self.counts[shade.hash(PLACE_BITS)] = Count { shade: Shade::DEFAULT, count: 0 };
    }
}

//! Frequent colours as entries of the terminal's palette.
//!
//! The parameters of a colour take up to sixteen bytes, the parameters of a palette entry at most
//! eight. Therefore frequent colours are defined as entries (OSC 4) before they are used. An entry
//! is redefined only if no cell shows its colour and the terminal's style does not use it, so that
//! a definition never changes the screen.
//!
//! The model does not record whether the colour of a cell was sent as an entry. Every cell with the
//! colour of an entry counts as showing the entry. This takes no memory per cell and is always
//! safe.
//!
//! A palette without definitions takes no memory. Most terminals have such a palette. A palette
//! with definitions takes 75 KB.
//!
//! On a terminal without 24-bit colours, a [`Quantizer`] replaces all colours by entries. A
//! terminal that shows 256 colours and lets a program define them (OSC 4) then looks almost like a
//! terminal with 24-bit colours. Entries 24 to 255 hold colours of the frames, and each colour of a
//! frame is replaced by the nearest entry in Oklab before the frame is encoded. The model of the
//! screen therefore contains only colours of entries. No two entries have the same colour, so that
//! a colour in the model tells which entry a cell shows.
//!
//! - The entries are chosen again if the frame's mean error has grown too much, and after a change
//!   of scene. Most of them keep their colours.
//! - A definition changes the cells that show the entry. The model then records their new colour,
//!   and the encoder sends a cell again if it has become too wrong.
//! - The same frames always lead to the same entries.
//!
//! Rejected: defining only entries that no cell shows, as the palette for shorter frames does. Most
//! entries are shown all the time, so a level kept the colours of the level before it.

use crate::color::oklab::Oklab;
use crate::color::{Rgb, palette};
use crate::terminal::cell_writer::bytes::{Bytes, PaletteWriter};
use crate::terminal::cell_writer::ink::{self, ColorCode, Ink, Price};
use crate::terminal::cell_writer::packed_cell::PackedCell;
use crate::terminal::cell_writer::screen::Screen;
use crate::terminal::cell_writer::style::{PackedColor, PackedColorKind, Style};
use crate::terminal::sequence::PALETTE;

/// The known entries of the terminal's palette.
#[derive(Debug, Default)]
pub(crate) struct TerminalPalette {
    /// Whether entries may be defined.
    pub(crate) is_on: bool,
    /// The colour of each entry. [`PackedColor::DEFAULT`] for undefined entries.
    colors: Vec<PackedColor>,
    /// The colours of the entries in L\*a\*b\*, component by component.
    labs: [Vec<f32>; 3],
    /// The entry that may hold a colour, by the colour's hash. Of several colours with the same
    /// hash, only one has an entry.
    entries: Vec<u8>,
    /// The numbers of recent uses of colours without an entry, by hash.
    counts: Vec<Count>,
    /// The entry nearest to a colour, by the colour's hash.
    nearest: Vec<NearestEntry>,
    /// The number of the frame.
    frame: u32,
    /// The number of the frame in which an entry's colour was last used.
    wanted_at: Vec<u32>,
    /// For each entry, whether a cell shows its colour.
    is_shown: Vec<bool>,
    frequent: Vec<Count>,
    free: Vec<u8>,
    definitions: Bytes,
    /// Replaces all colours by entries, on a terminal without 24-bit colours.
    quantizer: Option<Box<Quantizer>>,
}

/// The number of recent uses of a colour. Older uses count less.
#[derive(Clone, Copy, Debug)]
struct Count {
    shade: PackedColor,
    count: u16,
}

/// The entry nearest to a colour, and the number of the frame of the search.
#[derive(Clone, Copy, Debug)]
struct NearestEntry {
    shade: PackedColor,
    color: PackedColor,
    entry: u8,
    found_at: u32,
}

const ENTRIES: usize = 256;
/// The number of bits of the hash that selects the place of a colour's entry. The next constant is
/// the same for its other data. Colours that share a place for their entries also share a place for
/// their other data.
const ENTRY_PLACE_BITS: u32 = 13;
const PLACE_BITS: u32 = 11;
/// The number of frames for which a nearest entry is used without a new search.
const KNOWN_FOR: u32 = 8;

impl TerminalPalette {
    /// Sets whether entries may be defined, and forgets all definitions.
    pub(crate) fn set_on(&mut self, is_on: bool) {
        *self = if is_on { Self::on() } else { Self::default() };
    }

    /// From now on, sends all colours as entries. Forgets all definitions.
    pub(crate) fn set_quantizing(&mut self) {
        let quantizer = Some(Box::new(Quantizer::new()));
        *self = Self { is_on: true, quantizer, ..Self::default() };
    }

    /// Returns true if all colours are sent as entries.
    pub(crate) fn is_quantizing(&self) -> bool {
        self.quantizer.is_some()
    }

    /// Replaces the colours of all targets by entries, if all colours are sent as entries. Returns
    /// the definitions of entries that the terminal must receive before the targets.
    pub(crate) fn quantize(&mut self, screen: &mut Screen) -> Option<Bytes> {
        let mut definitions = Bytes::default();
        self.quantizer.as_mut()?.quantize(screen, &mut definitions);
        (!definitions.is_empty()).then_some(definitions)
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
    fn entry(&self, shade: PackedColor) -> Option<u8> {
        let entry = self.entries[entry_place(shade)];
        (self.colors[usize::from(entry)] == shade && shade != PackedColor::DEFAULT).then_some(entry)
    }

    /// The shade to send to the terminal for a colour.
    #[inline]
    pub(crate) fn told(&self, shade: PackedColor) -> PackedColor {
        if self.is_on { self.entry_or_itself(shade) } else { shade }
    }

    fn entry_or_itself(&self, shade: PackedColor) -> PackedColor {
        if let Some(quantizer) = &self.quantizer {
            return quantizer.told(shade).map_or(shade, |(_, entry)| PackedColor::indexed(entry));
        }
        match shade.kind() {
            // The entry with this index may have been redefined.
            PackedColorKind::Indexed(index @ 16..) => {
                PackedColor::rgb(palette::of_256(index).channels())
            }
            _ => self.entry(shade).map_or(shade, PackedColor::indexed),
        }
    }

    /// The cheapest colour to send for `wanted`, whose own parameters take this number of bytes.
    #[inline]
    pub(crate) fn telling(&mut self, wanted: Ink, bytes: f32, price: Price) -> ColorCode {
        let mut telling = ColorCode { ink: wanted, bytes, error: 0.0 };
        if self.is_on {
            self.shorten(&mut telling, price);
        }
        telling
    }

    /// Replaces the colour by an entry if that costs less.
    #[inline(never)]
    fn shorten(&mut self, telling: &mut ColorCode, price: Price) {
        if let Some(quantizer) = &mut self.quantizer {
            return quantizer.telling(telling, price);
        }
        let wanted = telling.ink;
        if let Some(entry) = self.entry(wanted.shade) {
            telling.bytes = PackedColor::indexed(entry).bytes() as f32;
            return;
        }
        let Some(near) = self.nearest(wanted) else { return };
        let ink = self.ink(near);
        let bytes = PackedColor::indexed(near).bytes() as f32;
        let error = price.of(ink, wanted);
        if bytes + error < telling.bytes {
            *telling = ColorCode { ink, bytes, error };
        }
    }

    /// The entry nearest to a colour. The search may have been in one of the last [`KNOWN_FOR`]
    /// frames.
    fn nearest(&mut self, wanted: Ink) -> Option<u8> {
        let place = wanted.shade.hash(PLACE_BITS);
        let known = self.nearest[place];
        let is_known = known.shade == wanted.shade
            && self.frame - known.found_at < KNOWN_FOR
            && self.colors[usize::from(known.entry)] == known.color;
        if is_known {
            return (known.color != PackedColor::DEFAULT).then_some(known.entry);
        }
        let (entry, _) = ink::nearest(&self.labs, wanted.lab);
        let color = self.colors[usize::from(entry)];
        self.nearest[place] =
            NearestEntry { shade: wanted.shade, color, entry, found_at: self.frame };
        (color != PackedColor::DEFAULT).then_some(entry)
    }

    /// A palette whose entries may be defined.
    fn on() -> Self {
        let places = 1 << PLACE_BITS;
        let shade = PackedColor::DEFAULT;
        Self {
            is_on: true,
            colors: vec![shade; ENTRIES],
            labs: std::array::from_fn(|_| vec![1e9; ENTRIES]),
            entries: vec![0; 1 << ENTRY_PLACE_BITS],
            counts: vec![Count { shade, count: 0 }; places],
            nearest: vec![NearestEntry { shade, color: shade, entry: 0, found_at: 0 }; places],
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
fn entry_place(shade: PackedColor) -> usize {
    shade.hash(ENTRY_PLACE_BITS)
}

/// The approximate number of bytes that the use of an entry saves.
const SPARED: f32 = 8.0;
/// The number of half cells in an exact frame that must use a colour before it is defined. The next
/// constant is the same for inexact frames, in which most half cells are kept. There, the savings
/// must also be as large as the savings of this number of full uses.
const MIN_USES: f32 = 2.0;
const MIN_USES_INEXACT: f32 = 4.0;

impl TerminalPalette {
    /// Begins a frame, on a terminal with this `style`: counts the shown colours and the targets'
    /// colours, row by row, and defines the frequent ones.
    ///
    /// Returns true if there are [definitions](TerminalPalette::definitions).
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
    fn note_shown(&mut self, shade: PackedColor) {
        if let Some(entry) = self.entry(shade) {
            self.is_shown[usize::from(entry)] = true;
        }
    }

    #[inline]
    fn note_wanted(&mut self, shade: PackedColor) {
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

    /// Returns true if the definition of a colour with this number of uses saves more bytes than it
    /// takes, compared with the entry that is now nearest to the colour.
    fn is_worth_defining(&mut self, Count { shade, count }: Count, price: Option<Price>) -> bool {
        if !shade.is_rgb() {
            return false;
        }
        // Each unit is half a use.
        let uses = f32::from(count) * 0.5;
        let Some(price) = price else { return uses >= MIN_USES };
        if uses < MIN_USES_INEXACT {
            return false;
        }
        let wanted = Ink::new(shade);
        let spared = self.nearest(wanted).map_or(SPARED, |near| {
            let near = self.ink(near);
            price.of(near, wanted).min(SPARED)
        });
        uses * spared >= MIN_USES_INEXACT * SPARED
    }

    /// Defines the most frequent colours, as far as that saves bytes and entries are free.
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
        self.free.extend(PALETTE.filter(is_free));
        self.free.sort_unstable_by_key(|&entry| (wanted_at[usize::from(entry)], entry));
        self.frequent.sort_unstable_by_key(|count| (u16::MAX - count.count, count.shade.in_bits()));
        let (entries, colors, is_shown) = (&self.entries, &self.colors, &self.is_shown);
        // Each place refers to one entry, which must not be replaced while it is shown.
        let is_told_of = |shade: PackedColor| {
            let entry = usize::from(entries[entry_place(shade)]);
            is_shown[entry] && colors[entry] != PackedColor::DEFAULT
        };
        self.frequent.retain(|count| !is_told_of(count.shade));
        let definitions = self.free.len().min(self.frequent.len());
        let mut sent = PaletteWriter::begin(bytes);
        for at in 0..definitions {
            let (entry, Count { shade, .. }) = (self.free[at], self.frequent[at]);
            let PackedColorKind::Rgb(channels) = shade.kind() else { continue };
            sent.push(entry, channels);
            self.define(entry, shade);
        }
        sent.end();
    }

    fn define(&mut self, entry: u8, shade: PackedColor) {
        // The previous entry at this place can no longer be found.
        let forgotten = usize::from(self.entries[entry_place(shade)]);
        if entry_place(self.colors[forgotten]) == entry_place(shade) {
            self.colors[forgotten] = PackedColor::DEFAULT;
            self.labs.iter_mut().for_each(|labs| labs[forgotten] = 1e9);
        }
        let index = usize::from(entry);
        self.colors[index] = shade;
        for (labs, component) in self.labs.iter_mut().zip(Ink::new(shade).lab) {
            labs[index] = component;
        }
        self.entries[entry_place(shade)] = entry;
        self.wanted_at[index] = self.frame;
        self.counts[shade.hash(PLACE_BITS)] = Count { shade: PackedColor::DEFAULT, count: 0 };
    }
}

/// Chooses the entries, and replaces colours by them.
#[derive(Debug)]
struct Quantizer {
    clusters: Clusters,
    /// The colour of each entry. [`PackedColor::NONE`] for undefined entries.
    shades: Vec<PackedColor>,
    /// The entries, sorted by the bits of their colours.
    by_shade: Vec<(u32, u8)>,
    /// Recent colours with their nearest entries, by hash.
    known: Vec<NearCluster>,
    /// The number of the frame, and the number of the frame in which the entries were last chosen.
    frame: u32,
    chosen_at: u32,
    /// The mean error just after that choice.
    error_then: f32,
}

/// The nearest entry of a colour, and its distance in Oklab.
#[derive(Clone, Copy, Debug)]
struct NearCluster {
    shade: PackedColor,
    place: u8,
    distance: f32,
}

/// A mean error up to this never leads to a new choice.
const SMALL: f32 = 0.004;
/// The growth of the mean error after which entries are chosen again.
const GROWTH: f32 = 1.4;
/// The number of frames for which a choice lasts, unless the error exceeds [`SCENE`].
const FRAMES_PER_CHOICE: u32 = 15;
/// A mean error that only a change of scene causes.
const SCENE: f32 = 0.03;
/// Recent colours are in a cache with this number of ways, of 2^[`PLACE_BITS`] places each.
const WAYS: usize = 4;

impl Quantizer {
    pub(crate) fn new() -> Self {
        let nothing = NearCluster { shade: PackedColor::NONE, place: 0, distance: 0.0 };
        Self {
            clusters: Clusters::new(PALETTE.count()),
            shades: vec![PackedColor::NONE; PALETTE.count()],
            by_shade: Vec::new(),
            known: vec![nothing; WAYS << PLACE_BITS],
            frame: 0,
            chosen_at: 0,
            error_then: 0.0,
        }
    }

    /// Replaces the colours of all targets by entries. Adds definitions to `bytes`, which the
    /// terminal must receive before the frame.
    pub(crate) fn quantize(&mut self, screen: &mut Screen, bytes: &mut Bytes) {
        self.frame += 1;
        let error = self.mean_error(screen);
        if self.must_choose(error) {
            self.choose(screen, bytes);
            self.chosen_at = self.frame;
            self.error_then = self.mean_error(screen).unwrap_or_default();
        }
        if !self.by_shade.is_empty() {
            screen.recolor_targets(|shade| self.nearest(shade).map_or(shade, |(shade, _)| shade));
        }
    }

    /// The colour of the entry that is shown for `shade`, and the entry. `None` for named colours
    /// and the terminal's default colours.
    pub(crate) fn told(&self, shade: PackedColor) -> Option<(PackedColor, u8)> {
        let channels = channels(shade)?;
        let place = match self.place_of(PackedColor::rgb(channels)) {
            Some(place) => place,
            None => self.clusters.nearest(lab(channels)).0,
        };
        self.at(place)
    }

    /// Replaces the colour by its nearest entry.
    pub(crate) fn telling(&mut self, telling: &mut ColorCode, price: Price) {
        let wanted = telling.ink;
        let Some((shade, entry)) = self.nearest(wanted.shade) else { return };
        telling.bytes = PackedColor::indexed(entry).bytes() as f32;
        if shade != wanted.shade {
            telling.ink = Ink::new(shade);
            telling.error = price.of(telling.ink, wanted);
        }
    }

    /// Returns the same as [`Quantizer::told`], and caches it.
    fn nearest(&mut self, shade: PackedColor) -> Option<(PackedColor, u8)> {
        let near = self.near(shade)?;
        self.at(near.place)
    }

    fn near(&mut self, shade: PackedColor) -> Option<NearCluster> {
        let channels = channels(shade)?;
        let way = (shade.in_bits() & (WAYS as u32 - 1)) as usize;
        let known = shade.hash(PLACE_BITS) * WAYS + way;
        if self.known[known].shade != shade {
            let (place, distance) = self.clusters.nearest(lab(channels));
            self.known[known] = NearCluster { shade, place, distance };
        }
        Some(self.known[known])
    }

    fn at(&self, place: u8) -> Option<(PackedColor, u8)> {
        let shade = self.shades[usize::from(place)];
        (shade != PackedColor::NONE).then_some((shade, place + PALETTE.start()))
    }

    fn place_of(&self, shade: PackedColor) -> Option<u8> {
        let found = self.by_shade.binary_search_by_key(&shade.in_bits(), |(bits, _)| *bits);
        found.ok().map(|index| self.by_shade[index].1)
    }

    /// The mean error of the targets, in Oklab. `None` if there are no colours. Also records which
    /// entries are in use.
    fn mean_error(&mut self, screen: &Screen) -> Option<f32> {
        let (mut error, mut count) = (0.0_f32, 0_u32);
        let mut last = (PackedCell::UNKNOWN, 0.0, 0);
        for &target in screen.targets() {
            if target != last.0 {
                last = (target, 0.0, 0);
                for shade in target.colors() {
                    let Some(near) = self.near(shade) else { continue };
                    self.clusters.note_use(near.place, self.frame);
                    last.1 += near.distance;
                    last.2 += 1;
                }
            }
            error += last.1;
            count += last.2;
        }
        (count > 0).then(|| error / count as f32)
    }

    /// Returns true if the entries must be chosen again for a frame with this mean error.
    fn must_choose(&self, error: Option<f32>) -> bool {
        let Some(error) = error else { return false };
        let has_grown = error > SMALL.max(self.error_then * GROWTH);
        let is_time = self.frame - self.chosen_at >= FRAMES_PER_CHOICE || error > SCENE;
        self.by_shade.is_empty() || has_grown && is_time
    }

    /// Chooses entries for the targets, defines them, and records the colours that the cells then
    /// show.
    fn choose(&mut self, screen: &mut Screen, bytes: &mut Bytes) {
        let samples = samples(screen);
        let wanted = self.clusters.fit(&samples, &self.shades);
        let mut changes = Vec::new();
        let mut definitions = PaletteWriter::begin(bytes);
        for (place, (shade, wanted)) in (0_u8..).zip(self.shades.iter_mut().zip(wanted)) {
            let before = std::mem::replace(shade, wanted);
            if let (true, PackedColorKind::Rgb(channels)) = (before != wanted, wanted.kind()) {
                definitions.push(place + PALETTE.start(), channels);
            }
            if before != wanted {
                changes.push((before.in_bits(), wanted));
            }
        }
        definitions.end();
        changes.sort_unstable_by_key(|(before, _)| *before);
        screen.recolor_shown(|shade| {
            let found = changes.binary_search_by_key(&shade.in_bits(), |(before, _)| *before);
            found.map_or(shade, |index| changes[index].1)
        });
        let shades =
            self.shades.iter().zip(0_u8..).filter(|(shade, _)| **shade != PackedColor::NONE);
        self.by_shade.clear();
        self.by_shade.extend(shades.map(|(shade, place)| (shade.in_bits(), place)));
        self.by_shade.sort_unstable();
        self.known.fill(NearCluster { shade: PackedColor::NONE, place: 0, distance: 0.0 });
    }
}

/// The maximum number of colours for which entries are chosen. In a large window, similar colours
/// count as one.
const MAX_SAMPLES: usize = 4096;

/// The colours of the targets, in the order of their bits.
fn samples(screen: &Screen) -> Vec<FrameColor> {
    let shades = screen.targets().flat_map(|target| target.colors());
    let mut colors: Vec<[u8; 3]> = shades.filter_map(channels).collect();
    colors.sort_unstable();
    let mut samples: Vec<FrameColor> = Vec::new();
    for dropped in 0..u8::BITS {
        samples.clear();
        let key = |color: [u8; 3]| color.map(|channel| channel >> dropped);
        if dropped > 0 {
            colors.sort_unstable_by_key(|color| (key(*color), *color));
        }
        for group in colors.chunk_by(|one, other| key(*one) == key(*other)) {
            let shade = PackedColor::rgb(group[group.len() / 2]);
            samples.push(FrameColor { shade, lab: [0.0; 3], count: group.len() as f32 });
        }
        if samples.len() <= MAX_SAMPLES {
            break;
        }
    }
    for sample in &mut samples {
        sample.lab = channels(sample.shade).map_or([0.0; 3], lab);
    }
    samples
}

/// Red, green and blue of a colour. `None` for named colours, which users can redefine, and for the
/// terminal's default colours.
fn channels(shade: PackedColor) -> Option<[u8; 3]> {
    match shade.kind() {
        PackedColorKind::Rgb(channels) => Some(channels),
        PackedColorKind::Indexed(index @ 16..) => Some(palette::of_256(index).channels()),
        PackedColorKind::Indexed(_) | PackedColorKind::Default => None,
    }
}

fn lab([red, green, blue]: [u8; 3]) -> [f32; 3] {
    Oklab::from(Rgb::new(red, green, blue)).0.map(|component| component as f32)
}

/// A colour of a frame.
#[derive(Clone, Copy, Debug)]
struct FrameColor {
    shade: PackedColor,
    lab: [f32; 3],
    /// The number of half cells with this colour.
    count: f32,
}

/// Clusters of colours, one for each entry, found by k-means in Oklab.
///
/// The search begins with the current entries. In each round, colours go to their nearest entries
/// and entries move to the means of their colours. Entries without colours move to the places with
/// the largest errors. The entries that have been unused for the longest time move first (Linde,
/// Buzo and Gray, 1980). An entry takes the colour of the frame that is nearest to its mean, so
/// that large areas of one colour, such as black, are exact.
///
/// Rejected: a median cut, which begins from nothing. An entry that keeps its place needs no new
/// definition, and cells that show it need not be sent again.
#[derive(Debug)]
struct Clusters {
    /// The centres of the clusters in Oklab, component by component.
    centers: [Vec<f32>; 3],
    /// The number of the frame in which each cluster was last in use.
    used_at: Vec<u32>,
}

/// The sums of a cluster's colours.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f32,
    lab: [f32; 3],
    /// The sum of the squared distances.
    error: f32,
    /// The sample with the largest error, and that error.
    worst: (usize, f32),
}

/// The centre of an entry that is undefined.
const UNDEFINED: f32 = 1e9;
/// The maximum number of rounds. Eight are needed to find all entries from nothing.
const ROUNDS: u32 = 12;
/// The mean error at which no further entries are needed.
const ENOUGH: f32 = 0.002;
/// An entry within this distance of its mean keeps its colour.
const NEAR: f32 = 0.004;

impl Clusters {
    /// Undefined clusters.
    fn new(count: usize) -> Self {
        Self { centers: [0, 1, 2].map(|_| vec![UNDEFINED; count]), used_at: vec![0; count] }
    }

    /// Records that an entry is in use.
    fn note_use(&mut self, place: u8, frame: u32) {
        self.used_at[usize::from(place)] = frame;
    }

    /// The cluster nearest to a colour, and the distance.
    fn nearest(&self, lab: [f32; 3]) -> (u8, f32) {
        let (place, square) = ink::nearest(&self.centers, lab);
        (place, square.sqrt())
    }

    /// Fits the entries, which have the colours `shades`, to `samples`. Returns their new colours.
    fn fit(&mut self, samples: &[FrameColor], shades: &[PackedColor]) -> Vec<PackedColor> {
        let before = self.centers.clone();
        for _ in 0..ROUNDS {
            let (sums, error) = self.sums(samples);
            for (place, sums) in sums.iter().enumerate().filter(|(_, sums)| sums.count > 0.0) {
                self.move_to(place, sums.lab.map(|sum| sum / sums.count));
            }
            if error <= ENOUGH || !self.split(&sums, samples) {
                break;
            }
        }
        self.settle(samples, shades, &before)
    }

    /// The sums of each cluster, and the mean distance of all samples.
    fn sums(&self, samples: &[FrameColor]) -> (Vec<Sums>, f32) {
        let mut all = vec![Sums::default(); self.used_at.len()];
        let (mut distances, mut count) = (0.0, 0.0);
        for (index, sample) in samples.iter().enumerate() {
            let (place, distance) = self.nearest(sample.lab);
            let sums = &mut all[usize::from(place)];
            let error = sample.count * distance * distance;
            sums.count += sample.count;
            sums.error += error;
            for (sum, component) in sums.lab.iter_mut().zip(sample.lab) {
                *sum += sample.count * component;
            }
            if error > sums.worst.1 {
                sums.worst = (index, error);
            }
            distances += sample.count * distance;
            count += sample.count;
        }
        (all, distances / count)
    }

    /// Moves entries without colours to the places with the largest errors. Returns true if any
    /// entry was moved.
    fn split(&mut self, sums: &[Sums], samples: &[FrameColor]) -> bool {
        let mut spare: Vec<usize> =
            (0..sums.len()).filter(|&place| sums[place].count == 0.0).collect();
        spare.sort_by_key(|&place| self.used_at[place]);
        let mut worst: Vec<Sums> = sums.iter().copied().filter(|sums| sums.worst.1 > 0.0).collect();
        worst.sort_by(|one, other| other.error.total_cmp(&one.error));
        for (&place, sums) in spare.iter().zip(&worst) {
            self.move_to(place, samples[sums.worst.0].lab);
        }
        !spare.is_empty() && !worst.is_empty()
    }

    /// Moves each centre to a colour of its own cluster, or back to its place `before` if that is
    /// near enough. Returns the colours.
    fn settle(
        &mut self,
        samples: &[FrameColor],
        shades: &[PackedColor],
        before: &[Vec<f32>; 3],
    ) -> Vec<PackedColor> {
        let mut nearest = vec![(f32::INFINITY, 0); shades.len()];
        for (index, sample) in samples.iter().enumerate() {
            let (place, distance) = self.nearest(sample.lab);
            let known = &mut nearest[usize::from(place)];
            if distance < known.0 {
                *known = (distance, index);
            }
        }
        let mut settled: Vec<PackedColor> = Vec::with_capacity(shades.len());
        for (place, (&shade, &(distance, index))) in shades.iter().zip(&nearest).enumerate() {
            let old = before.each_ref().map(|components| components[place]);
            let has_colors = distance.is_finite();
            let is_kept = !has_colors || self.distance(place, old) <= NEAR.max(distance);
            let (lab, chosen) =
                if is_kept { (old, shade) } else { (samples[index].lab, samples[index].shade) };
            // Two entries with the same colour could not be told apart.
            let is_new = chosen != PackedColor::NONE && !settled.contains(&chosen);
            self.move_to(place, if is_new { lab } else { [UNDEFINED; 3] });
            settled.push(if is_new { chosen } else { PackedColor::NONE });
        }
        settled
    }

    fn move_to(&mut self, place: usize, lab: [f32; 3]) {
        for (centers, component) in self.centers.iter_mut().zip(lab) {
            centers[place] = component;
        }
    }

    fn distance(&self, place: usize, lab: [f32; 3]) -> f32 {
        let squares = self.centers.iter().zip(lab).map(|(centers, component)| {
            let difference = centers[place] - component;
            difference * difference
        });
        squares.sum::<f32>().sqrt()
    }
}

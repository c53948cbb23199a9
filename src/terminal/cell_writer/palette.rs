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

mod definitions;
mod quantizer;

use super::bytes::Bytes;
use super::ink::{Ink, Price};
use super::screen::Screen;
use super::style::{Kind, Shade};
use quantizer::Quantizer;

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

/// A colour that may be sent for another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Telling {
    pub(crate) ink: Ink,
    /// The bytes of its parameters.
    pub(crate) bytes: f32,
    /// The price of its error, in bytes.
    pub(crate) error: f32,
}

impl Telling {
    /// The bytes and the price together.
    #[inline]
    pub(crate) fn cost(self) -> f32 {
        self.bytes + self.error
    }
}

const ENTRIES: usize = 256;
/// The number of bits of a hash for the place of a colour's entry, and for the places of its other
/// data.
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

    /// Replaces the colours of all targets by those of entries, if all colours are told as entries.
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
            Kind::Indexed(index @ 16..) => Shade::rgb(standard(index)),
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
    (shade.in_bits().wrapping_mul(0x9E37_79B1) >> (u32::BITS - ENTRY_PLACE_BITS)) as usize
}

/// The place of a colour's other data. Colours whose entries have the same place have the same
/// place here, too.
#[inline]
fn place(shade: Shade) -> usize {
    (shade.in_bits().wrapping_mul(0x9E37_79B1) >> (u32::BITS - PLACE_BITS)) as usize
}

/// The colour of an entry from the sixteenth on in xterm's palette: a cube of six levels a side,
/// and a ramp of greys.
fn standard(index: u8) -> [u8; 3] {
    let level = |step: u8| if step == 0 { 0 } else { 55 + 40 * step };
    match index.saturating_sub(16) {
        cube @ 0..216 => [level(cube / 36), level(cube / 6 % 6), level(cube % 6)],
        grey => [8 + 10 * (grey - 216); 3],
    }
}

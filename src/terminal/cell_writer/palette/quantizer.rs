//! All colours of the frames as entries of the terminal's palette.
//!
//! A terminal that shows 256 colours and lets a program define them (OSC 4) looks almost like one
//! with 24-bit colours. Entries 24 to 255 hold colours of the frames, and each colour of a frame is
//! replaced by the nearest entry in Oklab before the frame is encoded. The model of the screen
//! therefore holds only colours of entries. No two entries have the same colour, so that a colour
//! in the model tells which entry a cell shows.
//!
//! - The entries are chosen again if the frame's mean error has grown too much, and after a change of
//!   scene. Most of them keep their colours.
//! - A definition changes the cells that show the entry. The model then records their new colour,
//!   and the encoder sends the cells again that have become too wrong.
//! - The same frames give the same entries.
//!
//! Rejected: defining only entries that no cell shows, as the palette for shorter frames does. Most
//! entries are shown all the time, so that a level kept the colours of the one before it.

mod clusters;

use super::super::bytes::Bytes;
use super::super::ink::{Ink, Price};
use super::super::packed_cell::PackedCell;
use super::super::screen::Screen;
use super::super::style::{Kind, Shade};
use super::definitions::Definitions;
use super::{Telling, place, standard};
use crate::color::Rgb;
use crate::color::lab::PackedLab;
use crate::color::oklab::Oklab;
use crate::terminal::sequence::PALETTE;
use clusters::{Clusters, Sample};

/// The entries, and the colours that they stand for.
#[derive(Debug)]
pub(crate) struct Quantizer {
    clusters: Clusters,
    /// The colour of each entry; [`Shade::NONE`] for undefined ones.
    shades: Vec<Shade>,
    /// The entries by the bits of their colours.
    by_shade: Vec<(u32, u8)>,
    /// Recent colours with their nearest entries, by hash.
    known: Vec<Near>,
    /// The number of the frame, and of that in which the entries were last chosen.
    frame: u32,
    chosen_at: u32,
    /// The mean error just after that.
    error_then: f32,
}

/// The nearest entry of a colour, and its distance in Oklab.
#[derive(Clone, Copy, Debug)]
struct Near {
    shade: Shade,
    place: u8,
    distance: f32,
}

/// The mean error that is always small enough.
const SMALL: f32 = 0.004;
/// The growth of the mean error after which entries are chosen again.
const GROWTH: f32 = 1.4;
/// The number of frames for which a choice lasts, unless the error exceeds [`SCENE`].
const PATIENCE: u32 = 15;
/// A mean error that only a change of scene causes.
const SCENE: f32 = 0.03;
/// The places of recent colours: four for each place of the palette's other data.
const WAYS: usize = 4;

impl Quantizer {
    pub(crate) fn new() -> Self {
        let nothing = Near { shade: Shade::NONE, place: 0, distance: 0.0 };
        Self {
            clusters: Clusters::new(PALETTE.count()),
            shades: vec![Shade::NONE; PALETTE.count()],
            by_shade: Vec::new(),
            known: vec![nothing; WAYS << super::PLACE_BITS],
            frame: 0,
            chosen_at: 0,
            error_then: 0.0,
        }
    }

    /// Replaces the colours of all targets by those of entries. Definitions of entries, which the
    /// terminal must receive before the frame, are added to `bytes`.
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

    /// The colour of the entry that is shown for `shade`, and the entry; `None` for named colours and
    /// the terminal's own.
    pub(crate) fn told(&self, shade: Shade) -> Option<(Shade, u8)> {
        let channels = channels(shade)?;
        let place = match self.place_of(Shade::rgb(channels)) {
            Some(place) => place,
            None => self.clusters.nearest(lab(channels)).0,
        };
        self.at(place)
    }

    /// The nearest entry in place of `wanted`, whose own parameters take this number of bytes.
    pub(crate) fn telling(&mut self, telling: &mut Telling, price: Price) {
        let wanted = telling.ink;
        let Some((shade, entry)) = self.nearest(wanted.shade) else { return };
        telling.bytes = Shade::indexed(entry).bytes() as f32;
        if let (true, Kind::Rgb(channels)) = (shade != wanted.shade, shade.kind()) {
            telling.ink = Ink { lab: PackedLab::of(channels).components(), shade };
            telling.error = price.of(telling.ink, wanted);
        }
    }

    /// As [`Quantizer::told`], and remembers it.
    fn nearest(&mut self, shade: Shade) -> Option<(Shade, u8)> {
        let near = self.near(shade)?;
        self.at(near.place)
    }

    fn near(&mut self, shade: Shade) -> Option<Near> {
        let channels = channels(shade)?;
        let way = (shade.in_bits() & (WAYS as u32 - 1)) as usize;
        let known = place(shade) * WAYS + way;
        if self.known[known].shade != shade {
            let (place, distance) = self.clusters.nearest(lab(channels));
            self.known[known] = Near { shade, place, distance };
        }
        Some(self.known[known])
    }

    fn at(&self, place: u8) -> Option<(Shade, u8)> {
        let shade = self.shades[usize::from(place)];
        (shade != Shade::NONE).then_some((shade, place + PALETTE.start()))
    }

    fn place_of(&self, shade: Shade) -> Option<u8> {
        let found = self.by_shade.binary_search_by_key(&shade.in_bits(), |(bits, _)| *bits);
        found.ok().map(|index| self.by_shade[index].1)
    }

    /// The mean error of the targets, in Oklab; `None` without colours. Records which entries are in
    /// use.
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

    /// Whether the entries must be chosen again for a frame of this mean error.
    fn must_choose(&self, error: Option<f32>) -> bool {
        let Some(error) = error else { return false };
        let has_grown = error > SMALL.max(self.error_then * GROWTH);
        let is_time = self.frame - self.chosen_at >= PATIENCE || error > SCENE;
        self.by_shade.is_empty() || has_grown && is_time
    }

    /// Chooses entries for the targets, defines them, and records what the cells then show.
    fn choose(&mut self, screen: &mut Screen, bytes: &mut Bytes) {
        let samples = samples(screen);
        let wanted = self.clusters.fit(&samples, &self.shades);
        let mut changes = Vec::new();
        let mut definitions = Definitions::begin(bytes);
        for (place, (shade, wanted)) in (0_u8..).zip(self.shades.iter_mut().zip(wanted)) {
            let before = std::mem::replace(shade, wanted);
            if let (true, Kind::Rgb(channels)) = (before != wanted, wanted.kind()) {
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
        let shades = self.shades.iter().zip(0_u8..).filter(|(shade, _)| **shade != Shade::NONE);
        self.by_shade.clear();
        self.by_shade.extend(shades.map(|(shade, place)| (shade.in_bits(), place)));
        self.by_shade.sort_unstable();
        self.known.fill(Near { shade: Shade::NONE, place: 0, distance: 0.0 });
    }
}

/// The largest number of colours that entries are chosen for. In a large window, similar colours
/// count as one.
const MOST_SAMPLES: usize = 4096;

/// The colours of the targets, in the order of their bits.
fn samples(screen: &Screen) -> Vec<Sample> {
    let shades = screen.targets().flat_map(|target| target.colors());
    let mut colors: Vec<[u8; 3]> = shades.filter_map(channels).collect();
    colors.sort_unstable();
    let mut samples: Vec<Sample> = Vec::new();
    for dropped in 0..u8::BITS {
        samples.clear();
        let key = |color: [u8; 3]| color.map(|channel| channel >> dropped);
        if dropped > 0 {
            colors.sort_unstable_by_key(|color| (key(*color), *color));
        }
        for group in colors.chunk_by(|one, other| key(*one) == key(*other)) {
            let shade = Shade::rgb(group[group.len() / 2]);
            samples.push(Sample { shade, lab: [0.0; 3], count: group.len() as f32 });
        }
        if samples.len() <= MOST_SAMPLES {
            break;
        }
    }
    for sample in &mut samples {
        sample.lab = channels(sample.shade).map_or([0.0; 3], lab);
    }
    samples
}

/// Red, green and blue of a colour; `None` for named colours, which users redefine, and for the
/// terminal's own.
fn channels(shade: Shade) -> Option<[u8; 3]> {
    match shade.kind() {
        Kind::Rgb(channels) => Some(channels),
        Kind::Indexed(index @ 16..) => Some(standard(index)),
        Kind::Indexed(_) | Kind::Default => None,
    }
}

fn lab([red, green, blue]: [u8; 3]) -> [f32; 3] {
    Oklab::from(Rgb::new(red, green, blue)).0.map(|component| component as f32)
}

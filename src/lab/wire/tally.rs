//! What one encoder makes of a script.

use std::time::{Duration, Instant};

use ratatui::buffer::Buffer;

use super::EncoderReport;
use super::compression::{LEVELS, Stream};
use super::difference::Difference;
use super::encoder::{Changes, Encoder};
use crate::game::Script;

/// What was measured in a part of a script.
#[derive(Clone, Debug)]
pub struct Part {
    /// The section's name; `all` for all of them.
    pub name: String,
    /// How many frames it has.
    pub frames: usize,
    /// How many bytes a frame takes.
    pub bytes: Bytes,
    /// How many bytes it takes for each that ratatui's own encoder does, in the mean; NaN where
    /// neither takes any.
    pub ratio: f64,
    /// What a frame takes after compression by zlib at level 1, and at level 6 as by `ssh -C`.
    pub compressed: [Compressed; 2],
    /// How long encoding a frame took, in the mean.
    pub time: Duration,
    /// What the viewer saw.
    pub seen: Seen,
}

/// What a frame takes after compression, in the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compressed {
    /// How many bytes.
    pub bytes: f64,
    /// How long compressing took.
    pub time: Duration,
}

/// How many bytes a frame takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bytes {
    /// In the mean.
    pub mean: f64,
    /// Half of the frames take no more.
    pub median: usize,
    /// 19 of 20 frames take no more.
    pub percentile_95: usize,
    /// No frame takes more.
    pub largest: usize,
}

/// How far what the terminal shows is from what was drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The peak signal-to-noise ratio, in decibels; infinite where nothing differs.
    pub signal_to_noise: f64,
    /// The mean distance of a pixel's colour, in CIE76's ΔE.
    pub mean_distance: f64,
    /// The largest.
    pub largest_distance: f64,
}

/// An encoder at work, and what it has taken so far.
pub(super) struct Tally {
    name: String,
    encoder: Box<dyn Encoder>,
    streams: [Stream; 2],
    /// The place in `sections` of each of the script's.
    places: Vec<usize>,
    sections: Vec<Sums>,
    all: Sums,
    first_frame: usize,
    /// What the encoder wrote last.
    bytes: Vec<u8>,
}

impl Tally {
    pub(super) fn new(name: String, encoder: Box<dyn Encoder>, script: &Script) -> Self {
        let mut sections: Vec<Sums> = Vec::new();
        let places = script.sections().iter().map(|section| {
            let known = sections.iter().position(|sums| sums.name == section.name);
            known.unwrap_or_else(|| {
                sections.push(Sums::new(&section.name));
                sections.len() - 1
            })
        });
        let places = places.collect();
        Self {
            name,
            encoder,
            streams: LEVELS.map(Stream::new),
            places,
            sections,
            all: Sums::new("all"),
            first_frame: 0,
            bytes: Vec::new(),
        }
    }

    /// Encodes the frame `drawn`, which belongs to that section of the script; the first belongs to
    /// none.
    pub(super) fn take(&mut self, section: Option<usize>, changes: &Changes, drawn: &Buffer) {
        self.bytes.clear();
        let start = Instant::now();
        self.encoder.encode(changes, &mut self.bytes);
        let time = start.elapsed();
        let compressed = self.streams.each_mut().map(|stream| {
            let start = Instant::now();
            (stream.size_of(&self.bytes), start.elapsed())
        });
        let Some(section) = section else {
            self.first_frame = self.bytes.len();
            return;
        };
        let difference = Difference::of(&*self.encoder, drawn);
        for sums in [&mut self.sections[self.places[section]], &mut self.all] {
            sums.bytes.push(self.bytes.len());
            for (sum, (bytes, time)) in sums.compressed.iter_mut().zip(compressed) {
                sum.0 += bytes;
                sum.1 += time;
            }
            sums.time += time;
            sums.difference.add(difference);
        }
    }

    /// What it has come to, beside what the first of the encoders has; `None` for that one itself.
    pub(super) fn finish(self, first: Option<&EncoderReport>) -> EncoderReport {
        let sections = self.sections.into_iter().filter(|sums| !sums.name.is_empty());
        let sections = sections.enumerate();
        EncoderReport {
            name: self.name,
            first_frame: self.first_frame,
            sections: sections
                .map(|(index, sums)| sums.finish(first.map(|first| &first.sections[index])))
                .collect(),
            all: self.all.finish(first.map(|first| &first.all)),
        }
    }
}

/// What the frames of a part have taken so far.
struct Sums {
    name: String,
    bytes: Vec<usize>,
    compressed: [(usize, Duration); 2],
    time: Duration,
    difference: Difference,
}

impl Sums {
    fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            bytes: Vec::new(),
            compressed: [(0, Duration::ZERO); 2],
            time: Duration::ZERO,
            difference: Difference::default(),
        }
    }

    fn finish(mut self, first: Option<&Part>) -> Part {
        self.bytes.sort_unstable();
        let frames = self.bytes.len();
        let count = frames.max(1) as f64;
        let mean = self.bytes.iter().sum::<usize>() as f64 / count;
        Part {
            name: self.name,
            frames,
            bytes: Bytes {
                mean,
                median: share(&self.bytes, 50),
                percentile_95: share(&self.bytes, 95),
                largest: share(&self.bytes, 100),
            },
            ratio: mean / first.map_or(mean, |first| first.bytes.mean),
            compressed: self.compressed.map(|(bytes, time)| Compressed {
                bytes: bytes as f64 / count,
                time: time.div_f64(count),
            }),
            time: self.time.div_f64(count),
            seen: Seen {
                signal_to_noise: self.difference.signal_to_noise(),
                mean_distance: self.difference.mean_distance(),
                largest_distance: self.difference.largest_distance(),
            },
        }
    }
}

/// What so many percent of the `sorted` numbers do not exceed; 0 where there are none.
fn share(sorted: &[usize], percent: usize) -> usize {
    let rank = (sorted.len() * percent).div_ceil(100);
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or_default()
}

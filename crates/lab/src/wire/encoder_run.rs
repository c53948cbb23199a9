//! The frames of a script through one encoder.

use std::time::{Duration, Instant};

use ratatui::buffer::Buffer;

use super::EncoderReport;
use super::compression::{LEVELS, Stream};
use super::difference::Difference;
use super::encoder::{Changes, Encoder};
use cellcaster::game::Script;

/// The results of a part of a script.
#[derive(Clone, Debug)]
pub struct Part {
    /// The section's name; `all` for all of them.
    pub name: String,
    /// The number of frames.
    pub frames: usize,
    /// The number of bytes per frame.
    pub bytes: Bytes,
    /// The ratio of the mean number of bytes to that of ratatui's own encoder; NaN if both are 0.
    pub ratio: f64,
    /// The compressed frames, by zlib at level 1, and at level 6 as with `ssh -C`.
    pub compressed: [Compressed; 2],
    /// The mean time to encode a frame.
    pub time: Duration,
    /// The colour errors that the viewer sees.
    pub seen: Seen,
}

/// The mean of a compressed frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compressed {
    /// The number of bytes.
    pub bytes: f64,
    /// The time to compress.
    pub time: Duration,
}

/// The number of bytes per frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bytes {
    /// The mean.
    pub mean: f64,
    /// The median.
    pub median: usize,
    /// The 95th percentile.
    pub percentile_95: usize,
    /// The maximum.
    pub largest: usize,
}

/// The difference between the colours on the terminal and those that were drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The peak signal-to-noise ratio, in decibels; infinite if there is no difference.
    pub signal_to_noise: f64,
    /// The mean distance of a pixel's colour, in ΔE of CIE76.
    pub mean_distance: f64,
    /// The largest distance.
    pub largest_distance: f64,
}

/// An encoder and its sums so far.
pub(crate) struct EncoderRun {
    name: String,
    encoder: Box<dyn Encoder>,
    streams: [Stream; 2],
    /// For each section of the script, the index in `sections`.
    places: Vec<usize>,
    sections: Vec<Sums>,
    all: Sums,
    first_frame: usize,
    /// The bytes of the last frame.
    bytes: Vec<u8>,
}

impl EncoderRun {
    pub(crate) fn new(name: String, encoder: Box<dyn Encoder>, script: &Script) -> Self {
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

    /// Encodes the frame `drawn`, which belongs to this section of the script; the first frame has
    /// no section.
    pub(crate) fn take(&mut self, section: Option<usize>, changes: &Changes, drawn: &Buffer) {
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

    /// The results, relative to those of the first encoder; `None` for the first encoder itself.
    pub(crate) fn finish(self, first: Option<&EncoderReport>) -> EncoderReport {
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

/// The sums over the frames of a part.
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

/// The value that this percentage of the `sorted` numbers does not exceed; 0 if there are none.
fn share(sorted: &[usize], percent: usize) -> usize {
    let rank = (sorted.len() * percent).div_ceil(100);
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or_default()
}

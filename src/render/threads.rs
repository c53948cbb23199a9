//! Threads: their number for a frame, and the way they share its rows.
//!
//! Each frame that is large enough starts its own threads. Starting one takes tens of microseconds,
//! and drawing such a frame takes milliseconds. Rejected: a thread pool. It would need a shutdown
//! and sharing between renderers, and would save little.

use std::num::{NonZero, NonZeroU32};
use std::sync::{LazyLock, Mutex, PoisonError};
use std::{fmt, thread};

use super::samples::{MAX_SAMPLED_ROWS, SampleMemory};
use super::{Frame, FrameSize};
use crate::raster::{Band, RasterMemory, SurfaceBuffer, Target};
use crate::visibility::StatsCounter;

/// The least number of samples for each thread. For fewer samples, starting the thread takes longer
/// than it saves. The number is small under fuzzing, because a fuzz target compares numbers of
/// threads in small pictures.
const PIXELS_OF_A_THREAD: usize = 1 << if cfg!(fuzzing) { 8 } else { 19 };

/// The number of bands for each thread. Each band costs the preparation of all columns.
const BANDS_OF_A_THREAD: usize = 2;

/// The number of threads that this machine runs at once. The query takes longer than the drawing of
/// a small frame, so it is made once.
static OF_THE_MACHINE: LazyLock<NonZero<usize>> =
    LazyLock::new(|| thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN));

/// The threads that draw a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Threads {
    /// One thread.
    One(OneThreadReason),
    /// This number of threads. Each draws a band of rows, then the next band that no thread has
    /// taken.
    Bands(NonZero<usize>),
}

/// The reason why one thread draws the whole frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OneThreadReason {
    /// The frame is small. Other threads would take longer to start than the frame takes to draw.
    Small,
    /// No other thread is permitted.
    Only,
}

impl Threads {
    /// The threads for a frame of this size with this number of `samples` along both sides of each
    /// pixel, at most `most` or the number that the machine runs at once.
    pub(crate) fn new(size: FrameSize, samples: NonZeroU32, most: Option<NonZero<usize>>) -> Self {
        let all = size.area() * (samples.get() * samples.get()) as usize;
        let worthwhile = (all / PIXELS_OF_A_THREAD).min(size.height.get() as usize);
        if worthwhile < 2 {
            return Self::One(OneThreadReason::Small);
        }
        let most = most.unwrap_or_else(|| *OF_THE_MACHINE).get();
        match NonZero::new(worthwhile.min(most)) {
            None | Some(NonZero::<usize>::MIN) => Self::One(OneThreadReason::Only),
            Some(count) => Self::Bands(count),
        }
    }

    /// The number of threads.
    pub fn count(self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Bands(count) => count.get(),
        }
    }

    /// The number of rows of a band, for a frame of this height. One thread draws all rows. With
    /// several threads, bands are so small that a thread that finishes early can draw another one.
    fn rows_of_band(self, height: NonZeroU32) -> NonZeroU32 {
        match self {
            Self::One(_) => height,
            Self::Bands(count) => {
                let bands = count.get() * BANDS_OF_A_THREAD;
                NonZeroU32::new(height.get() / bands as u32).unwrap_or(NonZeroU32::MIN)
            }
        }
    }
}

impl fmt::Display for Threads {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::One(OneThreadReason::Small) => f.write_str("one: the picture is small"),
            Self::One(OneThreadReason::Only) => f.write_str("one: no others are allowed"),
            Self::Bands(count) => write!(f, "{count}, by bands of rows: the picture is large"),
        }
    }
}

/// Memory that a thread reuses from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct ThreadMemory {
    raster: RasterMemory,
    samples: SampleMemory,
}

/// Draws all bands of `frame` and its surface buffer with these threads, with `samples` along both
/// sides of each pixel. Adds the counts to `stats`.
pub(crate) fn draw_bands(
    threads: Threads,
    samples: NonZeroU32,
    (frame, surfaces): (&mut Frame, &mut SurfaceBuffer),
    memories: &mut Vec<ThreadMemory>,
    stats: &mut StatsCounter,
    draw: impl Fn(&mut RasterMemory, &mut Target<'_>) + Sync,
) {
    let count = threads.count();
    if memories.len() < count {
        memories.resize_with(count, ThreadMemory::default);
    }
    surfaces.begin(frame.size(), samples.get());
    let mut rows = threads.rows_of_band(frame.size().height);
    if samples.get() > 1 {
        rows = rows.min(MAX_SAMPLED_ROWS);
    }
    let bands = frame.bands(rows).zip(surfaces.bands(rows.saturating_mul(samples)));
    let of_band = stats.of_band();
    let stats = Mutex::new(stats);
    share_out(bands, &mut memories[..count], |(mut band, surfaces), memory| {
        let draw = |band: Band<'_>| {
            let mut target = Target::new(band, surfaces, of_band.clone());
            draw(&mut memory.raster, &mut target);
            target.into_stats()
        };
        let counts = match samples.get() {
            1 => draw(band),
            _ => memory.samples.draw(&mut band, draw),
        };
        stats.lock().unwrap_or_else(PoisonError::into_inner).add(&counts);
    });
}

/// Does `work` for each of `tasks`. Each worker has a thread and takes the next task until none is
/// left. A single worker works in the calling thread.
fn share_out<T, W: Send>(
    tasks: impl Iterator<Item = T> + Send,
    workers: &mut [W],
    work: impl Fn(T, &mut W) + Sync,
) {
    let Some((own, others)) = workers.split_first_mut() else { return };
    if others.is_empty() {
        tasks.for_each(|task| work(task, own));
        return;
    }
    let tasks = Mutex::new(tasks);
    let next = || tasks.lock().unwrap_or_else(PoisonError::into_inner).next();
    let work_with = |worker: &mut W| {
        while let Some(task) = next() {
            work(task, worker);
        }
    };
    let work_with = &work_with;
    thread::scope(|scope| {
        for worker in others {
            // If the system cannot start another thread, the existing threads do all tasks.
            _ = thread::Builder::new().spawn_scoped(scope, move || work_with(worker));
        }
        work_with(own);
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_task_is_done_once() {
        for count in 1..5 {
            let mut workers = vec![Vec::new(); count];
            share_out(0..100, &mut workers, |task, done| done.push(task));
            let mut done = workers.concat();
            done.sort_unstable();
            assert!(done.into_iter().eq(0..100), "{count}");
        }
    }

    #[test]
    fn only_large_frames_are_split() {
        let threads = |width, height, most| {
            let size = FrameSize::new(width, height).unwrap();
            Threads::new(size, NonZeroU32::MIN, NonZero::new(most))
        };
        for (width, height) in [(1, 1), (640, 480), (1280, 720), (4_000_000, 1)] {
            assert_eq!(threads(width, height, 8), Threads::One(OneThreadReason::Small));
        }
        assert_eq!(threads(1920, 1080, 1), Threads::One(OneThreadReason::Only));
        assert_eq!([2, 3, 7].map(|most| threads(1920, 1080, most).count()), [2, 3, 3]);
        assert_eq!([2, 7, 100].map(|most| threads(3840, 2160, most).count()), [2, 7, 15]);
    }
}

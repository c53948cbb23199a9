//! Survivors: the cheapest paths past a cell.

use super::super::style::Shade;
use super::lanes::{Lanes, least, min};
use super::{FRESH, KEPT, Paths, StepKind};

/// The cheapest paths past a cell so far. No two lead to the same colours and cursor column.
pub(crate) struct Survivors {
    pub(crate) cost: Lanes,
    pub(crate) turns: [Turn; KEPT],
    /// The states that they lead to.
    pub(crate) keys: [u64; KEPT],
    /// L*, a* and b* of the new colours.
    pub(crate) fresh: [[f32; 3]; FRESH],
    /// The cost of keeping the cell.
    keep: f32,
    /// A path survives only if it costs less than this.
    highest: f32,
    /// The index of the most expensive one.
    worst: usize,
    is_changed: bool,
}

/// The action of a path on a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn {
    pub(crate) kind: StepKind,
    pub(crate) before: u8,
    /// The sources of the text and background colours: below [`KEPT`] the paths before, from there
    /// on the fresh colours.
    pub(crate) sources: [u8; 2],
}

/// The turns of paths that all keep the cell.
const KEEP: [Turn; KEPT] = {
    let mut turns = [Turn { kind: StepKind::Keep, before: 0, sources: [0; 2] }; KEPT];
    let mut path = 0;
    while path < KEPT {
        turns[path].before = path as u8;
        turns[path].sources = [path as u8; 2];
        path += 1;
    }
    turns
};

impl Survivors {
    /// The paths themselves, before any cell.
    pub(crate) fn of(paths: &Paths) -> Self {
        Self {
            cost: paths.cost,
            turns: KEEP,
            keys: paths.keys,
            fresh: [[0.0; 3]; FRESH],
            highest: 0.0,
            keep: 0.0,
            worst: 0,
            is_changed: false,
        }
    }

    /// Begins with all paths, which keep the cell at this cost in bytes.
    #[inline]
    pub(crate) fn begin(&mut self, paths: &Paths, keep: f32) {
        for (cost, before) in self.cost.iter_mut().zip(&paths.cost) {
            *cost = before + keep;
        }
        self.keep = keep;
        self.keys = paths.keys;
        self.turns = KEEP;
        self.is_changed = false;
        self.find_worst();
    }

    /// Whether the cell shows its target exactly.
    #[inline]
    pub(crate) fn is_right(&self) -> bool {
        self.keep == 0.0
    }

    /// Whether a path of this cost would survive.
    #[inline]
    pub(crate) fn would_keep(&self, cost: f32) -> bool {
        cost < self.highest
    }

    /// Whether any path was added.
    #[inline]
    pub(crate) fn is_changed(&self) -> bool {
        self.is_changed
    }

    /// Adds a path that is cheaper than the most expensive survivor.
    #[inline]
    pub(crate) fn add(&mut self, cost: f32, key: u64, turn: Turn) {
        let mut place = self.worst;
        for path in 0..KEPT {
            place = if self.keys[path] == key { path } else { place };
        }
        if cost < self.cost[place] {
            self.is_changed = true;
            self.cost[place] = cost;
            self.keys[place] = key;
            self.turns[place] = turn;
            self.find_worst();
        }
    }

    #[inline]
    fn find_worst(&mut self) {
        let cost = &self.cost;
        let one = usize::from(cost[1] > cost[0]);
        let other = 2 + usize::from(cost[3] > cost[2]);
        self.worst = if cost[other] > cost[one] { other } else { one };
        self.highest = min(cost[self.worst], least(cost) + BEAM);
    }
}

/// A path does not survive if it costs this many bytes more than the cheapest.
const BEAM: f32 = 24.0;

/// The key of a state: the text and background colours, and the cursor column.
#[inline]
pub(crate) fn key([text, ground]: [Shade; 2], cursor: u16) -> u64 {
    u64::from(text.in_bits()) << TEXT
        | u64::from(ground.in_bits()) << GROUND
        | u64::from(cursor) & CURSOR
}

/// The text and background colours of a key.
#[inline]
pub(crate) fn colors_of(key: u64) -> [Shade; 2] {
    [TEXT, GROUND].map(|place| Shade::from_bits((key >> place) as u32))
}

/// The places of the colours in a key, and the bits of the cursor.
const TEXT: u32 = GROUND + Shade::BITS;
const GROUND: u32 = 12;
const CURSOR: u64 = (1 << GROUND) - 1;

/// The colours that a branch sets: the bits of a key that they change, and the indices of fresh
/// colours.
#[derive(Clone, Copy)]
pub(crate) struct Told {
    kept: u64,
    set: u64,
    /// For text and background, the bits of a path's index to keep, and the bits to set.
    kept_sources: [u8; 2],
    set_sources: [u8; 2],
}

impl Told {
    pub(crate) const NOTHING: Self =
        Self { kept: !CURSOR, set: 0, kept_sources: [u8::MAX; 2], set_sources: [0; 2] };

    /// Adds this colour of the text.
    #[inline]
    pub(crate) fn text(self, shade: Shade, source: u8) -> Self {
        self.with(shade, TEXT, 0, source)
    }

    /// Adds this colour of the background.
    #[inline]
    pub(crate) fn ground(self, shade: Shade, source: u8) -> Self {
        self.with(shade, GROUND, 1, source)
    }

    #[inline]
    fn with(self, shade: Shade, place: u32, which: usize, source: u8) -> Self {
        const SHADE: u64 = (1 << Shade::BITS) - 1;
        let Self { mut kept_sources, mut set_sources, .. } = self;
        (kept_sources[which], set_sources[which]) = (0, KEPT as u8 + source);
        let kept = self.kept & !(SHADE << place);
        let set = self.set | u64::from(shade.in_bits()) << place;
        Self { kept, set, kept_sources, set_sources }
    }

    /// The key after `key`, with the cursor in this column.
    #[inline]
    pub(crate) fn key(self, key: u64, cursor: u16) -> u64 {
        key & self.kept | self.set | u64::from(cursor) & CURSOR
    }

    /// The sources of the colours after `path`.
    #[inline]
    pub(crate) fn sources(self, path: usize) -> [u8; 2] {
        let [text, ground] = self.kept_sources.map(|kept| kept & path as u8);
        [text | self.set_sources[0], ground | self.set_sources[1]]
    }
}

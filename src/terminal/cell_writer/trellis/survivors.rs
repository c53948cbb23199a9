//! The cheapest of all the paths that go past a cell.

use super::super::style::Shade;
use super::lanes::{Lanes, least, min};
use super::{FRESH, KEPT, Paths, StepKind};

/// The cheapest paths past a cell so far, no two of which lead to the same colours and the same place of
/// the cursor.
pub(super) struct Survivors {
    pub(super) cost: Lanes,
    pub(super) turns: [Turn; KEPT],
    /// Where they lead to.
    pub(super) keys: [u64; KEPT],
    /// L*, a* and b* of the colours that the terminal may be told.
    pub(super) fresh: [[f32; 3]; FRESH],
    /// What it costs to leave the cell as it is.
    keep: f32,
    /// What costs no less than this does not survive.
    highest: f32,
    /// Which of them costs most.
    worst: usize,
    is_changed: bool,
}

/// What a path does about a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    pub(super) kind: StepKind,
    pub(super) before: u8,
    /// Where the colours of text and ground come from: the paths before, and then the fresh ones.
    pub(super) sources: [u8; 2],
}

/// What all paths do that leave the cell as it is.
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
    /// Those paths.
    pub(super) fn of(paths: &Paths) -> Self {
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

    /// Begins with all paths that leave the cell as it is, for so many bytes.
    #[inline]
    pub(super) fn begin(&mut self, paths: &Paths, keep: f32) {
        for (cost, before) in self.cost.iter_mut().zip(&paths.cost) {
            *cost = before + keep;
        }
        self.keep = keep;
        self.keys = paths.keys;
        self.turns = KEEP;
        self.is_changed = false;
        self.find_worst();
    }

    /// Whether the cell shows what it is to show.
    #[inline]
    pub(super) fn is_right(&self) -> bool {
        self.keep == 0.0
    }

    /// Whether a path of that cost would survive.
    #[inline]
    pub(super) fn would_keep(&self, cost: f32) -> bool {
        cost < self.highest
    }

    /// Whether any was added.
    #[inline]
    pub(super) fn is_changed(&self) -> bool {
        self.is_changed
    }

    /// Adds a path that is cheaper than the worst.
    #[inline]
    pub(super) fn add(&mut self, cost: f32, key: u64, turn: Turn) {
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

/// What costs so many bytes more than the cheapest does not survive.
const BEAM: f32 = 24.0;

/// What tells apart where paths lead to: the colours of text and ground, and the cursor.
#[inline]
pub(super) fn key([text, ground]: [Shade; 2], cursor: u16) -> u64 {
    u64::from(text.in_bits()) << TEXT
        | u64::from(ground.in_bits()) << GROUND
        | u64::from(cursor) & CURSOR
}

/// The colours of text and ground that a key tells of.
#[inline]
pub(super) fn colors_of(key: u64) -> [Shade; 2] {
    [TEXT, GROUND].map(|place| Shade::from_bits((key >> place) as u32))
}

/// Where in a key the colours are, and which bits the cursor has.
const TEXT: u32 = GROUND + Shade::BITS;
const GROUND: u32 = 12;
const CURSOR: u64 = (1 << GROUND) - 1;

/// The colours that the terminal is told: by which bits of a key they change, and which of the fresh ones they are.
#[derive(Clone, Copy)]
pub(super) struct Told {
    kept: u64,
    set: u64,
    /// For text and ground, the bits of a path's number that are kept, and those that are set.
    kept_sources: [u8; 2],
    set_sources: [u8; 2],
}

impl Told {
    pub(super) const NOTHING: Self =
        Self { kept: !CURSOR, set: 0, kept_sources: [u8::MAX; 2], set_sources: [0; 2] };

    /// And that colour of the text.
    #[inline]
    pub(super) fn text(self, shade: Shade, source: u8) -> Self {
        self.with(shade, TEXT, 0, source)
    }

    /// And that colour of the ground.
    #[inline]
    pub(super) fn ground(self, shade: Shade, source: u8) -> Self {
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

    /// Where a path leads to from `key`, when the cursor stands there.
    #[inline]
    pub(super) fn key(self, key: u64, cursor: u16) -> u64 {
        key & self.kept | self.set | u64::from(cursor) & CURSOR
    }

    /// Where the colours come from after `path`.
    #[inline]
    pub(super) fn sources(self, path: usize) -> [u8; 2] {
        let [text, ground] = self.kept_sources.map(|kept| kept & path as u8);
        [text | self.set_sources[0], ground | self.set_sources[1]]
    }
}

//! Frame stats: the cost of a frame, counted as the work is done.
//!
//! Drawing checks whether the counts are kept once per span and once per wall column, never per pixel.
//! Rejected: compiling all drawing code a second time, with counting. A fifth of the drawing code then served
//! only explanations of frames.

/// A kind of surface that pixels are written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Pass {
    /// Ceilings.
    Ceiling,
    /// Floors.
    Floor,
    /// The sky: above cells without a ceiling, or beyond the edge of the map.
    Sky,
    /// Walls that rays hit.
    Walls,
    /// Masked and translucent faces that rays passed.
    SeeThrough,
    /// Things and figures.
    Things,
}

/// The cost of a frame or of a band, if counts are kept.
#[derive(Clone, Debug, Default)]
pub(crate) struct StatsCounter {
    counts: Option<FrameStats>,
}

impl StatsCounter {
    /// Stats that are kept, starting at zero.
    pub(crate) fn kept() -> Self {
        Self { counts: Some(FrameStats::default()) }
    }

    /// The stats of a band, starting at zero. They are kept only if these are.
    pub(crate) fn of_band(&self) -> Self {
        Self { counts: self.counts.map(|_| FrameStats::default()) }
    }

    /// Returns true if the counts are kept.
    #[inline]
    pub(crate) fn are_kept(&self) -> bool {
        self.counts.is_some()
    }

    /// The counts; zeros if they are not kept.
    pub(crate) fn counts(&self) -> FrameStats {
        self.counts.unwrap_or_default()
    }

    /// Applies `change` to the counts, if they are kept.
    #[inline]
    pub(crate) fn change(&mut self, change: impl FnOnce(&mut FrameStats)) {
        /// A separate function, because most frames do not count and the inlined part should stay small.
        #[cold]
        #[inline(never)]
        fn call(change: impl FnOnce(&mut FrameStats), counts: &mut FrameStats) {
            change(counts);
        }
        if let Some(counts) = &mut self.counts {
            call(change, counts);
        }
    }

    /// Adds the counts of a band. A band has no walk counts, because visibility is found once per frame.
    pub(crate) fn add(&mut self, band: &Self) {
        let Self { counts: Some(band) } = band else { return };
        self.change(|counts| counts.add(band));
    }
}

/// The texels read and the pixels written by a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PassStats {
    /// The texels read, repeated reads included.
    pub texels: u64,
    /// The pixels written, repeated writes included.
    pub pixels: u64,
}

/// The cost of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct FrameStats {
    /// The cost of visibility.
    pub walk: WalkStats,
    /// The cost of ceilings.
    pub ceiling: PassStats,
    /// The cost of floors.
    pub floor: PassStats,
    /// The cost of the sky.
    pub sky: PassStats,
    /// The cost of walls.
    pub walls: PassStats,
    /// The cost of masked and translucent columns.
    pub see_through: PassStats,
    /// The cost of things and figures.
    pub things: PassStats,
    /// The things in cells that may be in view, plus all figures, counted again for each mirror image.
    pub things_considered: u64,
    /// The billboards of things and figures in view.
    pub things_drawn: u64,
    /// The spans of floor, ceiling and sky.
    pub spans: u64,
    /// The number of pixel writes after the first write to each pixel.
    pub overwritten: u64,
}

/// The cost of visibility: finding the surfaces in view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct WalkStats {
    /// The rays cast. Most columns need no ray of their own.
    pub rays: u64,
    /// The cells that the rays entered.
    pub cells: u64,
    /// The lookups of a tile or of a clear distance. There are fewer lookups than cells if the rays skip cells.
    pub looks: u64,
    /// The visits to sectors. One visit covers the rays of neighbouring columns.
    pub sectors: u64,
    /// The faces found.
    pub faces: u64,
    /// The reflections of rays in mirrors, one per column.
    pub bounces: u64,
}

impl Pass {
    const ALL: [Self; 6] =
        [Self::Ceiling, Self::Floor, Self::Sky, Self::Walls, Self::SeeThrough, Self::Things];
}

impl FrameStats {
    /// The cost of `pass`.
    pub fn of(&self, pass: Pass) -> PassStats {
        let mut stats = *self;
        *stats.of_mut(pass)
    }

    /// The pixels written by all passes together.
    pub fn pixels(&self) -> u64 {
        Pass::ALL.into_iter().map(|pass| self.of(pass).pixels).sum()
    }

    pub(crate) fn of_mut(&mut self, pass: Pass) -> &mut PassStats {
        match pass {
            Pass::Ceiling => &mut self.ceiling,
            Pass::Floor => &mut self.floor,
            Pass::Sky => &mut self.sky,
            Pass::Walls => &mut self.walls,
            Pass::SeeThrough => &mut self.see_through,
            Pass::Things => &mut self.things,
        }
    }

    /// Adds the counts of a band.
    fn add(&mut self, band: &Self) {
        for pass in Pass::ALL {
            let (sum, of_band) = (self.of_mut(pass), band.of(pass));
            sum.texels += of_band.texels;
            sum.pixels += of_band.pixels;
        }
        self.spans += band.spans;
    }
}

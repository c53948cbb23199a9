//! Frame stats: what a frame cost, counted where it is spent.
//!
//! Drawing is generic over [`Stats`], and a frame that nobody wants explained is drawn with `()`, which
//! counts nothing and leaves no code behind.

/// A kind of surface that pixels are written for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Pass {
    /// What is overhead.
    Ceiling,
    /// What is below.
    Floor,
    /// What is seen in place of a ceiling, or beyond the edge of the map.
    Sky,
    /// What the rays hit.
    Walls,
    /// What the rays passed.
    SeeThrough,
    /// What stands in the cells.
    Things,
}

/// Counts what a frame, or a band of it, costs.
pub(crate) trait Stats: Default + Send {
    /// Whether anything is counted.
    const ARE_KEPT: bool;

    /// Changes them by `change`, if they are kept.
    fn change(&mut self, change: impl FnOnce(&mut FrameStats));

    /// Adds all of `other`.
    fn add(&mut self, other: Self);
}

impl Stats for () {
    const ARE_KEPT: bool = false;

    #[inline]
    fn change(&mut self, _: impl FnOnce(&mut FrameStats)) {}

    #[inline]
    fn add(&mut self, (): Self) {}
}

/// What a pass read and wrote.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PassStats {
    /// Texels that were read, each as often as that.
    pub texels: u64,
    /// Pixels that were written, each as often as that.
    pub pixels: u64,
}

/// What a frame cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct FrameStats {
    /// Rays that were cast: at most one for each column of pixels, and another one where that may pass
    /// what it hit.
    pub rays: u64,
    /// Cells that they entered, the ones that they hit included.
    pub cells: u64,
    /// How often they looked where they were: less than once a cell, where they do not stop in each.
    pub looks: u64,
    /// The ceiling.
    pub ceiling: PassStats,
    /// The floor.
    pub floor: PassStats,
    /// The sky.
    pub sky: PassStats,
    /// The walls.
    pub walls: PassStats,
    /// Masked and translucent columns.
    pub see_through: PassStats,
    /// Things.
    pub things: PassStats,
    /// Things that may be in view by the cell that they stand in.
    pub things_considered: u64,
    /// Those that are.
    pub things_drawn: u64,
    /// What it took to see above, below and in mirrors.
    pub portals: PortalStats,
    /// Spans of floor, ceiling and sky.
    pub spans: u64,
    /// Pixels that were written more than once, each as often as that beyond the first time.
    pub overwritten: u64,
}

/// What it cost to follow rays through portals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PortalStats {
    /// Rays that were followed.
    pub rays: u64,
    /// Cells that they entered.
    pub cells: u64,
    /// Faces that they met, each as wide as a pixel.
    pub faces: u64,
    /// How often they were reflected.
    pub bounces: u64,
}

impl Pass {
    const ALL: [Self; 6] =
        [Self::Ceiling, Self::Floor, Self::Sky, Self::Walls, Self::SeeThrough, Self::Things];
}

impl FrameStats {
    /// What `pass` read and wrote.
    pub fn of(&self, pass: Pass) -> PassStats {
        match pass {
            Pass::Ceiling => self.ceiling,
            Pass::Floor => self.floor,
            Pass::Sky => self.sky,
            Pass::Walls => self.walls,
            Pass::SeeThrough => self.see_through,
            Pass::Things => self.things,
        }
    }

    /// Pixels that were written by all passes together.
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
}

impl Stats for FrameStats {
    const ARE_KEPT: bool = true;

    fn change(&mut self, change: impl FnOnce(&mut FrameStats)) {
        change(self);
    }

    /// Adds what `band` counted, a part of the drawing; finding what is in view is counted once.
    fn add(&mut self, band: Self) {
        for pass in Pass::ALL {
            let (sum, of_band) = (self.of_mut(pass), band.of(pass));
            sum.texels += of_band.texels;
            sum.pixels += of_band.pixels;
        }
        self.spans += band.spans;
    }
}

//! The tally: what a frame cost, counted where it is spent.
//!
//! The passes are generic over it, and a frame that nobody wants explained is drawn with `()`, which
//! counts nothing and leaves no code behind.

use super::WindowCounts;

/// A pass that writes pixels.
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

/// Something that is told what is spent.
///
/// Each band of a frame has one of its own.
pub(super) trait Tally: Default + Send {
    /// So many texels are read.
    fn texels(&mut self, pass: Pass, count: usize);

    /// So many pixels are written.
    fn pixels(&mut self, pass: Pass, count: usize);

    /// So many things are looked at, and so many of them drawn.
    fn things(&mut self, considered: usize, drawn: usize);

    /// So many stretches of rows are drawn, of what is not level.
    fn spans(&mut self, count: u64);

    /// All that `band` was told.
    fn add(&mut self, band: Self);
}

impl Pass {
    const ALL: [Self; 6] =
        [Self::Ceiling, Self::Floor, Self::Sky, Self::Walls, Self::SeeThrough, Self::Things];
}

impl Tally for () {
    #[inline]
    fn texels(&mut self, _: Pass, _: usize) {}

    #[inline]
    fn pixels(&mut self, _: Pass, _: usize) {}

    #[inline]
    fn things(&mut self, _: usize, _: usize) {}

    #[inline]
    fn spans(&mut self, _: u64) {}

    #[inline]
    fn add(&mut self, (): Self) {}
}

/// What a pass read and wrote.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PassCounts {
    /// Texels that were read, each as often as that.
    pub texels: u64,
    /// Pixels that were written, each as often as that.
    pub pixels: u64,
}

/// What a frame cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Counts {
    /// Rays that were cast: at most one for each column of pixels, and another one where that may pass
    /// what it hit.
    pub rays: u64,
    /// Cells that they entered, the ones that they hit included.
    pub cells: u64,
    /// How often they looked where they were: less than once a cell, where they do not stop in each.
    pub looks: u64,
    /// The ceiling.
    pub ceiling: PassCounts,
    /// The floor.
    pub floor: PassCounts,
    /// The sky.
    pub sky: PassCounts,
    /// The walls.
    pub walls: PassCounts,
    /// Masks and glass.
    pub see_through: PassCounts,
    /// Things.
    pub things: PassCounts,
    /// Things that may be in view by the cell that they stand in.
    pub things_considered: u64,
    /// Those that are.
    pub things_drawn: u64,
    /// What it took to see above, below and in mirrors, where the world is not level.
    pub windows: WindowCounts,
    /// Pixels that were written more than once, each as often as that beyond the first time.
    pub overwritten: u64,
}

impl Counts {
    /// What `pass` read and wrote.
    pub fn of(&self, pass: Pass) -> PassCounts {
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

    fn of_mut(&mut self, pass: Pass) -> &mut PassCounts {
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

impl Tally for Counts {
    fn texels(&mut self, pass: Pass, count: usize) {
        self.of_mut(pass).texels += count as u64;
    }

    fn pixels(&mut self, pass: Pass, count: usize) {
        self.of_mut(pass).pixels += count as u64;
    }

    fn things(&mut self, considered: usize, drawn: usize) {
        self.things_considered += considered as u64;
        self.things_drawn += drawn as u64;
    }

    fn spans(&mut self, count: u64) {
        self.windows.spans += count;
    }

    fn add(&mut self, band: Self) {
        for pass in Pass::ALL {
            self.texels(pass, band.of(pass).texels as usize);
            self.pixels(pass, band.of(pass).pixels as usize);
        }
        self.things(band.things_considered as usize, band.things_drawn as usize);
        self.spans(band.windows.spans);
    }
}

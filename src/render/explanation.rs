//! An explanation: the plan of a frame beside what the frame cost.

use std::cell::Cell;
use std::fmt;

use super::projection::Projection;
use super::see_through::Passed;
use super::tally::{Counts, Pass};
use super::{Geometry, Plan, WindowCounts, columns};
use crate::cast::{Caster, Hit, MajorAxisTraversal, Ray, Walk};
use crate::world::{Grid, World};

/// How a frame was drawn, and what it cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// How it was drawn.
    pub plan: Plan,
    /// What it cost.
    pub counts: Counts,
}

impl fmt::Display for Explanation {
    /// Writes a few lines for people.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { plan, counts } = self;
        write!(f, "{plan}")?;
        writeln!(f)?;
        let Counts { rays, cells, looks, .. } = counts;
        writeln!(f, "rays     {rays:>10} cast, into {cells} cells, by {looks} looks")?;
        if let Geometry::Windows(_) = plan.geometry {
            let WindowCounts { faces, spans, bounces, .. } = counts.windows;
            writeln!(f, "windows  {faces:>10} faces, {spans} spans, {bounces} bounces")?;
        }
        let passes = [
            ("ceiling", Pass::Ceiling),
            ("floor", Pass::Floor),
            ("sky", Pass::Sky),
            ("walls", Pass::Walls),
            ("through", Pass::SeeThrough),
            ("things", Pass::Things),
        ];
        for (name, pass) in passes {
            let counts = counts.of(pass);
            let (pixels, texels) = (counts.pixels, counts.texels);
            writeln!(f, "{name:8} {pixels:>10} pixels written, {texels} texels read")?;
        }
        let (considered, drawn) = (counts.things_considered, counts.things_drawn);
        writeln!(f, "in view  {considered:>10} things considered, {drawn} of them drawn")?;
        let (pixels, overwritten) = (counts.pixels(), counts.overwritten);
        writeln!(f, "all      {pixels:>10} pixels written, {overwritten} of them overwritten")
    }
}

/// What rays cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(super) struct RayCounts {
    /// How many of them are cast.
    pub(super) rays: u64,
    /// How many cells they enter until they hit something or leave the map.
    pub(super) cells: u64,
    /// How often they look where they are.
    pub(super) looks: u64,
}

/// Counts the rays of a picture of `world` that is level.
pub(super) struct RaysOf<'a> {
    pub(super) world: &'a World,
    pub(super) projection: &'a Projection,
}

impl RaysOf<'_> {
    pub(super) fn count<C: Caster>(self, caster: &C) -> RayCounts {
        let counting = Counting { caster, counts: Cell::default() };
        let (mut columns, mut passed) = (Vec::new(), Passed::default());
        columns::cast(&counting, self.world, self.projection, &mut columns, &mut passed);
        counting.counts.get()
    }
}

/// A caster that counts what it is asked.
struct Counting<'a, C> {
    caster: &'a C,
    counts: Cell<RayCounts>,
}

impl<C> Counting<'_, C> {
    fn count(&self, grid: &Grid, ray: &Ray) {
        let mut entered = 0;
        for crossing in Walk::new(grid, ray) {
            entered += 1;
            if grid.is_solid_tile(crossing.tile) {
                break;
            }
        }
        let looked = MajorAxisTraversal::new(grid, ray).map_or(entered, |mut traversal| {
            traversal.next();
            traversal.lookups()
        });
        let RayCounts { rays, cells, looks } = self.counts.get();
        let counts = RayCounts { rays: rays + 1, cells: cells + entered, looks: looks + looked };
        self.counts.set(counts);
    }
}

impl<C: Caster> Caster for Counting<'_, C> {
    fn cast(&self, grid: &Grid, ray: &Ray) -> Option<Hit> {
        self.count(grid, ray);
        self.caster.cast(grid, ray)
    }

    fn follows_between(&self, left: &Hit, right: &Hit) -> bool {
        self.caster.follows_between(left, right)
    }

    fn cast_through(&self, world: &World, ray: &Ray, passed: impl FnMut(Hit)) -> Option<Hit> {
        self.count(world.grid(), ray);
        self.caster.cast_through(world, ray, passed)
    }
}

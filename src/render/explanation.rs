//! An explanation: the plan of a frame beside what the frame cost.

use std::fmt;

use super::projection::Projection;
use super::tally::{Counts, Pass};
use super::{Geometry, Plan, WindowCounts};
use crate::cast::{Sweep, Walk};
use crate::world::Grid;

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

/// How many cells the rays of a picture enter until they hit something or leave the map, and how often
/// they look where they are.
pub(super) fn cells_entered(grid: &Grid, projection: &Projection) -> (u64, u64) {
    projection.rays().fold((0, 0), |(all_cells, all_looks), ray| {
        let mut cells = 0;
        for crossing in Walk::new(grid, &ray) {
            cells += 1;
            if grid.is_solid_tile(crossing.tile) {
                break;
            }
        }
        let looks = Sweep::new(grid, &ray).map_or(cells, |mut sweep| {
            sweep.next();
            sweep.looks()
        });
        (all_cells + cells, all_looks + looks)
    })
}

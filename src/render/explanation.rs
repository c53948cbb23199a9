//! An explanation: the plan of a frame and its cost.

use std::fmt;

use super::{FramePlan, FrameStats, Pass, PortalStats, Threads, Visibility};

/// The plan of a frame and its cost.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explanation {
    /// The loops that drew it.
    pub plan: FramePlan,
    /// The threads that drew it.
    pub threads: Threads,
    /// The counts.
    pub stats: FrameStats,
}

impl fmt::Display for Explanation {
    /// Writes a few lines of text.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { plan, threads, stats } = self;
        write!(f, "{plan}")?;
        writeln!(f, "threads  {threads}")?;
        writeln!(f)?;
        let FrameStats { rays, cells, looks, spans, .. } = stats;
        writeln!(f, "rays     {rays:>10} cast, into {cells} cells, by {looks} looks")?;
        if plan.visibility != Visibility::Flat {
            let PortalStats { rays, faces, bounces, .. } = stats.portals;
            writeln!(
                f,
                "portals  {rays:>10} rays, {faces} faces, {spans} spans, {bounces} bounces"
            )?;
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
            let counts = stats.of(pass);
            let (pixels, texels) = (counts.pixels, counts.texels);
            writeln!(f, "{name:8} {pixels:>10} pixels written, {texels} texels read")?;
        }
        let (considered, drawn) = (stats.things_considered, stats.things_drawn);
        writeln!(f, "in view  {considered:>10} things considered, {drawn} of them drawn")?;
        let (pixels, overwritten) = (stats.pixels(), stats.overwritten);
        writeln!(f, "all      {pixels:>10} pixels written, {overwritten} of them overwritten")
    }
}

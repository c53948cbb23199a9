//! The text of a plan: a line for each part, with its loop and the reason.

use std::fmt;

use super::{
    CeilingLoop, FramePlan, PlaneLoop, RayLoop, SkyLoop, ThingLoop, Visibility, WallLoop,
    WhyPortals,
};
use crate::visibility::Filter;

impl fmt::Display for FramePlan {
    /// Writes a line for each pass, with its loop and the reason.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "view     {}", self.visibility)?;
        writeln!(f, "rays     {}", self.rays)?;
        writeln!(f, "ceiling  {}", self.ceiling)?;
        writeln!(f, "floor    {}", self.floor)?;
        writeln!(f, "sky      {}", self.sky)?;
        writeln!(f, "walls    {}", self.walls)?;
        writeln!(f, "things   {}", self.things)?;
        writeln!(f, "filter   {}", self.filter)
    }
}

impl fmt::Display for Visibility {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Flat => f.write_str("flat: a ray ends at the first wall"),
            Self::Mixed(why) => write!(f, "flat, and portals in part of it: {why}"),
            Self::Portals(why) => write!(f, "portals: {why}"),
        }
    }
}

impl fmt::Display for WhyPortals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Heights => "floors, ceilings or walls are not all of one height",
            Self::Mirrors => "there are mirrors",
            Self::Eye => "the eye is not between floor and ceiling",
        })
    }
}

impl fmt::Display for RayLoop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Cells => "cell by cell: each is looked at",
            Self::Lines => "line by line, along one axis: walls are near",
            Self::Leaps => "many lines at once, along one axis: most of the map is empty",
        })
    }
}

impl fmt::Display for PlaneLoop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fill(color) => write!(f, "one fill: it is {color} everywhere"),
            Self::FillRows(color) => write!(f, "a fill for each row: it is {color}, in fog"),
            Self::Spans => f.write_str("visible spans: its covering is the same everywhere"),
            Self::Tiles => f.write_str("visible spans, cut by tile: tiles differ"),
        }
    }
}

impl fmt::Display for CeilingLoop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sky => f.write_str("not drawn: there is only sky"),
            Self::Plane(plane) => plane.fmt(f),
        }
    }
}

impl fmt::Display for SkyLoop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Gradient => "a colour for each row, where there is sky: it is a gradient",
            Self::Panorama => "visible spans, where there is sky: it is a panorama",
        })
    }
}

impl fmt::Display for WallLoop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.textured { "columns of texels" } else { "columns of one colour" })?;
        f.write_str(if self.faded {
            ", faded: there is fog, or a tile that is not fully lit"
        } else {
            ", unfaded: there is no fog, and all is fully lit"
        })
    }
}

impl fmt::Display for ThingLoop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::None => "not drawn: there are none",
            Self::Billboards => "those in view, from far to near",
        })
    }
}

impl fmt::Display for Filter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Mip => "mip: far texels are averaged",
            Self::Area => "area: texels are averaged over each pixel, and walls have smooth ends",
            Self::Nearest => "nearest: every texel is one of the texture's own",
        })
    }
}

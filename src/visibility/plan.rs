//! The frame plan: the loops that draw a frame.
//!
//! The plan is a small value, made from the world and the filter before the drawing. It is matched once per
//! frame, so that the loops contain no code for features that the scene lacks. Its text has a line for each
//! part of the frame, with the loop and the reason.

use std::fmt;
use std::num::NonZeroU32;

use super::FrameSize;
use crate::color::Rgb;
use crate::world::{Ceiling, Covering, Paint, Pattern, Sky, World};

/// The loops that draw a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FramePlan {
    /// The loop for ceilings; `None` if the sky is above every cell.
    pub ceiling: Option<PlaneLoop>,
    /// The loop for the floor.
    pub floor: PlaneLoop,
    /// `true` if the sky, in place of a ceiling or beyond the edge of the map, is a panorama and not a gradient.
    pub has_panorama: bool,
    /// The loop for walls.
    pub walls: WallLoop,
    /// `true` if the world has things or figures.
    pub has_things: bool,
    /// The filter of textures.
    pub filter: Filter,
    /// `true` if anything may be in front of the opaque faces: things, figures, masks, glass or mirrors.
    pub(crate) has_layers: bool,
}

/// A loop that draws the floor or the ceiling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaneLoop {
    /// For one colour everywhere: a single fill, behind the walls.
    Fill(Rgb),
    /// For one colour with fog: a fill for each row.
    FillRows(Rgb),
    /// For one covering everywhere: the spans of each row that no wall covers.
    Spans,
    /// For tiles that differ: the same spans, cut where the tile changes.
    Tiles,
}

/// The loop that draws walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WallLoop {
    /// `true` if any wall has a texture.
    pub textured: bool,
    /// `true` if fog or darkness fades colours.
    pub faded: bool,
    /// `true` if a wall may stand beside a door and show the door's jamb.
    pub jambs: bool,
}

impl FramePlan {
    /// The plan for views of `world`.
    pub fn new(world: &World, filter: Filter) -> Self {
        let tiles = world.tile_facts();
        let is_foggy = world.fog().is_some();
        let is_lamplit = world.has_lamplight();
        let has_things = !world.things().is_empty() || !world.figures().is_empty();
        Self {
            floor: PlaneLoop::new(world.floor(), is_lamplit || tiles.floors_differ, is_foggy),
            ceiling: match world.ceiling() {
                Ceiling::Sky if tiles.are_roofless => None,
                Ceiling::Sky => Some(PlaneLoop::Tiles),
                Ceiling::Covered(covering) => {
                    let varies = is_lamplit || tiles.ceilings_differ;
                    Some(PlaneLoop::new(covering, varies, is_foggy))
                }
            },
            has_panorama: matches!(world.sky(), Sky::Panorama(_)),
            walls: WallLoop {
                textured: tiles.have_textured_walls,
                faded: is_foggy || tiles.are_dim,
                jambs: tiles.have_doors,
            },
            has_things,
            filter,
            has_layers: has_things || tiles.have_see_through,
        }
    }
}

impl PlaneLoop {
    fn new(covering: Covering, varies: bool, is_foggy: bool) -> Self {
        match covering.pattern {
            _ if varies => Self::Tiles,
            Pattern::Plain(Paint::Color(color)) if is_foggy => Self::FillRows(color),
            Pattern::Plain(Paint::Color(color)) => Self::Fill(color),
            _ => Self::Spans,
        }
    }
}

impl fmt::Display for FramePlan {
    /// Writes a line for each pass, with its loop and the reason.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.ceiling {
            Some(plane) => writeln!(f, "ceiling  {plane}")?,
            None => f.write_str("ceiling  not drawn: there is only sky\n")?,
        }
        writeln!(f, "floor    {}", self.floor)?;
        f.write_str(if self.has_panorama {
            "sky      visible spans, where there is sky: it is a panorama\n"
        } else {
            "sky      a colour for each row, where there is sky: it is a gradient\n"
        })?;
        let texels = if self.walls.textured { "texels" } else { "one colour" };
        let fade = if self.walls.faded {
            "faded: there is fog, or a tile that is not fully lit"
        } else {
            "unfaded: there is no fog, and all is fully lit"
        };
        writeln!(f, "walls    columns of {texels}, {fade}")?;
        f.write_str(if self.has_things {
            "things   those in view, from far to near\n"
        } else {
            "things   not drawn: there are none\n"
        })?;
        f.write_str(match self.filter {
            Filter::Mip => "filter   mip: far texels are averaged\n",
            Filter::Area => "filter   area: the mean of nine samples of each pixel\n",
            Filter::Nearest => "filter   nearest: every texel is one of the texture's own\n",
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

/// The method of computing a pixel from the surfaces that it covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Filter {
    /// Samples the mip level whose texels are about as large as the pixel. Far walls and floors do not shimmer.
    #[default]
    Mip,
    /// Samples the texture itself at the pixel's centre. Far surfaces shimmer.
    Nearest,
    /// Shows the mean light of nine samples in each pixel, three across and three down, each drawn as by
    /// [`Filter::Mip`]. Every edge is smooth. The sample in the middle shows the point that the pixel shows under
    /// the other filters.
    Area,
}

impl Filter {
    /// All filters, the default first.
    pub const ALL: [Self; 3] = [Self::Mip, Self::Nearest, Self::Area];

    /// The number of samples of [`Filter::Area`] along both sides of each pixel.
    pub(crate) const AREA_SAMPLES: NonZeroU32 = NonZeroU32::new(3).unwrap();

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mip => "mip",
            Self::Nearest => "nearest",
            Self::Area => "area",
        }
    }

    /// The number of samples along both sides of each pixel, for a frame of `size`.
    pub(crate) fn samples(self, size: FrameSize) -> NonZeroU32 {
        /// Larger frames would have more samples than a `u32` can count.
        const MAX_SIDE: u32 = u32::MAX / Filter::AREA_SAMPLES.get();
        let are_countable = size.width.get().max(size.height.get()) <= MAX_SIDE;
        if self == Self::Area && are_countable { Self::AREA_SAMPLES } else { NonZeroU32::MIN }
    }

    /// The level of detail for a pixel that covers an area of this many texels.
    ///
    /// A texel of each level covers four texels of the level before. The area also decides for a long and
    /// narrow pixel. Rejected: its longer side. Walls seen at an angle would blur along their sharp direction.
    /// Rejected: its shorter side. Such walls would shimmer.
    pub(crate) fn lod(self, area: f64) -> usize {
        match self {
            // The nearest power of four. The exponent of a double is exact on every machine.
            Self::Mip | Self::Area if area >= 0.5 => (exponent(2.0 * area) / 2) as usize,
            Self::Mip | Self::Nearest | Self::Area => 0,
        }
    }
}

/// The binary exponent of a double that is at least 1. Infinity has the greatest exponent.
fn exponent(number: f64) -> u64 {
    const BIAS: u64 = f64::MAX_EXP as u64 - 1;
    (number.to_bits() >> (f64::MANTISSA_DIGITS - 1)) - BIAS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_level_covers_areas_around_a_power_of_four() {
        let lod = [0.0, f64::NAN, 1.9, 2.0, 4.0, 7.9, 8.0, 16.0].map(|area| Filter::Mip.lod(area));
        assert_eq!(lod, [0, 0, 0, 1, 1, 1, 2, 2]);
        assert!(Filter::Mip.lod(f64::INFINITY) > 100);
        assert_eq!(Filter::Nearest.lod(1e9), 0);
    }
}

//! The filter: how a pixel is computed from the surfaces that it covers.

/// How a pixel is computed from the surfaces that it covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Filter {
    /// From the mip level whose texels are about as large as the pixel: far walls and floors do not
    /// shimmer.
    #[default]
    Mip,
    /// From the texture itself, at the pixel's centre: far surfaces shimmer.
    Nearest,
    /// By area: from the mean of the texture over the pixel's width and height on the surface, with walls
    /// blended over what is behind them by the share of the pixel that they cover.
    ///
    /// Walls of level scenes are blended. The borders of tiles and of pieces of a pattern, things, masks, glass, doors,
    /// the sides of pillars and diagonals, and columns that show other heights have hard edges as by
    /// [`Filter::Mip`].
    Area,
}

impl Filter {
    /// All filters, the default first.
    pub const ALL: [Self; 3] = [Self::Mip, Self::Nearest, Self::Area];

    /// The name on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Mip => "mip",
            Self::Nearest => "nearest",
            Self::Area => "area",
        }
    }

    /// The level of detail for a pixel that covers an area of this many texels.
    ///
    /// A texel of each level covers four of the level before. A long and narrow pixel counts by its
    /// area: by its longer side, walls seen at an angle would blur along their sharp direction; by
    /// its shorter side, they would shimmer. [`Filter::Area`] samples by it what it has no
    /// [means](crate::world::texture::AreaLod) for: masks, things and the sky.
    pub(crate) fn lod(self, area: f64) -> usize {
        match self {
            // The nearest power of four. The exponent of a double is exact on every machine.
            Self::Mip | Self::Area if area >= 0.5 => (exponent(2.0 * area) / 2) as usize,
            Self::Mip | Self::Nearest | Self::Area => 0,
        }
    }
}

/// The binary exponent of a double that is at least 1. That of infinity is above all others.
fn exponent(number: f64) -> u64 {
    const BIAS: u64 = f64::MAX_EXP as u64 - 1;
    (number.to_bits() >> (f64::MANTISSA_DIGITS - 1)) - BIAS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_is_for_areas_around_a_power_of_four() {
        let lod = [0.0, f64::NAN, 1.9, 2.0, 4.0, 7.9, 8.0, 16.0].map(|area| Filter::Mip.lod(area));
        assert_eq!(lod, [0, 0, 0, 1, 1, 1, 2, 2]);
        assert!(Filter::Mip.lod(f64::INFINITY) > 100);
        assert_eq!(Filter::Nearest.lod(1e9), 0);
    }
}

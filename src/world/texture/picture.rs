//! The picture of a texture, made from the start or on demand.

use std::num::NonZeroU32;
use std::sync::{Arc, OnceLock};

use super::MipLevel;
use crate::color::Rgb;

/// The picture itself, and what is computed from all of it.
#[derive(Clone)]
pub(crate) struct Picture {
    pub(crate) level: MipLevel,
    pub(crate) mean: Rgb,
}

/// Where a texture has its picture from.
#[derive(Clone)]
pub(crate) enum Source {
    Made(Picture),
    OnDemand { paint: Arc<Paint>, made: OnceLock<Picture> },
}

/// The function that makes a picture: the same one, whenever it is called.
type Paint = dyn Fn() -> Picture + Send + Sync;

impl Picture {
    /// The picture with the texel `texel(x, y)` at `(x, y)`, and its alpha.
    pub(crate) fn from_fn(
        width: NonZeroU32,
        height: NonZeroU32,
        mut texel: impl FnMut(u32, u32) -> (Rgb, u8),
    ) -> Self {
        let (texels, mut alpha): (Vec<Rgb>, Vec<u8>) = (0..width.get())
            .flat_map(|x| (0..height.get()).map(move |y| (x, y)))
            .map(|(x, y)| texel(x, y))
            .unzip();
        if alpha.iter().all(|&alpha| alpha == u8::MAX) {
            alpha = Vec::new();
        }
        let mean = mean(&texels);
        Self { level: MipLevel::new(width, height, texels, alpha), mean }
    }
}

impl Source {
    /// The picture that `paint` makes when it is first read.
    pub(crate) fn on_demand(paint: impl Fn() -> Picture + Send + Sync + 'static) -> Self {
        Self::OnDemand { paint: Arc::new(paint), made: OnceLock::new() }
    }

    #[inline]
    pub(crate) fn picture(&self) -> &Picture {
        match self {
            Self::Made(picture) => picture,
            Self::OnDemand { paint, made } => made.get_or_init(&**paint),
        }
    }

    pub(crate) fn is_made(&self) -> bool {
        match self {
            Self::Made(_) => true,
            Self::OnDemand { made, .. } => made.get().is_some(),
        }
    }

    /// Whether both are painted by the same function.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::OnDemand { paint: one, .. }, Self::OnDemand { paint: other, .. }) => {
                Arc::ptr_eq(one, other)
            }
            _ => false,
        }
    }
}

fn mean(texels: &[Rgb]) -> Rgb {
    let mut sums = [0u64; 3];
    for texel in texels {
        for (sum, channel) in sums.iter_mut().zip(texel.channels()) {
            *sum += u64::from(channel);
        }
    }
    let count = texels.len() as u64;
    let [red, green, blue] = sums.map(|sum| ((sum + count / 2) / count) as u8);
    Rgb::new(red, green, blue)
}

//! The palette of an animation: at most 256 colours in place of any number, found by median cut (Heckbert,
//! "Color Image Quantization for Frame Buffer Display", 1982).

use std::collections::BTreeMap;
use std::mem;

use crate::color::Rgb;
use crate::sort;

/// A palette, and its entry for each colour of the pictures.
pub(crate) struct IndexedPalette {
    /// The channels of the entries.
    pub(crate) entries: Vec<[u8; 3]>,
    indices: BTreeMap<[u8; 3], u8>,
}

impl IndexedPalette {
    /// A palette for `colors` with at most `most` entries; `most` is at most 256. The palette is exact for up to `most`
    /// different colours.
    pub(crate) fn of(colors: impl Iterator<Item = Rgb>, most: usize) -> Self {
        let mut counts = BTreeMap::new();
        colors.for_each(|color| *counts.entry(color.channels()).or_default() += 1);
        let mut counted: Vec<Counted> = counts.into_iter().collect();
        let mut boxes = vec![ColorBox::of(&mut counted)];
        while boxes.len() < most
            && let Some(worst) =
                boxes.iter_mut().max_by_key(|it| it.error).filter(|it| it.error > 0)
        {
            let upper = worst.split();
            boxes.push(upper);
        }
        let entries = boxes.iter().map(ColorBox::mean).collect();
        let indices = (0..=u8::MAX).zip(&boxes);
        let indices = indices.flat_map(|(index, it)| it.colors.iter().map(move |it| (it.0, index)));
        Self { entries, indices: sort::gathered(indices) }
    }

    /// The index of the entry for `color`, which must be one of the colours that the palette was made for.
    pub(crate) fn index(&self, color: Rgb) -> u8 {
        self.indices[&color.channels()]
    }
}

/// A colour, and how often it occurs.
type Counted = ([u8; 3], u64);

/// Colours that share an entry.
struct ColorBox<'c> {
    colors: &'c mut [Counted],
    /// The channel in which the colours differ most.
    channel: usize,
    /// A measure of the error: the number of occurrences times the square of the largest difference.
    error: u64,
}

impl<'c> ColorBox<'c> {
    fn of(colors: &'c mut [Counted]) -> Self {
        let spread = |channel: usize| {
            let values = || colors.iter().map(|(color, _)| u64::from(color[channel]));
            values().max().unwrap_or(0) - values().min().unwrap_or(0)
        };
        let (spread, channel) =
            (0..3).map(|channel| (spread(channel), channel)).max().unwrap_or_default();
        let error = spread * spread * occurrences(colors);
        Self { colors, channel, error }
    }

    /// Splits the box at the median of the channel, and returns the upper half. The box must have two colours.
    fn split(&mut self) -> Self {
        let colors = mem::take(&mut self.colors);
        sort::by_key(colors, |(color, _)| color[self.channel]);
        let half = occurrences(colors) / 2;
        let mut below = 0;
        let at = colors.iter().take_while(|(_, count)| {
            below += count;
            below <= half
        });
        let at = at.count().clamp(1, colors.len() - 1);
        let (lower, upper) = colors.split_at_mut(at);
        *self = Self::of(lower);
        Self::of(upper)
    }

    /// The mean of all occurrences.
    fn mean(&self) -> [u8; 3] {
        let all = occurrences(self.colors).max(1);
        std::array::from_fn(|channel| {
            let sum: u64 =
                self.colors.iter().map(|(color, count)| u64::from(color[channel]) * count).sum();
            ((sum + all / 2) / all) as u8
        })
    }
}

fn occurrences(colors: &[Counted]) -> u64 {
    colors.iter().map(|(_, count)| count).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The palette for `colors`, and its colour for each of them.
    fn shown(colors: &[Rgb]) -> (usize, Vec<Rgb>) {
        let palette = IndexedPalette::of(colors.iter().copied(), 256);
        let entry = |&color| {
            let [red, green, blue] = palette.entries[usize::from(palette.index(color))];
            Rgb::new(red, green, blue)
        };
        (palette.entries.len(), colors.iter().map(entry).collect())
    }

    #[test]
    fn few_colors_are_exact() {
        let colors: Vec<Rgb> = (0..=u8::MAX).map(|it| Rgb::new(it, it / 3, 255 - it)).collect();
        assert_eq!(shown(&colors), (256, colors));
        assert_eq!(shown(&[Rgb::SKY; 5]), (1, vec![Rgb::SKY; 5]));
    }

    #[test]
    fn many_colors_are_close() {
        let channel = || (0..=255).step_by(15);
        let colors: Vec<Rgb> = channel()
            .flat_map(|red| channel().map(move |green| (red, green)))
            .flat_map(|(red, green)| channel().map(move |blue| Rgb::new(red, green, blue)))
            .collect();
        let (entries, shown) = shown(&colors);
        assert_eq!(entries, 256);
        let pairs = colors.iter().zip(shown).map(|(one, other)| (one.channels(), other.channels()));
        let error = |(one, other): ([u8; 3], [u8; 3])| {
            (0..3).map(|channel| one[channel].abs_diff(other[channel])).max()
        };
        let error = pairs.map(error).max().flatten();
        assert!(error <= Some(40), "{error:?}");
    }
}

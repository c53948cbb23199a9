//! An animated SVG: rectangles of equal colour, as one path for each colour of a frame.
//!
//! A frame has only the pixels that differ from the frame before, and covers it. Every [`KEY`] frames, a whole frame
//! begins a group, and the group before disappears, so a browser paints few layers. Text is drawn as pixels, so no font
//! matters. Animations say when each frame appears, and repeat.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::io::{self, Write};

use ratatui::layout::Rect;

use super::palette::IndexedPalette;
use super::{Frames, in_pixels};
use crate::tui::pixels::CellSize;

/// The number of frames from a whole frame to the next.
const KEY: usize = 16;

impl Frames {
    /// Writes the animated SVG.
    pub(crate) fn encode_svg(
        &self,
        cell: CellSize,
        palette: &IndexedPalette,
        mut output: impl Write,
    ) -> io::Result<()> {
        let Rect { width, height, .. } = in_pixels(self.last.area, cell);
        writeln!(
            output,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" shape-rendering=\"crispEdges\">"
        )?;
        let total = self.length();
        let width = usize::from(width);
        let mut shown: Vec<Option<u8>> = vec![None; width * usize::from(height)];
        let (mut data, mut begun) = (Vec::new(), 0);
        for group in self.changes.chunks(KEY) {
            let length: u64 = group.iter().map(|change| u64::from(change.length)).sum();
            let end = begun + length;
            let is_key = |index| index == 0;
            for (index, change) in group.iter().enumerate() {
                let area = in_pixels(change.area, cell);
                change.draw(cell, palette, &mut data);
                let mut drawn = if is_key(index) { shown.clone() } else { vec![None; shown.len()] };
                let rows = data.chunks_exact(area.width.into()).zip(usize::from(area.y)..);
                for (row, y) in rows {
                    for (&color, x) in row.iter().zip(usize::from(area.x)..) {
                        let at = y * width + x;
                        if is_key(index) || shown[at] != Some(color) {
                            drawn[at] = Some(color);
                        }
                        shown[at] = Some(color);
                    }
                }
                let times = [begun, end].map(|frames| frames as f64 / total as f64);
                let seconds = total as f64 / f64::from(self.rate);
                writeln!(
                    output,
                    "<g>{}{}</g>",
                    appearance(times, seconds),
                    paths(&drawn, width, palette)
                )?;
                begun += u64::from(change.length);
            }
        }
        writeln!(output, "</svg>")
    }
}

/// Shows a group from one share of the time to another.
fn appearance([from, to]: [f64; 2], seconds: f64) -> String {
    let (mut values, mut times) = ("none;inline".to_owned(), format!("0;{from:.5}"));
    if from == 0.0 {
        (values, times) = ("inline".to_owned(), "0".to_owned());
    }
    if to < 1.0 {
        values.push_str(";none");
        // Writing to a string cannot fail.
        _ = write!(times, ";{to:.5}");
    }
    format!(
        "<animate attributeName=\"display\" calcMode=\"discrete\" repeatCount=\"indefinite\" \
         dur=\"{seconds:.3}s\" values=\"{values}\" keyTimes=\"{times}\"/>"
    )
}

/// The paths of pixels in rows of this width, one for each colour.
fn paths(pixels: &[Option<u8>], width: usize, palette: &IndexedPalette) -> String {
    let mut rectangles: BTreeMap<u8, Vec<[usize; 4]>> = BTreeMap::new();
    // The rectangles that end with the row above, each with its colour and its first row.
    let mut open: BTreeMap<(usize, usize, u8), usize> = BTreeMap::new();
    let mut close = |(x, width, color): (usize, usize, u8), top: usize, y: usize| {
        rectangles.entry(color).or_default().push([x, top, width, y - top]);
    };
    let rows = pixels.chunks_exact(width);
    let height = rows.len();
    for (y, row) in rows.enumerate() {
        let mut next = BTreeMap::new();
        let mut x = 0;
        for run in row.chunk_by(|one, other| one == other) {
            if let Some(color) = run[0] {
                let key = (x, run.len(), color);
                next.insert(key, open.remove(&key).unwrap_or(y));
            }
            x += run.len();
        }
        for (it, top) in std::mem::replace(&mut open, next) {
            close(it, top, y);
        }
    }
    for (it, top) in open {
        close(it, top, height);
    }
    let mut text = String::new();
    for (color, rectangles) in rectangles {
        let [red, green, blue] = palette.entries[usize::from(color)];
        // Writing to a string cannot fail.
        _ = write!(text, "<path fill=\"#{red:02x}{green:02x}{blue:02x}\" d=\"");
        for [x, y, width, height] in rectangles {
            _ = write!(text, "M{x} {y}h{width}v{height}h-{width}z");
        }
        text.push_str("\"/>");
    }
    text
}

//! The PNG format of a page.

use std::io::{self, Write};

use font8x8::{BASIC_FONTS, LATIN_FONTS, UnicodeFonts};
use png::{BitDepth, ColorType, Encoder};

use super::{Align, Mark, Page, PlotColor};
use cellcaster::color::Rgb;

const BACKGROUND: Rgb = Rgb::WHITE;
const FOREGROUND: Rgb = Rgb::new(0x20, 0x20, 0x20);
const GLYPH_SIDE: i32 = 8;

pub(crate) fn write(page: &Page, output: &mut impl Write) -> io::Result<()> {
    let mut bitmap = Bitmap::blank(page);
    for mark in &page.marks {
        bitmap.put(mark);
    }
    let mut encoder = Encoder::new(output, bitmap.width as u32, bitmap.height as u32);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    if !page.description.is_empty() {
        encoder.add_itxt_chunk("Description".to_owned(), page.description.clone())?;
    }
    let bytes: Vec<u8> = bitmap.pixels.iter().flat_map(|pixel| pixel.channels()).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&bytes)?;
    Ok(writer.finish()?)
}

struct Bitmap {
    width: i32,
    height: i32,
    pixels: Vec<Rgb>,
}

impl Bitmap {
    fn blank(page: &Page) -> Self {
        let (width, height) = (page.width as i32, page.height as i32);
        Self { width, height, pixels: vec![BACKGROUND; width as usize * height as usize] }
    }

    fn put(&mut self, mark: &Mark) {
        match mark {
            Mark::Line { from, to, color } => self.line(*from, *to, *color),
            Mark::Dot { at, radius, color } => self.dot(*at, *radius, color.rgb()),
            Mark::Text { at, align, text } => self.text(*at, *align, text),
        }
    }

    fn set(&mut self, x: i32, y: i32, color: Rgb) {
        if (0..self.width).contains(&x) && (0..self.height).contains(&y) {
            self.pixels[y as usize * self.width as usize + x as usize] = color;
        }
    }

    fn line(&mut self, from: (f64, f64), to: (f64, f64), color: PlotColor) {
        let length = (to.0 - from.0).abs().max((to.1 - from.1).abs()).ceil().max(1.0);
        for step in 0..=length as i32 {
            let share = f64::from(step) / length;
            let x = (from.0 + share * (to.0 - from.0)).round() as i32;
            let y = (from.1 + share * (to.1 - from.1)).round() as i32;
            self.set(x, y, color.rgb());
            if color != PlotColor::Pale {
                self.set(x, y + 1, color.rgb());
            }
        }
    }

    fn dot(&mut self, at: (f64, f64), radius: f64, color: Rgb) {
        let radius = radius as i32;
        let around = -radius - 1..=radius + 1;
        for (dx, dy) in around.clone().flat_map(|dx| around.clone().map(move |dy| (dx, dy))) {
            let square = dx * dx + dy * dy;
            if square <= radius * radius {
                self.set(at.0 as i32 + dx, at.1 as i32 + dy, color);
            } else if square <= (radius + 1) * (radius + 1) {
                self.set(at.0 as i32 + dx, at.1 as i32 + dy, BACKGROUND);
            }
        }
    }

    fn text(&mut self, at: (f64, f64), align: Align, text: &str) {
        let width = GLYPH_SIDE * text.chars().count() as i32;
        let left = at.0 as i32
            - match align {
                Align::Start => 0,
                Align::Middle => width / 2,
                Align::End => width,
            };
        let top = at.1 as i32 - GLYPH_SIDE;
        for (index, character) in (0..).zip(text.chars()) {
            let rows = BASIC_FONTS.get(character).or_else(|| LATIN_FONTS.get(character));
            for (row, dots) in (0..).zip(rows.unwrap_or_default()) {
                for column in (0..GLYPH_SIDE).filter(|column| dots >> column & 1 == 1) {
                    self.set(left + GLYPH_SIDE * index + column, top + row, FOREGROUND);
                }
            }
        }
    }
}

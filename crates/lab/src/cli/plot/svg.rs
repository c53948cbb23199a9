//! The SVG format of a page.

use std::io::{self, Write};

use super::{Align, Mark, Page, PlotColor};

pub(crate) fn write(page: &Page, output: &mut impl Write) -> io::Result<()> {
    let Page { width, height, marks, description } = page;
    writeln!(
        output,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"monospace\" font-size=\"13\">"
    )?;
    if !description.is_empty() {
        writeln!(output, "<desc>{}</desc>", escaped(description))?;
    }
    writeln!(output, "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>")?;
    marks.iter().try_for_each(|mark| write_mark(mark, output))?;
    writeln!(output, "</svg>")
}

fn write_mark(mark: &Mark, output: &mut impl Write) -> io::Result<()> {
    match mark {
        Mark::Line { from, to, color } => {
            let rgb = color.rgb();
            let width = if *color == PlotColor::Pale { 1 } else { 2 };
            writeln!(
                output,
                "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{rgb}\" \
                 stroke-width=\"{width}\"/>",
                from.0, from.1, to.0, to.1
            )
        }
        Mark::Dot { at, radius, color } => {
            let rgb = color.rgb();
            writeln!(
                output,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"{radius}\" fill=\"{rgb}\" stroke=\"#ffffff\"/>",
                at.0, at.1
            )
        }
        Mark::Text { at, align, text } => {
            let anchor = match align {
                Align::Start => "start",
                Align::Middle => "middle",
                Align::End => "end",
            };
            writeln!(
                output,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{}</text>",
                at.0,
                at.1,
                escaped(text)
            )
        }
    }
}

/// `text` without the characters that are special in XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

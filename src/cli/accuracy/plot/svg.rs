//! Marks as an SVG file.

use std::io::{self, Write};

use super::{Align, Mark, PAGE};

pub(super) fn write(marks: &[Mark], output: &mut impl Write) -> io::Result<()> {
    let (width, height) = PAGE;
    writeln!(
        output,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
         font-family=\"monospace\" font-size=\"13\">"
    )?;
    writeln!(output, "<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>")?;
    marks.iter().try_for_each(|mark| write_mark(mark, output))?;
    writeln!(output, "</svg>")
}

fn write_mark(mark: &Mark, output: &mut impl Write) -> io::Result<()> {
    match mark {
        Mark::Line { from, to, is_front } => {
            let (color, width) = if *is_front { ("#d06010", 2) } else { ("#dddddd", 1) };
            writeln!(
                output,
                "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"{color}\" \
                 stroke-width=\"{width}\"/>",
                from.0, from.1, to.0, to.1
            )
        }
        Mark::Dot { at, is_front } => {
            let color = if *is_front { "#d06010" } else { "#3060a0" };
            writeln!(
                output,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"5\" fill=\"{color}\"/>",
                at.0, at.1
            )
        }
        // No method's name and no number has a character that XML would mistake.
        Mark::Text { at, align, text } => {
            let anchor = match align {
                Align::Start => "start",
                Align::Middle => "middle",
                Align::End => "end",
            };
            writeln!(
                output,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"{anchor}\">{text}</text>",
                at.0, at.1
            )
        }
    }
}

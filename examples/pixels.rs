//! The engine without any feature: writes the view from the start of a level as a PPM picture.
//!
//! `cargo run --no-default-features --example pixels > cellar.ppm`

use std::io::{self, BufWriter, Write};

use cellcaster::map::builtin;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::FieldOfView;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let world = builtin::LEVELS[0].world()?;
    let camera = world.start_camera(FieldOfView::default());
    let size = FrameSize::new(320, 200).ok_or("a picture has pixels")?;
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    Renderer::new().render(&world, &camera, &mut frame);

    let mut output = BufWriter::new(io::stdout().lock());
    writeln!(output, "P6 {} {} 255", frame.width(), frame.height())?;
    for pixel in frame.rows().flatten() {
        output.write_all(&pixel.channels())?;
    }
    Ok(output.flush()?)
}

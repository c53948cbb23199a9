//! PNG files. The first two bytes choose how a map uses the file, and the others are the file.
//!
//! A picture is decoded or rejected within bounded memory, and a map that uses it is drawn.

use allocation_counter::measure;
use cellcaster::map;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::FieldOfView;

use crate::bytes::Bytes;
use crate::faults::check_faults;
use crate::files::OneFile;

/// Twice the size of the largest picture in 16-bit RGBA, for the decoder, the texels and their mip
/// levels.
const MAX_BYTES: u64 = 64 << 20;

/// Uses the file in all ways that the input chooses, and draws the map.
pub fn run(data: &[u8]) {
    let mut choices = Bytes::new(data);
    let text = text(&mut choices);
    let file = choices.take(data.len());
    let mut read = None;
    let used = measure(|| read = Some(map::parse(&text, "map", &OneFile(file))));
    assert!(used.bytes_max <= MAX_BYTES, "{} bytes", used.bytes_max);
    let world = match read.expect("it was read") {
        Ok(world) => world,
        Err(faults) => return check_faults(&faults),
    };
    let size = FrameSize::new(40, 24).expect("neither is 0");
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    for seconds in [0.0, 0.7] {
        renderer.set_time(seconds);
        renderer.render(&world, &world.start_camera(FieldOfView::default()), &mut frame);
    }
}

/// A map that uses the file.
fn text(choices: &mut Bytes) -> String {
    let uses = choices.byte();
    let is_used = |bit: u8| uses >> bit & 1 == 1;
    let surface =
        |bit: u8, color: &str| format!("{:?}", if is_used(bit) { "a.png" } else { color });
    let parts = choices.byte();
    let sprite = if is_used(4) {
        let facings = if is_used(5) { "facings = 4, " } else { "" };
        format!("{{ sprite = \"a.png\", {facings}frames = {}, frame_time = 0.5 }}", parts & 7)
    } else {
        "{ sprite = \"barrel\" }".to_owned()
    };
    let floor = if is_used(6) {
        "{ texture = \"a.png\", scale = 0.5 }".to_owned()
    } else {
        surface(1, "#606060")
    };
    let sky = if is_used(3) { "{ panorama = \"a.png\" }" } else { "\"#102040\"" };
    let mask = if is_used(7) { "{ mask = \"a.png\" }" } else { "{ wall = \"#203040\" }" };
    format!(
        "floor = {floor}\nceiling = {}\nsky = {sky}\n\
         grid = '''\n#######\n#@..s.#\n#..m..#\n#######\n'''\n\
         [tiles]\n\"#\" = {{ wall = {} }}\n\"m\" = {mask}\n\
         [things]\n\"@\" = {{ start = 10 }}\n\"s\" = {sprite}\n",
        if is_used(2) { "\"sky\"".to_owned() } else { surface(2, "sky") },
        surface(0, "#a04030"),
    )
}

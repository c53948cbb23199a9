//! Mirrors compared with a copy: a room behind the mirror's position, built in reverse, looks the
//! same without the mirror.

use cellcaster::map::{self, TextureFileError, TextureFiles};
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer, Surface};
use cellcaster::world::{Camera, FieldOfView, Heading, World};
use glam::DVec2;
use proptest::prelude::*;

const COLUMNS: usize = 6;
const ROWS: usize = 4;
/// The kinds of cells in a room: plain floor, textured floor, a wall, a low wall, a step, a tall
/// wall, and glass.
const KINDS: [char; 7] = ['.', 'f', 'a', 'l', 's', 't', 'g'];
/// The largest number of reflections of a ray.
const MAX_BOUNCES: usize = 8;

/// Whether a room is seen in a mirror that faces east or west, and whether it is seen in a mirror
/// that faces north or south.
type Flips = (bool, bool);

/// A texture of noise, and its mirror image.
struct Noise;

impl TextureFiles for Noise {
    fn read(&self, name: &str) -> Result<Vec<u8>, TextureFileError> {
        let is_flipped = |letter| name.contains(letter);
        let side = |index: u8, is_flipped: bool| if is_flipped { 7 - index } else { index };
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 8, 8);
        encoder.set_color(png::ColorType::Rgb);
        let places = (0..8).flat_map(|y| (0..8).map(move |x| (x, y)));
        let texels: Vec<u8> = places
            .flat_map(|(x, y)| {
                let (x, y) = (side(x, is_flipped('x')), side(y, is_flipped('y')));
                [x * 32, y * 32, (x ^ y) * 16]
            })
            .collect();
        encoder.write_header().unwrap().write_image_data(&texels).unwrap();
        Ok(bytes)
    }
}

/// The character for a cell of this kind in a room seen in these mirrors.
fn character(kind: char, (x, y): Flips) -> char {
    let copies = ["#.glstfa", "Q.glBCDE", "q.glcdez", "R.glGHIJ"];
    let index = copies[0].find(kind).unwrap();
    char::from(copies[usize::from(x) + 2 * usize::from(y)].as_bytes()[index])
}

/// The tiles of a room seen in these mirrors.
fn tiles(flips: Flips) -> String {
    let (x, y) = flips;
    let letters = |x, y| format!("{}{}", if x { "x" } else { "" }, if y { "y" } else { "" });
    let floor = format!("noise-{}.png", letters(x, y));
    // After two mirrors, left is left again.
    let wall = format!("noise-{}.png", letters(x != y, false));
    let of = |kind, what: String| format!("\"{}\" = {{ {what} }}\n", character(kind, flips));
    let tiles = of('#', format!("wall = \"{wall}\""))
        + &of('a', format!("wall = \"{wall}\""))
        + &of('t', format!("wall = \"{wall}\", height = 1.75"))
        + &of('s', format!("floor = \"{floor}\", floor_height = 0.25, riser = \"{wall}\""))
        + &of('f', format!("floor = \"{floor}\""));
    if x || y {
        return tiles;
    }
    // Glass that touches a mirror forms one cube with its image. The top of a low wall is also
    // visible, and its texture is mirrored differently from the texture of the sides.
    tiles
        + &of('g', "glass = \"#80c0ff\"".to_owned())
        + &of('l', "wall = \"#a07040\", height = 0.375".to_owned())
}

/// A map with the cells of a room, and with the start outside, behind a wall.
fn parse(rows: &[String], tiles: &str, is_covered: bool) -> World {
    let start: String =
        std::iter::once('@').chain(std::iter::repeat_n('#', rows[0].chars().count() - 1)).collect();
    let text = format!(
        "floor = \"#604830\"\nceiling = \"{}\"\ngrid = '''\n{}\n{start}\n'''\n[tiles]\n{tiles}\
         \"M\" = {{ mirror = \"#204060\", opacity = 0, height = 9 }}\n[things]\n\"@\" = {{ start = 0 }}\n",
        if is_covered { "#506070" } else { "sky" },
        rows.join("\n"),
    );
    map::parse(&text, "room", &Noise).unwrap_or_else(|faults| panic!("{faults}"))
}

/// The cell of a walled room of `cells` at a column and a row.
fn at(cells: &[char], column: usize, row: usize) -> char {
    let is_inside = (1..=COLUMNS).contains(&column) && (1..=ROWS).contains(&row);
    if is_inside { cells[(row - 1) * COLUMNS + column - 1] } else { '#' }
}

/// The same cells, with floor around the camera.
fn with_room_for((x, y): (f64, f64), mut cells: Vec<char>) -> Vec<char> {
    cells[(y as usize - 1) * COLUMNS + x as usize - 1] = '.';
    cells
}

/// A picture, and the surfaces of its pixels.
struct Picture {
    frame: Frame,
    renderer: Renderer,
}

fn picture(world: &World, position: DVec2, degrees: f64, eye: f64) -> Picture {
    let heading = Heading::from_degrees(degrees).unwrap();
    let camera = Camera::new(position, heading, FieldOfView::default()).unwrap();
    let mut frame = Frame::new(FrameSize::new(72, 48).unwrap(), PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    // Without filtering, a texel is either visible or not. An average could be partly visible.
    renderer.set_filter(Filter::Nearest);
    renderer.keep_surfaces(true);
    renderer.render(world, &camera.with_eye(eye).unwrap(), &mut frame);
    Picture { frame, renderer }
}

/// The position of the first difference between two pictures, ignoring the player's own image in
/// one of them.
fn first_difference(reflected: &Picture, straight: &Picture) -> Option<(u32, u32)> {
    let (width, height) = (straight.frame.width(), straight.frame.height());
    let mut places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    places.find(|&(x, y)| {
        let is_player = reflected.renderer.surface(x, y) == Some(Surface::Thing);
        !is_player && reflected.frame.pixel(x, y) != straight.frame.pixel(x, y)
    })
}

/// A coordinate that a double represents exactly, wherever the map starts.
fn place(cells: usize) -> impl Strategy<Value = f64> {
    (1025..1023 + 1024 * cells as u32).prop_map(|parts| f64::from(parts) / 1024.0)
}

fn cells() -> impl Strategy<Value = Vec<char>> {
    let kind = prop_oneof![2 => Just('.'), 1 => prop::sample::select(&KINDS[..])];
    prop::collection::vec(kind, COLUMNS * ROWS)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn a_mirror_shows_the_room_the_other_way_round(
        cells in cells(),
        (is_in_east, is_in_north) in prop::sample::select(vec![(true, false), (false, true), (true, true)]),
        position in (place(COLUMNS), place(ROWS)),
        degrees in 0.0..360.0,
        eye in prop_oneof![2 => Just(0.5), 1 => 0.3..0.95],
        is_covered in any::<bool>(),
    ) {
        let cells = with_room_for(position, cells);
        let columns: Vec<(usize, bool)> = if is_in_east {
            (0..=COLUMNS).map(|x| (x, false)).chain((0..=COLUMNS).rev().map(|x| (x, true))).collect()
        } else {
            (0..COLUMNS + 2).map(|x| (x, false)).collect()
        };
        let rows: Vec<(usize, bool)> = if is_in_north {
            (1..ROWS + 2).rev().map(|y| (y, true)).chain((1..ROWS + 2).map(|y| (y, false))).collect()
        } else {
            (0..ROWS + 2).map(|y| (y, false)).collect()
        };
        let unfolded: Vec<String> = rows
            .iter()
            .map(|&(y, flip_y)| {
                columns.iter().map(|&(x, flip_x)| character(at(&cells, x, y), (flip_x, flip_y))).collect()
            })
            .collect();
        let with_mirrors: Vec<String> = (0..ROWS + 2)
            .map(|y| {
                let cell = |x| match (x, y) {
                    _ if x == COLUMNS + 1 && is_in_east || y == 0 && is_in_north => 'M',
                    _ => character(at(&cells, x, y), (false, false)),
                };
                (0..COLUMNS + 2).map(cell).collect()
            })
            .collect();
        let all_tiles: String =
            [(false, false), (true, false), (false, true), (true, true)].map(tiles).concat();
        let with_mirrors = parse(&with_mirrors, &all_tiles, is_covered);
        let unfolded = parse(&unfolded, &all_tiles, is_covered);

        let position = DVec2::from(position);
        let moved = DVec2::new(0.0, if is_in_north { ROWS as f64 } else { 0.0 });
        let reflected = picture(&with_mirrors, position, degrees, eye);
        let straight = picture(&unfolded, position + moved, degrees, eye);
        prop_assert_eq!(first_difference(&reflected, &straight), None);
    }

    /// Between two mirrors there is a row of rooms, with the mirrors' own colour at its end.
    #[test]
    fn two_mirrors_show_a_row_of_rooms(
        cells in cells(),
        position in (place(COLUMNS), place(ROWS)),
        degrees in prop_oneof![4 => 0.0..360.0, 1 => -5.0..5.0, 1 => 175.0..185.0],
    ) {
        let cells = with_room_for(position, cells);
        let copies = || (0..=2 * MAX_BOUNCES).map(|copy| copy % 2 == 1);
        let row = |y| {
            let room = copies().flat_map(|is_flipped| {
                let columns = (1..=COLUMNS).map(move |x| if is_flipped { COLUMNS + 1 - x } else { x });
                columns.map(move |x| (x, is_flipped))
            });
            room.map(|(x, is_flipped)| character(at(&cells, x, y), (is_flipped, false))).collect::<String>()
        };
        let unfolded: Vec<String> = (0..ROWS + 2).map(|y| format!("n{}n", row(y))).collect();
        let with_mirrors: Vec<String> = (0..ROWS + 2)
            .map(|y| {
                let inside: String =
                    (1..=COLUMNS).map(|x| character(at(&cells, x, y), (false, false))).collect();
                format!("M{inside}M")
            })
            .collect();
        let tiles = tiles((false, false)) + &tiles((true, false)) + "n = { wall = \"#204060\" }\n";
        let with_mirrors = parse(&with_mirrors, &tiles, true);
        let unfolded = parse(&unfolded, &tiles, true);

        let position = DVec2::from(position);
        let moved = DVec2::new((MAX_BOUNCES * COLUMNS) as f64, 0.0);
        let reflected = picture(&with_mirrors, position, degrees, 0.5);
        let straight = picture(&unfolded, position + moved, degrees, 0.5);
        prop_assert_eq!(first_difference(&reflected, &straight), None);
    }

    /// Every picture ends, even with the camera inside a mirror or touching one.
    #[test]
    fn any_view_among_mirrors_can_be_drawn(
        position in (-2.0..6.0, -2.0..6.0),
        is_on_a_line in any::<bool>(),
        degrees in prop_oneof![0.0..360.0, (0..8).prop_map(|eighth| 45.0 * f64::from(eighth))],
        eye in -2.0..3.0,
    ) {
        let rows = ["MMMM", "M.M.", "M..M", "MMMM"].map(str::to_owned);
        let world = parse(&rows, &tiles((false, false)), eye < 1.0);
        let position = DVec2::from(position);
        let position = if is_on_a_line { position.round() } else { position };
        picture(&world, position, degrees, eye);
    }
}

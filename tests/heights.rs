//! Worlds that are not level, against geometry: every pixel of small random ones, computed again by
//! asking all blocks of rock which of them a line through the pixel meets first.

use std::fmt::Write as _;

use cellcaster::map;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, Gap, Heading, Pitch, Rgb, TileKind, World};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

/// How near to an edge a pixel's centre may be before its colour is anybody's guess, in pixels.
const DOUBTFUL: f64 = 1e-5;
/// Further than anything.
const FAR: f64 = 1e30;
const SKY: Rgb = Rgb::new(1, 2, 3);
const GROUND: Rgb = Rgb::new(8, 16, 24);
const COLUMNS: usize = 6;
const ROWS: usize = 5;

/// What a tile of a random world is like.
#[derive(Clone, Copy, Debug)]
enum Kind {
    Wall { height: f64 },
    Open { floor: f64 },
    Covered { floor: f64, room: f64, rock: f64 },
}

fn height() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => (-4..=8_i32).prop_map(|quarters| f64::from(quarters) / 4.0),
        2 => -1.0..2.0,
        1 => prop::sample::select(vec![1e-9, -1e-9, 0.5 + 1e-9, 1e3, -1e3, 1e8, -1e8]),
    ]
}

fn kind() -> impl Strategy<Value = Kind> {
    let above = || prop_oneof![4 => 0.25..2.0, 1 => Just(1e-9), 1 => Just(1e3)];
    let rock = prop_oneof![Just(0.0), 0.1..1.0];
    prop_oneof![
        height().prop_map(|height| Kind::Wall { height: height.abs().max(1e-9) }),
        height().prop_map(|floor| Kind::Open { floor }),
        (height(), above(), rock).prop_map(|(floor, room, rock)| Kind::Covered {
            floor,
            room,
            rock
        }),
    ]
}

/// A map of tiles `a`, `b` and so on; the player starts in a corner that nobody looks at.
fn map_of(kinds: &[Kind], cells: &[usize], is_covered: bool) -> String {
    let mut text = format!(
        "sky = {{ gradient = [\"{SKY}\", \"{SKY}\"] }}\nfloor = \"{GROUND}\"\nceiling = \"{}\"\n",
        if is_covered { "#506070" } else { "sky" }
    );
    text += "ceiling_height = 1.25\ngrid = '''\n";
    for row in cells.chunks(COLUMNS) {
        text.extend(row.iter().map(|&kind| char::from(b'a' + kind as u8)));
        text.push('\n');
    }
    _ = writeln!(text, "@.....\n'''\n[tiles]");
    for (index, kind) in kinds.iter().enumerate() {
        let character = char::from(b'a' + index as u8);
        let color = |part: usize| Rgb::new(20 * index as u8 + 20, 50 * part as u8, 200);
        let [floor, ceiling, riser, lintel] = [0, 1, 2, 3].map(color);
        _ = match kind {
            Kind::Wall { height } => {
                writeln!(text, "{character} = {{ wall = \"{riser}\", height = {height:?} }}")
            }
            Kind::Open { floor: height } => writeln!(
                text,
                "{character} = {{ floor = \"{floor}\", floor_height = {height:?}, riser = \"{riser}\", \
                 ceiling = \"sky\" }}",
            ),
            Kind::Covered { floor: height, room, rock } => {
                let top = height + room.max(height.abs() * 1e-9);
                writeln!(
                    text,
                    "{character} = {{ floor = \"{floor}\", floor_height = {height:?}, \
                     riser = \"{riser}\", ceiling = \"{ceiling}\", ceiling_height = {top:?}, \
                     roof_height = {:?}, lintel = \"{lintel}\" }}",
                    top + rock
                )
            }
        };
    }
    text + "[things]\n\"@\" = { start = 0 }\n"
}

/// A block of rock, and the colours of its sides, its top and its bottom.
struct Block {
    low: DVec3,
    high: DVec3,
    side: Rgb,
    top: Rgb,
    bottom: Rgb,
}

/// Which face of a block a line enters.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Face {
    X,
    Y,
    Top,
    Bottom,
}

/// All rock of `world`, and the ground around it.
fn blocks_of(world: &World) -> Vec<Block> {
    let (width, height) = (world.grid().width(), world.grid().height());
    let cells = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let mut blocks: Vec<Block> = cells
        .flat_map(|(column, row)| {
            let tile = world.tile(world.grid().tile(column.into(), row.into()).unwrap());
            let gaps: Vec<Gap> = tile.gaps().collect();
            let low = DVec3::new(f64::from(column), f64::from(row), -FAR);
            let high = DVec3::new(low.x + 1.0, low.y + 1.0, gaps[0].bottom);
            let [riser, lintel] = [tile.riser, tile.lintel].map(|paint| world.mean_color(paint));
            let floor = world.mean_color(tile.floor.pattern.first_paint());
            let top = if let TileKind::Wall(_) = tile.kind { riser } else { floor };
            let below = Block { low, high, side: riser, top, bottom: Rgb::BLACK };
            let above = gaps.get(1).map(|gap| Block {
                low: low.with_z(gaps[0].top),
                high: high.with_z(gap.bottom),
                side: lintel,
                top: lintel,
                bottom: match tile.ceiling {
                    cellcaster::world::Ceiling::Covered(it) => {
                        world.mean_color(it.pattern.first_paint())
                    }
                    cellcaster::world::Ceiling::Sky => unreachable!("there is rock above"),
                },
            });
            [below].into_iter().chain(above)
        })
        .collect();
    let (width, height) = (f64::from(width), f64::from(height));
    let around = [
        (-FAR, -FAR, 0.0, FAR),
        (width, -FAR, FAR, FAR),
        (0.0, -FAR, width, 0.0),
        (0.0, height, width, FAR),
    ];
    blocks.extend(around.map(|(west, north, east, south)| Block {
        low: DVec3::new(west, north, -FAR),
        high: DVec3::new(east, south, 0.0),
        side: GROUND,
        top: GROUND,
        bottom: GROUND,
    }));
    blocks
}

impl Block {
    /// Where a line from `origin` along `direction` enters, and by which face.
    fn entry(&self, origin: DVec3, direction: DVec3) -> Option<(f64, Face)> {
        let mut enters = (f64::NEG_INFINITY, Face::X);
        let mut leaves = f64::INFINITY;
        for axis in 0..3 {
            let to = |place: f64| (place - origin[axis]) / direction[axis];
            if direction[axis] == 0.0 {
                if !(self.low[axis]..=self.high[axis]).contains(&origin[axis]) {
                    return None;
                }
                continue;
            }
            let (near, far) = if direction[axis] > 0.0 {
                (to(self.low[axis]), to(self.high[axis]))
            } else {
                (to(self.high[axis]), to(self.low[axis]))
            };
            if near > enters.0 {
                let upright = [Face::X, Face::Y].get(axis).copied();
                let flat = if direction.z > 0.0 { Face::Bottom } else { Face::Top };
                enters = (near, upright.unwrap_or(flat));
            }
            leaves = leaves.min(far);
        }
        (enters.0 >= 0.0 && enters.0 <= leaves).then_some(enters)
    }
}

/// The colour of what a line meets first, and which block and face that is.
fn meet(blocks: &[Block], origin: DVec3, direction: DVec3) -> Option<(usize, Face, Rgb)> {
    let entries = blocks.iter().enumerate().filter_map(|(index, block)| {
        block.entry(origin, direction).map(|(t, face)| (t, index, face))
    });
    let (_, index, face) = entries.min_by(|one, other| one.0.total_cmp(&other.0))?;
    let block = &blocks[index];
    let color = match face {
        Face::X => block.side,
        Face::Y => block.side.halved(),
        Face::Top => block.top,
        Face::Bottom => block.bottom,
    };
    Some((index, face, color))
}

/// The line through a place in a picture.
fn direction(camera: &Camera, frame: &Frame, x: f64, y: f64) -> DVec3 {
    let (width, height) = (f64::from(frame.width()), f64::from(frame.height()));
    let focal_length = width / 2.0 / camera.field_of_view.half_width();
    let horizon = height / 2.0 + (camera.pitch.slope() * focal_length).round();
    let across = camera.direction() + camera.plane() * (2.0 * x / width - 1.0);
    across.extend((horizon - y) / focal_length)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn every_pixel_is_where_geometry_says(
        kinds in prop::collection::vec(kind(), 5),
        cells in prop::collection::vec(0_usize..5, COLUMNS * ROWS),
        is_covered in any::<bool>(),
        position in (0.0..6.0, 0.0..5.0),
        is_on_a_roof in any::<bool>(),
        up in 0.01..0.99,
        degrees in prop_oneof![0.0..360.0, (0..8).prop_map(|eighth| 45.0 * f64::from(eighth))],
        pitch in prop_oneof![Just(0.0), -30.0..30.0],
        size in (1_u32..40, 1_u32..40),
    ) {
        let world = map::parse_str(&map_of(&kinds, &cells, is_covered)).unwrap();
        let position = DVec2::from(position);
        let tile = world.grid().tile(position.x as i64, position.y as i64).unwrap();
        let mut gaps = world.tile(tile).gaps();
        let gap = if is_on_a_roof { gaps.next_back() } else { gaps.next() }.unwrap();
        let eye = gap.bottom + up * gap.height().min(3.0);
        let camera =
            Camera::new(position, Heading::from_degrees(degrees).unwrap(), FieldOfView::default());
        let camera = camera.unwrap().with_eye(eye).unwrap();
        let camera = camera.with_pitch(Pitch::from_degrees(pitch).unwrap());
        let mut frame = Frame::new(FrameSize::new(size.0, size.1).unwrap(), PixelAspect::SQUARE);
        Renderer::new().render(&world, &camera, &mut frame);

        let blocks = blocks_of(&world);
        let origin = position.extend(eye);
        for (x, y) in (0..size.0).flat_map(|x| (0..size.1).map(move |y| (x, y))) {
            let meet_beside = |right: f64, down: f64| {
                let (x, y) = (f64::from(x) + 0.5 + right, f64::from(y) + 0.5 + down);
                meet(&blocks, origin, direction(&camera, &frame, x, y))
            };
            let met = meet_beside(0.0, 0.0);
            let beside = [(-DOUBTFUL, 0.0), (DOUBTFUL, 0.0), (0.0, -DOUBTFUL), (0.0, DOUBTFUL)];
            if beside.into_iter().all(|(right, down)| meet_beside(right, down) == met) {
                let color = met.map_or(SKY, |(_, _, color)| color);
                prop_assert_eq!(frame.pixel(x, y), color, "at ({}, {}): {:?}", x, y, met);
            }
        }
    }
}

//! Masks and glass compared with a simple renderer. For each pixel, it tests every face of every
//! cell, and blends the hits from far to near.

use crate::geometry::camera;
use cellcaster::color::Rgb;
use cellcaster::map;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, TileKind, World};
use glam::DVec2;
use proptest::prelude::*;

const MAP: &str = r##"
floor   = "#102030"
ceiling = "#405060"
grid = '''
#########
#.r.|f..#
#.g.|...#
#@b.ff.r#
#.rgbg.g#
#..|....#
#########
'''
[tiles]
"#" = { wall = "#ff8040" }
"r" = { glass = "#ff0000", opacity = 0.5 }
"g" = { glass = "#00ff00", opacity = 0.25 }
"b" = { glass = "#0000ff" }
"|" = { mask = "grate" }
"f" = { mask = "fence" }
[things]
"@" = { start = 0 }
"##;

/// The colours in the map.
const FLOOR: &str = "#102030";
const CEILING: &str = "#405060";

/// Pixels whose centres are closer than this to an edge, in pixels, are not compared.
const DOUBTFUL: f64 = 1e-6;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_number_of_faces_blends_in_order(
        position in (1.0..8.0, 1.0..6.0),
        degrees in 0.0..360.0,
        field_of_view in 30.0..=120.0,
        size in (8_u32..40, 8_u32..40),
    ) {
        let world = map::parse_str(MAP).unwrap();
        let camera = camera(position, degrees, field_of_view);
        let mut frame = Frame::new(FrameSize::new(size.0, size.1).unwrap(), PixelAspect::SQUARE);
        let mut renderer = Renderer::new();
        renderer.set_filter(Filter::Nearest);
        renderer.render(&world, &camera, &mut frame);

        let picture = Picture { world: &world, camera: &camera, size };
        let mut compared = 0;
        for (x, y) in (0..size.0).flat_map(|x| (0..size.1).map(move |y| (x, y))) {
            if let Some(color) = picture.pixel(x, y) {
                prop_assert_eq!(frame.pixel(x, y), color, "at ({}, {})", x, y);
                compared += 1;
            }
        }
        prop_assert!(compared * 4 > size.0 * size.1 * 3, "{} compared", compared);
    }
}

/// The view of a camera.
struct Picture<'a> {
    world: &'a World,
    camera: &'a Camera,
    size: (u32, u32),
}

/// A hit of a ray on a face.
struct Face {
    kind: TileKind,
    t: f64,
    u: f64,
    is_y_side: bool,
}

impl Picture<'_> {
    /// The colour of a pixel; `None` if its centre is too close to an edge.
    fn pixel(&self, x: u32, y: u32) -> Option<Rgb> {
        let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let color = self.color(x, y);
        let beside = [(-1.0, 0.0), (1.0, 0.0), (0.0, -1.0), (0.0, 1.0)];
        let is_certain = beside
            .iter()
            .all(|(right, down)| self.color(x + right * DOUBTFUL, y + down * DOUBTFUL) == color);
        is_certain.then_some(color)
    }

    /// The colour at a point of the picture, in pixels from its upper left corner.
    fn color(&self, x: f64, y: f64) -> Rgb {
        let (width, height) = (f64::from(self.size.0), f64::from(self.size.1));
        let ray = self.camera.direction() + self.camera.plane() * (2.0 * x / width - 1.0);
        let focal_length = width / 2.0 / self.camera.field_of_view.half_width();
        // The downward slope, at a distance of one cell.
        let slope = (y - height / 2.0) / focal_length;
        let background: Rgb = if slope < 0.0 { CEILING } else { FLOOR }.parse().unwrap();

        let mut faces = self.faces(ray);
        faces.sort_by(|one, other| one.t.total_cmp(&other.t));
        let is_wall = |face: &Face| matches!(face.kind, TileKind::Wall(_));
        let visible = faces.iter().position(is_wall).map_or(faces.len(), |wall| wall + 1);
        faces[..visible].iter().rev().fold(background, |behind, face| {
            let from_top = 0.5 + slope * face.t;
            if !(0.0..1.0).contains(&from_top) {
                return behind;
            }
            let (color, alpha) = self.texel(face, from_top);
            let color = if face.is_y_side { color.halved() } else { color };
            over(color, behind, alpha)
        })
    }

    /// All faces through which the ray enters a solid cell, except faces between two cells with the
    /// same tile.
    fn faces(&self, ray: DVec2) -> Vec<Face> {
        let grid = self.world.grid();
        let cells = (0..i64::from(grid.height()))
            .flat_map(|row| (0..i64::from(grid.width())).map(move |column| (column, row)));
        let mut faces = Vec::new();
        for (column, row) in cells.filter(|&(column, row)| grid.is_solid(column, row)) {
            let tile = grid.tile(column, row);
            let kind = self.world.tile(tile.unwrap()).kind;
            let (east, south) = (ray.x > 0.0, ray.y > 0.0);
            let corner = DVec2::new(
                column as f64 + f64::from(u8::from(!east)),
                row as f64 + f64::from(u8::from(!south)),
            );
            let t = (corner - self.camera.position()) / ray;
            let place =
                |t: f64| self.camera.position() + ray * t - DVec2::new(column as f64, row as f64);
            let before_x = grid.tile(if east { column - 1 } else { column + 1 }, row);
            let before_y = grid.tile(column, if south { row - 1 } else { row + 1 });
            let (along_y, along_x) = (place(t.x).y, place(t.y).x);
            if t.x >= 0.0 && (0.0..1.0).contains(&along_y) && before_x != tile {
                let u = if east { along_y } else { 1.0 - along_y };
                faces.push(Face { kind, t: t.x, u, is_y_side: false });
            }
            if t.y >= 0.0 && (0.0..1.0).contains(&along_x) && before_y != tile {
                let u = if south { 1.0 - along_x } else { along_x };
                faces.push(Face { kind, t: t.y, u, is_y_side: true });
            }
        }
        faces
    }

    /// The colour of a face, and its opacity in 255ths.
    fn texel(&self, face: &Face, from_top: f64) -> (Rgb, u8) {
        match face.kind {
            TileKind::Wall(paint) => (self.world.mean_color(paint), 255),
            TileKind::Glass(glass) => (glass.color, glass.opacity),
            TileKind::Mask(texture) => {
                let texture = self.world.texture(texture);
                let (x, y) = ((face.u * 64.0) as u32, (from_top * 64.0) as u32);
                (texture.column(face.u)[y as usize], texture.texel(x, y).1)
            }
            other => panic!("{other:?} is not in the map"),
        }
    }
}

fn over(front: Rgb, behind: Rgb, alpha: u8) -> Rgb {
    let share = f64::from(alpha) / 255.0;
    let mix = |front: u8, behind: u8| {
        (f64::from(front) * share + f64::from(behind) * (1.0 - share) + 1e-9).round() as u8
    };
    let [red, green, blue] = front.channels();
    let [behind_red, behind_green, behind_blue] = behind.channels();
    Rgb::new(mix(red, behind_red), mix(green, behind_green), mix(blue, behind_blue))
}

//! A world as a list of solids: blocks, pillars, thin walls, leaves of doors, cubes of glass and
//! pictures. A line hits the nearest of them.
//!
//! It uses no sectors, rows or cells: it tests every solid and takes the nearest hit. The colour of
//! a hit depends only on its position. A mirror reflects the line, and the viewer with it.

use std::f64::consts::TAU;

use cellcaster::color::Rgb;
use cellcaster::world::{
    Anchor, Camera, Ceiling, Cell, Covering, Figure, Gap, Light, Outline, Paint, Pattern, Sky,
    Sprite, Texture, Tile, TileId, TileKind, World,
};
use glam::{DVec2, DVec3};

/// A distance beyond everything.
const FAR: f64 = 1e30;
/// Things nearer than this are not drawn.
const NEAREST: f64 = 0.2;
/// The largest number of mirrors that reflect a line.
const MAX_BOUNCES: usize = 8;

/// The solids of a world for one camera.
pub struct Solids<'a> {
    world: &'a World,
    camera: &'a Camera,
    all: Vec<Solid<'a>>,
}

struct Solid<'a> {
    form: Form<'a>,
    heights: Gap,
    sides: Paint,
    top: Covering,
    bottom: Covering,
    /// The light of its top and its bottom.
    light: Light,
    /// The light of its sides. Without it, each cell in front lights its own part.
    side_light: Option<Light>,
    /// Whether that light is blended between cells that are open to each other.
    is_blended: bool,
    /// The kind of its tile, if that changes its sides.
    kind: Option<TileKind>,
}

#[derive(Clone, Copy)]
enum Form<'a> {
    /// A block over a rectangle, between its north-western and its south-eastern corner.
    Block([DVec2; 2]),
    /// A cube of glass or a mask. Only its front sides are visible, and no sides between cells with
    /// the same tile.
    Cube([DVec2; 2], TileId),
    Pillar(DVec2, f64),
    /// A thin wall, or the leaf of a door with the part of it that is in the jamb.
    Panel(DVec2, DVec2, Option<f64>),
    /// A picture that faces the camera, and whether light and fog dim it.
    Picture(&'a Sprite, Figure, bool),
}

/// A line of sight, and its viewer: the camera, or an image of the camera in mirrors.
struct Sight {
    origin: DVec3,
    direction: DVec3,
    /// The distance at which the line starts.
    from: f64,
    /// −1 along each axis on which the viewer is mirrored.
    signs: DVec2,
}

impl Sight {
    fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// Reflects the sight from `t` on, at a side across `axis`.
    fn reflect(&mut self, axis: usize, t: f64) {
        let line = self.at(t)[axis].round();
        self.origin[axis] = 2.0 * line - self.origin[axis];
        self.direction[axis] *= -1.0;
        self.signs[axis] *= -1.0;
        self.from = t;
    }
}

/// The hits of a line, up to the first opaque one.
#[derive(Clone, Debug, PartialEq)]
pub struct Met {
    /// The indices of the solids, from near to far, and their faces.
    faces: Vec<(usize, Face)>,
    /// The visible colour.
    pub color: Rgb,
    /// Whether two pictures are equally far away, except for rounding.
    pub is_tied: bool,
}

/// The axis across the face by which a line enters.
type Face = usize;
/// A top or a bottom.
const FLAT: Face = 2;
/// A face that is parallel to no axis.
const SLANTED: Face = 3;

/// The distance along a line at which it enters a solid, and the face.
type Entry = (f64, Face);
/// A colour and its opacity.
type Texel = (Rgb, u8);

impl<'a> Solids<'a> {
    /// The solids of `world` that `camera` may see.
    pub fn of(world: &'a World, camera: &'a Camera) -> Self {
        let (width, height) = (world.grid().width(), world.grid().height());
        let cells = (0..height).flat_map(|row| (0..width).map(move |column| Cell { column, row }));
        let things = world.things().iter().map(|thing| {
            let (sprite, heights) = (world.sprite(thing.sprite), world.room_in(thing.cell));
            let base = match sprite.anchor {
                Anchor::Floor => heights.floor(),
                Anchor::Ceiling => heights.ceiling() - sprite.height.cells(),
            };
            let shown = Figure {
                sprite: thing.sprite,
                position: thing.cell.center(),
                base,
                heading: sprite.heading,
                frame: thing.frame.unwrap_or_default(),
                opacity: u8::MAX,
            };
            Form::Picture(sprite, shown, true)
        });
        let figures = world.figures().iter().filter(|figure| figure.opacity > 0).map(|&shown| {
            let sprite = world.sprite(shown.sprite);
            Form::Picture(sprite, shown, !sprite.glows)
        });
        let (anywhere, black) = (Gap { bottom: -FAR, top: FAR }, Paint::Color(Rgb::BLACK));
        let pictures = things.chain(figures).map(|it| Solid::new(it, anywhere, black, Light::FULL));
        let solids = cells.flat_map(|cell| solids_in(world, cell)).chain(ground_around(world));
        Self { world, camera, all: solids.chain(pictures).collect() }
    }

    /// The hits of a line from the camera along `direction`, in front of the sky.
    pub fn meet(&self, direction: DVec3) -> Met {
        let origin = self.camera.position().extend(self.camera.eye());
        let mut sight = Sight { origin, direction, from: 0.0, signs: DVec2::ONE };
        let mut met = Met { faces: Vec::new(), color: Rgb::BLACK, is_tied: false };
        let mut layers = Vec::new();
        for bounces in 0..=MAX_BOUNCES {
            let entries = self.all.iter().enumerate().filter_map(|(index, solid)| {
                self.entry(solid, &sight).map(|(t, face)| (t, index, face))
            });
            let mut entries: Vec<_> = entries.collect();
            entries.sort_by(|one, other| one.0.total_cmp(&other.0));
            let mut mirror = None;
            let last = entries.iter().position(|&(t, index, face)| {
                let solid = &self.all[index];
                let (color, mut alpha) = self.color(solid, face, &sight, t);
                if let (Form::Block(_), Some(TileKind::Mirror(tint))) = (solid.form, solid.kind)
                    && tint.opacity < u8::MAX
                    && bounces < MAX_BOUNCES
                    && face < FLAT
                {
                    (mirror, alpha) = (Some((face, t)), tint.opacity);
                }
                met.faces.push((index, face));
                layers.push((color, alpha));
                mirror.is_some() || alpha == u8::MAX
            });
            // One more hit may be as near as the last one.
            entries.truncate(last.map_or(usize::MAX, |last| last + 2));
            entries.retain(|it| matches!(self.all[it.1].form, Form::Picture(..)));
            met.is_tied |= entries.windows(2).any(|pair| pair[1].0 - pair[0].0 < 1e-9);
            let Some((axis, t)) = mirror else { break };
            sight.reflect(axis, t);
        }
        let sky = self.sky(sight.direction);
        met.color =
            layers.into_iter().rev().fold(sky, |behind, (color, alpha)| color.over(behind, alpha));
        met
    }

    fn entry(&self, solid: &Solid, sight: &Sight) -> Option<Entry> {
        let heights = solid.heights;
        let entry = match solid.form {
            Form::Block(corners) => block_entry(sight, corners, heights),
            Form::Cube(corners, tile) => {
                let (t, face) = block_entry(sight, corners, heights)?;
                let mut before = sight.at(t);
                before[face] -= sight.direction[face].signum() / 2.0;
                let DVec3 { x, y, .. } = before.floor();
                let is_inside = self.world.grid().tile(x as i64, y as i64) == Some(tile);
                // A mirror beside the cube reflects the line into it, through no side.
                let is_reflected_here = sight.from > 0.0 && t - sight.from < 1e-9;
                (face < FLAT && !is_inside && !is_reflected_here).then_some((t, face))
            }
            Form::Pillar(center, radius) => pillar_entry(sight, center, radius, heights),
            Form::Panel(start, way, _) => panel_entry(sight, start, way, heights),
            Form::Picture(sprite, shown, _) => {
                // The component of the direction along the viewer's direction is 1.
                let forward = self.camera.direction() * sight.signs;
                let t = (shown.position - sight.origin.truncate()).dot(forward);
                let (_, alpha) = self.texel_of(sprite, &shown, sight, t)?;
                // Nothing is drawn behind the edge of the map.
                let is_on_map = self.tile_at(sight.at(t).truncate()).is_some();
                (t >= NEAREST && is_on_map && alpha > 0).then_some((t, SLANTED))
            }
        };
        entry.filter(|&(t, _)| t >= sight.from)
    }

    /// The colour and the opacity of a solid at the point where `sight` meets it, at `t`.
    fn color(&self, solid: &Solid, face: Face, sight: &Sight, t: f64) -> Texel {
        if let Form::Picture(sprite, shown, is_dimmed) = solid.form {
            let texel = self.texel_of(sprite, &shown, sight, t);
            let (color, alpha) = texel.unwrap_or((Rgb::BLACK, 0));
            let alpha = (u32::from(alpha) * u32::from(shown.opacity) + 127) / 255;
            let on_map = self.tile_at(shown.position).map(|_| self.light_at(shown.position));
            let light = on_map.or(self.world.ground().light).unwrap_or(Light::FULL);
            let color = if is_dimmed { self.lit(color, light, DVec2::X, t) } else { color };
            return (color, alpha as u8);
        }
        let ((color, own_alpha), light, normal) = if face == FLAT {
            let covering = if sight.direction.z > 0.0 { solid.bottom } else { solid.top };
            (self.texel_of_plane(covering, sight.at(t)), solid.light, DVec2::X)
        } else {
            self.side(solid, face, sight, t)
        };
        let alpha = match (solid.form, solid.kind) {
            (Form::Cube(..), Some(TileKind::Glass(glass))) => glass.opacity,
            (Form::Cube(..), _) => own_alpha,
            _ => u8::MAX,
        };
        (self.lit(color, light, normal, t), alpha)
    }

    /// The texel, the light and the normal of a side of `solid`.
    fn side(&self, solid: &Solid, face: Face, sight: &Sight, t: f64) -> (Texel, Light, DVec2) {
        let (place, height) = (sight.at(t).truncate(), sight.at(t).z);
        let direction = sight.direction.truncate();
        // The distance to the cell in front, the normal, and the texture coordinate from the left.
        let (reach, normal, u) = match solid.form {
            Form::Pillar(center, radius) => {
                let outward = (place - center) / radius;
                let times = (TAU * radius).round().max(1.0);
                (0.0, outward, libm::atan2(-outward.y, outward.x) / TAU * times)
            }
            Form::Panel(start, way, opening) => {
                let along = (place - start).dot(way) / way.length();
                let along = opening.map_or(along / way.length(), |opening| along + opening);
                (1.0, way.perp().normalize(), along * direction.perp_dot(way).signum())
            }
            _ if face == 0 => (0.5, DVec2::X, place.y * direction.x.signum()),
            _ => (0.5, DVec2::Y, place.x * -direction.y.signum()),
        };
        let front = place - normal * (direction.dot(normal).signum() * reach);
        let light = solid.side_light.unwrap_or_else(|| {
            let axis = normal.perp().abs();
            if solid.is_blended { self.blended_light(front, axis) } else { self.light_at(front) }
        });
        let paint = match (solid.kind, self.tile_at(front).map(|it| it.kind)) {
            (Some(TileKind::Wall(_)), Some(TileKind::Door(it) | TileKind::Doorway(it))) => it.jamb,
            _ => solid.sides,
        };
        // Textures start at whole heights.
        (self.texel(paint, u, -height), light, normal)
    }

    /// The texel of a picture at a point in its plane.
    fn texel_of(&self, sprite: &Sprite, shown: &Figure, sight: &Sight, t: f64) -> Option<Texel> {
        let to_viewer = sight.origin.truncate() - shown.position;
        let picture = sprite.picture_of(shown.frame, shown.heading, to_viewer);
        let right = self.camera.direction().perp() * sight.signs;
        let beside = (sight.at(t).truncate() - shown.position).dot(right) / sprite.width();
        // A mirror shows the mirror image of a picture that faces the image of the viewer.
        let beside = beside * sight.signs.element_product() + 0.5;
        let down = 1.0 - (sight.at(t).z - shown.base) / sprite.height.cells();
        let is_on_it = (0.0..1.0).contains(&beside) && (0.0..1.0).contains(&down);
        is_on_it.then(|| texel_at(picture, beside, down))
    }

    /// A colour in this light on a face with the normal `normal`, at distance `t`.
    fn lit(&self, color: Rgb, light: Light, normal: DVec2, t: f64) -> Rgb {
        let share = f64::midpoint(1.0, normal.x * normal.x);
        let light = (f64::from(light.in_256ths()) * share) as u32;
        let (clear, fog) = match self.world.fog() {
            Some(fog) => ((fog.clearness(t) * 256.0).round() as u32, fog.color),
            None => (256, Rgb::BLACK),
        };
        mixed([(color, light * clear / 256), (fog, 256 - clear)])
    }

    /// The tile of the cell that contains `place`.
    fn tile_at(&self, place: DVec2) -> Option<Tile> {
        let DVec2 { x, y } = place.floor();
        Some(self.world.tile(self.world.grid().tile(x as i64, y as i64)?))
    }

    /// The light in the cell that contains `place`, of lamps, too.
    fn light_at(&self, place: DVec2) -> Light {
        let is_cell = place.x >= 0.0 && place.y >= 0.0;
        let cell = Cell { column: place.x as u32, row: place.y as u32 };
        if is_cell { self.world.light_in(cell) } else { Light::FULL }
    }

    /// The light of a face along `axis`, with the cell of `front` in front of it. If two such cells
    /// are open to each other, the light is interpolated between their middles.
    fn blended_light(&self, front: DVec2, axis: DVec2) -> Light {
        let along = front.dot(axis) - 0.5;
        let share = along - along.floor();
        let cells = [0.0, 1.0].map(|next| front + axis * (next - share));
        let tiles = cells.map(|center| self.tile_at(center));
        let [one, other] = cells.map(|center| f64::from(self.light_at(center).in_256ths()));
        let mean = match tiles {
            [Some(west), Some(east)] if are_open_to_each_other(&west, &east) => {
                one * (1.0 - share) + other * share
            }
            _ if share < 0.5 => one,
            _ => other,
        };
        Light::new(mean.round() / 256.0).unwrap_or(Light::FULL)
    }

    /// The colour of the sky along `direction`.
    fn sky(&self, direction: DVec3) -> Rgb {
        match self.world.sky() {
            Sky::Gradient(sky) => {
                // The zenith's colour starts at a slope of a half.
                let up = (direction.z / 0.5).clamp(0.0, 1.0);
                let share = (up * (2.0 - up) * 256.0) as u32;
                mixed([(sky.horizon, 256 - share), (sky.zenith, share)])
            }
            Sky::Panorama(id) => {
                let texture = self.world.texture(id);
                let (width, height) = (f64::from(texture.width()), f64::from(texture.height()));
                let turn = libm::atan2(direction.y, direction.x) / TAU;
                let up = direction.z / direction.truncate().length() * width / TAU;
                texel_at(texture, turn, (height - up).clamp(0.0, height - 0.5) / height).0
            }
        }
    }

    /// The colour and the opacity of a floor or a ceiling at a position.
    fn texel_of_plane(&self, Covering { pattern, scale }: Covering, place: DVec3) -> Texel {
        let place = place / scale.cells();
        let is_odd = |place: f64| place.floor() % 2.0 != 0.0;
        let paint = match pattern {
            Pattern::Plain(paint) => paint,
            Pattern::Checker(paints) => paints[usize::from(is_odd(place.x) != is_odd(place.y))],
            Pattern::Stripes(paints) => paints[usize::from(is_odd(place.y))],
        };
        self.texel(paint, place.x, place.y)
    }

    /// The colour and the opacity of `paint` at a position, given as distances in cells from its
    /// left and its top.
    fn texel(&self, paint: Paint, x: f64, y: f64) -> Texel {
        let Paint::Texture(id) = paint else { return (self.world.mean_color(paint), u8::MAX) };
        texel_at(self.world.texture(id), x, y)
    }
}

/// The texel of a repeated texture, whose width and height are 1.
fn texel_at(texture: &Texture, x: f64, y: f64) -> Texel {
    let index = |place: f64, count: u32| {
        let fraction = place - place.floor();
        ((fraction * f64::from(count)) as u32).min(count - 1)
    };
    texture.texel(index(x, texture.width()), index(y, texture.height()))
}

/// The sum of two colours, each with a weight in 256ths.
fn mixed(parts: [(Rgb, u32); 2]) -> Rgb {
    let [red, green, blue] = [0, 1, 2].map(|channel: usize| {
        let parts = parts.map(|(color, weight)| u32::from(color.channels()[channel]) * weight);
        (parts.iter().sum::<u32>() / 256) as u8
    });
    Rgb::new(red, green, blue)
}

/// Returns whether light passes between two tiles: both are open or see-through, and a gap of one
/// overlaps the lowest gap of the other.
fn are_open_to_each_other(one: &Tile, other: &Tile) -> bool {
    let is_open =
        |tile: &Tile| matches!(tile.kind, TileKind::Open | TileKind::Mask(_) | TileKind::Glass(_));
    let meets = |one: &Tile, other: &Tile| {
        let lowest = one.gaps().next().unwrap();
        other.gaps().any(|gap| !(gap.top <= lowest.bottom || lowest.top <= gap.bottom))
    };
    is_open(one) && is_open(other) && (meets(one, other) || meets(other, one))
}

impl<'a> Solid<'a> {
    fn new(form: Form<'a>, heights: Gap, sides: Paint, light: Light) -> Self {
        let (top, bottom) = (sides.into(), sides.into());
        let (side_light, is_blended, kind) = (None, true, None);
        Self { form, heights, sides, top, bottom, light, side_light, is_blended, kind }
    }
}

/// The solids in a cell.
fn solids_in<'a>(world: &World, cell: Cell) -> Vec<Solid<'a>> {
    let corner = DVec2::new(f64::from(cell.column), f64::from(cell.row));
    let corners = [corner, corner + DVec2::ONE];
    let id = world.grid().tile(cell.column.into(), cell.row.into()).unwrap();
    let tile = world.tile(id);
    let light = world.light_in(cell);
    let is_blended = !matches!(tile.kind, TileKind::Door(_));
    let is_open = matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
    let side_light = tile.light.filter(|_| !is_open);
    let solid = |form, bottom, top, sides| Solid {
        side_light,
        is_blended,
        ..Solid::new(form, Gap { bottom, top }, sides, light)
    };
    let mut gaps = tile.gaps();
    let lowest = gaps.next().unwrap();
    let below = solid(Form::Block(corners), -FAR, lowest.bottom, tile.riser);
    let is_wall = matches!(tile.kind, TileKind::Wall(_) | TileKind::Mirror(_));
    let top = if is_wall { below.top } else { tile.floor };
    let mut all = vec![Solid { top, kind: Some(tile.kind), ..below }];
    if let (Some(gap), Ceiling::Covered(bottom)) = (gaps.next(), tile.ceiling) {
        let above = solid(Form::Block(corners), lowest.top, gap.bottom, tile.lintel);
        all.push(Solid { bottom, ..above });
    }
    let stand = |form, paint| solid(form, tile.heights.floor(), tile.top_of_what_stands(), paint);
    let kind = Some(tile.kind);
    let cube = |paint| Some(Solid { kind, ..stand(Form::Cube(corners, id), paint) });
    all.extend(match tile.kind {
        TileKind::Glass(glass) => cube(Paint::Color(glass.color)),
        TileKind::Mask(texture) => cube(Paint::Texture(texture)),
        TileKind::Shape(shape) => {
            let form = match shape.outline {
                Outline::Pillar(radius) => Form::Pillar(cell.center(), radius.cells()),
                Outline::Line(line) => Form::Panel(line.start(cell), line.stretch(), None),
            };
            let side_light = side_light.or(Some(light));
            Some(Solid { side_light, ..stand(form, shape.paint) })
        }
        TileKind::Door(door) => {
            let opening = world.opening(cell).part();
            // The leaf slides into the jamb in the west or in the north.
            let (west, row) = (i64::from(cell.column) - 1, i64::from(cell.row));
            let along = if world.grid().is_solid(west, row) { DVec2::X } else { DVec2::Y };
            let (start, way) = (cell.center() - along / 2.0, along * (1.0 - opening));
            Some(stand(Form::Panel(start, way, Some(opening)), door.leaf))
        }
        _ => None,
    });
    all
}

/// The ground beyond the edges of the map.
fn ground_around<'a>(world: &World) -> impl Iterator<Item = Solid<'a>> {
    let (width, height) = (f64::from(world.grid().width()), f64::from(world.grid().height()));
    let (ground, top) = (world.ground(), world.floor());
    let around = [
        [(-FAR, -FAR), (0.0, FAR)],
        [(width, -FAR), (FAR, FAR)],
        [(0.0, -FAR), (width, 0.0)],
        [(0.0, height), (width, FAR)],
    ];
    around.into_iter().map(move |corners| {
        let form = Form::Block(corners.map(DVec2::from));
        let light = ground.light.unwrap_or(Light::FULL);
        let solid = Solid::new(form, Gap { bottom: -FAR, top: 0.0 }, ground.riser, light);
        Solid { top, is_blended: false, ..solid }
    })
}

/// The distance at which a line enters a block, and the face.
fn block_entry(sight: &Sight, corners: [DVec2; 2], heights: Gap) -> Option<Entry> {
    let &Sight { origin, direction, from, .. } = sight;
    let [low, high] = [corners[0].extend(heights.bottom), corners[1].extend(heights.top)];
    let mut enters = (f64::NEG_INFINITY, 0);
    let mut leaves = f64::INFINITY;
    for axis in 0..=FLAT {
        if direction[axis] == 0.0 {
            if !(low[axis]..=high[axis]).contains(&origin[axis]) {
                return None;
            }
            continue;
        }
        let [one, other] = [low, high].map(|it| (it[axis] - origin[axis]) / direction[axis]);
        if one.min(other) > enters.0 {
            enters = (one.min(other), axis);
        }
        leaves = leaves.min(one.max(other));
    }
    (enters.0 >= from && enters.0 <= leaves).then_some(enters)
}

/// The distance at which a line enters a pillar, and the face.
fn pillar_entry(sight: &Sight, center: DVec2, radius: f64, heights: Gap) -> Option<Entry> {
    let &Sight { origin, direction, from, .. } = sight;
    let (start, along) = (origin.truncate() - center, direction.truncate());
    let (a, b) = (along.length_squared(), start.dot(along));
    let discriminant = b * b - a * (start.length_squared() - radius * radius);
    // It is no number if the line passes the pillar: no comparison with it holds.
    let enters = (-b - discriminant.sqrt()) / a;
    let to_top = (heights.top - origin.z) / direction.z;
    let is_on_top = (start + along * to_top).length() <= radius;
    if enters >= from && heights.holds(origin.z + direction.z * enters) {
        Some((enters, SLANTED))
    } else {
        (direction.z < 0.0 && to_top >= from && is_on_top).then_some((to_top, FLAT))
    }
}

/// The distance at which a line crosses a thin wall along `way`, and the face.
fn panel_entry(sight: &Sight, start: DVec2, way: DVec2, heights: Gap) -> Option<Entry> {
    let (from, along) = (sight.origin.truncate() - start, sight.direction.truncate());
    let across = along.perp_dot(way);
    let t = -from.perp_dot(way) / across;
    let place = -from.perp_dot(along) / across;
    let is_met =
        across != 0.0 && t >= 0.0 && (0.0..=1.0).contains(&place) && heights.holds(sight.at(t).z);
    is_met.then_some((t, SLANTED))
}

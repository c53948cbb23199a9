//! A world as a set of solids: blocks, pillars, thin walls, leaves of doors, cubes of glass and
//! pictures. A line hits the nearest of them.
//!
//! It uses no sectors, rows or cells: it tests every solid and takes the nearest hit. The colour of
//! a hit depends only on its position. A mirror reflects the line, and the viewer with it.

use std::f64::consts::TAU;

use cellcaster::color::Rgb;
use cellcaster::world::{
    Anchor, Camera, Ceiling, Cell, Covering, Figure, Gap, Glass, Light, Outline, Paint, Pattern,
    Sky, Sprite, Texture, Tile, TileId, TileKind, World,
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

enum Solid<'a> {
    Block(Block),
    /// A cube of glass or a mask. Only its front sides are visible, and no sides between cells with
    /// the same tile.
    Cube {
        block: Block,
        tile: TileId,
        /// The opacity of glass; `None` for a mask, whose texels have their own opacity.
        opacity: Option<u8>,
    },
    Pillar {
        center: DVec2,
        radius: f64,
        heights: Gap,
        paint: Paint,
    },
    /// A thin wall or the leaf of a door, with its start and its extent.
    Panel {
        start: DVec2,
        way: DVec2,
        heights: Gap,
        paint: Paint,
        cell: Cell,
        /// The part of a leaf that is in the jamb; `None` for a thin wall.
        opening: Option<f64>,
    },
    /// A picture that faces the camera, and whether light and fog dim it.
    Picture {
        sprite: &'a Sprite,
        shown: Figure,
        is_dimmed: bool,
    },
}

/// A block, with the paints of its sides, its top and its bottom.
struct Block {
    low: DVec3,
    high: DVec3,
    side: Paint,
    /// `true` for a wall, which shows the jambs of doors.
    has_jambs: bool,
    top: Covering,
    bottom: Covering,
    /// The light of its sides, if it does not depend on the cells in front of them.
    side_light: Option<Light>,
    /// `true` for ground outside the map, and for what is below and above a door. Each cell in
    /// front of it lights its own part.
    is_lit_by_cells: bool,
    /// The light of its top and its bottom.
    flat_light: Light,
    /// The tint of its sides, if they are mirrors.
    mirror: Option<Glass>,
}

/// A line of sight, and its viewer: the camera, or an image of the camera in mirrors.
struct Sight {
    origin: DVec3,
    direction: DVec3,
    /// The distance at which the line starts.
    from: f64,
    forward: DVec2,
    right: DVec2,
    is_mirrored: bool,
}

impl Sight {
    fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// The sight from `t` on, after a side of `block` has reflected it.
    fn reflected(&self, block: &Block, face: Face, t: f64) -> Self {
        let axis = usize::from(face == Face::Y);
        let line = if self.direction[axis] > 0.0 { block.low[axis] } else { block.high[axis] };
        let mut image = Self { from: t, is_mirrored: !self.is_mirrored, ..*self };
        image.origin[axis] = 2.0 * line - self.origin[axis];
        image.direction[axis] = -self.direction[axis];
        image.forward[axis] = -self.forward[axis];
        image.right[axis] = -self.right[axis];
        image
    }
}

/// The hits of a line, up to the first opaque one.
#[derive(Clone, Debug, PartialEq)]
pub struct Met {
    /// The indices of the solids, from near to far, and their faces.
    faces: Vec<(usize, Face)>,
    color: Rgb,
    is_tied: bool,
}

impl Met {
    /// The visible colour.
    pub fn color(&self) -> Rgb {
        self.color
    }

    /// Returns whether two pictures are equally far away, except for rounding.
    pub fn is_tied(&self) -> bool {
        self.is_tied
    }
}

/// The face by which a line enters.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Face {
    X,
    Y,
    /// A face along neither axis.
    Slanted,
    Top,
    Bottom,
}

/// The distance along a line at which it enters a solid, and the face.
type Entry = (f64, Face);

impl<'a> Solids<'a> {
    /// The solids of `world` that `camera` may see.
    pub fn of(world: &'a World, camera: &'a Camera) -> Self {
        let (width, height) = (world.grid().width(), world.grid().height());
        let cells = (0..height).flat_map(|row| (0..width).map(move |column| Cell { column, row }));
        let mut all: Vec<Solid> = cells.flat_map(|cell| solids_in(world, cell)).collect();
        all.extend(ground_around(world).map(Solid::Block));
        all.extend(world.things().iter().map(|thing| {
            let sprite = world.sprite(thing.sprite);
            let heights = world.room_in(thing.cell);
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
            Solid::Picture { sprite, shown, is_dimmed: true }
        }));
        let visible = world.figures().iter().filter(|figure| figure.opacity > 0);
        all.extend(visible.map(|&shown| {
            let sprite = world.sprite(shown.sprite);
            Solid::Picture { sprite, shown, is_dimmed: !sprite.glows }
        }));
        Self { world, camera, all }
    }

    /// The hits of a line from the camera along `direction`, in front of the sky.
    pub fn meet(&self, direction: DVec3) -> Met {
        let mut sight = Sight {
            origin: self.camera.position().extend(self.camera.eye()),
            direction,
            from: 0.0,
            forward: self.camera.direction(),
            right: self.camera.direction().perp(),
            is_mirrored: false,
        };
        let mut met = Met { faces: Vec::new(), color: Rgb::BLACK, is_tied: false };
        let mut layers = Vec::new();
        for bounces in 0..=MAX_BOUNCES {
            let image = self.meet_in(&sight, bounces < MAX_BOUNCES, &mut met, &mut layers);
            let Some(image) = image else { break };
            sight = image;
        }
        let sky = self.sky(sight.direction);
        met.color =
            layers.into_iter().rev().fold(sky, |behind, (color, alpha)| color.over(behind, alpha));
        met
    }

    /// Adds the hits of `sight` up to a mirror, and returns the sight from there on.
    fn meet_in(
        &self,
        sight: &Sight,
        reflects: bool,
        met: &mut Met,
        layers: &mut Vec<(Rgb, u8)>,
    ) -> Option<Sight> {
        let entries = self.all.iter().enumerate().filter_map(|(index, solid)| {
            let (t, face) = self.entry(solid, sight)?;
            Some((t, index, face))
        });
        let mut entries: Vec<_> = entries.collect();
        entries.sort_by(|one, other| one.0.total_cmp(&other.0));
        let (mut seen, mut image) = (0, None);
        for &(t, index, face) in &entries {
            seen += 1;
            met.faces.push((index, face));
            let (color, alpha) = self.color(&self.all[index], face, sight, t);
            if let Solid::Block(block) = &self.all[index]
                && let Some(tint) = block.mirror.filter(|tint| tint.opacity < u8::MAX)
                && matches!(face, Face::X | Face::Y)
                && reflects
            {
                layers.push((color, tint.opacity));
                image = Some(sight.reflected(block, face, t));
                break;
            }
            layers.push((color, alpha));
            if alpha == u8::MAX {
                break;
            }
        }
        // One more hit may be as near as the last one.
        entries.truncate(seen + 1);
        let is_picture = |index: usize| matches!(self.all[index], Solid::Picture { .. });
        met.is_tied |= entries.windows(2).any(|pair| {
            let [(near, one, _), (far, other, _)] = [pair[0], pair[1]];
            is_picture(one) && is_picture(other) && far - near < 1e-9
        });
        image
    }

    /// Returns whether a position is inside a pillar, where nothing is visible.
    pub fn is_in_pillar(&self, place: DVec3) -> bool {
        self.all.iter().any(|solid| match *solid {
            Solid::Pillar { center, radius, heights, .. } => {
                place.truncate().distance(center) <= radius && heights.holds(place.z)
            }
            _ => false,
        })
    }

    fn entry(&self, solid: &Solid, sight: &Sight) -> Option<Entry> {
        let &Sight { origin, direction, from, .. } = sight;
        let entry = match *solid {
            Solid::Block(ref block) => block.entry(sight),
            Solid::Cube { ref block, tile, opacity } => {
                let (t, face) = block.entry(sight)?;
                let place = sight.at(t);
                let before = match face {
                    Face::X => place - direction.signum() * DVec3::X / 2.0,
                    Face::Y => place - direction.signum() * DVec3::Y / 2.0,
                    _ => return None,
                };
                let id = self.world.grid().tile(before.x.floor() as i64, before.y.floor() as i64);
                // A mirror beside the cube reflects the line into it, through no side.
                let is_reflected_here = from > 0.0 && t - from < 1e-9;
                (id != Some(tile) && opacity != Some(0) && !is_reflected_here).then_some((t, face))
            }
            Solid::Pillar { center, radius, heights, .. } => {
                pillar_entry((origin - center.extend(0.0), direction, from), radius, heights)
            }
            Solid::Panel { start, way, heights, .. } => {
                panel_entry(origin - start.extend(0.0), direction, way, heights)
            }
            Solid::Picture { sprite, ref shown, .. } => {
                // The component of the direction along the viewer's direction is 1.
                let t = (shown.position - origin.truncate()).dot(sight.forward);
                let place = sight.at(t);
                let (x, y) = texel_of(sprite, shown, place, sight)?;
                // Nothing is drawn behind the edge of the map.
                let is_on_map = self.tile_in((place.x.floor(), place.y.floor())).is_some();
                let picture = picture_of(sprite, shown, sight);
                let is_seen = t >= NEAREST && is_on_map && picture.texel(x, y).1 > 0;
                is_seen.then_some((t, Face::Slanted))
            }
        };
        entry.filter(|&(t, _)| t >= from)
    }

    /// The colour and the opacity of a solid at the point where `sight` meets it, at `t`.
    fn color(&self, solid: &Solid, face: Face, sight: &Sight, t: f64) -> (Rgb, u8) {
        let (place, direction) = (sight.at(t), sight.direction);
        let light_in = |center: DVec2| self.light_in((center.x.floor(), center.y.floor()));
        // Textures start at whole heights.
        let upright = |paint, u: f64| self.texel(paint, u, -place.z);
        let flat = |covering: Covering| self.texel_of_plane(covering, place.truncate());
        let ((texel, own_alpha), light, normal) = match *solid {
            Solid::Block(ref block) | Solid::Cube { ref block, .. } => match face {
                Face::Top => (flat(block.top), block.flat_light, DVec2::X),
                Face::Bottom => (flat(block.bottom), block.flat_light, DVec2::X),
                Face::X => {
                    let u = if direction.x > 0.0 { place.y } else { -place.y };
                    let before = place.x - direction.x.signum() / 2.0;
                    let light = self.side_light(block, place.y, |row| (before.floor(), row));
                    let paint = self.paint_of_side(block, DVec2::new(before, place.y));
                    (upright(paint, u), light, DVec2::X)
                }
                Face::Y | Face::Slanted => {
                    let u = if direction.y < 0.0 { place.x } else { -place.x };
                    let before = place.y - direction.y.signum() / 2.0;
                    let light = self.side_light(block, place.x, |column| (column, before.floor()));
                    let paint = self.paint_of_side(block, DVec2::new(place.x, before));
                    (upright(paint, u), light, DVec2::Y)
                }
            },
            Solid::Pillar { paint, center, .. } if face == Face::Top => {
                (flat(paint.into()), light_in(center), DVec2::X)
            }
            Solid::Pillar { center, radius, paint, .. } => {
                let outward = place.truncate() - center;
                let times = (TAU * radius).round().max(1.0);
                let turn = libm::atan2(-outward.y, outward.x) / TAU * times;
                let cell = Cell { column: center.x as u32, row: center.y as u32 };
                (upright(paint, turn), self.light_of_standing(cell, center), outward / radius)
            }
            Solid::Panel { start, way, paint, cell, opening, .. } => {
                let along = (place.truncate() - start).dot(way) / way.length();
                let along = along + opening.unwrap_or_default();
                let along = if opening.is_some() { along } else { along / way.length() };
                let is_from_the_left = direction.truncate().perp_dot(way) > 0.0;
                let u = if is_from_the_left { along } else { -along };
                let normal = way.perp().normalize();
                // The cell in front of it lights a leaf, and its own cell a thin wall.
                let away = normal * -direction.truncate().dot(normal).signum();
                let before = if opening.is_some() { cell.center() + away } else { cell.center() };
                (upright(paint, u), self.light_of_standing(cell, before), normal)
            }
            Solid::Picture { sprite, ref shown, .. } => {
                let (x, y) = texel_of(sprite, shown, place, sight).unwrap_or_default();
                let DVec2 { x: column, y: row } = shown.position.floor();
                let ground = self.world.ground().light.unwrap_or(Light::FULL);
                let is_on_map = self.tile_in((column, row)).is_some();
                let light = if is_on_map { self.light_in((column, row)) } else { ground };
                let (color, texel_alpha) = picture_of(sprite, shown, sight).texel(x, y);
                let alpha = (u32::from(texel_alpha) * u32::from(shown.opacity) + 127) / 255;
                ((color, alpha as u8), light, DVec2::X)
            }
        };
        let alpha = match *solid {
            Solid::Cube { opacity: Some(opacity), .. } => opacity,
            Solid::Cube { opacity: None, .. } | Solid::Picture { .. } => own_alpha,
            _ => u8::MAX,
        };
        if matches!(solid, Solid::Picture { is_dimmed: false, .. }) {
            return (texel, alpha);
        }
        (self.lit(texel, light, normal, t), alpha)
    }

    /// A colour in this light on a face with the normal `normal`, at distance `t`.
    fn lit(&self, color: Rgb, light: Light, normal: DVec2, t: f64) -> Rgb {
        let share = f64::midpoint(1.0, normal.x * normal.x);
        let light = (f64::from(light.in_256ths()) * share) as u32;
        let (clear, fog) = match self.world.fog() {
            Some(fog) => ((fog.clearness(t) * 256.0).round() as u32, fog.color),
            None => (256, Rgb::BLACK),
        };
        let own = light * clear / 256;
        let [red, green, blue] = [0, 1, 2].map(|index| {
            let [own_channel, of_fog] =
                [color, fog].map(|color| u32::from(color.channels()[index]));
            ((own_channel * own + of_fog * (256 - clear)) / 256) as u8
        });
        Rgb::new(red, green, blue)
    }

    /// The tile of the cell with this corner.
    fn tile_in(&self, (column, row): (f64, f64)) -> Option<Tile> {
        let id = self.world.grid().tile(column as i64, row as i64)?;
        Some(self.world.tile(id))
    }

    /// The light in the cell with this corner, of lamps, too.
    fn light_in(&self, corner: (f64, f64)) -> Light {
        cell_at(corner).map_or(Light::FULL, |cell| self.world.light_in(cell))
    }

    /// The light of an object in `cell`: of its tile, or in the cell that contains `before`.
    fn light_of_standing(&self, cell: Cell, before: DVec2) -> Light {
        let DVec2 { x: column, y: row } = before.floor();
        let own = self.tile_in((cell.column.into(), cell.row.into())).and_then(|tile| tile.light);
        own.unwrap_or_else(|| self.light_in((column, row)))
    }

    /// The paint of a side of `block` as seen from the cell that contains `before`.
    fn paint_of_side(&self, block: &Block, before: DVec2) -> Paint {
        let before = before.floor();
        match self.tile_in((before.x, before.y)).map(|tile| tile.kind) {
            Some(TileKind::Door(door) | TileKind::Doorway(door)) if block.has_jambs => door.jamb,
            _ => block.side,
        }
    }

    /// The colour of the sky along `direction`.
    fn sky(&self, direction: DVec3) -> Rgb {
        match self.world.sky() {
            Sky::Gradient(sky) => {
                // The zenith's colour starts at a slope of a half.
                let up = (direction.z / 0.5).clamp(0.0, 1.0);
                let share = (up * (2.0 - up) * 256.0) as u32;
                let [red, green, blue] = [0, 1, 2].map(|index| {
                    let [of_horizon, of_zenith] =
                        [sky.horizon, sky.zenith].map(|color| u32::from(color.channels()[index]));
                    ((of_horizon * (256 - share) + of_zenith * share) / 256) as u8
                });
                Rgb::new(red, green, blue)
            }
            Sky::Panorama(id) => {
                let texture = self.world.texture(id);
                let (width, height) = (f64::from(texture.width()), f64::from(texture.height()));
                let turn = libm::atan2(direction.y, direction.x) / TAU;
                let up = direction.z / direction.truncate().length() * width / TAU;
                let x = (turn - turn.floor()) * width;
                let y = (height - up).clamp(0.0, height - 1.0);
                texture.texel((x as u32).min(texture.width() - 1), y as u32).0
            }
        }
    }

    /// The colour and the opacity of a floor or a ceiling at a position.
    fn texel_of_plane(&self, Covering { pattern, scale }: Covering, place: DVec2) -> (Rgb, u8) {
        let place = place / scale.cells();
        let is_odd = |place: f64| place.floor() % 2.0 != 0.0;
        let paint = match pattern {
            Pattern::Plain(paint) => paint,
            Pattern::Checker(paints) => paints[usize::from(is_odd(place.x) != is_odd(place.y))],
            Pattern::Stripes(paints) => paints[usize::from(is_odd(place.y))],
        };
        self.texel(paint, place.x, place.y)
    }

    fn side_light(&self, block: &Block, along: f64, before: impl Fn(f64) -> (f64, f64)) -> Light {
        match block.side_light {
            Some(own) => own,
            None if block.is_lit_by_cells => self.light_in(before(along.floor())),
            None => self.light_along(along, before),
        }
    }

    /// The light of a face at `along`. `before` returns the cells in front of the face. If two of
    /// them are open to each other, the light is interpolated between their middles.
    fn light_along(&self, along: f64, before: impl Fn(f64) -> (f64, f64)) -> Light {
        let first = (along - 0.5).floor();
        let share = along - 0.5 - first;
        let cells = [first, first + 1.0].map(before);
        let tiles = cells.map(|corner| self.tile_in(corner));
        let lights = cells.map(|corner| self.light_in(corner).in_256ths());
        let [one, other] = lights.map(f64::from);
        let mean = match tiles {
            [Some(west), Some(east)] if are_open_to_each_other(&west, &east) => {
                one * (1.0 - share) + other * share
            }
            _ if share < 0.5 => one,
            _ => other,
        };
        Light::new(mean.round() / 256.0).unwrap()
    }

    /// The colour and the opacity of `paint` at a position, given as distances in cells from its
    /// left and its top.
    fn texel(&self, paint: Paint, x: f64, y: f64) -> (Rgb, u8) {
        let Paint::Texture(id) = paint else { return (self.world.mean_color(paint), u8::MAX) };
        let texture = self.world.texture(id);
        let index = |place: f64, count: u32| {
            let fraction = place - place.floor();
            ((fraction * f64::from(count)) as u32).min(count - 1)
        };
        texture.texel(index(x, texture.width()), index(y, texture.height()))
    }
}

/// The texel at a position in a picture's plane.
fn texel_of(sprite: &Sprite, shown: &Figure, place: DVec3, sight: &Sight) -> Option<(u32, u32)> {
    let picture = picture_of(sprite, shown, sight);
    let beside = (place.truncate() - shown.position).dot(sight.right) / sprite.width();
    let up = place.z - shown.base;
    // A mirror shows the mirror image of a picture that faces the image of the viewer.
    let beside = if sight.is_mirrored { -beside } else { beside };
    let x = (beside + 0.5) * f64::from(picture.width());
    let y = (1.0 - up / sprite.height.cells()) * f64::from(picture.height());
    let is_on_it = (0.0..f64::from(picture.width())).contains(&x)
        && (0.0..f64::from(picture.height())).contains(&y);
    is_on_it.then_some((x as u32, y as u32))
}

fn picture_of<'s>(sprite: &'s Sprite, shown: &Figure, sight: &Sight) -> &'s Texture {
    let to_viewer = sight.origin.truncate() - shown.position;
    sprite.picture_of(shown.frame, shown.heading, to_viewer)
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

/// The solids in a cell.
fn solids_in<'a>(world: &World, cell: Cell) -> Vec<Solid<'a>> {
    let id = world.grid().tile(cell.column.into(), cell.row.into()).unwrap();
    let tile = world.tile(id);
    let gaps: Vec<Gap> = tile.gaps().collect();
    let low = DVec3::new(f64::from(cell.column), f64::from(cell.row), -FAR);
    let high = DVec3::new(low.x + 1.0, low.y + 1.0, gaps[0].bottom);
    let top = match tile.kind {
        TileKind::Wall(_) | TileKind::Mirror(_) => tile.riser.into(),
        _ => tile.floor,
    };
    let is_door = matches!(tile.kind, TileKind::Door(_));
    let is_open = matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
    let side_light = tile.light.filter(|_| !is_open);
    let flat_light = world.light_in(cell);
    let below = Block {
        low,
        high,
        side: tile.riser,
        has_jambs: matches!(tile.kind, TileKind::Wall(_)),
        top,
        bottom: top,
        side_light,
        is_lit_by_cells: is_door,
        flat_light,
        mirror: match tile.kind {
            TileKind::Mirror(tint) => Some(tint),
            _ => None,
        },
    };
    let above = gaps.get(1).map(|gap| Block {
        low: low.with_z(gaps[0].top),
        high: high.with_z(gap.bottom),
        side: tile.lintel,
        has_jambs: false,
        top: tile.lintel.into(),
        bottom: match tile.ceiling {
            Ceiling::Covered(covering) => covering,
            Ceiling::Sky => unreachable!("there is rock above"),
        },
        side_light,
        is_lit_by_cells: is_door,
        flat_light,
        mirror: None,
    });
    let cube = match tile.kind {
        TileKind::Glass(glass) => Some((Paint::Color(glass.color), Some(glass.opacity))),
        TileKind::Mask(texture) => Some((Paint::Texture(texture), None)),
        _ => None,
    };
    let cube = cube.map(|(side, opacity)| Solid::Cube {
        block: Block {
            low: low.with_z(tile.heights.floor()),
            high: high.with_z(tile.heights.ceiling()),
            side,
            has_jambs: false,
            top: side.into(),
            bottom: side.into(),
            side_light,
            is_lit_by_cells: false,
            flat_light,
            mirror: None,
        },
        tile: id,
        opacity,
    });
    let shape = match tile.kind {
        TileKind::Shape(shape) => Some(shape),
        _ => None,
    };
    let shape = shape.map(|shape| {
        let heights = Gap { bottom: tile.heights.floor(), top: tile.top_of_what_stands() };
        let paint = shape.paint;
        match shape.outline {
            Outline::Pillar(radius) => {
                Solid::Pillar { center: cell.center(), radius: radius.cells(), heights, paint }
            }
            Outline::Line(line) => {
                let (start, way) = (line.start(cell), line.stretch());
                Solid::Panel { start, way, heights, paint, cell, opening: None }
            }
        }
    });
    let leaf = match tile.kind {
        TileKind::Door(door) => Some(leaf_of(world, cell, &tile, door.leaf)),
        _ => None,
    };
    let standing = shape.into_iter().chain(cube).chain(leaf);
    [below].into_iter().chain(above).map(Solid::Block).chain(standing).collect()
}

/// The leaf of the door in `cell`, which slides into the jamb in the west or in the north.
fn leaf_of<'a>(world: &World, cell: Cell, tile: &Tile, paint: Paint) -> Solid<'a> {
    let opening = world.opening(cell).part();
    let is_jamb_in_the_west =
        world.grid().is_solid(i64::from(cell.column) - 1, i64::from(cell.row));
    let way = if is_jamb_in_the_west { DVec2::X } else { DVec2::Y };
    Solid::Panel {
        start: cell.center() - way / 2.0,
        way: way * (1.0 - opening),
        heights: Gap { bottom: tile.heights.floor(), top: tile.top_of_what_stands() },
        paint,
        cell,
        opening: Some(opening),
    }
}

fn cell_at((column, row): (f64, f64)) -> Option<Cell> {
    let is_on_axis = |place: &f64| (0.0..f64::from(u32::MAX)).contains(place);
    (is_on_axis(&column) && is_on_axis(&row))
        .then_some(Cell { column: column as u32, row: row as u32 })
}

/// The ground beyond the edges of the map.
fn ground_around(world: &World) -> impl Iterator<Item = Block> {
    let (width, height) = (f64::from(world.grid().width()), f64::from(world.grid().height()));
    let ground = world.ground();
    let around = [
        (-FAR, -FAR, 0.0, FAR),
        (width, -FAR, FAR, FAR),
        (0.0, -FAR, width, 0.0),
        (0.0, height, width, FAR),
    ];
    around.into_iter().map(move |(west, north, east, south)| Block {
        low: DVec3::new(west, north, -FAR),
        high: DVec3::new(east, south, 0.0),
        side: ground.riser,
        has_jambs: false,
        top: world.floor(),
        bottom: world.floor(),
        side_light: None,
        is_lit_by_cells: true,
        flat_light: ground.light.unwrap_or(Light::FULL),
        mirror: None,
    })
}

impl Block {
    /// The distance at which a line enters, and the face.
    fn entry(&self, sight: &Sight) -> Option<Entry> {
        let &Sight { origin, direction, from, .. } = sight;
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
        (enters.0 >= from && enters.0 <= leaves).then_some(enters)
    }
}

/// The distance at which a line enters a pillar, and the face. Positions are relative to the
/// pillar's axis.
fn pillar_entry(
    (origin, direction, from): (DVec3, DVec3, f64),
    radius: f64,
    heights: Gap,
) -> Option<Entry> {
    let (start, along) = (origin.truncate(), direction.truncate());
    let (a, b) = (along.length_squared(), start.dot(along));
    let discriminant = b * b - a * (start.length_squared() - radius * radius);
    if discriminant < 0.0 {
        return None;
    }
    let enters = (-b - discriminant.sqrt()) / a;
    let to_top = (heights.top - origin.z) / direction.z;
    let is_on_top = (start + along * to_top).length() <= radius;
    if enters >= from && heights.holds(origin.z + direction.z * enters) {
        Some((enters, Face::Slanted))
    } else if direction.z < 0.0 && to_top >= from && is_on_top {
        Some((to_top, Face::Top))
    } else {
        None
    }
}

/// The distance at which a line crosses a thin wall along `way`, and the face. Positions are
/// relative to the wall's start.
fn panel_entry(origin: DVec3, direction: DVec3, way: DVec2, heights: Gap) -> Option<Entry> {
    let (from, along) = (origin.truncate(), direction.truncate());
    let across = along.perp_dot(way);
    let t = -from.perp_dot(way) / across;
    let place = -from.perp_dot(along) / across;
    let is_met = across != 0.0
        && t >= 0.0
        && (0.0..=1.0).contains(&place)
        && heights.holds(origin.z + direction.z * t);
    is_met.then_some((t, Face::Slanted))
}

//! Billboards: flat pictures of things and figures that stand parallel to the camera plane.

use std::ops::Range;

use glam::DVec2;

#[cfg(feature = "terminal")]
use super::Projection;
use super::{FrameContext, Lighting};
use crate::cast::MirrorTransform;
use crate::world::texture::MipLevel;
use crate::world::{Camera, Cell, Figure, Heading, Light, Sprite, SpriteId, Thing};
#[cfg(feature = "terminal")]
use crate::world::{Heights, World};

/// The least distance from the camera plane at which a thing is drawn, in cells. A nearer thing would contain
/// the player.
const NEAREST: f64 = 0.2;

/// A thing, a figure or the player in the picture, seen directly or in mirrors.
#[derive(Clone, Debug)]
pub(crate) struct Billboard {
    /// The sprite of a thing or a figure; `None` for the player.
    sprite: Option<SpriteId>,
    /// `true` if its frame changes with time.
    is_animated: bool,
    /// The index of the sprite's picture, and its mip level.
    picture: usize,
    lod: usize,
    pub(crate) lighting: Lighting,
    /// The opacity, from 1 to 255.
    pub(crate) opacity: u8,
    /// The distance from the camera plane, in cells.
    pub(crate) depth: f64,
    /// The position of the left edge in columns, and the width in pixels.
    left: f64,
    width: f64,
    /// The columns of pixels whose centres it covers.
    pub(crate) columns: Range<usize>,
    /// The position of the top in rows, and the number of texels per row of pixels.
    top: f64,
    texels_in_row: f64,
    /// The rows of pixels whose centres it covers.
    pub(crate) rows: Range<u32>,
    is_mirrored: bool,
    /// `true` if any part of it is in view.
    pub(crate) is_drawn: bool,
    /// The order among billboards at the same depth: by row, column and sprite, then things before figures, and
    /// figures in the order of the world's list.
    pub(crate) order: (u32, u32, u16, u32),
}

/// Returns whether `figure`, or its mark on a map of the view, may be seen in a picture whose rays end at
/// `distances`. The picture must have no mirrors. The figure may be seen if a part of it is nearer than the end
/// of a ray, or if it rises above level walls under the sky.
#[cfg(feature = "terminal")]
pub(crate) fn may_show(
    world: &World,
    projection: &Projection,
    distances: &[f64],
    figure: &Figure,
) -> bool {
    /// The number of columns on each side of the figure that are also checked: more than the rounding error.
    const MARGIN: f64 = 1.0;
    let Some(sprite) = world.sprites().get(usize::from(figure.sprite.0)) else { return false };
    let place = projection.place(figure.position);
    if place.depth < NEAREST {
        return place.depth > 0.0;
    }
    let half = projection.columns_for(sprite.width(), place.depth) / 2.0 + MARGIN;
    let covered = projection.columns_between(place.column - half, place.column + half);
    let ends = distances.get(covered);
    let top = figure.base + sprite.height.cells();
    world.tile_facts().have_open_sky && top > Heights::LEVEL.ceiling()
        || ends.is_none_or(|ends| ends.iter().any(|&end| place.depth <= end))
}

/// The frame and the heading that a billboard shows.
#[derive(Clone, Copy)]
enum Pose {
    /// The sprite's own heading, and its frame after this many seconds.
    AtTime(f64),
    Fixed {
        frame: usize,
        heading: Heading,
    },
}

/// An image, and the distances at which the rays of all columns end if it is the direct one.
pub(crate) type Image<'a> = (MirrorTransform, Option<&'a [f64]>);

/// The place of a billboard on the map, and its columns in the picture.
struct Placement {
    center: DVec2,
    depth: f64,
    left: f64,
    width: f64,
    columns: Range<usize>,
}

impl Placement {
    /// The placement of a sprite of this `width`, in cells, with its middle at a point on the map. `None` if it
    /// is outside the picture, or behind the ends of all rays in its columns. Most things are, so this costs
    /// less than their whole billboards.
    fn new(
        scene: FrameContext<'_>,
        (image, distances): Image<'_>,
        center: DVec2,
        width: f64,
    ) -> Option<Self> {
        let projection = scene.projection;
        let place = projection.place(image.in_image(center));
        let depth = place.depth;
        if !(NEAREST..f64::INFINITY).contains(&depth) {
            return None;
        }
        let width = projection.columns_for(width, depth);
        let left = place.column - width / 2.0;
        let columns = projection.columns_between(left, left + width);
        let is_reached = match distances {
            Some(ends) => {
                let mut ends = ends[columns.clone()].iter();
                ends.any(|&end| depth < end)
            }
            None => !columns.is_empty(),
        };
        is_reached.then_some(Self { center, depth, left, width, columns })
    }
}

impl Billboard {
    /// The billboard of `thing` in an image; `None` if it is outside the picture.
    pub(crate) fn of_thing(
        scene: FrameContext<'_>,
        image: Image<'_>,
        thing: Thing,
    ) -> Option<Self> {
        let world = scene.world;
        let sprite = world.sprite(thing.sprite);
        let place = Placement::new(scene, image, thing.cell.center(), sprite.width())?;
        let base = sprite.base(world.room_in(thing.cell));
        let light = world.light_in(thing.cell);
        let pose = match thing.frame {
            None => Pose::AtTime(scene.seconds),
            Some(frame) => Pose::Fixed { frame: usize::from(frame), heading: sprite.heading },
        };
        let billboard = Self::new(scene, image.0, sprite, pose, (place, base), light)?;
        let order = (thing.cell.row, thing.cell.column, thing.sprite.0, 0);
        let (sprite, is_animated) = (Some(thing.sprite), thing.frame.is_none());
        Some(Self { sprite, is_animated, order, ..billboard })
    }

    /// The billboards, in an image, of the figures that are at least partly inside the picture.
    pub(crate) fn of_figures(
        scene: FrameContext<'_>,
        image: Image<'_>,
    ) -> impl Iterator<Item = Self> {
        let figures = (1..).zip(scene.world.figures());
        figures.filter_map(move |(number, figure)| Self::of_figure(scene, image, number, figure))
    }

    /// The billboard of `figure` in an image. `None` if it is outside the picture, fully transparent, or has an
    /// unknown sprite.
    fn of_figure(
        scene: FrameContext<'_>,
        image: Image<'_>,
        number: u32,
        figure: &Figure,
    ) -> Option<Self> {
        let world = scene.world;
        let &Figure { position, base, heading, frame, opacity, .. } = figure;
        let sprite = world.sprites().get(usize::from(figure.sprite.0)).filter(|_| opacity > 0)?;
        let place = Placement::new(scene, image, position, sprite.width())?;
        let pose = Pose::Fixed { frame: usize::from(frame), heading };
        let light = world.light_on(figure);
        let billboard = Self::new(scene, image.0, sprite, pose, (place, base), light)?;
        let lighting = if sprite.glows { Lighting::FULL } else { billboard.lighting };
        let (row, column) = figure.cell().map_or((0, 0), |cell| (cell.row, cell.column));
        let order = (row, column, figure.sprite.0, number);
        Some(Self { sprite: Some(figure.sprite), opacity, lighting, order, ..billboard })
    }

    /// The billboard of the player in an image, drawn as `figure`.
    pub(crate) fn of_player(
        scene: FrameContext<'_>,
        image: Image<'_>,
        figure: &Sprite,
    ) -> Option<Self> {
        let origin = scene.projection.origin();
        let place = Placement::new(scene, image, origin, figure.width())?;
        let base = scene.projection.eye() - Camera::STANDING;
        let cell = Cell::containing(origin);
        let light = cell.map_or(Light::FULL, |cell| scene.world.light_in(cell));
        Self::new(scene, image.0, figure, Pose::AtTime(0.0), (place, base), light)
    }

    /// The billboard of `sprite` at a place, with its base at a height.
    fn new(
        scene: FrameContext<'_>,
        image: MirrorTransform,
        sprite: &Sprite,
        pose: Pose,
        (place, base): (Placement, f64),
        light: Light,
    ) -> Option<Self> {
        let FrameContext { world, projection, plan, .. } = scene;
        let Placement { center, depth, left, width, columns } = place;
        let top = projection.row_at(base + sprite.height.cells(), depth);
        let bottom = projection.row_at(base, depth);
        let rows = projection.rows_between(top, bottom);
        if rows.is_empty() {
            return None;
        }
        let to_viewer = image.to_map(projection.origin()) - center;
        let (frame, heading) = match pose {
            Pose::AtTime(seconds) => (sprite.frame_at(seconds), sprite.heading),
            Pose::Fixed { frame, heading } => (frame, heading),
        };
        let picture = sprite.picture_index(frame, heading, to_viewer);
        let texture = &sprite.pictures()[picture];
        let texels = f64::from(texture.width()) * f64::from(texture.height());
        let lod = plan.filter.lod(texels / (width * (bottom - top)));
        Some(Self {
            sprite: None,
            is_animated: false,
            picture,
            lod,
            lighting: Lighting::of_plane(light, world.fog(), depth),
            opacity: u8::MAX,
            depth,
            left,
            width,
            columns,
            top,
            texels_in_row: f64::from(texture.height_of_level(lod)) / (bottom - top),
            rows,
            is_mirrored: image.swaps_sides(),
            is_drawn: false,
            order: (0, 0, 0, 0),
        })
    }

    /// Returns true if it shows a thing or a figure, and not the player.
    pub(crate) fn is_of_thing(&self) -> bool {
        self.sprite.is_some()
    }

    /// The mip level from which it is drawn. A billboard of the player takes it from the sprite `player`.
    pub(crate) fn level<'a>(
        &self,
        scene: FrameContext<'a>,
        player: Option<&'a Sprite>,
    ) -> Option<&'a MipLevel> {
        let sprite = match self.sprite {
            Some(id) => scene.world.sprite(id),
            None => player?,
        };
        Some(sprite.pictures()[self.picture].level(self.lod))
    }

    /// The position across its picture of the pixel centres in `column`, from 0 to 1.
    pub(crate) fn u(&self, column: usize) -> f64 {
        let u = (column as f64 + 0.5 - self.left) / self.width;
        if self.is_mirrored { 1.0 - u } else { u }
    }

    /// The texel at the centre of `row`, counted from the top.
    #[inline]
    pub(crate) fn texel(&self, row: u32) -> usize {
        // A conversion to 32 bits takes fewer instructions.
        ((f64::from(row) + 0.5 - self.top) * self.texels_in_row) as u32 as usize
    }

    /// The next time at which a billboard in view changes its appearance; `None` for never.
    pub(crate) fn next_change(billboards: &[Self], scene: FrameContext<'_>) -> Option<f64> {
        let drawn =
            billboards.iter().filter(|it| it.is_drawn && it.is_animated).filter_map(|it| it.sprite);
        let changes = drawn.filter_map(|id| scene.world.sprite(id).next_change(scene.seconds));
        changes.reduce(f64::min)
    }
}

//! Things, where the world is not level: billboards that are clipped to the windows they are seen in.
//!
//! A thing is seen by each unfolding of the map once, at its own depth. Along a ray, whatever is
//! between two lines is behind the panes at the first and before all at the second; so a column notes
//! such a stretch among its veils, and the things in it are cut to strips as wide as a pixel. Drawing each
//! thing across all of its columns at once was refused: what hides it differs from one to the next.

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec2;

use super::notes::Notes;
use super::profile::{Profiles, SlotId};
use super::sights::Sights;
use super::{IMAGES_AT_ONCE, Reflection, Scene, Viewer};
use crate::cast::{Side, Unfolding};
use crate::render::Surface;
use crate::render::band::Band;
use crate::render::marks::MarksOfBand;
use crate::render::shade::{Faded, Shade};
use crate::render::tally::{Pass, Tally};
use crate::render::things::NEAREST;
use crate::world::sprite::builtin;
use crate::world::{Camera, Cell, Light, Sprite, SpriteId, Thing};

/// A part of a ray that is in one gap.
#[derive(Clone, Debug)]
pub(super) struct Between {
    pub(super) column: u32,
    /// The rows that nothing nearer covers.
    pub(super) rows: Range<u32>,
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) slot: SlotId,
    pub(super) reflection: Reflection,
}

/// The things in view, as they stand in the picture; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct Billboards {
    /// Those of each image together, from near to far.
    list: Vec<Billboard>,
    of_image: Vec<Range<usize>>,
    sights: Sights,
    /// Which columns show any of them, if nothing is before it.
    is_covered: Vec<bool>,
    considered: u64,
    /// The player, as they see themselves; `None` until there is a mirror.
    figure: Option<Sprite>,
}

/// What shows of a thing in a column of pixels.
#[derive(Clone, Debug)]
pub(super) struct Strip {
    pub(super) column: u32,
    pub(super) rows: Range<u32>,
    /// Which of all billboards.
    billboard: usize,
}

#[derive(Clone, Debug)]
struct Billboard {
    /// `None` for the player.
    sprite: Option<SpriteId>,
    /// Which of the sprite's pictures, and how often to halve it.
    picture: usize,
    halvings: usize,
    shade: Faded,
    depth: f64,
    /// Where its left edge is, in pixels, and how many pixels wide it is.
    left: f64,
    width: f64,
    columns: Range<u32>,
    /// Where its top and its bottom are, in rows.
    top: f64,
    bottom: f64,
    is_mirrored: bool,
    is_drawn: bool,
    /// Which comes first of those that are equally far away.
    order: (u32, u32, u16),
}

impl Billboards {
    /// Finds all that the rays of `notes` show to `viewer`.
    pub(super) fn find(&mut self, scene: Scene<'_>, notes: &Notes, viewer: Viewer<'_>) {
        const MOST_AT_FIRST: usize = 4096;
        let (world, images) = (scene.world, &notes.images);
        let players = images.len().max(IMAGES_AT_ONCE);
        self.list.clear();
        self.list.reserve(world.things().len().min(MOST_AT_FIRST) + players);
        self.of_image.clear();
        self.of_image.reserve(players);
        self.considered = 0;
        if self.figure.is_none() && world.has_mirrors() {
            self.figure = builtin::named(builtin::PLAYER);
        }
        if let Some(figure) = &mut self.figure {
            figure.heading = viewer.camera.heading;
        }
        self.sights.look(scene, images.len(), &notes.legs);
        for (index, &unfolding) in images.iter().enumerate() {
            let start = self.list.len();
            for &thing in self.sights.things(index, world) {
                self.considered += 1;
                self.list.extend(Billboard::of_thing(scene, unfolding, thing, viewer.seconds));
            }
            if let Some(figure) = self.figure.as_ref().filter(|_| index > 0) {
                self.list.extend(Billboard::of_player(scene, unfolding, figure));
            }
            self.list[start..].sort_unstable_by(from_near_to_far);
            self.of_image.push(start..self.list.len());
        }
        self.is_covered.clear();
        self.is_covered.resize(scene.projection.columns(), false);
        for billboard in &self.list {
            let Range { start, end } = billboard.columns;
            self.is_covered[start as usize..end as usize].fill(true);
        }
    }

    /// Cuts out what shows in a part of a ray, from far to near.
    pub(super) fn cut(
        &mut self,
        (scene, profiles): (Scene<'_>, &Profiles),
        between: &Between,
        mut cut_out: impl FnMut(Strip),
    ) {
        if !self.is_covered[between.column as usize] {
            return;
        }
        let Reflection(image) = between.reflection;
        let of_image = self.of_image[usize::from(image)].clone();
        let first = of_image.start;
        let list = &mut self.list[of_image];
        let start = list.partition_point(|it| it.depth < between.from);
        let end = list.partition_point(|it| it.depth < between.to).max(start);
        for (index, billboard) in list.iter_mut().enumerate().take(end).skip(start).rev() {
            let rows = billboard.rows_in(scene, profiles, between);
            if !rows.is_empty() {
                billboard.is_drawn = true;
                cut_out(Strip { column: between.column, rows, billboard: first + index });
            }
        }
    }

    /// Draws what shows in one column.
    pub(super) fn draw<T: Tally>(
        &self,
        scene: Scene<'_>,
        strip: &Strip,
        marks: &mut MarksOfBand<'_>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        let billboard = &self.list[strip.billboard];
        let sprite = match billboard.sprite {
            Some(id) => Some(scene.world.sprite(id)),
            None => self.figure.as_ref(),
        };
        if let Some(sprite) = sprite {
            billboard.draw(sprite, strip, marks, band, tally);
        }
    }

    /// How many things were looked at, and how many of them drawn.
    pub(super) fn counts(&self) -> (u64, u64) {
        let drawn = self.list.iter().filter(|it| it.is_drawn && it.sprite.is_some()).count();
        (self.considered, drawn as u64)
    }

    /// When something that was drawn begins to look different; `None` for never.
    pub(super) fn next_change(&self, scene: Scene<'_>, seconds: f64) -> Option<f64> {
        let drawn = self.list.iter().filter(|it| it.is_drawn);
        let sprites = drawn.filter_map(|it| it.sprite).map(|id| scene.world.sprite(id));
        sprites.filter_map(|sprite| sprite.next_change(seconds)).reduce(f64::min)
    }
}

fn from_near_to_far(one: &Billboard, other: &Billboard) -> Ordering {
    one.depth.total_cmp(&other.depth).then_with(|| other.order.cmp(&one.order))
}

impl Billboard {
    fn of_thing(
        scene: Scene<'_>,
        unfolding: Unfolding,
        thing: Thing,
        seconds: f64,
    ) -> Option<Self> {
        let world = scene.world;
        let sprite = world.sprite(thing.sprite);
        let base = sprite.base(world.room_in(thing.cell));
        let light = world.light_in(thing.cell);
        let center = thing.cell.center();
        let billboard = Self::new(scene, unfolding, sprite, seconds, center, base, light)?;
        let order = (thing.cell.row, thing.cell.column, thing.sprite.0);
        Some(Self { sprite: Some(thing.sprite), order, ..billboard })
    }

    fn of_player(scene: Scene<'_>, unfolding: Unfolding, figure: &Sprite) -> Option<Self> {
        let place = scene.projection.origin();
        let base = scene.projection.eye() - Camera::STANDING;
        let is_on_map = place.x >= 0.0 && place.y >= 0.0;
        let cell = Cell { column: place.x as u32, row: place.y as u32 };
        let light = if is_on_map { scene.world.light_in(cell) } else { Light::FULL };
        Self::new(scene, unfolding, figure, 0.0, place, base, light)
    }

    /// How `sprite` looks that stands at `center` on the map; `None` where it is out of the picture.
    fn new(
        scene: Scene<'_>,
        unfolding: Unfolding,
        sprite: &Sprite,
        seconds: f64,
        center: DVec2,
        base: f64,
        light: Light,
    ) -> Option<Self> {
        let Scene { world, projection, filter, .. } = scene;
        let place = projection.place(unfolding.unfolded_point(center));
        let depth = place.depth;
        if !(NEAREST..f64::INFINITY).contains(&depth) {
            return None;
        }
        let width = projection.columns_for(sprite.width(), depth);
        let left = place.column - width / 2.0;
        let columns = projection.columns_between(left, left + width);
        let top = projection.row_seen_at(base + sprite.height.cells(), depth);
        let bottom = projection.row_seen_at(base, depth);
        if columns.is_empty() || projection.rows_between(top, bottom).is_empty() {
            return None;
        }
        let to_viewer = unfolding.real_point(projection.origin()) - center;
        let picture = sprite.picture_index(seconds, to_viewer);
        let texture = &sprite.pictures()[picture];
        let texels = f64::from(texture.width()) * f64::from(texture.height());
        Some(Self {
            sprite: None,
            picture,
            halvings: filter.halvings(texels / (width * (bottom - top))),
            shade: Faded::of_wall(Side::X, light, world.fog(), depth),
            depth,
            left,
            width,
            columns,
            top,
            bottom,
            is_mirrored: unfolding.swaps_sides(),
            is_drawn: false,
            order: (0, 0, 0),
        })
    }

    /// The rows in which it shows in a part of a ray.
    fn rows_in(&self, scene: Scene<'_>, profiles: &Profiles, between: &Between) -> Range<u32> {
        if !self.columns.contains(&between.column) {
            return 0..0;
        }
        let projection = scene.projection;
        let own = projection.rows_between(self.top, self.bottom);
        let slot = profiles.slot(between.slot);
        let top = slot.row_of_top(projection, self.depth);
        let bottom = slot.row_of_bottom(projection, self.depth);
        let start = own.start.max(between.rows.start).max(top);
        start..own.end.min(between.rows.end).min(bottom)
    }

    fn draw<T: Tally>(
        &self,
        sprite: &Sprite,
        strip: &Strip,
        marks: &mut MarksOfBand<'_>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        let rows = band.clip(&strip.rows);
        tally.pixels(Pass::Things, rows.len());
        tally.texels(Pass::Things, rows.len());
        let u = (f64::from(strip.column) + 0.5 - self.left) / self.width;
        let u = if self.is_mirrored { 1.0 - u } else { u };
        let level = sprite.pictures()[self.picture].level(self.halvings);
        let (texels, alphas) = (level.column(u), level.alpha_column(u));
        let texels_in_row = f64::from(level.height()) / (self.bottom - self.top);
        let texel = |row: u32| {
            let texel = (f64::from(row) + 0.5 - self.top) * texels_in_row;
            (texel as usize).min(texels.len() - 1)
        };
        let alpha = |texel: usize| alphas.map_or(u8::MAX, |alphas| alphas[texel]);
        let pixels = band.column_mut(strip.column, rows.clone());
        for (row, pixel) in rows.clone().zip(pixels) {
            let texel = texel(row);
            *pixel = match alpha(texel) {
                0 => *pixel,
                u8::MAX => self.shade.apply(texels[texel]),
                alpha => self.shade.apply(texels[texel]).over(*pixel, alpha),
            };
        }
        let shown = rows.clone().map(|row| alpha(texel(row)) > u8::MAX / 2);
        marks.note(strip.column as usize, rows.start, Surface::Thing, shown);
    }
}

//! The pass for things: flat pictures that stand parallel to the camera plane.
//!
//! Where the rays ended is known by now, and with it the part of the map that can be seen, its `sight`:
//! only things in there are considered. What is left of them is drawn from far to near, column by
//! column as far as the walls let it be seen; what the rays passed on their way, such as a grate, is
//! drawn before the first thing that stands nearer. A buffer of depths for each pixel was refused: one
//! distance for each column says the same, since walls reach from floor to ceiling.

mod sight;

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec2;

use super::band::Band;
use super::marks::MarksOfBand;
use super::see_through::{self, Left, Passed};
use super::shade::{Bright, Faded, Shade};
use super::tally::{Pass, Tally};
use super::{Scene, Surface};
use crate::world::texture::Level;
use crate::world::{Thing, World};
pub(super) use sight::Sight;

/// Things that are nearer than that to the camera plane are not drawn: the player stands in them.
pub(super) const NEAREST: f64 = 0.2;

/// There is room for so many things in view from the first frame on, so that a camera that turns
/// towards more of them needs no more memory.
const MOST_AT_FIRST: usize = 4096;

/// The things in view, from far to near; kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct InView {
    sight: Sight,
    list: Vec<Billboard>,
}

/// A thing, as it stands in the picture.
#[derive(Clone, Debug)]
struct Billboard {
    /// Its place in the world's list.
    thing: Thing,
    /// How far it is from the camera plane, in cells.
    depth: f64,
    /// Where its left edge is, in pixels, and how many pixels wide it is.
    left: f64,
    width: f64,
    /// The columns of pixels whose centres are on it.
    columns: Range<u32>,
    /// Where its top and its bottom are, in rows.
    top: f64,
    bottom: f64,
    /// The rows of pixels whose centres are on it.
    rows: Range<u32>,
}

impl InView {
    /// Finds them.
    pub(super) fn find<T: Tally>(&mut self, scene: Scene<'_>, tally: &mut T) {
        let Self { sight, list } = self;
        list.clear();
        list.reserve(scene.world.things().len().min(MOST_AT_FIRST));
        let mut considered = 0;
        sight.look(scene);
        for &thing in sight.things(scene.world) {
            considered += 1;
            list.extend(Billboard::new(scene, thing));
        }
        list.sort_unstable_by(from_far_to_near);
        tally.things(considered, list.len());
    }

    /// When one of them, as they are after `seconds`, will look different; `None` for never.
    pub(super) fn next_change(&self, world: &World, seconds: f64) -> Option<f64> {
        let sprites = self.list.iter().map(|billboard| world.sprite(billboard.thing.sprite));
        sprites.filter_map(|sprite| sprite.next_change(seconds)).reduce(f64::min)
    }

    /// Draws them, as they are after `seconds`, and all that the rays `passed`.
    pub(super) fn draw<T: Tally>(
        &self,
        scene: Scene<'_>,
        seconds: f64,
        (passed, left): (&Passed, &mut Left),
        marks: &mut MarksOfBand<'_>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        left.begin(passed, scene.columns.len());
        for billboard in &self.list {
            billboard.draw(scene, seconds, (passed, left), marks, band, tally);
        }
        see_through::draw_rest(scene, (passed, left), marks, band, tally);
    }
}

fn from_far_to_near(one: &Billboard, other: &Billboard) -> Ordering {
    other.depth.total_cmp(&one.depth).then_with(|| {
        let place = |it: &Billboard| (it.thing.cell.row, it.thing.cell.column, it.thing.sprite.0);
        place(one).cmp(&place(other))
    })
}

impl Billboard {
    /// `thing`, if any of it is in the picture and before the walls.
    fn new(scene: Scene<'_>, thing: Thing) -> Option<Self> {
        let Scene { world, projection, columns: seen, .. } = scene;
        let place = projection.place(thing.cell.center());
        let depth = place.depth;
        if !(NEAREST..f64::INFINITY).contains(&depth) {
            return None;
        }
        let sprite = world.sprite(thing.sprite);
        let width = projection.columns_for(sprite.width(), depth);
        let left = place.column - width / 2.0;
        let columns = projection.columns_between(left, left + width);
        let is_seen = |x: u32| depth < seen[x as usize].distance;
        if !columns.clone().any(is_seen) {
            return None;
        }
        let base = sprite.base(world.room_in(thing.cell));
        let top = projection.row_at(base + sprite.height.cells(), depth);
        let bottom = projection.row_at(base, depth);
        let rows = projection.rows_between(top, bottom);
        let billboard = Self { thing, depth, left, width, columns, top, bottom, rows };
        (!billboard.rows.is_empty()).then_some(billboard)
    }

    /// Draws what is seen of it, and before that what is behind it of what the rays passed.
    fn draw<T: Tally>(
        &self,
        scene: Scene<'_>,
        seconds: f64,
        (passed, left): (&Passed, &mut Left),
        marks: &mut MarksOfBand<'_>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        let rows = band.clip(&self.rows);
        if rows.is_empty() {
            return;
        }
        let picture = Picture::new(scene, self, seconds, rows);
        for x in self.columns.clone() {
            if self.depth >= scene.columns[x as usize].distance {
                continue;
            }
            let passed = (passed, &mut *left);
            see_through::draw_behind(self.depth, x as usize, scene, passed, marks, band, tally);
            let u = (f64::from(x) + 0.5 - self.left) / self.width;
            picture.draw_column(x as usize, u, marks, band, tally);
        }
    }
}

/// What a thing looks like from where the camera is, in some rows.
struct Picture<'a> {
    level: &'a Level,
    shade: Option<Faded>,
    rows: Range<u32>,
    /// Where its top is, in rows, and how many texels there are in a row.
    top: f64,
    texels_in_row: f64,
}

impl<'a> Picture<'a> {
    fn new(scene: Scene<'a>, billboard: &Billboard, seconds: f64, rows: Range<u32>) -> Self {
        let Scene { world, projection, filter, .. } = scene;
        let Billboard { thing, depth, width, top, bottom, .. } = *billboard;
        let sprite = world.sprite(thing.sprite);
        let to_viewer: DVec2 = projection.origin() - thing.cell.center();
        let texture = sprite.picture(seconds, to_viewer);
        let texels = f64::from(texture.width()) * f64::from(texture.height());
        let level = texture.level(filter.halvings(texels / (width * (bottom - top))));
        Self {
            level,
            shade: Faded::of_plane(world.light_in(thing.cell), world.fog(), depth),
            rows,
            top,
            texels_in_row: f64::from(level.height()) / (bottom - top),
        }
    }

    fn draw_column<T: Tally>(
        &self,
        x: usize,
        u: f64,
        marks: &mut MarksOfBand<'_>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        tally.pixels(Pass::Things, self.rows.len());
        tally.texels(Pass::Things, self.rows.len());
        match self.shade {
            None => self.draw_shaded(Bright, x, u, band),
            Some(faded) => self.draw_shaded(faded, x, u, band),
        }
        let alphas = self.level.alpha_column(u);
        let shown = self
            .rows
            .clone()
            .map(|row| alphas.is_none_or(|alphas| alphas[self.texel(row)] > u8::MAX / 2));
        marks.note(x, self.rows.start, Surface::Thing, shown);
    }

    fn draw_shaded<S: Shade>(&self, shade: S, x: usize, u: f64, band: &mut Band<'_>) {
        let texels = self.level.column(u);
        let alphas = self.level.alpha_column(u);
        let pixels = band.column_mut(x as u32, self.rows.clone());
        for (row, pixel) in self.rows.clone().zip(pixels) {
            let texel = self.texel(row);
            *pixel = match alphas.map_or(u8::MAX, |alphas| alphas[texel]) {
                0 => *pixel,
                u8::MAX => shade.apply(texels[texel]),
                alpha => shade.apply(texels[texel]).over(*pixel, alpha),
            };
        }
    }

    /// Which texel, from the top, the centre of `row` is on.
    fn texel(&self, row: u32) -> usize {
        let texel = (f64::from(row) + 0.5 - self.top) * self.texels_in_row;
        (texel as usize).min(self.level.height() as usize - 1)
    }
}

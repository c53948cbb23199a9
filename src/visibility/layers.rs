//! Layers: masks, tints and the billboards between them, from far to near.
//!
//! A thing or a figure appears once in each image, at its own depth. The part of a ray in a sector is behind
//! the faces through which the ray enters, and in front of the faces through which it leaves. A billboard is
//! therefore drawn in the parts whose distances contain its depth, clipped to the rows and the heights of the
//! sector. The reverse of the list of items that rays passed is the order of painting. Rejected: a depth for
//! each pixel. A clip range for each column is equivalent.
//!
//! Only things in the cells that an image shows are considered. Colours are mixed as sRGB values, as in the
//! frame. Rejected: mixing linear light. It needs a table lookup in each direction for every pixel, and tints
//! looked no more like glass.

use std::cmp::Ordering;
use std::ops::Range;

use glam::DVec2;

use super::draw_list::{BillboardPart, DrawList, Layer, RayPart, RaySegment};
use super::face::Rows;
use super::visible_cells::VisibleCells;
use super::{Billboard, FrameContext};
use crate::world::sprite::builtin;
use crate::world::{Sector, World};

/// The number of mirror images for which memory is reserved in advance.
pub(crate) const IMAGES_AT_ONCE: usize = 64;
/// The number of things in view for which memory is reserved in advance.
const MAX_THINGS: usize = 4096;

/// Memory for finding billboards, reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct LayerMemory {
    /// The cells in view in each image.
    visible: Vec<VisibleCells>,
    /// The northern and southern limits of each image.
    extents: Vec<[f64; 2]>,
    /// The indices of each image's billboards, from near to far.
    of_image: Vec<Range<usize>>,
}

impl LayerMemory {
    /// Reserves memory here and in `list` for all but extreme views of `world`.
    pub(crate) fn make_room(&mut self, world: &World, width: usize, list: &mut DrawList) {
        let images = if world.has_mirrors() { IMAGES_AT_ONCE } else { 1 };
        let billboards = world.things().len().min(MAX_THINGS) + world.figures().len();
        list.make_room_for_layers(width, 2 * billboards + images, images);
        self.of_image.clear();
        self.of_image.reserve(images);
        self.extents.clear();
        self.extents.reserve(images);
        self.make_images(world, images);
    }

    fn make_images(&mut self, world: &World, images: usize) {
        if self.visible.len() < images {
            self.visible.resize_with(images, VisibleCells::default);
        }
        for visible in &mut self.visible {
            visible.make_room(world);
        }
    }
}

/// Makes the layers of `list` from the items that rays passed. Returns the number of things and figures
/// considered.
pub(crate) fn fill(scene: FrameContext<'_>, memory: &mut LayerMemory, list: &mut DrawList) -> u64 {
    let has_parts = list.passed.iter().any(|layer| matches!(layer, Layer::Part(_)));
    let considered = if has_parts { find_billboards(scene, memory, list) } else { 0 };
    let mut passed = std::mem::take(&mut list.passed);
    for layer in passed.drain(..).rev() {
        match layer {
            Layer::Part(part) => cut(scene, memory, &part, list),
            other => list.layers.push(other),
        }
    }
    list.passed = passed;
    considered
}

/// Finds the billboards of all images. Returns the number of things and figures considered.
fn find_billboards(scene: FrameContext<'_>, memory: &mut LayerMemory, list: &mut DrawList) -> u64 {
    let world = scene.world;
    if list.player.is_none() && world.has_mirrors() {
        list.player = builtin::named(builtin::PLAYER);
    }
    if let Some(player) = &mut list.player {
        player.heading = scene.camera.heading;
    }
    look(scene, memory, list);
    let mut considered = 0;
    memory.of_image.clear();
    let DrawList { images, distances, billboards, player, .. } = list;
    for (index, &image) in images.iter().enumerate() {
        let start = billboards.len();
        let is_direct = index == 0;
        let image = (image, is_direct.then_some(distances.as_slice()));
        for &thing in memory.visible[index].things(world) {
            considered += 1;
            billboards.extend(Billboard::of_thing(scene, image, thing));
        }
        considered += world.figures().len() as u64;
        billboards.extend(Billboard::of_figures(scene, image));
        if let Some(player) = player.as_ref().filter(|_| !is_direct && !has_own_figure(scene)) {
            billboards.extend(Billboard::of_player(scene, image, player));
        }
        billboards[start..].sort_unstable_by(from_near_to_far);
        memory.of_image.push(start..billboards.len());
    }
    considered
}

/// Finds the cells in view in each image.
fn look(scene: FrameContext<'_>, memory: &mut LayerMemory, list: &DrawList) {
    let world = scene.world;
    let images = list.images.len();
    memory.make_images(world, images);
    let mut visible = memory.visible[..images].iter_mut();
    if visible.all(|visible| visible.shows_all_of(world, images)) {
        return;
    }
    memory.extents.clear();
    memory.extents.resize(images, [f64::INFINITY, f64::NEG_INFINITY]);
    let extents = &mut memory.extents;
    for_each_edge(scene, list, |image, ends| {
        let [north, south] = &mut extents[image];
        for end in ends {
            (*north, *south) = (north.min(end.y), south.max(end.y));
        }
    });
    for (visible, &[north, south]) in memory.visible.iter_mut().zip(&memory.extents) {
        visible.begin(world, north, south);
    }
    let visible = &mut memory.visible;
    for_each_edge(scene, list, |image, [one, other]| visible[image].follow(one, other));
}

/// Calls `follow` with the index of the image and each edge of the area on the map that ray parts cover. It
/// skips edges whose ends are not finite. In the direct image, it also skips edges at which a part begins,
/// because another part ends there.
fn for_each_edge(
    scene: FrameContext<'_>,
    list: &DrawList,
    mut follow: impl FnMut(usize, [DVec2; 2]),
) {
    let origin = scene.projection.origin();
    for layer in &list.passed {
        let Layer::Part(part) = layer else { continue };
        let index = list.index_of_image(part.image);
        let ends = |column: usize| {
            let stretch = list.stretches[part.first + column - part.columns.start];
            let direction = list.directions.of(column);
            [stretch.from, stretch.to].map(|t| part.image.to_map(origin + direction * t))
        };
        let mut corners = list.corners[part.corners.clone()].iter();
        let Some(&first) = corners.next() else { continue };
        let mut before = ends(first);
        let mut follow = |edge: [DVec2; 2]| {
            if edge.iter().all(|end| end.is_finite()) {
                follow(index, edge);
            }
        };
        follow(before);
        for &column in corners {
            let after = ends(column);
            if index > 0 {
                follow([before[0], after[0]]);
            }
            follow([before[1], after[1]]);
            before = after;
        }
        follow(before);
    }
}

/// Returns true if the world has a figure at the camera, which mirrors show instead of the built-in player.
fn has_own_figure(scene: FrameContext<'_>) -> bool {
    let origin = scene.projection.origin();
    scene.world.figures().iter().any(|figure| figure.position == origin)
}

fn from_near_to_far(one: &Billboard, other: &Billboard) -> Ordering {
    one.depth.total_cmp(&other.depth).then_with(|| other.order.cmp(&one.order))
}

/// Adds the layers of the billboards in a ray part, from far to near.
fn cut(scene: FrameContext<'_>, memory: &LayerMemory, part: &RayPart, list: &mut DrawList) {
    let index = list.index_of_image(part.image);
    let of_image = memory.of_image[index].clone();
    if of_image.is_empty() {
        return;
    }
    let stretches = &list.stretches[part.first..][..part.columns.len()];
    let from = stretches.iter().map(|it| it.from).fold(f64::INFINITY, f64::min);
    let to = stretches.iter().map(|it| it.to).fold(0.0, f64::max);
    let first = of_image.start;
    let billboards = &mut list.billboards[of_image];
    let start = billboards.partition_point(|it| it.depth < from);
    let end = billboards.partition_point(|it| it.depth < to).max(start);
    for (index, billboard) in billboards.iter_mut().enumerate().take(end).skip(start).rev() {
        let columns = part.columns.start.max(billboard.columns.start)
            ..part.columns.end.min(billboard.columns.end);
        if columns.is_empty() {
            continue;
        }
        let limits = limits(scene, part, list.sectors.get(part.sector), billboard);
        let first_rows = list.billboard_rows.len();
        let of_columns = &stretches[columns.start - part.columns.start..];
        list.billboard_rows.extend(of_columns[..columns.len()].iter().map(|stretch| {
            let &RaySegment { rows, from, to } = stretch;
            let is_in_it = from <= billboard.depth && billboard.depth < to;
            let rows = Rows { start: rows.start.max(limits.start), end: rows.end.min(limits.end) };
            if is_in_it { rows } else { Rows::NONE }
        }));
        if list.billboard_rows[first_rows..].iter().all(|rows| rows.is_empty()) {
            list.billboard_rows.truncate(first_rows);
            continue;
        }
        billboard.is_drawn = true;
        let (first, billboard) = (first_rows, first + index);
        list.layers.push(Layer::Billboard(BillboardPart { columns, first, billboard }));
    }
}

/// The rows of `billboard` between the heights of a ray part.
fn limits(scene: FrameContext<'_>, part: &RayPart, sector: &Sector, billboard: &Billboard) -> Rows {
    let row_of = |height| scene.projection.row_of_height(height, billboard.depth);
    let top = if sector.top < f64::INFINITY { row_of(sector.top) } else { 0 };
    let bottom = row_of(part.top_below.unwrap_or(sector.bottom));
    Rows { start: billboard.rows.start.max(top), end: billboard.rows.end.min(bottom) }
}

#[cfg(test)]
mod tests;

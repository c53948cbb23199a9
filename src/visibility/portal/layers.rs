//! The layers of the portal way: see-through faces, and the billboards between them.
//!
//! A thing or a figure is seen once in each image, at its own depth. Along a ray, the part between two lines is
//! behind the see-through faces at the first line and in front of all faces at the second. A column
//! therefore keeps such a part of its ray, and the billboards in it are cut to columns, clipped to the gaps in
//! which they are seen. Rejected: drawing each billboard across all of its columns at once. Different faces
//! cover it in each column.

use std::cmp::Ordering;
use std::ops::Range;

use super::ImageId;
use super::bundle::{Bundle, Clip};
use super::ray_segments::{ImagesInView, RaySegment};
use super::tile_gaps::{GapId, TileGaps};
use crate::visibility::draw_list::put_in_order;
use crate::visibility::runs::{Chains, IMAGES_AT_ONCE};
use crate::visibility::{Billboard, BillboardColumn, DrawList, Layer, Scene};
use crate::world::World;
use crate::world::sprite::builtin;

/// An item that a ray passes.
#[derive(Clone, Debug)]
pub(crate) enum Passed {
    /// An index into the masked and translucent columns.
    SeeThrough(usize),
    /// The billboards in a part of the ray.
    Billboards(RayPart),
}

/// Memory for ordering layers, reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct LayerMemory {
    /// The layers of each column together, from far to near.
    by_column: Vec<Layer>,
}

impl LayerMemory {
    /// Reserves memory for as many layers as `list` has memory for.
    pub(crate) fn make_room(&mut self, list: &DrawList) {
        self.by_column.clear();
        self.by_column.reserve(list.layers.capacity());
    }
}

/// Makes the layers of `list` from the items that rays passed: in each column, nearer items come
/// later.
pub(crate) fn fill(
    scene: Scene<'_>,
    gaps: &TileGaps,
    passed: &Chains<Passed>,
    finder: &Finder,
    memory: &mut LayerMemory,
    list: &mut DrawList,
) {
    let by_column = &mut memory.by_column;
    by_column.clear();
    for passed in (0..passed.width()).flat_map(|column| passed.latest_first(column)) {
        match passed {
            &Passed::SeeThrough(index) => by_column.push(Layer::SeeThrough(index)),
            Passed::Billboards(part) => {
                finder.cut(scene, gaps, part, &mut list.billboards, |column| {
                    by_column.push(Layer::Billboard(column));
                });
            }
        }
    }
    put_in_order(by_column, &list.see_through, &mut list.layers);
}

/// The part of a ray within one gap.
#[derive(Clone, Debug)]
pub(crate) struct RayPart {
    pub(crate) column: u32,
    /// The rows that no nearer surface covers.
    pub(crate) rows: Range<u32>,
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) gap: GapId,
    /// The height of the top of a pillar below it, which hides what is lower.
    top_below: Option<f64>,
    pub(crate) image: ImageId,
}

impl RayPart {
    /// The part of the ray of `column`, whose clip is `clip`, up to `to`, for billboards that are higher than
    /// the top of a pillar below it.
    #[inline]
    pub(crate) fn new(
        bundle: &Bundle,
        column: u32,
        clip: &Clip,
        to: f64,
        top_below: Option<f64>,
    ) -> Self {
        let &Bundle { gap, image, .. } = bundle;
        let &Clip { ref rows, from, .. } = clip;
        Self { column, rows: rows.clone(), from, to, gap, top_below, image }
    }
}

/// Finds the billboards in view, in memory that is reused from frame to frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct Finder {
    /// The billboards of each image, from near to far, as indices.
    of_image: Vec<Range<usize>>,
    in_view: ImagesInView,
    /// Whether each column shows any billboard, unless a nearer face covers it.
    is_covered: Vec<bool>,
}

impl Finder {
    /// Reserves memory for the images of all but extreme maps.
    pub(crate) fn make_room(&mut self, world: &World, width: usize) {
        self.of_image.clear();
        self.of_image.reserve(IMAGES_AT_ONCE);
        self.is_covered.clear();
        self.is_covered.reserve(width);
        self.in_view.make_room(world, 1);
    }

    /// Finds the billboards in the `segments` of rays. Returns the number of things and figures
    /// considered.
    pub(crate) fn find(
        &mut self,
        scene: Scene<'_>,
        segments: &[RaySegment],
        list: &mut DrawList,
    ) -> u64 {
        let world = scene.world;
        let DrawList { billboards, player, runs, .. } = list;
        let images = runs.images();
        let first = billboards.len();
        self.of_image.clear();
        if player.is_none() && world.has_mirrors() {
            *player = builtin::named(builtin::PLAYER);
        }
        if let Some(player) = player {
            player.heading = scene.camera.heading;
        }
        self.in_view.look(scene, images.len(), segments);
        let mut considered = 0;
        for (index, &image) in images.iter().enumerate() {
            let start = billboards.len();
            for &thing in self.in_view.things(index, world) {
                considered += 1;
                billboards.extend(Billboard::of_thing(scene, image, thing));
            }
            considered += world.figures().len() as u64;
            billboards.extend(Billboard::of_figures(scene, image));
            if let Some(player) = player.as_ref().filter(|_| index > 0 && !has_own_figure(scene)) {
                billboards.extend(Billboard::of_player(scene, image, player));
            }
            billboards[start..].sort_unstable_by(from_near_to_far);
            self.of_image.push(start..billboards.len());
        }
        self.is_covered.clear();
        self.is_covered.resize(scene.projection.columns(), false);
        for billboard in &billboards[first..] {
            let Range { start, end } = billboard.columns;
            self.is_covered[start as usize..end as usize].fill(true);
        }
        considered
    }

    /// Cuts out the visible billboards of a part of a ray, from far to near.
    pub(crate) fn cut(
        &self,
        scene: Scene<'_>,
        gaps: &TileGaps,
        part: &RayPart,
        billboards: &mut [Billboard],
        mut cut_out: impl FnMut(BillboardColumn),
    ) {
        if !self.is_covered[part.column as usize] {
            return;
        }
        let ImageId(image) = part.image;
        let of_image = self.of_image[usize::from(image)].clone();
        let first = of_image.start;
        let list = &mut billboards[of_image];
        let start = list.partition_point(|it| it.depth < part.from);
        let end = list.partition_point(|it| it.depth < part.to).max(start);
        for (index, billboard) in list.iter_mut().enumerate().take(end).skip(start).rev() {
            let rows = rows_in(scene, gaps, billboard, part);
            if !rows.is_empty() {
                billboard.is_drawn = true;
                let (column, billboard) = (part.column, first + index);
                cut_out(BillboardColumn { column, rows, billboard });
            }
        }
    }
}

/// Whether the world has a figure of the player who sees it, which mirrors show then.
fn has_own_figure(scene: Scene<'_>) -> bool {
    let origin = scene.projection.origin();
    scene.world.figures().iter().any(|figure| figure.position == origin)
}

fn from_near_to_far(one: &Billboard, other: &Billboard) -> Ordering {
    one.depth.total_cmp(&other.depth).then_with(|| other.order.cmp(&one.order))
}

/// The rows in which `billboard` is visible in a part of a ray.
fn rows_in(scene: Scene<'_>, gaps: &TileGaps, billboard: &Billboard, part: &RayPart) -> Range<u32> {
    if !billboard.columns.contains(&part.column) {
        return 0..0;
    }
    let gap = gaps.gap(part.gap);
    let top = gap.row_of_top(scene.projection, billboard.depth);
    let bottom = match part.top_below {
        Some(height) => scene.projection.row_of_height(height, billboard.depth),
        None => gap.row_of_bottom(scene.projection, billboard.depth),
    };
    let start = billboard.rows.start.max(part.rows.start).max(top);
    start..billboard.rows.end.min(part.rows.end).min(bottom)
}

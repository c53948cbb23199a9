//! The first pass: a column of pixels, and its ray through the gaps.

use std::ops::Range;

use super::faces::Facing;
use super::{Part, Piece, Reflection, Scene, Shown, Windows, rows_between};
use crate::cast::{Hit, Ray, Side, UnfoldedWalk};
use crate::render::Column;
use crate::world::{Cell, Gap, Heights, TileId};

/// How often a ray is reflected; the mirror after that shows its tint.
pub(super) const MOST_BOUNCES: u32 = 8;

/// A ray that is followed on in one gap.
#[derive(Clone, Debug)]
pub(super) struct Branch {
    pub(super) walk: UnfoldedWalk,
    pub(super) place: Place,
    pub(super) gap: Gap,
    /// The rows that nothing nearer covers.
    pub(super) window: Range<u32>,
    /// Where on the ray it begins.
    pub(super) from: f64,
    pub(super) reflection: Reflection,
}

/// Where a branch is: in a cell, or off the map.
pub(super) type Place = Option<(Cell, TileId)>;

/// Something upright that a ray meets.
pub(super) struct Met {
    /// The kind of line that it is on, or runs along most.
    pub(super) side: Side,
    pub(super) facing: Facing,
    /// How much of the ray leads straight at it, for each unit of `t`.
    pub(super) slope: f64,
    pub(super) t: f64,
    pub(super) u: f64,
    /// From where it is met.
    pub(super) before: Place,
}

/// One column that is being looked at.
pub(super) struct Look<'a> {
    pub(super) scene: Scene<'a>,
    pub(super) column: usize,
    height: u32,
    pub(super) windows: &'a mut Windows,
    /// What it hit last before it was reflected, and how far it got.
    pub(super) hit: Option<Hit>,
    pub(super) distance: f64,
}

impl<'a> Look<'a> {
    pub(super) fn new(
        scene: Scene<'a>,
        column: usize,
        height: u32,
        windows: &'a mut Windows,
    ) -> Self {
        Self { scene, column, height, windows, hit: None, distance: 0.0 }
    }

    /// Follows `ray`, which is that of the column, to the end of all its branches. Tells what it hit
    /// and how far it got before it was reflected.
    pub(super) fn follow(mut self, ray: &Ray) -> Column {
        let start = self.start(ray);
        self.windows.branches.push(start);
        while let Some(branch) = self.windows.branches.pop() {
            self.follow_branch(branch);
        }
        let Self { scene, hit, distance, .. } = self;
        let rows = scene.projection.row_of(1.0, distance)..scene.projection.row_of(0.0, distance);
        Column { hit, distance, rows }
    }

    fn start(&self, ray: &Ray) -> Branch {
        let world = self.scene.world;
        let eye = self.scene.projection.eye();
        let most_bounces = if world.has_mirrors() { MOST_BOUNCES } else { 0 };
        let walk = UnfoldedWalk::new(world.grid(), ray, most_bounces);
        let place = walk.cell(world.grid());
        let holds_eye = |gap: &Gap| gap.holds(eye);
        let gap_in = |place: Place| self.gaps(place).into_iter().flatten().find(holds_eye);
        // An eye inside the rock sees as if the cell were like the map's own floor.
        let ground = place.map(|(cell, _)| (cell, TileId(0)));
        let (place, gap) = match (gap_in(place), gap_in(ground)) {
            (Some(gap), _) => (place, gap),
            (None, Some(gap)) => (ground, gap),
            (None, None) => (ground, BOTTOMLESS),
        };
        Branch { walk, place, gap, window: 0..self.height, from: 0.0, reflection: Reflection::NONE }
    }

    fn follow_branch(&mut self, mut branch: Branch) {
        let direction = self.scene.projection.direction_of(self.column as u32);
        loop {
            self.meet_standing(&mut branch);
            if branch.window.is_empty() {
                return;
            }
            let crossed = branch.walk.cross(self.scene.world.grid());
            self.windows.counts.cells += u64::from(crossed.into.is_some());
            let tile = |(_, tile): (Cell, TileId)| tile;
            if crossed.into.is_some() && crossed.into.map(tile) == branch.place.map(tile) {
                // All of its heights are the same.
                branch.place = crossed.into;
                continue;
            }
            let (t, u) = branch.walk.meeting(&crossed);
            self.lay(&mut branch, t);
            if branch.reflection == Reflection::NONE {
                self.distance = self.distance.max(t);
            }
            if branch.window.is_empty() {
                return;
            }
            let side = crossed.side;
            let slope = match side {
                Side::X => direction.x,
                Side::Y => direction.y,
            };
            let met = Met { side, facing: Facing::Side(side), slope, t, u, before: branch.place };
            match self.share_out(branch, crossed.into, &met) {
                Some(next) => branch = next,
                None => return,
            }
        }
    }

    /// Notes floor and ceiling of the cell that `branch` is in, which it leaves at `t`, and closes
    /// the window over them.
    pub(super) fn lay(&mut self, branch: &mut Branch, t: f64) {
        self.note_things(branch, t);
        let projection = self.scene.projection;
        let (eye, Gap { bottom, top }) = (projection.eye(), branch.gap);
        let Range { start, end } = branch.window;
        let tile = branch.place.map(|(_, tile)| tile);
        let reflection = branch.reflection;
        let piece = |part| Shown::Plane(Piece { tile, part, reflection });
        if eye > bottom {
            let row = projection.row_of(bottom, t).max(start);
            self.show(row..end, piece(self.part_below(branch)));
        }
        if eye < top && top < f64::INFINITY {
            let row = projection.row_of(top, t).min(end);
            self.show(start..row, piece(Part::Ceiling));
        }
        branch.window = self.rows(&branch.window, bottom, top, t);
        branch.from = t;
    }

    /// Whether the bottom of a branch's gap is a floor or a roof.
    fn part_below(&self, branch: &Branch) -> Part {
        let lowest = self.gaps(branch.place)[0];
        if lowest.is_none_or(|gap| gap.bottom == branch.gap.bottom) {
            Part::Floor
        } else {
            Part::Roof
        }
    }

    /// The part of `window` that shows what is between two heights at distance `t`.
    pub(super) fn rows(&self, window: &Range<u32>, bottom: f64, top: f64, t: f64) -> Range<u32> {
        rows_between(self.scene.projection, window, bottom, top, t)
    }
}

/// Where an eye is that is in no gap at all.
pub(super) const BOTTOMLESS: Gap = Gap { bottom: -2.0 * Heights::MOST, top: 2.0 * Heights::MOST };

//! The first pass: a column of pixels, and its ray through the gaps.

use std::ops::Range;

use super::faces::{Face, Stretch};
use super::veils::{Film, Veil};
use super::{Part, Piece, Reflection, Scene, Shown, Windows};
use crate::cast::{Hit, Ray, Side, UnfoldedWalk};
use crate::render::Column;
use crate::world::{Cell, Gap, Glass, Heights, Light, Paint, Tile, TileId, TileKind};

/// How often a ray is reflected; the mirror after that shows its tint.
const MOST_BOUNCES: u32 = 8;

/// A ray that is followed on in one gap.
#[derive(Clone, Debug)]
pub(super) struct Branch {
    walk: UnfoldedWalk,
    place: Place,
    gap: Gap,
    /// The rows that nothing nearer covers.
    window: Range<u32>,
    /// Where on the ray it begins.
    from: f64,
    reflection: Reflection,
}

/// Where a branch is: in a cell, or off the map.
type Place = Option<(Cell, TileId)>;

/// What is met at a line.
struct Met {
    side: Side,
    t: f64,
    u: f64,
    before: Place,
}

/// One column that is being looked at.
pub(super) struct Look<'a> {
    scene: Scene<'a>,
    column: usize,
    height: u32,
    windows: &'a mut Windows,
    hit: Option<Hit>,
    distance: f64,
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
        loop {
            if let Some((cell, TileKind::Door(_))) = self.kind(branch.place)
                && let Some(leaf) = branch.walk.leaf(self.scene.world, cell)
                && (branch.reflection == Reflection::NONE || leaf.t >= branch.from)
            {
                self.meet_leaf(&mut branch, &leaf);
            }
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
            let met = Met { side: crossed.side, t, u, before: branch.place };
            match self.share_out(branch, crossed.into, &met) {
                Some(next) => branch = next,
                None => return,
            }
        }
    }

    /// Notes floor and ceiling of the cell that `branch` is in, which it leaves at `t`, and closes
    /// the window over them.
    fn lay(&mut self, branch: &mut Branch, t: f64) {
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

    /// Shares the window of `branch` out among what is met at a line into `place`. One of the gaps
    /// is returned, others are left for later.
    fn share_out(&mut self, branch: Branch, place: Place, met: &Met) -> Option<Branch> {
        let Scene { projection, top, .. } = self.scene;
        let end_of_sky = projection.row_of(top, met.t).min(projection.first_row_of_ground());
        if branch.window.end <= end_of_sky {
            self.show(branch.window, Shown::Sky { reflection: branch.reflection });
            return None;
        }
        let mut next: Option<Branch> = None;
        let mut rock_from = f64::NEG_INFINITY;
        for gap in self.gaps(place).into_iter().flatten() {
            self.meet_rock(&branch, place, met, rock_from..gap.bottom);
            let window = self.rows(&branch.window, gap.bottom, gap.top, met.t);
            rock_from = gap.top;
            if window.is_empty() {
                continue;
            }
            let open = Branch { place, gap, window, from: met.t, ..branch.clone() };
            self.pass_pane(&open, met);
            if place.is_none() {
                self.look_beyond_edge(&open);
            } else if let Some(other) = next.replace(open) {
                self.windows.branches.push(other);
            }
        }
        next
    }

    /// Meets what is solid in `place` between two heights: a face, or a mirror.
    fn meet_rock(&mut self, branch: &Branch, place: Place, met: &Met, heights: Range<f64>) {
        let rows = self.rows(&branch.window, heights.start, heights.end, met.t);
        if rows.is_empty() {
            return;
        }
        let is_lowest = heights.start == f64::NEG_INFINITY;
        if is_lowest
            && let Some((_, TileKind::Mirror(tint))) = self.kind(place)
            && branch.walk.bounces() < MOST_BOUNCES
        {
            self.reflect(Branch { window: rows, ..branch.clone() }, place, met, tint);
            return;
        }
        let tile = self.tile(place).unwrap_or(self.ground());
        let paint = match (is_lowest, self.kind(met.before), tile.kind) {
            (
                true,
                Some((_, TileKind::Door(door) | TileKind::Doorway(door))),
                TileKind::Wall(_),
            ) => door.jamb,
            (true, ..) => tile.riser,
            (false, ..) => tile.lintel,
        };
        // As far as it is in the gap that it is seen from.
        let bottom = heights.start.max(branch.gap.bottom);
        let top = heights.end.min(branch.gap.top);
        self.face(rows, met, paint, self.light(place, met), Stretch { bottom, top });
        if branch.reflection == Reflection::NONE
            && let Some((cell, _)) = place
        {
            self.hit = Some(Hit { cell, side: met.side, t: met.t, u: met.u });
        }
    }

    /// Follows the mirror image later, behind the mirror's tint.
    fn reflect(&mut self, mut image: Branch, place: Place, met: &Met, tint: Glass) {
        self.windows.counts.bounces += 1;
        let everywhere = Stretch { bottom: BOTTOMLESS.bottom, top: BOTTOMLESS.top };
        self.veil(image.window.clone(), met, place, Film::Glass(tint), everywhere);
        image.from = met.t;
        image.walk.reflect(met.side);
        image.reflection = self.windows.reflection(image.walk.unfolding());
        self.windows.branches.push(image);
    }

    /// Passes the face of a cube that is seen through, if `branch` has just entered one.
    fn pass_pane(&mut self, branch: &Branch, met: &Met) {
        let film = match self.kind(branch.place) {
            Some((_, TileKind::Mask(texture))) => Film::Mask(texture),
            Some((_, TileKind::Glass(glass))) => Film::Glass(glass),
            _ => return,
        };
        let Some(Tile { heights, .. }) = self.tile(branch.place) else { return };
        if heights.floor() == branch.gap.bottom {
            let rows = self.rows(&branch.window, heights.floor(), heights.ceiling(), met.t);
            let stretch = Stretch { bottom: heights.floor(), top: heights.ceiling() };
            self.veil(rows, met, branch.place, film, stretch);
        }
    }

    /// Meets the leaf of the door that `branch` is in: what is above it, if anything, stays open.
    fn meet_leaf(&mut self, branch: &mut Branch, leaf: &Hit) {
        self.lay(branch, leaf.t);
        let Some((_, TileKind::Door(door))) = self.kind(branch.place) else { return };
        let Some(tile) = self.tile(branch.place) else { return };
        let (bottom, top) = (tile.heights.floor(), tile.heights.ceiling());
        if branch.gap.bottom != bottom {
            return;
        }
        let rows = self.rows(&branch.window, bottom, top, leaf.t);
        let before = branch.place;
        let met = Met { side: leaf.side, t: leaf.t, u: leaf.u, before };
        let light = self.light(before, &met);
        let above = self.rows(&branch.window, top, f64::INFINITY, leaf.t);
        self.face(rows, &met, door.leaf, light, Stretch { bottom, top });
        if branch.reflection == Reflection::NONE {
            self.hit = Some(*leaf);
            self.distance = self.distance.max(leaf.t);
        }
        branch.window = above;
    }

    /// Shows what is beyond the edge of the map: the sky, and the ground below the horizon.
    fn look_beyond_edge(&mut self, branch: &Branch) {
        let Range { start, end } = branch.window;
        let reflection = branch.reflection;
        let horizon = self.scene.projection.first_row_of_ground().clamp(start, end);
        self.show(start..horizon, Shown::Sky { reflection });
        let ground = Piece { tile: None, part: Part::Floor, reflection };
        self.show(horizon..end, Shown::Plane(ground));
    }

    fn face(&mut self, rows: Range<u32>, met: &Met, paint: Paint, light: Light, stretch: Stretch) {
        self.show(rows.clone(), Shown::Face(met.side));
        let &Met { side, t, u, .. } = met;
        let column = self.column as u32;
        self.windows.faces.push(Face { column, rows, side, t, u, paint, light, stretch });
    }

    fn veil(&mut self, rows: Range<u32>, met: &Met, place: Place, film: Film, stretch: Stretch) {
        if rows.is_empty() {
            return;
        }
        let light = self.light(place, met);
        let &Met { side, t, u, .. } = met;
        let column = self.column as u32;
        self.windows.veils.push(Veil { column, rows, side, t, u, light, film, stretch });
    }

    fn show(&mut self, rows: Range<u32>, shown: Shown) {
        let Windows { shown: pixels, width, .. } = &mut *self.windows;
        let from = rows.start as usize * *width + self.column;
        for pixel in pixels.iter_mut().skip(from).step_by(*width).take(rows.len()) {
            *pixel = shown;
        }
    }

    /// The part of `window` that shows what is between two heights at distance `t`.
    fn rows(&self, window: &Range<u32>, bottom: f64, top: f64, t: f64) -> Range<u32> {
        let projection = self.scene.projection;
        let Range { mut start, mut end } = *window;
        if top < f64::INFINITY {
            start = start.max(projection.row_of(top, t));
        }
        if bottom > f64::NEG_INFINITY {
            end = end.min(projection.row_of(bottom, t));
        }
        start..end
    }

    /// How bright what stands in `place` is, seen from where it is met: by its own light, if it is
    /// solid, else as bright as what is before it.
    fn light(&self, place: Place, met: &Met) -> Light {
        let is_solid = |tile: &&Tile| !matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
        let own = self.tile(place).filter(is_solid).and_then(|tile| tile.light);
        own.or_else(|| self.tile(met.before)?.light).unwrap_or(Light::FULL)
    }

    /// What is open at `place`, from the lowest gap up.
    fn gaps(&self, place: Place) -> [Option<Gap>; 2] {
        let Some(tile) = self.tile(place) else {
            return [Some(Gap { bottom: 0.0, top: f64::INFINITY }), None];
        };
        let mut gaps = tile.gaps();
        [gaps.next(), gaps.next()]
    }

    fn kind(&self, place: Place) -> Option<(Cell, TileKind)> {
        let (cell, _) = place?;
        Some((cell, self.tile(place)?.kind))
    }

    fn tile(&self, place: Place) -> Option<&'a Tile> {
        let (_, id) = place?;
        self.scene.world.tiles().get(usize::from(id.0))
    }

    fn ground(&self) -> &'a Tile {
        &self.scene.world.tiles()[0]
    }
}

/// Where an eye is that is in no gap at all.
const BOTTOMLESS: Gap = Gap { bottom: -2.0 * Heights::MOST, top: 2.0 * Heights::MOST };

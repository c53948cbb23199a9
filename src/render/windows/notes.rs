//! What a column of pixels notes for the passes that draw, and what it looks up in the world.

use std::ops::Range;

use super::faces::{Face, Stretch};
use super::look::{Branch, Look, Met, Place};
use super::things::Between;
use super::veils::{Film, Pane, Veil};
use super::{Shown, Windows};
use crate::world::{Cell, Gap, Light, Paint, Tile, TileKind};

impl<'a> Look<'a> {
    pub(super) fn face(
        &mut self,
        rows: Range<u32>,
        met: &Met,
        paint: Paint,
        light: Light,
        stretch: Stretch,
    ) {
        self.show(rows.clone(), Shown::Face(met.side));
        let &Met { facing, slope, t, u, .. } = met;
        let column = self.column as u32;
        self.windows.faces.push(Face { column, rows, facing, slope, t, u, paint, light, stretch });
    }

    pub(super) fn veil(
        &mut self,
        rows: Range<u32>,
        met: &Met,
        place: Place,
        film: Film,
        stretch: Stretch,
    ) {
        if rows.is_empty() {
            return;
        }
        let light = self.light(place, met);
        let &Met { facing, slope, t, u, .. } = met;
        let column = self.column as u32;
        let pane = Pane { column, rows, facing, slope, t, u, light, film, stretch };
        self.windows.veils.push(Veil::Pane(pane));
    }

    /// Takes note of the things that are seen by `branch` before it gets to `to`.
    pub(super) fn note_things(&mut self, branch: &Branch, to: f64) {
        if !self.scene.has_things {
            return;
        }
        let &Branch { ref window, gap, from, reflection, .. } = branch;
        let column = self.column as u32;
        let between = Between { column, rows: window.clone(), from, to, gap, reflection };
        self.windows.veils.push(Veil::Things(between));
    }

    pub(super) fn show(&mut self, rows: Range<u32>, shown: Shown) {
        let Windows { shown: pixels, width, .. } = &mut *self.windows;
        let from = rows.start as usize * *width + self.column;
        for pixel in pixels.iter_mut().skip(from).step_by(*width).take(rows.len()) {
            *pixel = shown;
        }
    }

    /// How bright what is in `place` is, seen from where it is met: by its own light, if it is solid,
    /// else as it is there.
    pub(super) fn light(&self, place: Place, met: &Met) -> Light {
        let is_solid = |tile: &&Tile| !matches!(tile.kind, TileKind::Open | TileKind::Doorway(_));
        let own = self.tile(place).filter(is_solid).and_then(|tile| tile.light);
        let there = |(cell, _)| self.scene.world.light_in(cell);
        own.unwrap_or_else(|| met.before.map_or(Light::FULL, there))
    }

    /// What is open at `place`, from the lowest gap up.
    pub(super) fn gaps(&self, place: Place) -> [Option<Gap>; 2] {
        let Some(tile) = self.tile(place) else {
            return [Some(Gap { bottom: 0.0, top: f64::INFINITY }), None];
        };
        let mut gaps = tile.gaps();
        [gaps.next(), gaps.next()]
    }

    pub(super) fn kind(&self, place: Place) -> Option<(Cell, TileKind)> {
        let (cell, _) = place?;
        Some((cell, self.tile(place)?.kind))
    }

    pub(super) fn tile(&self, place: Place) -> Option<&'a Tile> {
        let (_, id) = place?;
        self.scene.world.tiles().get(usize::from(id.0))
    }

    pub(super) fn ground(&self) -> &'a Tile {
        &self.scene.world.tiles()[0]
    }
}

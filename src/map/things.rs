//! Things and guards in a plan.

use super::checks;
use super::drawing::PerCharacter;
use super::legend::{Meaning, Symbol, is_thing};
use super::plan::{Names, Plan};
use super::textures::Textures;
use crate::fault::Fault;
use crate::world::sprite::builtin;
use crate::world::{
    Cell, Duty, GuardPost, KeyId, Lamp, NoteId, Sprite, SpriteId, SwitchId, Thing, ThingKind,
};

/// The largest number of sprites, and of notes.
const MAX_KINDS: usize = 1000;
/// The largest number of things.
const MAX_THINGS: usize = 1 << 20;
/// The largest number of cells that lamps light: room for ten thousand lamps of the longest reach.
/// A cell counts once for each lamp that reaches it.
///
/// A lamp takes time for each cell within its reach, so a limit on the number of lamps alone would
/// not be enough. Walls do not count, because lamps are counted before any of them is lit.
const MAX_LIT_CELLS: u64 = 1 << 25;
/// The cost of a kind of lamp, in lamps. The cells that it lights are computed once, which takes as
/// long as lighting this many lamps.
const COST_OF_LAMP_KIND: u64 = 32;

/// The things in a plan except the start, with the sprites and texts that they refer to.
#[derive(Default)]
pub(crate) struct ThingList {
    pub(crate) things: Vec<Thing>,
    pub(crate) sprites: Vec<Sprite>,
    /// The texts of notes.
    pub(crate) notes: Vec<String>,
    /// The built-in sprites that several characters may share.
    built_in: Vec<(&'static str, SpriteId)>,
}

impl ThingList {
    /// The things in `plan`. Reports the faults of their sprites.
    pub(crate) fn of(
        plan: Plan<'_>,
        keys: &Names<'_>,
        switches: &Names<'_>,
        textures: &mut Textures<'_>,
    ) -> Self {
        let mut list = Self::default();
        let mut thing_of = PerCharacter::<Option<(ThingKind, SpriteId)>>::new();
        // `None` after lamps exceeded it.
        let mut cells_to_light = Some(MAX_LIT_CELLS);
        let mut count = 0;
        for (character, symbol) in plan.symbols() {
            if list.sprites.len().max(list.notes.len()) >= MAX_KINDS {
                let message = format!("the grid has more than {MAX_KINDS} kinds of thing");
                let fault = Fault::new(symbol.place.clone(), message).label("one too many");
                textures.faults.push(fault);
                break;
            }
            let Some(thing) = list.add(symbol, keys, switches, textures) else { continue };
            let drawn = plan.drawing.count(character);
            count += drawn;
            if let (Some(lamp), Some(left)) =
                (list.sprites[usize::from(thing.1.0)].lamp, cells_to_light)
            {
                cells_to_light = left.checked_sub(cost_of_lamps(lamp, drawn));
                if cells_to_light.is_none() {
                    textures.faults.push(too_many_lamps(symbol));
                }
            }
            *thing_of.get_mut(character) = Some(thing);
        }
        textures.faults.extend(checks::too_many_spikes(plan));
        let place = plan.drawing.key_place.clone();
        if let Some(fault) = checks::too_many(place, count, MAX_THINGS, "things") {
            textures.faults.push(fault);
            return list;
        }
        list.things.extend(plan.drawing.cells().filter_map(|(cell, character)| {
            let (kind, sprite) = thing_of.get(character)?;
            // Other things select their frame by the time.
            let shows_its_state =
                matches!(kind, ThingKind::Checkpoint | ThingKind::Lever(_) | ThingKind::Spikes(_));
            Some(Thing { kind, cell, sprite, frame: shows_its_state.then_some(0) })
        }));
        list
    }

    /// Adds the sprite of a thing; returns it with the kind of thing.
    fn add(
        &mut self,
        symbol: &Symbol<'_>,
        keys: &Names<'_>,
        switches: &Names<'_>,
        textures: &mut Textures<'_>,
    ) -> Option<(ThingKind, SpriteId)> {
        let kind = match &symbol.meaning {
            Meaning::Sprite(text) => {
                let kind = if text.is_doused { ThingKind::Flame } else { ThingKind::Ornament };
                return Some((kind, self.push(text.sprite(textures)?)));
            }
            Meaning::Item(kind) => *kind,
            Meaning::Key(key) => ThingKind::Key(KeyId(keys.id(key.text)?)),
            Meaning::Lever(switch) => ThingKind::Lever(SwitchId(switches.id(switch.text)?)),
            Meaning::Note(text) => {
                self.notes.push((*text).to_owned());
                ThingKind::Note(NoteId(self.notes.len() as u16 - 1))
            }
            _ => return None,
        };
        let name = sprite_name(kind);
        if let Some(&(_, id)) = self.built_in.iter().find(|(known, _)| *known == name) {
            return Some((kind, id));
        }
        let id = self.push(builtin::named(name)?);
        self.built_in.push((name, id));
        Some((kind, id))
    }

    fn push(&mut self, sprite: Sprite) -> SpriteId {
        self.sprites.push(sprite);
        SpriteId(self.sprites.len() as u16 - 1)
    }
}

/// The name of the built-in sprite of a kind of thing.
pub(crate) fn sprite_name(kind: ThingKind) -> &'static str {
    match kind {
        ThingKind::Exit => builtin::EXIT,
        ThingKind::Treasure(..25) => "coins",
        ThingKind::Treasure(25..100) => "cup",
        ThingKind::Treasure(100..) => "crown",
        ThingKind::Healing(_) => "heart",
        ThingKind::Supply(supply, _) => supply.name(),
        ThingKind::Note(_) => "note",
        ThingKind::Checkpoint => "checkpoint",
        ThingKind::Lever(_) => "lever",
        ThingKind::Spikes(_) => "spikes",
        _ => builtin::KEY,
    }
}

/// The cells that `count` lamps light, as [`MAX_LIT_CELLS`] counts them.
fn cost_of_lamps(lamp: Lamp, count: usize) -> u64 {
    lamp.reach.cell_count() * (count as u64 + COST_OF_LAMP_KIND)
}

fn too_many_lamps(symbol: &Symbol<'_>) -> Fault {
    let message = format!(
        "the lamps of a map may light at most {MAX_LIT_CELLS} cells, counted for each lamp"
    );
    Fault::new(symbol.place.clone(), message)
        .label("with these, they light more")
        .help("draw fewer lamps, or give them a shorter reach")
}

/// The guards in the plan, row by row from the north, and within a row from the west.
pub(crate) fn posts(plan: Plan<'_>) -> Vec<GuardPost> {
    let is_guard = |meaning: &Meaning<'_>| matches!(meaning, Meaning::Guard(_));
    let waypoints = plan.drawing.cells_of(|it| plan.means(it, is_thing));
    let waypoints: PerCharacter<Option<Cell>> =
        waypoints.map(|(cell, character)| (character, Some(cell))).collect();
    let guards = plan.drawing.cells_of(|it| plan.means(it, is_guard));
    let posts = guards.filter_map(|(cell, character)| {
        let Meaning::Guard(guard) = &plan.symbol(character)?.meaning else { return None };
        let duty = match &guard.patrol {
            Some(patrol) => {
                Duty::Patrol(patrol.text.chars().filter_map(|it| waypoints.get(it)).collect())
            }
            None => guard.duty.clone(),
        };
        let (kind, heading, from) = (guard.kind, guard.heading, guard.from);
        Some(GuardPost { kind, cell, heading, duty, from })
    });
    posts.collect()
}

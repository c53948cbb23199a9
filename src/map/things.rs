//! Things in the drawing, and their sprites.

use super::doors::Keys;
use super::drawing::Drawing;
use super::items::ItemSymbol;
use super::lamp_budget::{self, LampBudget};
use super::legend::{Legend, Meaning, Symbol};
use super::per_character::PerCharacter;
use super::reader::Reader;
use super::switches::Switches;
use crate::fault::Fault;
use crate::world::sprite::builtin;
use crate::world::{NoteId, Sprite, SpriteId, Thing, ThingKind};

/// The largest number of sprites, and of notes.
const MOST_KINDS: usize = 1000;
/// The largest number of things.
const MOST_THINGS: usize = 1 << 20;
/// The largest number of spikes. All of them may come out in one step, and each is heard.
const MOST_SPIKES: usize = 512;

/// The things in a drawing except the start, with what they refer to.
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
    /// The things in the drawing. Reports the faults of their sprites.
    pub(crate) fn of(
        drawing: &Drawing<'_>,
        legend: &Legend<'_>,
        keys: &Keys,
        switches: &Switches,
        reader: &mut Reader<'_>,
    ) -> Self {
        let mut list = Self::default();
        let mut thing_of = PerCharacter::<Option<(ThingKind, SpriteId)>>::new();
        let mut lamp_budget = LampBudget::default();
        let mut count = 0;
        for (character, symbol) in legend.used_in(drawing) {
            if list.sprites.len().max(list.notes.len()) >= MOST_KINDS {
                let message = format!("the grid has more than {MOST_KINDS} kinds of thing");
                reader.faults.push(Fault::new(symbol.place.clone(), message).label("one too many"));
                break;
            }
            let thing = match &symbol.meaning {
                Meaning::Exit => list.add_built_in(ThingKind::Exit, builtin::EXIT),
                Meaning::Key(key) => keys
                    .id(key.name)
                    .and_then(|key| list.add_built_in(ThingKind::Key(key), builtin::KEY)),
                Meaning::Ornament(sprite) => {
                    let kind =
                        if sprite.is_doused { ThingKind::Flame } else { ThingKind::Ornament };
                    let sprite = sprite.sprite(reader);
                    list.add(kind, sprite)
                }
                Meaning::Item(item) => list.add_item(item, switches),
                _ => None,
            };
            let Some((_, sprite)) = thing else { continue };
            let drawn = drawing.sightings(character).count;
            count += drawn;
            let lamp = list.sprites[usize::from(sprite.0)].lamp;
            if lamp.is_some_and(|lamp| lamp_budget.is_exceeded_by(lamp, drawn)) {
                reader.faults.push(too_many_lamps(symbol));
            }
            *thing_of.get_mut(character) = thing;
        }
        reader.faults.extend(too_many_spikes(drawing, legend));
        if count > MOST_THINGS {
            reader.faults.push(too_many_things(drawing, count));
            return list;
        }
        list.things.extend(drawing.cells().filter_map(|(cell, character)| {
            let (kind, sprite) = thing_of.get(character)?;
            Some(Thing { kind, cell, sprite, frame: first_frame(kind) })
        }));
        list
    }

    /// Adds a sprite; returns it with the kind of thing that has it.
    fn add(&mut self, kind: ThingKind, sprite: Option<Sprite>) -> Option<(ThingKind, SpriteId)> {
        let id = SpriteId(u16::try_from(self.sprites.len()).ok()?);
        self.sprites.push(sprite?);
        Some((kind, id))
    }

    fn add_item(
        &mut self,
        item: &ItemSymbol<'_>,
        switches: &Switches,
    ) -> Option<(ThingKind, SpriteId)> {
        let kind = match item {
            &ItemSymbol::Treasure(worth) => ThingKind::Treasure(worth),
            &ItemSymbol::Healing(points) => ThingKind::Healing(points),
            &ItemSymbol::Supply(supply, count) => ThingKind::Supply(supply, count),
            ItemSymbol::Note(text) => ThingKind::Note(self.note(text)),
            ItemSymbol::Checkpoint => ThingKind::Checkpoint,
            ItemSymbol::Lever(switch) => ThingKind::Lever(switches.id(switch.name)?),
            &ItemSymbol::Spikes(rhythm) => ThingKind::Spikes(rhythm),
        };
        self.add_built_in(kind, item.sprite_name())
    }

    /// Adds a built-in sprite, once for each name; returns it with the kind of thing that has it.
    fn add_built_in(
        &mut self,
        kind: ThingKind,
        name: &'static str,
    ) -> Option<(ThingKind, SpriteId)> {
        if let Some(&(_, id)) = self.built_in.iter().find(|(known, _)| *known == name) {
            return Some((kind, id));
        }
        let (_, id) = self.add(kind, builtin::named(name))?;
        self.built_in.push((name, id));
        Some((kind, id))
    }

    fn note(&mut self, text: &str) -> NoteId {
        let id = NoteId(self.notes.len() as u16);
        self.notes.push(text.to_owned());
        id
    }
}

fn too_many_lamps(symbol: &Symbol<'_>) -> Fault {
    let most = lamp_budget::MOST_CELLS;
    let message = format!("the lamps of a map light {most} cells at most, counted for each lamp");
    Fault::new(symbol.place.clone(), message)
        .label("with these, they light more")
        .help("draw fewer lamps, or let them reach less far")
}

fn too_many_things(drawing: &Drawing<'_>, count: usize) -> Fault {
    let message = format!("the grid has {count} things, and {MOST_THINGS} at most can be there");
    Fault::new(drawing.key_place.clone(), message).help("draw fewer of them")
}

/// The frame that a thing shows first; `None` if it depends on the time.
fn first_frame(kind: ThingKind) -> Option<u8> {
    let shows_its_state =
        matches!(kind, ThingKind::Checkpoint | ThingKind::Lever(_) | ThingKind::Spikes(_));
    shows_its_state.then_some(0)
}

/// The fault of more than [`MOST_SPIKES`].
fn too_many_spikes(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Option<Fault> {
    let is_it =
        |symbol: &&Symbol<'_>| matches!(symbol.meaning, Meaning::Item(ItemSymbol::Spikes(_)));
    let spikes = legend.used_in(drawing).filter(|(_, symbol)| is_it(symbol));
    let spikes = spikes.map(|(character, symbol)| (symbol, drawing.sightings(character).count));
    let spikes: Vec<_> = spikes.collect();
    let count: usize = spikes.iter().map(|(_, count)| count).sum();
    let (symbol, most) = spikes.into_iter().max_by_key(|&(_, count)| count)?;
    (count > MOST_SPIKES).then(|| {
        let message =
            format!("the grid has {count} spikes, and {MOST_SPIKES} at most can be there");
        Fault::new(symbol.place.clone(), message)
            .label(format!("{most} of them here"))
            .help("draw fewer of them")
    })
}

//! Checks that a level can be played as drawn: first its characters, then its cells.

use std::collections::BTreeSet;
use std::ops::Range;

use super::drawing::Drawing;
use super::legend::{Meaning, Symbol, is_thing};
use super::plan::{Names, Plan};
use super::reach::KeySearch;
use super::values::Name;
use crate::fault::{Fault, nearest, quoted};
use crate::sort;
use crate::world::{
    Cell, Grid, GuardPost, MovingTile, Sprite, Start, Thing, ThingKind, Tile, TileId, TileKind,
};

/// The largest number of guards.
const MAX_GUARDS: usize = 256;
/// The largest number of levers.
const MAX_LEVERS: usize = 256;
/// The largest number of cells that switches move. One press may move all of them in a step.
const MAX_DRIVEN: usize = 512;
/// The largest number of spikes. All of them may come out in one step, and each makes a sound.
const MAX_SPIKES: usize = 512;
/// The least headroom where the player starts, and the least height of the map's ceiling.
pub(crate) const MIN_HEADROOM: f64 = 0.75;

/// The faults of the characters in `plan`: undefined characters, and faults of starts, supports,
/// patrols and switches.
pub(crate) fn faults_of_characters(plan: Plan<'_>) -> Vec<Fault> {
    let mut faults: Vec<Fault> = undefined_characters(plan).collect();
    faults.extend(wrong_start(plan));
    faults.extend(wrong_supports(plan));
    if plan.legend.is_clear() {
        let guards = plan.count(|symbol| matches!(symbol.meaning, Meaning::Guard(_)));
        let levers = plan.count(|symbol| matches!(symbol.meaning, Meaning::Lever(_)));
        for (counted, max, noun) in [(guards, MAX_GUARDS, "guards"), (levers, MAX_LEVERS, "levers")]
        {
            let place = plan.drawing.key_place.clone();
            faults.extend(counted.and_then(|(count, ..)| too_many(place, count, max, noun)));
        }
        faults.extend(wrong_patrols(plan));
        faults.extend(too_many_driven(plan));
        faults.extend(unconnected_switches(plan));
    }
    faults
}

/// The fault of more than `max` `things` that are drawn.
pub(crate) fn too_many(
    place: Range<usize>,
    count: usize,
    max: usize,
    things: &str,
) -> Option<Fault> {
    let message = format!("the grid has {count} {things}, but at most {max} are allowed");
    (count > max).then(|| Fault::new(place, message).help("draw fewer of them"))
}

/// The fault of more than [`MAX_SPIKES`] spikes.
pub(crate) fn too_many_spikes(plan: Plan<'_>) -> Option<Fault> {
    let is_spikes =
        |symbol: &Symbol<'_>| matches!(symbol.meaning, Meaning::Item(ThingKind::Spikes(_)));
    let (count, symbol, most) = plan.count(is_spikes)?;
    let fault = too_many(symbol.place.clone(), count, MAX_SPIKES, "spikes")?;
    Some(fault.label(format!("{most} of them here")))
}

/// The fault of more than [`MAX_DRIVEN`] cells that switches move.
fn too_many_driven(plan: Plan<'_>) -> Option<Fault> {
    let (count, symbol, most) = plan.count(|symbol| symbol.driver().is_some())?;
    let place = symbol.driver()?.place.clone();
    let message =
        format!("switches move {count} cells of the grid, but at most {MAX_DRIVEN} can move");
    (count > MAX_DRIVEN).then(|| {
        Fault::new(place, message)
            .label(format!("{most} of them here"))
            .help("replace some of them with plain floor or wall")
    })
}

fn undefined_characters(plan: Plan<'_>) -> impl Iterator<Item = Fault> {
    let is_undefined = move |character: &char| {
        plan.legend.is_complete && !plan.legend.symbols.contains_key(character)
    };
    plan.drawing.characters().filter(is_undefined).filter_map(move |character| {
        let place = plan.drawing.first_places(character).into_iter().next()?;
        let fault = if character.is_control() {
            let message = format!("the grid contains the control character {character:?}");
            Fault::new(place, message).help("draw open floor as '.' or a space")
        } else {
            let message = format!("the grid's character {character:?} is not defined");
            Fault::new(place, message).help(format!(
                "define it under [tiles], such as {:?} = {{ wall = \"brick\" }}, or under [things]",
                character.to_string()
            ))
        };
        Some(match plan.drawing.count(character) - 1 {
            0 => fault,
            others => fault.label(format!("and {others} more")),
        })
    })
}

/// The fault of a plan without a start, or with more than one.
fn wrong_start(plan: Plan<'_>) -> Option<Fault> {
    let Plan { drawing, legend } = plan;
    let is_start = |(_, symbol): &(&char, &Symbol<'_>)| matches!(symbol.meaning, Meaning::Start(_));
    let mut starts = legend.symbols.iter().filter(is_start).peekable();
    let defined = starts.peek().map(|&(&character, symbol)| (character, symbol.place.clone()));
    let mut drawn: Vec<Range<usize>> =
        starts.flat_map(|(&character, _)| drawing.first_places(character)).collect();
    sort::by_key(&mut drawn, |place| place.start);
    match (&drawn[..], defined) {
        ([_], _) => None,
        ([_, second, ..], _) => Some(
            Fault::new(second.clone(), "the player starts in more than one place")
                .label("this is the second")
                .help("leave one start, and draw the others as '.'"),
        ),
        ([], Some((character, place))) => {
            let message = format!("the start {character:?} is not drawn in the grid");
            let help = format!("draw one {character:?} where the player starts");
            Some(Fault::new(place, message).help(help))
        }
        // An earlier fault may be the reason.
        ([], None) => legend.is_clear().then(|| {
            Fault::new(drawing.key_place.clone(), "the grid has no start")
                .help("under [things] write \"@\" = { start = 0 }, and draw one @ in the grid")
        }),
    }
}

/// The faults of things that stand on anything but open floor.
fn wrong_supports(plan: Plan<'_>) -> impl Iterator<Item = Fault> {
    plan.symbols().filter_map(move |(_, symbol)| {
        let (tile, place) = symbol.support.as_ref()?;
        let is_fine = match plan.symbol(*tile) {
            Some(tile) => {
                matches!(tile.meaning, Meaning::Open | Meaning::Floor | Meaning::Unclear)
            }
            None => !plan.legend.is_complete,
        };
        let message = format!("a thing stands on open floor, but {tile:?} is not open floor");
        let help = "write the character of a tile that has no wall, door, mask or glass";
        (!is_fine).then(|| Fault::new(place.clone(), message).help(help))
    })
}

/// The faults of patrols with a missing waypoint, and of waypoints without a patrol or drawn twice. A
/// thing that a patrol names is a waypoint, too.
fn wrong_patrols(plan: Plan<'_>) -> Vec<Fault> {
    let is_waypoint = |it| plan.means(it, |meaning| matches!(meaning, Meaning::Waypoint));
    let is_such_a_thing = |it| plan.means(it, is_thing);
    let mut faults = Vec::new();
    let mut walked = BTreeSet::new();
    for (_, symbol) in plan.symbols() {
        let Meaning::Guard(guard) = &symbol.meaning else { continue };
        let Some(patrol) = &guard.patrol else { continue };
        let missing = patrol.text.chars().find(|&it| !is_such_a_thing(it));
        let undrawn = patrol.text.chars().find(|&it| plan.drawing.count(it) == 0);
        walked.extend(patrol.text.chars());
        let fault = |message| Fault::new(patrol.place.clone(), message);
        if let Some(missing) = missing {
            let name = missing.to_string();
            faults.push(
                fault(format!("the patrol names {missing:?}, which is not a waypoint")).help(
                    format!(
                        "under [things] write {name:?} = {{ waypoint = true }}, and draw it once"
                    ),
                ),
            );
        } else if let Some(undrawn) = undrawn {
            let message = format!("the waypoint {undrawn:?} of the patrol is not drawn");
            faults.push(fault(message).help(format!("draw one {undrawn:?} in the grid")));
        }
    }
    let is_walked_to = |it| walked.contains(&it) && is_such_a_thing(it);
    for character in plan.drawing.characters().filter(|&it| is_waypoint(it) || is_walked_to(it)) {
        let places = plan.drawing.first_places(character);
        faults.extend(match &places[..] {
            [first, ..] if !walked.contains(&character) => {
                let message = format!("no guard walks to the waypoint {character:?}");
                let help = format!("name it in a guard's patrol, such as patrol = \"{character}\"");
                Some(Fault::new(first.clone(), message).help(help))
            }
            [_, second] => {
                let message = format!("the waypoint {character:?} is drawn more than once");
                let fault = Fault::new(second.clone(), message).label("this is the second");
                Some(fault.help("draw each waypoint once, and give each its own character"))
            }
            _ => None,
        });
    }
    faults
}

/// The faults of switches that nothing sets, and of levers and plates that drive nothing.
fn unconnected_switches(plan: Plan<'_>) -> impl Iterator<Item = Fault> {
    let (driven, setting) = (Names::of(plan.driven()), Names::of(plan.setting()));
    let idle: Vec<_> = plan.setting().filter(|it| !driven.contains(it.text)).collect();
    let stuck: Vec<_> = plan.driven().filter(|it| !setting.contains(it.text)).collect();
    let idle = idle.into_iter().enumerate().map(move |(index, switch)| {
        let name = quoted(switch.text);
        let message = format!("the switch {name} moves nothing in the grid");
        let example = format!(
            "draw a door, a wall or a floor that moves with it, such as \
             {{ door = \"metal\", switch = {name} }}"
        );
        Fault::new(switch.place.clone(), message)
            .label("this does nothing")
            .help(nearest_switch(switch, &driven, index).unwrap_or(example))
    });
    let stuck = stuck.into_iter().enumerate().map(move |(index, switch)| {
        let name = quoted(switch.text);
        let message = format!("nothing in the grid sets the switch {name}");
        let example = format!("under [things] write \"l\" = {{ lever = {name} }}, and draw one l");
        Fault::new(switch.place.clone(), message)
            .label("this never moves")
            .help(nearest_switch(switch, &setting, index).unwrap_or(example))
    });
    idle.chain(stuck)
}

/// A help text for fault number `index`: the name in `known` that is most similar to `switch`.
/// `None` if no name is similar, or if there are too many names or faults to compare quickly.
fn nearest_switch(switch: &Name<'_>, known: &Names<'_>, index: usize) -> Option<String> {
    const MAX_COMPARED: usize = 32;
    const MAX_FAULTS: usize = 100;
    let Names(known) = known;
    if known.len() > MAX_COMPARED || index >= MAX_FAULTS {
        return None;
    }
    nearest(switch.text, known).map(|near| format!("the nearest switch is {}", quoted(near)))
}

/// The cells of a level, with their tiles and things.
#[derive(Clone, Copy)]
pub(crate) struct Cells<'l> {
    pub(crate) grid: &'l Grid,
    pub(crate) tiles: &'l [Tile],
    pub(crate) moving: &'l [MovingTile],
    pub(crate) sprites: &'l [Sprite],
    pub(crate) things: &'l [Thing],
}

impl<'l> Cells<'l> {
    /// The tile at a column and a row; `None` outside the map.
    fn tile(self, column: i64, row: i64) -> Option<(TileId, &'l Tile)> {
        let id = self.grid.tile(column, row)?;
        Some((id, &self.tiles[usize::from(id.0)]))
    }

    /// The tile of a cell; `None` outside the map.
    fn at(self, cell: Cell) -> Option<&'l Tile> {
        Some(&self.tiles[usize::from(self.grid.tile_in(cell)?.0)])
    }

    /// The tiles to the west and east, and to the north and south of `cell`.
    fn beside(self, cell: Cell) -> [[Option<(TileId, &'l Tile)>; 2]; 2] {
        let (column, row) = (i64::from(cell.column), i64::from(cell.row));
        let pairs =
            [[(column - 1, row), (column + 1, row)], [(column, row - 1), (column, row + 1)]];
        pairs.map(|pair| pair.map(|(column, row)| self.tile(column, row)))
    }

    /// Returns whether `id` is the first state of a moving tile.
    fn moves(self, id: TileId) -> bool {
        self.moving.iter().any(|moving| moving.states[0] == id)
    }
}

/// The faults of the cells in `plan`, and of the guards' `posts`.
pub(crate) fn faults_of_cells(
    plan: Plan<'_>,
    cells: Cells<'_>,
    start: Start,
    posts: &[GuardPost],
) -> Vec<Fault> {
    let mut faults = cramped_guards(plan.drawing, cells, posts);
    faults.extend(low_start(plan.drawing, cells, start));
    faults.extend(blind_secrets(plan, cells));
    let misplaced = misplaced_doors(plan, cells);
    // Behind a misplaced door, reachability means nothing.
    if misplaced.is_empty() {
        faults.extend(keys_out_of_reach(plan, cells, start));
    }
    faults.extend(misplaced);
    faults.extend(useless_keys(plan));
    faults
}

/// The fault of a start where the player has no room to stand.
fn low_start(drawing: &Drawing<'_>, cells: Cells<'_>, start: Start) -> Option<Fault> {
    let room = cells.at(start.cell)?.gaps().next()?.height();
    (room < MIN_HEADROOM).then(|| {
        let message = "the player has no room to stand where they start";
        Fault::new(drawing.place_of(start.cell), message)
            .label(format!("the ceiling is {room} above the floor here"))
            .help(format!("start the player where it is {MIN_HEADROOM} or more"))
    })
}

/// The fault of a map that requires more treasure than lies in it. `place` is the place of the
/// requirement.
pub(crate) fn missing_treasure(
    needed: u32,
    place: &Range<usize>,
    things: &[Thing],
) -> Option<Fault> {
    let worth = things.iter().map(|thing| match thing.kind {
        ThingKind::Treasure(worth) => u64::from(worth),
        _ => 0,
    });
    let total: u64 = worth.sum();
    (total < u64::from(needed)).then(|| {
        Fault::new(place.clone(), "the exit asks for more treasure than the map has")
            .label(format!("treasure worth {total} is drawn"))
            .help("draw more, such as { treasure = 50 }, or ask for less")
    })
}

/// The faults of guards under a ceiling that is too low.
fn cramped_guards(drawing: &Drawing<'_>, cells: Cells<'_>, posts: &[GuardPost]) -> Vec<Fault> {
    let cramped = posts.iter().filter_map(|post| {
        let room = cells.at(post.cell)?.gaps().next()?.height();
        let (name, height) = (post.kind.name(), post.kind.height());
        (room < height).then(|| {
            let message = format!("the {name} has no room to stand here");
            Fault::new(drawing.place_of(post.cell), message)
                .label(format!("the ceiling is {room} above the floor here"))
                .help(format!("a {name} is {height} high: raise the ceiling, or draw it elsewhere"))
        })
    });
    cramped.collect()
}

/// The faults of secret walls that lead nowhere, one for each character.
fn blind_secrets(plan: Plan<'_>, cells: Cells<'_>) -> Vec<Fault> {
    let is_secret = |meaning: &Meaning<'_>| matches!(meaning, Meaning::Wall(it) if it.is_secret);
    let blind = plan.drawing.first_of_each(
        |character| plan.means(character, is_secret),
        |cell| ways_into(cells, cell) < 2,
    );
    let faults = blind.into_iter().map(|(first, others)| {
        let message = "there is nothing behind this secret wall";
        let fault = Fault::new(plan.drawing.place_of(first), message)
            .help("draw open floor on two of its sides, one to come from and one to find");
        match others {
            0 => fault,
            others => fault.label(format!("and behind {others} more")),
        }
    });
    faults.collect()
}

/// The number of sides from which a player may enter the cell of a secret wall once it has sunk.
fn ways_into(cells: Cells<'_>, cell: Cell) -> usize {
    let top = cells.at(cell).map_or(0.0, |tile| tile.heights.floor());
    let is_way = |&(id, tile): &(TileId, &Tile)| match tile.kind {
        TileKind::Wall(_) | TileKind::Mirror(_) => cells.moves(id) || tile.heights.floor() < top,
        TileKind::Mask(_) | TileKind::Glass(_) => false,
        _ => true,
    };
    cells.beside(cell).into_iter().flatten().flatten().filter(is_way).count()
}

/// The faults of doors that cannot slide or that lead nowhere, one for each character. A door
/// slides into a wall, so it stands between two walls, with open floor before and behind it.
fn misplaced_doors(plan: Plan<'_>, cells: Cells<'_>) -> Vec<Fault> {
    let is_door = |meaning: &Meaning<'_>| matches!(meaning, Meaning::Door(_));
    let misplaced = plan.drawing.first_of_each(
        |character| plan.means(character, is_door),
        |cell| !is_between_jambs(cells, cell),
    );
    let faults = misplaced.into_iter().map(|(first, others)| {
        let message = "a door stands between two walls, with open floor before and behind it";
        let fault = Fault::new(plan.drawing.place_of(first), message)
            .help("draw it in a gap in a wall, such as \"#+#\", or use { wall = … }");
        match others {
            0 => fault.label("this one does not"),
            others => fault.label(format!("this one does not, and {others} more")),
        }
    });
    faults.collect()
}

/// Returns whether one pair of opposite neighbours of `cell` can hold a door, and the other pair is
/// open floor.
fn is_between_jambs(cells: Cells<'_>, cell: Cell) -> bool {
    use TileKind::{Glass, Mask, Mirror, Open, Wall};

    // A wall that sinks would leave the door without its jamb.
    let holds = |&(id, tile): &(TileId, &Tile)| {
        matches!(tile.kind, Wall(_) | Mask(_) | Glass(_) | Mirror(_)) && !cells.moves(id)
    };
    let is_open = |(_, tile): &(TileId, &Tile)| matches!(tile.kind, Open);
    let [one, other] = cells.beside(cell);
    let all_hold = |pair: [Option<_>; 2]| pair.iter().all(|it| it.as_ref().is_some_and(holds));
    let all_open = |pair: [Option<_>; 2]| pair.iter().all(|it| it.as_ref().is_some_and(is_open));
    all_hold(one) && all_open(other) || all_open(one) && all_hold(other)
}

/// The faults of keys that no door in the grid needs.
fn useless_keys(plan: Plan<'_>) -> impl Iterator<Item = Fault> {
    let asked = Names::of(plan.locks());
    plan.keys().filter(move |key| !asked.contains(key.text)).map(|key| {
        let name = quoted(key.text);
        let help = format!("draw a door {{ door = \"oak\", key = {name} }}, or leave the key out");
        let message = format!("no door in the grid asks for the key {name}");
        Fault::new(key.place.clone(), message).help(help)
    })
}

/// The faults of doors whose key the player cannot reach without opening them.
fn keys_out_of_reach(plan: Plan<'_>, cells: Cells<'_>, start: Start) -> Vec<Fault> {
    if plan.locks().next().is_none() {
        return Vec::new();
    }
    let found = KeySearch::of(plan, cells.grid, low_things(cells)).keys_from(start.cell);
    let drawn = Names::of(plan.keys());
    let missing = plan.locks().filter(|lock| !found.contains(lock.text)).map(|lock| {
        let name = quoted(lock.text);
        let (message, help) = if drawn.contains(lock.text) {
            (
                format!("the key {name} cannot be reached from the start"),
                "put the key where the player can get it without opening the doors that need it"
                    .to_owned(),
            )
        } else {
            (
                format!("there is no key {name} in the grid"),
                format!("under [things] write \"k\" = {{ key = {name} }}, and draw one k"),
            )
        };
        Fault::new(lock.place.clone(), message).label("nobody can open this door").help(help)
    });
    missing.collect()
}

/// The cells of things that block, but leave room above them to jump over.
fn low_things(cells: Cells<'_>) -> impl Iterator<Item = Cell> {
    /// The height of a player who ducks, in cells.
    const DUCKING: f64 = 0.5;
    let is_low = move |thing: &&Thing| {
        let sprite = &cells.sprites[usize::from(thing.sprite.0)];
        let has_room = |tile: &Tile| {
            let top = sprite.base(tile.heights) + sprite.height.cells();
            tile.gaps().any(|gap| gap.holds(top) && gap.top - top >= DUCKING)
        };
        sprite.blocks && cells.at(thing.cell).is_some_and(has_room)
    };
    cells.things.iter().filter(is_low).map(|thing| thing.cell)
}

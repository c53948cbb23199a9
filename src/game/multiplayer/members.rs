//! The players of a game for several, by slot, and whose turn it is.

use serde::{Deserialize, Serialize};

use super::seen::Track;
use super::{MOST_PLAYERS, MultiplayerRules};
use crate::game::guards::Target;
use crate::game::player::Player;
use crate::game::scratch::Scratch;
use crate::game::stored::{OfLevel, Unrestorable, at_most, check};
use crate::game::{Game, Intents};
use crate::world::sprite::builtin::PlayerColor;
use crate::world::{Cell, Figure, SpriteId, Thing, World};

/// The players of a game for several.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Members {
    #[serde(skip)]
    pub(crate) rules: MultiplayerRules,
    /// The last slot is taken, if there is any.
    #[serde(deserialize_with = "at_most::<MOST_PLAYERS, _, _>")]
    pub(crate) slots: Vec<Option<Member>>,
    /// The slot of the player whose turn it is; that player is [`Game::player`] meanwhile.
    #[serde(skip)]
    pub(crate) turn: Option<usize>,
    /// The worth of the treasure of those who have left.
    pub(crate) treasure_of_the_gone: u32,
    /// Where the keys lay at the start.
    #[serde(skip)]
    pub(crate) keys: Vec<Thing>,
    /// By colour.
    #[serde(skip)]
    pub(crate) sprites: [Option<SpriteId>; PlayerColor::ALL.len()],
    /// The blows of the last step: who has struck whom.
    pub(crate) blows: Vec<(usize, usize)>,
    /// The memory for what guards perceive, for the positions of those in the way, and for figures.
    #[serde(skip)]
    pub(crate) targets: Scratch<Vec<Target>>,
    #[serde(skip)]
    pub(crate) in_the_way: Scratch<Vec<glam::DVec2>>,
    #[serde(deserialize_with = "at_most::<MOST_PLAYERS, _, _>")]
    pub(crate) figures: Vec<Figure>,
}

/// A player, and what concerns them among others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Member {
    pub(crate) player: Player,
    pub(crate) color: PlayerColor,
    /// Whether the player is alive and has not reached the exit; it changes between steps.
    pub(crate) is_playing: bool,
    pub(crate) has_won: bool,
    /// What the player wants in this step, and the step that they saw.
    pub(crate) intents: Intents,
    pub(crate) seen: u64,
    /// The step in which they joined, and the one in which they died or reached the exit.
    pub(crate) joined: u64,
    pub(crate) ended: Option<u64>,
    /// The last checkpoint; `None` for the start.
    pub(crate) checkpoint: Option<Cell>,
    /// The steps for which they lie on the floor, and until they can be struck again.
    pub(crate) stunned: u16,
    pub(crate) spared: u16,
    /// The steps for which the figure strikes, and how far it has walked, in cells.
    pub(crate) swing: u16,
    pub(crate) walked: f64,
    pub(crate) track: Track,
}

impl Member {
    /// Whether the player lies on the floor.
    pub(crate) fn is_down(&self) -> bool {
        self.stunned > 0 || self.player.killed_by.is_some()
    }
}

impl Members {
    /// The member in a slot.
    pub(crate) fn member(&self, index: usize) -> Option<&Member> {
        self.slots.get(index)?.as_ref()
    }

    pub(crate) fn member_mut(&mut self, index: usize) -> Option<&mut Member> {
        self.slots.get_mut(index)?.as_mut()
    }

    /// The members with the indices of their slots.
    pub(crate) fn each(&self) -> impl Iterator<Item = (usize, &Member)> + Clone {
        let slots = self.slots.iter().enumerate();
        slots.filter_map(|(index, slot)| Some((index, slot.as_ref()?)))
    }

    pub(crate) fn each_mut(&mut self) -> impl Iterator<Item = (usize, &mut Member)> {
        let slots = self.slots.iter_mut().enumerate();
        slots.filter_map(|(index, slot)| Some((index, slot.as_mut()?)))
    }

    /// The last checkpoint of the player whose turn it is.
    pub(crate) fn checkpoint(&self) -> Option<Cell> {
        self.member(self.turn?)?.checkpoint
    }

    pub(crate) fn set_checkpoint(&mut self, cell: Cell) {
        let turn = self.turn;
        if let Some(member) = turn.and_then(|turn| self.member_mut(turn)) {
            member.checkpoint = Some(cell);
        }
    }

    /// Whether anybody goes on from the checkpoint in `cell`.
    pub(crate) fn has_checkpoint(&self, cell: Cell) -> bool {
        self.each().any(|(_, member)| member.checkpoint == Some(cell))
    }

    /// Refuses a state in which a step after the step `now` could fail.
    pub(crate) fn check(&self, world: &World, now: u64) -> Result<(), Unrestorable> {
        check(self.slots.last().is_none_or(Option::is_some), "a player")?;
        self.each().try_for_each(|(_, member)| {
            check(member.walked >= 0.0, "how far a player has walked")?;
            member.player.check(world, now)
        })
    }

    /// The first free slot.
    pub(crate) fn free_slot(&self) -> Option<usize> {
        let free = self.slots.iter().position(Option::is_none);
        free.or(Some(self.slots.len())).filter(|&index| index < MOST_PLAYERS)
    }
}

impl OfLevel for Members {
    fn of_level(self, start: Self) -> Result<Self, Unrestorable> {
        let Self { rules, keys, sprites, .. } = start;
        Ok(Self { rules, keys, sprites, ..self })
    }
}

impl Game {
    /// The index of the player whose turn it is.
    pub(crate) fn turn(&self) -> usize {
        self.members.as_ref().and_then(|members| members.turn).unwrap_or_default()
    }

    /// Lets the player in a slot have their turn while `act` runs; does nothing if nobody is there.
    pub(crate) fn in_turn<T>(
        &mut self,
        index: usize,
        act: impl FnOnce(&mut Self) -> T,
    ) -> Option<T> {
        if self.members.is_none() {
            return Some(act(self));
        }
        let before = self.members.as_ref()?.turn;
        if !self.swap_turn(index) {
            return None;
        }
        let done = act(self);
        self.swap_turn(index);
        if let Some(members) = &mut self.members {
            members.turn = before;
        }
        Some(done)
    }

    /// Lets each player who plays have their turn while `act` runs.
    pub(crate) fn for_each_player(&mut self, act: impl Fn(&mut Self)) {
        let count = self.members.as_ref().map_or(1, |members| members.slots.len());
        for index in 0..count {
            let is_playing = |it: &Members| it.member(index).is_some_and(|it| it.is_playing);
            if self.members.as_deref().is_none_or(is_playing) {
                self.in_turn(index, &act);
            }
        }
    }

    /// Exchanges the player who has the turn with the one in a slot. Returns whether there is one.
    fn swap_turn(&mut self, index: usize) -> bool {
        let Self { members, player, .. } = self;
        let Some(members) = members.as_deref_mut() else { return false };
        let Some(member) = members.member_mut(index) else { return false };
        std::mem::swap(&mut member.player, player);
        members.turn = Some(index);
        true
    }

    /// The players who are alive and have not reached the exit, with their indices, as they were
    /// when the step began.
    pub(crate) fn playing(&self) -> impl Iterator<Item = (usize, &Player)> {
        playing(&self.player, self.members.as_deref())
    }

    /// Whether nobody is alive in a game for several, or has yet to reach the exit: time does not
    /// pass in it.
    pub fn is_deserted(&self) -> bool {
        let stands =
            |(_, member): (usize, &Member)| !member.has_won && member.player.killed_by.is_none();
        self.members.as_ref().is_some_and(|members| !members.each().any(stands))
    }

    /// The member whose turn it is.
    pub(crate) fn member_in_turn(&mut self) -> Option<&mut Member> {
        let members = self.members.as_deref_mut()?;
        let turn = members.turn?;
        members.member_mut(turn)
    }
}

/// [`Game::playing`], of the parts of a game.
pub(crate) fn playing<'a>(
    player: &'a Player,
    members: Option<&'a Members>,
) -> impl Iterator<Item = (usize, &'a Player)> + Clone {
    let turn = members.and_then(|members| members.turn);
    let alone = members.is_none().then_some((0, player));
    let several = members.into_iter().flat_map(Members::each);
    let several = several.filter(|(_, member)| member.is_playing).map(move |(index, member)| {
        (index, if turn == Some(index) { player } else { &member.player })
    });
    alone.into_iter().chain(several)
}

/// The same, between turns, for what moves them.
pub(crate) fn playing_mut<'a>(
    player: &'a mut Player,
    members: Option<&'a mut Members>,
) -> impl Iterator<Item = (usize, &'a mut Player)> {
    let alone = members.is_none().then_some((0, player));
    let several = members.into_iter().flat_map(Members::each_mut);
    let several = several.filter(|(_, member)| member.is_playing);
    alone.into_iter().chain(several.map(|(index, member)| (index, &mut member.player)))
}

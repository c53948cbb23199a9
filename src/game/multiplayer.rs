//! Multiplayer games: their players, and the rules between players.
//!
//! A player occupies a slot for as long as they are in the game. A step moves the players in the
//! order of their slots, and then everything else once, exactly as in a step of a single-player
//! game. Therefore a multiplayer game with one player equals the single-player game, bit for bit,
//! until that player dies.
//!
//! - Time passes while any player is alive and has not reached the exit.
//! - A dead player continues alone from their own last checkpoint, and the level stays as it is.
//!   Rejected: restoring the level, as a single-player game does. It would undo the actions of the
//!   other players.
//! - Treasure counts for all players. A key belongs to the player who found it. When a player
//!   leaves, reaches the exit or is dead for good, their keys return to the cells where they were
//!   found.
//! - A player's action against others is judged by the positions in the step that the player saw,
//!   at most [`MAX_LAG`](super::MAX_LAG) steps ago. Rejected: judging by the present positions.
//!   Players would have to aim ahead by the delay of their connection.
//! - Bodies that collide are columns without an upper end, so nobody can jump onto a head.

mod entry;
mod strike;
pub(crate) mod view;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::checkpoint::Checkpoint;
use super::guards::PerceivedPlayer;
use super::player::{Motion, Player, Supplies};
use super::rules::{Input, MAX_PLAYERS, MultiplayerRules, PlayerId, Rules};
use super::scratch::Scratch;
use super::stored::{OfLevel, RestoreError, at_most, check};
use super::{Game, Intent, Intents};
use crate::world::sprite::builtin::{self, PlayerColor, PlayerFrame};
use crate::world::{Cell, Figure, SpriteId, Thing, ThingKind, World};
use strike::Track;

/// The distance after which a figure changes its foot, in cells.
const STRIDE: f64 = 0.45;

/// The target for a slot without a player.
const NOBODY: PerceivedPlayer = PerceivedPlayer {
    position: DVec2::ZERO,
    feet: 0.0,
    head: 0.0,
    visibility: 0,
    has_light: false,
    is_noticeable: false,
};

/// The players of a multiplayer game.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Members {
    #[serde(skip)]
    rules: MultiplayerRules,
    /// The last slot, if any, is occupied.
    #[serde(deserialize_with = "at_most::<MAX_PLAYERS, _, _>")]
    slots: Vec<Option<Member>>,
    /// The slot of the current player, whose turn it is. During the turn, that player is in
    /// [`Game::player`].
    #[serde(skip)]
    turn: Option<usize>,
    /// The value of the treasure found by players who have left.
    treasure_of_the_gone: u32,
    /// The keys at their initial positions.
    #[serde(skip)]
    keys: Vec<Thing>,
    /// Indexed by colour.
    #[serde(skip)]
    sprites: [Option<SpriteId>; PlayerColor::ALL.len()],
    #[serde(skip)]
    marked: Option<SpriteId>,
    /// The blows of the last step, each as the slots of the attacker and the victim.
    blows: Vec<(usize, usize)>,
    /// Reused memory for targets.
    #[serde(skip)]
    pub(crate) targets: Scratch<Vec<PerceivedPlayer>>,
    /// The positions of the players who are in the way of the current player, in reused memory.
    #[serde(skip)]
    pub(crate) in_the_way: Scratch<Vec<DVec2>>,
    #[serde(deserialize_with = "at_most::<MAX_PLAYERS, _, _>")]
    figures: Vec<Figure>,
}

/// A player and their multiplayer state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Member {
    player: Player,
    color: PlayerColor,
    /// Whether the player is alive and has not reached the exit. Changes only between steps.
    is_playing: bool,
    has_won: bool,
    /// The player's intents in this step, and the step that the player saw.
    intents: Intents,
    seen: u64,
    /// The step in which the player joined, and the step in which they died or reached the exit.
    joined: u64,
    ended: Option<u64>,
    /// The last checkpoint; `None` for the start.
    checkpoint: Option<Cell>,
    /// The number of steps until the player stands up, and until they can be struck again.
    stunned: u16,
    spared: u16,
    /// The remaining steps for which the figure strikes, and the distance it has walked, in cells.
    swing: u16,
    walked: f64,
    track: Track,
}

impl Member {
    /// Whether the player lies on the floor.
    pub(crate) fn is_down(&self) -> bool {
        self.stunned > 0 || self.player.killed_by.is_some()
    }

    fn figure(&self, world: &World, sprite: SpriteId) -> Figure {
        let motion = &self.player.motion;
        // Floors that have moved since the death do not carry the dead.
        let base = if self.is_playing { motion.feet() } else { world.floor_at(motion.cell()) };
        let (position, heading) = (motion.position(), motion.heading());
        Figure { sprite, position, base, heading, frame: self.frame().index(), opacity: u8::MAX }
    }

    fn frame(&self) -> PlayerFrame {
        let motion = &self.player.motion;
        match self.swing {
            _ if self.is_down() => PlayerFrame::Down,
            0 => walking_frame(motion, self.walked),
            _ => PlayerFrame::Strike,
        }
    }
}

impl Members {
    /// The member in a slot.
    fn member(&self, index: usize) -> Option<&Member> {
        self.slots.get(index)?.as_ref()
    }

    fn member_mut(&mut self, index: usize) -> Option<&mut Member> {
        self.slots.get_mut(index)?.as_mut()
    }

    /// The members with the indices of their slots.
    fn each(&self) -> impl Iterator<Item = (usize, &Member)> + Clone {
        let slots = self.slots.iter().enumerate();
        slots.filter_map(|(index, slot)| Some((index, slot.as_ref()?)))
    }

    fn each_mut(&mut self) -> impl Iterator<Item = (usize, &mut Member)> {
        let slots = self.slots.iter_mut().enumerate();
        slots.filter_map(|(index, slot)| Some((index, slot.as_mut()?)))
    }

    /// The last checkpoint of the current player.
    pub(crate) fn checkpoint(&self) -> Option<Cell> {
        self.member(self.turn?)?.checkpoint
    }

    pub(crate) fn set_checkpoint(&mut self, cell: Cell) {
        let turn = self.turn;
        if let Some(member) = turn.and_then(|turn| self.member_mut(turn)) {
            member.checkpoint = Some(cell);
        }
    }

    /// Whether any player's last checkpoint is in `cell`.
    pub(crate) fn has_checkpoint(&self, cell: Cell) -> bool {
        self.each().any(|(_, member)| member.checkpoint == Some(cell))
    }

    /// Returns an error if a step after the step `now` could fail in this state.
    pub(crate) fn check(&self, world: &World, now: u64) -> Result<(), RestoreError> {
        check(self.slots.last().is_none_or(Option::is_some), "a player")?;
        self.each().try_for_each(|(_, member)| {
            check(member.walked >= 0.0, "how far a player has walked")?;
            member.player.check(world, now)
        })
    }

    /// The first free slot.
    fn free_slot(&self) -> Option<usize> {
        let free = self.slots.iter().position(Option::is_none);
        free.or(Some(self.slots.len())).filter(|&index| index < MAX_PLAYERS)
    }

    /// Updates the figures of the players. Returns whether they have changed.
    pub(crate) fn pose(&mut self, world: &World) -> bool {
        let mut figures = std::mem::take(&mut self.figures);
        let mut count = 0;
        let mut has_changed = false;
        let shown = self.each().filter(|(_, member)| !member.has_won);
        for (_, member) in shown {
            let Some(sprite) = self.sprites[member.color as usize] else { continue };
            let figure = member.figure(world, sprite);
            if let Some(before) = figures.get_mut(count) {
                has_changed |= *before != figure;
                *before = figure;
            } else {
                has_changed = true;
                figures.push(figure);
            }
            count += 1;
        }
        has_changed |= count < figures.len();
        figures.truncate(count);
        self.figures = figures;
        has_changed
    }

    /// The figures of the players.
    pub(crate) fn figures(&self) -> &[Figure] {
        &self.figures
    }
}

impl OfLevel for Members {
    fn of_level(self, start: Self) -> Result<Self, RestoreError> {
        let Self { rules, keys, sprites, marked, .. } = start;
        Ok(Self { rules, keys, sprites, marked, ..self })
    }
}

impl Game {
    /// A multiplayer game at its start, without players.
    pub fn for_players(world: World, rules: Rules, multiplayer: MultiplayerRules) -> Self {
        let is_key = |kind| matches!(kind, ThingKind::Key(_));
        let keys = world.things().iter().filter(|thing| is_key(thing.kind)).copied().collect();
        // The sprites of guards come first, as in a single-player game.
        let mut game = Self::with_rules(world, rules);
        let sprites = PlayerColor::ALL
            .map(|color| builtin::player(color).map(|sprite| game.world.add_sprite(sprite)));
        let marked = builtin::marked_player().map(|sprite| game.world.add_sprite(sprite));
        game.checkpoint = Checkpoint::default();
        game.members = Some(Box::new(Members {
            rules: multiplayer,
            slots: Vec::new(),
            turn: None,
            treasure_of_the_gone: 0,
            keys,
            sprites,
            marked,
            blows: Vec::new(),
            targets: Scratch::default(),
            in_the_way: Scratch::default(),
            figures: Vec::new(),
        }));
        game
    }

    /// The rules between players; `None` in a single-player game.
    pub fn multiplayer_rules(&self) -> Option<MultiplayerRules> {
        self.members.as_ref().map(|members| members.rules)
    }

    /// Adds a player at the start or the nearest free position. Returns `None` if no slot or
    /// position is free, or in a single-player game.
    pub fn join(&mut self, color: PlayerColor) -> Option<PlayerId> {
        let index = self.members.as_ref()?.free_slot()?;
        let motion = self.free_place(self.world.start().cell)?;
        let supplies = if self.is_mission { Supplies::AT_START } else { Supplies::default() };
        let member = Member {
            player: Player::new(&self.world, supplies).at(motion),
            color,
            is_playing: true,
            has_won: false,
            intents: Intents::new(),
            seen: self.steps,
            joined: self.steps,
            ended: None,
            checkpoint: None,
            stunned: 0,
            spared: 0,
            swing: 0,
            walked: 0.0,
            track: Track::default(),
        };
        let members = self.members.as_deref_mut()?;
        if index == members.slots.len() {
            members.slots.push(None);
        }
        members.slots[index] = Some(member);
        self.settle(index);
        self.show();
        PlayerId::new(index)
    }

    /// Removes a player. Their keys return to where they were found, and their treasure still
    /// counts.
    pub fn leave(&mut self, player: PlayerId) {
        let index = player.index();
        self.put_keys_back(index);
        let Some(members) = self.members.as_deref_mut() else { return };
        let Some(member) = members.slots.get_mut(index).and_then(Option::take) else { return };
        members.treasure_of_the_gone =
            members.treasure_of_the_gone.saturating_add(member.player.treasure);
        while members.slots.last().is_some_and(Option::is_none) {
            members.slots.pop();
        }
        self.grey_checkpoint(member.checkpoint);
        self.guards.forget_player(index);
        self.show();
    }

    /// Advances the game by one step of [`STEP`](crate::game::STEP) seconds. Each player has the
    /// intents of their input. A player without an input has no intents. If a player has several
    /// inputs, the last one counts. A single-player game takes the input of the [first
    /// slot](PlayerId::FIRST).
    pub fn step_all(&mut self, inputs: &[Input]) {
        if self.members.is_none() {
            let own = inputs.iter().rfind(|input| input.player == PlayerId::FIRST);
            return self.step(own.map_or_else(Intents::new, |input| input.intents));
        }
        *self.work = 0;
        self.take_inputs(inputs);
        self.revive();
        if self.playing().next().is_none() {
            return;
        }
        self.each_turn(Self::move_one);
        self.thin_smoke();
        self.move_doors();
        self.each_turn(|game, intents| {
            game.act(intents);
            intents
        });
        self.move_others();
        self.each_turn(|game, intents| {
            game.hear();
            game.reach_checkpoint();
            intents
        });
        self.sounds.clear();
        self.pass_time_of_members();
        self.steps = self.steps.saturating_add(1);
        self.settle_all();
        self.show();
    }

    /// Gives each active player their turn, with their intents, which `act` may change.
    fn each_turn(&mut self, act: impl Fn(&mut Self, Intents) -> Intents) {
        for index in 0..self.slot_count() {
            let member = self.members.as_ref().and_then(|members| members.member(index));
            let Some(member) = member.filter(|member| member.is_playing) else { continue };
            let intents = member.intents;
            self.in_turn(index, |game| {
                let intents = act(game, intents);
                if let Some(member) = game.member_in_turn() {
                    member.intents = intents;
                }
            });
        }
    }

    fn slot_count(&self) -> usize {
        self.members.as_ref().map_or(0, |members| members.slots.len())
    }

    fn take_inputs(&mut self, inputs: &[Input]) {
        let now = self.steps;
        let Some(members) = self.members.as_deref_mut() else { return };
        members.blows.clear();
        for (index, member) in members.each_mut() {
            let input = inputs.iter().rfind(|input| input.player.index() == index);
            member.intents = input.map_or_else(Intents::new, |input| input.intents);
            member.seen = input.map_or(now, |input| input.seen.min(now));
            if member.stunned > 0 {
                member.intents = Intents::new().with_look(member.intents.look());
            }
        }
    }

    /// Revives the dead players who want to retry, and determines who plays in this step.
    fn revive(&mut self) {
        let respawns = self.multiplayer_rules().is_some_and(|rules| rules.respawns);
        for index in 0..self.slot_count() {
            let member = self.members.as_ref().and_then(|members| members.member(index));
            let Some(member) = member else { continue };
            let (is_dead, intents) = (member.player.killed_by.is_some(), member.intents);
            let is_playing = !is_dead && !member.has_won;
            if is_dead {
                self.in_turn(index, |game| {
                    let presses = game.presses(intents);
                    let retries = game.player.fresh(presses).contains(Intent::Retry);
                    game.player.pressed = presses;
                    if retries && respawns {
                        game.respawn();
                    }
                });
            }
            if let Some(member) = self.members.as_deref_mut().and_then(|it| it.member_mut(index)) {
                member.is_playing = is_playing;
            }
        }
    }

    /// Advances the clocks of figures, and the clocks of players who only watch.
    fn pass_time_of_members(&mut self) {
        let Some(members) = self.members.as_deref_mut() else { return };
        for (_, member) in members.each_mut() {
            member.stunned = member.stunned.saturating_sub(1);
            member.spared = member.spared.saturating_sub(1);
            member.swing = member.swing.saturating_sub(1);
            if !member.is_playing {
                let has_ended = member.player.wait(1);
                member.player.hearing.wait(1);
                self.revision += u64::from(has_ended);
            }
        }
    }

    fn settle_all(&mut self) {
        for index in 0..self.slot_count() {
            self.settle(index);
        }
    }

    /// Records the position of a player, and whether they have just died or reached the exit.
    fn settle(&mut self, index: usize) {
        let now = self.steps;
        let has_reached_exit = self.in_turn(index, |game| game.is_finished());
        let Some(members) = self.members.as_deref_mut() else { return };
        let respawns = members.rules.respawns;
        let Some(member) = members.member_mut(index) else { return };
        let is_dead = member.player.killed_by.is_some();
        let wins = has_reached_exit == Some(true) && !member.has_won;
        if wins || is_dead && member.ended.is_none() {
            member.ended = Some(now);
            self.revision += 1;
        }
        member.has_won |= wins;
        member.is_playing = !member.has_won && !is_dead;
        (member.intents, member.seen) = (Intents::new(), now);
        let is_out = member.has_won || is_dead && !respawns;
        let stands = (!member.has_won && !is_dead).then_some(&member.player.motion);
        member.walked += member.track.record(now, stands);
        if is_out {
            self.put_keys_back(index);
        }
    }

    /// The index of the current player.
    pub(crate) fn turn(&self) -> usize {
        self.members.as_ref().and_then(|members| members.turn).unwrap_or_default()
    }

    /// Runs `act` as a turn of the player in a slot. Does nothing if the slot is empty.
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

    /// Runs `act` as a turn of each active player.
    pub(crate) fn for_each_player(&mut self, act: impl Fn(&mut Self)) {
        let count = self.members.as_ref().map_or(1, |members| members.slots.len());
        for index in 0..count {
            let is_playing = |it: &Members| it.member(index).is_some_and(|it| it.is_playing);
            if self.members.as_deref().is_none_or(is_playing) {
                self.in_turn(index, &act);
            }
        }
    }

    /// Swaps the current player with the player in a slot. Returns false if the slot is empty.
    fn swap_turn(&mut self, index: usize) -> bool {
        let Self { members, player, .. } = self;
        let Some(members) = members.as_deref_mut() else { return false };
        let Some(member) = members.member_mut(index) else { return false };
        std::mem::swap(&mut member.player, player);
        members.turn = Some(index);
        true
    }

    /// The players who were alive and had not reached the exit when the step began, with their
    /// indices.
    pub(crate) fn playing(&self) -> impl Iterator<Item = (usize, &Player)> {
        playing(&self.player, self.members.as_deref())
    }

    /// Returns true if a multiplayer game has no player who is alive and has not reached the exit.
    /// Time does not pass in such a game.
    pub fn is_deserted(&self) -> bool {
        let stands =
            |(_, member): (usize, &Member)| !member.has_won && member.player.killed_by.is_none();
        self.members.as_ref().is_some_and(|members| !members.each().any(stands))
    }

    /// The member entry of the current player.
    pub(crate) fn member_in_turn(&mut self) -> Option<&mut Member> {
        let members = self.members.as_deref_mut()?;
        let turn = members.turn?;
        members.member_mut(turn)
    }

    /// The total value of the treasure found by all players.
    pub(crate) fn treasure_found(&self) -> u32 {
        let Some(members) = self.members.as_deref() else { return self.player.treasure };
        let found = members.each().map(|(index, member)| {
            let player = if members.turn == Some(index) { &self.player } else { &member.player };
            player.treasure
        });
        found.fold(members.treasure_of_the_gone, u32::saturating_add)
    }

    /// Puts a player's keys back where they were found.
    pub(crate) fn put_keys_back(&mut self, index: usize) {
        let Self { members, world, .. } = self;
        let Some(members) = members.as_deref_mut() else { return };
        let Some(member) = members.member_mut(index) else { return };
        let keys = std::mem::take(&mut member.player.keys);
        if keys.is_empty() {
            return;
        }
        let is_lost = |thing: &&Thing| match thing.kind {
            ThingKind::Key(key) => keys.contains(&key),
            _ => false,
        };
        for &thing in members.keys.iter().filter(is_lost) {
            let lies_there = world.things_in(thing.cell).iter().any(|it| it.kind == thing.kind);
            if !lies_there {
                world.put_thing(thing);
            }
        }
        self.revision += 1;
    }

    /// Updates the perceptible state of the players of a multiplayer game, by slot.
    pub(crate) fn find_targets(&mut self) {
        let Some(members) = &mut self.members else { return };
        let mut targets = std::mem::take(&mut members.targets);
        targets.clear();
        targets.resize(members.slots.len(), NOBODY);
        for (index, player) in self.playing() {
            targets[index] = self.target_at(player);
        }
        if let Some(members) = &mut self.members {
            members.targets = targets;
        }
    }

    /// Finds the players who are in the way of the current player.
    pub(crate) fn find_those_in_the_way(&mut self) {
        let Some(members) = &mut self.members else { return };
        if !members.rules.collides {
            return;
        }
        let turn = members.turn;
        let mut in_the_way = std::mem::take(&mut members.in_the_way);
        in_the_way.clear();
        let others = self.playing().filter(|&(index, _)| Some(index) != turn);
        in_the_way.extend(others.map(|(_, player)| player.motion.position()));
        if let Some(members) = &mut self.members {
            members.in_the_way = in_the_way;
        }
    }

    /// The sprite frame for the player of a single-player game after `walked` cells.
    pub fn frame_of_figure(&self, walked: f64) -> u8 {
        let frame = match self.player.killed_by {
            Some(_) => PlayerFrame::Down,
            None => walking_frame(&self.player.motion, walked),
        };
        frame.index()
    }

    /// The sprite of players with that colour; `None` in a single-player game.
    pub fn sprite_of_players(&self, color: PlayerColor) -> Option<SpriteId> {
        self.members.as_ref()?.sprites[color as usize]
    }

    /// The sprite of a player who glows and has a mark above the head, in place of their colour;
    /// `None` in a single-player game. The game itself never shows it.
    pub fn sprite_of_marked_players(&self) -> Option<SpriteId> {
        self.members.as_ref()?.marked
    }
}

/// [`Game::playing`], from the parts of a game.
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

/// The mutable form of [`playing`]. It must be called between turns.
pub(crate) fn playing_mut<'a>(
    player: &'a mut Player,
    members: Option<&'a mut Members>,
) -> impl Iterator<Item = (usize, &'a mut Player)> {
    let alone = members.is_none().then_some((0, player));
    let several = members.into_iter().flat_map(Members::each_mut);
    let several = several.filter(|(_, member)| member.is_playing);
    alone.into_iter().chain(several.map(|(index, member)| (index, &mut member.player)))
}

/// The frame of a player who stands or walks, after `walked` cells.
fn walking_frame(motion: &Motion, walked: f64) -> PlayerFrame {
    match (walked / STRIDE) as u64 % 4 {
        _ if motion.is_ducking() => PlayerFrame::Duck,
        _ if motion.is_still() => PlayerFrame::Stand,
        0 => PlayerFrame::WalkLeft,
        2 => PlayerFrame::WalkRight,
        _ => PlayerFrame::Stand,
    }
}

#[cfg(test)]
mod tests;

//! Joining, leaving, and a step of a game for several.

use super::members::{Member, Members};
use super::seen::Track;
use super::{Input, MultiplayerRules, PlayerId};
use crate::game::checkpoint::Checkpoint;
use crate::game::player::Player;
use crate::game::scratch::Scratch;
use crate::game::tools::Supplies;
use crate::game::{Game, Intent, Intents, Rules};
use crate::world::sprite::builtin::{self, PlayerColor};
use crate::world::{ThingKind, World};

impl Game {
    /// A game for several at its start, with nobody in it.
    pub fn for_players(world: World, rules: Rules, multiplayer: MultiplayerRules) -> Self {
        let is_key = |kind| matches!(kind, ThingKind::Key(_));
        let keys = world.things().iter().filter(|thing| is_key(thing.kind)).copied().collect();
        // The sprites of guards come first, as in a game for one.
        let mut game = Self::with_rules(world, rules);
        let sprites = PlayerColor::ALL
            .map(|color| builtin::player(color).map(|sprite| game.world.add_sprite(sprite)));
        game.checkpoint = Checkpoint::default();
        game.members = Some(Box::new(Members {
            rules: multiplayer,
            slots: Vec::new(),
            turn: None,
            treasure_of_the_gone: 0,
            keys,
            sprites,
            blows: Vec::new(),
            targets: Scratch::default(),
            in_the_way: Scratch::default(),
            figures: Vec::new(),
        }));
        game
    }

    /// The rules among the players; `None` in a game for one.
    pub fn multiplayer_rules(&self) -> Option<MultiplayerRules> {
        self.members.as_ref().map(|members| members.rules)
    }

    /// Lets a player join, at the start or the nearest free place. `None` if no slot or no place is
    /// free, and in a game for one.
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

    /// Lets a player leave. Their keys lie where they were found, and their treasure still counts.
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

    /// Advances the game by one step of [`STEP`](crate::game::STEP) seconds, in which each player
    /// wants what their input says, and those without one want nothing. Of several inputs of one
    /// player, the last counts. In a game for one, that is the input of the [first
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

    /// Gives each player who plays their turn, with their intents, which `act` may change.
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

    /// Lets dead players go on who want to, and finds out who plays.
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

    /// Advances the clocks of figures, and of those who watch.
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

    /// Notes where a player is, and whether they have just died or reached the exit.
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
}

//! Interactions between players, and shared state.

use super::*;

const HALL: [&str; 3] = ["##########", "#@.......#", "##########"];

fn rules(strikes: StrikeEffect) -> MultiplayerRules {
    MultiplayerRules { strikes, collides: true, ..MultiplayerRules::default() }
}

#[test]
fn players_join_at_the_start_or_beside_it_until_the_game_is_full() {
    let hall = [".................", "........@........", "................."];
    let rules = MultiplayerRules { collides: true, ..MultiplayerRules::default() };
    let (mut game, ids) = with_players(level(&hall, "", ""), rules, MAX_PLAYERS);
    assert_eq!(position(&game, ids[0]), DVec2::new(8.5, 1.5));
    assert_eq!(game.players().collect::<Vec<_>>(), ids);
    assert_eq!(game.join(PlayerColor::Red), None);
    game.leave(ids[3]);
    assert_eq!(game.seen_by(ids[3]).map(|view| view.id()), None);
    assert_eq!(game.join(PlayerColor::Green), Some(ids[3]));
    assert_eq!(game.seen_by(ids[3]).unwrap().color(), Some(PlayerColor::Green));
    let (mut closet, _) = with_players(level(&["@"], "", ""), rules, 1);
    assert_eq!(closet.join(PlayerColor::Red), None);
    assert_eq!(Game::new(level(&["@."], "", "")).join(PlayerColor::Red), None);
}

/// The cells of players, in the order of their slots.
fn cells(game: &Game, ids: &[PlayerId]) -> Vec<(u32, u32)> {
    let cell = |id: &PlayerId| position(game, *id);
    ids.iter().map(cell).map(|place| (place.x as u32, place.y as u32)).collect()
}

fn assert_apart(game: &Game, ids: &[PlayerId]) {
    let places: Vec<DVec2> = ids.iter().map(|&id| position(game, id)).collect();
    for (index, place) in places.iter().enumerate() {
        let is_apart = |other: &DVec2| other.distance(*place) >= 2.0 * RADIUS.cells();
        assert!(places[..index].iter().all(is_apart), "{places:?}");
    }
}

#[test]
fn players_start_apart_with_the_levels_heading() {
    let hall = ["#########", "#.......#", "#...@...#", "#.......#", "#########"];
    let mut game = Game::for_players(level(&hall, "", ""), RULES, MultiplayerRules::default());
    let ids = [(); 8].map(|()| game.join(PlayerColor::Red).unwrap());
    assert_apart(&game, &ids);
    assert_eq!(cells(&game, &ids)[..2], [(4, 2), (5, 2)], "the second one is in view");
    for id in ids {
        let camera = game.seen_by(id).unwrap().camera(crate::world::FieldOfView::default());
        assert_eq!(camera.heading.degrees(), 0.0);
    }
}

#[test]
fn players_start_on_this_side_of_doors_and_hazards_if_possible() {
    let rows = ["###########", "#...D@s...#", "#####.#####", "####..._###", "###########"];
    let tiles = "D = { door = 'oak' }\n_ = { floor_height = 0.3 }";
    let things = "s = { spikes = 1.0 }";
    let (mut game, mut ids) =
        with_players(level(&rows, tiles, things), MultiplayerRules::default(), 5);
    let mut begun = cells(&game, &ids);
    begun.sort_unstable();
    assert_eq!(begun, [(4, 3), (5, 1), (5, 2), (5, 3), (6, 3)]);
    // Further players find no better cells.
    ids.extend([(); 4].map(|()| game.join(PlayerColor::Red).unwrap()));
    assert_apart(&game, &ids);
    assert!(!cells(&game, &ids).contains(&(6, 1)));
    // If no cell is free, players share the start.
    let (closet, ids) = with_players(level(&["@"], "", ""), MultiplayerRules::default(), 2);
    assert_eq!(cells(&closet, &ids), [(0, 0); 2]);
}

#[test]
fn players_start_out_of_sight_of_guards_if_possible() {
    let rows = ["########", "####..G#", "####.###", "#...@###", "########"];
    let things = "G = { guard = 'warden', heading = 180 }";
    let (mut game, mut ids) =
        with_players(level(&rows, "", things), MultiplayerRules::default(), 5);
    let mut begun = cells(&game, &ids);
    begun.sort_unstable();
    assert_eq!(begun, [(1, 3), (2, 3), (3, 3), (4, 2), (4, 3)]);
    ids.push(game.join(PlayerColor::Red).unwrap());
    assert_eq!(cells(&game, &ids)[5], (4, 1));
}

#[test]
fn players_push_against_each_other_and_slide_past() {
    let (mut game, ids) = with_players(level(&HALL, "", ""), rules(StrikeEffect::Nobody), 2);
    play(&mut game, 60, &[(ids[0], &[Intent::Forward])]);
    let apart = position(&game, ids[1]).x - position(&game, ids[0]).x;
    assert!((0.5..0.5 + 1e-9).contains(&apart), "{apart}");
    play(&mut game, 60, &[(ids[0], &[Intent::StrafeRight])]);
    play(&mut game, 120, &[(ids[0], &[Intent::Forward]), (ids[1], &[Intent::StrafeLeft])]);
    assert!(position(&game, ids[0]).x > 5.0, "{}", position(&game, ids[0]));
}

#[test]
fn a_rule_lets_players_walk_through_each_other() {
    let rules = MultiplayerRules { collides: false, ..rules(StrikeEffect::Nobody) };
    let (mut game, ids) = with_players(level(&HALL, "", ""), rules, 2);
    play(&mut game, 60, &[(ids[0], &[Intent::Forward])]);
    assert!(position(&game, ids[0]).x > position(&game, ids[1]).x + 1.0);
    play(&mut game, 120, &[(ids[1], &[Intent::Forward, Intent::Run])]);
    assert!(position(&game, ids[1]).x > position(&game, ids[0]).x + 1.0);
}

#[test]
fn a_blow_pushes_or_stuns_as_the_rules_say() {
    for strikes in [StrikeEffect::Nobody, StrikeEffect::Push, StrikeEffect::Stun] {
        let (mut game, ids) = with_players(level(&HALL, "", ""), rules(strikes), 2);
        let before = position(&game, ids[1]);
        play(&mut game, 1, &[(ids[0], &[Intent::Strike])]);
        let blows: Vec<_> = game.blows().collect();
        let is_hit = strikes != StrikeEffect::Nobody;
        assert_eq!(blows, if is_hit { vec![(ids[0], ids[1])] } else { vec![] });
        play(&mut game, 30, &[(ids[1], &[Intent::StrafeRight])]);
        assert_eq!(game.blows().count(), 0);
        let moved = position(&game, ids[1]) - before;
        assert_eq!(moved.x > 0.3, is_hit, "{strikes:?}: {moved}");
        let view = game.seen_by(ids[0]).unwrap();
        let other = view.others().next().unwrap();
        assert_eq!(other.is_down, strikes == StrikeEffect::Stun);
        // A player who lies on the floor does not walk.
        assert_eq!(moved.y > 0.0, strikes != StrikeEffect::Stun, "{moved}");
        assert_eq!(game.seen_by(ids[1]).unwrap().health().points, 6);
    }
}

#[test]
fn a_stunned_player_is_spared_for_a_while() {
    let (mut game, ids) = with_players(level(&HALL, "", ""), rules(StrikeEffect::Stun), 2);
    play(&mut game, 1, &[(ids[0], &[Intent::Strike])]);
    assert_eq!(game.seen_by(ids[1]).unwrap().stunned(), 119);
    play(&mut game, 100, &[(ids[0], &[Intent::Forward])]);
    play(&mut game, 1, &[(ids[0], &[Intent::Strike])]);
    assert_eq!(game.blows().count(), 0);
    play(&mut game, 150, &[]);
    assert_eq!(game.seen_by(ids[1]).unwrap().stunned(), 0);
    play(&mut game, 1, &[(ids[0], &[Intent::Strike])]);
    assert_eq!(game.blows().count(), 1);
}

#[test]
fn acts_are_judged_at_the_step_that_the_player_saw() {
    for (lag, hits) in [(0, false), (15, true), (40, true)] {
        let (mut game, ids) = with_players(level(&HALL, "", ""), rules(StrikeEffect::Push), 2);
        // The players are one cell apart, and the second one runs away.
        let long_ago = game.steps();
        play(&mut game, 15, &[(ids[1], &[Intent::Forward, Intent::Run])]);
        assert!(position(&game, ids[1]).x - position(&game, ids[0]).x > 1.2);
        let seen = game.steps() - lag.min(game.steps());
        assert_eq!(seen == long_ago, lag > 0);
        let strike = Input { player: ids[0], intents: intents(&[Intent::Strike]), seen };
        game.step_all(&[strike]);
        assert_eq!(game.blows().count() == 1, hits, "{lag}");
    }
    let (mut game, ids) = with_players(level(&HALL, "", ""), rules(StrikeEffect::Push), 2);
    play(&mut game, 10, &[(ids[0], &[Intent::Forward])]);
    play(&mut game, 30, &[(ids[1], &[Intent::Forward, Intent::Run])]);
    play(&mut game, 16, &[]);
    // The step is too long ago, so the game uses the step 15 steps ago.
    let strike = Input { player: ids[0], intents: intents(&[Intent::Strike]), seen: 0 };
    game.step_all(&[strike]);
    assert_eq!(game.blows().count(), 0);
}

#[test]
fn touching_can_be_judged_at_a_past_step() {
    let rules = MultiplayerRules { collides: false, ..MultiplayerRules::default() };
    let (mut game, ids) = with_players(level(&HALL, "", ""), rules, 2);
    assert!(!game.touches(ids[0], ids[1], game.steps()), "they begin apart");
    play(&mut game, 15, &[(ids[0], &[Intent::Forward])]);
    play(&mut game, 30, &[]);
    let now = game.steps();
    assert!(game.touches(ids[0], ids[1], now) && game.touches(ids[1], ids[0], now));
    assert!(!game.touches(ids[0], ids[0], now));
    play(&mut game, 15, &[(ids[1], &[Intent::Forward, Intent::Run])]);
    assert!(game.touches(ids[0], ids[1], now));
    assert!(!game.touches(ids[0], ids[1], game.steps()));
    play(&mut game, 60, &[]);
    assert!(!game.touches(ids[0], ids[1], now));
    game.leave(ids[1]);
    assert!(!game.touches(ids[0], ids[1], now));
}

#[test]
fn a_leaving_players_keys_return_and_treasure_stays_counted() {
    let text = "treasure_needed = 20\ngrid = '''\n########\n#.@k.t.D.X#\n########\n'''\n[tiles]\n'#' = { wall = 'brick' }\n\
                D = { door = 'oak', key = 'brass' }\n[things]\n'@' = { start = 0 }\nk = { key = 'brass' }\n\
                t = { treasure = 20 }\nX = { exit = true }";
    let rows =
        text.replace("########\n#.", "###########\n#.").replace("X#\n########", "X#\n###########");
    let (mut game, ids) = with_players(world(&rows), MultiplayerRules::default(), 2);
    let things = game.world().things().len();
    play(&mut game, 75, &[(ids[0], &[Intent::Forward])]);
    let keys = |game: &Game, id| game.seen_by(id).unwrap().keys().count();
    assert_eq!((keys(&game, ids[0]), keys(&game, ids[1])), (1, 0));
    assert_eq!(game.seen_by(ids[0]).unwrap().treasure(), 20);
    assert_eq!(game.world().things().len(), things - 2);
    game.leave(ids[0]);
    assert_eq!(game.world().things().len(), things - 1);
    assert_eq!((game.treasure().found, game.treasure().total), (20, 20));
    let third = game.join(PlayerColor::Blue).unwrap();
    play(&mut game, 400, &[(ids[1], &[Intent::Forward])]);
    let outcome = |game: &Game, id| game.seen_by(id).unwrap().outcome();
    assert_eq!(outcome(&game, ids[1]), Outcome::Won);
    assert_eq!(outcome(&game, third), Outcome::Playing);
    assert_eq!(game.world().things().len(), things - 1);
    let tally = game.seen_by(ids[1]).unwrap().tally();
    assert!(tally.treasure.is_all() && tally.steps < 475);
    assert!(!game.is_deserted());
    play(&mut game, 400, &[(third, &[Intent::Forward])]);
    assert_eq!(outcome(&game, third), Outcome::Won);
    assert!(game.seen_by(third).unwrap().tally().steps < 800 && game.is_deserted());
}

#[test]
fn a_rule_lets_the_dead_resume_from_their_own_checkpoint() {
    let rows = ["###########", "#@.u...s..#", "###########"];
    let things = "u = { checkpoint = true }\ns = { spikes = 1.0 }";
    for respawns in [true, false] {
        let rules = MultiplayerRules { respawns, ..MultiplayerRules::default() };
        let (mut game, ids) = with_players(level(&rows, "", things), rules, 2);
        play(&mut game, 60, &[(ids[0], &[Intent::Forward])]);
        for _ in 0..1200 {
            let column = position(&game, ids[0]).x as u32;
            let walk: &[Intent] = if column < 7 { &[Intent::Forward] } else { &[] };
            play(&mut game, 1, &[(ids[0], walk)]);
        }
        let view = game.seen_by(ids[0]).unwrap();
        assert_eq!(view.outcome(), Outcome::Dead { cause: "spikes" });
        assert_eq!(view.tally().deaths, 1);
        assert!(!game.is_deserted());
        play(&mut game, 1, &[(ids[0], &[Intent::Retry])]);
        let view = game.seen_by(ids[0]).unwrap();
        if respawns {
            assert_eq!((view.outcome(), view.health().points), (Outcome::Playing, 3));
            assert_eq!(position(&game, ids[0]), Cell { column: 3, row: 1 }.center());
            play(&mut game, 30, &[(ids[0], &[Intent::Forward])]);
            assert!(position(&game, ids[0]).x > 4.0);
        } else {
            assert!(matches!(view.outcome(), Outcome::Dead { .. }));
        }
        assert_eq!(game.seen_by(ids[1]).unwrap().health().points, 6);
    }
}

#[test]
fn every_player_works_plates_and_doors() {
    let tiles =
        "p = { plate = 'gate', floor = '#808080' }\nG = { door = 'metal', switch = 'gate' }";
    let rows = ["#########", "#.@p...G.", "#########"];
    let (mut game, ids) = with_players(level(&rows, tiles, ""), MultiplayerRules::default(), 2);
    let gate = Cell { column: 7, row: 1 };
    // The second player starts behind the first one and walks onto the plate. The first one then
    // walks through the gate.
    play(&mut game, 40, &[(ids[1], &[Intent::Forward])]);
    play(&mut game, 240, &[(ids[0], &[Intent::Forward])]);
    assert_eq!(game.world().opening(gate).part(), 1.0);
    assert!(position(&game, ids[0]).x > 8.0, "{}", position(&game, ids[0]));
}

#[test]
fn players_hear_each_other_and_guards_chase_anyone_in_sight() {
    let rows = ["##############", "#@......G....#", "##############"];
    let things = "G = { guard = 'warden', heading = 180 }";
    let (mut game, ids) = with_players(level(&rows, "", things), MultiplayerRules::default(), 2);
    play(&mut game, 30, &[(ids[1], &[Intent::Forward, Intent::Run])]);
    let kinds = |id| -> Vec<_> {
        game.seen_by(id).unwrap().heard().iter().map(|heard| heard.kind).collect()
    };
    let running = crate::game::SoundKind::Running;
    assert!(kinds(ids[0]).contains(&running) && !kinds(ids[1]).contains(&running));
    let mut hurt = Vec::new();
    for _ in 0..600 {
        play(&mut game, 1, &[]);
        hurt = ids.iter().filter(|&&id| game.seen_by(id).unwrap().health().points < 6).collect();
        if !hurt.is_empty() {
            break;
        }
    }
    assert_eq!(hurt, [&ids[1]]);
    assert_eq!(game.seen_by(ids[0]).unwrap().tally().alarms, 1);
    // The guard who followed the player now looks for the other one.
    game.leave(ids[1]);
    play(&mut game, 60, &[]);
}

#[test]
fn the_rules_decide_which_players_the_map_shows() {
    let rows = ["@.#..", "..+..", "..#.."];
    for (shows_on_map, count) in
        [(ShownPlayers::Nobody, 0), (ShownPlayers::InSight, 1), (ShownPlayers::All, 2)]
    {
        let rules = MultiplayerRules { shows_on_map, ..MultiplayerRules::default() };
        let (mut game, ids) = with_players(level(&rows, "'+' = { door = 'oak' }", ""), rules, 3);
        let member = game.members.as_mut().unwrap().member_mut(2).unwrap();
        let behind = Cell { column: 4, row: 1 };
        member.player.motion = member.player.motion.moved_to(&game.world, behind).unwrap();
        let view = game.seen_by(ids[0]).unwrap();
        assert_eq!((view.others().count(), view.others_on_map().count()), (2, count));
    }
}

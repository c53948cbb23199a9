use proptest::prelude::*;

use super::*;
use crate::rooms::replayed::replayed;
use crate::simulation;
use cellcaster::game::{Intent, Outcome, PlayerColor};
use cellcaster::world::Difficulty;

/// Two levels with a hall whose exit is straight ahead of the start.
fn catalog() -> Arc<Catalog> {
    let map = simulation::HALL
        .replace("............>#", ".............#")
        .replace("@............#", "@.......>....#");
    Arc::new(simulation::catalog(&map))
}

fn room(mode: Mode) -> Room {
    Room::new(&catalog(), Header::new("hall", mode, Difficulty::Normal, 7)).unwrap()
}

fn line(text: &str) -> Line {
    Line::of(text, CHAT_COLUMNS).unwrap()
}

fn join(room: &mut Room, name: &str) -> MemberId {
    let member = room.next_member();
    let color = PlayerColor::ALL[member.0 as usize % PlayerColor::ALL.len()];
    do_now(room, member, Command::Join { color, name: line(name) });
    member
}

fn do_now(room: &mut Room, member: MemberId, command: Command) {
    let step = room.step();
    room.apply(&Entry { step, member, command });
}

fn want(room: &mut Room, member: MemberId, intents: &[Intent]) {
    let seen = room.view().game.steps();
    let intents = intents.iter().copied().collect();
    do_now(room, member, Command::Intents { seen, intents });
}

fn advance(room: &mut Room, steps: u64) {
    (0..steps).for_each(|_| room.advance());
}

fn position(room: &Room, member: MemberId) -> glam::DVec2 {
    let view = room.view();
    let player = view.member(member).unwrap().player.unwrap();
    view.game.seen_by(player).unwrap().position()
}

#[test]
fn members_walk_independently() {
    let mut room = room(Mode::Roam);
    let [one, other] = ["Mara", "Jon"].map(|name| join(&mut room, name));
    want(&mut room, one, &[Intent::Forward]);
    let before = position(&room, other);
    advance(&mut room, 60);
    assert!(position(&room, one).x > 2.5);
    assert_eq!(position(&room, other), before);
    do_now(&mut room, one, Command::Leave);
    advance(&mut room, 1);
    assert_eq!(room.view().members.len(), 1);
    let said: Vec<String> = room.view().said.iter().map(|it| it.text.clone()).collect();
    assert_eq!(said, ["Mara has joined.", "Jon has joined.", "Mara leaves."]);
}

#[test]
fn a_race_counts_down_and_is_won_at_the_exit() {
    let mut room = room(Mode::Race);
    let [one, other] = ["Mara", "Jon"].map(|name| join(&mut room, name));
    want(&mut room, one, &[Intent::Forward, Intent::Run]);
    let start = position(&room, one);
    advance(&mut room, 3 * SECOND);
    assert_eq!(position(&room, one), start, "before the start, nobody walks");
    advance(&mut room, 4 * SECOND);
    let view = room.view();
    let player = view.member(one).unwrap().player.unwrap();
    assert_eq!(view.game.seen_by(player).unwrap().outcome(), Outcome::Won);
    assert_eq!(view.member(one).unwrap().role, Role::Done);
    assert!(matches!(view.phase, Phase::Playing { .. }));
    advance(&mut room, 60 * SECOND);
    let view = room.view();
    assert!(matches!(view.phase, Phase::Over { .. }));
    assert_eq!((view.standings[0].member, view.standings[0].points), (one, 1));
    assert_eq!((view.standings[1].member, view.standings[1].points), (other, 0));
    let next = room.next_header();
    assert_eq!((next.round, next.level.as_str()), (2, "museum"));
    assert_eq!(next.members.iter().map(|seat| seat.points).collect::<Vec<_>>(), [1, 0]);
}

#[test]
fn a_finish_gives_place_and_time_and_limits_the_race() {
    let mut room = room(Mode::Race);
    let [one, other, third] = ["Mara", "Jon", "Kim"].map(|name| join(&mut room, name));
    advance(&mut room, 3 * SECOND + 1);
    let left = |room: &Room| match room.phase() {
        Phase::Playing { ends, .. } => ends - room.step(),
        phase => panic!("{phase:?}"),
    };
    assert!(left(&room) > 9 * 60 * SECOND);
    want(&mut room, one, &[Intent::Forward, Intent::Run]);
    advance(&mut room, 3 * SECOND);
    assert!((58 * SECOND..60 * SECOND).contains(&left(&room)), "{}", left(&room));
    let finish = |room: &Room, id| room.view().member(id).unwrap().finish.unwrap().to_string();
    assert!(finish(&room, one).starts_with("1st, 0:01."), "{}", finish(&room, one));
    want(&mut room, other, &[Intent::Forward, Intent::Run]);
    advance(&mut room, 4 * SECOND);
    assert!(finish(&room, other).starts_with("2nd, 0:0"), "{}", finish(&room, other));
    // A second finish does not extend the round.
    assert!(left(&room) < 55 * SECOND);
    advance(&mut room, 55 * SECOND);
    assert!(matches!(room.phase(), Phase::Over { .. }));
    let last = *room.view().standings.last().unwrap();
    assert_eq!((last.member, last.steps), (third, None));
}

#[test]
fn racers_are_placed_by_their_way_to_the_exit() {
    let mut room = room(Mode::Race);
    let ids = ["Mara", "Jon", "Kim"].map(|name| join(&mut room, name));
    let places = |room: &Room| {
        let view = room.view();
        ids.map(|id| view.member(id).unwrap().place)
    };
    assert_eq!(places(&room), [None; 3], "nobody has a place before the start");
    advance(&mut room, 3 * SECOND + 1);
    assert_eq!(
        places(&room),
        [Some(2), Some(1), Some(3)],
        "Jon begins ahead of Mara, Kim beside her"
    );
    want(&mut room, ids[0], &[Intent::StrafeRight]);
    advance(&mut room, SECOND);
    assert_eq!(places(&room), [Some(3), Some(1), Some(2)], "Mara goes off the way");
    want(&mut room, ids[0], &[]);
    want(&mut room, ids[1], &[Intent::Forward, Intent::Run]);
    advance(&mut room, 3 * SECOND);
    assert_eq!(places(&room), [Some(3), Some(1), Some(2)]);
    assert_eq!(room.view().member(ids[1]).unwrap().role, Role::Done);
    do_now(&mut room, ids[1], Command::Leave);
    let left = [0, 2].map(|index| room.view().member(ids[index]).unwrap().place);
    assert_eq!(left, [Some(3), Some(2)], "a finisher who has left counts");
}

#[test]
fn a_round_ends_with_the_winners_last_seconds() {
    let mut room = room(Mode::Race);
    let [one, other] = ["Mara", "Jon"].map(|name| join(&mut room, name));
    advance(&mut room, 3 * SECOND + 1);
    want(&mut room, one, &[Intent::Forward]);
    advance(&mut room, SECOND);
    let (before, of_other) = (position(&room, one), position(&room, other));
    // Restored from a checkpoint here, a room has only the moments after it.
    let mut restored = Room::restore(&catalog(), &room.checkpoint()).unwrap();
    for room in [&mut room, &mut restored] {
        advance(room, 7 * SECOND);
        assert!(room.view().replayed().is_none(), "the round goes on");
        want(room, other, &[Intent::Back]);
        advance(room, 60 * SECOND);
        assert!(matches!(room.phase(), Phase::Over { .. }));
    }
    assert_eq!(room.checksum(), restored.checksum());
    let moments = |room: &mut Room| -> Vec<Moment> {
        let moment = |_| {
            let moment = room.view().replayed().map(|(name, moment)| {
                assert_eq!(name.as_str(), "Mara");
                moment.clone()
            });
            room.advance();
            moment
        };
        (0..5 * SECOND).filter_map(moment).collect()
    };
    let (all, later) = (moments(&mut room), moments(&mut restored));
    assert_eq!(all.len() as u64, 5 * SECOND);
    let x = |moment: &Moment| moment.camera.position().x;
    let [first, last] = [all.iter(), later.iter()].map(|it| it.map(x).reduce(f64::min).unwrap());
    assert!(first < before.x && last > before.x, "{first} {before} {last}");
    let reached = all.iter().map(x).reduce(f64::max).unwrap();
    assert!((8.5..10.0).contains(&reached), "the exit is in column 9: {reached}");
    let shows_other = |it: &Moment| it.figures.iter().any(|figure| figure.position == of_other);
    assert!(all.iter().all(shows_other), "the other stood still at that time");
}

#[test]
fn it_is_marked_and_the_previous_it_is_pale() {
    let mut room = room(Mode::Tag);
    let ids = ["Mara", "Jon"].map(|name| join(&mut room, name));
    want(&mut room, ids[1], &[Intent::Back]);
    advance(&mut room, 3 * SECOND + 1);
    for id in ids {
        want(&mut room, id, &[]);
    }
    let seeker = |room: &Room| {
        let view = room.view();
        view.members.iter().find(|it| it.role == Role::Seeker).unwrap().id
    };
    let first = seeker(&room);
    while seeker(&room) == first {
        advance(&mut room, 1);
    }
    let marked_and_pale = |room: &Room| {
        let view = room.view();
        let sprite = view.game.sprite_of_marked_players();
        let figures = view.figures().unwrap();
        let is_of = |figure: &&Figure| figure.position == position(room, seeker(room));
        assert_eq!(figures.iter().find(is_of).map(|it| it.sprite), sprite);
        let count = |is_it: &dyn Fn(&Figure) -> bool| figures.iter().filter(|it| is_it(it)).count();
        (count(&|it| Some(it.sprite) == sprite), count(&|it| it.opacity < u8::MAX))
    };
    assert_eq!(marked_and_pale(&room), (1, 1), "nobody can touch the previous \"it\"");
    let out_of_reach = seeker(&room);
    want(&mut room, first, &[Intent::Forward, Intent::Run]);
    advance(&mut room, 4 * SECOND);
    assert_eq!((seeker(&room), marked_and_pale(&room)), (out_of_reach, (1, 0)));
}

#[test]
fn members_start_apart_in_every_round() {
    for mode in Mode::ALL {
        let mut room = room(mode);
        let ids: Vec<MemberId> =
            (0..mode.most()).map(|number| join(&mut room, &format!("m{number}"))).collect();
        for _ in 0..2 {
            let places: Vec<_> = ids.iter().map(|&id| position(&room, id)).collect();
            for (index, place) in places.iter().enumerate() {
                let is_apart = |other: &glam::DVec2| other.distance(*place) >= 1.0;
                assert!(places[..index].iter().all(is_apart), "{mode:?}: {places:?}");
            }
            room.begin_next();
        }
    }
}

#[test]
fn a_touch_tags_the_other_player() {
    let mut room = room(Mode::Tag);
    let ids = ["Mara", "Jon"].map(|name| join(&mut room, name));
    // The member in front steps back until the two touch.
    want(&mut room, ids[1], &[Intent::Back]);
    advance(&mut room, 3 * SECOND + 1);
    let it = |room: &Room| {
        ids.into_iter().find(|&id| room.view().member(id).unwrap().role == Role::Seeker)
    };
    let first = it(&room).unwrap();
    let other = ids.into_iter().find(|&id| id != first).unwrap();
    for id in ids {
        want(&mut room, id, &[]);
    }
    advance(&mut room, 2 * SECOND);
    assert_eq!(it(&room), Some(other), "they stand in each other's reach");
    want(&mut room, first, &[Intent::Forward, Intent::Run]);
    advance(&mut room, 3 * 60 * SECOND);
    let view = room.view();
    assert!(matches!(view.phase, Phase::Over { .. }));
    assert_eq!(view.standings[0].member, first);
}

#[test]
fn seekers_wait_before_they_find_the_others() {
    let mut room = room(Mode::Hide);
    let ids = ["Mara", "Jon"].map(|name| join(&mut room, name));
    advance(&mut room, 1);
    let view = room.view();
    let seeker = view.members.iter().find(|member| member.role == Role::Seeker).unwrap();
    assert!(seeker.is_blind);
    let hidden = ids.into_iter().find(|&id| id != seeker.id).unwrap();
    want(&mut room, hidden, &[Intent::Forward]);
    want(&mut room, seeker.id, &[Intent::Forward]);
    advance(&mut room, 3 * SECOND);
    assert!(position(&room, hidden).distance(position(&room, seeker.id)) > 2.0);
    want(&mut room, hidden, &[]);
    advance(&mut room, 17 * SECOND);
    assert!(!room.view().member(seeker.id).unwrap().is_blind);
    advance(&mut room, 10 * SECOND);
    assert!(matches!(room.view().phase, Phase::Over { .. }), "the hall is straight");
    assert_eq!(room.view().standings[0].member, hidden);
}

#[test]
fn a_round_waits_for_a_second_member() {
    let mut room = room(Mode::Tag);
    let one = join(&mut room, "Mara");
    advance(&mut room, 100 * SECOND);
    assert_eq!(room.view().phase, Phase::Waiting);
    join(&mut room, "Jon");
    advance(&mut room, 10);
    assert!(matches!(room.view().phase, Phase::Countdown { .. }));
    do_now(&mut room, one, Command::Leave);
    advance(&mut room, 1);
    assert_eq!(room.view().phase, Phase::Waiting);
}

#[test]
fn a_full_room_admits_nobody() {
    let mut room = room(Mode::Tag);
    for number in 0..20 {
        join(&mut room, &format!("m{number}"));
    }
    assert_eq!(room.len(), Mode::Tag.most());
    assert!(room.is_full());
}

/// A list of commands in order, each with the steps before it and the number of its member.
fn commands() -> impl Strategy<Value = Vec<(u64, u32, Command)>> {
    let intents = prop::sample::subsequence(Intent::ALL.to_vec(), 0..4);
    let intents = intents.prop_map(|it| it.into_iter().collect::<Intents>());
    let command = prop_oneof![
        2 => Just(Command::Join { color: PlayerColor::ALL[0], name: line("Mara") }),
        1 => Just(Command::Leave),
        2 => Just(Command::Keep),
        1 => Just(Command::Away),
        1 => any::<u64>().prop_map(|token| Command::Return { token }),
        6 => (0_u64..500, intents).prop_map(|(seen, intents)| Command::Intents { seen, intents }),
        1 => Just(Command::Say(line("hello"))),
        1 => Just(Command::Emote(Emote::Wave)),
        1 => Just(Command::Day(Day::default())),
    ];
    prop::collection::vec((0_u64..40, 0_u32..10, command), 0..40)
}

/// Plays a round for `steps` steps with these entries.
fn played(entries: &[Entry], header: &Header, steps: u64) -> Room {
    let mut room = Room::new(&catalog(), header.clone()).unwrap();
    let mut entries = entries.iter().peekable();
    while room.step() < steps {
        while let Some(entry) = entries.next_if(|entry| entry.step <= room.step()) {
            room.apply(entry);
        }
        room.advance();
    }
    room
}

/// The text of a round's recording.
fn recorded(header: &Header, entries: &[Entry]) -> String {
    let lines = entries.iter().map(|entry| format!("{entry}\n"));
    header.to_string() + &lines.collect::<String>()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_log_reproduces_the_room(
        mode in prop::sample::select(&Mode::ALL),
        seed: u64,
        commands in commands(),
    ) {
        let header = Header::new("hall", mode, Difficulty::Normal, seed);
        let mut step = 0;
        let mut entries = Vec::new();
        for (wait, member, command) in commands {
            step += wait;
            entries.push(Entry { step, member: MemberId(member), command });
        }
        let one = played(&entries, &header, step + 60);
        let rounds = parse_log(&recorded(&header, &entries)).unwrap();
        let [(read, entries)] = &rounds[..] else { panic!("one round") };
        prop_assert_eq!(read, &header);
        let other = played(entries, read, step + 60);
        prop_assert_eq!(one.checksum(), other.checksum());
        prop_assert_eq!(one.game, other.game);
    }
}

#[test]
fn a_recording_can_be_replayed() {
    let header = Header::new("hall", Mode::Race, Difficulty::Normal, 7);
    let mut room = Room::new(&catalog(), header.clone()).unwrap();
    let runs = [Intent::Forward, Intent::Run].into_iter().collect();
    let name = line("Mara");
    let commands = [
        Command::Join { color: PlayerColor::ALL[0], name },
        Command::Intents { seen: 0, intents: runs },
    ];
    let entries = commands.map(|command| Entry { step: 0, member: MemberId(1), command });
    for entry in &entries {
        room.apply(entry);
    }
    while !room.is_over() {
        room.advance();
    }
    let (steps, checksum) = (room.step(), room.checksum());
    let text = recorded(&header, &entries) + &recorded(&room.next_header(), &[]);
    let older =
        replayed(&text.replace("cellcaster-room 3", "cellcaster-room 2"), &catalog(), &mut |_| {
            Ok(())
        });
    assert!(older.unwrap_err().contains("another version"));
    let reports = replayed(&text, &catalog(), &mut |_| Ok(())).unwrap();
    assert_eq!(reports.len(), 2);
    assert_eq!((reports[0].steps, reports[0].checksum), (steps, checksum));
    assert_eq!(reports[0].standings, [("Mara".to_owned(), 0)]);
    assert_eq!((reports[1].round, reports[1].level.as_str()), (2, "museum"));
    assert!(replayed("nonsense", &catalog(), &mut |_| Ok(())).is_err());
}

#[test]
fn a_round_that_waits_for_hours_can_be_replayed() {
    let header = Header::new("hall", Mode::Tag, Difficulty::Normal, 7);
    let join = Command::Join { color: PlayerColor::ALL[0], name: line("Mara") };
    let waits = |step| {
        let entry = |step, command| Entry { step, member: MemberId(1), command };
        recorded(&header, &[entry(0, join.clone()), entry(step, Command::Again)])
    };
    let replay = |step| replayed(&waits(step), &catalog(), &mut |_| Ok(()));
    let steps = 2 * 60 * 60 * SECOND + 1;
    assert_eq!(replay(steps).unwrap()[0].steps, steps);
    for step in [26 * 60 * 60 * SECOND, u64::MAX] {
        let fault = replay(step).unwrap_err();
        assert_eq!(fault, "nothing happens in round 1 for longer than a day");
    }
}

/// A room with two members. The first one has an account.
fn room_of_two(mode: Mode) -> (Room, [MemberId; 2]) {
    let mut room = room(mode);
    let members = ["Mara", "Jon"].map(|name| join(&mut room, name));
    do_now(&mut room, members[0], Command::Keep);
    (room, members)
}

fn last_line(room: &Room) -> String {
    room.view().said.last().map(|said| said.text.clone()).unwrap_or_default()
}

#[test]
fn an_away_member_stands_still_and_can_return() {
    let (mut room, [mara, _]) = room_of_two(Mode::Roam);
    want(&mut room, mara, &[Intent::Forward]);
    advance(&mut room, 20);
    do_now(&mut room, mara, Command::Away);
    assert_eq!(last_line(&room), "Mara is away.");
    advance(&mut room, 60);
    let place = position(&room, mara);
    // Late commands from the old host have no effect.
    want(&mut room, mara, &[Intent::Forward]);
    do_now(&mut room, mara, Command::Again);
    advance(&mut room, AWAY - 61);
    assert_eq!(position(&room, mara), place);
    assert!(room.view().member(mara).unwrap().is_away && room.is_away(mara));
    do_now(&mut room, mara, Command::Return { token: 7 });
    assert_eq!((last_line(&room).as_str(), room.is_away(mara)), ("Mara is back.", false));
    assert_eq!(room.kept_place(mara), Some(KeptPlace { token: 7, away: None }));
    want(&mut room, mara, &[Intent::Forward]);
    advance(&mut room, AWAY + 60);
    assert!(position(&room, mara).x > place.x + 1.0 && room.len() == 2);
}

#[test]
fn a_member_who_is_away_for_too_long_leaves() {
    let (mut room, [mara, jon]) = room_of_two(Mode::Roam);
    do_now(&mut room, mara, Command::Away);
    advance(&mut room, AWAY - 1);
    // A second `away` does not restart the count.
    do_now(&mut room, mara, Command::Away);
    assert_eq!(room.len(), 2);
    advance(&mut room, 1);
    assert_eq!((room.len(), last_line(&room).as_str()), (1, "Mara leaves."));
    do_now(&mut room, mara, Command::Return { token: 7 });
    assert!(room.has_lost(mara) && !room.has_lost(jon) && !room.has_lost(room.next_member()));
}

#[test]
fn a_guest_who_disconnects_leaves_the_room() {
    let (mut room, [_, jon]) = room_of_two(Mode::Roam);
    do_now(&mut room, jon, Command::Return { token: 7 });
    assert_eq!(room.kept_place(jon), None);
    do_now(&mut room, jon, Command::Away);
    assert_eq!((room.len(), last_line(&room).as_str()), (1, "Jon leaves."));
}

#[test]
fn a_round_does_not_wait_for_away_members() {
    let (mut room, [mara, jon]) = room_of_two(Mode::Roam);
    do_now(&mut room, mara, Command::Again);
    do_now(&mut room, mara, Command::Away);
    assert!(!room.is_over());
    do_now(&mut room, jon, Command::Again);
    assert!(room.is_over());
}

#[test]
fn an_away_member_stays_away_in_the_next_round() {
    let (mut room, [mara, _]) = room_of_two(Mode::Tag);
    do_now(&mut room, mara, Command::Return { token: 7 });
    advance(&mut room, 100);
    assert!(matches!(room.phase(), Phase::Countdown { .. }));
    do_now(&mut room, mara, Command::Away);
    advance(&mut room, 100);
    room.begin_next();
    let kept = KeptPlace { token: 7, away: Some(AWAY - 100) };
    assert_eq!(room.kept_place(mara), Some(kept));
    advance(&mut room, AWAY - 101);
    assert_eq!(room.len(), 2);
    advance(&mut room, 1);
    assert_eq!(room.len(), 1);
}

use super::*;
use cellcaster::game::{Intent, Intents};

fn line(text: &str) -> Line {
    Line::of(text, 16).unwrap()
}

fn inbox() -> (Inbox, MemberId) {
    let inbox = Inbox::new(Mode::Tag, MemberId(1));
    let id = inbox.join(&line("Mara")).unwrap();
    (inbox, id)
}

fn taken(inbox: &Inbox) -> Vec<Command> {
    let mut commands = Vec::new();
    inbox.take(|_, command| commands.push(command));
    commands
}

fn want(intents: impl IntoIterator<Item = Intent>) -> Command {
    Command::Intents { seen: 0, intents: intents.into_iter().collect::<Intents>() }
}

#[test]
fn each_member_has_a_unique_number_and_colour() {
    let inbox = Inbox::new(Mode::Tag, MemberId(5));
    let ids: Vec<_> = (0..9).map(|_| inbox.join(&line("Mara"))).collect();
    assert_eq!(ids[7], Ok(MemberId(12)));
    assert_eq!(ids[8], Err(RoomRefusal::Full));
    let mut colors = Vec::new();
    inbox.take(|_, command| {
        let Command::Join { color, .. } = command else { panic!("{command:?}") };
        assert!(!colors.contains(&color));
        colors.push(color);
    });
    inbox.leave(MemberId(7));
    assert_eq!(inbox.join(&line("Mara")), Ok(MemberId(13)));
    inbox.close();
    assert_eq!(inbox.join(&line("Mara")), Err(RoomRefusal::Gone));
}

#[test]
fn intent_changes_keep_their_order_with_one_per_step() {
    let (inbox, id) = inbox();
    taken(&inbox);
    for _ in 0..100 {
        assert!(inbox.act(id, want([Intent::Forward])));
    }
    assert!(inbox.act(id, want([])));
    let intents: Vec<Command> = (0..60).flat_map(|_| taken(&inbox)).collect();
    assert_eq!(intents.len(), MAX_INTENTS);
    assert_eq!(intents.last(), Some(&want([])));
    let mut count = 0;
    for step in 0..600 {
        inbox.act(id, want((step % 2 == 0).then_some(Intent::Back)));
        count += taken(&inbox).len();
    }
    assert_eq!(count, 600);
}

#[test]
fn a_member_who_has_left_does_nothing() {
    let (inbox, id) = inbox();
    inbox.act(id, Command::Say(line("bye")));
    inbox.leave(id);
    inbox.leave(id);
    assert!(!inbox.act(id, want([])));
    assert!(matches!(taken(&inbox)[..], [Command::Join { .. }, Command::Leave]));
    assert!(inbox.is_empty());
}

#[test]
fn joins_and_departures_in_one_step_are_bounded() {
    let inbox = Inbox::new(Mode::Roam, MemberId(1));
    let ids = std::iter::from_fn(|| {
        let id = inbox.join(&line("Mara")).ok()?;
        inbox.leave(id);
        Some(id)
    });
    assert!(ids.take(1000).count() <= MAX_MOVES);
    assert!(taken(&inbox).len() <= MAX_MOVES + 1);
}

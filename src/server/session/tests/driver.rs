//! What the driver of sessions does, for a rig.

use super::*;

impl Rig {
    /// Does what a driver does with one session between frames.
    pub(super) fn serve(&mut self, index: usize) {
        let now = self.now;
        let view = self.room.view();
        let visitor = &mut self.visitors[index];
        let is_due = |(due, _): &mut (Duration, Vec<u8>)| *due <= now;
        for (_, answer) in visitor.under_way.extract_if(.., is_due).collect::<Vec<_>>() {
            visitor.session.receive(&answer, now);
        }
        let seen = visitor.is_inside.then_some(&view);
        if visitor.session.wakes_at(seen, now).is_some_and(|wakes| wakes <= now) {
            visitor.session.wake(now);
        }
        for ask in visitor.session.asks() {
            self.answer(index, ask);
        }
        self.send_output(index);
    }

    pub(super) fn show(&mut self, index: usize) {
        let (now, view) = (self.now, self.room.view());
        let visitor = &mut self.visitors[index];
        let seen = visitor.is_inside.then_some(&view);
        if visitor.session.is_due(seen, now) {
            visitor.session.draw(seen, now);
            visitor.pictures += 1;
        }
        self.send_output(index);
    }

    pub(super) fn send_output(&mut self, index: usize) {
        let now = self.now;
        let visitor = &mut self.visitors[index];
        let bytes = std::mem::take(visitor.session.output(now));
        if bytes.is_empty() || !visitor.answers {
            visitor.bytes += bytes.len();
            return;
        }
        visitor.bytes += bytes.len();
        visitor.session.written(now);
        visitor.bells += bytes.split(|&byte| byte == 0x07).count() - 1;
        let answers = visitor.emulator.process(&bytes);
        if !answers.is_empty() {
            visitor.under_way.push((now + visitor.latency, answers));
        }
        visitor.sent.push(bytes);
    }

    pub(super) fn answer(&mut self, index: usize, ask: Ask) {
        let now = self.now;
        let news = match ask {
            Ask::Name(name) => News::Named(
                Line::of(&name, NAME_COLUMNS).ok_or_else(|| "Choose another name.".to_owned()),
            ),
            Ask::Rooms => News::Rooms(self.summaries()),
            Ask::Enter { watches: true, .. } => {
                self.visitors[index].is_inside = true;
                News::Entered { room: ROOM, member: None }
            }
            Ask::Enter { watches: false, .. } => self.join(index),
            Ask::Open(wish) => {
                let header = Header::new(&wish.level, wish.mode, wish.difficulty, 7);
                self.room = Room::new(&self.catalog, header).unwrap();
                self.log.clear();
                self.join(index)
            }
            Ask::Deed(deed) => {
                if let Deed::Want { seen, .. } = &deed {
                    let step = self.room.view().game.steps();
                    self.visitors[index].wants.push((*seen, step));
                }
                return self.apply(index, deed);
            }
            Ask::Leave => {
                self.apply(index, Deed::Leave);
                self.visitors[index].is_inside = false;
                return;
            }
            Ask::Board { level, difficulty } => {
                News::Board { level, difficulty, rows: Arc::from([]) }
            }
            Ask::Ghosts { level, difficulty } => {
                News::Ghosts { level, difficulty, ghosts: Arc::clone(&self.ghosts) }
            }
            Ask::Save(settings) => {
                self.visitors[index].saved = Some(settings);
                return;
            }
        };
        self.visitors[index].session.tell(news, now);
    }

    pub(super) fn join(&mut self, index: usize) -> News {
        let member = self.room.next_member();
        let name = self.visitors[index].session.visit.identity.name.clone();
        let color = PlayerColor::ALL[index % PlayerColor::ALL.len()];
        self.enter(member, Deed::Join { color, name });
        self.visitors[index].member = Some(member);
        self.visitors[index].is_inside = true;
        News::Entered { room: ROOM, member: Some(member) }
    }

    pub(super) fn apply(&mut self, index: usize, deed: Deed) {
        if let Some(member) = self.visitors[index].member {
            self.enter(member, deed);
        }
    }

    /// Enters something in the log, and applies it.
    pub(super) fn enter(&mut self, member: MemberId, deed: Deed) {
        let entry = Entry { step: self.room.step(), member, deed };
        self.room.apply(&entry);
        self.log.push(entry);
    }

    pub(super) fn summaries(&self) -> Arc<[RoomSummary]> {
        let view = self.room.view();
        let header = &view.header;
        Arc::from([RoomSummary {
            id: ROOM,
            level: header.level.clone(),
            mode: header.mode,
            difficulty: header.difficulty,
            phase: view.phase,
            members: view.members.iter().map(|member| member.name.clone()).collect(),
            watchers: 0,
        }])
    }
}

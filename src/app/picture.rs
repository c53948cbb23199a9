//! The picture of one player, with the HUD and the map over it: directions of sounds, a flash at
//! the edge, the compass, the middle of the picture, and the text of a note.
//!
//! All of it depends only on the game and the player. A game at home and a room with several
//! players therefore show the same picture. Absent things are not drawn, so a level without guards
//! looks and costs as if there were no HUD.
//!
//! - **Sounds.** The edge of the picture is a ring around the player, seen from above. A sound from
//!   ahead is marked at the top, a sound from behind at the bottom. A mark is an arrow with one to
//!   three characters, depending on the loudness. Each kind of sound has its own character, so the
//!   marks work without colours. If a guard notices the player or strikes, a word says so. If two
//!   marks would overlap, a threat or the louder sound keeps its place, and the other mark moves
//!   aside.
//! - **Suspicion.** A guard in view who has noticed something has a mark above the head: `?` to `???`
//!   the surer they are, `<?>` while they search, and `!!!` while they follow the player.
//! - **The map** is darker while the guards are wary or alarmed, so that the picture stands out. The
//!   marks of guards, the floor that they look at and the exit keep their colours.
//! - **The flash.** It is red on the side of the blow when the player is hurt, and golden when the
//!   player finds something. It tints the pixels before they are painted, so every colour depth
//!   shows it. Without colours, the edge is drawn in characters.

use std::cell::OnceCell;

use glam::DVec2;
use ratatui::layout::{Rect, Size};
use ratatui::style::{Color, Modifier, Style};
use ratatui::text::Line;

use crate::app::controls::MapChange;
use crate::app::page::{self, BORDERS, PADDING, framed, panel, wrapped};
use crate::app::setting::{MapDisplay, Preferences};
use crate::color::Rgb;
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::game::{
    Alarm, Flash, FlashKind, Game, GuardView, Heard, Mood, PlayerId, PlayerView, SightCone,
    SoundKind,
};
use crate::render::{Filter, Frame, Renderable};
use crate::sort;
use crate::terminal::Protocol;
use crate::tui::canvas::Canvas;
use crate::tui::{CellAspect, Correction, Explored, FirstPerson, GlyphSet, MapMark, Minimap, View};
use crate::visibility::{FrameSize, Projection};
use crate::world::{Camera, FieldOfView, Heading};

/// The known properties of the terminal that affect the picture.
#[derive(Clone, Copy, Debug, Default)]
pub struct TerminalLook {
    /// The height-to-width ratio of a cell, if known.
    pub aspect: Option<CellAspect>,
    /// The colour depth.
    pub depth: ColorDepth,
    /// The way in which the terminal draws shade characters.
    pub shade_ink: ShadeInk,
    /// The finest block glyphs that the terminal is known to draw well.
    pub glyphs: GlyphSet,
}

impl TerminalLook {
    /// The properties of the terminal that `protocol` talks to.
    pub fn of(protocol: &Protocol) -> Self {
        Self {
            aspect: protocol.size().cell_aspect.and_then(CellAspect::new),
            depth: protocol.color_depth(),
            shade_ink: protocol.shade_ink(),
            glyphs: protocol.glyph_support(),
        }
    }
}

/// Options for drawing a picture.
#[derive(Clone, Copy, Debug)]
pub struct DrawOptions {
    /// The glyph set.
    pub glyphs: GlyphSet,
    /// The colour depth.
    pub depth: ColorDepth,
    /// The way in which the terminal draws shade characters.
    pub shade_ink: ShadeInk,
    /// The height-to-width ratio of a cell.
    pub cell_aspect: CellAspect,
    /// The texture filter.
    pub filter: Filter,
    /// The colour correction for the player's eyes.
    pub correction: Correction,
    /// The field of view.
    pub field_of_view: FieldOfView,
    /// The flash at the edge, and the direction of view.
    pub flash: Option<(Flash, Heading)>,
    /// `true` to mark the middle with a dot.
    pub marks_middle: bool,
}

impl DrawOptions {
    /// Draws `scene` from `camera` at game time `seconds`.
    pub fn draw<S: Renderable>(
        &self,
        scene: &S,
        camera: &S::Camera,
        seconds: f64,
        canvas: &mut impl Canvas,
        area: Rect,
        view: &mut View<S>,
    ) {
        let picture = self.picture(scene, camera, seconds);
        self.render(&picture, area.as_size(), view, &mut || true);
        picture.paint(view, 0, area, canvas);
    }

    /// The picture of `scene` from `camera` at game time `seconds`.
    pub(crate) fn picture<'a, S: Renderable>(
        &self,
        scene: &'a S,
        camera: &'a S::Camera,
        seconds: f64,
    ) -> FirstPerson<'a, S> {
        FirstPerson::new(scene, camera)
            .glyphs(self.glyphs)
            .color_depth(self.depth)
            .shade_ink(self.shade_ink)
            .cell_aspect(self.cell_aspect)
            .filter(self.filter)
            .correction(self.correction)
            .time(seconds)
    }

    /// Renders `picture` for an area of this size into `view`. Rendering may stop once `go_on`
    /// returns `false`. Returns whether the picture is complete.
    pub(crate) fn render<S: Renderable>(
        &self,
        picture: &FirstPerson<'_, S>,
        size: Size,
        view: &mut View<S>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        let is_complete = picture.draw_while(size, view, go_on);
        let has_pixels = size.width > 0 && size.height > 0;
        if is_complete && has_pixels && self.depth != ColorDepth::Mono {
            self.change_pixels(view.frame_mut());
        }
        is_complete
    }

    /// Tints the edge and marks the middle of a picture in colours.
    fn change_pixels(&self, frame: &mut Frame) {
        if let Some((flash, heading)) = &self.flash {
            tint(frame, flash, *heading);
        }
        if self.marks_middle && self.glyphs.has_blocks() {
            mark_middle(frame);
        }
    }
}

/// The field of view after a key press: 6 degrees wider or narrower than `view`, and between 30 and
/// 120 degrees.
pub fn widened(view: FieldOfView, widens: bool) -> FieldOfView {
    let by = if widens { 6.0 } else { -6.0 };
    FieldOfView::from_degrees((view.degrees() + by).clamp(30.0, 120.0)).unwrap_or(view)
}

/// One player of a game, and the options for their picture.
pub struct Overlay<'a> {
    game: &'a Game,
    player: PlayerView<'a>,
    options: &'a DrawOptions,
    preferences: Preferences,
    /// The guards in the picture, for the map and for the marks above their heads.
    guards_in_sight: OnceCell<Vec<GuardView>>,
}

impl<'a> Overlay<'a> {
    /// The overlay for `player`'s picture; `None` if that player is not in the game.
    pub fn new(
        game: &'a Game,
        player: PlayerId,
        options: &'a DrawOptions,
        preferences: Preferences,
    ) -> Option<Self> {
        let (player, guards_in_sight) = (game.seen_by(player)?, OnceCell::new());
        Some(Self { game, player, options, preferences, guards_in_sight })
    }

    fn guards_in_sight(&self) -> &[GuardView] {
        self.guards_in_sight.get_or_init(|| {
            let camera = self.player.camera(self.options.field_of_view);
            self.player.guards_in_sight(&camera).collect()
        })
    }

    /// Draws the middle mark, the flash at the edge, and the compass. If `shows_events`, also draws
    /// sounds and the note, both beside the `map` panel.
    pub fn draw_hud(
        &self,
        canvas: &mut impl Canvas,
        area: Rect,
        map: Option<Rect>,
        shows_events: bool,
    ) {
        let Self { player, options, .. } = self;
        options.draw_middle(canvas, area);
        let heading = player.camera(options.field_of_view).heading;
        let is_plain = options.depth == ColorDepth::Mono;
        if let Some((flash, heading)) = options.flash.as_ref().filter(|_| is_plain) {
            draw_edge(canvas, area, flash, *heading);
        }
        if self.preferences.compass {
            draw_compass(canvas, area, heading);
        }
        if shows_events {
            let marks = self.preferences.marks;
            let taken = if marks { self.draw_suspicions(canvas, area, map) } else { Vec::new() };
            draw_sounds(canvas, (area, map), (player.heard(), taken), heading, options.depth);
            if let Some(note) = player.note() {
                draw_note(canvas, area, note);
            }
        }
    }

    /// Draws the suspicion of each guard in view above the guard's head, or beside the map panel.
    /// Returns the areas.
    fn draw_suspicions(
        &self,
        canvas: &mut impl Canvas,
        area: Rect,
        map: Option<Rect>,
    ) -> Vec<Rect> {
        let Self { player, options, .. } = self;
        let (width, height) = (area.width.into(), area.height.into());
        let mut taken = Vec::new();
        let Some(size) = FrameSize::new(width, height) else { return taken };
        let camera = player.camera(options.field_of_view);
        let cell = options.cell_aspect.of_pixels(GlyphSet::Ascii);
        let projection = Projection::new(&camera, size, cell);
        for guard in self.guards_in_sight() {
            let Some(suspicion) = Suspicion::of(guard) else { continue };
            let text = suspicion.text();
            let place = projection.place(guard.position);
            let head = projection.row_at(guard.feet + guard.kind.height(), place.depth);
            let columns = text.len() as u16;
            let last = area.width.saturating_sub(columns);
            let x = (place.column - f64::from(columns) / 2.0).round().clamp(0.0, last.into());
            let y = (head - 1.0).floor().max(ROWS_ABOVE_MARKS).min(f64::from(area.height - 1));
            let mark = Line::raw(text).style(suspicion.style(options.depth));
            let (x, y) = (area.x + x as u16, area.y + y as u16);
            let place = Rect { x, y, width: columns, height: 1 };
            let place = beside(map, place).intersection(area);
            canvas.draw_widget(mark, place);
            taken.push(place);
        }
        taken
    }

    /// Draws the map panel, if it is shown, and the ghost on it, if there is one. `view` must hold
    /// the last picture. Returns the area of the panel.
    pub fn draw_map(
        &self,
        canvas: &mut impl Canvas,
        area: Rect,
        panel: &mut MapPanel,
        view: &View,
        ghost: Option<MapMark>,
    ) -> Option<Rect> {
        let Self { game, player, options, .. } = self;
        let camera = &player.camera(options.field_of_view);
        panel.explore(game, camera, area.width);
        if !panel.is_shown {
            return None;
        }
        let guards = game.guards().filter(|guard| !guard.is_down);
        let guards = guards.map(|it| MapMark { position: it.position, heading: it.heading });
        let others = player.others_on_map();
        let others = others.map(|it| MapMark { position: it.position, heading: it.heading });
        let marks: Vec<MapMark> = guards.chain(others).collect();
        let seen = self.guards_in_sight().iter();
        let cones: Vec<SightCone> = seen.filter_map(|guard| game.sight_cone(guard)).collect();
        let map = panel.minimap(game, camera, view);
        let map = map
            .glyphs(options.glyphs)
            .color_depth(options.depth)
            .marks(&marks)
            .cones(&cones)
            .faded(game.alarm() > Alarm::Calm)
            .ghost(ghost);
        let place = page::minimap(area, &map, panel.is_narrow_in(area.width))?;
        let inside = framed(canvas, place, "map");
        map.paint(inside, canvas);
        panel.shown(map.extent_within(inside.as_size()), game, camera);
        Some(place)
    }
}

impl DrawOptions {
    /// Marks the middle with a character if pixels do not show it.
    pub(crate) fn draw_middle(&self, canvas: &mut impl Canvas, area: Rect) {
        let is_plain = self.depth == ColorDepth::Mono;
        if self.marks_middle && (is_plain || !self.glyphs.has_blocks()) {
            let (x, y) = (area.x + area.width / 2, area.y + area.height / 2);
            canvas.draw_character(x, y, '+', [Color::Reset; 2]);
        }
    }
}

/// The maximum width of a note's text, in columns.
const NOTE_COLUMNS: usize = 56;

/// Draws the text of a note at the bottom of the picture.
pub(crate) fn draw_note(canvas: &mut impl Canvas, picture: Rect, note: &str) {
    let most_columns = usize::from(picture.width.saturating_sub(BORDERS + PADDING)).max(1);
    let columns = most_columns.min(NOTE_COLUMNS);
    let lines: Vec<String> = note.lines().flat_map(|line| wrapped(line, columns)).collect();
    let widest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0);
    let (width, height) = (widest as u16 + BORDERS + PADDING, lines.len() as u16 + BORDERS);
    let (width, height) = (width.max(8).min(picture.width), height.min(picture.height));
    let area = Rect {
        x: picture.x + (picture.width - width) / 2,
        y: picture.bottom() - height,
        width,
        height,
    };
    panel(canvas, area, "note", lines.into_iter().map(Line::from).collect());
}

/// Marks the middle of a picture in half blocks.
fn mark_middle(frame: &mut Frame) {
    let (x, y) = (frame.width() as usize / 2, frame.height() as usize / 2);
    let Some(pixel) = frame.rows_mut().nth(y).and_then(|row| row.get_mut(x)) else { return };
    *pixel = if pixel.luma() < 128 { Rgb::WHITE } else { Rgb::BLACK };
}

/// The maximum number of marks.
const MAX: usize = 8;
/// The number of rows at the top that other panels use.
const ROWS_ABOVE: u16 = 1;
/// The minimum width of a picture with room for words, in columns.
const COLUMNS_FOR_WORDS: u16 = 40;

/// Draws a mark for each of `heard`, relative to the direction of view `heading`, beside the `map` panel
/// and outside the areas that are `taken`.
fn draw_sounds(
    canvas: &mut impl Canvas,
    (picture, map): (Rect, Option<Rect>),
    (heard, mut taken): (&[Heard], Vec<Rect>),
    heading: Heading,
    depth: ColorDepth,
) {
    if heard.is_empty() || picture.height <= ROWS_ABOVE + 2 || picture.width < 20 {
        return;
    }
    let ring = Rect { y: picture.y + ROWS_ABOVE, height: picture.height - ROWS_ABOVE, ..picture };
    let mut loudest: Vec<&Heard> = heard.iter().collect();
    sort::by_key(&mut loudest, |heard| (!is_threat(heard.kind), u8::MAX - heard.strength));
    for heard in loudest.into_iter().take(MAX) {
        let text = mark(heard, heading, picture.width >= COLUMNS_FOR_WORDS);
        let angle = angle(heard.bearing, heading);
        let Some(area) = free_place((ring, map), angle, &text, &taken) else { continue };
        canvas.draw_widget(Line::raw(text).style(style(heard.kind, depth)), area);
        taken.push(area);
    }
}

/// Returns true if the sound means that a guard has noticed the player or is about to strike.
fn is_threat(kind: SoundKind) -> bool {
    sign(kind).1.is_some()
}

/// The character for a kind of sound, and a word for what the guard does if that threatens the
/// player.
const fn sign(kind: SoundKind) -> (char, Option<&'static str>) {
    match kind {
        SoundKind::Walking => ('.', None),
        SoundKind::Running => (':', None),
        SoundKind::Landing => ('_', None),
        SoundKind::Splash => ('~', None),
        SoundKind::Door => ('+', None),
        SoundKind::Mechanism => ('=', None),
        SoundKind::Spikes => ('i', None),
        SoundKind::Knock => ('o', None),
        SoundKind::Crash => ('*', None),
        SoundKind::Blow => ('x', None),
        SoundKind::Cry => ('a', None),
        SoundKind::Fall => ('u', None),
        SoundKind::Wonder => ('?', Some("wonders")),
        SoundKind::GiveUp => (',', None),
        SoundKind::Shout => ('!', Some("shouts")),
        SoundKind::Bell => ('&', Some("rings")),
        SoundKind::Bark => ('w', Some("barks")),
        SoundKind::Windup => ('/', Some("attacks")),
        SoundKind::Draw => (')', Some("aims")),
        SoundKind::Shot => ('-', Some("shoots")),
        SoundKind::Swing => ('\\', Some("strikes")),
    }
}

/// The angle from the direction of view to `bearing`: clockwise, from −180 to 180 degrees.
fn angle(bearing: Heading, heading: Heading) -> f64 {
    let clockwise = bearing.degrees() - heading.degrees();
    (clockwise + 540.0).rem_euclid(360.0) - 180.0
}

/// A side of the picture, or of the ring that shows sounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RingSide {
    Ahead,
    Right,
    Behind,
    Left,
}

impl RingSide {
    fn of(angle: f64) -> Self {
        match angle {
            -45.0..=45.0 => Self::Ahead,
            45.0..=135.0 => Self::Right,
            -135.0..=-45.0 => Self::Left,
            _ => Self::Behind,
        }
    }
}

fn mark(heard: &Heard, heading: Heading, has_words: bool) -> String {
    let strength = usize::from(heard.strength.clamp(1, 3));
    let (character, word) = sign(heard.kind);
    let characters: String = std::iter::repeat_n(character, strength).collect();
    let characters = match (word.filter(|_| has_words), RingSide::of(angle(heard.bearing, heading)))
    {
        (None, _) => characters,
        (Some(word), RingSide::Right) => format!("{word} {characters}"),
        (Some(word), _) => format!("{characters} {word}"),
    };
    match RingSide::of(angle(heard.bearing, heading)) {
        RingSide::Ahead => format!("^{characters}"),
        RingSide::Right => format!("{characters}>"),
        RingSide::Behind => format!("v{characters}"),
        RingSide::Left => format!("<{characters}"),
    }
}

/// The position of `text` on the ring, or the nearest free position.
fn free_place(
    (ring, map): (Rect, Option<Rect>),
    angle: f64,
    text: &str,
    taken: &[Rect],
) -> Option<Rect> {
    let width = text.chars().count() as u16;
    let place = place(ring, angle, width);
    let along_a_side = matches!(RingSide::of(angle), RingSide::Left | RingSide::Right);
    let moved = |by: i32| {
        let (by_x, by_y) = if along_a_side { (0, by) } else { (by * i32::from(width + 1), 0) };
        let x = u16::try_from(i32::from(place.x) + by_x).ok()?;
        let y = u16::try_from(i32::from(place.y) + by_y).ok()?;
        let moved = beside(map, Rect { x, y, ..place });
        (ring.intersection(moved) == moved).then_some(moved)
    };
    let nearest = (0..MAX as i32).flat_map(|by| [by, -by]);
    nearest.filter_map(moved).find(|place| taken.iter().all(|other| !other.intersects(*place)))
}

/// The position itself, or the nearest one to its left that is beside the `map` panel.
fn beside(map: Option<Rect>, place: Rect) -> Rect {
    match map {
        Some(map) if map.intersects(place) => {
            Rect { x: map.x.saturating_sub(place.width), ..place }
        }
        _ => place,
    }
}

/// The position of a mark that is `width` columns wide.
fn place(ring: Rect, angle: f64, width: u16) -> Rect {
    let spare = [ring.width - width, ring.height - 1].map(f64::from);
    // The position along the side, from 0 to 1: from left to right, or from top to bottom.
    let along = |angle: f64| ((angle + 45.0) / 90.0).clamp(0.0, 1.0);
    let (x, y) = match RingSide::of(angle) {
        RingSide::Ahead => (along(angle), 0.0),
        RingSide::Right => (1.0, along(angle - 90.0)),
        RingSide::Left => (0.0, 1.0 - along(angle + 90.0)),
        RingSide::Behind => (1.0 - along(angle - 180.0_f64.copysign(angle)), 1.0),
    };
    Rect {
        x: ring.x + (x * spare[0]).round() as u16,
        y: ring.y + (y * spare[1]).round() as u16,
        width,
        height: 1,
    }
}

fn style(kind: SoundKind, depth: ColorDepth) -> Style {
    if is_threat(kind) {
        colored(depth, 9, 203, (0xff, 0x60, 0x50)).add_modifier(Modifier::BOLD)
    } else {
        colored(depth, 14, 153, (0xa8, 0xd0, 0xf0))
    }
}

/// The style with this colour among 16, among 256 and among all colours, on black: the background of a light
/// terminal would make it hard to read.
fn colored(depth: ColorDepth, of_16: u8, of_256: u8, (red, green, blue): (u8, u8, u8)) -> Style {
    let (color, black) = match depth {
        ColorDepth::Mono => return Style::new().add_modifier(Modifier::REVERSED),
        ColorDepth::Indexed16 => (Color::Indexed(of_16), Color::Indexed(0)),
        ColorDepth::Indexed256 => (Color::Indexed(of_256), Color::Indexed(16)),
        ColorDepth::True => (Color::Rgb(red, green, blue), Color::Rgb(0, 0, 0)),
    };
    Style::new().fg(color).bg(black)
}

/// The suspicion of a guard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Suspicion {
    /// The guard notices something, or wonders. The number of thirds of what raises the alarm.
    Wary(u8),
    /// The guard has lost a player, and looks for them.
    Searching,
    /// The guard follows a player.
    Alarmed,
}

/// The number of rows at the top without marks: for the compass, and for sounds from ahead.
const ROWS_ABOVE_MARKS: f64 = 2.0;
/// Less awareness than this shows no mark.
const MIN_AWARENESS: u16 = 30;

impl Suspicion {
    /// The suspicion of `guard`; `None` if the guard is calm.
    pub(crate) fn of(guard: &GuardView) -> Option<Self> {
        let awareness = guard.awareness.min(GuardView::SURE - 1);
        let thirds = (3 * awareness / GuardView::SURE) as u8 + 1;
        match guard.mood {
            Mood::Chasing | Mood::Attacking => Some(Self::Alarmed),
            Mood::Searching => Some(Self::Searching),
            Mood::Wondering => Some(Self::Wary(thirds)),
            Mood::OnDuty | Mood::Returning if awareness >= MIN_AWARENESS => {
                Some(Self::Wary(thirds))
            }
            Mood::OnDuty | Mood::Returning | Mood::Asleep | Mood::Down => None,
        }
    }

    fn text(self) -> &'static str {
        match self {
            Self::Wary(1) => "?",
            Self::Wary(2) => "??",
            Self::Wary(_) => "???",
            Self::Searching => "<?>",
            Self::Alarmed => "!!!",
        }
    }

    /// The colours from pale yellow to red.
    fn style(self, depth: ColorDepth) -> Style {
        let (of_16, of_256, color) = match self {
            Self::Wary(1) => (15, 230, (0xff, 0xf0, 0xc0)),
            Self::Wary(_) => (11, 221, (0xff, 0xd8, 0x50)),
            Self::Searching => (14, 215, (0xff, 0xa8, 0x48)),
            Self::Alarmed => (9, 203, (0xff, 0x60, 0x50)),
        };
        colored(depth, of_16, of_256, color).add_modifier(Modifier::BOLD)
    }
}

/// The colours of a flash.
const HURT: Rgb = Rgb::new(0xe8, 0x18, 0x10);
const GAIN: Rgb = Rgb::new(0xff, 0xd0, 0x40);
/// The opacity of the tint at the edge, out of 255. Gold needs as much as this to differ from red in a
/// dark picture for people without green cones.
const HURT_OPACITY: f64 = 210.0;
const GAIN_OPACITY: f64 = 175.0;
/// The width of the tint as a fraction of the picture's shorter side, on the side of the blow and
/// on the other sides.
const NEAR_SIDE: f64 = 0.3;
const OTHER_SIDES: f64 = 0.08;

/// The side of the picture from which the player was hurt; `None` if the flash covers all sides.
fn side_of(flash: &Flash, heading: Heading) -> Option<RingSide> {
    let FlashKind::Hurt { bearing: Some(bearing) } = flash.kind else { return None };
    Some(RingSide::of(angle(bearing, heading)))
}

/// Tints the pixels at the edge of `frame`.
pub(crate) fn tint(frame: &mut Frame, flash: &Flash, heading: Heading) {
    let (color, opacity) = match flash.kind {
        FlashKind::Hurt { .. } => (HURT, HURT_OPACITY),
        FlashKind::Gain => (GAIN, GAIN_OPACITY),
    };
    let opacity = opacity * flash.strength();
    let hit = side_of(flash, heading);
    // A flash without a direction is thin on all sides.
    let (width, height) = (f64::from(frame.width()), f64::from(frame.height()));
    // The pixels of half blocks are square. The pixels of other glyphs are higher than wide.
    let aspect = frame.pixel_aspect().height_over_width();
    let side = width.min(height * aspect);
    let reach = |which| side * if hit == Some(which) { NEAR_SIDE } else { OTHER_SIDES };
    let share = |distance: f64, reach: f64| (1.0 - distance / reach.max(1.0)).max(0.0);
    for (y, row) in frame.rows_mut().enumerate() {
        let (top, bottom) = ((y as f64 + 0.5) * aspect, (height - y as f64 - 0.5) * aspect);
        let rows = share(top, reach(RingSide::Ahead)).max(share(bottom, reach(RingSide::Behind)));
        for (x, pixel) in row.iter_mut().enumerate() {
            let (left, right) = (x as f64 + 0.5, width - x as f64 - 0.5);
            let columns =
                share(left, reach(RingSide::Left)).max(share(right, reach(RingSide::Right)));
            let alpha = opacity * rows.max(columns);
            if alpha >= 1.0 {
                *pixel = color.over(*pixel, alpha as u8);
            }
        }
    }
}

/// Draws the edge in characters, for a picture without colours.
fn draw_edge(canvas: &mut impl Canvas, picture: Rect, flash: &Flash, heading: Heading) {
    let character = match flash.kind {
        FlashKind::Hurt { .. } => '#',
        FlashKind::Gain => '+',
    };
    let hit = side_of(flash, heading);
    let is_hit = |side| hit.is_none_or(|only| only == side);
    let mut draw = |x, y| canvas.draw_character(x, y, character, [Color::Reset; 2]);
    let (last_column, last_row) =
        (picture.right().saturating_sub(1), picture.bottom().saturating_sub(1));
    for x in picture.left()..picture.right() {
        let rows = [(RingSide::Ahead, picture.top()), (RingSide::Behind, last_row)];
        rows.into_iter().filter(|row| is_hit(row.0)).for_each(|(_, y)| draw(x, y));
    }
    for y in picture.top()..picture.bottom() {
        let columns = [(RingSide::Left, picture.left()), (RingSide::Right, last_column)];
        columns.into_iter().filter(|column| is_hit(column.0)).for_each(|(_, x)| draw(x, y));
    }
}

/// The names of the directions, clockwise from east, which is heading 0.
const NAMES: [&str; 8] = ["E", "SE", "S", "SW", "W", "NW", "N", "NE"];
/// The number of columns between two names. It is odd, and a third of it stands for 15 degrees.
const ADVANCE: i32 = 9;
/// The maximum width of the strip, in columns.
const MAX_COLUMNS: u16 = 31;

/// Draws the strip in the middle of the first row of the picture.
fn draw_compass(canvas: &mut impl Canvas, picture: Rect, heading: Heading) {
    let width = MAX_COLUMNS.min(picture.width / 3);
    if width < 7 {
        return;
    }
    let area = Rect { x: picture.x + (picture.width - width) / 2, width, height: 1, ..picture };
    let strip = Line::raw(strip(heading, width.into()));
    canvas.draw_widget(strip.style(Style::new().add_modifier(Modifier::REVERSED)), area);
}

/// The directions around `heading`, with `heading` in the middle.
fn strip(heading: Heading, width: usize) -> String {
    let around = NAMES.len() as i32 * ADVANCE;
    let middle = (heading.degrees() / 360.0 * f64::from(around)).round() as i32;
    let letter = |column: usize| {
        let at = (middle + column as i32 - width as i32 / 2).rem_euclid(around);
        // A two-letter name begins at the column of its direction.
        let (name, offset) = (NAMES[(at / ADVANCE) as usize], at % ADVANCE);
        match (name.as_bytes().get(offset as usize), offset % (ADVANCE / 3)) {
            (Some(&letter), _) => char::from(letter),
            (None, 0) => '.',
            (None, _) => ' ',
        }
    };
    (0..width).map(letter).collect()
}

/// The state of the minimap between frames.
#[derive(Clone, Debug, Default)]
pub struct MapPanel {
    /// `true` if the map is shown.
    pub is_shown: bool,
    display: MapDisplay,
    /// `true` if the panel takes less of the picture's width than at home.
    is_narrow: bool,
    explored: Explored,
    zoom: i32,
    /// The displacement of the visible part from the player, in cells.
    offset: DVec2,
    /// The numbers of cells visible in the last drawing, from left to right and from top to bottom.
    extent: DVec2,
}

/// The maximum number of zoom levels in each direction.
const MAX_ZOOM: i32 = 6;
/// The widest picture with a narrow map at home, in columns.
const NARROW_COLUMNS: u16 = 80;
/// The fraction of the visible part by which one key press moves the map.
const MOVED_BY: f64 = 0.25;

impl MapPanel {
    /// A panel that displays this content.
    pub fn new(display: MapDisplay) -> Self {
        Self { is_shown: display != MapDisplay::Off, display, ..Self::default() }
    }

    /// The panel, narrower than at home: other players are in the picture beside it.
    #[must_use]
    pub fn narrow(self) -> Self {
        Self { is_narrow: true, ..self }
    }

    /// Returns true if the panel is narrow in a picture with `columns` columns. In a picture of up to
    /// 80 columns at home, it is narrow until the player enlarges the map.
    fn is_narrow_in(&self, columns: u16) -> bool {
        self.is_narrow || (columns <= NARROW_COLUMNS && self.zoom <= 0)
    }

    /// The content of the map, as the settings page shows it.
    pub fn display(&self) -> MapDisplay {
        match (self.is_shown, self.display) {
            (false, _) => MapDisplay::Off,
            (true, MapDisplay::All) => MapDisplay::All,
            (true, _) => MapDisplay::Seen,
        }
    }

    /// Resets the panel for a new level.
    pub fn begin_level(&mut self) {
        self.explored = Explored::default();
        self.offset = DVec2::ZERO;
    }

    /// Adds the cells that `camera` sees in a picture with `columns` columns.
    pub(crate) fn explore(&mut self, game: &Game, camera: &Camera, columns: u16) {
        if self.display == MapDisplay::All {
            return;
        }
        if let Some(corner) = game.corner() {
            self.explored.follow(corner);
        }
        self.explored.look(game.world(), camera, columns.into());
    }

    /// The fraction of the level that the player has seen, if that is counted.
    pub(crate) fn share_seen(&self, game: &Game) -> Option<f64> {
        let is_counted = self.display != MapDisplay::All && game.corner().is_none();
        is_counted.then(|| self.explored.share())
    }

    /// Changes the zoom or the visible part.
    pub fn change(&mut self, change: MapChange) {
        let by = self.extent * MOVED_BY;
        match change {
            MapChange::Larger => self.zoom = (self.zoom + 1).min(MAX_ZOOM),
            MapChange::Smaller => self.zoom = (self.zoom - 1).max(-MAX_ZOOM),
            MapChange::North => self.offset.y -= by.y,
            MapChange::South => self.offset.y += by.y,
            MapChange::West => self.offset.x -= by.x,
            MapChange::East => self.offset.x += by.x,
            MapChange::Center => (self.zoom, self.offset) = (0, DVec2::ZERO),
        }
    }

    /// The minimap of `game`, with the camera and the rays of the picture.
    pub(crate) fn minimap<'a>(
        &'a self,
        game: &'a Game,
        camera: &'a Camera,
        view: &'a View,
    ) -> Minimap<'a> {
        self.plain(game, camera).seen(view.distances()).zoom(self.zoom).offset(self.offset)
    }

    /// The known part of the map of `game`, around `camera`.
    pub(crate) fn plain<'a>(&'a self, game: &'a Game, camera: &'a Camera) -> Minimap<'a> {
        let map = Minimap::new(game.world(), camera);
        match self.display {
            MapDisplay::All => map,
            MapDisplay::Seen | MapDisplay::Off => map.explored(&self.explored),
        }
    }

    /// Records that `extent` cells were visible. Limits the offset to the map, so that the player
    /// needs no extra key presses to come back from outside.
    pub(crate) fn shown(&mut self, extent: DVec2, game: &Game, camera: &Camera) {
        let grid = game.world().grid();
        let size = grid.extent();
        self.extent = extent.min(size);
        let half = self.extent / 2.0;
        let center = (camera.position() + self.offset).clamp(half, size - half);
        if self.offset != DVec2::ZERO {
            self.offset = center - camera.position();
        }
    }
}

#[cfg(test)]
mod tests;

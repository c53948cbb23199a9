//! Generated levels: golden pictures, equality on all machines, and mistakes in the options.

use std::fmt::Write as _;
use std::sync::Arc;

use crate::support::{complaint_about, output_of};
use cellcaster::game::{Game, Intent, Intents};
use cellcaster::generate::{
    CHUNK_SIDE, Chunk, ChunkArea, Extent, GeneratedLevel, Generator, Site, Terrain,
};
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::FieldOfView;
use proptest::prelude::*;

#[test]
fn every_generator_looks_as_it_did() {
    for (generator, seed, start) in [
        ("maze", "7", "1,1"),
        ("maze", "3", "1000000000,-1000000000"),
        ("cave", "7", "1,1"),
        ("cave", "11", "1000000000,-1000000000"),
        ("office", "7", "6,4"),
        ("office", "1", "20,20"),
    ] {
        let level = ["--generate", generator, "--seed", seed, "--start", start];
        let arguments = [&["snapshot"][..], &level, &["--format", "png"]].concat();
        let name = format!("{generator}_{seed}_png.png");
        insta::assert_binary_snapshot!(&name, output_of(&arguments));
    }
}

#[test]
fn the_same_seed_gives_the_same_level() {
    let sites = [(0, 0), (1_000_000_000, -1_000_000_000), (i64::MIN, i64::MAX)];
    for generator in Generator::ALL {
        let level = generator.level(7, Extent::Endless).unwrap();
        let mut drawn = String::new();
        for (column, row) in sites {
            let chunk = level.chunk(Site { column, row }.chunk().0);
            writeln!(drawn, "around {column}, {row}:\n{chunk}").unwrap();
        }
        insta::assert_snapshot!(format!("{}_of_seed_7", generator.name()), drawn);
    }
}

#[test]
fn a_camera_position_is_a_place_in_the_level() {
    let level = Generator::Maze.level(7, Extent::Endless).unwrap();
    for place in [0, 1_000_000_000, -1_000_000_000] {
        let Site { column, row } = level.start_near(Site { column: place, row: -place }).unwrap();
        let start = format!("{column},{row}");
        let maze = ["snapshot", "--generate", "maze", "--seed", "7"];
        let at_start = output_of(&[&maze[..], &["--start", &start]].concat());
        let looks = [0, 90, 180, 270].map(|heading| {
            let camera = format!("{},{},{heading}", column as f64 + 0.5, row as f64 + 0.5);
            output_of(&[&maze[..], &["--camera", &camera]].concat())
        });
        assert!(looks.contains(&at_start), "{start}");
    }
}

#[test]
fn each_mistake_is_reported_in_one_sentence() {
    let complaints = [
        &["play", "--generate", "swamp"][..],
        &["play", "--generate"],
        &["snapshot", "--seed", "7"],
        &["snapshot", "cellar", "--generate", "maze"],
        &["snapshot", "--generate", "maze", "--seed", "-1"],
        &["snapshot", "--generate", "maze", "--level-size", "7x8"],
        &["snapshot", "--generate", "maze", "--level-size", "8x1000000001"],
        &["snapshot", "--generate", "cave", "--start", "here"],
        &["snapshot", "--generate", "cave", "--level-size", "64x64", "--start", "64,9"],
        &["snapshot", "--generate", "cave", "--level-size", "64x64", "--camera", "-9,9,0"],
        &["replay", "walk.script", "--level-size", "64x64"],
        &["play", "--genrate", "maze"],
    ]
    .map(|arguments| format!("{}\n{}", arguments.join(" "), complaint_about(arguments)));
    insta::assert_snapshot!(complaints.join("\n"));
}

/// A level with the same content in every chunk.
#[derive(Debug)]
struct Repeated;

impl Terrain for Repeated {
    fn seed(&self) -> u64 {
        0
    }

    fn legend(&self) -> String {
        "grid = '''\n#####\n#@oX#\n#####\n'''\nfloor = \"flagstone\"\n[tiles]\n\
         \"#\" = { wall = \"brick\" }\n\"o\" = { pillar = \"marble\", radius = 0.3 }\n\
         [things]\n\"@\" = { start = 0 }\n\"X\" = { exit = true }\n"
            .to_owned()
    }

    fn chunk(&self, _: &ChunkArea) -> Chunk {
        let mut chunk = Chunk::full_of(b'.');
        for place in (0..CHUNK_SIDE).step_by(5) {
            chunk.set(place, 7, b'#');
            chunk.set(9, place, b'o');
        }
        chunk
    }

    fn hub(&self, _: &ChunkArea) -> Option<(usize, usize)> {
        Some((3, 3))
    }
}

fn intents() -> impl Strategy<Value = Intents> {
    use Intent::{Forward, Run, StrafeLeft, StrafeRight, TurnLeft, TurnRight};
    let others =
        prop::sample::subsequence(vec![StrafeLeft, StrafeRight, TurnLeft, TurnRight], 0..2);
    others.prop_map(|others| others.into_iter().chain([Forward, Run]).collect())
}

fn picture(game: &Game) -> Frame {
    let mut frame = Frame::new(FrameSize::new(40, 30).unwrap(), PixelAspect::SQUARE);
    Renderer::new().render(game.world(), &game.camera(FieldOfView::default()), &mut frame);
    frame
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// In a level that is the same everywhere, pictures are equal at every distance, bit for bit.
    #[test]
    fn equal_chunks_give_equal_pictures(
        (column, row) in (
            prop::sample::select(vec![31_250_000_i64, -31_250_000, i64::MAX >> 5, i64::MIN >> 5]),
            prop_oneof![-1_000_000_i64..1_000_000, Just(i64::MIN >> 5)],
        ),
        walk in prop::collection::vec((intents(), 30..300), 2..8),
    ) {
        let side = CHUNK_SIDE as i64;
        let level = GeneratedLevel::new(Arc::new(Repeated), Extent::Endless).unwrap();
        let far = Site { column: column.wrapping_mul(side) + 3, row: row.wrapping_mul(side) + 3 };
        let home = Site { column: 3, row: 3 };
        let mut at_home = Game::in_level(level.clone(), home).unwrap();
        let mut far_away = Game::in_level(level, far).unwrap();
        for (intents, steps) in walk {
            for _ in 0..steps {
                at_home.step(intents);
                far_away.step(intents);
            }
            let camera = |game: &Game| game.camera(FieldOfView::default());
            prop_assert_eq!(camera(&at_home), camera(&far_away));
            prop_assert!(picture(&at_home) == picture(&far_away));
            let position = camera(&at_home).position();
            prop_assert!(position.cmpge((64.0, 64.0).into()).all());
            prop_assert!(position.cmplt((128.0, 128.0).into()).all());
            let (here, there) = (at_home.site().unwrap(), far_away.site().unwrap());
            prop_assert_eq!(there.column.wrapping_sub(here.column), far.column.wrapping_sub(home.column));
            prop_assert_eq!(there.row.wrapping_sub(here.row), far.row.wrapping_sub(home.row));
        }
    }

    /// The player is never inside anything, at any distance from the start.
    #[test]
    fn the_player_is_never_inside_a_wall(
        generator in prop::sample::select(&Generator::ALL),
        seed: u64,
        (column, row) in (any::<i64>(), any::<i64>()),
        walk in prop::collection::vec((intents(), 30..200), 2..8),
    ) {
        let level = generator.level(seed, Extent::Endless).unwrap();
        let mut game = Game::in_level(level, Site { column, row }).unwrap();
        for (intents, steps) in walk {
            for _ in 0..steps {
                game.step(intents);
            }
            let position = game.camera(FieldOfView::default()).position();
            let (column, row) = (position.x as i64, position.y as i64);
            let tile = game.world().grid().tile(column, row).unwrap();
            let is_shape = matches!(
                game.world().tile(tile).kind,
                cellcaster::world::TileKind::Shape(_)
            );
            prop_assert!(is_shape || !game.world().grid().is_solid(column, row));
        }
    }
}

/// A picture is neither too dark to read nor too bright for a dungeon.
#[test]
fn first_views_are_neither_too_dark_nor_too_bright() {
    for (generator, allowed) in
        [(Generator::Maze, 53..=140), (Generator::Cave, 53..=100), (Generator::Office, 60..=180)]
    {
        for seed in 1..=8 {
            let luma = mean_luma(&first_view(generator, seed));
            assert!(allowed.contains(&luma), "{} {seed}: {luma}", generator.name());
        }
    }
}

/// The first views of consecutive seeds differ, in position or in materials.
#[test]
fn offices_differ_from_the_first_view() {
    let views: Vec<Frame> = (1..=8).map(|seed| first_view(Generator::Office, seed)).collect();
    for (index, one) in views.iter().enumerate() {
        for other in &views[index + 1..] {
            let pixels = one.rows().flatten().zip(other.rows().flatten());
            let differ =
                pixels.filter(|(one, other)| one.luma().abs_diff(other.luma()) > 16).count();
            assert!(differ > 80 * 48 / 5, "{differ} pixels from view {}", index + 1);
        }
    }
}

/// The first view of a level, in a terminal of 80×24 cells.
fn first_view(generator: Generator, seed: u64) -> Frame {
    let level = generator.level(seed, Extent::Endless).unwrap();
    let start = level.start().unwrap();
    let game = Game::in_level(level, start).unwrap();
    let mut frame = Frame::new(FrameSize::new(80, 48).unwrap(), PixelAspect::SQUARE);
    Renderer::new().render(game.world(), &game.camera(FieldOfView::default()), &mut frame);
    frame
}

fn mean_luma(frame: &Frame) -> u64 {
    let pixels = || frame.rows().flatten();
    pixels().map(|pixel| u64::from(pixel.luma())).sum::<u64>() / pixels().count() as u64
}

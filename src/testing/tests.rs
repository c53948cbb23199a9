use std::fs;
use std::time::{Duration, Instant};

use proptest::prelude::*;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier};

use super::*;
use crate::map;
use crate::world::FieldOfView;

/// Every kind of symbol, colour and modifier.
fn everything() -> CellGrid {
    let mut buffer = Buffer::empty(Rect::new(0, 0, 24, 6));
    buffer.set_string(0, 0, "Text, bars | and 字 wide", Color::Red);
    buffer.set_string(0, 1, "bold", Color::LightBlue);
    buffer.set_string(5, 1, "both", Color::Indexed(208));
    buffer.set_style(Rect::new(0, 1, 4, 1), Modifier::BOLD);
    buffer.set_style(Rect::new(5, 1, 4, 1), Modifier::BOLD | Modifier::REVERSED);
    for (x, symbol) in ["", "\u{7}", "字", "x", "🇫", "🇷", "e\u{301}", "\u{FFFD}", "ab", "\u{200b}"]
        .iter()
        .enumerate()
    {
        buffer[(2 * x as u16, 2)].set_symbol(symbol);
        buffer[(2 * x as u16 + 1, 2)].set_symbol("|");
    }
    for x in 0..24 {
        let shade = 10 * x as u8;
        buffer[(x, 3)]
            .set_char('▀')
            .set_fg(Color::Rgb(shade, 60, 0))
            .set_bg(Color::Rgb(0, 60, shade));
        buffer[(x, 4)].set_bg(Color::Rgb(0x10, 0x10, 0x18));
    }
    buffer.into()
}

/// A grid of the first version can be read forever, and is written as it was.
#[test]
fn the_format_is_unchanged() {
    assert_grid!(everything(), "everything");
    let file = fs::read_to_string("src/testing/grids/everything.grid").unwrap();
    assert_eq!(everything().to_string(), file);
}

fn symbol() -> impl Strategy<Value = String> {
    const ODD: [&str; 14] = [
        "",
        "\n",
        "字",
        "🇫",
        "🇷",
        "\u{301}",
        "e\u{301}",
        "\u{FFFD}",
        "👨\u{200d}👩",
        "|",
        " ",
        "\u{a0}",
        "ab",
        "▀",
    ];
    prop_oneof![
        4 => Just(" ".to_owned()),
        4 => prop::sample::select(&ODD[..]).prop_map(str::to_owned),
        1 => any::<char>().prop_map(String::from),
    ]
}

fn color() -> impl Strategy<Value = Color> {
    const NAMED: [Color; 6] =
        [Color::Reset, Color::Black, Color::Gray, Color::DarkGray, Color::LightRed, Color::White];
    prop_oneof![
        prop::sample::select(&NAMED[..]),
        any::<u8>().prop_map(Color::Indexed),
        prop::sample::select(&[0, 1, 128, 255][..]).prop_map(|red| Color::Rgb(red, 8, 200)),
        any::<[u8; 3]>().prop_map(|[red, green, blue]| Color::Rgb(red, green, blue)),
    ]
}

fn grid() -> impl Strategy<Value = CellGrid> {
    (0_u16..14, 0_u16..12).prop_flat_map(|(columns, rows)| {
        let modifier = prop_oneof![3 => Just(0), 1 => any::<u16>()];
        let cell = (symbol(), color(), color(), modifier).prop_map(|(symbol, fg, bg, bits)| {
            let mut cell = Cell::default();
            cell.set_symbol(&symbol).set_fg(fg).set_bg(bg);
            cell.modifier = Modifier::from_bits_truncate(bits);
            cell
        });
        let cells = prop::collection::vec(cell, usize::from(columns) * usize::from(rows));
        cells.prop_map(move |content| {
            CellGrid(Buffer { area: Rect::new(0, 0, columns, rows), content })
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn a_text_reads_back_exactly(grid in grid()) {
        prop_assert_eq!(grid.to_string().parse::<CellGrid>(), Ok(grid));
    }

    #[test]
    fn no_text_panics(grid in grid(), place in any::<prop::sample::Index>(), new in "\\PC{0,3}", cut in 0_usize..9) {
        let mut characters: Vec<char> = grid.to_string().chars().collect();
        let place = place.index(characters.len());
        characters.splice(place..(place + cut).min(characters.len()), new.chars());
        let text: String = characters.into_iter().collect();
        if let Ok(read) = text.parse::<CellGrid>() {
            _ = read.compare(&grid, 0.0).to_string();
        }
    }
}

/// A hall of plain walls, with the pillar in this column.
fn hall(pillar: usize) -> CellGrid {
    let mut row = "#@............#".to_owned();
    row.replace_range(pillar..=pillar, "o");
    let map = format!(
        "floor = 'flagstone'\ngrid = '''\n###############\n#.............#\n{row}\n#.............#\n\
         ###############\n'''\n[tiles]\n'#' = {{ wall = 'brick' }}\n'o' = {{ pillar = 'marble', radius = 0.2 }}\n\
         [things]\n'@' = {{ start = 0 }}\n"
    );
    let world = map::parse_str(&map).unwrap();
    let camera = world.start_camera(FieldOfView::default());
    CellGrid::of(FirstPerson::new(&world, &camera), 80, 24)
}

#[test]
fn a_change_alters_only_the_rows_that_show_it() {
    let (before, after) = (hall(9), hall(10));
    let differences = before.compare(&after, 0.0).differences;
    let mut rows: Vec<u16> = differences.iter().map(|difference| difference.row).collect();
    rows.dedup();
    assert!((3..12).contains(&rows.len()), "{rows:?}");
    let (before, after) = (before.to_string(), after.to_string());
    assert_eq!(before.lines().count(), after.lines().count());
    let changed: Vec<&str> = before
        .lines()
        .zip(after.lines())
        .filter(|(before, after)| before != after)
        .map(|(before, _)| before)
        .collect();
    for line in &changed {
        let row = line.split('|').next().unwrap().trim().parse().unwrap();
        assert!(rows.contains(&row), "{line}");
    }
}

#[test]
fn a_grid_without_colours_is_its_glyphs() {
    let grid = CellGrid::drawn(4, 1, |frame| frame.render_widget("Hi", frame.area()));
    assert_eq!(grid.to_string(), "cellcaster grid 1: 4x1\n\nglyphs\n   0---\n0 |Hi  |\n");
    assert_eq!(grid.to_string().parse(), Ok(grid));
}

/// A grid of one cell.
fn cell(symbol: char, fg: Color, bg: Color) -> CellGrid {
    let mut buffer = Buffer::empty(Rect::new(0, 0, 1, 1));
    buffer[(0, 0)].set_char(symbol).set_fg(fg).set_bg(bg);
    buffer.into()
}

#[test]
fn cells_are_compared_by_what_they_show() {
    let [red, dark, blue] =
        [(200, 0, 0), (196, 0, 0), (0, 0, 200)].map(|(r, g, b)| Color::Rgb(r, g, b));
    let far = |wanted: &CellGrid, got: &CellGrid| wanted.compare(got, 0.0).differences[0].delta_e;
    assert_eq!(far(&cell('▀', red, blue), &cell('▄', blue, red)), Some(0.0));
    assert_eq!(far(&cell(' ', blue, red), &cell('█', red, blue)), Some(0.0));
    assert!((0.1..2.3).contains(&far(&cell('▀', red, blue), &cell('▄', blue, dark)).unwrap()));
    assert!(far(&cell('▀', red, blue), &cell('▄', red, blue)).unwrap() > 50.0);
    assert_eq!(far(&cell('a', red, blue), &cell('b', red, blue)), None);
    assert_eq!(far(&cell('a', red, blue), &cell('a', red, Color::Reset)), None);
    assert_eq!(
        far(&cell('a', Color::Indexed(196), blue), &cell('a', Color::Rgb(255, 0, 0), blue)),
        Some(0.0)
    );
}

#[test]
fn a_tolerance_permits_near_colours_and_nothing_else() {
    let [red, dark] = [200, 196].map(|red| Color::Rgb(red, 0, 0));
    let differ = |wanted, got: CellGrid, tolerance| {
        !CellGrid::compare(&wanted, &got, tolerance).differences.is_empty()
    };
    assert!(!differ(cell('▀', red, dark), cell('▀', red, dark), 0.0));
    assert!(differ(cell('▀', red, dark), cell('▀', red, red), 0.0));
    assert!(!differ(cell('▀', red, dark), cell('▀', red, red), 2.3));
    assert!(differ(cell('▀', red, dark), cell('▄', dark, red), 0.0), "the characters differ");
    assert!(!differ(cell('▀', red, dark), cell('▄', dark, red), 0.1));
    assert!(differ(cell('a', red, dark), cell('b', red, dark), 1000.0));
    assert!(
        differ(cell('a', red, dark), CellGrid::drawn(2, 1, |_| {}), 1000.0),
        "the sizes differ"
    );
}

#[test]
fn each_fault_of_a_file_is_a_sentence() {
    let text = everything().to_string();
    let fault = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let fault = text.replacen(from, to, 1).parse::<CellGrid>().unwrap_err();
        format!("the file {fault}\n")
    };
    let faults = [
        fault("cellcaster grid", "grid"),
        fault("grid 1", "grid 2"),
        fault("24x6", "24"),
        fault("24x6", "65535x65535"),
        fault("glyphs", "glyph"),
        fault("Text", "Texts"),
        fault(" 7 ", " 110000 "),
        fault("5 |", "6 |"),
        fault("colours", "colors"),
        fault("LightBlue", "Lightish"),
        fault("r  red      Red\n", ""),
        fault("#003c00", "#003c0"),
        fault(" #003c00", ""),
        fault("\nbackground", ""),
        fault("5-8", "5-24"),
        fault("reversed", "inverted"),
        CellGrid::from_json("{}").unwrap_err().to_string() + "\n",
        CellGrid::from_json(r#"{"cols":1,"rows":2,"cells":[[]]}"#).unwrap_err().to_string() + "\n",
        CellGrid::from_json(r#"{"cols":1,"rows":1,"cells":[[{"ch":"a","fg":"red","bg":null}]]}"#)
            .unwrap_err()
            .to_string(),
    ];
    insta::assert_snapshot!(faults.concat());
}

#[test]
fn large_files_are_rejected_in_time() {
    let begun = Instant::now();
    let endless = io::repeat(b'[');
    assert_eq!(CellGrid::read_from(endless).unwrap_err().to_string(), "is larger than 16 MiB");
    let lists = format!("{{\"cols\":1,\"rows\":1,\"cells\":[{}[]]}}", "[],".repeat(5 << 20));
    assert!(CellGrid::read_from(lists.as_bytes()).is_err());
    let colors =
        format!("cellcaster grid 1: 512x512\n\nglyphs\n ruler\n{}", "0 |a|\n".repeat(1 << 20));
    assert!(CellGrid::read_from(colors.as_bytes()).is_err());
    assert!(CellGrid::read("/dev/zero".as_ref()).is_err());
    let (wide, high) = (CellGrid::blank(65535, 1).unwrap(), CellGrid::blank(1, 65535).unwrap());
    assert_eq!(wide.compare(&high, 0.0).cells, 2 * 65535 - 1);
    assert!(begun.elapsed() < Duration::from_secs(20), "{:?}", begun.elapsed());
}

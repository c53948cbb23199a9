//! Maps of the editor Tiled: there and back, and the reports on their faults.

use std::error::Error;
use std::fs;
use std::path::Path;

use allocation_counter::measure;
use cellcaster::map::tiled::{export, import, is_tiled, load};
use cellcaster::map::{self, Folder, Level, NoFiles, TextureFiles, builtin};

type Outcome = Result<(), Box<dyn Error>>;

/// Returns whether a map file is the same level after a way through Tiled.
fn is_same(text: &str, name: &str, files: &dyn TextureFiles) -> Result<bool, Box<dyn Error>> {
    let before = map::parse_level(text, name, files)?;
    let there = export(text, name, "tiles.png", files)?;
    let back = import(&there.map, name, files)?;
    // The text is a map file as well.
    let again = map::parse_level(&back.text, name, files)?;
    Ok(back.level == before && again == before)
}

#[test]
fn levels_are_the_same_after_a_way_through_tiled() -> Outcome {
    for level in builtin::LEVELS {
        assert!(is_same(level.text, level.name, &NoFiles)?, "{}", level.name);
    }
    Ok(())
}

#[test]
fn maps_of_the_gallery_and_of_tests_are_the_same_after_a_way_through_tiled() -> Outcome {
    let mut count = 0;
    for folder in ["maps/gallery", "tests/maps"] {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            let name = path.display().to_string();
            if path.extension().is_none_or(|it| it != "toml") {
                continue;
            }
            let text = fs::read_to_string(&path)?;
            let files = Folder::of(&path);
            if let Level::Space(_) = map::parse_level(&text, &name, &files)? {
                let faults = export(&text, &name, "tiles.png", &files).unwrap_err();
                assert!(faults.to_string().contains("is a map of bodies"), "{faults}");
                continue;
            }
            assert!(is_same(&text, &name, &files)?, "{name}");
            count += 1;
        }
    }
    assert!(count > 30, "where are the maps?");
    Ok(())
}

/// A map with a tileset in a file of its own, compressed tiles, a group, a patrol as a line, a plate
/// and areas.
#[test]
fn a_map_drawn_in_tiled_becomes_a_map_file() -> Outcome {
    let path = Path::new("tests/tiled/yard.tmx");
    let import = load(path, &Folder::of(path))?;
    let pictures: Vec<&str> = import.pictures.keys().map(String::as_str).collect();
    assert_eq!(pictures, ["yard-0-0.png", "yard-16-0.png"]);
    insta::assert_snapshot!(import.text);
    Ok(())
}

#[test]
fn every_bad_map_of_tiled_is_refused_with_a_report() -> Outcome {
    let folder = Path::new("tests/bad_tiled");
    let mut count = 0;
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if !is_tiled(&path) {
            continue;
        }
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let faults = load(&path, &Folder::of(&path)).err();
        let faults = faults.ok_or_else(|| format!("{name} was accepted"))?;
        insta::assert_snapshot!(format!("tiled_{name}"), faults);
        count += 1;
    }
    assert!(count > 10, "where are the bad maps?");
    Ok(())
}

/// A Tiled map with this side and this content.
fn tmx(side: u32, content: &str) -> String {
    format!(
        "<map orientation='orthogonal' width='{side}' height='{side}' tilewidth='8' \
         tileheight='8'>{content}</map>"
    )
}

/// Layers of tiles with this number, which are packed.
fn packed_layers(count: usize, side: u32, gid: u32) -> Result<String, Box<dyn Error>> {
    let tiles = gid.to_le_bytes().repeat((side * side) as usize);
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    std::io::Write::write_all(&mut packer, &tiles)?;
    let packed = packer.finish()?;
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in packed.chunks(3) {
        let bits = three.iter().fold(0, |bits, &byte| bits << 8 | u32::from(byte));
        let bits = bits << (8 * (3 - three.len()));
        text.extend(
            (0..=three.len()).map(|at| char::from(digits[(bits >> (18 - 6 * at) & 63) as usize])),
        );
    }
    let layer = format!(
        "<layer name='walls'><data encoding='base64' compression='zlib'>{text}</data></layer>"
    );
    Ok(layer.repeat(count))
}

#[test]
fn a_map_of_tiled_under_a_megabyte_needs_bounded_memory() -> Outcome {
    let set = "<tileset firstgid='1' tilecount='1'><tile id='0' type='wall'/></tileset>";
    let start = "<object id='1' type='start' x='4' y='4'/>";
    let many = |part: &str| part.repeat(1_000_000 / part.len());
    let objects = |part: &str| format!("{set}<objectgroup>{start}{}</objectgroup>", many(part));
    let maps = [
        tmx(4, &many("<group>")),
        tmx(4, &format!("<a {}/>", many("b='' "))),
        tmx(4, &many("<a b='&lt;'/>")),
        tmx(4, &many("<tileset/>")),
        tmx(4, &format!("<tileset firstgid='1'>{}</tileset>", many("<tile id='1'/>"))),
        tmx(4, &objects("<object x='9' y='9' type='exit'/>")),
        tmx(2000, &objects("<object width='16000' height='16000' type='water'/>")),
        tmx(400, &objects("<object width='3200' height='3200' type='water'/>")),
        tmx(4, &objects("<object x='1' y='1'><polyline points='0,0 1,1'/></object>")),
        tmx(
            4,
            &format!(
                "{set}<objectgroup><object><polyline points='{}'/></object></objectgroup>",
                many("0,0 ")
            ),
        ),
        tmx(4, &format!("<properties>{}</properties>", many("<property name='a' value=''/>"))),
        tmx(4000, &packed_layers(1, 4000, 1)?),
        tmx(
            2000,
            &format!("{set}{}<objectgroup>{start}</objectgroup>", packed_layers(20, 2000, 1)?),
        ),
        tmx(64, &format!("{set}{}<objectgroup>{start}</objectgroup>", packed_layers(1000, 64, 1)?)),
        tmx(4_000_000_000, "<objectgroup/>"),
        tmx(4_000_000_000, "<layer><data encoding='csv'>1</data></layer>"),
        format!("{{\"layers\":{}", "[".repeat(1_000_000)),
        format!(
            "{{\"width\":1,\"height\":1,\"tilewidth\":1,\"tileheight\":1,\"layers\":[{}{{}}]}}",
            many("{},")
        ),
    ];
    for map in maps {
        let mut read = None;
        let used = measure(|| read = Some(import(&map, "map", &NoFiles)));
        let start: String = map.chars().skip(70).take(60).collect();
        assert!(used.bytes_max <= 256 << 20, "{} bytes for {start:?}", used.bytes_max);
        let faults = read.and_then(Result::err).ok_or_else(|| format!("{start:?} was accepted"))?;
        assert!(faults.to_string().len() < 1 << 20, "{start:?}");
    }
    Ok(())
}

#[test]
fn a_large_picture_is_cut_within_bounds() -> Outcome {
    let tiles: Vec<String> = (1..=60).map(|gid| gid.to_string()).collect();
    let tiles = tiles.join(",");
    let set = |columns| {
        format!(
            "<tileset firstgid='1' tilewidth='16' tileheight='16' tilecount='60' columns='{columns}'>\
             <image source='yard.png'/></tileset>"
        )
    };
    let layer = format!("<layer name='floor'><data encoding='csv'>{tiles}</data></layer>");
    let map = format!(
        "<map width='60' height='1' tilewidth='8' tileheight='8'>{}{layer}<objectgroup>\
         <object type='start' x='4' y='4'/></objectgroup></map>",
        set(60)
    );
    let files = Folder::of(Path::new("tests/tiled/yard.tmx"));
    let faults =
        import(&map, "map", &files).err().ok_or("tiles beyond the picture were accepted")?;
    assert!(faults.to_string().contains("tile 2 of the tileset"), "{faults}");
    Ok(())
}

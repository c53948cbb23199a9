//! The reports on maps with faults: one for each file in `tests/bad_maps`, and for maps that cannot
//! be stored there as a file.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use cellcaster::fault::Faults;
use cellcaster::map;

type Outcome = Result<(), Box<dyn Error>>;

/// The faults of a map that must have some.
fn faults(path: &Path) -> Result<Faults, String> {
    map::load_level(path).err().ok_or_else(|| format!("{} was accepted", path.display()))
}

/// An empty folder for the test `name`.
fn scratch(name: &str) -> std::io::Result<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&folder)?;
    Ok(folder)
}

/// A report without the folder of its file.
fn without_folder(faults: &Faults, folder: &Path) -> String {
    faults.to_string().replace(&format!("{}/", folder.display()), "")
}

fn map_with_grid(rows: &str) -> String {
    format!(
        "grid = '''\n{rows}'''\n[tiles]\n\"#\" = {{ wall = \"brick\" }}\n\
         [things]\n\"@\" = {{ start = 0 }}\n"
    )
}

#[test]
fn every_bad_map_is_refused_with_a_report() -> Outcome {
    let mut names = Vec::new();
    for entry in fs::read_dir("tests/bad_maps")? {
        let name = entry?.file_name().into_string().map_err(|_| "a name that is not UTF-8")?;
        names.extend(name.strip_suffix(".toml").map(str::to_owned));
    }
    assert!(names.len() > 40, "where are the bad maps?");
    for name in names {
        let faults = faults(Path::new(&format!("tests/bad_maps/{name}.toml")))?;
        assert!(faults.len() >= 1, "{name}");
        insta::assert_snapshot!(name, faults);
    }
    Ok(())
}

#[test]
fn a_missing_quote_or_bracket_is_one_fault_at_its_line() -> Outcome {
    let definition = r##""#" = { wall = "brick", height = 2.0 }"##;
    let map = format!(
        "grid = \"\"\"\n####\n#@k#\n####\n\"\"\"\n[tiles]\n{definition}\n\"x\" = {{ wall = \"moss\" }}\n\n\
         [things]\n\"@\" = {{ start = 0 }}\n\"k\" = {{ key = \"brass\" }}\n"
    );
    // Without the first quote, the line is a comment.
    for (place, _) in definition.match_indices(['"', '}', ']']).skip(1) {
        let mut broken = definition.to_owned();
        broken.remove(place);
        let text = map.replace(definition, &broken);
        let faults = map::parse_str(&text).err().ok_or("a broken map was accepted")?;
        assert_eq!(faults.len(), 1, "{broken}\n{faults}");
        assert!(faults.to_string().contains(":7:"), "{broken}\n{faults}");
    }
    Ok(())
}

#[test]
fn a_missing_file_is_refused() -> Outcome {
    insta::assert_snapshot!(faults(Path::new("tests/bad_maps/absent.toml"))?, @"error: there is no file tests/bad_maps/absent.toml");
    Ok(())
}

#[test]
fn a_folder_is_refused() -> Outcome {
    insta::assert_snapshot!(faults(Path::new("tests/bad_maps"))?, @r"
    error: tests/bad_maps is a folder, not a map
     |
     = help: name a map file in it
    ");
    Ok(())
}

#[test]
fn a_grid_too_wide_or_too_high_is_refused() -> Outcome {
    let folder = scratch("large_grids")?;
    let path = folder.join("wide.toml");
    fs::write(&path, map_with_grid(&format!("@{}\n", "#".repeat(4096))))?;
    insta::assert_snapshot!(without_folder(&faults(&path)?, &folder), @r"
    error: the grid is 4097×1 cells, but at most 4096×4096 is allowed
     --> wide.toml:1:1
      |
    1 | grid = '''
      | ^^^^
    ");
    let path = folder.join("high.toml");
    fs::write(&path, map_with_grid(&format!("@\n{}", "#\n".repeat(4096))))?;
    insta::assert_snapshot!(without_folder(&faults(&path)?, &folder), @r"
    error: the grid is 1×4097 cells, but at most 4096×4096 is allowed
     --> high.toml:1:1
      |
    1 | grid = '''
      | ^^^^
    ");
    Ok(())
}

#[test]
fn an_oversized_file_is_refused() -> Outcome {
    let folder = scratch("large_file")?;
    let path = folder.join("large.toml");
    fs::File::create(&path)?.set_len(map::MAX_BYTES as u64 + 1)?;
    let report = without_folder(&faults(&path)?, &folder);
    fs::remove_file(&path)?;
    insta::assert_snapshot!(report, @"error: large.toml is larger than 64 MiB, the maximum for a map");
    let text = " ".repeat(map::MAX_BYTES + 1);
    assert!(map::parse_str(&text).is_err());
    Ok(())
}

#[cfg(unix)]
#[test]
fn a_link_out_of_the_folder_is_refused() -> Outcome {
    let folder = scratch("links")?;
    let inside = folder.join("inside");
    fs::create_dir_all(&inside)?;
    fs::write(folder.join("outside.png"), "")?;
    let link = inside.join("link.png");
    if !link.is_symlink() {
        std::os::unix::fs::symlink("../outside.png", &link)?;
    }
    let path = inside.join("map.toml");
    fs::write(&path, format!("floor = \"link.png\"\n{}", map_with_grid("@#\n")))?;
    insta::assert_snapshot!(without_folder(&faults(&path)?, &inside), @r#"
    error: the texture "link.png" links to a file outside the map's folder
     --> map.toml:1:9
      |
    1 | floor = "link.png"
      |         ^^^^^^^^^^
      |
      = help: a texture is a PNG file beside the map
    "#);
    Ok(())
}

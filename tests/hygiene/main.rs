//! The repository: its documents, and the claims in them.

mod modules;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::{fs, io};

use cellcaster::map::{self, Folder};

/// The documents, relative to the root of the package.
fn documents() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let markdown = |folder: &Path| -> io::Result<Vec<PathBuf>> {
        let files = fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
        files.filter(|path| path.as_ref().map_or(true, |path| is_markdown(path))).collect()
    };
    let mut documents = [root.to_owned(), root.join("docs")]
        .iter()
        .flat_map(|folder| markdown(folder).unwrap())
        .collect::<Vec<_>>();
    documents.sort();
    assert!(documents.len() > 10, "{documents:?}");
    documents
}

fn is_markdown(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "md")
}

/// The anchors of a document's headings, as GitHub makes them.
fn anchors(text: &str) -> BTreeSet<String> {
    let headings =
        prose(text).filter_map(|line| Some(line.strip_prefix('#')?.trim_start_matches('#')));
    headings
        .map(|heading| {
            let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect::<String>().to_lowercase()
        })
        .collect()
}

/// The lines of a document outside code blocks.
fn prose(text: &str) -> impl Iterator<Item = &str> {
    let mut is_code = false;
    text.lines().filter(move |line| {
        let is_fence = line.trim_start().starts_with("```");
        is_code ^= is_fence;
        !is_code && !is_fence
    })
}

/// The targets of a document's links.
fn links(text: &str) -> Vec<String> {
    let text: String = prose(text).flat_map(|line| [line, "\n"]).collect();
    let targets = text.split("](").skip(1).filter_map(|rest| rest.split_once(')'));
    targets.map(|(target, _)| target.to_owned()).collect()
}

/// The code blocks of a document in `language`, each with the number of its first line.
fn blocks(text: &str, language: &str) -> Vec<(usize, String)> {
    let mut blocks = Vec::new();
    let mut lines = (1..).zip(text.lines());
    while let Some((number, line)) = lines.next() {
        if line.trim() == format!("```{language}") {
            let inside =
                lines.by_ref().map(|(_, line)| line).take_while(|line| line.trim() != "```");
            blocks.push((number + 1, inside.flat_map(|line| [line, "\n"]).collect()));
        }
    }
    blocks
}

#[test]
fn links_between_documents_resolve() {
    let mut broken = Vec::new();
    for document in documents() {
        let text = fs::read_to_string(&document).unwrap();
        for link in links(&text).iter().filter(|link| !link.contains("://")) {
            let (path, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target =
                if path.is_empty() { document.clone() } else { document.with_file_name(path) };
            let has_anchor = || {
                anchor.is_empty() || anchors(&fs::read_to_string(&target).unwrap()).contains(anchor)
            };
            if !target.exists() || !has_anchor() {
                broken.push(format!("{}: {link}", document.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}

#[test]
fn documents_are_formatted() {
    for document in documents() {
        let (name, text) = (document.display(), fs::read_to_string(&document).unwrap());
        assert!(text.starts_with("# "), "{name} does not begin with its title");
        assert!(text.ends_with('\n') && !text.ends_with("\n\n"), "{name} ends with one line break");
        assert_eq!(text.matches("```").count() % 2, 0, "{name} has a block of code without end");
        assert_eq!(prose(&text).filter(|line| line.starts_with("# ")).count(), 1, "{name}");
        for (number, line) in (1..).zip(text.lines()) {
            assert_eq!(line, line.trim_end(), "{name}:{number} ends with blanks");
            assert!(!line.contains('\t'), "{name}:{number} has a tab");
        }
    }
}

#[test]
fn the_price_list_has_every_gallery_map() {
    let list = fs::read_to_string("docs/prices.md").unwrap();
    for map in fs::read_dir("maps/gallery").unwrap() {
        let path = map.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        let row = format!("| {name} | ");
        assert!(list.contains(&row), "{name}: write the table anew by the bench `prices`");
    }
}

#[test]
fn the_changelog_has_a_section_for_this_version() {
    let changelog = include_str!("../../CHANGELOG.md");
    let version = env!("CARGO_PKG_VERSION");
    let mut sections = changelog.lines().filter_map(|line| line.strip_prefix("## "));
    let is_named = |section: &str| section == "Unreleased" || section.contains(version);
    assert!(sections.next().is_some_and(is_named), "the first section is neither");
}

/// A block with a grid is a whole map. Any other block is a part of a map, and is valid TOML.
#[test]
fn maps_in_the_documents_are_valid() {
    let mut maps = 0;
    for document in documents() {
        let text = fs::read_to_string(&document).unwrap();
        for (line, block) in blocks(&text, "toml") {
            let name = format!("{}:{line}", document.display());
            let is_map = block
                .lines()
                .any(|line| line.starts_with("grid ") || line.starts_with("[[sphere]]"));
            if is_map {
                maps += 1;
                let folder = Folder::of(Path::new(concat!(
                    env!("CARGO_MANIFEST_DIR"),
                    "/tests/maps/map.toml"
                )));
                if let Err(faults) = map::parse_level(&block, &name, &folder) {
                    panic!("{faults}");
                }
            } else if let Err(error) = toml::from_str::<toml::Table>(&block) {
                panic!("{name}: {error}");
            }
        }
    }
    assert!(maps > 0);
}

//! The macro [`assert_grid!`], and the files that it compares with.

use std::fmt::{self, Write as _};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::{env, io};

use super::CellGrid;

/// The maximum number of differences that a failure lists.
const MAX_LISTED: usize = 8;
/// The environment variable that makes tests write their files.
const UPDATE: &str = "CELLCASTER_UPDATE_GRIDS";

/// Asserts that a grid is the one in the file `grids/NAME.grid` beside the test.
///
/// `assert_grid!(grid, "name")` takes a [`CellGrid`], or a ratatui buffer. `assert_grid!(grid, "name", tolerance)`
/// permits the differences of a [`Tolerance`]. With the environment variable `CELLCASTER_UPDATE_GRIDS=1`, a file that
/// does not exist or differs is written anew. [`testing`](crate::testing) has an example.
///
/// # Panics
/// If the grid differs, if the file cannot be read or written, or if the name has other characters than letters,
/// digits, `_`, `-` and `.`.
#[macro_export]
macro_rules! assert_grid {
    ($grid:expr, $name:expr $(,)?) => {
        $crate::assert_grid!($grid, $name, $crate::testing::Tolerance::default())
    };
    ($grid:expr, $name:expr, $tolerance:expr $(,)?) => {
        $crate::testing::check(
            &$crate::testing::CellGrid::from($grid),
            &$crate::testing::Golden::beside(
                ::core::env!("CARGO_MANIFEST_DIR"),
                ::core::file!(),
                ::core::env!("CARGO_CRATE_NAME"),
                $name,
            ),
            $tolerance,
        )
    };
}

/// The differences that [`assert_grid!`](crate::assert_grid!) permits; by default, none.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tolerance {
    /// The greatest ΔE at which a cell counts as equal. Most people notice a difference of 2.3 or more.
    pub delta_e: f64,
    /// The number of cells that may differ by more.
    pub cells: usize,
}

/// The file of a grid, and where its pictures are written after a failure.
#[derive(Clone, Debug)]
pub struct Golden {
    name: String,
    path: PathBuf,
    pictures: PathBuf,
}

impl Golden {
    /// The file called `name`, beside the source file `source` in the package at `manifest`.
    ///
    /// # Panics
    /// If `name` is not the name of a file.
    #[track_caller]
    pub fn beside(manifest: &str, source: &str, test: &str, name: &str) -> Self {
        let is_plain = |c: char| c.is_alphanumeric() || "_-.".contains(c);
        assert!(
            !name.is_empty() && name.chars().all(is_plain),
            "{name:?} is not a valid name for a grid: use letters, digits, \"_\", \"-\" and \".\""
        );
        // A source file is named from the root of its workspace, which may be above the package.
        let roots = Path::new(manifest).ancestors().map(|root| root.join(source));
        let source = { roots }.find(|path| path.exists()).unwrap_or_else(|| source.into());
        Self {
            name: name.to_owned(),
            path: source.with_file_name("grids").join(format!("{name}.grid")),
            pictures: pictures_folder().join(test),
        }
    }

    /// Compares `grid` with the file.
    ///
    /// # Errors
    /// The differences, if the tolerance does not permit them.
    fn compare(&self, grid: &CellGrid, tolerance: Tolerance) -> Result<(), Failure<'_>> {
        let failure = |message: String, wanted: Option<(&CellGrid, _)>| {
            let pictures = self.write_pictures(grid, wanted);
            Failure { golden: self, message, pictures }
        };
        let wanted = match CellGrid::read(&self.path) {
            Ok(wanted) => wanted,
            Err(error) => return Err(failure(format!("the file {error}"), None)),
        };
        let comparison = wanted.compare(grid, tolerance.delta_e);
        if comparison.differences.len() <= tolerance.cells {
            return Ok(());
        }
        let mut message = comparison.to_string();
        for difference in comparison.differences.iter().take(MAX_LISTED) {
            _ = write!(message, "\n  {difference}");
        }
        if comparison.differences.len() > MAX_LISTED {
            message.push_str("\n  …");
        }
        Err(failure(message, Some((&wanted, comparison))))
    }

    /// Writes pictures of the actual and the expected grid. Returns their paths.
    fn write_pictures(
        &self,
        got: &CellGrid,
        wanted: Option<(&CellGrid, super::Comparison)>,
    ) -> io::Result<Vec<PathBuf>> {
        fs::create_dir_all(&self.pictures)?;
        let mut paths = Vec::new();
        let mut create = |kind: &str| {
            let path = self.pictures.join(format!("{}.{kind}.png", self.name));
            paths.push(path.clone());
            File::create(path)
        };
        got.write_png(create("got")?)?;
        if let Some((wanted, comparison)) = wanted {
            wanted.write_png(create("wanted")?)?;
            got.write_difference_png(&comparison, create("difference")?)?;
        }
        Ok(paths)
    }

    fn write(&self, grid: &CellGrid) -> io::Result<()> {
        fs::create_dir_all(self.path.with_file_name(""))?;
        fs::write(&self.path, grid.to_string())
    }
}

/// The folder `grids` in the target folder of the test that runs, or a folder for temporary files.
fn pictures_folder() -> PathBuf {
    let test = env::current_exe().unwrap_or_default();
    let target = test
        .parent()
        .filter(|folder| folder.ends_with("deps"))
        .and_then(|it| it.ancestors().nth(2));
    target.map_or_else(|| env::temp_dir().join("cellcaster-grids"), |target| target.join("grids"))
}

/// A grid that is not the one in its file.
#[derive(Debug)]
struct Failure<'a> {
    golden: &'a Golden,
    message: String,
    pictures: io::Result<Vec<PathBuf>>,
}

impl fmt::Display for Failure<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { golden: Golden { name, path, .. }, message, pictures } = self;
        writeln!(f, "the grid {name:?} differs from {}:\n{message}", path.display())?;
        match pictures {
            Ok(pictures) => {
                for path in pictures {
                    writeln!(f, "see {}", path.display())?;
                }
            }
            Err(error) => writeln!(f, "its pictures cannot be written: {error}")?,
        }
        write!(f, "to accept the new grid, run the test with {UPDATE}=1")
    }
}

/// Does what [`assert_grid!`](crate::assert_grid!) does.
///
/// # Panics
/// If the grid is not the one in the file.
#[track_caller]
pub fn check(grid: &CellGrid, golden: &Golden, tolerance: Tolerance) {
    let Err(failure) = golden.compare(grid, tolerance) else { return };
    let updates = env::var_os(UPDATE).is_some_and(|value| !value.is_empty() && value != "0");
    assert!(updates, "{failure}");
    if let Err(error) = golden.write(grid) {
        panic!("{} cannot be written: {error}", golden.path.display());
    }
}

#[cfg(test)]
mod tests {
    use ratatui::style::{Color, Stylize};

    use super::*;

    fn hello(color: u8) -> CellGrid {
        CellGrid::drawn(8, 2, |frame| {
            frame.render_widget("Hello".fg(Color::Rgb(color, 0, 0)), frame.area());
        })
    }

    #[test]
    fn a_failure_says_where_and_how_far_and_draws_three_pictures() {
        let folder = env::temp_dir().join(format!("cellcaster-assertion-{}", std::process::id()));
        let golden = Golden {
            name: "hello".to_owned(),
            path: folder.join("grids/hello.grid"),
            pictures: folder.join("pictures"),
        };
        let compare = |color, tolerance| {
            let failure = golden.compare(&hello(color), tolerance).err();
            failure.map(|failure| failure.to_string().replace(folder.to_str().unwrap(), "FOLDER"))
        };
        let exact = Tolerance::default();
        insta::assert_snapshot!(compare(200, exact).unwrap(), @r#"
        the grid "hello" differs from FOLDER/grids/hello.grid:
        the file does not exist
        see FOLDER/pictures/hello.got.png
        to accept the new grid, run the test with CELLCASTER_UPDATE_GRIDS=1
        "#);
        golden.write(&hello(200)).unwrap();
        assert_eq!(compare(200, exact), None);
        insta::assert_snapshot!(compare(210, exact).unwrap(), @r#"
        the grid "hello" differs from FOLDER/grids/hello.grid:
        5 of 16 cells differ, in columns 0-4 and row 0
        the largest difference: column 0, row 0: "H" #d20000 on Reset in place of "H" #c80000 on Reset, ΔE 3.9
          column 0, row 0: "H" #d20000 on Reset in place of "H" #c80000 on Reset, ΔE 3.9
          column 1, row 0: "e" #d20000 on Reset in place of "e" #c80000 on Reset, ΔE 3.9
          column 2, row 0: "l" #d20000 on Reset in place of "l" #c80000 on Reset, ΔE 3.9
          column 3, row 0: "l" #d20000 on Reset in place of "l" #c80000 on Reset, ΔE 3.9
          column 4, row 0: "o" #d20000 on Reset in place of "o" #c80000 on Reset, ΔE 3.9
        see FOLDER/pictures/hello.got.png
        see FOLDER/pictures/hello.wanted.png
        see FOLDER/pictures/hello.difference.png
        to accept the new grid, run the test with CELLCASTER_UPDATE_GRIDS=1
        "#);
        for picture in ["wanted", "got", "difference"] {
            let bytes = fs::read(folder.join(format!("pictures/hello.{picture}.png"))).unwrap();
            let mut reader = png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
            assert_eq!((reader.info().width, reader.info().height), (64, 32));
            reader.next_frame(&mut vec![0; 64 * 32 * 3]).unwrap();
        }
        assert_eq!(compare(210, Tolerance { delta_e: 10.0, ..exact }), None);
        assert_eq!(compare(210, Tolerance { cells: 5, ..exact }), None);
        assert!(compare(210, Tolerance { cells: 4, ..exact }).is_some());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    #[should_panic(expected = "is not a valid name for a grid")]
    fn a_name_is_not_a_path() {
        _ = Golden::beside(env!("CARGO_MANIFEST_DIR"), file!(), "tests", "../hello");
    }
}

//! Casters to compare with the exact one, as found in tutorials and other programs.
//!
//! | method | finds the hit by | source |
//! |---|---|---|
//! | [`Exact`] | lines in their true order: integers, or longer integers if these cannot decide | [`cellcaster::cast`] |
//! | [`Dda`] | lines in order, in double precision | Lode Vandevenne, "Raycasting II" |
//! | [`Dda32`] | the same in single precision | the same |
//! | [`Accumulate`] | a running sum of distances | Lode Vandevenne, "Raycasting" |
//! | [`Fixed`] | lines in order, in fixed point | drummyfish, LRS, "Raycasting" |
//! | [`AngleTable`] | x and y lines separately, along the nearest of a fixed number of angles | F. Permadi, "Ray-Casting Tutorial" |
//! | [`March`] | constant steps | the method against which Lode Vandevenne warns |
//!
//! Except for the exact caster, all casters treat doors, glass, masks and shapes as walls, and none
//! keeps the rules of [`cellcaster::cast`] for every ray. Each method is one type that implements
//! [`Caster`]; a [`Method`] is chosen by name.
//!
//! A [`Method`] is not a caster. Code whose speed does not matter takes a caster from
//! [`Method::caster`], which is called through a pointer. Code that measures times passes a
//! [`Visitor`], whose loop is compiled for each caster. Otherwise the measurement would include
//! following a pointer for each ray.

mod clipped_ray;
mod lines;
mod march;
mod table;

pub use lines::{Accumulate, Dda, Dda32, Fixed};
pub use march::March;
pub use table::AngleTable;

use std::fmt;
use std::ops::RangeInclusive;
use std::str::FromStr;

use cellcaster::cast::{Caster, Exact};

/// A method of casting, with its parameter.
///
/// It is written as a name, followed by a colon and a value if the method has a parameter: `exact`,
/// `dda`, `dda32`, `accumulate`, `fixed:10`, `table:1920`, `march:0.01`. A missing parameter has
/// the value shown here.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Method {
    /// [`Exact`].
    #[default]
    Exact,
    /// [`Dda`].
    Dda,
    /// [`Dda32`].
    Dda32,
    /// [`Accumulate`].
    Accumulate,
    /// [`Fixed`].
    Fixed(Fixed),
    /// [`AngleTable`].
    Table(AngleTable),
    /// [`March`].
    March(March),
}

/// A function that is generic over the caster.
pub trait Visitor {
    /// The result.
    type Output;

    /// Calls the function with `caster`.
    fn visit<C: Caster>(self, caster: &C) -> Self::Output;
}

impl Method {
    /// The names of all methods, the default first.
    pub const NAMES: [&str; 7] = ["exact", "dda", "dda32", "accumulate", "fixed", "table", "march"];

    /// All methods, each with the default value of its parameter.
    ///
    /// # Panics
    /// Never: the names are valid, and a test parses them.
    pub fn all() -> [Self; 7] {
        Self::NAMES.map(|name| name.parse().expect("these are the names of all methods"))
    }

    /// All methods, those with a parameter at several of its values.
    ///
    /// # Panics
    /// Never: a test parses the names.
    pub fn at_all_parameters() -> Vec<Self> {
        let names = "exact dda dda32 accumulate fixed:6 fixed:10 fixed:16 fixed:22 table:480 table:1920 table:7680 \
                     table:61440 march:0.1 march:0.01 march:0.001";
        names.split(' ').map(|name| name.parse().expect("it is the name of a method")).collect()
    }

    /// Passes the caster to `visitor`.
    pub fn accept<V: Visitor>(&self, visitor: V) -> V::Output {
        match self {
            Self::Exact => visitor.visit(&Exact),
            Self::Dda => visitor.visit(&Dda),
            Self::Dda32 => visitor.visit(&Dda32),
            Self::Accumulate => visitor.visit(&Accumulate),
            Self::Fixed(fixed) => visitor.visit(fixed),
            Self::Table(table) => visitor.visit(table),
            Self::March(march) => visitor.visit(march),
        }
    }

    /// The caster.
    pub fn caster(&self) -> Box<dyn Caster> {
        match self {
            Self::Exact => Box::new(Exact),
            Self::Dda => Box::new(Dda),
            Self::Dda32 => Box::new(Dda32),
            Self::Accumulate => Box::new(Accumulate),
            Self::Fixed(fixed) => Box::new(*fixed),
            Self::Table(table) => Box::new(table.clone()),
            Self::March(march) => Box::new(*march),
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exact => f.write_str("exact"),
            Self::Dda => f.write_str("dda"),
            Self::Dda32 => f.write_str("dda32"),
            Self::Accumulate => f.write_str("accumulate"),
            Self::Fixed(fixed) => write!(f, "fixed:{}", fixed.fraction_bits),
            Self::Table(table) => write!(f, "table:{}", table.angles()),
            Self::March(march) => write!(f, "march:{}", march.step),
        }
    }
}

impl FromStr for Method {
    type Err = ParseMethodError;

    /// Parses the format that [`Display`](fmt::Display) writes. The parameter is optional.
    ///
    /// # Errors
    /// Returns an error if there is no such method, or if its parameter is invalid or out of range.
    fn from_str(text: &str) -> Result<Self, ParseMethodError> {
        let (name, parameter) = match text.split_once(':') {
            Some((name, parameter)) => (name, Some(parameter)),
            None => (text, None),
        };
        let plain = |method| match parameter {
            None => Ok(method),
            Some(_) => Err(ParseMethodError(format!("the caster \"{name}\" takes no parameter"))),
        };
        match name {
            "exact" => plain(Self::Exact),
            "dda" => plain(Self::Dda),
            "dda32" => plain(Self::Dda32),
            "accumulate" => plain(Self::Accumulate),
            // The defaults of the sources: 10 bits, and 1920 angles.
            "fixed" => number(parameter, 10, 4..=26, "\"fixed\" takes 4 to 26 fraction bits")
                .map(|fraction_bits| Self::Fixed(Fixed { fraction_bits })),
            "table" => number(parameter, 1920, 8..=65_536, "\"table\" takes 8 to 65536 angles")
                .map(|count| Self::Table(AngleTable::new(count))),
            "march" => {
                let takes = "\"march\" takes steps of 0.0001 to 1 cells";
                number(parameter, 0.01, 0.0001..=1.0, takes).map(|step| Self::March(March { step }))
            }
            _ => {
                let names = Self::NAMES.join(", ");
                Err(ParseMethodError(format!(
                    "there is no caster \"{name}\"; the casters are {names}"
                )))
            }
        }
    }
}

/// A parameter within `range`, or `usual` if there is none. `takes` is the error message.
fn number<T: FromStr + PartialOrd>(
    parameter: Option<&str>,
    usual: T,
    range: RangeInclusive<T>,
    takes: &str,
) -> Result<T, ParseMethodError> {
    let Some(text) = parameter else { return Ok(usual) };
    let number = text.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| ParseMethodError(format!("the caster {takes}, not \"{text}\"")))
}

/// The error of parsing a [`Method`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ParseMethodError(String);

impl fmt::Display for ParseMethodError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for ParseMethodError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_round_trips() {
        for name in Method::NAMES {
            let method: Method = name.parse().unwrap();
            let written = method.to_string();
            assert!(written.starts_with(name));
            assert_eq!(written.parse(), Ok(method));
        }
        for written in ["fixed:16", "table:360", "march:0.0625"] {
            assert_eq!(written.parse::<Method>().unwrap().to_string(), written);
        }
        assert_eq!("exact".parse(), Ok(Method::default()));
    }

    #[test]
    fn an_error_about_a_bad_name_says_why() {
        let error = |text: &str| text.parse::<Method>().unwrap_err().to_string();
        let errors = [
            "bresenham",
            "",
            "dda:64",
            "fixed:3",
            "fixed:27",
            "fixed:",
            "table:7",
            "table:-1",
            "march:0",
            "march:NaN",
            "march:inf",
            "march:1.5",
        ]
        .map(error)
        .join("\n");
        insta::assert_snapshot!(errors, @r#"
        there is no caster "bresenham"; the casters are exact, dda, dda32, accumulate, fixed, table, march
        there is no caster ""; the casters are exact, dda, dda32, accumulate, fixed, table, march
        the caster "dda" takes no parameter
        the caster "fixed" takes 4 to 26 fraction bits, not "3"
        the caster "fixed" takes 4 to 26 fraction bits, not "27"
        the caster "fixed" takes 4 to 26 fraction bits, not ""
        the caster "table" takes 8 to 65536 angles, not "7"
        the caster "table" takes 8 to 65536 angles, not "-1"
        the caster "march" takes steps of 0.0001 to 1 cells, not "0"
        the caster "march" takes steps of 0.0001 to 1 cells, not "NaN"
        the caster "march" takes steps of 0.0001 to 1 cells, not "inf"
        the caster "march" takes steps of 0.0001 to 1 cells, not "1.5"
        "#);
    }
}

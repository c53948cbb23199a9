//! Decor: the surfaces of an office.

/// The surfaces of an office, as values of a map file.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Decor {
    wall: &'static str,
    carpet: &'static str,
    corridor: &'static str,
    ceiling: &'static str,
    fog: &'static str,
}

const DECORS: [Decor; 5] = [
    Decor {
        wall: r#""brick""#,
        carpet: r##""#5c5348""##,
        corridor: r##"{ checker = ["wood", "#6f5138"] }"##,
        ceiling: r##"{ checker = ["#c4b8a4", "#b6aa96"], scale = 0.5 }"##,
        fog: "#6a6258",
    },
    Decor {
        wall: r#""plaster""#,
        carpet: r##""#4a5866""##,
        corridor: r##"{ checker = ["marble", "#39444e"] }"##,
        ceiling: r##"{ checker = ["#b4bac0", "#a6adb4"], scale = 0.5 }"##,
        fog: "#59626b",
    },
    Decor {
        wall: r#""wood""#,
        carpet: r##""#6e343a""##,
        corridor: r##"{ checker = ["#7c3b40", "#66302f"] }"##,
        ceiling: r#"{ texture = "coffer", scale = 2 }"#,
        fog: "#5e4c40",
    },
    Decor {
        wall: r#""tile""#,
        carpet: r##""#56787a""##,
        corridor: r##"{ checker = ["tile", "#c3cfcb"], scale = 0.5 }"##,
        ceiling: r##"{ checker = ["#d3dcda", "#c2ccca"], scale = 0.5 }"##,
        fog: "#7b8a8a",
    },
    Decor {
        wall: r#""sandstone""#,
        carpet: r##""#3f5f4c""##,
        corridor: r##"{ checker = ["sandstone", "#7a5a3c"] }"##,
        ceiling: r##"{ checker = ["#cfc3a4", "#c2b494"], scale = 0.5 }"##,
        fog: "#6e6650",
    },
];

impl Decor {
    /// The decor of a seed. The next seed has another one.
    pub(crate) fn of(seed: u64) -> Self {
        DECORS[(seed % DECORS.len() as u64) as usize]
    }

    /// The map file `legend` with this decor: keys above its grid, and tiles below it.
    pub(crate) fn legend(self, legend: &str) -> String {
        let Self { wall, carpet, corridor, ceiling, fog } = self;
        format!(
            "floor = {carpet}\nceiling = {ceiling}\nfog = {{ color = \"{fog}\", distance = 16 }}\n\
             {legend}\n[tiles.\"#\"]\nwall = {wall}\n[tiles.\",\"]\nfloor = {corridor}\n"
        )
    }
}

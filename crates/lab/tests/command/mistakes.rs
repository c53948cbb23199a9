//! Mistakes in the arguments of the laboratory: one sentence each, with what to write instead.

use crate::support::complaint_about;

#[test]
fn each_mistake_prints_one_sentence() {
    let lines = [
        &["bench", "cellar"][..],
        &["bench", "--seconds", "0"],
        &["accuracy", "--rays", "1000001"],
        &["accuracy", "--set", "nonsense"],
        &["accuracy", "--caster", "marsh"],
        &["accuracy", "--format", "xml"],
        &["wire", "--format", "gif"],
        &["wire", "--palette", "256", "cellar"],
        &["wire", "--glyphs", "all", "--palette", "16"],
        &["wire", "--scirpt", "x"],
        &["wire", "--size", "1000x1000"],
        &["wire", "--script"],
        &["--caster", "marsh", "cast"],
        &["load", "--sessions", "many"],
        &["nonsense"],
        &[],
    ];
    let complaints =
        lines.map(|arguments| format!("{}\n  {}", arguments.join(" "), complaint_about(arguments)));
    insta::assert_snapshot!(complaints.concat());
}

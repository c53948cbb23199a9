//! Keys of names: equal for names that look alike.

use unicode_security::skeleton;

/// The keys of a name. Two names that share a key are not told from each other.
///
/// A key is a skeleton of Unicode Technical Standard #39, section 4, in which letters that look alike are
/// one. Skeletons know upper from lower case, and these look alike in another way each: `I` is like `l`,
/// and `i` is not. So there are two keys, the skeleton of the name in lower case, and the skeleton of the
/// name as it is, put in lower case then. Names that differ in case alone share the first one, and names
/// with the same skeleton share the second one.
pub(crate) fn of(name: &str) -> Vec<String> {
    let of_lower_case: String = skeleton(&folded(name)).collect();
    let of_name: String = skeleton(name).collect();
    let mut keys = vec![of_lower_case, folded(&of_name)];
    keys.dedup();
    keys
}

/// The text with one case. It goes by way of upper case, in which `ß` is `SS` and both forms of a small
/// sigma are one.
fn folded(text: &str) -> String {
    text.chars().flat_map(char::to_uppercase).flat_map(char::to_lowercase).collect()
}

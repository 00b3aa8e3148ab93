//! What an element is for, by the words of its class, id, label and title.

use toile_pattern_files::svg::words::{ALLOWANCE, DRILL, FOLD, HOLE, MARK, NOTCH, NOTHING, OUTLINE};

/// What a drawn line is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// The line that is sewn along.
    Outline,
    /// The line that is cut along, outside the seam allowance.
    Allowance,
    /// The grain, or the grain and a fold.
    Grain {
        /// Whether the piece is cut on the fold there.
        fold: bool,
    },
    /// Where a half piece is cut on the fold.
    Fold,
    Notch,
    /// A point inside, such as a dart's tip.
    Drill,
    Hole,
    /// A line inside that changes nothing.
    Mark,
    /// The arrow of a dimension.
    Dimension,
    /// What is no part of the pattern.
    Nothing,
}

/// The words of a name in lower case; anything but a letter separates words.
fn words(name: &str) -> Vec<String> {
    let parts = name.split(|c: char| !c.is_alphabetic());
    parts.filter(|w| !w.is_empty()).map(str::to_lowercase).collect()
}

/// The role that the words of these names give; none where they give none.
pub(super) fn role<'a>(names: impl IntoIterator<Item = &'a str>) -> Option<Role> {
    let all: Vec<String> = names.into_iter().flat_map(words).collect();
    let has = |table: &[&str]| all.iter().any(|w| table.contains(&w.as_str()));
    let begins = |with: &str| all.iter().any(|w| w.starts_with(with));
    let grain = begins("grain") || all.iter().any(|w| w.ends_with("grainline"));
    let fold = begins("cutonfold") || has(&FOLD);
    match () {
        () if has(&["hidden", "logo", "scalebox"]) => Some(Role::Nothing),
        () if begins("dimension") => Some(Role::Dimension),
        () if has(&ALLOWANCE) => Some(Role::Allowance),
        () if grain => Some(Role::Grain { fold }),
        () if fold => Some(Role::Fold),
        () if has(&NOTCH) => Some(Role::Notch),
        () if has(&DRILL) => Some(Role::Drill),
        () if has(&HOLE) => Some(Role::Hole),
        () if has(&MARK) => Some(Role::Mark),
        () if has(&NOTHING) => Some(Role::Nothing),
        () if has(&OUTLINE) => Some(Role::Outline),
        () => None,
    }
}

/// The role of a group whose name is that role's word alone, such as a layer of notches.
pub(super) fn of_group<'a>(names: impl IntoIterator<Item = &'a str>) -> Option<Role> {
    let alone = |name: &&str| words(name).len() <= 2;
    role(names.into_iter().filter(alone))
}

/// How often a piece is cut, as a text says: as drawn, and mirrored. `by_word` where pairs are
/// mirrored only if the text says so.
pub(super) fn cut(text: &str, by_word: bool, most: usize) -> Option<(usize, usize)> {
    let small = text.to_lowercase();
    let parts: Vec<&str> = small.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let at = parts.windows(2).position(|w| w[0] == "cut" && w[1].parse::<usize>().is_ok())?;
    let number = parts[at + 1].parse::<usize>().ok()?.min(most);
    let mirrored = parts.iter().any(|w| w.starts_with("mirror") || *w == "pair");
    let alike = parts.contains(&"identical") || (by_word && !mirrored);
    Some(if alike { (number, 0) } else { (number - number / 2, number / 2) })
}

/// Whether an id was given by a program: a word with a number behind it.
pub(super) fn is_generated(id: &str) -> bool {
    let rest = id.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let number = rest.trim_start_matches(['-', '_']);
    let tags = [
        "path", "rect", "circle", "ellipse", "polygon", "polyline", "line", "g", "use", "svg", "layer", "fs",
        "group",
    ];
    let word = &id[..id.len() - rest.len()];
    !number.is_empty()
        && number.chars().all(|c| c.is_ascii_digit() || "-_".contains(c))
        && tags.contains(&word.to_lowercase().as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_freesewing_and_of_drawings_give_roles() {
        let is = |names: &[&str]| role(names.iter().copied());
        assert_eq!(is(&["fabric", "fs-1"]), Some(Role::Outline));
        assert_eq!(is(&["fabric sa", "fs-2"]), Some(Role::Allowance));
        assert_eq!(is(&["note", "plugin-annotations:grainline"]), Some(Role::Grain { fold: false }));
        assert_eq!(
            is(&["note", "plugin-annotations:cutOnFoldAndGrainline"]),
            Some(Role::Grain { fold: true })
        );
        assert_eq!(is(&["note", "plugin-annotations:cutOnFold"]), Some(Role::Fold));
        assert_eq!(is(&["#bnotch"]), Some(Role::Notch));
        assert_eq!(is(&["contrast help"]), Some(Role::Mark));
        assert_eq!(is(&["mark", "fs-18", "url(#dimensionFrom)"]), Some(Role::Dimension));
        assert_eq!(is(&["Seam allowance"]), Some(Role::Allowance));
        assert_eq!(is(&["front"]), None);
        assert_eq!(of_group(["Seam lines"]), Some(Role::Outline));
        assert_eq!(of_group(["front cut on fold"]), None);
    }

    #[test]
    fn texts_say_how_often_a_piece_is_cut() {
        let freesewing = "plugin-annotations:cut,2,plugin-annotations:mirrored,plugin-annotations:from";
        assert_eq!(cut(freesewing, true, 12), Some((1, 1)));
        assert_eq!(cut("plugin-annotations:cut,2,plugin-annotations:from", true, 12), Some((2, 0)));
        assert_eq!(cut("Sleeve, cut 2", false, 12), Some((1, 1)));
        assert_eq!(cut("cut 2 identical", false, 12), Some((2, 0)));
        assert_eq!(cut("cut out", false, 12), None);
    }

    #[test]
    fn ids_of_programs_are_no_names() {
        assert!(
            ["path123", "g-12", "rect7", "fs-1", "layer1", "path12-3-7"].iter().all(|id| is_generated(id))
        );
        assert!(["front", "back2", "gusset", "g", "sleeve_1"].iter().all(|id| !is_generated(id)));
    }
}

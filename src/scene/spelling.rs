//! Spelling suggestions.

/// Smallest number of letters for which a prefix is recognised.
const SHORTEST_BEGINNING: usize = 3;

/// The known word most similar to another one, or of which that is a prefix.
pub fn meant<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let begins = |known: &str| {
        word.len() >= SHORTEST_BEGINNING && (known.starts_with(word) || is_plural(word, known))
    };
    known
        .map(|known| (if begins(known) { 1 } else { edits(word, known) }, known))
        .filter(|&(edits, known)| edits <= 2 && edits < known.len())
        .min_by_key(|&(edits, _)| edits)
        .map(|(_, known)| known)
}

/// Returns true for `bodies` of `body`.
fn is_plural(word: &str, known: &str) -> bool {
    word.strip_suffix("ies").is_some_and(|stem| known.strip_suffix('y') == Some(stem))
}

/// `" (did you mean …?)"` if a known word is similar.
pub fn hint<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> String {
    meant(word, known).map_or(String::new(), |meant| format!(" (did you mean `{meant}`?)"))
}

/// Number of letters to insert, delete, replace or swap with a neighbour that turn one word into
/// the other.
///
/// Source: R. Lowrance and R. A. Wagner, J. ACM 22 (1975) 177, in its restricted form.
fn edits(from: &str, to: &str) -> usize {
    let (from, to): (Vec<_>, Vec<_>) = (from.chars().collect(), to.chars().collect());
    let mut before_last = Vec::new();
    let mut last: Vec<usize> = (0..=to.len()).collect();
    for i in 0..from.len() {
        let mut row = vec![i + 1];
        for j in 0..to.len() {
            let replaced = last[j] + usize::from(from[i] != to[j]);
            let mut fewest = replaced.min(last[j + 1] + 1).min(row[j] + 1);
            if i > 0 && j > 0 && from[i] == to[j - 1] && from[i - 1] == to[j] {
                fewest = fewest.min(before_last[j - 1] + 1);
            }
            row.push(fewest);
        }
        before_last = std::mem::replace(&mut last, row);
    }
    last[to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefix_outweighs_similarity() {
        let known = ["shear", "pressure", "heat_flux"];
        assert_eq!(meant("heat", known.into_iter()), Some("heat_flux"));
        assert_eq!(meant("shaer", known.into_iter()), Some("shear"));
        assert_eq!(meant("bodies", ["load", "body"].into_iter()), Some("body"));
        assert_eq!(meant("he", known.into_iter()), None);
    }

    #[test]
    fn edit_distance() {
        for (from, to, count) in [("", "abc", 3), ("abc", "acb", 1), ("kitten", "sitting", 3)] {
            assert_eq!(edits(from, to), count, "{from} → {to}");
            assert_eq!(edits(to, from), count, "{to} → {from}");
        }
    }
}

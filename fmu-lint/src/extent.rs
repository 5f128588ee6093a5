//! Limits on width and depth of an XML text before parsing. Parsing time grows with the square of an element's
//! attributes, and its stack with the depth.

/// Largest number of attributes of an element, and largest nesting depth.
const MOST_ATTRIBUTES: usize = 1000;
const DEEPEST: usize = 1000;

/// Returns the offset at which a limit is exceeded, and its description.
pub fn check(text: &str) -> Result<(), (usize, String)> {
    let bytes = text.as_bytes();
    let (mut at, mut depth) = (0, 0_usize);
    while let Some(start) = find(bytes, at, b"<") {
        let rest = &bytes[start..];
        let skip_to = |end: &[u8]| find(bytes, start, end).map(|at| at + end.len());
        at = match rest {
            [b'<', b'!', b'-', b'-', ..] => skip_to(b"-->"),
            [b'<', b'!', b'[', ..] => skip_to(b"]]>"),
            [b'<', b'?', ..] => skip_to(b"?>"),
            [b'<', b'!', ..] => skip_to(b">"),
            [b'<', b'/', ..] => {
                depth = depth.saturating_sub(1);
                skip_to(b">")
            }
            _ => {
                let tag = tag(bytes, start);
                if tag.attributes > MOST_ATTRIBUTES {
                    let wrong = format!("an element has more than {MOST_ATTRIBUTES} attributes");
                    return Err((start, wrong));
                }
                depth += usize::from(!tag.is_empty);
                if depth > DEEPEST {
                    return Err((
                        start,
                        format!("elements are nested more than {DEEPEST} levels deep"),
                    ));
                }
                Some(tag.end)
            }
        }
        // The parser reports unclosed elements.
        .unwrap_or(bytes.len());
    }
    Ok(())
}

struct Tag {
    /// Offset behind its last letter.
    end: usize,
    attributes: usize,
    /// True for a self-closing tag.
    is_empty: bool,
}

fn tag(bytes: &[u8], start: usize) -> Tag {
    let (mut at, mut attributes) = (start, 0);
    while at < bytes.len() {
        match bytes[at] {
            quote @ (b'"' | b'\'') => {
                attributes += 1;
                at = find(bytes, at + 1, &[quote]).unwrap_or(bytes.len());
            }
            b'>' => return Tag { end: at + 1, attributes, is_empty: bytes[at - 1] == b'/' },
            _ => {}
        }
        at += 1;
    }
    Tag { end: bytes.len(), attributes, is_empty: false }
}

/// Offset of some bytes, searched from an offset on.
fn find(bytes: &[u8], from: usize, wanted: &[u8]) -> Option<usize> {
    let rest = bytes.get(from..)?;
    rest.windows(wanted.len()).position(|window| window == wanted).map(|at| from + at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_and_deep_texts_are_detected() {
        let wide = |count: usize| format!("<a {}/>", "b='>' ".repeat(count));
        let deep = |count: usize| format!("{}{}", "<a>".repeat(count), "</a>".repeat(count));
        for text in [
            wide(MOST_ATTRIBUTES),
            deep(DEEPEST),
            "<a/>".repeat(5000),
            format!("<!-- {} -->", "<a>".repeat(5000)),
            format!("<a><![CDATA[{}]]></a>", "<a>".repeat(5000)),
            "<a b='".into(),
            "<".into(),
        ] {
            assert_eq!(check(&text), Ok(()));
        }
        assert!(check(&wide(MOST_ATTRIBUTES + 1)).is_err());
        assert!(check(&deep(DEEPEST + 1)).is_err());
    }
}

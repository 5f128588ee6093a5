//! Common slips in TOML, with explanations of what is meant.

/// Explains an invalid line of a scene; `None` for what is no known slip.
pub fn explanation(line: &str) -> Option<(&'static str, &'static str)> {
    let line = line.split('#').next().unwrap_or_default().trim();
    if line.contains(['“', '”', '„', '‘', '’', '«', '»']) {
        return Some(("these are not straight quotes", "texts in \"…\""));
    }
    let Some((_, value)) = line.split_once('=') else {
        let is_entry = line.contains(':') && !line.starts_with('[');
        return is_entry.then_some(("a key and its value are joined by a colon", "`KEY = VALUE`"));
    };
    let value = value.trim();
    let end = value.find(|c: char| !c.is_ascii_digit() && !matches!(c, '-' | '+' | '.' | ','));
    let (number, rest) = value.split_at(end.unwrap_or(value.len()));
    if !number.contains(|c: char| c.is_ascii_digit()) {
        return None;
    }
    if number.contains(',') {
        return Some(("decimals follow a point, not a comma", "a number such as 293.15"));
    }
    if number.starts_with('.') || number.ends_with('.') {
        return Some(("a point has digits on both sides", "a number such as 0.5 or 5.0"));
    }
    let is_unit = rest.trim_start().starts_with(|c: char| c.is_alphabetic() || "°%µ".contains(c));
    let is_exponent = rest.starts_with(['e', 'E', 'x', 'o', 'b']);
    (is_unit && !is_exponent)
        .then_some(("a number with a unit is a text", "quotes, as in \"2 mm\""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_are_recognised() {
        let says = |line: &str| explanation(line).map(|(message, _)| message);
        assert_eq!(says("T = 293,15"), Some("decimals follow a point, not a comma"));
        assert_eq!(says("d = 2 mm # wide"), Some("a number with a unit is a text"));
        assert_eq!(says("d = 2mm"), Some("a number with a unit is a text"));
        assert_eq!(says("T = 90 °C"), Some("a number with a unit is a text"));
        assert_eq!(says("name = “A”"), Some("these are not straight quotes"));
        assert_eq!(says("name: \"A\""), Some("a key and its value are joined by a colon"));
        assert_eq!(says("d = .5"), Some("a point has digits on both sides"));
        assert_eq!(says("[body"), None);
        assert_eq!(says("a = 1e"), None);
    }
}

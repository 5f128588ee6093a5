//! Converts the resource location from a master to a path.

use std::borrow::Cow;
use std::path::PathBuf;

use percent_encoding::percent_decode_str;

/// Returns the path of a `file:` URI. Some masters write one slash, `localhost`, unescaped blanks or a plain path; all
/// of these are accepted.
pub fn to_path(uri: &str) -> Result<PathBuf, String> {
    let Some(rest) = strip_scheme(uri) else {
        return match uri.split_once("://") {
            Some((scheme, _)) => Err(format!("{uri:?} is a {scheme} URI; only file URIs are read")),
            None if uri.is_empty() => Err("the resource location is empty".into()),
            None => Ok(PathBuf::from(uri)),
        };
    };
    let path = strip_authority(rest)
        .ok_or_else(|| format!("{uri:?} names another host; only local files are read"))?;
    if !path.starts_with('/') {
        return Err(format!("{uri:?} names no absolute path"));
    }
    let decoded: Cow<[u8]> = percent_decode_str(strip_drive_slash(path)).into();
    bytes_to_path(decoded.into_owned()).ok_or_else(|| format!("{uri:?} is no valid path"))
}

/// Returns the part after `file:`, in any case.
fn strip_scheme(uri: &str) -> Option<&str> {
    uri.get(..5).filter(|scheme| scheme.eq_ignore_ascii_case("file:")).map(|_| &uri[5..])
}

/// Returns the part after `//host`, if the host is this one.
fn strip_authority(rest: &str) -> Option<&str> {
    let Some(rest) = rest.strip_prefix("//") else { return Some(rest) };
    let (host, path) = rest.split_at(rest.find('/').unwrap_or(rest.len()));
    (host.is_empty() || host.eq_ignore_ascii_case("localhost")).then_some(path)
}

/// Returns `C:/folder` for `/C:/folder`.
fn strip_drive_slash(path: &str) -> &str {
    match path.as_bytes() {
        [b'/', drive, b':', b'/', ..] if drive.is_ascii_alphabetic() => &path[1..],
        _ => path,
    }
}

#[cfg(unix)]
fn bytes_to_path(bytes: Vec<u8>) -> Option<PathBuf> {
    use std::os::unix::ffi::OsStringExt;
    Some(std::ffi::OsString::from_vec(bytes).into())
}

#[cfg(not(unix))]
fn bytes_to_path(bytes: Vec<u8>) -> Option<PathBuf> {
    String::from_utf8(bytes).ok().map(PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn file_uris_in_all_their_forms_are_paths() {
        for (uri, path) in [
            ("file:///tmp/unit/resources", "/tmp/unit/resources"),
            ("file:/tmp/unit/resources", "/tmp/unit/resources"),
            ("file://localhost/tmp/unit/resources", "/tmp/unit/resources"),
            ("FILE:///tmp/unit/resources/", "/tmp/unit/resources/"),
            ("file:///tmp/a%20b/%C3%BCber", "/tmp/a b/über"),
            ("file:///tmp/a b/über", "/tmp/a b/über"),
            ("file:///tmp/100%25%73", "/tmp/100%s"),
            ("file:///tmp/100%", "/tmp/100%"),
            ("file:////tmp/x", "//tmp/x"),
            ("file:///C:/Temp/unit", "C:/Temp/unit"),
            ("file:/c:/Temp/unit", "c:/Temp/unit"),
            ("/tmp/a%20b", "/tmp/a%20b"),
            ("C:/Temp/unit", "C:/Temp/unit"),
        ] {
            assert_eq!(to_path(uri).as_deref(), Ok(Path::new(path)), "{uri}");
        }
    }

    #[test]
    fn other_locations_are_refused_with_the_reason() {
        for (uri, reason) in [
            ("http://host/unit", "http URI"),
            ("file://server/share/unit", "another host"),
            ("file:relative/unit", "no absolute path"),
            ("file://", "no absolute path"),
            ("", "empty"),
        ] {
            let message = to_path(uri).unwrap_err();
            assert!(message.contains(reason), "{uri}: {message}");
        }
    }
}

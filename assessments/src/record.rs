//! Bytes of a stored assessment: a line with key and checksum, then its content in JSON.

use impinge::warning::{self, Finding, Warning};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::key::{Key, hexadecimal};

/// Returns the bytes of a content; `None` if no reader would find the same content in them, as infinite numbers have no
/// form in JSON.
pub fn to_bytes<T: Serialize + DeserializeOwned + PartialEq>(
    key: &Key,
    content: &T,
) -> Option<Vec<u8>> {
    let text = serde_json::to_string(content).ok()?;
    let is_same = serde_json::from_str::<T>(&text).is_ok_and(|read| read == *content);
    is_same.then(|| format!("{}{text}", head(key, &text)).into_bytes())
}

/// Returns the content of bytes; `None` if they are damaged, cut off, or those of another key.
pub fn from_bytes<T: DeserializeOwned>(key: &Key, bytes: &[u8]) -> Option<T> {
    let text = std::str::from_utf8(bytes).ok()?;
    let (_, content) = text.split_once('\n')?;
    let is_whole = text.strip_suffix(content)? == head(key, content);
    is_whole.then(|| serde_json::from_str(content).ok())?
}

fn head(key: &Key, content: &str) -> String {
    format!("impinge assessment {} {}\n", key.0, hexadecimal(&Sha256::digest(content)))
}

/// A warning as stored.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub struct StoredWarning {
    id: String,
    place: String,
    message: String,
    remedy: String,
}

impl StoredWarning {
    pub fn of(warning: &Warning) -> Self {
        let Finding { id, message, remedy } = warning.finding().clone();
        Self { id: id.to_owned(), place: warning.place().to_owned(), message, remedy }
    }

    /// Returns the warning if its rule exists.
    pub fn read(self) -> Option<Warning> {
        let Self { id, place, message, remedy } = self;
        let rule = warning::table().find(|rule| rule.id == id)?;
        Some(Finding { id: rule.id, message, remedy }.at(place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key() -> Key {
        Key("0123".to_owned())
    }

    #[test]
    fn numbers_and_warnings_round_trip_to_the_bit() {
        let numbers = vec![0.1 + 0.2, -0.0, 5e-324, f64::MAX, 1.0 / 3.0];
        let bytes = to_bytes(&key(), &numbers).unwrap();
        let read: Vec<f64> = from_bytes(&key(), &bytes).unwrap();
        let bits = |numbers: &[f64]| numbers.iter().map(|one| one.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read), bits(&numbers));
        let warning = warning::mesh_locks("probe.stress_xx", "3 %", "1 %").at("plate");
        assert_eq!(StoredWarning::of(&warning).read(), Some(warning.clone()));
        let foreign = StoredWarning { id: "no_rule".to_owned(), ..StoredWarning::of(&warning) };
        assert_eq!(foreign.read(), None);
    }

    #[test]
    fn content_without_a_form_in_json_is_not_stored() {
        assert_eq!(to_bytes(&key(), &vec![f64::INFINITY]), None);
        assert_eq!(to_bytes(&key(), &vec![f64::NAN]), None);
    }

    #[test]
    fn damaged_truncated_and_foreign_bytes_are_ignored() {
        let bytes = to_bytes(&key(), &vec![1.5, 2.5]).unwrap();
        let read = |bytes: &[u8]| from_bytes::<Vec<f64>>(&key(), bytes);
        assert!(read(&bytes).is_some());
        for place in 0..bytes.len() {
            assert_eq!(read(&bytes[..place]), None, "{place} bytes");
            for flip in [0x01, 0x20, 0x80] {
                let mut damaged = bytes.clone();
                damaged[place] ^= flip;
                assert_eq!(read(&damaged), None, "byte {place}");
            }
        }
        assert_eq!(from_bytes::<Vec<f64>>(&Key("4567".to_owned()), &bytes), None);
        assert_eq!(from_bytes::<String>(&key(), &bytes), None);
    }
}

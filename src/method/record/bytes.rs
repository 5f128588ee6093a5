//! A course as bytes, for storage.

use super::course::Course;
use super::profile::{Amounts, Profile};
use crate::runtime::sealed::{Content, Format, Reader};

const RECORD: Format = Format { magic: b"IMPREC02", noun: "record", of: "drops" };

impl Course {
    /// Serialises a course together with the `key` that describes its inputs.
    pub fn to_bytes(&self, key: &str) -> Vec<u8> {
        let mut content = Content::default();
        content.count(self.profiles().count());
        for profile in self.profiles() {
            content.count(profile.rings);
            content.count(profile.samples());
            let Profile { speed, heat_capacity, duration, radius, stray, .. } = *profile;
            content.numbers([speed, heat_capacity, duration, radius, stray]);
            let of = |a: &Amounts| [a.heat, a.push, a.outward];
            content.numbers(profile.amounts.iter().flat_map(of));
            content.numbers(profile.spread.iter().copied());
        }
        RECORD.seal(key, &content)
    }

    /// Deserialises a course and its key; refuses bytes that are damaged or of another format.
    pub fn from_bytes(bytes: &[u8]) -> Result<(String, Self), String> {
        let (key, profiles) = RECORD.open(bytes, profiles)?;
        Ok((key, Self::new(profiles)?))
    }
}

fn profiles(reader: &mut Reader) -> Option<Vec<Profile>> {
    let count = reader.count()?;
    (0..count).map(|_| profile(reader)).collect()
}

fn profile(reader: &mut Reader) -> Option<Profile> {
    let [rings, samples] = [reader.count()?, reader.count()?];
    let [speed, heat_capacity, duration, radius, stray] = reader.numbers(5)?.try_into().ok()?;
    let amounts = reader.numbers(rings.checked_mul(samples)?.checked_mul(3)?)?;
    let of = |a: &[f64]| Amounts { heat: a[0], push: a[1], outward: a[2] };
    let amounts = amounts.chunks_exact(3).map(of).collect();
    let spread = reader.numbers(samples)?;
    Some(Profile { speed, heat_capacity, duration, rings, radius, amounts, spread, stray })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course() -> Course {
        let profile = Profile {
            speed: 3.0,
            heat_capacity: 1.0,
            duration: 0.5,
            rings: 2,
            radius: 0.25,
            amounts: (0..6)
                .map(|n| Amounts { heat: 0.1, push: f64::from(n), outward: -0.5 })
                .collect(),
            spread: vec![0.1, 0.2, 0.3],
            stray: 0.25,
        };
        Course::new(vec![profile.clone(), Profile { speed: 4.0, ..profile }]).unwrap()
    }

    #[test]
    fn round_trip() {
        let bytes = course().to_bytes("a drop");
        assert_eq!(Course::from_bytes(&bytes), Ok(("a drop".to_owned(), course())));
    }

    #[test]
    fn damaged_bytes_are_refused() {
        let bytes = course().to_bytes("a drop");
        for place in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[place] ^= 0x20;
            assert!(Course::from_bytes(&damaged).is_err(), "byte {place}");
            assert!(Course::from_bytes(&bytes[..place]).is_err(), "{place} bytes");
        }
    }
}

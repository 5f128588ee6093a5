//! A course as bytes, for storage: a name of the format, what it follows from, the numbers, and a checksum.

use super::course::Course;
use super::profile::{Amounts, Profile};

/// Name and version of the format.
const MAGIC: &[u8; 8] = b"IMPREC01";
/// Bytes of a number and of the checksum.
const WORD: usize = 8;

impl Course {
    /// The bytes of a course that follows from what `key` says.
    pub fn to_bytes(&self, key: &str) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        put(&mut bytes, key.len() as u64);
        bytes.extend_from_slice(key.as_bytes());
        put(&mut bytes, self.profiles().count() as u64);
        for profile in self.profiles() {
            put(&mut bytes, profile.rings as u64);
            put(&mut bytes, profile.samples() as u64);
            let head = [profile.speed, profile.heat_capacity, profile.duration, profile.radius];
            let of = |a: &Amounts| [a.heat, a.push, a.outward];
            let amounts = profile.amounts.iter().flat_map(of);
            let numbers = head.into_iter().chain(amounts).chain(profile.spread.iter().copied());
            numbers.for_each(|number| put(&mut bytes, number.to_bits()));
        }
        let sum = checksum(&bytes);
        put(&mut bytes, sum);
        bytes
    }

    /// The course and what it follows from; refuses bytes that are damaged or of another format.
    pub fn from_bytes(bytes: &[u8]) -> Result<(String, Self), String> {
        let cut = || "the record is cut off".to_owned();
        let end = bytes.len().checked_sub(WORD).ok_or_else(cut)?;
        let (body, sum) = bytes.split_at(end);
        let mut reader = Reader { rest: body };
        if reader.take(MAGIC.len()).ok_or_else(cut)? != MAGIC {
            return Err("this is no record of drops, or one of another version".to_owned());
        }
        if sum != checksum(body).to_le_bytes() {
            return Err("the record is damaged: its checksum is not that of its content".to_owned());
        }
        let length = reader.count().ok_or_else(cut)?;
        let key = String::from_utf8(reader.take(length).ok_or_else(cut)?.to_vec());
        let key = key.map_err(|_| "the record does not say what it follows from".to_owned())?;
        let count = reader.count().ok_or_else(cut)?;
        let mut profiles = Vec::new();
        for _ in 0..count {
            profiles.push(reader.profile().ok_or_else(cut)?);
        }
        if !reader.rest.is_empty() {
            return Err("the record goes on beyond its end".to_owned());
        }
        Ok((key, Self::new(profiles)?))
    }
}

struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(count)?;
        self.rest = rest;
        Some(taken)
    }

    fn word(&mut self) -> Option<u64> {
        Some(u64::from_le_bytes(self.take(WORD)?.try_into().ok()?))
    }

    /// A number of things, of which there are no more than bytes.
    fn count(&mut self) -> Option<usize> {
        usize::try_from(self.word()?).ok().filter(|count| *count <= self.rest.len())
    }

    fn numbers(&mut self, count: usize) -> Option<Vec<f64>> {
        let bytes = self.take(count.checked_mul(WORD)?)?;
        let number = |word: &[u8]| Some(f64::from_le_bytes(word.try_into().ok()?));
        bytes.chunks_exact(WORD).map(number).collect()
    }

    fn profile(&mut self) -> Option<Profile> {
        let [rings, samples] = [self.count()?, self.count()?];
        let [speed, heat_capacity, duration, radius] = self.numbers(4)?.try_into().ok()?;
        let amounts = self.numbers(rings.checked_mul(samples)?.checked_mul(3)?)?;
        let of = |a: &[f64]| Amounts { heat: a[0], push: a[1], outward: a[2] };
        let amounts = amounts.chunks_exact(3).map(of).collect();
        let spread = self.numbers(samples)?;
        Some(Profile { speed, heat_capacity, duration, rings, radius, amounts, spread })
    }
}

fn put(bytes: &mut Vec<u8>, word: u64) {
    bytes.extend_from_slice(&word.to_le_bytes());
}

/// FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo 1991), of 64 bits.
fn checksum(bytes: &[u8]) -> u64 {
    let mix = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, mix)
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
        };
        Course::new(vec![profile.clone(), Profile { speed: 4.0, ..profile }]).unwrap()
    }

    #[test]
    fn what_is_stored_is_read_again() {
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

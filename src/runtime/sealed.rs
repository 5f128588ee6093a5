//! Serialised numbers: a name of the format, a key that describes their inputs, the content, and a checksum.

/// Number of bytes of a number and of the checksum.
const WORD: usize = 8;

/// A format, and the noun for its content.
pub struct Format {
    /// Its name and version.
    pub magic: &'static [u8; 8],
    pub noun: &'static str,
    pub of: &'static str,
}

impl Format {
    /// Serialises a content together with the `key` that describes its inputs.
    pub fn seal(&self, key: &str, content: &Content) -> Vec<u8> {
        let mut bytes = self.magic.to_vec();
        bytes.extend_from_slice(&(key.len() as u64).to_le_bytes());
        bytes.extend_from_slice(key.as_bytes());
        bytes.extend_from_slice(&content.bytes);
        let sum = checksum(&bytes);
        bytes.extend_from_slice(&sum.to_le_bytes());
        bytes
    }

    /// Returns the content as `read` decodes it, and its key. Refuses bytes that are damaged, of another format, or not
    /// fully consumed.
    pub fn open<T>(
        &self,
        bytes: &[u8],
        read: impl FnOnce(&mut Reader) -> Option<T>,
    ) -> Result<(String, T), String> {
        let Self { magic, noun, of } = self;
        let cut = || format!("the {noun} is cut off");
        let end = bytes.len().checked_sub(WORD).ok_or_else(cut)?;
        let (body, sum) = bytes.split_at(end);
        let mut reader = Reader { rest: body };
        if reader.take(magic.len()).ok_or_else(cut)? != magic.as_slice() {
            return Err(format!("not a {noun} of {of}, or one of another version"));
        }
        if sum != checksum(body).to_le_bytes() {
            return Err(format!("the {noun} is damaged: its checksum does not match its content"));
        }
        let length = reader.count().ok_or_else(cut)?;
        let key = String::from_utf8(reader.take(length).ok_or_else(cut)?.to_vec());
        let key = key.map_err(|_| format!("the {noun} does not say what it follows from"))?;
        let content = read(&mut reader).ok_or_else(cut)?;
        match reader.rest.is_empty() {
            true => Ok((key, content)),
            false => Err(format!("the {noun} goes on beyond its end")),
        }
    }
}

/// Numbers to be stored.
#[derive(Default)]
pub struct Content {
    bytes: Vec<u8>,
}

impl Content {
    pub fn count(&mut self, count: usize) {
        self.bytes.extend_from_slice(&(count as u64).to_le_bytes());
    }

    pub fn numbers(&mut self, numbers: impl IntoIterator<Item = f64>) {
        for number in numbers {
            self.bytes.extend_from_slice(&number.to_le_bytes());
        }
    }
}

/// Remaining stored numbers; reads return `None` at their end.
pub struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(count)?;
        self.rest = rest;
        Some(taken)
    }

    /// Reads a whole number.
    pub fn whole(&mut self) -> Option<usize> {
        usize::try_from(u64::from_le_bytes(self.take(WORD)?.try_into().ok()?)).ok()
    }

    /// Reads a length, which cannot exceed the number of bytes.
    pub fn count(&mut self) -> Option<usize> {
        self.whole().filter(|count| *count <= self.rest.len())
    }

    pub fn numbers(&mut self, count: usize) -> Option<Vec<f64>> {
        let bytes = self.take(count.checked_mul(WORD)?)?;
        let number = |word: &[u8]| Some(f64::from_le_bytes(word.try_into().ok()?));
        bytes.chunks_exact(WORD).map(number).collect()
    }
}

/// FNV-1a (G. Fowler, L. C. Noll, K.-P. Vo 1991), of 64 bits.
fn checksum(bytes: &[u8]) -> u64 {
    let mix = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, mix)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FORMAT: Format = Format { magic: b"IMPTST01", noun: "list", of: "numbers" };

    fn sealed() -> Vec<u8> {
        let mut content = Content::default();
        content.count(2);
        content.numbers([1.5, -0.0]);
        FORMAT.seal("a key", &content)
    }

    fn list(reader: &mut Reader) -> Option<Vec<f64>> {
        let count = reader.count()?;
        reader.numbers(count)
    }

    #[test]
    fn round_trip() {
        let (key, numbers) = FORMAT.open(&sealed(), list).unwrap();
        assert_eq!((key.as_str(), numbers.as_slice()), ("a key", &[1.5, -0.0][..]));
        assert!(numbers[1].is_sign_negative());
    }

    #[test]
    fn damaged_or_truncated_bytes_are_refused() {
        let bytes = sealed();
        for place in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[place] ^= 0x20;
            assert!(FORMAT.open(&damaged, list).is_err(), "byte {place}");
            assert!(FORMAT.open(&bytes[..place], list).is_err(), "{place} bytes");
        }
        let left = FORMAT.open(&bytes, |reader| reader.count()).unwrap_err();
        assert_eq!(left, "the list goes on beyond its end");
        let beyond = FORMAT.open(&bytes, |reader| reader.numbers(9)).unwrap_err();
        assert_eq!(beyond, "the list is cut off");
        let other = Format { magic: b"IMPTST02", ..FORMAT };
        let said = other.open(&bytes, list).unwrap_err();
        assert_eq!(said, "not a list of numbers, or one of another version");
    }
}

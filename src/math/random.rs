//! SplitMix64: the same random numbers on every machine (G. L. Steele, D. Lea & C. H. Flood 2014, doi
//! 10.1145/2660193.2660195).

/// Step of the state.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// A sequence of random numbers.
pub struct Random(u64);

impl Random {
    pub fn of(seed: u64) -> Self {
        Self(seed)
    }

    /// Uniformly distributed in [0, 1).
    pub fn number(&mut self) -> f64 {
        let bits = mixed(self.0);
        self.0 = self.0.wrapping_add(STEP);
        fraction(bits)
    }
}

/// Bits of a number, each of which depends on all of its bits: one step of the sequence.
pub fn mixed(number: u64) -> u64 {
    let bits = number.wrapping_add(STEP);
    let bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// A number in [0, 1) of random bits.
pub fn fraction(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first number of the published generator for the seed 1234567.
    #[test]
    fn numbers_are_those_of_the_published_generator() {
        assert_eq!(mixed(1_234_567), 6_457_827_717_110_365_317);
        let mut random = Random::of(1_234_567);
        assert_eq!(random.number(), fraction(6_457_827_717_110_365_317));
        assert_eq!(random.number(), fraction(3_203_168_211_198_807_973));
    }
}

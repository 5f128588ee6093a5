//! Scatter of strengths and energies.

/// Factor with the mean 1, evenly distributed between `1 − width` and `1 + width`, from a hash of the seed and some
/// numbers (G. L. Steele, D. Lea & C. H. Flood 2014, doi 10.1145/2660193.2660195).
pub fn scattered<const N: usize>(width: f64, seed: u32, numbers: [u64; N]) -> f64 {
    if width == 0.0 {
        return 1.0;
    }
    let mut bits = u64::from(seed);
    for part in numbers {
        bits = bits.wrapping_add(part).wrapping_add(0x9e37_79b9_7f4a_7c15);
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^= bits >> 31;
    }
    let even = (bits >> 11) as f64 / (1_u64 << 53) as f64;
    1.0 + width * (2.0 * even - 1.0)
}

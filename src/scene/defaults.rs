//! Values of keys that several tables may leave out.

pub fn yes() -> bool {
    true
}

/// Dimension of a model in space.
pub fn three() -> usize {
    3
}

/// Heat that has passed since time zero [J], or in some time.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HeatTotals {
    pub brought_in: f64,
    pub lost: f64,
}

//! Points with the functions of nodes there.

/// A function of a node at a point, with its gradient [1/m]; in an axisymmetric model the circumferential strain of a
/// radial displacement u is `value / r · u`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Value {
    pub node: u32,
    pub value: f64,
    pub gradient: [f64; 3],
}

/// Points, each with a row of values.
#[derive(Debug, Clone, Default)]
pub struct Samples {
    /// Places X [m].
    pub at: Vec<[f64; 3]>,
    /// Volumes or areas that the points represent; a model of a plane is a metre deep, a ring goes round.
    pub weights: Vec<f64>,
    starts: Vec<usize>,
    values: Vec<Value>,
}

impl Samples {
    /// Adds a point.
    pub fn push(&mut self, at: [f64; 3], weight: f64, row: impl IntoIterator<Item = Value>) {
        if self.starts.is_empty() {
            self.starts.push(0);
        }
        self.at.push(at);
        self.weights.push(weight);
        self.values.extend(row);
        self.starts.push(self.values.len());
    }

    pub fn len(&self) -> usize {
        self.at.len()
    }

    pub fn is_empty(&self) -> bool {
        self.at.is_empty()
    }

    pub fn row(&self, point: usize) -> &[Value] {
        &self.values[self.starts[point]..self.starts[point + 1]]
    }
}

//! The state of a body: a flat vector of numbers, each of which belongs to a named field.

use std::fmt;

/// A quantity that a state holds, for the whole body or for each of its entries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    pub name: &'static str,
    /// Description of the field, with its unit.
    pub words: &'static str,
    pub per: Per,
    /// Number of values of an entry.
    pub width: usize,
}

/// Objects for which a field has entries.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Per {
    /// The whole body, once.
    Body,
    Cell,
    Drop,
    Face,
    Link,
    Mode,
    Node,
    Particle,
    Point,
    Segment,
}

/// The fields of a state in their order of storage.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Layout {
    /// Each field with its number of entries.
    fields: Vec<(Field, usize)>,
}

/// Field and entry of a number of a state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    pub field: Field,
    pub entry: usize,
    pub component: usize,
}

/// A structure that can be stored as fields.
pub trait Fields {
    /// Returns all fields with their numbers, always in the same order.
    fn fields(&mut self) -> Vec<(Field, &mut [f64])>;
}

impl Layout {
    /// Adds a field with a number of entries.
    pub fn with(mut self, field: Field, entries: usize) -> Self {
        self.fields.push((field, entries));
        self
    }

    /// The layout of a structure with fields.
    pub fn of(fields: &mut dyn Fields) -> Self {
        let entries =
            |(field, numbers): (Field, &mut [f64])| (field, numbers.len() / field.width.max(1));
        Self { fields: fields.fields().into_iter().map(entries).collect() }
    }

    /// Concatenates two layouts.
    pub fn then(mut self, other: Self) -> Self {
        self.fields.extend(other.fields);
        self
    }

    /// Number of values.
    pub fn len(&self) -> usize {
        self.fields.iter().map(|(field, entries)| field.width * entries).sum()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub fn fields(&self) -> impl Iterator<Item = &(Field, usize)> {
        self.fields.iter()
    }

    /// Field and entry of a number; `None` beyond the last.
    pub fn place(&self, index: usize) -> Option<Place> {
        let mut rest = index;
        for &(field, entries) in &self.fields {
            let numbers = field.width * entries;
            if rest < numbers {
                let (entry, component) = (rest / field.width, rest % field.width);
                return Some(Place { field, entry, component });
            }
            rest -= numbers;
        }
        None
    }
}

impl fmt::Display for Place {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        write!(out, "{}", self.field.name)?;
        let entry = match self.field.per {
            Per::Body => return Ok(()),
            Per::Cell => "cell",
            Per::Drop => "drop",
            Per::Face => "face",
            Per::Link => "link",
            Per::Mode => "mode",
            Per::Node => "node",
            Per::Particle => "particle",
            Per::Point => "point",
            Per::Segment => "segment",
        };
        write!(out, " of {entry} {}", self.entry)
    }
}

/// Writes all fields to the beginning of a list; returns the number of values.
pub fn store(fields: &mut dyn Fields, to: &mut [f64]) -> usize {
    let mut at = 0;
    for (_, numbers) in fields.fields() {
        to[at..at + numbers.len()].copy_from_slice(numbers);
        at += numbers.len();
    }
    at
}

/// Replaces a list by the values of all fields.
pub fn store_all(fields: &mut dyn Fields, to: &mut Vec<f64>) {
    to.clear();
    for (_, numbers) in fields.fields() {
        to.extend_from_slice(numbers);
    }
}

/// Reads all fields from the beginning of a list.
pub fn load(fields: &mut dyn Fields, from: &[f64]) {
    let mut at = 0;
    for (_, numbers) in fields.fields() {
        numbers.copy_from_slice(&from[at..at + numbers.len()]);
        at += numbers.len();
    }
}

/// Returns the values of all fields as a list.
pub fn stored<T: Fields + Clone>(fields: &T) -> Vec<f64> {
    let mut fields = fields.clone();
    let mut numbers = vec![0.0; Layout::of(&mut fields).len()];
    store(&mut fields, &mut numbers);
    numbers
}

/// Returns the layout of a list of the same fields; `None` if the list has another length.
pub fn layout_like<T: Fields + Clone>(fields: &T, numbers: &[f64]) -> Option<Layout> {
    Some(Layout::of(&mut fields.clone())).filter(|layout| layout.len() == numbers.len())
}

/// Refuses a list of another length than the same fields of a body have.
pub fn expect_like<T: Fields + Clone>(
    fields: &T,
    numbers: &[f64],
    body: &str,
) -> Result<(), String> {
    let own = Layout::of(&mut fields.clone()).len();
    match numbers.len() == own {
        true => Ok(()),
        false => Err(format!("{} unknowns of {body}; this body has {own}", numbers.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIME: Field = Field { name: "time", words: "[s]", per: Per::Body, width: 1 };
    const PLACE: Field = Field { name: "position", words: "[m]", per: Per::Particle, width: 3 };

    #[derive(Default, PartialEq, Debug)]
    struct Some {
        time: f64,
        position: Vec<[f64; 3]>,
    }

    impl Fields for Some {
        fn fields(&mut self) -> Vec<(Field, &mut [f64])> {
            let time = std::slice::from_mut(&mut self.time);
            vec![(TIME, time), (PLACE, self.position.as_flattened_mut())]
        }
    }

    #[test]
    fn store_load_round_trip() {
        let mut some = Some { time: 2.0, position: vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]] };
        let layout = Layout::of(&mut some);
        assert_eq!(layout.len(), 7);
        let mut numbers = vec![0.0; 9];
        assert_eq!(store(&mut some, &mut numbers), 7);
        let mut other = Some { time: 0.0, position: vec![[0.0; 3]; 2] };
        load(&mut other, &numbers);
        assert_eq!(other, some);
    }

    #[test]
    fn every_number_has_a_name() {
        let layout = Layout::default().with(TIME, 1).with(PLACE, 2);
        let names: Vec<_> = (0..8).map(|n| layout.place(n).map(|p| p.to_string())).collect();
        assert_eq!(names[0].as_deref(), Option::Some("time"));
        assert_eq!(names[6].as_deref(), Option::Some("position of particle 1"));
        assert_eq!(names[7], None);
        assert_eq!(layout.place(6).map(|p| p.component), Option::Some(2));
    }
}

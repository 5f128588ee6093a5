//! Position of a walk through a scene.

use crate::scene::locate::Path;

/// Position of a walk through a scene; its path is built only on request.
#[derive(Default)]
pub struct Place<'v> {
    steps: Vec<Step<'v>>,
    /// Number of variable-length lists that the walk has reached, and whether it is inside the last of them.
    lists: usize,
    is_in_list: bool,
}

enum Step<'v> {
    Key(&'v str),
    Index(usize),
}

impl<'v> Place<'v> {
    pub fn path(&self) -> Path {
        self.steps.iter().fold(Path::default(), |path, step| match step {
            Step::Key(key) => path.key(key),
            Step::Index(index) => path.index(*index),
        })
    }

    /// Number, counted from 1, of the outermost variable-length list of numbers that contains the value.
    pub fn list(&self) -> Option<usize> {
        self.is_in_list.then_some(self.lists)
    }

    pub(super) fn at_key(&mut self, key: &'v str, then: impl FnOnce(&mut Self)) {
        self.at(Step::Key(key), then);
    }

    pub(super) fn at_index(&mut self, index: usize, then: impl FnOnce(&mut Self)) {
        self.at(Step::Index(index), then);
    }

    fn at(&mut self, step: Step<'v>, then: impl FnOnce(&mut Self)) {
        self.steps.push(step);
        then(self);
        self.steps.pop();
    }

    /// Walks through a variable-length list of numbers, or of lists of these.
    pub(super) fn in_list(&mut self, then: impl FnOnce(&mut Self)) {
        let is_outermost = !self.is_in_list;
        if is_outermost {
            self.is_in_list = true;
            self.lists += 1;
        }
        then(self);
        if is_outermost {
            self.is_in_list = false;
        }
    }
}

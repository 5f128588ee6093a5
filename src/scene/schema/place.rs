use crate::scene::locate::Path;

/// Where a walk through a scene stands; its path is made only where it is asked for.
#[derive(Default)]
pub struct Place<'v> {
    steps: Vec<Step<'v>>,
    /// Lists of any length that the walk has come to, and whether it is in the last of them.
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

    /// The number, counted from 1, of the outermost list of any length of numbers that the value is in.
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

    /// Goes through a list of any length of numbers, or of lists of these.
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

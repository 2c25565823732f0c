//! Names of sets, surfaces, materials, …: found in any case, suggested when misspelt, and whether they are used.

use rustc_hash::FxHashMap;

use super::super::lex::key;
use super::super::report::{At, Report, excerpt};

/// Names of one kind of thing, in order of definition.
pub struct Names {
    /// What the things are called in messages, e.g. `node set`.
    kind: &'static str,
    positions: FxHashMap<String, u32>,
    written: Vec<String>,
    /// Lines of the first definitions.
    at: Vec<At>,
    used: Vec<bool>,
    /// The definition was faulty, and that has been reported: whoever refers to it need not complain again.
    faulty: Vec<bool>,
}

impl Names {
    /// No names yet.
    pub fn new(kind: &'static str) -> Self {
        Self {
            kind,
            positions: FxHashMap::default(),
            written: Vec::new(),
            at: Vec::new(),
            used: Vec::new(),
            faulty: Vec::new(),
        }
    }

    /// Position of a name, added when it is new; whether it is new.
    pub fn enter(&mut self, name: &str, at: At) -> (u32, bool) {
        let next = self.written.len() as u32;
        let position = *self.positions.entry(key(name)).or_insert(next);
        if position == next {
            self.written.push(name.to_string());
            self.at.push(at);
            self.used.push(false);
            self.faulty.push(false);
        }
        (position, position == next)
    }

    /// Marks a definition as faulty.
    pub fn mark_faulty(&mut self, position: u32) {
        self.faulty[position as usize] = true;
    }

    /// Whether a definition is faulty.
    pub fn is_faulty(&self, position: u32) -> bool {
        self.faulty[position as usize]
    }

    /// Position of a name.
    pub fn find(&self, name: &str) -> Option<u32> {
        self.positions.get(&key(name)).copied()
    }

    /// Position of a name that a line refers to; `None` when there is none, which is reported, or when it is faulty.
    #[track_caller]
    pub fn refer(&mut self, name: &str, at: At, keyword: &str, report: &mut Report) -> Option<u32> {
        let Some(position) = self.find(name) else {
            let remedy = self.remedy(name, report);
            report.error(at, keyword, self.missing(name), remedy);
            return None;
        };
        self.used[position as usize] = true;
        (!self.is_faulty(position)).then_some(position)
    }

    /// Message about a name that does not exist.
    pub fn missing(&self, name: &str) -> String {
        format!("there is no {} {}", self.kind, excerpt(name.as_bytes()))
    }

    /// Remedy for a name that does not exist.
    pub fn remedy(&self, name: &str, report: &mut Report) -> String {
        match report.suggest(name, self.written.iter().map(String::as_str)) {
            Some(near) => format!("did you mean {near}?"),
            None => "define it, or correct the name".to_string(),
        }
    }

    /// The name as first written.
    pub fn written(&self, position: u32) -> &str {
        &self.written[position as usize]
    }

    /// Line of the first definition.
    pub fn at(&self, position: u32) -> At {
        self.at[position as usize]
    }

    /// Marks a name as used.
    pub fn mark_used(&mut self, position: u32) {
        self.used[position as usize] = true;
    }

    /// Positions of names that nothing refers to.
    pub fn unused(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.used.len() as u32).filter(|&position| !self.used[position as usize])
    }
}

/// Finds the position of a label.
pub enum Labels {
    /// Positions by label, `u32::MAX` where there is none.
    Dense(Vec<u32>),
    /// Labels far apart.
    Sparse(FxHashMap<u32, u32>),
}

impl Labels {
    /// Positions of labels; the first of equal labels counts.
    pub fn of(labels: &[u32]) -> Self {
        let largest = labels.iter().copied().max().unwrap_or(0) as usize;
        if largest <= 8 * labels.len() + 1024 {
            let mut dense = vec![u32::MAX; largest + 1];
            for (position, &label) in labels.iter().enumerate().rev().map(|(i, label)| (i as u32, label)) {
                dense[label as usize] = position;
            }
            return Self::Dense(dense);
        }
        let mut sparse = FxHashMap::with_capacity_and_hasher(labels.len(), Default::default());
        for (position, &label) in (0..).zip(labels) {
            sparse.entry(label).or_insert(position);
        }
        Self::Sparse(sparse)
    }

    /// Position of a label.
    pub fn get(&self, label: u32) -> Option<u32> {
        match self {
            Self::Dense(dense) => dense.get(label as usize).copied().filter(|&position| position != u32::MAX),
            Self::Sparse(sparse) => sparse.get(&label).copied(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_in_any_case() {
        let mut names = Names::new("node set");
        assert_eq!(names.enter("Top", At(1)), (0, true));
        assert_eq!(names.enter("TOP", At(2)), (0, false));
        assert_eq!(names.find(" top "), Some(0));
        assert_eq!(names.written(0), "Top");
        assert_eq!(names.remedy("TOPP", &mut Report::default()), "did you mean Top?");
    }

    #[test]
    fn labels_near_and_far_apart_are_found() {
        for labels in [vec![7, 3, 7, 5], vec![4_000_000_000, 3, 4_000_000_000, 5]] {
            let positions = Labels::of(&labels);
            assert_eq!(
                labels.iter().map(|&l| positions.get(l)).collect::<Vec<_>>(),
                [Some(0), Some(1), Some(0), Some(3)]
            );
            assert_eq!(positions.get(4), None);
        }
    }
}

//! What steps write, and when.

use super::{ContactPair, SetId, SurfaceId};

/// What a step writes, and how often.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OutputRequests {
    /// `*NODE PRINT`, `*NODE FILE`, `*NODE OUTPUT`.
    pub nodes: Vec<NodeRequest>,
    /// `*EL PRINT`, `*EL FILE`, `*ELEMENT OUTPUT`.
    pub elements: Vec<ElementRequest>,
    /// `*CONTACT PRINT`, `*CONTACT FILE`, `*CONTACT OUTPUT`.
    pub contacts: Vec<ContactRequest>,
    /// `*OUTPUT, HISTORY`: when the history of an explicit step has a row; none: at every increment.
    pub history: Vec<OutputFrequency>,
    /// `*RESTART, WRITE`: snapshots from which a run can go on.
    pub restart: Option<RestartRequest>,
}

/// When a request is due within a step. At the last increment of the step each is, unless it never is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutputFrequency {
    /// `FREQUENCY`: every so many increments, counted from the start of the step. 0: never.
    Increments(u32),
    /// `NUMBER INTERVAL`: at the increments that reach the ends of so many equal parts of the step, at least one.
    Intervals(u32),
    /// `TIME INTERVAL`: at the increments that reach the multiples of a time since the start of the step \[time\], positive.
    TimeInterval(f64),
}

impl OutputFrequency {
    /// At every increment.
    pub const EVERY: Self = Self::Increments(1);

    /// Whether it is never due.
    pub fn is_never(self) -> bool {
        self == Self::Increments(0)
    }
}

/// When snapshots are written within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RestartFrequency {
    /// Every so many increments (at least 1), counted from the start of the step; and at the end of the step.
    Increments(u32),
    /// `NUMBER INTERVAL`: at the increments that reach the ends of so many equal parts of the step (at least 1).
    Intervals(u32),
    /// At the end of the step only.
    StepEnd,
}

/// Request for snapshots in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RestartRequest {
    /// When.
    pub frequency: RestartFrequency,
    /// `OVERLAY`: only the latest snapshot is kept.
    pub overlay: bool,
}

/// Where a request wants its values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutputTarget {
    /// `... PRINT`: the printed table.
    Print,
    /// `... FILE`: the results file, and field results.
    File,
    /// `*OUTPUT, FIELD`: field results.
    Field,
    /// `*OUTPUT, HISTORY`.
    History,
}

/// Rows of single nodes, their totals, or both (`TOTALS=` of CalculiX and Abaqus).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Totals {
    /// `NO`: rows only.
    #[default]
    No,
    /// `YES`: rows and totals.
    Yes,
    /// `ONLY`: totals only.
    Only,
}

/// Request for nodal values.
#[derive(Clone, Debug, PartialEq)]
pub struct NodeRequest {
    /// Where to.
    pub target: OutputTarget,
    /// Node set; `None` is all nodes.
    pub set: Option<SetId>,
    /// Variables in upper case, e.g. `U`, `RF`.
    pub variables: Vec<String>,
    /// When.
    pub frequency: OutputFrequency,
    /// Rows, totals or both.
    pub totals: Totals,
    /// `SUMMARY`: whether the extremes of each column are printed below it.
    pub summary: bool,
}

/// Request for element values.
#[derive(Clone, Debug, PartialEq)]
pub struct ElementRequest {
    /// Where to.
    pub target: OutputTarget,
    /// Element set; `None` is all elements.
    pub set: Option<SetId>,
    /// Variables in upper case, e.g. `S`, `E`.
    pub variables: Vec<String>,
    /// When.
    pub frequency: OutputFrequency,
    /// `SUMMARY`: whether the extremes of each column are printed below it.
    pub summary: bool,
}

/// Request for contact values.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactRequest {
    /// Where to.
    pub target: OutputTarget,
    /// Components at the points by name (`CPRESS`, `COPEN`, `CSTATUS`, …) and totals of the pair by family (`CFN`, `CMT`, `XN`, `CAREA`, …).
    pub variables: Vec<String>,
    /// When.
    pub frequency: OutputFrequency,
    /// Pairs with this secondary surface; `None` is any.
    pub secondary: Option<SurfaceId>,
    /// Pairs with this primary surface; `None` is any.
    pub primary: Option<SurfaceId>,
    /// Secondary nodes of this set; `None` is all.
    pub nodes: Option<SetId>,
    /// `TOTALS`: whether the sum of each column is printed below it.
    pub totals: bool,
    /// `SUMMARY`: whether the extremes of each column are printed below it.
    pub summary: bool,
}

impl ContactRequest {
    /// Whether it is about a pair. Contact elements have no surfaces: a request that names some is not about them.
    pub fn selects(&self, pair: &ContactPair) -> bool {
        let is = |wanted: Option<SurfaceId>, surface: SurfaceId| wanted.is_none_or(|wanted| wanted == surface);
        match pair.surfaces() {
            Some(surfaces) => is(self.secondary, surfaces.secondary) && is(self.primary, surfaces.primary),
            None => self.secondary.is_none() && self.primary.is_none() && self.nodes.is_none(),
        }
    }

    /// Whether it asks for one of these variables.
    pub fn asks_for(&self, names: &[&str]) -> bool {
        self.variables.iter().any(|variable| names.contains(&variable.as_str()))
    }
}

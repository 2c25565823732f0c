//! Contact in a step: rules of all points, sorted by how they are treated, and what they leave of the stable increment.

use rustc_hash::FxHashMap;

use super::limits::NodeLimit;
use super::phase::Phase;
use super::rules::{Law, Laws, Rule};
use super::stable;
use crate::model::MechanicalConstraint;

/// Balanced pairs of one weight.
#[derive(Clone, Debug, Default)]
pub struct Balanced {
    /// Weight of the points of the first surface.
    pub weight: f64,
    /// Points of first surfaces.
    pub own: Vec<u32>,
    /// Points of second surfaces.
    pub mirrored: Vec<u32>,
}

/// A step.
pub struct StepPlan {
    /// Phase, by position.
    pub phase: usize,
    /// Rule of each point.
    pub rules: Vec<Rule>,
    /// Kinematic points of pure pairs.
    pub pure: Vec<u32>,
    /// Kinematic points of balanced pairs.
    pub balanced: Vec<Balanced>,
    /// Whether the corrector of the manual covers a point.
    pub simple: Vec<bool>,
    /// Penalty points.
    pub penalties: Vec<u32>,
    /// Penalty points whose stiffness changes with the overclosure.
    pub curved: Vec<u32>,
    /// Rows of the other ones with their stiffness and viscosity.
    pub straight: Vec<Spring>,
    /// What elements leave at the nodes that penalty points touch.
    pub under: NodeLimit,
    /// Whether pairs act that did not, or the other way round, in the step before.
    pub changed: bool,
}

/// A row with its stiffness [force/length] and viscosity [force·time/length].
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// The row.
    pub row: u32,
    /// Stiffness.
    pub stiffness: f64,
    /// Viscosity.
    pub viscosity: f64,
}

impl LimitWork {
    /// For some slots.
    pub fn new(slots: usize) -> Self {
        Self { sums: vec![0.0; slots], ..Self::default() }
    }
}

impl StepPlan {
    /// From the rules of a step.
    pub fn new(phase_index: usize, phase: &Phase, laws: &Laws, rules: Vec<Rule>, changed: bool) -> Self {
        let kinematic = |r: &Rule| r.acts && r.constraint == MechanicalConstraint::Kinematic;
        let of = |pick: &dyn Fn(&Rule) -> bool| -> Vec<u32> {
            rules.iter().zip(0u32..).filter(|(r, _)| pick(r)).map(|(_, i)| i).collect()
        };
        let pure = of(&|r| kinematic(r) && r.share == 1.0);
        let mut balanced: Vec<Balanced> = Vec::new();
        for (rule, i) in rules.iter().zip(0u32..).filter(|(r, _)| kinematic(r) && r.share != 1.0) {
            let weight = if rule.mirrored { 1.0 - rule.share } else { rule.share };
            let found = balanced.iter().position(|b| b.weight == weight).unwrap_or_else(|| {
                balanced.push(Balanced { weight, ..Balanced::default() });
                balanced.len() - 1
            });
            let list = if rule.mirrored { &mut balanced[found].mirrored } else { &mut balanced[found].own };
            list.push(i);
        }
        let mut simple = vec![false; rules.len()];
        for list in std::iter::once(&pure).chain(balanced.iter().flat_map(|b| [&b.own, &b.mirrored])) {
            mark_simple(phase, &rules, list, &mut simple);
        }
        let penalties = of(&|r| r.acts && r.constraint == MechanicalConstraint::Penalty);
        let (mut curved, mut straight) = (Vec::new(), Vec::new());
        for &i in &penalties {
            let rule = &rules[i as usize];
            match laws.constant_slope(rule) {
                Some(slope) => straight.extend(springs(rule, i, slope)),
                None => curved.push(i),
            }
        }
        let mut under = NodeLimit::default();
        for &point in &penalties {
            for &(slot, _) in &phase.slots.rows[point as usize].entries {
                let node = phase.slots.at[slot as usize] as usize / 3;
                let limit = phase.limits.nodes[node];
                under.stiffness = under.stiffness.max(limit.stiffness);
                under.damping = under.damping.max(limit.damping);
                under.bulk = under.bulk.max(limit.bulk);
            }
        }
        Self { phase: phase_index, rules, pure, balanced, simple, penalties, curved, straight, under, changed }
    }

    /// Whether any kinematic points act.
    pub fn has_kinematic(&self) -> bool {
        !self.pure.is_empty() || !self.balanced.is_empty()
    }
}

/// Springs of a point: its own, and those against slip.
pub fn springs(rule: &Rule, point: u32, slope: f64) -> impl Iterator<Item = Spring> + use<> {
    let normal = Spring { row: point, stiffness: rule.area * slope, viscosity: rule.viscosity(slope) };
    let slip = Spring {
        row: rule.tangential.unwrap_or(0),
        stiffness: rule.stiffness,
        viscosity: rule.tangent_fraction * normal.viscosity,
    };
    let tangential = if rule.rough && rule.tangential.is_some() { 2 } else { 0 };
    std::iter::once(normal).chain((0..tangential).map(move |k| Spring { row: slip.row + k, ..slip }))
}

/// Stable increment under some springs \[time\], and the row that limits it; `bulk`: factor on bulk viscosity. Normal and tangential
/// rows act along directions at right angles: the larger bound counts.
pub fn increment_under(
    phase: &Phase,
    plan: &StepPlan,
    springs: &[Spring],
    points: usize,
    bulk: f64,
    work: &mut LimitWork,
) -> (f64, Option<u32>) {
    let (mut stiffness, mut viscosity, mut at) = (0.0f64, 0.0f64, None);
    for tangential in [false, true] {
        for viscous in [false, true] {
            work.rows.clear();
            let value = |s: &Spring| if viscous { s.viscosity } else { s.stiffness };
            let wanted = springs.iter().filter(|s| (s.row as usize >= points) == tangential && value(s) > 0.0);
            work.rows.extend(wanted.map(|s| (s.row, value(s))));
            if work.rows.is_empty() {
                continue;
            }
            let (bound, row) = stable::bound(&phase.slots, &work.rows, &mut work.sums);
            match viscous {
                false if bound > stiffness => (stiffness, at) = (bound, row),
                true => viscosity = viscosity.max(bound),
                false => {}
            }
        }
    }
    if stiffness == 0.0 && viscosity == 0.0 {
        return (f64::INFINITY, None);
    }
    let under = plan.under;
    let limit = stable::increment(under.stiffness + stiffness, under.damping + bulk * under.bulk + viscosity);
    (limit, at)
}

/// Work space of limits.
#[derive(Default)]
pub struct LimitWork {
    /// A zero for each slot.
    sums: Vec<f64>,
    rows: Vec<(u32, f64)>,
    /// Springs of the present increment.
    pub springs: Vec<Spring>,
}

/// Hard points whose secondary node has no other part in the list.
fn mark_simple(phase: &Phase, rules: &[Rule], list: &[u32], simple: &mut [bool]) {
    let slots = &phase.slots;
    let own = |i: u32| {
        let row = &slots.rows[i as usize];
        row.own.map(|(from, _)| slots.unit[row.entries[from as usize].0 as usize])
    };
    // How often each unit is that of a secondary node, or on the primary side.
    let mut uses: FxHashMap<u32, u32> = FxHashMap::default();
    for &i in list {
        let row = &slots.rows[i as usize];
        own(i).into_iter().chain(row.parts.iter().map(|p| p.unit)).for_each(|u| *uses.entry(u).or_default() += 1);
    }
    for &i in list {
        let alone = own(i).is_some_and(|unit| uses[&unit] == 1);
        simple[i as usize] = alone && slots.rows[i as usize].simple && rules[i as usize].law == Law::Hard;
    }
}

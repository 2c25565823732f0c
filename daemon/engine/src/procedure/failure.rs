//! Why an increment failed, in words.

use crate::simulation::Simulation;
use crate::solve::contact::SolveFailure;

/// Points named in a message.
const NAMED_POINTS: usize = 6;

/// Why an attempt failed.
pub(crate) enum Failure {
    /// The contact solve.
    Solve(SolveFailure),
    /// Points that slide too far.
    Slid(Vec<u32>),
    /// Numbers that are none.
    Overflow,
    /// Hard contact changes too often in one increment.
    Events,
    /// A matrix without inverse, in words.
    Singular(String),
    /// By how much the work of contact misses what its laws store, and the largest energy \[energy\].
    ContactWork { error: f64, largest: f64 },
    /// The residual half-way through an increment and what it may be \[force\].
    HalfIncrement { residual: f64, tolerance: f64 },
}

impl Failure {
    /// A smaller increment cannot help a point that slides or an input beyond all measure.
    pub fn is_final(&self) -> bool {
        matches!(
            self,
            Failure::Slid(_) | Failure::Overflow | Failure::Singular(_) | Failure::Solve(SolveFailure::Unheld { .. })
        )
    }

    pub fn describe(&self, simulation: &Simulation) -> String {
        let prepared = &simulation.prepared;
        let name = |&i: &u32| {
            let point = &prepared.row_points[i as usize];
            format!(
                "{} (pair {})",
                prepared.model.mesh.node_labels[point.node.index()],
                prepared.model.pairs[point.pair as usize].name
            )
        };
        let list = |points: &[u32]| {
            let named: Vec<String> = points.iter().take(NAMED_POINTS).map(name).collect();
            let more = if points.len() > NAMED_POINTS {
                format!(" and {} more", points.len() - NAMED_POINTS)
            } else {
                String::new()
            };
            format!("{}{more}", named.join(", "))
        };
        let after = format!("after total time {}", simulation.time());
        match self {
            Failure::Overflow => {
                format!("{after}: the solution leaves the range of numbers; an input is too large for this model")
            }
            Failure::Events => format!(
                "{after}: points of hard contact keep closing and opening at one time; smaller increments or a softened law may help"
            ),
            Failure::Singular(words) => format!("{after}: {words}"),
            Failure::ContactWork { error, largest } => format!(
                "{after}: contact meets its law too fast: its work misses the energy of the law by {error:e}, the largest energy so far is {largest:e}; a smaller least increment lets it follow"
            ),
            Failure::HalfIncrement { residual, tolerance } => format!(
                "{after}: forces half-way through the increment are out of balance by {residual:e}, more than {tolerance:e}; a larger HAFTOL or a smaller least increment lets it pass"
            ),
            Failure::Slid(points) => format!(
                "{after}: a secondary node slides beyond half a face of the primary surface, which small sliding does not cover: node {}",
                list(points)
            ),
            Failure::Solve(SolveFailure::Unheld { motions }) => {
                let (name, motion) = prepared.describe_motion(motions);
                format!(
                    "{after}: {name} is loaded along a motion that neither supports nor contact hold: {motion}; hold it by *BOUNDARY or a spring, or let contact resist it"
                )
            }
            Failure::Solve(SolveFailure::Unsettled) => format!(
                "{after}: contact does not settle: statuses or the multipliers of augmented Lagrange keep changing; a larger penetration tolerance or penalty stiffness needs fewer augmentations"
            ),
            Failure::Solve(SolveFailure::NotConverged { points }) => {
                format!("{after}: no equilibrium found; points that kept changing: node {}", list(points))
            }
            Failure::Solve(SolveFailure::Infeasible { points }) => {
                let only: Vec<u32> = points.iter().map(|p| p.0).collect();
                let worst = points.iter().map(|p| p.1.abs()).fold(0.0, f64::max);
                if points.iter().all(|p| p.0 as usize >= prepared.points.len()) {
                    return format!(
                        "{after}: prescribed motions slide surfaces under rough friction by up to {worst:e} and nothing can give way: node {}",
                        list(&only)
                    );
                }
                format!(
                    "{after}: prescribed motions push hard surfaces into each other by up to {worst:e} and nothing can give way: node {}",
                    list(&only)
                )
            }
        }
    }
}

//! What can be read from an analysis.

use serde::{Deserialize, Serialize};

use crate::model::NodeId;

/// What never changes about a contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPointInfo {
    /// Index into `model().pairs`.
    pub pair: u32,
    /// Secondary node.
    pub node: NodeId,
    /// Tributary area \[length²\].
    pub area: f64,
    /// Unit normal of the primary, towards the secondary.
    pub normal: [f64; 3],
    /// Initial clearance \[length\].
    pub clearance: f64,
}

/// Status of a contact point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ContactStatus {
    /// No contact.
    #[serde(rename = "OP")]
    Open,
    /// Closed, frictionless.
    #[serde(rename = "CL")]
    Closed,
    /// Closed with friction, sticking.
    #[serde(rename = "ST")]
    Sticking,
    /// Closed with friction, slipping.
    #[serde(rename = "SL")]
    Slipping,
    /// Open, with a pressure from viscous damping alone.
    #[serde(rename = "VD")]
    Viscous,
}

impl ContactStatus {
    /// Whether the surfaces touch, frictionless or not.
    pub const fn is_closed(self) -> bool {
        match self {
            Self::Closed | Self::Sticking | Self::Slipping => true,
            Self::Open | Self::Viscous => false,
        }
    }

    /// Two letters of printed tables: OP, CL, ST, SL, VD.
    pub const fn code(self) -> &'static str {
        match self {
            Self::Open => "OP",
            Self::Closed => "CL",
            Self::Sticking => "ST",
            Self::Slipping => "SL",
            Self::Viscous => "VD",
        }
    }

    /// `CSTATUS` as a number, for fields: 0 open, 1 closed, 2 sticking, 3 slipping, 4 open with viscous damping only.
    pub const fn number(self) -> i8 {
        match self {
            Self::Open => 0,
            Self::Closed => 1,
            Self::Sticking => 2,
            Self::Slipping => 3,
            Self::Viscous => 4,
        }
    }
}

/// Result at a contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPointResult {
    /// Status.
    pub status: ContactStatus,
    /// COPEN: clearance \[length\], negative when the bodies overlap.
    pub clearance: f64,
    /// CPRESS: contact pressure \[pressure\], positive in compression, with its viscous part.
    pub pressure: f64,
    /// CDPRESS: the part of `pressure` that damping gives \[pressure\].
    pub viscous: f64,
    /// CSHEAR1, CSHEAR2 \[pressure\], with their viscous parts.
    pub shear: [f64; 2],
    /// CDSHEAR1, CDSHEAR2: the parts of `shear` that damping gives \[pressure\].
    pub viscous_shear: [f64; 2],
    /// CSLIP1, CSLIP2: accumulated slip while closed \[length\].
    pub slip: [f64; 2],
}

/// Totals of a pair at the end of an increment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairTotals {
    /// CFN1..3: force on the secondary surface due to pressure.
    pub force: [f64; 3],
    /// CFNM: its magnitude.
    pub force_magnitude: f64,
    /// CAREA: area of the closed points.
    pub area: f64,
    /// CFS1..3: force on the secondary surface due to friction.
    pub shear_force: [f64; 3],
    /// CMN1..3: moment of the pressure on the secondary surface about the origin \[force·length\].
    pub moment: [f64; 3],
    /// CMS1..3: moment of the friction on it about the origin \[force·length\].
    pub shear_moment: [f64; 3],
}

/// Energies at the end of an increment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energies {
    /// ALLSE: strain energy of the bodies.
    pub strain: f64,
    /// ALLKE: kinetic energy.
    pub kinetic: f64,
    /// ALLWK: work of loads and prescribed displacements.
    pub external_work: f64,
    /// ALLFD: frictional dissipation.
    pub friction: f64,
    /// ALLVD: viscous dissipation.
    pub viscous: f64,
    /// ALLCCE: energy stored in softened contact.
    pub contact: f64,
    /// IMPACT_LOSS: kinetic energy lost in impacts.
    pub impact_loss: f64,
    /// ETOTAL: stored plus dissipated less external work; constant when the solution is exact.
    pub total: f64,
}

/// One row of the history.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HistoryRow {
    /// Per contact pair.
    pub pairs: Vec<PairTotals>,
    /// Energies.
    pub energies: Energies,
    /// Total reaction force per set of [`PreparedModel::total_set_names`](crate::simulation::PreparedModel::total_set_names).
    pub reactions: Vec<[f64; 3]>,
}

/// Nodal fields, recovered by one solve. One entry per node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NodalSolution {
    /// U \[length\].
    pub displacement: Vec<[f64; 3]>,
    /// V [length/time]; empty in a static step. In an explicit step that of the middle of the last increment.
    pub velocity: Vec<[f64; 3]>,
    /// A [length/time²]; empty in a static step. In an explicit step that of the start of the last increment.
    pub acceleration: Vec<[f64; 3]>,
    /// RF \[force\]: non-zero at prescribed directions only.
    pub reaction: Vec<[f64; 3]>,
}

/// Work counts, per step.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct WorkCounts {
    /// Increments completed.
    pub increments: u32,
    /// Equilibrium iterations.
    pub equilibrium_iterations: u32,
    /// Severe discontinuity iterations: those that changed a contact status.
    pub severe_discontinuity_iterations: u32,
    /// Cutbacks.
    pub cutbacks: u32,
    /// Sparse factorisations done for this step.
    pub factorizations: u32,
    /// Augmentations: times that multipliers of augmented Lagrange were brought up to date.
    pub augmentations: u32,
    /// Impacts: instants of implicit dynamic steps at which hard contact closed and velocities jumped.
    pub impacts: u32,
}

/// What a step has done so far.
#[derive(Clone, Debug, PartialEq)]
pub struct StepReport {
    /// Name of the step.
    pub name: String,
    /// `*STATIC`, ….
    pub procedure: &'static str,
    /// Total time reached.
    pub time_reached: f64,
    /// Work.
    pub counts: WorkCounts,
}

/// A contact point that changed status in an increment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StatusChange {
    /// Index into [`PreparedModel::contact_points`](crate::simulation::PreparedModel::contact_points).
    pub point: u32,
    /// Status at the start of the increment.
    pub from: ContactStatus,
    /// Status at the end of the increment.
    pub to: ContactStatus,
}

/// One line of the increments table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IncrementReport {
    /// Step number, from 1.
    pub step: u32,
    /// Increment number within the step, from 1.
    pub increment: u32,
    /// Attempt that succeeded, from 1.
    pub attempt: u32,
    /// Severe discontinuity iterations of the attempt.
    pub severe_discontinuity_iterations: u32,
    /// Equilibrium iterations of the attempt.
    pub equilibrium_iterations: u32,
    /// Total time at the end.
    pub time: f64,
    /// Step time at the end.
    pub step_time: f64,
    /// Size of the increment.
    pub increment_size: f64,
    /// In an explicit step the largest increment that would have been stable \[time\].
    pub stable_increment: Option<f64>,
    /// Points whose status at the end differs from that at the start: the contact log.
    pub status_changes: Vec<StatusChange>,
}

/// An increment that was tried in vain.
#[derive(Clone, Debug, PartialEq)]
pub struct CutbackReport {
    /// Step number, from 1.
    pub step: u32,
    /// Increment that was tried, from 1.
    pub increment: u32,
    /// Attempt that failed, from 1.
    pub attempt: u32,
    /// Its size \[time\].
    pub increment_size: f64,
    /// Size of the next attempt \[time\].
    pub next_size: f64,
    /// Why it failed, in words.
    pub reason: String,
}

/// A field: row-major values, one row per label.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// `U`, `UR`, `RF`, `RM`, in dynamic steps `V`, `VR`, `A`, `AR`; `S`, `CPRESS`, `CSHEAR`, `CDPRESS`, `CDSHEAR`, `COPEN`, `CSLIP`, `CSTATUS`.
    pub name: String,
    /// Node label of each row.
    pub labels: Vec<u32>,
    /// Values per row.
    pub components: usize,
    /// `labels.len() * components` values.
    pub values: Vec<f64>,
}

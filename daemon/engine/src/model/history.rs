//! Steps: procedures, loads and prescribed displacements.

use super::{AmplitudeId, ElementFace, ElementId, NodeId, OutputRequests, SetId, StepContact, SurfaceId};
use crate::diagnostic::Place;

/// `*STEP` … `*END STEP`.
#[derive(Clone, Debug)]
pub struct Step {
    /// `NAME=` or `Step-1`, `Step-2`, ….
    pub name: String,
    /// `INC=`: most increments of the step; 100 unless given.
    pub increments_max: u32,
    /// Procedure and its data line.
    pub procedure: Procedure,
    /// How values without an amplitude of their own are reached.
    pub default_amplitude: DefaultAmplitude,
    /// `*BOUNDARY` lines of the step, in order.
    pub boundaries: Vec<Boundary>,
    /// `*CLOAD`, `*DLOAD`, `*DSLOAD` lines of the step, in order.
    pub loads: Vec<Load>,
    /// Whether `*CLOAD, OP=NEW` / `*DLOAD, OP=NEW` / `*DSLOAD, OP=NEW` removes the loads of earlier steps.
    pub loads_removed: LoadsRemoved,
    /// Contact controls, pairs that act, interferences.
    pub contact: StepContact,
    /// What to write.
    pub output: OutputRequests,
    /// Line of `*STEP`.
    pub place: Place,
}

/// `AMPLITUDE` of `*STEP`: how loads and prescribed values without an amplitude of their own are reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DefaultAmplitude {
    /// Linearly over the step, from where they were: what `*STATIC` does unless told otherwise.
    #[default]
    Ramp,
    /// At once, at the start of the step: what `*DYNAMIC` does unless told otherwise.
    Step,
}

/// Kinds of loads whose earlier values do not carry over into this step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LoadsRemoved {
    /// `*CLOAD, OP=NEW`.
    pub cload: bool,
    /// `*DLOAD, OP=NEW`.
    pub dload: bool,
    /// `*DSLOAD, OP=NEW`.
    pub dsload: bool,
}

/// What a step does. The steps of a deck are all of Abaqus/Standard (`*STATIC`, `*DYNAMIC`) or all of Abaqus/Explicit.
#[derive(Clone, Debug, PartialEq)]
pub enum Procedure {
    /// `*STATIC`.
    Static(StaticControl),
    /// `*DYNAMIC`: implicit.
    Dynamic(DynamicControl),
    /// `*DYNAMIC, EXPLICIT`.
    Explicit(ExplicitControl),
}

impl Procedure {
    /// Length of the step \[time\].
    pub fn period(&self) -> f64 {
        match self {
            Self::Static(control) => control.period,
            Self::Dynamic(control) => control.period,
            Self::Explicit(control) => control.period,
        }
    }

    /// Size of the first increment \[time\]; of an explicit step with automatic increments 0: it follows from the model.
    pub fn increment_first(&self) -> f64 {
        match self {
            Self::Static(control) => control.increment_initial.min(control.increment_max),
            Self::Dynamic(control) => control.increment_initial.min(control.increment_max),
            Self::Explicit(control) => match control.increments {
                ExplicitIncrements::Direct(size) => size,
                ExplicitIncrements::Automatic { .. } => 0.0,
            },
        }
    }

    /// How implicit increments are chosen; none for an explicit step.
    pub fn implicit_increments(&self) -> Option<StaticControl> {
        match *self {
            Self::Static(control) => Some(control),
            Self::Dynamic(DynamicControl {
                increment_initial, period, increment_min, increment_max, direct, ..
            }) => Some(StaticControl { increment_initial, period, increment_min, increment_max, direct }),
            Self::Explicit(_) => None,
        }
    }

    /// The keyword.
    pub fn keyword(&self) -> &'static str {
        match self {
            Self::Static(_) => "*STATIC",
            Self::Dynamic(_) => "*DYNAMIC",
            Self::Explicit(_) => "*DYNAMIC, EXPLICIT",
        }
    }

    /// Whether inertia takes part.
    pub fn is_dynamic(&self) -> bool {
        !matches!(self, Self::Static(_))
    }
}

/// `*DYNAMIC`: parameters and data line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicControl {
    /// First (or, with DIRECT, every) increment \[time\]: the base of automatic sizes, which are base · 2^k.
    pub increment_initial: f64,
    /// Length of the step \[time\].
    pub period: f64,
    /// Smallest increment before the step stops; default 1e-5 of the period (or the first increment, if smaller).
    pub increment_min: f64,
    /// Largest increment; default the period.
    pub increment_max: f64,
    /// `DIRECT`: increments are fixed, no cutback.
    pub direct: bool,
    /// `ALPHA` of the operator, -1/3..=0; -0.05 unless given.
    pub alpha: f64,
    /// What bounds the half-increment residual of automatic increments.
    pub half_increment: HalfIncrement,
    /// `INITIAL`: whether accelerations at the start of the step are computed from equilibrium; they are unless `INITIAL=NO`.
    pub initial_accelerations: bool,
    /// Mass matrix.
    pub mass: MassMatrix,
}

/// What bounds the half-increment residual of automatic implicit increments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum HalfIncrement {
    /// `NOHAF`: nothing, increments grow to the largest one.
    Unchecked,
    /// `HAFTOL`: largest residual force at a node \[force\].
    Force(f64),
    /// Neither given: this factor on the largest force so far (external, inertia, contact).
    Relative(f64),
}

/// How the mass of elements is attached to their nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MassMatrix {
    /// First-order elements lumped, second-order elements consistent: what Abaqus/Standard does.
    #[default]
    ByOrder,
    /// `MASS=LUMPED` (our option).
    Lumped,
    /// `MASS=CONSISTENT` (our option); what CalculiX does.
    Consistent,
}

/// `*DYNAMIC, EXPLICIT`: parameters, data line, `*BULK VISCOSITY`, `*FIXED MASS SCALING`.
#[derive(Clone, Debug, PartialEq)]
pub struct ExplicitControl {
    /// Length of the step \[time\], positive.
    pub period: f64,
    /// Sizes of increments.
    pub increments: ExplicitIncrements,
    /// Largest increment \[time\]; none: the stable one.
    pub increment_max: Option<f64>,
    /// Linear and quadratic bulk viscosity; 0.06 and 1.2 unless given.
    pub bulk_viscosity: [f64; 2],
    /// `*FIXED MASS SCALING`, in order; later lines act on what earlier ones leave.
    pub mass_scaling: Vec<MassScaling>,
}

/// Sizes of explicit increments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ExplicitIncrements {
    /// The stable increment times a factor (`SCALE FACTOR`, 1 unless given).
    Automatic {
        /// The factor, in 0..=1.
        scale: f64,
    },
    /// `DIRECT USER CONTROL`: this size \[time\].
    Direct(f64),
}

/// `*FIXED MASS SCALING`, at the start of the step.
#[derive(Clone, Debug, PartialEq)]
pub struct MassScaling {
    /// Elements; none: all.
    pub element_set: Option<SetId>,
    /// How much.
    pub kind: MassScalingKind,
}

/// How masses are scaled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MassScalingKind {
    /// `FACTOR`: by a factor, positive.
    Factor(f64),
    /// `DT` with `TYPE=UNIFORM`: all by one factor, so that the smallest stable increment becomes this \[time\].
    Uniform(f64),
    /// `DT` with `TYPE=BELOW MIN`: each element below this stable increment up to it \[time\].
    BelowMin(f64),
    /// `DT` with `TYPE=SET EQUAL DT`: each element to it \[time\].
    SetEqual(f64),
}

/// Data line of `*STATIC`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticControl {
    /// First (or, with DIRECT, every) increment \[time\]; defaults to the period.
    pub increment_initial: f64,
    /// Length of the step \[time\]; 1 unless given.
    pub period: f64,
    /// Smallest increment before the step stops; default 1e-5 of the period (or the first increment, if smaller).
    pub increment_min: f64,
    /// Largest increment; default the period.
    pub increment_max: f64,
    /// `DIRECT`: increments are fixed, no cutback.
    pub direct: bool,
}

/// Reference to a set or surface by its name, or to one node or element by its number.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Region {
    /// A set.
    Set(SetId),
    /// A single node label or element label.
    Label(u32),
    /// A surface (`*DSLOAD`).
    Surface(SurfaceId),
}

/// One degree of freedom range of one `*BOUNDARY` data line, already split: one direction each.
#[derive(Clone, Debug)]
pub struct Boundary {
    /// What the analyst named.
    pub region: Region,
    /// Name of the set, or the label as text: used in port names.
    pub region_name: String,
    /// Nodes of the region.
    pub nodes: Vec<NodeId>,
    /// Direction, 0..3.
    pub direction: u8,
    /// What `magnitude` is.
    pub kind: BoundaryKind,
    /// Prescribed displacement \[length\], velocity or acceleration at amplitude 1.
    pub magnitude: f64,
    /// Amplitude, if any; otherwise that of the step ([`Step::default_amplitude`]).
    pub amplitude: Option<AmplitudeId>,
    /// The line.
    pub place: Place,
}

/// `TYPE=` of `*BOUNDARY`: what is prescribed. Velocities and accelerations only in dynamic steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum BoundaryKind {
    /// A displacement.
    #[default]
    Displacement,
    /// A velocity: the displacement is its integral from where the direction stands at the start of the step.
    Velocity,
    /// An acceleration: integrated twice, from displacement and velocity at the start of the step.
    Acceleration,
}

/// One load data line.
#[derive(Clone, Debug)]
pub struct Load {
    /// What the analyst named.
    pub region: Region,
    /// Name of the set or surface, or the label as text: used in port names.
    pub region_name: String,
    /// Kind and target.
    pub kind: LoadKind,
    /// Force, pressure or acceleration at amplitude 1.
    pub magnitude: f64,
    /// Amplitude, if any; otherwise that of the step ([`Step::default_amplitude`]).
    pub amplitude: Option<AmplitudeId>,
    /// The line.
    pub place: Place,
}

/// Loads that can be applied.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadKind {
    /// `*CLOAD`: force on each node of the region, in one direction (0..3).
    Concentrated {
        /// Loaded nodes.
        nodes: Vec<NodeId>,
        /// Direction, 0..3.
        direction: u8,
    },
    /// `*DLOAD` Pn: pressure on face n of each element of the region, positive into the element.
    FacePressure {
        /// Loaded faces.
        faces: Vec<ElementFace>,
        /// Face number 1..6, for the port name.
        label: u8,
    },
    /// `*DLOAD` GRAV: acceleration `magnitude` along the unit vector on the elements' mass.
    Gravity {
        /// Loaded elements.
        elements: Vec<ElementId>,
        /// Unit vector.
        direction: [f64; 3],
    },
    /// `*DSLOAD` P: pressure on a surface, positive into the body.
    SurfacePressure {
        /// Loaded faces.
        faces: Vec<ElementFace>,
    },
}

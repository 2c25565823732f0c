//! Contact: interactions, pairs, and what steps change about them.

use super::{AmplitudeId, ElementId, InteractionId, NodeId, SetId, SurfaceId};
use crate::diagnostic::Place;
use crate::law::{NormalBehavior, Separation};

/// `*SURFACE INTERACTION` (or the options under `*GAP` and `*INTERFACE`) with what stands under it.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceInteraction {
    /// Name as the analyst wrote it; for contact elements, the name of their element set.
    pub name: String,
    /// Normal behaviour: hard or a softened law.
    pub normal: NormalBehavior,
    /// How hard contact is enforced. Softened laws are always enforced as they are.
    pub enforcement: Enforcement,
    /// `NO SEPARATION`.
    pub separation: Separation,
    /// `*CONTACT DAMPING` of Abaqus/Standard.
    pub damping: Option<ContactDamping>,
    /// `*CONTACT DAMPING` of Abaqus/Explicit, with its default.
    pub explicit_damping: ExplicitDamping,
    /// `*FRICTION`; steps may change it (`*CHANGE FRICTION`, see [`StepContact::frictions`]).
    pub friction: Friction,
    /// Area that each point of a node-based secondary surface stands for \[length²\], where the deck gives one. Otherwise 1, in
    /// the CalculiX dialect a share of the outer faces at the node (`contact/node_areas.rs`).
    pub node_area: Option<f64>,
}

impl SurfaceInteraction {
    /// Frictionless, enforced by Lagrange multipliers, without damping; surfaces may separate.
    pub fn new(name: &str, normal: NormalBehavior) -> Self {
        Self {
            name: name.to_owned(),
            normal,
            enforcement: Enforcement::Lagrange,
            separation: Separation::Allowed,
            damping: None,
            explicit_damping: ExplicitDamping::default(),
            friction: Friction::None,
            node_area: None,
        }
    }
}

/// How hard contact is enforced.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Enforcement {
    /// Exactly, by multipliers: the default.
    #[default]
    Lagrange,
    /// `AUGMENTED LAGRANGE`: by a penalty, with multipliers that grow until the penetration is within a tolerance.
    AugmentedLagrange(LinearPenalty),
    /// `PENALTY` or `PENALTY=LINEAR` (later releases).
    Penalty(LinearPenalty),
    /// `PENALTY=NONLINEAR` (later releases).
    NonlinearPenalty(NonlinearPenalty),
}

/// Data line of `AUGMENTED LAGRANGE` and `PENALTY`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearPenalty {
    /// Penalty stiffness \[pressure/length\], positive; none: automatic from the underlying elements.
    pub stiffness: Option<f64>,
    /// Clearance at zero pressure \[length\]: the penalty acts on overclosure plus this.
    pub clearance: f64,
    /// Factor on the stiffness, positive; 1 unless given.
    pub scale: f64,
}

impl Default for LinearPenalty {
    fn default() -> Self {
        Self { stiffness: None, clearance: 0.0, scale: 1.0 }
    }
}

/// Data line of `PENALTY=NONLINEAR`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NonlinearPenalty {
    /// Final stiffness `Kf` \[pressure/length\]; none: automatic, 100 times the underlying stiffness.
    pub stiffness_final: Option<f64>,
    /// Clearance at zero pressure `c0` \[length\].
    pub clearance: f64,
    /// Factor on both stiffnesses; 1 unless given.
    pub scale: f64,
    /// Upper end `e` of the quadratic range as a part of the characteristic face length; 0.03 unless given.
    pub upper_limit: f64,
    /// `Ki / Kf`; 0.01 unless given.
    pub stiffness_ratio: f64,
    /// `d / e`, lower end of the quadratic range; 1/3 unless given.
    pub lower_ratio: f64,
}

impl Default for NonlinearPenalty {
    fn default() -> Self {
        Self {
            stiffness_final: None,
            clearance: 0.0,
            scale: 1.0,
            upper_limit: 0.03,
            stiffness_ratio: 0.01,
            lower_ratio: 1.0 / 3.0,
        }
    }
}

/// `*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactDamping {
    /// `mu0` \[pressure·time/length\], not negative.
    pub coefficient: f64,
    /// `c0`: clearance from which on nothing is damped \[length\], positive.
    pub clearance: f64,
    /// `eta`: part of `c0` over which the coefficient is constant, in 0..1 (1 excluded).
    pub fraction: f64,
    /// `TANGENT FRACTION`: tangential coefficient over normal one; 0 unless given.
    pub tangent_fraction: f64,
}

/// `*CONTACT DAMPING` in Abaqus/Explicit: acts while surfaces touch; not on hard kinematic contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExplicitDamping {
    /// How the coefficient is found.
    pub definition: DampingDefinition,
    /// `TANGENT FRACTION`: tangential coefficient over normal one; 1 unless given.
    pub tangent_fraction: f64,
}

impl Default for ExplicitDamping {
    fn default() -> Self {
        Self { definition: DampingDefinition::CriticalFraction(0.03), tangent_fraction: 1.0 }
    }
}

/// `DEFINITION=` of `*CONTACT DAMPING`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DampingDefinition {
    /// `DAMPING COEFFICIENT`: `f = mu0 A v` \[pressure·time/length\], not negative.
    Coefficient(f64),
    /// `CRITICAL DAMPING FRACTION`: `f = 2 xi sqrt(m k) v`, not negative; 0.03 unless given.
    CriticalFraction(f64),
}

/// `*FRICTION`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Friction {
    /// Frictionless.
    #[default]
    None,
    /// `ROUGH`: no slip while closed.
    Rough,
}

/// A contact pair: surfaces, or contact elements of one set.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPair {
    /// Name used in results and ports: `SECONDARY_PRIMARY`, or the name of the element set.
    pub name: String,
    /// What meets what.
    pub members: PairMembers,
    /// Interaction of the pair.
    pub interaction: InteractionId,
    /// How Abaqus/Explicit treats the pair; without meaning in other decks.
    pub explicit: ExplicitContact,
    /// Where the pair was defined, for diagnostics.
    pub place: Place,
}

/// How Abaqus/Explicit treats a pair.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExplicitContact {
    /// `MECHANICAL CONSTRAINT`.
    pub constraint: MechanicalConstraint,
    /// `WEIGHT` after the table of defaults, in 0..=1: share of the result in which `secondary` and `primary` have these parts; the
    /// rest has them exchanged. 1 is pure, 0.5 balanced. (The reader turns pure pairs round so that theirs is 1.)
    pub weight: Weight,
}

/// A share in 0..=1; 1 unless given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weight(pub f64);

impl Default for Weight {
    fn default() -> Self {
        Self(1.0)
    }
}

/// `MECHANICAL CONSTRAINT` of a pair in Abaqus/Explicit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MechanicalConstraint {
    /// `KINEMATIC`: predictor and corrector; the default of pairs.
    #[default]
    Kinematic,
    /// `PENALTY`: always in general contact.
    Penalty,
}

/// What meets what.
#[derive(Clone, Debug, PartialEq)]
pub enum PairMembers {
    /// `*CONTACT PAIR`, node-to-surface.
    Surfaces(SurfacePair),
    /// `*GAP` over an element set: one contact point per element.
    Gaps(Vec<GapElement>),
    /// `*CONTACT`: general contact of Abaqus/Explicit.
    General(GeneralContact),
}

/// A part of general contact: nodes of each surface meet faces of the other, where they belong to different bodies. With
/// [`ExplicitContact::weight`] 0.5 (the default of general contact) both ways count half; with 1 only nodes of the first surface meet
/// faces of the second.
#[derive(Clone, Debug, PartialEq)]
pub struct GeneralContact {
    /// Surfaces of faces; both may be the same.
    pub surfaces: [SurfaceId; 2],
    /// `*CONTACT EXCLUSIONS`, and what other parts of general contact treat with properties of their own: a node that is on one surface
    /// of a couple does not meet a face that is on the other.
    pub excluded: Vec<[SurfaceId; 2]>,
}

impl ContactPair {
    /// The surfaces, unless the pair consists of contact elements.
    pub fn surfaces(&self) -> Option<&SurfacePair> {
        match &self.members {
            PairMembers::Surfaces(surfaces) => Some(surfaces),
            PairMembers::Gaps(_) | PairMembers::General(_) => None,
        }
    }
}

/// Surfaces of a `*CONTACT PAIR`.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfacePair {
    /// Secondary surface (element-based or node-based): its nodes become contact points.
    pub secondary: SurfaceId,
    /// Primary surface (element-based or analytical).
    pub primary: SurfaceId,
    /// Part of a face's size by which a secondary node may hang over the edge of the primary surface; 0.1 unless given.
    pub extension_zone: f64,
    /// `HCRIT`: overclosure beyond which the analyst should look at the geometry \[length\]; half a face unless given.
    pub hcrit: Option<f64>,
    /// `ADJUST`: secondary nodes that lie on the primary surface at the start. The coordinates of the mesh are the adjusted ones.
    pub adjust: Option<Adjust>,
    /// `*CLEARANCE`: overrides the geometry at these nodes, ascending by node \[length\]; negative is an overclosure.
    pub clearances: Vec<(NodeId, f64)>,
}

/// `ADJUST` of a contact pair: a strain-free change of the geometry before the analysis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Adjust {
    /// Nodes that are adjusted.
    pub region: AdjustRegion,
    /// How many nodes the reader has moved.
    pub moved: u32,
    /// The largest move \[length\].
    pub distance_max: f64,
}

/// Nodes that `ADJUST` names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AdjustRegion {
    /// Nodes with a clearance up to this \[length\], and all that overlap; not negative.
    Within(f64),
    /// Nodes of a set, wherever they are.
    Set(SetId),
}

/// A GAP element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GapElement {
    /// The element.
    pub element: ElementId,
    /// Its nodes.
    pub nodes: [NodeId; 2],
    /// Kind with its direction.
    pub kind: GapKind,
    /// `d` of the data line \[length\]: clearance of GAPUNI, largest (positive) or smallest (negative) distance of the others.
    pub distance: f64,
    /// Cross-sectional area \[length²\]; 1 unless given: then pressures are forces.
    pub area: f64,
}

/// Kinds of GAP elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GapKind {
    /// `GAPUNI`: contact along a fixed unit vector, from node 1 to node 2.
    Unidirectional([f64; 3]),
    /// `GAPCYL`: distance normal to an axis, a unit vector.
    Cylindrical([f64; 3]),
    /// `GAPSPHER`: distance of the nodes.
    Spherical,
}

/// Contact in a step, as everything written so far leaves it. Lists have one entry per pair.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StepContact {
    /// `*CONTACT CONTROLS`; empty: the defaults for every pair.
    pub controls: Vec<ContactControls>,
    /// Whether the pair acts (`*MODEL CHANGE`); empty: every pair acts.
    pub active: Vec<bool>,
    /// `*FRICTION` of the pair in this step; empty: that of its interaction.
    pub frictions: Vec<Friction>,
    /// `*CONTACT INTERFERENCE`; empty: none.
    pub interferences: Vec<Option<Interference>>,
}

impl StepContact {
    /// Controls of a pair.
    pub fn controls_of(&self, pair: usize) -> ContactControls {
        self.controls.get(pair).copied().unwrap_or_default()
    }

    /// Whether a pair acts.
    pub fn is_active(&self, pair: usize) -> bool {
        self.active.get(pair).copied().unwrap_or(true)
    }

    /// Allowable interference of a pair.
    pub fn interference_of(&self, pair: usize) -> Option<Interference> {
        self.interferences.get(pair).copied().flatten()
    }
}

/// `*CONTACT CONTROLS` of one pair in one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactControls {
    /// Penetration that augmented Lagrange leaves; 0.1 % of the characteristic length unless given.
    pub penetration_tolerance: PenetrationTolerance,
    /// `STIFFNESS SCALE FACTOR` on penalty stiffnesses; 1 unless given.
    pub stiffness_scale: f64,
    /// Modified hard contact.
    pub modified: Option<ModifiedHard>,
    /// `STABILIZE`.
    pub stabilization: Option<Stabilization>,
    /// `FRICTION ONSET`.
    pub friction_onset: FrictionOnset,
    /// `SCALE PENALTY` of Abaqus/Explicit, on default penalties only; 1 unless given.
    pub scale_penalty: f64,
}

impl Default for ContactControls {
    fn default() -> Self {
        Self {
            penetration_tolerance: PenetrationTolerance::Relative(1e-3),
            stiffness_scale: 1.0,
            modified: None,
            stabilization: None,
            friction_onset: FrictionOnset::Immediate,
            scale_penalty: 1.0,
        }
    }
}

/// Largest penetration that augmented Lagrange accepts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PenetrationTolerance {
    /// In lengths.
    Absolute(f64),
    /// As a part of the characteristic length of the interface.
    Relative(f64),
}

/// Controls of modified hard contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModifiedHard {
    /// `MAXCHP`: most points that may violate the hard conditions in an increment.
    pub points_max: u32,
    /// `PERRMX`: largest tension of a closed point \[pressure\], not negative.
    pub tension_max: f64,
    /// `UERRMX`: largest overclosure of an open point \[length\], not negative.
    pub overclosure_max: f64,
    /// Whether the points of all pairs with global controls are counted together, not those of the pair.
    pub global: bool,
}

/// `*CONTACT CONTROLS, STABILIZE`: normal damping within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stabilization {
    /// Damping coefficient \[pressure·time/length\], positive; none: automatic.
    pub coefficient: Option<f64>,
    /// Factor on the automatic coefficient (`STABILIZE=factor`); 1 unless given.
    pub factor: f64,
    /// Part of the coefficient that is left at the end of the step; 0 unless given.
    pub fraction_end: f64,
    /// Clearance from which on nothing is damped \[length\]; none: the characteristic length of the interface.
    pub clearance: Option<f64>,
    /// `TANGENT FRACTION`; 1 unless given.
    pub tangent_fraction: f64,
}

/// When friction begins at a point that closes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrictionOnset {
    /// In the increment in which it closes.
    #[default]
    Immediate,
    /// In the next increment.
    Delayed,
}

/// `*CONTACT INTERFERENCE` of a pair: overclosure that is allowed, gradually resolved in the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interference {
    /// How much.
    pub allowed: AllowedOverclosure,
    /// Factor over time; none: from 1 at the start of the step to 0 at its end.
    pub amplitude: Option<AmplitudeId>,
    /// Step that states it (position in `Model::steps`); in later steps the last value stays.
    pub step: u32,
}

/// Overclosure that is allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AllowedOverclosure {
    /// The same at every point \[length\]; the overclosure of the law is that of the geometry less this.
    Uniform(f64),
    /// `SHRINK`: what each point has at the start.
    Initial,
}

//! The model that a deck describes: plain data, nothing computed, nothing mutable after the reader.
//!
//! Indices (`NodeId`, `ElementId`, …) count from zero in the order of definition; `label` fields hold the
//! numbers that the analyst wrote. Units are consistent units.

mod analytical;
mod contact;
mod element;
mod history;
mod mesh;
mod output;

pub use analytical::*;
pub use contact::*;
pub use element::*;
pub use history::*;
pub use mesh::*;
pub use output::*;

/// What a keyword means where codes disagree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Dialect {
    /// Decks mean what Abaqus means.
    #[default]
    Abaqus,
    /// Decks mean what CalculiX means, where that changes the answer.
    Calculix,
}

/// A whole deck, validated: every reference resolves, every section has its material.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// Text of `*HEADING`, lines joined by a newline.
    pub heading: String,
    /// How keywords were read.
    pub dialect: Dialect,
    /// Nodes, elements, sets and surfaces.
    pub mesh: Mesh,
    /// Materials, in order of definition.
    pub materials: Vec<Material>,
    /// Sections: which elements are made of what.
    pub sections: Vec<SolidSection>,
    /// Contact interactions, in order of definition.
    pub interactions: Vec<SurfaceInteraction>,
    /// Contact pairs, in order of definition.
    pub pairs: Vec<ContactPair>,
    /// Linear constraints between displacements, in order of definition.
    pub equations: Vec<Equation>,
    /// Rigid bodies, in order of definition; `equations` has what they say of their nodes.
    pub rigid_bodies: Vec<RigidBody>,
    /// Amplitude curves.
    pub amplitudes: Vec<Amplitude>,
    /// Boundary conditions of the model part (before the first step): all values are zero. Lines that name single
    /// nodes are joined per direction; region and place are those of the first.
    pub initial_boundaries: Vec<Boundary>,
    /// `*INITIAL CONDITIONS, TYPE=VELOCITY`, in order; a later line replaces an earlier one at the same node and direction.
    pub initial_velocities: Vec<InitialVelocity>,
    /// Steps in order. Never empty in a validated model.
    pub steps: Vec<Step>,
}

/// Isotropic linear elastic material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name as the analyst wrote it.
    pub name: String,
    /// Young's modulus \[pressure\], positive; zero in the copies that solids of rigid bodies have.
    pub youngs_modulus: f64,
    /// Poisson's ratio, in (-1, 0.5).
    pub poissons_ratio: f64,
    /// Mass density [mass/length³], positive; needed for GRAV and in dynamic steps.
    pub density: Option<f64>,
    /// `*DAMPING`: zero unless given.
    pub damping: Rayleigh,
}

/// Rayleigh damping: the damping matrix is `alpha M + beta K`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rayleigh {
    /// Mass-proportional factor [1/time], not negative.
    pub alpha: f64,
    /// Stiffness-proportional factor \[time\], not negative.
    pub beta: f64,
}

/// Velocity at the start of the analysis: that of the first dynamic step.
#[derive(Clone, Debug, PartialEq)]
pub struct InitialVelocity {
    /// Node.
    pub node: NodeId,
    /// Direction, 0..3 (of a hidden node: rotation).
    pub direction: u8,
    /// Velocity [length/time].
    pub value: f64,
}

/// `*SOLID SECTION`.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidSection {
    /// Elements of the section.
    pub element_set: SetId,
    /// Material of the section.
    pub material: MaterialId,
}

/// `*EQUATION`: Σ coefficient · displacement = 0. The first term is the dependent one: its direction is eliminated.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// Node, direction (0..3) and coefficient; the first coefficient is not zero, no direction comes twice.
    pub terms: Vec<(NodeId, u8, f64)>,
    /// The line, for diagnostics.
    pub place: crate::diagnostic::Place,
}

/// `*RIGID BODY`: nodes that move with a reference node, `u = u_ref + θ × (x − x_ref)`.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// Reference node.
    pub reference: NodeId,
    /// Node whose displacements are the rotations `θ`.
    pub rotation: NodeId,
    /// Nodes that move with it, ascending, without these two.
    pub nodes: Vec<NodeId>,
    /// The line, for diagnostics.
    pub place: crate::diagnostic::Place,
}

impl RigidBody {
    /// Equations of the nodes: three each.
    pub fn equations<'a>(&'a self, mesh: &'a Mesh) -> impl Iterator<Item = Equation> + 'a {
        self.nodes.iter().flat_map(move |&node| {
            let [x, origin] = [node, self.reference].map(|n| mesh.nodes[n.index()]);
            let r: [f64; 3] = std::array::from_fn(|d| x[d] - origin[d]);
            (0..3u8).map(move |d| {
                // (θ × r)_d = θ_a r_b − θ_b r_a.
                let (a, b) = ((d + 1) % 3, (d + 2) % 3);
                let mut terms = vec![(node, d, 1.0), (self.reference, d, -1.0)];
                let turned = [(a, -r[usize::from(b)]), (b, r[usize::from(a)])];
                terms.extend(turned.iter().filter(|(_, c)| *c != 0.0).map(|&(axis, c)| (self.rotation, axis, c)));
                Equation { terms, place: self.place.clone() }
            })
        })
    }
}

/// `*AMPLITUDE`, tabular, relative values.
#[derive(Clone, Debug, PartialEq)]
pub struct Amplitude {
    /// Name as the analyst wrote it.
    pub name: String,
    /// Which clock the times are measured on.
    pub clock: AmplitudeClock,
    /// (time, factor), times strictly increasing, at least one point.
    pub points: Vec<(f64, f64)>,
}

impl Model {
    /// Whether the deck is one of Abaqus/Explicit.
    pub fn is_explicit(&self) -> bool {
        matches!(self.steps.first().map(|step| &step.procedure), Some(Procedure::Explicit(_)))
    }

    /// Whether any step is static.
    pub fn has_statics(&self) -> bool {
        self.steps.iter().any(|step| !step.procedure.is_dynamic())
    }

    /// Whether any step is dynamic.
    pub fn has_dynamics(&self) -> bool {
        self.steps.iter().any(|step| step.procedure.is_dynamic())
    }
}

impl Amplitude {
    /// Factor at a time on the amplitude's own clock; constant outside the table.
    pub fn evaluate(&self, time: f64) -> f64 {
        let after = self.points.partition_point(|&(t, _)| t <= time);
        match (after.checked_sub(1).map(|i| self.points[i]), self.points.get(after)) {
            (None, first) => first.map_or(0.0, |&(_, v)| v),
            (Some((_, v)), None) => v,
            (Some((t0, v0)), Some(&(t1, v1))) => v0 + (v1 - v0) * ((time - t0) / (t1 - t0)),
        }
    }
}

/// `TIME=` of `*AMPLITUDE`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AmplitudeClock {
    /// Time since the start of the step (the default).
    Step,
    /// Time since the start of the analysis.
    Total,
}

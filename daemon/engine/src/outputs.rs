//! Output ports: which condensed results a deck offers, and where each comes from.

use crate::diagnostic::{Diagnostic, Place};
use crate::model::{Friction, Model, NodeId, SetId};
use crate::port::{Port, PortList, Quantity, inputs_of};
use crate::port_config::PortConfig;
use crate::simulation::ContactStatus;
use crate::solve::columns::{Column, merge};
use crate::solve::constraints::Constraints;

/// Where the value of an output comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// Component of the contact force of a pair.
    PairForce(usize, usize),
    /// CFNM of a pair.
    PairForceMagnitude(usize),
    /// CAREA of a pair.
    PairArea(usize),
    /// Largest pressure of a pair.
    PairPressureMax(usize),
    /// Smallest clearance of a pair.
    PairClearanceMin(usize),
    /// Closed points of a pair.
    PairClosed(usize),
    /// Open points of a pair.
    PairOpen(usize),
    /// Component of the friction force of a pair.
    PairShear(usize, usize),
    /// Points of a pair with a status.
    PairStatus(usize, ContactStatus),
    /// Generalised value of a column; none where no direction of the set takes part.
    Generalised(Option<usize>),
    /// Mean of a component of the velocity over a node set, by its place in [`Outputs::sets`]; 0 in static steps.
    Velocity(usize, usize),
    /// Mean of a component of the acceleration over it; 0 in static steps.
    Acceleration(usize, usize),
    /// One of the energies, in the order of [`ENERGIES`].
    Energy(usize),
    /// Increments so far, all steps.
    Increments,
    /// Equilibrium iterations so far, all steps.
    EquilibriumIterations,
    /// Severe discontinuity iterations so far, all steps.
    SevereDiscontinuityIterations,
    /// Cutbacks so far, all steps.
    Cutbacks,
    /// Augmentations so far, all steps.
    Augmentations,
    /// Impacts so far, all steps.
    Impacts,
    /// Total time of the last status change.
    LastStatusChange,
}

/// Names of the energies, in the order of the history, and what they are.
pub const ENERGIES: [(&str, &str); 8] = [
    ("ALLSE", "Strain energy of the bodies"),
    ("ALLKE", "Kinetic energy"),
    ("ALLWK", "Work of loads and prescribed displacements, by the trapezoidal rule over the increments"),
    ("ALLFD", "Energy dissipated by friction"),
    ("ALLVD", "Energy dissipated by viscous and contact damping"),
    ("ALLCCE", "Energy stored in softened contact"),
    ("IMPACT_LOSS", "Kinetic energy lost in impacts"),
    ("ETOTAL", "Stored and dissipated energy less external work; its drift is the error of the energy balance"),
];

/// Columns that only outputs and the audit need, behind the real ones.
pub struct Outputs {
    /// Ports.
    pub ports: Vec<Port>,
    /// Source of each port.
    pub sources: Vec<Source>,
    /// Node sets with reaction totals, in the order of the history.
    pub sets: Vec<SetId>,
    /// Column of the reaction total of each set and direction.
    pub set_reactions: Vec<[Option<usize>; 3]>,
    /// Column of the reaction total of all supports, per direction: the audit.
    pub all_reactions: [Option<usize>; 3],
}

/// Inputs and outputs of a validated model as `ports.toml` declares them, without preparing it. Errors are those of the
/// declarations: ports that the deck does not have, names that clash, text that is no TOML.
pub fn ports_of(model: &Model, ports_toml: Option<&str>) -> Result<PortList, Vec<Diagnostic>> {
    let outputs = Outputs::new(model, &Constraints::new(model, std::iter::empty()), &mut Vec::new());
    declared(inputs_of(model), &outputs, ports_toml).map(|(ports, _)| ports)
}

/// Ports under their declared names, and the sources of the outputs that are left.
pub fn declared(
    inputs: Vec<Port>,
    outputs: &Outputs,
    ports_toml: Option<&str>,
) -> Result<(PortList, Vec<Source>), Vec<Diagnostic>> {
    let all = PortList { inputs, outputs: outputs.ports.clone() };
    let Some(text) = ports_toml else { return Ok((all, outputs.sources.clone())) };
    PortConfig::parse(text).and_then(|config| config.apply(all, &outputs.sources)).map_err(|messages| {
        let as_error = |message| Diagnostic::error(Place::nowhere(), "ports.toml", message, "");
        messages.into_iter().map(as_error).collect()
    })
}

/// Node sets that any step asks output for, in order of definition.
fn requested_sets(model: &Model) -> Vec<SetId> {
    let mut sets: Vec<SetId> = model.steps.iter().flat_map(|s| &s.output.nodes).filter_map(|r| r.set).collect();
    sets.sort();
    sets.dedup();
    sets
}

/// Whether a pair has friction in any step.
fn has_friction(model: &Model, pair: usize) -> bool {
    let own = model.interactions.get(model.pairs[pair].interaction.index()).map(|interaction| interaction.friction);
    let steps = model.steps.iter().filter_map(|step| step.contact.frictions.get(pair).copied());
    own.into_iter().chain(steps).any(|friction| friction != Friction::None)
}

/// Whether open points of a pair may be damped in any step.
fn is_damped(model: &Model, pair: usize) -> bool {
    let interaction = model.interactions.get(model.pairs[pair].interaction.index());
    interaction.is_some_and(|interaction| interaction.damping.is_some())
        || model.steps.iter().any(|step| step.contact.controls_of(pair).stabilization.is_some())
}

impl Outputs {
    /// Lists the outputs of a model and appends the columns that they need.
    pub fn new(model: &Model, constraints: &Constraints, columns: &mut Vec<Column>) -> Self {
        let mut out = Self {
            ports: Vec::new(),
            sources: Vec::new(),
            sets: requested_sets(model),
            set_reactions: Vec::new(),
            all_reactions: [None; 3],
        };
        for (index, pair) in model.pairs.iter().enumerate() {
            out.pair(index, &pair.name);
            if has_friction(model, index) {
                out.friction(index, &pair.name);
            }
            if is_damped(model, index) {
                let what = "Open contact points with viscous damping only".into();
                let source = Source::PairStatus(index, ContactStatus::Viscous);
                out.add(format!("contact.{}.viscous", pair.name), Quantity::Count, what, source);
            }
        }
        let reaction = |nodes: &[NodeId], d: usize, columns: &mut Vec<Column>| {
            let entries: Vec<_> =
                nodes.iter().filter(|&&n| constraints.is_prescribed(n, d)).map(|&n| (n, d as u8, 1.0)).collect();
            (!entries.is_empty()).then(|| {
                columns.push(Column::Displacement(merge(entries)));
                columns.len() - 1
            })
        };
        let is_dynamic = model.steps.iter().any(|step| step.procedure.is_dynamic());
        for (position, &set) in out.sets.clone().iter().enumerate() {
            let set = &model.mesh.node_sets[set.index()];
            let share = 1.0 / set.nodes.len() as f64;
            for d in 0..3 {
                let column = (!set.nodes.is_empty()).then(|| {
                    columns.push(Column::Force(merge(set.nodes.iter().map(|&n| (n, d as u8, share)).collect())));
                    columns.len() - 1
                });
                let what = format!("Mean displacement {} of {}", d + 1, set.name);
                out.add(format!("node.{}.U{}", set.name, d + 1), Quantity::Length, what, Source::Generalised(column));
            }
            let mut reactions = [None; 3];
            for (d, slot) in reactions.iter_mut().enumerate() {
                *slot = reaction(&set.nodes, d, columns);
                let what = format!("Total reaction force {} on {}", d + 1, set.name);
                out.add(format!("node.{}.RF{}", set.name, d + 1), Quantity::Force, what, Source::Generalised(*slot));
            }
            out.set_reactions.push(reactions);
            if is_dynamic {
                out.motion(position, &set.name);
            }
        }
        let all: Vec<NodeId> =
            (0..model.mesh.nodes.len() as u32).map(NodeId).filter(|&n| constraints.touches(n)).collect();
        out.all_reactions = std::array::from_fn(|d| reaction(&all, d, columns));
        for (index, (name, what)) in ENERGIES.iter().enumerate() {
            out.add(format!("energy.{name}"), Quantity::Energy, (*what).into(), Source::Energy(index));
        }
        let counts = [
            ("increments", Source::Increments, "Increments completed"),
            ("equilibrium_iterations", Source::EquilibriumIterations, "Iterations that changed no contact status"),
            (
                "severe_discontinuity_iterations",
                Source::SevereDiscontinuityIterations,
                "Iterations that changed a contact status",
            ),
            ("cutbacks", Source::Cutbacks, "Increments tried again with a smaller size"),
        ];
        for (name, source, what) in counts {
            out.add(format!("work.{name}"), Quantity::Count, what.into(), source);
        }
        out.add(
            "contact.last_status_change".into(),
            Quantity::Time,
            "Total time of the last status change".into(),
            Source::LastStatusChange,
        );
        out.add(
            "work.augmentations".into(),
            Quantity::Count,
            "Updates of the multipliers of augmented Lagrange".into(),
            Source::Augmentations,
        );
        if is_dynamic {
            let what = "Instants at which hard contact closed and velocities jumped (implicit dynamic steps)".into();
            out.add("work.impacts".into(), Quantity::Count, what, Source::Impacts);
        }
        out
    }

    fn motion(&mut self, position: usize, name: &str) {
        for d in 0..3 {
            let what = format!("Mean velocity {} of {name}", d + 1);
            self.add(format!("node.{name}.V{}", d + 1), Quantity::Velocity, what, Source::Velocity(position, d));
        }
        for d in 0..3 {
            let what = format!("Mean acceleration {} of {name}", d + 1);
            let source = Source::Acceleration(position, d);
            self.add(format!("node.{name}.A{}", d + 1), Quantity::Acceleration, what, source);
        }
    }

    fn friction(&mut self, index: usize, name: &str) {
        for d in 0..3 {
            let what = format!("Friction force {} on the secondary surface", d + 1);
            self.add(format!("contact.{name}.CFS{}", d + 1), Quantity::Force, what, Source::PairShear(index, d));
        }
        for (suffix, what, status) in [
            ("sticking", "Closed contact points that stick", ContactStatus::Sticking),
            ("slipping", "Closed contact points that slip", ContactStatus::Slipping),
        ] {
            let source = Source::PairStatus(index, status);
            self.add(format!("contact.{name}.{suffix}"), Quantity::Count, what.into(), source);
        }
    }

    fn pair(&mut self, index: usize, name: &str) {
        for d in 0..3 {
            let what = format!("Contact force {} on the secondary surface", d + 1);
            self.add(format!("contact.{name}.CFN{}", d + 1), Quantity::Force, what, Source::PairForce(index, d));
        }
        let rest = [
            ("CFNM", Quantity::Force, "Magnitude of the contact force", Source::PairForceMagnitude(index)),
            ("CAREA", Quantity::Area, "Area of the closed points", Source::PairArea(index)),
            ("CPRESS_max", Quantity::Pressure, "Largest contact pressure", Source::PairPressureMax(index)),
            (
                "COPEN_min",
                Quantity::Length,
                "Smallest clearance, negative when the bodies overlap",
                Source::PairClearanceMin(index),
            ),
            ("closed", Quantity::Count, "Closed contact points", Source::PairClosed(index)),
            ("open", Quantity::Count, "Open contact points", Source::PairOpen(index)),
        ];
        for (suffix, quantity, what, source) in rest {
            self.add(format!("contact.{name}.{suffix}"), quantity, what.into(), source);
        }
    }

    fn add(&mut self, name: String, quantity: Quantity, description: String, source: Source) {
        self.ports.push(Port { name, quantity, unit: None, description });
        self.sources.push(source);
    }
}

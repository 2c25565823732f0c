//! What a model holds, in a few lines for people.

mod dynamics;

use std::fmt::Write;

use crate::law::{NormalBehavior, PressureOverclosure, Separation};
use crate::model::{
    AllowedOverclosure, ContactControls, ContactPair, Enforcement, ExplicitIncrements, Friction, MechanicalConstraint,
    Model, PairMembers, PenetrationTolerance, Procedure, StepContact, SurfaceId, SurfaceInteraction, SurfaceKind,
};

use dynamics::{describe_damping, describe_dynamics};

/// Counts of nodes, elements, sets, contact pairs with their faces and nodes, and steps. Ends with a newline.
pub fn summary(model: &Model) -> String {
    let mesh = &model.mesh;
    let mut text = String::new();
    let mut line = |key: &str, value: String| {
        // Writing into a string cannot fail.
        let _ = writeln!(text, "{key:<14}{value}");
    };
    line("nodes", mesh.node_count().to_string());
    line("elements", elements(model));
    line("sets", format!("{} of nodes, {} of elements", mesh.node_sets.len(), mesh.element_sets.len()));
    line("surfaces", mesh.surfaces.len().to_string());
    line("materials", join(model.materials.iter().map(|material| material.name.as_str())));
    if !model.equations.is_empty() {
        line("equations", model.equations.len().to_string());
    }
    for body in &model.rigid_bodies {
        let label = mesh.node_labels[body.reference.index()];
        line("rigid body", format!("{} nodes follow node {label}", body.nodes.len()));
    }
    for pair in &model.pairs {
        line("contact pair", describe_pair(model, pair));
    }
    if model.pairs.is_empty() {
        line("contact pairs", "none".into());
    }
    if !model.initial_velocities.is_empty() {
        line("velocities", format!("{} directions have one at the start", model.initial_velocities.len()));
    }
    for material in model.materials.iter().filter(|material| material.damping != Default::default()) {
        line("damping", describe_damping(material));
    }
    for step in &model.steps {
        let fixed = match &step.procedure {
            Procedure::Static(control) => control.direct,
            Procedure::Dynamic(control) => control.direct,
            Procedure::Explicit(control) => matches!(control.increments, ExplicitIncrements::Direct(_)),
        };
        let increments = match (step.procedure.increment_first(), fixed) {
            (0.0, _) => "stable increments".into(),
            (size, true) => format!("fixed increments from {size}"),
            (size, false) => format!("automatic increments from {size}"),
        };
        line(
            "step",
            format!(
                "{}: {}, period {}, {increments}; {} boundary lines, {} load lines",
                step.name,
                step.procedure.keyword(),
                step.procedure.period(),
                step.boundaries.len(),
                step.loads.len()
            ),
        );
        let facts = describe_dynamics(&step.procedure);
        if !facts.is_empty() {
            line("", facts.join("; "));
        }
        for (index, pair) in model.pairs.iter().enumerate() {
            let changes = describe_changes(model, &step.contact, index, pair);
            if !changes.is_empty() {
                line("", format!("{}: {}", pair.name, changes.join("; ")));
            }
        }
    }
    text
}

/// Number of elements, and how many of each type where there are several.
fn elements(model: &Model) -> String {
    let mut types: Vec<(&str, usize)> = Vec::new();
    for (kind, _) in model.mesh.elements.iter() {
        match types.iter_mut().find(|(name, _)| *name == kind.name()) {
            Some((_, count)) => *count += 1,
            None => types.push((kind.name(), 1)),
        }
    }
    let count = model.mesh.elements.len();
    let types: Vec<String> = types.iter().map(|(name, count)| format!("{count} {name}")).collect();
    if types.len() < 2 { count.to_string() } else { format!("{count}: {}", types.join(", ")) }
}

fn join<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<_> = names.collect();
    if names.is_empty() { "none".into() } else { names.join(", ") }
}

fn describe_pair(model: &Model, pair: &ContactPair) -> String {
    let behavior = describe_interaction(&model.interactions[pair.interaction.index()]);
    let surfaces = match &pair.members {
        PairMembers::Surfaces(surfaces) => surfaces,
        PairMembers::Gaps(gaps) => return format!("{}: {} contact elements; {behavior}", pair.name, gaps.len()),
        PairMembers::General(general) => {
            let [first, second] = general.surfaces.map(|surface| describe_surface(model, surface));
            return format!("{}: general contact of {first} with {second}; {behavior}", pair.name);
        }
    };
    let mut text = format!(
        "{}: secondary {}; primary {}; {behavior}",
        pair.name,
        describe_surface(model, surfaces.secondary),
        describe_surface(model, surfaces.primary)
    );
    // Writing into a string cannot fail.
    if model.is_explicit() {
        let enforced = match pair.explicit.constraint {
            MechanicalConstraint::Kinematic => "kinematic",
            MechanicalConstraint::Penalty => "by penalty",
        };
        let _ = match pair.explicit.weight.0 {
            1.0 => write!(text, ", {enforced}, pure"),
            weight => write!(text, ", {enforced}, balanced by {weight}"),
        };
    }
    if let Some(adjust) = surfaces.adjust {
        let _ = write!(text, "; ADJUST moved {} nodes by up to {:.4e}", adjust.moved, adjust.distance_max);
    }
    if !surfaces.clearances.is_empty() {
        let _ = write!(text, "; clearances of {} nodes are given", surfaces.clearances.len());
    }
    text
}

fn describe_interaction(interaction: &SurfaceInteraction) -> String {
    let mut text = match (&interaction.normal, &interaction.enforcement) {
        (NormalBehavior::Hard, Enforcement::Lagrange) => "hard",
        (NormalBehavior::Hard, Enforcement::AugmentedLagrange(_)) => "hard by augmented Lagrange",
        (NormalBehavior::Hard, Enforcement::Penalty(_)) => "hard by linear penalty",
        (NormalBehavior::Hard, Enforcement::NonlinearPenalty(_)) => "hard by nonlinear penalty",
        (NormalBehavior::Softened(PressureOverclosure::Linear(_)), _) => "linear",
        (NormalBehavior::Softened(PressureOverclosure::Tabular(_)), _) => "tabular",
        (NormalBehavior::Softened(PressureOverclosure::Exponential(_)), _) => "exponential",
        (NormalBehavior::Softened(PressureOverclosure::CalculixExponential(_)), _) => "exponential of CalculiX",
    }
    .to_string();
    if interaction.separation == Separation::Prevented {
        text.push_str(", no separation");
    }
    if interaction.friction == Friction::Rough {
        text.push_str(", rough friction");
    }
    if let Some(damping) = interaction.damping {
        let _ = write!(text, ", damped below a clearance of {}", damping.clearance);
    }
    text
}

/// What a step says about a pair that is not the default.
fn describe_changes(model: &Model, contact: &StepContact, index: usize, pair: &ContactPair) -> Vec<String> {
    if !contact.is_active(index) {
        return vec!["removed".into()];
    }
    let mut changes = Vec::new();
    let (controls, default) = (contact.controls_of(index), ContactControls::default());
    let interaction = &model.interactions[pair.interaction.index()];
    if let Some(friction) = contact.frictions.get(index).filter(|friction| **friction != interaction.friction) {
        changes.push(match friction {
            Friction::None => "frictionless".to_string(),
            Friction::Rough => "rough friction".to_string(),
        });
    }
    if let Some(interference) = contact.interference_of(index) {
        changes.push(match interference.allowed {
            AllowedOverclosure::Initial => "interference of the start resolved gradually".to_string(),
            AllowedOverclosure::Uniform(value) => format!("interference of {value} allowed"),
        });
    }
    if controls.penetration_tolerance != default.penetration_tolerance {
        changes.push(match controls.penetration_tolerance {
            PenetrationTolerance::Absolute(value) => format!("penetration up to {value}"),
            PenetrationTolerance::Relative(value) => format!("penetration up to {value} of the characteristic length"),
        });
    }
    if controls.stiffness_scale != default.stiffness_scale {
        changes.push(format!("penalty stiffness times {}", controls.stiffness_scale));
    }
    if let Some(modified) = controls.modified {
        changes.push(format!(
            "modified hard: up to {} points with a tension up to {} or an overclosure up to {}",
            modified.points_max, modified.tension_max, modified.overclosure_max
        ));
    }
    if controls.stabilization.is_some() {
        changes.push("stabilized by damping".into());
    }
    changes
}

fn describe_surface(model: &Model, surface: SurfaceId) -> String {
    let mesh = &model.mesh;
    match &mesh.surfaces[surface.index()].kind {
        SurfaceKind::Nodes(nodes) => format!("{} nodes", nodes.len()),
        SurfaceKind::Bars(bars) => format!("{} bars", bars.len()),
        SurfaceKind::Analytical(_) => "an analytical surface".to_string(),
        SurfaceKind::Faces(faces) => {
            let mut nodes: Vec<_> = faces.iter().flat_map(|&face| mesh.face_nodes(face).to_vec()).collect();
            nodes.sort_unstable();
            nodes.dedup();
            format!("{} faces with {} nodes", faces.len(), nodes.len())
        }
    }
}

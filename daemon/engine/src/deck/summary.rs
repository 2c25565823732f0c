//! What a model holds, in a few lines for people.

use std::fmt::Write;

use crate::law::{NormalBehavior, PressureOverclosure};
use crate::model::{ContactPair, Model, Procedure, SurfaceId, SurfaceKind};

/// Counts of nodes, elements, sets, contact pairs with their faces and nodes, and steps. Ends with a newline.
pub fn summary(model: &Model) -> String {
    let mesh = &model.mesh;
    let mut text = String::new();
    let mut line = |key: &str, value: String| {
        // Writing into a string cannot fail.
        let _ = writeln!(text, "{key:<14}{value}");
    };
    line("nodes", mesh.nodes.len().to_string());
    line("elements", elements(model));
    line("sets", format!("{} of nodes, {} of elements", mesh.node_sets.len(), mesh.element_sets.len()));
    line("surfaces", mesh.surfaces.len().to_string());
    line("materials", join(model.materials.iter().map(|material| material.name.as_str())));
    if !model.equations.is_empty() {
        line("equations", model.equations.len().to_string());
    }
    for pair in &model.pairs {
        line("contact pair", describe_pair(model, pair));
    }
    if model.pairs.is_empty() {
        line("contact pairs", "none".into());
    }
    for step in &model.steps {
        let Procedure::Static(control) = &step.procedure;
        let increments = if control.direct { "fixed" } else { "automatic" };
        line(
            "step",
            format!(
                "{}: *STATIC, period {}, {increments} increments from {}; {} boundary lines, {} load lines",
                step.name,
                control.period,
                control.increment_initial,
                step.boundaries.len(),
                step.loads.len()
            ),
        );
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
    let interaction = &model.interactions[pair.interaction.index()];
    let law = match &interaction.normal {
        NormalBehavior::Hard => "hard",
        NormalBehavior::Softened(PressureOverclosure::Linear(_)) => "linear",
        NormalBehavior::Softened(PressureOverclosure::Tabular(_)) => "tabular",
        NormalBehavior::Softened(PressureOverclosure::Exponential(_)) => "exponential",
        NormalBehavior::Softened(PressureOverclosure::CalculixExponential(_)) => "exponential of CalculiX",
    };
    let Some(surfaces) = pair.surfaces() else { return format!("{}: {law}", pair.name) };
    let adjusted = match surfaces.adjust {
        Some(adjust) => format!("; ADJUST moved {} nodes by up to {:.4e}", adjust.moved, adjust.distance_max),
        None => String::new(),
    };
    format!(
        "{}: secondary {}; primary {}; {law}{adjusted}",
        pair.name,
        describe_surface(model, surfaces.secondary),
        describe_surface(model, surfaces.primary)
    )
}

fn describe_surface(model: &Model, surface: SurfaceId) -> String {
    let mesh = &model.mesh;
    match &mesh.surfaces[surface.index()].kind {
        SurfaceKind::Nodes(nodes) => format!("{} nodes", nodes.len()),
        SurfaceKind::Faces(faces) => {
            let mut nodes: Vec<_> = faces.iter().flat_map(|&face| mesh.face_nodes(face).to_vec()).collect();
            nodes.sort_unstable();
            nodes.dedup();
            format!("{} faces with {} nodes", faces.len(), nodes.len())
        }
    }
}

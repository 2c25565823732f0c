//! Second pass: cards to a model. References are followed in any direction, so the order of definitions does not matter.

mod adjust;
mod analytical;
mod behavior;
mod budget;
mod clearance;
mod combinations;
mod contact_history;
mod controls;
mod damping;
mod enforcement;
mod equations;
mod explicit;
mod explicit_controls;
mod explicit_pairs;
mod friction;
mod gaps;
mod general;
mod initial;
mod interactions;
mod interference;
mod layout;
mod loads;
mod materials;
mod mesh;
mod names;
mod output;
mod pairs;
mod prescribed;
mod procedures;
mod regions;
mod rigid;
mod sections;
mod sets;
mod steps;
mod surfaces;

use crate::model::{Boundary, Dialect, InteractionId, Model, Region, SurfaceId, SurfaceKind};

use super::card::Deck;
use super::report::{At, Report};
use super::source::SourceMap;
use budget::Budget;
use explicit_pairs::PairEvent;
use interactions::InteractionLines;
use layout::Layout;
use names::{Labels, Names};
use prescribed::Part;
use rustc_hash::FxHashSet;

/// What the passes share.
struct Builder<'r> {
    model: Model,
    report: &'r mut Report,
    map: &'r SourceMap,
    node_index: Labels,
    element_index: Labels,
    node_sets: Names,
    element_sets: Names,
    surfaces: Names,
    materials: Names,
    interactions: Names,
    /// Positions in `Model::interactions` of those names.
    interaction_names: Vec<InteractionId>,
    /// Lines of `Model::interactions`.
    interaction_lines: Vec<InteractionLines>,
    amplitudes: Names,
    /// Labels about which enough has been said.
    refused_nodes: FxHashSet<u32>,
    refused_elements: FxHashSet<u32>,
    /// Lines of the elements.
    element_at: Vec<At>,
    budget: Budget,
    /// Lines of the equations.
    equation_at: Vec<At>,
    /// Lines of the rigid bodies.
    rigid_at: Vec<At>,
    /// Position of the first equation of a rigid body: those of the deck stand before.
    rigid_equations_from: usize,
    /// Names of the contact pairs.
    pairs: FxHashSet<String>,
    /// Surfaces of pairs that are wrong, about which enough has been said.
    faulty_pairs: FxHashSet<(SurfaceId, SurfaceId)>,
    /// Positions of pairs without SMALL SLIDING.
    finite_sliding: FxHashSet<usize>,
    /// Sets of pairs of explicit decks.
    contact_sets: Names,
    /// Positions of the pairs of each.
    contact_set_pairs: Vec<Vec<usize>>,
    /// Pairs that explicit steps add and delete, in the order of the deck.
    pair_events: Vec<PairEvent>,
    /// Interaction of explicit pairs that name none.
    default_interaction: Option<InteractionId>,
    /// Interactions of the parts of general contact.
    general_interactions: Vec<InteractionId>,
    /// Factors on the penalties of parts of general contact, by their positions among the pairs.
    general_scales: Vec<(usize, f64)>,
    /// Whether the deck is one of Abaqus/Explicit.
    is_explicit: bool,
    /// Values before the first step, which CalculiX reaches over it.
    early_boundaries: Vec<(At, Boundary)>,
    /// Lines of the contact pairs.
    pair_at: Vec<At>,
    /// Lines of the boundaries of each step.
    step_lines: Vec<Vec<At>>,
    /// Lines of the loads of each step.
    load_lines: Vec<Vec<At>>,
}

/// Builds the model. It is to be used only when the report has no errors.
pub fn build(mut deck: Deck, dialect: Dialect, map: &SourceMap, report: &mut Report) -> Model {
    let parts = mesh::build_mesh(&mut deck, dialect, report);
    let Deck { heading, cards, refused_nodes, refused_elements, incomplete, stopped, .. } = deck;
    let layout = layout::arrange(&cards, stopped, report);
    let entities = parts.mesh.nodes.len() + parts.mesh.elements.len();
    let mut builder = Builder {
        model: Model { heading, dialect, mesh: parts.mesh, ..Model::default() },
        report,
        map,
        node_index: parts.nodes,
        element_index: parts.elements,
        node_sets: Names::new("node set"),
        element_sets: Names::new("element set"),
        surfaces: Names::new("surface"),
        materials: Names::new("material"),
        interactions: Names::new("surface interaction"),
        interaction_names: Vec::new(),
        interaction_lines: Vec::new(),
        amplitudes: Names::new("amplitude"),
        refused_nodes,
        refused_elements,
        element_at: parts.element_at,
        budget: Budget::of(entities),
        equation_at: Vec::new(),
        rigid_at: Vec::new(),
        rigid_equations_from: 0,
        pairs: FxHashSet::default(),
        faulty_pairs: FxHashSet::default(),
        finite_sliding: FxHashSet::default(),
        contact_sets: Names::new("contact pair set"),
        contact_set_pairs: Vec::new(),
        pair_events: Vec::new(),
        default_interaction: None,
        general_interactions: Vec::new(),
        general_scales: Vec::new(),
        is_explicit: layout.is_explicit(),
        early_boundaries: Vec::new(),
        pair_at: Vec::new(),
        step_lines: Vec::new(),
        load_lines: Vec::new(),
    };
    if incomplete {
        // Names and labels may stand in what was not read.
        return builder.model;
    }
    builder.build_sets(&layout, &parts.node_rows, &parts.element_rows);
    builder.build_surfaces(&layout);
    builder.build_materials(&layout);
    builder.build_sections(&layout);
    builder.build_rigid_bodies(&layout);
    builder.place_rotary_inertia();
    builder.check_masses(&layout);
    builder.check_dashpots(&layout);
    builder.build_equations(&layout);
    builder.build_interactions(&layout);
    builder.build_pairs(&layout);
    builder.build_gaps(&layout);
    builder.build_general_contact(&layout);
    builder.build_amplitudes(&layout);
    builder.build_clearances(&layout);
    builder.build_initial_boundaries(&layout);
    builder.build_initial_velocities(&layout);
    builder.build_steps(&layout);
    builder.check_prescribed(&layout);
    builder.check_equations();
    builder.check_loads();
    builder.check_combinations(&layout);
    if !layout.has_refused_keywords() {
        builder.check_unused();
    }
    if !builder.report.has_errors() {
        builder.adjust_nodes();
        builder.write_rigid_equations();
    }
    builder.model
}

impl Builder<'_> {
    fn build_initial_boundaries(&mut self, layout: &Layout<'_>) {
        let mut boundaries: Vec<Boundary> = Vec::new();
        // Lines of single nodes, which generators write by the thousand, are joined per direction.
        let mut joined: [Option<usize>; 3] = [None; 3];
        for card in layout.model.iter().filter(|card| card.keyword.name == "*BOUNDARY") {
            let mut early = Vec::new();
            self.boundary_card(card, Part::Model, |at, boundary| {
                if boundary.magnitude != 0.0 {
                    join_early(&mut early, at, boundary);
                    return;
                }
                let boundary = Boundary { amplitude: None, ..boundary };
                let slot = &mut joined[boundary.direction as usize];
                match (&boundary.region, &*slot) {
                    (Region::Label(_), Some(first)) => boundaries[*first].nodes.extend(boundary.nodes),
                    (Region::Label(_), None) => {
                        *slot = Some(boundaries.len());
                        boundaries.push(boundary);
                    }
                    _ => boundaries.push(boundary),
                }
            });
            for (_, boundary) in &mut early {
                boundary.nodes.sort_unstable();
                boundary.nodes.dedup();
            }
            self.early_boundaries.append(&mut early);
        }
        for boundary in joined.into_iter().flatten() {
            let nodes = &mut boundaries[boundary].nodes;
            nodes.sort_unstable();
            nodes.dedup();
        }
        self.model.initial_boundaries = boundaries;
    }

    /// Definitions that nothing uses are often misspelt references.
    fn check_unused(&mut self) {
        let kinds = [
            (&self.materials, "*MATERIAL", "material"),
            (&self.interactions, "*SURFACE INTERACTION", "surface interaction"),
            (&self.amplitudes, "*AMPLITUDE", "amplitude"),
            (&self.surfaces, "*SURFACE", "surface"),
        ];
        for (names, keyword, kind) in kinds {
            for position in names.unused() {
                let name = names.written(position);
                self.report.warning(
                    names.at(position),
                    keyword,
                    format!("{kind} {name} is not used"),
                    "check the names that should refer to it",
                );
            }
        }
        // Equations and node-based surfaces give a node a purpose too.
        let mesh = &self.model.mesh;
        let mut has_purpose = vec![false; mesh.nodes.len()];
        let of_elements = mesh.elements.iter().flat_map(|(_, nodes)| nodes);
        let of_surfaces = mesh.surfaces.iter().flat_map(|surface| match &surface.kind {
            SurfaceKind::Nodes(nodes) => nodes.as_slice(),
            SurfaceKind::Faces(_) | SurfaceKind::Bars(_) | SurfaceKind::Analytical(_) => &[],
        });
        let of_bodies = self.model.rigid_bodies.iter().flat_map(|body| [&body.reference, &body.rotation]);
        let of_equations = self.model.equations.iter().flat_map(|equation| &equation.terms).map(|(node, ..)| node);
        for node in of_elements.chain(of_surfaces).chain(of_equations).chain(of_bodies) {
            has_purpose[node.index()] = true;
        }
        let loose: Vec<_> = (has_purpose.iter().zip(&self.model.mesh.node_labels))
            .filter(|(used, _)| !**used)
            .map(|(_, label)| *label)
            .collect();
        if let (Some(first), true) =
            (loose.first(), self.refused_elements.is_empty() && !self.model.mesh.elements.is_empty())
        {
            let message = format!("{} nodes belong to no element, the first is node {first}", loose.len());
            self.report.warning(
                At::DECK,
                "*NODE",
                message,
                "they have no stiffness; remove them if they serve no purpose",
            );
        }
    }
}

/// Adds a value before the first step; lines of single nodes with one direction and value that follow each other are joined.
fn join_early(early: &mut Vec<(At, Boundary)>, at: At, boundary: Boundary) {
    let alike = |other: &Boundary| {
        matches!((&other.region, &boundary.region), (Region::Label(_), Region::Label(_)))
            && (other.direction, other.magnitude) == (boundary.direction, boundary.magnitude)
    };
    match early.iter_mut().rev().take(3).find(|(_, other)| alike(other)) {
        Some((_, first)) => first.nodes.extend(boundary.nodes),
        None => early.push((at, boundary)),
    }
}

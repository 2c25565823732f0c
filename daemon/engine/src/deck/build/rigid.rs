//! `*RIGID BODY`: nodes that follow a reference node, and elements that do not deform.
//!
//! The rotations of a reference node are the displacements of a hidden node that is added to the mesh (in the CalculiX dialect of
//! `ROT NODE`, where given). The nodes of the body depend on both by equations. Solids of the body get a material without
//! stiffness, so they keep their weight and their faces.

use rustc_hash::FxHashMap;

use crate::model::{Dialect, ElementId, ElementKind, Material, MaterialId, NodeId, RigidBody, SurfaceKind};

use super::super::card::Card;
use super::super::lex::{self, looks_numeric, unquoted};
use super::super::report::{At, excerpt};
use super::Builder;
use super::layout::Layout;

const RIGID: &str = "*RIGID BODY";

/// Which body a node or element belongs to, by its line.
#[derive(Default)]
struct Owners {
    nodes: FxHashMap<NodeId, At>,
    references: FxHashMap<NodeId, At>,
    elements: FxHashMap<ElementId, At>,
    /// Copies of materials without stiffness.
    materials: FxHashMap<MaterialId, MaterialId>,
}

impl Builder<'_> {
    /// Reads every rigid body; behind sections, before equations and boundaries.
    pub(super) fn build_rigid_bodies(&mut self, layout: &Layout<'_>) {
        let mut owners = Owners::default();
        let mut sound = true;
        for card in layout.model.iter().filter(|card| card.keyword.name == RIGID) {
            sound &= self.rigid_card(card, &mut owners).is_some();
        }
        if !sound {
            return;
        }
        for (body, &at) in self.model.rigid_bodies.iter().zip(&self.rigid_at) {
            if owners.nodes.contains_key(&body.reference) || owners.nodes.contains_key(&body.rotation) {
                let label = self.model.mesh.node_labels[body.reference.index()];
                let message = format!("the reference node {label} or its ROT NODE is a node of another rigid body");
                self.report.error(at, RIGID, message, "give the body a reference node of its own");
            }
        }
        let mesh = &self.model.mesh;
        let facets = mesh.elements.iter().enumerate().filter(|(_, (kind, _))| kind.is_facet());
        let mut without = facets.map(|(e, _)| e).filter(|&e| !owners.elements.contains_key(&ElementId(e as u32)));
        if let Some(first) = without.next() {
            let (label, kind) = (mesh.element_labels[first], mesh.elements.kind(first).name());
            let count = 1 + without.count();
            let message = format!("{count} facets belong to no rigid body, the first is element {label} ({kind})");
            let remedy = "name their set in a *RIGID BODY, ELSET=…, REF NODE=…";
            self.report.error(self.element_at[first], "*ELEMENT", message, remedy);
        }
    }

    fn rigid_card(&mut self, card: &Card, owners: &mut Owners) -> Option<()> {
        let reference = self.single_node(card, "REF NODE")?;
        if owners.references.insert(reference, card.at).is_some() {
            let label = self.model.mesh.node_labels[reference.index()];
            let message = format!("node {label} is the reference node of another rigid body already");
            let remedy = "give each body a reference node of its own, or join the bodies";
            self.report.error(card.at, RIGID, message, remedy);
            return None;
        }
        let names = ["ELSET", "TIE NSET", "PIN NSET", "NSET"];
        if !names.iter().any(|name| card.parameters.has(name)) && !card.parameters.has("ANALYTICAL SURFACE") {
            let remedy = "write ELSET=, PIN NSET=, TIE NSET= or ANALYTICAL SURFACE=";
            self.report.error(card.at, RIGID, "the rigid body has neither elements nor nodes nor a surface", remedy);
            return None;
        }
        let elements = match card.parameters.value("ELSET") {
            Some(name) => self.rigid_elements(name, card, owners)?,
            None => Vec::new(),
        };
        let mesh = &self.model.mesh;
        let mut nodes: Vec<NodeId> = elements.iter().flat_map(|e| mesh.elements.nodes(e.index())).copied().collect();
        for name in names.into_iter().skip(1).filter_map(|name| card.parameters.value(name)) {
            let set = self.node_sets.refer(name, card.at, RIGID, self.report)?;
            nodes.extend(&self.model.mesh.node_sets[set as usize].nodes);
        }
        nodes.sort_unstable();
        nodes.dedup();
        // Three equations of four terms each.
        if !self.budget.take(12 * nodes.len(), card.at, RIGID, self.report) {
            return None;
        }
        let rotation = self.rotation_node(card, reference)?;
        nodes.retain(|&node| node != reference && node != rotation);
        for &node in &nodes {
            if owners.nodes.insert(node, card.at).is_some() {
                let message =
                    format!("node {} belongs to another rigid body already", self.model.mesh.node_labels[node.index()]);
                self.report.error(
                    card.at,
                    RIGID,
                    message,
                    "a node follows one reference node: join the bodies, or take it out of one",
                );
                return None;
            }
        }
        self.add_rotation(reference, rotation);
        if let Some(name) = card.parameters.value("ANALYTICAL SURFACE") {
            self.rigid_surface(name, card)?;
        }
        self.model.rigid_bodies.push(RigidBody { reference, rotation, nodes, place: self.map.place(card.at) });
        self.rigid_at.push(card.at);
        Some(())
    }

    /// Elements of a body: facets, and solids, which get a material without stiffness.
    fn rigid_elements(&mut self, name: &str, card: &Card, owners: &mut Owners) -> Option<Vec<ElementId>> {
        let set = self.element_sets.refer(name, card.at, RIGID, self.report)?;
        let elements = self.model.mesh.element_sets[set as usize].elements.clone();
        if !self.budget.take(elements.len(), card.at, RIGID, self.report) {
            return None;
        }
        for &element in &elements {
            let mesh = &self.model.mesh;
            let (kind, label) = (mesh.elements.kind(element.index()), mesh.element_labels[element.index()]);
            if !kind.is_solid() && !kind.is_facet() {
                let message = format!("element {label} of type {} cannot be part of a rigid body", kind.name());
                let remedy = "name solids, R3D3 and R3D4; attach springs and masses to nodes of the body";
                self.report.error(card.at, RIGID, message, remedy);
                return None;
            }
            if owners.elements.insert(element, card.at).is_some() {
                let message = format!("element {label} belongs to another rigid body already");
                self.report.error(card.at, RIGID, message, "name each element in one body");
                return None;
            }
            let material = self.model.mesh.element_materials[element.index()];
            if let Some(original) = self.model.materials.get(material.index()).filter(|_| kind.is_solid()) {
                let copy = Material { youngs_modulus: 0.0, ..original.clone() };
                let materials = &mut self.model.materials;
                let copy = *owners.materials.entry(material).or_insert_with(|| {
                    materials.push(copy);
                    MaterialId(materials.len() as u32 - 1)
                });
                self.model.mesh.element_materials[element.index()] = copy;
            }
        }
        Some(elements)
    }

    /// Gives an analytical surface to the body that comes next.
    fn rigid_surface(&mut self, name: &str, card: &Card) -> Option<()> {
        let position = self.surfaces.refer(name, card.at, RIGID, self.report)?;
        let (mesh, next) = (&mut self.model.mesh, self.model.rigid_bodies.len() as u32);
        let definition = &mesh.surfaces[position as usize];
        let SurfaceKind::Analytical(index) = definition.kind else {
            let message = format!("surface {} is not analytical", definition.name);
            self.report.error(
                card.at,
                RIGID,
                message,
                "name a surface of TYPE=CYLINDER or TYPE=REVOLUTION, or give ELSET",
            );
            return None;
        };
        if mesh.analytical[index as usize].body.replace(next).is_some() {
            let message = format!("surface {} belongs to another rigid body already", definition.name);
            self.report.error(card.at, RIGID, message, "name each surface in one body");
            return None;
        }
        Some(())
    }

    /// Node of a parameter: a number, or a set of one node.
    fn single_node(&mut self, card: &Card, parameter: &str) -> Option<NodeId> {
        let text = card.parameters.value(parameter)?;
        if looks_numeric(text.as_bytes()) {
            return match lex::label(text.as_bytes()) {
                Ok(label) => self.node(label, card.at, RIGID),
                Err(fault) => {
                    let message = format!("{parameter}={} {}", excerpt(text.as_bytes()), fault.text());
                    self.report.error(card.at, RIGID, message, "give the number of a node, or a set of one node");
                    None
                }
            };
        }
        let set = self.node_sets.refer(unquoted(text), card.at, RIGID, self.report)?;
        let definition = &self.model.mesh.node_sets[set as usize];
        if let [node] = definition.nodes[..] {
            return Some(node);
        }
        let message = format!("{parameter}={}: the set has {} nodes", definition.name, definition.nodes.len());
        self.report.error(card.at, RIGID, message, "give the number of a node, or a set of one node");
        None
    }

    /// Node that carries the rotations: a hidden one, or `ROT NODE`.
    fn rotation_node(&mut self, card: &Card, reference: NodeId) -> Option<NodeId> {
        if card.parameters.has("ROT NODE") {
            if self.model.dialect == Dialect::Abaqus {
                let remedy = "remove it: the reference node has the rotations, degrees of freedom 4 to 6";
                self.report.error(card.at, RIGID, "ROT NODE is a parameter of CalculiX", remedy);
                return None;
            }
            let node = self.single_node(card, "ROT NODE")?;
            let label = self.model.mesh.node_labels[node.index()];
            if node == reference {
                let message = format!("node {label} is reference node and ROT NODE");
                self.report.error(card.at, RIGID, message, "give a ROT NODE of its own");
                return None;
            }
            if self.model.mesh.elements.iter().any(|(_, nodes)| nodes.contains(&node)) {
                let message = format!("the ROT NODE {label} belongs to an element");
                self.report.error(
                    card.at,
                    RIGID,
                    message,
                    "its displacements are rotations: give a node without elements",
                );
                return None;
            }
            return Some(node);
        }
        Some(self.hidden_node(reference))
    }

    /// Hangs the ROTARYI elements on the hidden nodes that carry the rotations of their nodes: those of reference nodes, and new ones
    /// for other nodes.
    pub(super) fn place_rotary_inertia(&mut self) {
        for element in 0..self.model.mesh.elements.len() {
            if self.model.mesh.elements.kind(element) != ElementKind::RotaryI {
                continue;
            }
            let node = self.model.mesh.elements.nodes(element)[0];
            let hidden = match self.model.mesh.rotation_of(node) {
                Some(hidden) => hidden,
                None => {
                    if self.model.rigid_bodies.iter().any(|body| body.nodes.binary_search(&node).is_ok()) {
                        let mesh = &self.model.mesh;
                        let (label, node) = (mesh.element_labels[element], mesh.node_labels[node.index()]);
                        let message = format!(
                            "element {label} (ROTARYI) hangs on node {node}, which follows the reference node of a rigid body"
                        );
                        let remedy = "give the inertia to the reference node";
                        self.report.error(self.element_at[element], "*ELEMENT", message, remedy);
                        continue;
                    }
                    let hidden = self.hidden_node(node);
                    self.add_rotation(node, hidden);
                    hidden
                }
            };
            self.model.mesh.elements.replace_node(element, 0, hidden);
        }
    }

    /// Adds a hidden node at the place of another one.
    fn hidden_node(&mut self, node: NodeId) -> NodeId {
        let mesh = &mut self.model.mesh;
        let hidden = NodeId(mesh.nodes.len() as u32);
        mesh.nodes.push(mesh.nodes[node.index()]);
        mesh.node_labels.push(mesh.node_labels[node.index()]);
        mesh.hidden_nodes += 1;
        hidden
    }

    fn add_rotation(&mut self, node: NodeId, rotation: NodeId) {
        let rotations = &mut self.model.mesh.rotations;
        let at = rotations.partition_point(|&(other, _)| other < node);
        rotations.insert(at, (node, rotation));
    }

    /// Adds the equations of the rigid bodies behind those of the deck; again when nodes have moved.
    pub(super) fn write_rigid_equations(&mut self) {
        self.model.equations.truncate(self.rigid_equations_from);
        self.equation_at.truncate(self.rigid_equations_from);
        for (body, at) in self.model.rigid_bodies.iter().zip(&self.rigid_at) {
            self.model.equations.extend(body.equations(&self.model.mesh));
            self.equation_at.resize(self.model.equations.len(), *at);
        }
    }
}

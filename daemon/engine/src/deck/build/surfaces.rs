//! `*SURFACE`: faces of elements, free faces of element sets, or nodes.

use rustc_hash::FxHashMap;

use crate::model::{ElementFace, ElementId, ElementKind, Mesh, NodeId, Surface, SurfaceKind, Sweep};

use super::super::card::{Body, Card, Faces, Members};
use super::super::members::{FACE_REMEDY, SNEG, SPOS};
use super::super::report::At;
use super::Builder;
use super::layout::Layout;

const SURFACE: &str = "*SURFACE";

impl Builder<'_> {
    pub(super) fn build_surfaces(&mut self, layout: &Layout<'_>) {
        for card in layout.all.iter().filter(|card| card.keyword.name == SURFACE) {
            let Some(name) = card.parameters.value("NAME") else { continue };
            let (position, is_new) = self.surfaces.enter(name, card.at);
            if !is_new {
                let message = format!("surface {name} is defined twice");
                self.report.error(card.at, SURFACE, message, "write all its faces under one *SURFACE, or rename one");
                continue;
            }
            let mut sound = !card.faulty;
            let kind = match &card.body {
                Body::Members(members) => SurfaceKind::Nodes(self.node_members(card, members, &mut sound)),
                Body::Faces(faces) => {
                    let (faces, bars) = self.face_members(card.at, faces, &mut sound);
                    if !faces.is_empty() && !bars.is_empty() {
                        let message = format!("surface {name} has faces and bars");
                        self.report.error(card.at, SURFACE, message, "give the bars a surface of their own");
                        sound = false;
                    }
                    if faces.is_empty() && !bars.is_empty() {
                        SurfaceKind::Bars(bars)
                    } else {
                        SurfaceKind::Faces(faces)
                    }
                }
                Body::Lines(_) => {
                    let sweep =
                        if card.parameters.word("TYPE") == "CYLINDER" { Sweep::Translation } else { Sweep::Revolution };
                    self.analytical_surface(card, sweep).unwrap_or_else(|| {
                        sound = false;
                        SurfaceKind::Faces(Vec::new())
                    })
                }
                _ => SurfaceKind::Faces(Vec::new()),
            };
            let empty = match &kind {
                SurfaceKind::Nodes(nodes) => nodes.is_empty(),
                SurfaceKind::Faces(faces) => faces.is_empty(),
                SurfaceKind::Bars(_) | SurfaceKind::Analytical(_) => false,
            };
            if empty && sound {
                self.report.error(
                    card.at,
                    SURFACE,
                    format!("surface {name} is empty"),
                    "list its faces, or its nodes with TYPE=NODE",
                );
                sound = false;
            }
            if !sound {
                self.surfaces.mark_faulty(position);
            }
            self.model.mesh.surfaces.push(Surface { name: name.to_string(), kind });
        }
    }

    fn node_members(&mut self, card: &Card, members: &Members, sound: &mut bool) -> Vec<NodeId> {
        let mut nodes = Vec::new();
        for &(label, at) in &members.labels {
            match self.node(label, at, card.keyword.name) {
                Some(node) => nodes.push(node),
                None => *sound = false,
            }
        }
        for (name, at) in &members.names {
            match self.node_sets.refer(name, *at, card.keyword.name, self.report) {
                Some(set) => {
                    let members = &self.model.mesh.node_sets[set as usize].nodes;
                    if self.budget.take(members.len(), *at, SURFACE, self.report) {
                        nodes.extend(members);
                    }
                }
                None => *sound = false,
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Faces, and bars named without a face.
    fn face_members(&mut self, at: At, members: &Faces, sound: &mut bool) -> (Vec<ElementFace>, Vec<ElementId>) {
        let (mut faces, mut bars) = (Vec::new(), Vec::new());
        // Elements whose free faces are wanted.
        let mut exposed: Vec<ElementId> = Vec::new();
        for &(label, face, at) in &members.labels {
            match self.element(label, at, SURFACE) {
                Some(element) if face == 0 && self.is_bar(element) => bars.push(element),
                Some(element) => match self.without_face(&[element], face) {
                    None if face == 0 => exposed.push(element),
                    None => faces.push(ElementFace { element, face: position(face) }),
                    Some(message) => {
                        self.report.error(at, SURFACE, message, FACE_REMEDY);
                        *sound = false;
                    }
                },
                None => *sound = false,
            }
        }
        for (name, face, at) in &members.names {
            let Some(set) = self.element_sets.refer(name, *at, SURFACE, self.report) else {
                *sound = false;
                continue;
            };
            let elements = &self.model.mesh.element_sets[set as usize].elements;
            if !self.budget.take(elements.len(), *at, SURFACE, self.report) {
                break;
            }
            if *face == 0 && !elements.is_empty() && elements.iter().all(|&element| self.is_bar(element)) {
                bars.extend(elements);
                continue;
            }
            match (self.without_face(elements, *face), *face) {
                (None, 0) => exposed.extend(elements),
                (None, face) => {
                    faces.extend(elements.iter().map(|&element| ElementFace { element, face: position(face) }));
                }
                (Some(message), _) => {
                    self.report.error(*at, SURFACE, message, FACE_REMEDY);
                    *sound = false;
                }
            }
        }
        // The search for free faces looks at every element of the mesh.
        let searched = 6 * self.model.mesh.elements.len();
        if !exposed.is_empty() && self.budget.take(searched, at, SURFACE, self.report) {
            faces.extend(free_faces(&self.model.mesh, &exposed));
        }
        faces.sort_unstable();
        faces.dedup();
        bars.sort_unstable();
        bars.dedup();
        (faces, bars)
    }

    fn is_bar(&self, element: ElementId) -> bool {
        self.model.mesh.elements.kind(element.index()) == ElementKind::T3D2
    }
}

impl Builder<'_> {
    /// Says which of the elements has no such face, numbered from 1; 0 is any face, SPOS and SNEG are those of facets.
    pub(super) fn without_face(&self, elements: &[ElementId], face: u8) -> Option<String> {
        let mesh = &self.model.mesh;
        let faces = |element: ElementId| mesh.elements.kind(element.index()).shape().faces().len();
        if let Some(facet) = elements.iter().find(|e| face == 0 && mesh.elements.kind(e.index()).is_facet()) {
            let (label, kind) = (mesh.element_labels[facet.index()], mesh.elements.kind(facet.index()).name());
            return Some(format!("element {label} of type {kind} has two sides: write SPOS or SNEG behind it"));
        }
        if let SPOS | SNEG = face {
            let solid = elements.iter().find(|e| !mesh.elements.kind(e.index()).is_facet())?;
            let (label, kind) = (mesh.element_labels[solid.index()], mesh.elements.kind(solid.index()).name());
            return Some(format!("element {label} of type {kind} has no sides SPOS and SNEG: it is no facet"));
        }
        let element = *elements.iter().find(|&&element| usize::from(face.max(1)) > faces(element))?;
        let (label, kind) = (mesh.element_labels[element.index()], mesh.elements.kind(element.index()).name());
        Some(match faces(element) {
            0 => format!("element {label} of type {kind} has no faces"),
            count => format!("element {label} of type {kind} has {count} faces and no face {face}"),
        })
    }
}

/// Position of a face in its element.
fn position(face: u8) -> u8 {
    match face {
        SPOS => 0,
        SNEG => 1,
        face => face - 1,
    }
}

/// Faces of the elements that no other element of the mesh shares.
pub fn free_faces(mesh: &Mesh, elements: &[ElementId]) -> Vec<ElementFace> {
    // Corners tell a face; the fourth of a triangle is no node.
    let corners = |face: ElementFace| {
        let mut corners = [NodeId(u32::MAX); 4];
        for (corner, &node) in corners.iter_mut().zip(mesh.face_nodes(face).corners()) {
            *corner = node;
        }
        corners.sort_unstable();
        corners
    };
    // A facet that covers a solid does not take its face away.
    let is_solid = |element: &ElementId| mesh.elements.kind(element.index()).is_solid();
    let faces_of = |element: ElementId| mesh.elements.faces_of(element);
    let mut wanted: FxHashMap<[NodeId; 4], u32> = FxHashMap::default();
    for &element in elements {
        wanted.extend(faces_of(element).map(|face| (corners(face), 0)));
    }
    for element in (0..mesh.elements.len() as u32).map(ElementId).filter(is_solid) {
        for face in faces_of(element) {
            if let Some(count) = wanted.get_mut(&corners(face)) {
                *count += 1;
            }
        }
    }
    let all = elements.iter().flat_map(|&element| faces_of(element));
    all.filter(|&face| wanted.get(&corners(face)) == Some(&1)).collect()
}

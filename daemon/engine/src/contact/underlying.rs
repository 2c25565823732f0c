//! Representative stiffness of what lies under a contact point: automatic penalties are multiples of it.
//!
//! ```text
//! solid under a face     k = M / L,  L = V / A             [pressure/length]
//! connectors at a node   k = Σ c (b · n)² / a              c = EA/L of a bar, the constant of a spring; a the point's area
//! both sides             1 / (1/k_secondary + 1/k_primary)
//! ```
//!
//! `M = E (1 − ν) / ((1 + ν) (1 − 2ν))` resists strain along one direction with the others held; `V` is the volume of the element,
//! `A` the area of its face, so `L` is its depth. Several elements at a node count by their mean. A side without elements that
//! deform (rigid, only supported, only a mass) is infinitely stiff.
//!
//! Points that carry a force instead of a pressure (nodes of a node-based surface, GAP elements) have an area that is not that of
//! any face. There the force per length `M A / L` of the faces is divided by the area of the point, so that stiffness times area is
//! what the elements give, whatever the area says.

use rustc_hash::FxHashMap;

use crate::element::quad::{dot, norm};
use crate::element::{self, Coordinates, connector, face};
use crate::model::{ElementFace, ElementId, MaterialId, Model, NodeId, PairMembers, SurfaceKind};

/// Faces within 60 degrees of the contact direction lie under the point.
const FACING_COSINE: f64 = 0.5;

/// Two sides one behind the other; a side without stiffness of its own is rigid. None when both are.
pub fn in_series(one: Option<f64>, other: Option<f64>) -> Option<f64> {
    match (one, other) {
        (Some(a), Some(b)) => Some(1.0 / (1.0 / a + 1.0 / b)),
        (only, None) | (None, only) => only,
    }
}

/// Stiffness under the faces and nodes of a model.
pub struct Underlying<'a> {
    /// The model.
    pub model: &'a Model,
    /// `M` of each material [pressure].
    moduli: Vec<f64>,
    /// Connectors at each node.
    connectors: FxHashMap<NodeId, Vec<ElementId>>,
    /// Solids at the nodes of node-based surfaces and GAP elements.
    solids: FxHashMap<NodeId, Vec<ElementId>>,
}

impl<'a> Underlying<'a> {
    /// Looks through the elements once.
    pub fn new(model: &'a Model) -> Self {
        let mesh = &model.mesh;
        let modulus = |e: f64, nu: f64| e * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let moduli = model.materials.iter().map(|m| modulus(m.youngs_modulus, m.poissons_ratio)).collect();
        let mut solids: FxHashMap<NodeId, Vec<ElementId>> = lone_nodes(model).map(|n| (n, Vec::new())).collect();
        let mut connectors: FxHashMap<NodeId, Vec<ElementId>> = FxHashMap::default();
        if !solids.is_empty() || !mesh.connectors.is_empty() {
            for (position, (kind, nodes)) in mesh.elements.iter().enumerate() {
                let element = ElementId(position as u32);
                if kind.is_solid() {
                    for node in nodes {
                        if let Some(at) = solids.get_mut(node) {
                            at.push(element);
                        }
                    }
                } else if mesh.connectors.contains_key(&element) {
                    nodes.iter().for_each(|n| connectors.entry(*n).or_default().push(element));
                }
            }
        }
        Self { model, moduli, connectors, solids }
    }

    /// Under a face [pressure/length]; none if its element does not deform.
    pub fn of_face(&self, face: ElementFace) -> Option<f64> {
        Some(self.modulus(face.element)? * face_area(self.model, face) / self.volume(face.element))
    }

    /// Under a face as a force per length: `M A / L` [force/length].
    pub fn force_of_face(&self, face: ElementFace) -> Option<f64> {
        self.of_face(face).map(|k| k * face_area(self.model, face))
    }

    /// Under each node of some faces: the mean over its faces [pressure/length].
    pub fn of_faces(&self, faces: &[ElementFace]) -> FxHashMap<NodeId, f64> {
        let mut sums: FxHashMap<NodeId, (f64, f64)> = FxHashMap::default();
        for &face in faces {
            let Some(k) = self.of_face(face) else { continue };
            for node in self.model.mesh.face_nodes(face).iter() {
                let sum = sums.entry(*node).or_default();
                *sum = (sum.0 + k, sum.1 + 1.0);
            }
        }
        sums.into_iter().map(|(node, (sum, count))| (node, sum / count)).collect()
    }

    /// Connectors at a node along a unit vector [force/length]; none without any that resists.
    pub fn of_connectors(&self, node: NodeId, normal: [f64; 3]) -> Option<f64> {
        let mesh = &self.model.mesh;
        let mut sum = 0.0;
        for element in self.connectors.get(&node)? {
            let (kind, nodes) = (mesh.elements.kind(element.index()), mesh.elements.nodes(element.index()));
            let coordinates = Coordinates::of(nodes.iter().map(|n| mesh.nodes[n.index()]));
            let section = mesh.connectors[element];
            let material = mesh.element_materials.get(element.index()).copied().unwrap_or(MaterialId::NONE);
            let youngs_modulus = self.model.materials.get(material.index()).map_or(0.0, |m| m.youngs_modulus);
            let stiffness = connector::axial_stiffness(&coordinates, section, youngs_modulus).unwrap_or(0.0);
            let b = connector::elongation(kind, &coordinates, section);
            // Facets of rigid bodies have more nodes than ends; none of them is drawn out.
            let position = nodes.iter().position(|own| *own == node);
            let at = position.and_then(|position| b.get(position).copied()).unwrap_or_default();
            sum += stiffness * dot(at, normal).powi(2);
        }
        (sum > 0.0).then_some(sum)
    }

    /// Solids at a node that was looked for, on its outer faces that look along `outward` [force/length]: the sum of their shares
    /// `M A / L / nodes of the face`. Without such a face the mean of `M V^(1/3)` of its elements; none without any.
    pub fn of_node(&self, node: NodeId, outward: [f64; 3]) -> Option<f64> {
        let mesh = &self.model.mesh;
        let elements: Vec<ElementId> =
            self.solids.get(&node)?.iter().copied().filter(|e| self.modulus(*e).is_some()).collect();
        if elements.is_empty() {
            return None;
        }
        let mut faces: Vec<([NodeId; 4], ElementFace)> = Vec::new();
        for face in elements.iter().flat_map(|&e| mesh.elements.faces_of(e)) {
            let nodes = mesh.face_nodes(face);
            if nodes.contains(&node) {
                let mut key = [NodeId(u32::MAX); 4];
                key[..nodes.corners().len()].copy_from_slice(nodes.corners());
                key.sort_unstable();
                faces.push((key, face));
            }
        }
        let outer = faces.iter().filter(|(key, _)| faces.iter().filter(|(other, _)| other == key).count() == 1);
        let (mut sum, mut any) = (0.0, false);
        for (_, face) in outer {
            let coordinates = face_coordinates(self.model, *face);
            let vector = face::nodal_area_vectors(&coordinates).iter().fold([0.0; 3], |s, v| sum_of(s, *v));
            if dot(vector, outward) >= FACING_COSINE * norm(vector) {
                sum += self.force_of_face(*face).unwrap_or(0.0) / coordinates.len() as f64;
                any = true;
            }
        }
        if any {
            return Some(sum);
        }
        let all = elements.iter().filter_map(|&e| self.modulus(e).map(|m| m * self.volume(e).cbrt()));
        Some(all.sum::<f64>() / elements.len() as f64)
    }

    /// `M` of a solid; none if it is part of a rigid body.
    fn modulus(&self, element: ElementId) -> Option<f64> {
        let material = self.model.mesh.element_materials.get(element.index()).copied().unwrap_or(MaterialId::NONE);
        self.moduli.get(material.index()).copied().filter(|&m| m > 0.0)
    }

    fn volume(&self, element: ElementId) -> f64 {
        let mesh = &self.model.mesh;
        let coordinates = Coordinates::of(mesh.elements.nodes(element.index()).iter().map(|n| mesh.nodes[n.index()]));
        element::nodal_volumes(mesh.elements.kind(element.index()), &coordinates).iter().sum()
    }
}

/// Area of a face [length²].
pub fn face_area(model: &Model, face: ElementFace) -> f64 {
    face::nodal_areas(&face_coordinates(model, face)).iter().sum()
}

fn face_coordinates(model: &Model, face: ElementFace) -> Coordinates {
    Coordinates::of(model.mesh.face_nodes(face).iter().map(|n| model.mesh.nodes[n.index()]))
}

fn sum_of(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// Nodes that meet something without a face of their own.
fn lone_nodes(model: &Model) -> impl Iterator<Item = NodeId> + '_ {
    model.pairs.iter().flat_map(|pair| {
        let mut nodes = Vec::new();
        match &pair.members {
            // General contact has faces only.
            PairMembers::General(_) => {}
            PairMembers::Gaps(gaps) => nodes.extend(gaps.iter().flat_map(|gap| gap.nodes)),
            PairMembers::Surfaces(surfaces) => {
                let mesh = &model.mesh;
                match &mesh.surfaces[surfaces.secondary.index()].kind {
                    SurfaceKind::Nodes(all) => nodes.extend(all),
                    SurfaceKind::Bars(bars) => nodes.extend(bars.iter().flat_map(|e| mesh.elements.nodes(e.index()))),
                    SurfaceKind::Faces(_) | SurfaceKind::Analytical(_) => {}
                }
            }
        }
        nodes
    })
}

//! Nodes, elements, sets and surfaces.

use rustc_hash::FxHashMap;

use super::{AnalyticalSurface, Connector, Elements, FaceNodes};

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
        pub struct $name(pub u32);

        impl $name {
            /// As an index into the vector that holds these.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

id!(
    /// Position of a node in [`Mesh::nodes`].
    NodeId
);
id!(
    /// Position of an element in [`Mesh::elements`].
    ElementId
);
id!(
    /// Position of a node set in [`Mesh::node_sets`] or of an element set in [`Mesh::element_sets`].
    SetId
);
id!(
    /// Position of a surface in [`Mesh::surfaces`].
    SurfaceId
);
id!(
    /// Position of a material in [`super::Model::materials`].
    MaterialId
);
impl MaterialId {
    /// Of an element that has no material.
    pub const NONE: Self = Self(u32::MAX);
}

id!(
    /// Position of an interaction in [`super::Model::interactions`].
    InteractionId
);
id!(
    /// Position of an amplitude in [`super::Model::amplitudes`].
    AmplitudeId
);

/// Geometry and grouping.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Coordinates \[length\].
    pub nodes: Vec<[f64; 3]>,
    /// Number that the analyst gave to each node.
    pub node_labels: Vec<u32>,
    /// Node of each label.
    pub node_of_label: FxHashMap<u32, NodeId>,
    /// Elements: kinds and nodes.
    pub elements: Elements,
    /// Number that the analyst gave to each element.
    pub element_labels: Vec<u32>,
    /// Element of each label.
    pub element_of_label: FxHashMap<u32, ElementId>,
    /// Material of each element, from the sections; [`MaterialId::NONE`] for springs and masses.
    pub element_materials: Vec<MaterialId>,
    /// Section of each element that is not a solid.
    pub connectors: FxHashMap<ElementId, Connector>,
    /// Node sets, in order of first definition. Members ascending, without repetition.
    pub node_sets: Vec<NodeSet>,
    /// Element sets, in order of first definition. Members ascending, without repetition.
    pub element_sets: Vec<ElementSet>,
    /// Surfaces, in order of definition.
    pub surfaces: Vec<Surface>,
    /// Analytical surfaces, by [`SurfaceKind::Analytical`].
    pub analytical: Vec<AnalyticalSurface>,
    /// Nodes with rotations (reference nodes of rigid bodies, nodes of ROTARYI elements), each with the node whose three displacements
    /// are its rotations \[rad\]; by node.
    pub rotations: Vec<(NodeId, NodeId)>,
    /// How many of the last nodes are not the analyst's: they only carry the rotations of reference nodes, whose numbers they have.
    pub hidden_nodes: u32,
}

/// Face of an element; `face` is 0 for S1 (or P1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ElementFace {
    /// The element.
    pub element: ElementId,
    /// Face number less one.
    pub face: u8,
}

impl Mesh {
    /// Number of nodes that the analyst defined; the hidden ones follow.
    pub fn node_count(&self) -> usize {
        self.nodes.len() - self.hidden_nodes as usize
    }

    /// Node whose displacements are the rotations of a reference node; none for nodes without rotations.
    pub fn rotation_of(&self, reference: NodeId) -> Option<NodeId> {
        let at = self.rotations.binary_search_by_key(&reference, |&(reference, _)| reference).ok()?;
        Some(self.rotations[at].1)
    }

    /// Degree of freedom, as analysts number them, of a direction (0..3): 1 to 3, or 4 to 6 on hidden nodes.
    pub fn dof_of(&self, node: NodeId, direction: u8) -> u8 {
        direction + if node.index() < self.node_count() { 1 } else { 4 }
    }

    /// Nodes of a face, outward by the right-hand rule: corners, then midside nodes.
    pub fn face_nodes(&self, face: ElementFace) -> FaceNodes {
        self.elements.face_nodes(face)
    }
}

/// `*NSET`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeSet {
    /// Name as first written; comparisons ignore case.
    pub name: String,
    /// Members, ascending by index, no repetition.
    pub nodes: Vec<NodeId>,
}

/// `*ELSET`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ElementSet {
    /// Name as first written; comparisons ignore case.
    pub name: String,
    /// Members, ascending by index, no repetition.
    pub elements: Vec<ElementId>,
}

/// `*SURFACE`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Surface {
    /// Name as the analyst wrote it.
    pub name: String,
    /// Faces or nodes.
    pub kind: SurfaceKind,
}

/// Members of a surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SurfaceKind {
    /// `TYPE=ELEMENT`: faces, ascending, no repetition.
    Faces(Vec<ElementFace>),
    /// `TYPE=NODE`: nodes, ascending, no repetition.
    Nodes(Vec<NodeId>),
    /// `TYPE=ELEMENT` on bars, secondary only: their nodes carry a force per length. Ascending, no repetition.
    Bars(Vec<ElementId>),
    /// Analytical rigid surface, primary only: position in [`Mesh::analytical`].
    Analytical(u32),
}

//! Element kinds, their shapes and faces, and the element table of a mesh.

use super::{ElementFace, ElementId, NodeId};

/// Most nodes that an element has.
pub const ELEMENT_NODES_MAX: usize = 20;

/// Most nodes that a face has.
pub const FACE_NODES_MAX: usize = 8;

/// Element kinds that can be solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementKind {
    /// Eight-node brick, volumetric part selectively reduced (mean dilatation).
    C3D8,
    /// Eight-node brick, fully integrated: what CalculiX calls C3D8.
    C3D8Full,
    /// Eight-node brick with incompatible modes.
    C3D8I,
    /// Eight-node brick of uniform strain with hourglass stiffness.
    C3D8R,
    /// Four-node tetrahedron.
    C3D4,
    /// Six-node wedge.
    C3D6,
    /// Ten-node tetrahedron.
    C3D10,
    /// Fifteen-node wedge.
    C3D15,
    /// Twenty-node brick, fully integrated (3 x 3 x 3).
    C3D20,
    /// Twenty-node brick, reduced integration (2 x 2 x 2).
    C3D20R,
    /// C3D8R with the hourglass stiffness of CalculiX.
    C3D8RCalculix,
    /// Bar between two nodes.
    T3D2,
    /// Spring along the line between two nodes.
    SpringA,
    /// Spring between a direction of a node and the ground.
    Spring1,
    /// Spring between a direction of one node and a direction of another.
    Spring2,
    /// Dashpot along the line between two nodes.
    DashpotA,
    /// Dashpot between a direction of a node and the ground.
    Dashpot1,
    /// Dashpot between a direction of one node and a direction of another.
    Dashpot2,
    /// Point mass.
    Mass,
    /// Rotary inertia at a node with rotations.
    RotaryI,
    /// Gap between two nodes along a fixed direction.
    GapUni,
    /// Gap between two nodes in their distance from each other normal to an axis.
    GapCyl,
    /// Gap between two nodes in their distance.
    GapSpher,
    /// Triangular facet of a rigid body.
    R3D3,
    /// Quadrilateral facet of a rigid body.
    R3D4,
}

/// Where the nodes and faces of an element are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ElementShape {
    /// Tetrahedron of corners.
    Tetrahedron4,
    /// Tetrahedron with midside nodes.
    Tetrahedron10,
    /// Wedge of corners.
    Wedge6,
    /// Wedge with midside nodes.
    Wedge15,
    /// Hexahedron of corners.
    Hexahedron8,
    /// Hexahedron with midside nodes.
    Hexahedron20,
    /// Line between two nodes; no faces.
    Line2,
    /// One node; no faces.
    Point1,
    /// Triangle of corners; its two sides are its faces.
    Triangle3,
    /// Quadrilateral of corners; its two sides are its faces.
    Quadrilateral4,
}

/// What a section says of a connector: an element that is not a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Connector {
    /// T3D2: `*SOLID SECTION` with a cross-section; the material is that of the element.
    Bar {
        /// Cross-section area \[length²\], positive.
        area: f64,
    },
    /// `*SPRING`, linear.
    Spring {
        /// Force per length, not negative.
        stiffness: f64,
        /// Directions (0..3) at the first and second node; SPRINGA ignores them, SPRING1 uses the first.
        directions: [u8; 2],
    },
    /// `*DASHPOT`, linear.
    Dashpot {
        /// Force per velocity, not negative.
        coefficient: f64,
        /// Directions (0..3) at the first and second node; DASHPOTA ignores them, DASHPOT1 uses the first.
        directions: [u8; 2],
    },
    /// `*MASS`.
    Mass {
        /// Mass, not negative.
        mass: f64,
        /// `ALPHA`: mass-proportional damping [1/time].
        alpha: f64,
    },
    /// `*ROTARY INERTIA`: the element's node is the hidden node that carries the rotations.
    RotaryInertia {
        /// I11, I22, I33, I12, I13, I23 about the node, global axes [mass·length²].
        inertia: [f64; 6],
        /// `ALPHA`: mass-proportional damping [1/time].
        alpha: f64,
    },
    /// GAP elements and facets of rigid bodies: neither stiffness nor mass. What they do stands in pairs and equations.
    Inert,
}

impl ElementKind {
    /// Every solid kind.
    pub const SOLIDS: [Self; 11] = [
        Self::C3D8,
        Self::C3D8Full,
        Self::C3D8I,
        Self::C3D8R,
        Self::C3D4,
        Self::C3D6,
        Self::C3D10,
        Self::C3D15,
        Self::C3D20,
        Self::C3D20R,
        Self::C3D8RCalculix,
    ];

    /// Kinds that connect nodes or give them mass.
    pub const CONNECTORS: [Self; 9] = [
        Self::T3D2,
        Self::SpringA,
        Self::Spring1,
        Self::Spring2,
        Self::DashpotA,
        Self::Dashpot1,
        Self::Dashpot2,
        Self::Mass,
        Self::RotaryI,
    ];

    /// Kinds without stiffness and mass: contact elements and facets of rigid bodies.
    pub const INERT: [Self; 5] = [Self::GapUni, Self::GapCyl, Self::GapSpher, Self::R3D3, Self::R3D4];

    /// Where its nodes and faces are.
    pub const fn shape(self) -> ElementShape {
        match self {
            Self::C3D8 | Self::C3D8Full | Self::C3D8I | Self::C3D8R | Self::C3D8RCalculix => ElementShape::Hexahedron8,
            Self::C3D4 => ElementShape::Tetrahedron4,
            Self::C3D6 => ElementShape::Wedge6,
            Self::C3D10 => ElementShape::Tetrahedron10,
            Self::C3D15 => ElementShape::Wedge15,
            Self::C3D20 | Self::C3D20R => ElementShape::Hexahedron20,
            Self::T3D2
            | Self::SpringA
            | Self::Spring2
            | Self::DashpotA
            | Self::Dashpot2
            | Self::GapUni
            | Self::GapCyl
            | Self::GapSpher => ElementShape::Line2,
            Self::Spring1 | Self::Dashpot1 | Self::Mass | Self::RotaryI => ElementShape::Point1,
            Self::R3D3 => ElementShape::Triangle3,
            Self::R3D4 => ElementShape::Quadrilateral4,
        }
    }

    /// Number of nodes.
    pub const fn node_count(self) -> usize {
        self.shape().node_count()
    }

    /// Whether it is a solid: it has faces, a volume and stresses in all components.
    pub const fn is_solid(self) -> bool {
        !matches!(
            self.shape(),
            ElementShape::Line2 | ElementShape::Point1 | ElementShape::Triangle3 | ElementShape::Quadrilateral4
        )
    }

    /// Whether it is a GAP element: a contact point.
    pub const fn is_gap(self) -> bool {
        matches!(self, Self::GapUni | Self::GapCyl | Self::GapSpher)
    }

    /// Whether it is a facet of a rigid body: it has two faces, SPOS (S1) and SNEG (S2), and no volume.
    pub const fn is_facet(self) -> bool {
        matches!(self, Self::R3D3 | Self::R3D4)
    }

    /// Name in a deck.
    pub const fn name(self) -> &'static str {
        match self {
            Self::C3D8 | Self::C3D8Full => "C3D8",
            Self::C3D8I => "C3D8I",
            Self::C3D8R | Self::C3D8RCalculix => "C3D8R",
            Self::C3D4 => "C3D4",
            Self::C3D6 => "C3D6",
            Self::C3D10 => "C3D10",
            Self::C3D15 => "C3D15",
            Self::C3D20 => "C3D20",
            Self::C3D20R => "C3D20R",
            Self::T3D2 => "T3D2",
            Self::SpringA => "SPRINGA",
            Self::Spring1 => "SPRING1",
            Self::Spring2 => "SPRING2",
            Self::DashpotA => "DASHPOTA",
            Self::Dashpot1 => "DASHPOT1",
            Self::Dashpot2 => "DASHPOT2",
            Self::Mass => "MASS",
            Self::RotaryI => "ROTARYI",
            Self::GapUni => "GAPUNI",
            Self::GapCyl => "GAPCYL",
            Self::GapSpher => "GAPSPHER",
            Self::R3D3 => "R3D3",
            Self::R3D4 => "R3D4",
        }
    }
}

/// Local nodes of the faces S1, S2, … of each shape, outward by the right-hand rule: corners, then midside nodes in the
/// order of the edges that begin at the corners.
const TETRAHEDRON4: &[&[u8]] = &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]];
const TETRAHEDRON10: &[&[u8]] = &[&[0, 2, 1, 6, 5, 4], &[0, 1, 3, 4, 8, 7], &[1, 2, 3, 5, 9, 8], &[2, 0, 3, 6, 7, 9]];
const WEDGE6: &[&[u8]] = &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]];
const WEDGE15: &[&[u8]] = &[
    &[0, 2, 1, 8, 7, 6],
    &[3, 4, 5, 9, 10, 11],
    &[0, 1, 4, 3, 6, 13, 9, 12],
    &[1, 2, 5, 4, 7, 14, 10, 13],
    &[2, 0, 3, 5, 8, 12, 11, 14],
];
const HEXAHEDRON8: &[&[u8]] =
    &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];
const HEXAHEDRON20: &[&[u8]] = &[
    &[0, 3, 2, 1, 11, 10, 9, 8],
    &[4, 5, 6, 7, 12, 13, 14, 15],
    &[0, 1, 5, 4, 8, 17, 12, 16],
    &[1, 2, 6, 5, 9, 18, 13, 17],
    &[2, 3, 7, 6, 10, 19, 14, 18],
    &[3, 0, 4, 7, 11, 16, 15, 19],
];
const TRIANGLE3: &[&[u8]] = &[&[0, 1, 2], &[0, 2, 1]];
const QUADRILATERAL4: &[&[u8]] = &[&[0, 1, 2, 3], &[0, 3, 2, 1]];

impl ElementShape {
    /// Number of nodes.
    pub const fn node_count(self) -> usize {
        match self {
            Self::Tetrahedron4 => 4,
            Self::Tetrahedron10 => 10,
            Self::Wedge6 => 6,
            Self::Wedge15 => 15,
            Self::Hexahedron8 => 8,
            Self::Hexahedron20 => 20,
            Self::Line2 => 2,
            Self::Point1 => 1,
            Self::Triangle3 => 3,
            Self::Quadrilateral4 => 4,
        }
    }

    /// Local nodes of the faces S1, S2, …, outward by the right-hand rule: corners, then midside nodes.
    pub const fn faces(self) -> &'static [&'static [u8]] {
        match self {
            Self::Tetrahedron4 => TETRAHEDRON4,
            Self::Tetrahedron10 => TETRAHEDRON10,
            Self::Wedge6 => WEDGE6,
            Self::Wedge15 => WEDGE15,
            Self::Hexahedron8 => HEXAHEDRON8,
            Self::Hexahedron20 => HEXAHEDRON20,
            Self::Line2 | Self::Point1 => &[],
            Self::Triangle3 => TRIANGLE3,
            Self::Quadrilateral4 => QUADRILATERAL4,
        }
    }
}

/// Nodes of a face: 3 or 4 corners, or 6 or 8 nodes with the midside nodes behind the corners.
#[derive(Clone, Copy, Debug)]
pub struct FaceNodes {
    nodes: [NodeId; FACE_NODES_MAX],
    count: u8,
}

impl FaceNodes {
    /// One node in place of a face.
    pub fn single(node: NodeId) -> Self {
        let mut nodes = [NodeId(0); FACE_NODES_MAX];
        nodes[0] = node;
        Self { nodes, count: 1 }
    }

    /// The corners only.
    pub fn corners(&self) -> &[NodeId] {
        let corners = if self.count > 4 { self.count / 2 } else { self.count };
        &self.nodes[..corners as usize]
    }

    /// Whether the face has midside nodes.
    pub fn is_quadratic(&self) -> bool {
        self.count > 4
    }
}

impl std::ops::Deref for FaceNodes {
    type Target = [NodeId];

    fn deref(&self) -> &[NodeId] {
        &self.nodes[..self.count as usize]
    }
}

/// Elements of a mesh: a kind each, and all node lists in one array.
#[derive(Clone, Debug, Default)]
pub struct Elements {
    kinds: Vec<ElementKind>,
    /// End of each element's nodes in `nodes`.
    ends: Vec<u32>,
    nodes: Vec<NodeId>,
}

impl Elements {
    /// Makes room for elements and their nodes.
    pub fn reserve_exact(&mut self, elements: usize, nodes: usize) {
        self.kinds.reserve_exact(elements);
        self.ends.reserve_exact(elements);
        self.nodes.reserve_exact(nodes);
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Nodes of all elements, counted as often as they are named.
    pub fn node_references(&self) -> usize {
        self.nodes.len()
    }

    /// Appends an element. The nodes are in the order of the manual, as many as the kind has.
    pub fn push(&mut self, kind: ElementKind, nodes: &[NodeId]) {
        debug_assert_eq!(nodes.len(), kind.node_count());
        self.kinds.push(kind);
        self.nodes.extend_from_slice(nodes);
        self.ends.push(self.nodes.len() as u32);
    }

    /// Gives an element another node in place of one of its own, by their positions.
    pub fn replace_node(&mut self, element: usize, index: usize, node: NodeId) {
        let start = element.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.nodes[start as usize + index] = node;
    }

    /// Kind of an element by its position.
    pub fn kind(&self, element: usize) -> ElementKind {
        self.kinds[element]
    }

    /// Nodes of an element by its position, in the order of the manual.
    pub fn nodes(&self, element: usize) -> &[NodeId] {
        let start = element.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.nodes[start as usize..self.ends[element] as usize]
    }

    /// Kinds and nodes in order.
    pub fn iter(&self) -> impl Iterator<Item = (ElementKind, &[NodeId])> {
        (0..self.len()).map(|e| (self.kinds[e], self.nodes(e)))
    }

    /// Faces of an element, numbered from 0.
    pub fn faces_of(&self, element: ElementId) -> impl Iterator<Item = ElementFace> + use<> {
        let count = self.kind(element.index()).shape().faces().len() as u8;
        (0..count).map(move |face| ElementFace { element, face })
    }

    /// Nodes of a face, outward by the right-hand rule: corners, then midside nodes.
    pub fn face_nodes(&self, face: ElementFace) -> FaceNodes {
        let nodes = self.nodes(face.element.index());
        let local = self.kind(face.element.index()).shape().faces()[face.face as usize];
        let mut out = FaceNodes { nodes: [NodeId(0); FACE_NODES_MAX], count: local.len() as u8 };
        for (node, &a) in out.nodes.iter_mut().zip(local) {
            *node = nodes[a as usize];
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_of_different_kinds_keep_their_nodes() {
        let mut elements = Elements::default();
        let ids = |range: std::ops::Range<u32>| range.map(NodeId).collect::<Vec<_>>();
        elements.push(ElementKind::C3D4, &ids(0..4));
        elements.push(ElementKind::C3D20R, &ids(4..24));
        elements.push(ElementKind::C3D6, &ids(1..7));
        assert_eq!((elements.len(), elements.node_references()), (3, 30));
        assert_eq!(elements.nodes(0), ids(0..4));
        assert_eq!(elements.nodes(1), ids(4..24));
        assert_eq!(elements.nodes(2), ids(1..7));
        let face = elements.face_nodes(ElementFace { element: ElementId(1), face: 5 });
        assert_eq!(face.iter().map(|n| n.0 - 4).collect::<Vec<_>>(), [3, 0, 4, 7, 11, 16, 15, 19]);
        assert_eq!((face.corners().len(), face.is_quadratic()), (4, true));
        let face = elements.face_nodes(ElementFace { element: ElementId(2), face: 1 });
        assert_eq!((face.len(), face.corners().len(), face.is_quadratic()), (3, 3, false));
        assert_eq!(elements.faces_of(ElementId(2)).count(), 5);
    }

    #[test]
    fn every_edge_belongs_to_two_faces_in_opposite_directions_with_one_midside_node() {
        for kind in ElementKind::SOLIDS {
            let mut edges = std::collections::BTreeMap::new();
            for face in kind.shape().faces() {
                let corners = if face.len() > 4 { face.len() / 2 } else { face.len() };
                for i in 0..corners {
                    let middle = face.get(corners + i).copied();
                    assert!(edges.insert((face[i], face[(i + 1) % corners]), middle).is_none(), "{kind:?}");
                }
            }
            for (&(a, b), middle) in &edges {
                assert_eq!(edges.get(&(b, a)), Some(middle), "{kind:?}: edge {a} {b}");
            }
        }
    }
}

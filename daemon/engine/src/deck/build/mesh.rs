//! Nodes and elements: labels to positions, repetitions, undefined nodes, inverted elements.

use rustc_hash::FxHashMap;

use crate::model::{Dialect, ELEMENT_NODES_MAX, ElementId, ElementKind, ElementShape, Mesh, NodeId};

use super::super::card::{Deck, ElementTable, NodeTable};
use super::super::report::{At, Report};
use super::names::Labels;
use crate::element::{Coordinates, connector, jacobian_min};

const NODE: &str = "*NODE";
const ELEMENT: &str = "*ELEMENT";

/// Nodes and elements, and how to find them.
pub struct MeshParts {
    /// The mesh without sets and surfaces.
    pub mesh: Mesh,
    /// Node positions.
    pub nodes: Labels,
    /// Element positions.
    pub elements: Labels,
    /// Position in the mesh of each row of `*NODE` lines.
    pub node_rows: Rows,
    /// Position in the mesh of each row of `*ELEMENT` lines.
    pub element_rows: Rows,
    /// Lines of the elements.
    pub element_at: Vec<At>,
}

/// Positions of rows: the same, unless labels are repeated or elements refused.
pub struct Rows(Option<Vec<u32>>);

/// Position of a row that was refused.
const REFUSED: u32 = u32::MAX;

impl Rows {
    /// Position of a row, unless it was refused.
    pub fn position(&self, row: u32) -> Option<u32> {
        match &self.0 {
            None => Some(row),
            Some(positions) => positions.get(row as usize).copied().filter(|&position| position != REFUSED),
        }
    }
}

/// Takes nodes and elements out of the deck.
pub fn build_mesh(deck: &mut Deck, dialect: Dialect, report: &mut Report) -> MeshParts {
    let mut mesh = Mesh::default();
    let node_rows = take_nodes(std::mem::take(&mut deck.nodes), &mut mesh, report);
    let nodes = Labels::of(&mesh.node_labels);
    let (element_rows, element_at) =
        take_elements(std::mem::take(&mut deck.elements), &nodes, deck, dialect, &mut mesh, report);
    let elements = Labels::of(&mesh.element_labels);
    mesh.node_of_label = map_labels(&mesh.node_labels, NodeId);
    mesh.element_of_label = map_labels(&mesh.element_labels, ElementId);
    if !deck.incomplete && !deck.cards.is_empty() {
        if mesh.nodes.is_empty() && deck.refused_nodes.is_empty() {
            report.error(At::DECK, NODE, "the deck has no nodes", "add *NODE with the nodes of the mesh");
        }
        if mesh.elements.is_empty() && deck.refused_elements.is_empty() {
            report.error(
                At::DECK,
                ELEMENT,
                "the deck has no elements",
                "add *ELEMENT, TYPE=C3D8 with the elements of the mesh",
            );
        }
    }
    MeshParts { mesh, nodes, elements, node_rows, element_rows, element_at }
}

fn map_labels<I>(labels: &[u32], id: impl Fn(u32) -> I) -> FxHashMap<u32, I> {
    let mut map = FxHashMap::with_capacity_and_hasher(labels.len(), Default::default());
    map.extend((0..).zip(labels).map(|(position, &label)| (label, id(position))));
    map
}

fn take_nodes(table: NodeTable, mesh: &mut Mesh, report: &mut Report) -> Rows {
    let first = Labels::of(&table.labels);
    let NodeTable { mut labels, mut coordinates, at } = table;
    let mut kept = 0;
    let mut positions = None::<Vec<u32>>;
    for row in 0..labels.len() {
        let earlier = first.get(labels[row]).unwrap_or(row as u32) as usize;
        if earlier == row {
            labels[kept] = labels[row];
            coordinates[kept] = coordinates[row];
            if let Some(positions) = &mut positions {
                positions.push(kept as u32);
            }
            kept += 1;
            continue;
        }
        let positions = positions.get_or_insert_with(|| (0..row as u32).collect());
        let position = positions[earlier];
        positions.push(position);
        if coordinates[position as usize] == coordinates[row] {
            let message = format!("node {} is given twice, with the same coordinates", labels[row]);
            report.warning(at[row], NODE, message, "remove one of the lines");
        } else {
            let [x, y, z] = coordinates[position as usize];
            let message = format!("node {} is given twice, first at ({x}, {y}, {z})", labels[row]);
            report.error(at[row], NODE, message, "give one of the nodes another number, or remove it");
        }
    }
    labels.truncate(kept);
    coordinates.truncate(kept);
    mesh.node_labels = labels;
    mesh.nodes = coordinates;
    Rows(positions)
}

fn take_elements(
    table: ElementTable,
    node_index: &Labels,
    deck: &mut Deck,
    dialect: Dialect,
    mesh: &mut Mesh,
    report: &mut Report,
) -> (Rows, Vec<At>) {
    let first = Labels::of(&table.labels);
    let mut positions = Vec::with_capacity(table.labels.len());
    let mut kept_at = Vec::with_capacity(table.labels.len());
    mesh.elements.reserve_exact(table.labels.len(), table.nodes.len());
    mesh.element_labels.reserve_exact(table.labels.len());
    let mut rest = table.nodes.as_slice();
    for (row, (&label, &written)) in table.labels.iter().zip(&table.kinds).enumerate() {
        let (labels, behind) = rest.split_at(written.node_count());
        rest = behind;
        let at = table.at[row];
        let earlier = first.get(label).unwrap_or(row as u32) as usize;
        if earlier < row {
            report.error(
                at,
                ELEMENT,
                format!("element {label} is given twice"),
                "give one of them another number, or remove it",
            );
            positions.push(positions[earlier]);
            continue;
        }
        let kind = meaning(written, dialect);
        match resolve_nodes(label, kind, labels, at, node_index, deck, mesh, report) {
            Some(nodes) => {
                positions.push(mesh.elements.len() as u32);
                mesh.elements.push(kind, &nodes[..labels.len()]);
                mesh.element_labels.push(label);
                kept_at.push(at);
            }
            None => {
                positions.push(REFUSED);
                deck.refused_elements.insert(label);
            }
        }
    }
    let unchanged = mesh.elements.len() == positions.len();
    (Rows((!unchanged).then_some(positions)), kept_at)
}

/// What a dialect means by an element type.
fn meaning(written: ElementKind, dialect: Dialect) -> ElementKind {
    match (written, dialect) {
        (ElementKind::C3D8, Dialect::Calculix) => ElementKind::C3D8Full,
        (ElementKind::C3D8R, Dialect::Calculix) => ElementKind::C3D8RCalculix,
        (kind, _) => kind,
    }
}

#[expect(clippy::too_many_arguments, reason = "one call, from the loop above")]
fn resolve_nodes(
    label: u32,
    kind: ElementKind,
    labels: &[u32],
    at: At,
    node_index: &Labels,
    deck: &Deck,
    mesh: &Mesh,
    report: &mut Report,
) -> Option<[NodeId; ELEMENT_NODES_MAX]> {
    let mut nodes = [NodeId(0); ELEMENT_NODES_MAX];
    for (node, &wanted) in nodes.iter_mut().zip(labels) {
        match node_index.get(wanted) {
            Some(position) => *node = NodeId(position),
            None => {
                if !deck.incomplete && !deck.refused_nodes.contains(&wanted) {
                    let message = format!("element {label} uses node {wanted}, which is not defined");
                    report.error(at, ELEMENT, message, "define the node, or correct the number");
                }
                return None;
            }
        }
    }
    for i in 1..labels.len() {
        if labels[..i].contains(&labels[i]) {
            let message = format!("element {label} uses node {} twice", labels[i]);
            let remedy = if kind.is_solid() {
                format!("collapsed elements are not solved: give {} different nodes, or use C3D6 or C3D4", labels.len())
            } else {
                "give two different nodes; to the ground leads a SPRING1 or DASHPOT1".into()
            };
            report.error(at, ELEMENT, message, remedy);
            return None;
        }
    }
    let coordinates = Coordinates::of(nodes[..labels.len()].iter().map(|node| mesh.nodes[node.index()]));
    if let Some(fault) = shape_fault(kind, &coordinates) {
        report.error(at, ELEMENT, format!("element {label} {fault}"), order_remedy(kind));
        return None;
    }
    Some(nodes)
}

/// Why an element of this shape has no stiffness.
pub fn shape_fault(kind: ElementKind, coordinates: &Coordinates) -> Option<String> {
    if kind.is_solid() {
        // Positive wherever it is evaluated: coordinates are bounded, so it is never NaN.
        let jacobian = jacobian_min(kind, coordinates);
        return (jacobian <= 0.0)
            .then(|| format!("is inverted or distorted: its Jacobian is {jacobian:.3e} at an integration point"));
    }
    // The line between the nodes gives the direction of these two.
    let has_axis = matches!(kind, ElementKind::T3D2 | ElementKind::SpringA | ElementKind::DashpotA);
    (has_axis && connector::length(coordinates) == 0.0).then(|| "has no length: its nodes are at the same place".into())
}

/// How the nodes of an element are listed.
fn order_remedy(kind: ElementKind) -> &'static str {
    match kind.shape() {
        ElementShape::Hexahedron8 | ElementShape::Wedge6 => {
            "list the bottom face anticlockwise seen from the top face, then the top face; check the coordinates"
        }
        ElementShape::Hexahedron20 | ElementShape::Wedge15 => {
            "list the corners of the bottom face anticlockwise seen from the top face, those of the top face, then the midside nodes of the bottom, the top and the sides; check the coordinates"
        }
        ElementShape::Tetrahedron4 => {
            "list the first three nodes anticlockwise seen from the fourth; check the coordinates"
        }
        ElementShape::Tetrahedron10 => {
            "list the first three corners anticlockwise seen from the fourth, then the midside nodes of 1-2, 2-3, 3-1, 1-4, 2-4, 3-4; check the coordinates"
        }
        ElementShape::Line2 | ElementShape::Point1 => "give the two nodes different coordinates",
        ElementShape::Triangle3 | ElementShape::Quadrilateral4 => {
            "list the corners around the facet; check the coordinates"
        }
    }
}

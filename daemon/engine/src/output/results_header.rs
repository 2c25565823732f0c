//! Head of an ASCII results file: elements, nodes, sets, surfaces, the names of both, active directions, heading.

use std::collections::BTreeMap;

use super::fil_record::{Record, Stream, WORDS_MAX};
use crate::model::{ElementId, Mesh, Model, NodeId, SurfaceKind};

/// Characters of a name that fits into a word.
const NAME_MAX: usize = 8;
/// Degrees of freedom in record 1902.
const DIRECTIONS: u32 = 30;

/// Names as the file has them: those of more than eight characters are numbers, explained by records 1940.
#[derive(Default)]
pub(super) struct Labels {
    numbers: BTreeMap<String, u32>,
}

impl Labels {
    /// Of all sets and surfaces of a model.
    pub(super) fn of(model: &Model) -> Self {
        let mesh = &model.mesh;
        let elements = mesh.element_sets.iter().map(|set| &set.name);
        let nodes = mesh.node_sets.iter().map(|set| &set.name);
        let mut labels = Self::default();
        for name in elements.chain(nodes).chain(mesh.surfaces.iter().map(|surface| &surface.name)) {
            let next = labels.numbers.len() as u32 + 1;
            if name.chars().count() > NAME_MAX {
                labels.numbers.entry(name.to_uppercase()).or_insert(next);
            }
        }
        labels
    }

    /// The word for a name: itself, or its number at the right.
    pub(super) fn word(&self, name: &str) -> String {
        let name = name.to_uppercase();
        match self.numbers.get(&name) {
            Some(number) => format!("{number:>8}"),
            None => name,
        }
    }

    fn records(&self, stream: &mut Stream) {
        let mut ordered: Vec<_> = self.numbers.iter().map(|(name, number)| (*number, name)).collect();
        ordered.sort_unstable();
        for (number, name) in ordered {
            stream.push(&Record::new(1940).whole(number).text(name, 1));
        }
    }
}

/// Appends everything before the first increment.
pub(super) fn header(stream: &mut Stream, model: &Model, labels: &Labels) {
    let mesh = &model.mesh;
    let release = format!("OC{}", env!("CARGO_PKG_VERSION"));
    // Date and time are left blank: equal runs give equal files.
    stream.push(
        &Record::new(1921)
            .word(&release)
            .word("")
            .word("")
            .word("")
            .whole(mesh.elements.len() as u32)
            .whole(mesh.node_count() as u32)
            .reals(&[typical_length(mesh)]),
    );
    for (element, (kind, nodes)) in mesh.elements.iter().enumerate() {
        let label = mesh.element_labels[element];
        let nodes = nodes.iter().map(|node| mesh.node_labels[node.index()]);
        stream.push(&Record::new(1900).whole(label).word(kind.name()).wholes(nodes));
    }
    for (coordinates, &label) in mesh.nodes.iter().zip(&mesh.node_labels).take(mesh.node_count()) {
        stream.push(&Record::new(1901).whole(label).reals(coordinates));
    }
    for set in &mesh.element_sets {
        let members = set.elements.iter().map(|element| mesh.element_labels[element.index()]);
        members_of_set(stream, [1933, 1934], &labels.word(&set.name), members.collect());
    }
    for set in &mesh.node_sets {
        let members = set.nodes.iter().map(|node| mesh.node_labels[node.index()]);
        members_of_set(stream, [1931, 1932], &labels.word(&set.name), members.collect());
    }
    surfaces(stream, model, labels);
    labels.records(stream);
    let active = if mesh.rotations.is_empty() { 3 } else { 6 };
    stream.push(&Record::new(1902).wholes((1..=DIRECTIONS).map(|d| if d <= active { d } else { 0 })));
    let heading: String = model.heading.lines().next().unwrap_or_default().chars().take(WORDS_MAX).collect();
    stream.push(&Record::new(1922).text(&heading, 10));
    stream.end_increment();
}

/// A set over as many records as it needs.
fn members_of_set(stream: &mut Stream, [first, next]: [u32; 2], name: &str, members: Vec<u32>) {
    // Number of words, key and name come before the members.
    let (head, rest) = members.split_at(members.len().min(WORDS_MAX - 3));
    stream.push(&Record::new(first).word(name).wholes(head.iter().copied()));
    for piece in rest.chunks(WORDS_MAX - 2) {
        stream.push(&Record::new(next).wholes(piece.iter().copied()));
    }
}

/// Surfaces with the primary surfaces that they meet; records 1502 hold their faces.
fn surfaces(stream: &mut Stream, model: &Model, labels: &Labels) {
    let mesh = &model.mesh;
    for (position, surface) in mesh.surfaces.iter().enumerate() {
        let faces = match &surface.kind {
            SurfaceKind::Faces(faces) => faces.as_slice(),
            _ => &[],
        };
        let pairs = model.pairs.iter().filter_map(|pair| pair.surfaces());
        let primaries: Vec<&str> = pairs
            .filter(|surfaces| surfaces.secondary.index() == position)
            .map(|surfaces| mesh.surfaces[surfaces.primary.index()].name.as_str())
            .collect();
        let mut record = Record::new(1501).word(&labels.word(&surface.name)).wholes([
            3,
            1,
            faces.len() as u32,
            primaries.len() as u32,
        ]);
        for primary in primaries {
            record = record.word(&labels.word(primary));
        }
        stream.push(&record);
        for &face in faces {
            let nodes = mesh.face_nodes(face);
            let nodes: Vec<u32> = nodes.iter().map(|node| mesh.node_labels[node.index()]).collect();
            let element = mesh.element_labels[face.element.index()];
            // 1 to 6 are S1 to S6 of solids, 7 and 8 the two sides of a facet.
            let first = if mesh.elements.kind(face.element.index()).is_solid() { 1 } else { 7 };
            let head = Record::new(1502).wholes([element, u32::from(face.face) + first, nodes.len() as u32]);
            stream.push(&head.wholes(nodes));
        }
    }
}

/// Mean over the elements of the mean extent of each \[length\]; 0 without elements that have one.
fn typical_length(mesh: &Mesh) -> f64 {
    let extent = |nodes: &[NodeId]| {
        let sides = (0..3).map(|d| {
            let x = || nodes.iter().map(|node| mesh.nodes[node.index()][d]);
            x().fold(f64::NEG_INFINITY, f64::max) - x().fold(f64::INFINITY, f64::min)
        });
        sides.sum::<f64>() / 3.0
    };
    let solids = (0..).map(ElementId).zip(mesh.elements.iter()).filter(|(_, (kind, _))| kind.is_solid());
    let (sum, count) = solids.fold((0.0, 0u32), |(sum, count), (_, (_, nodes))| (sum + extent(nodes), count + 1));
    if count == 0 { 0.0 } else { sum / f64::from(count) }
}

//! Fingerprint of a model: what ties a checkpoint to its deck.

use std::fmt::Write;

use crate::model::Model;

/// FNV-1a, 64 bits.
pub struct Fnv(pub u64);

impl Fnv {
    /// Takes in some bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        for &b in bytes {
            self.0 = (self.0 ^ u64::from(b)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

impl Write for Fnv {
    fn write_str(&mut self, s: &str) -> std::fmt::Result {
        self.bytes(s.as_bytes());
        Ok(())
    }
}

/// Depends on everything that the solution depends on, and on the sets and requests that shape ports and outputs;
/// not on heading, file names, line numbers or snapshots.
pub fn fingerprint(model: &Model) -> u64 {
    let mut hash = Fnv(0xcbf2_9ce4_8422_2325);
    let mesh = &model.mesh;
    for x in mesh.nodes.iter().flatten() {
        hash.bytes(&x.to_bits().to_le_bytes());
    }
    for label in mesh.node_labels.iter().chain(&mesh.element_labels) {
        hash.bytes(&label.to_le_bytes());
    }
    for (kind, nodes) in mesh.elements.iter() {
        hash.bytes(&[kind as u8]);
        for n in nodes {
            hash.bytes(&n.0.to_le_bytes());
        }
    }
    for material in &mesh.element_materials {
        hash.bytes(&material.0.to_le_bytes());
    }
    let mut text = |part: std::fmt::Arguments<'_>| hash.write_fmt(part).expect("hashing never fails");
    text(format_args!("{:?}{:?}{:?}", mesh.node_sets, mesh.element_sets, mesh.surfaces));
    if !mesh.rotations.is_empty() {
        text(format_args!("{:?}{:?}", mesh.rotations, mesh.analytical));
    }
    let mut connectors: Vec<_> = mesh.connectors.iter().collect();
    connectors.sort_by_key(|(element, _)| **element);
    text(format_args!("{connectors:?}"));
    for equation in &model.equations {
        text(format_args!("{:?}", equation.terms));
    }
    text(format_args!("{:?}{:?}{:?}", model.materials, model.interactions, model.amplitudes));
    for pair in &model.pairs {
        text(format_args!("{:?}{:?}{:?}", pair.name, pair.members, pair.interaction));
        if pair.explicit != Default::default() {
            text(format_args!("{:?}", pair.explicit));
        }
    }
    if !model.initial_velocities.is_empty() {
        text(format_args!("{:?}", model.initial_velocities));
    }
    let mut boundary = |b: &crate::model::Boundary| {
        text(format_args!("{:?}{:?}{}{}{:?}", b.region_name, b.nodes, b.direction, b.magnitude.to_bits(), b.amplitude));
        if b.kind != Default::default() {
            text(format_args!("{:?}", b.kind));
        }
    };
    model.initial_boundaries.iter().for_each(&mut boundary);
    for step in &model.steps {
        step.boundaries.iter().for_each(&mut boundary);
    }
    for step in &model.steps {
        text(format_args!("{}{:?}{:?}", step.increments_max, step.procedure, step.loads_removed));
        if step.default_amplitude != Default::default() {
            text(format_args!("{:?}", step.default_amplitude));
        }
        text(format_args!("{:?}", step.contact));
        for l in &step.loads {
            text(format_args!("{:?}{:?}{}{:?}", l.region_name, l.kind, l.magnitude.to_bits(), l.amplitude));
        }
        let requests = &step.output;
        text(format_args!("{:?}{:?}{:?}", requests.nodes, requests.elements, requests.contacts));
    }
    hash.0
}

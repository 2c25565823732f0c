//! What explicit dynamics needs of each element before it is scaled: lumped masses, the fastest frequency, bulk viscosity.

use crate::element::{Elasticity, Stiffness, connector, dilatation, stable};
use crate::model::{Connector, ElementId, MassMatrix, Material, Model};
use crate::solve::assembly::{coordinates, element_stiffness};
use crate::solve::inertia::element_mass;

/// An element with mass and stiffness of its own.
#[derive(Clone, Debug)]
pub struct Part {
    /// Its position.
    pub element: u32,
    /// Mass of each node \[mass\].
    pub masses: Vec<f64>,
    /// Largest `ω²` on them [1/time²]; 0 without stiffness.
    pub frequency_squared: f64,
    /// How it resists changes of volume; none where nothing does.
    pub volume: Option<Volume>,
}

/// Bulk viscosity of an element.
#[derive(Clone, Debug)]
pub struct Volume {
    /// `∂ε̇/∂v` at each node [1/length].
    pub gradient: Vec<[f64; 3]>,
    /// Volume [length³].
    pub volume: f64,
    /// `ρ c L` [pressure·time].
    pub impedance: f64,
    /// `ρ L²` [pressure·time²].
    pub square: f64,
}

/// Material of an element.
pub fn material(model: &Model, element: u32) -> Option<&Material> {
    let material = model.mesh.element_materials.get(element as usize)?;
    model.materials.get(material.index())
}

/// Whether an element has mass of its own that scaling multiplies: solids and bars.
fn is_scalable(model: &Model, element: u32) -> bool {
    let section = model.mesh.connectors.get(&ElementId(element));
    let has_density = material(model, element).is_some_and(|m| m.density.is_some());
    has_density && section.is_none_or(|s| matches!(s, Connector::Bar { .. }))
}

/// Elements whose mass is their own, ascending.
pub fn parts(model: &Model, elasticities: &[Elasticity]) -> Vec<Part> {
    let mut out = Vec::new();
    let (mut mass, mut stiffness) = (Stiffness::default(), Stiffness::default());
    for element in (0..model.mesh.elements.len() as u32).filter(|&e| is_scalable(model, e)) {
        element_mass(model, element, MassMatrix::Lumped, &mut mass);
        element_stiffness(model, elasticities, element, &mut stiffness);
        let count = model.mesh.elements.nodes(element as usize).len();
        let masses: Vec<f64> = (0..count).map(|a| mass.block(a, a)[0]).collect();
        let index = model.mesh.element_materials[element as usize].index();
        let elasticity = elasticities[index];
        let density = model.materials[index].density.unwrap_or(0.0);
        let frequency_squared = if elasticity.is_zero() { 0.0 } else { stable::frequency_squared(&stiffness, &masses) };
        let volume = if elasticity.is_zero() { None } else { Some(volume(model, element, elasticity, density)) };
        out.push(Part { element, masses, frequency_squared, volume });
    }
    out
}

fn volume(model: &Model, element: u32, elasticity: Elasticity, density: f64) -> Volume {
    let mesh = &model.mesh;
    let kind = mesh.elements.kind(element as usize);
    let coordinates = coordinates(mesh, element);
    if let Some(&section @ Connector::Bar { area }) = mesh.connectors.get(&ElementId(element)) {
        let length = connector::length(&coordinates);
        let b = connector::elongation(kind, &coordinates, section);
        let speed = (elasticity.youngs_modulus() / density).sqrt();
        return Volume {
            gradient: b.iter().map(|b| b.map(|x| x / length)).collect(),
            volume: area * length,
            impedance: density * speed * length,
            square: density * length * length,
        };
    }
    let dilatation = dilatation::of(kind, &coordinates);
    let length = dilatation::characteristic_length(kind, &coordinates);
    let speed = ((elasticity.lambda + 2.0 * elasticity.mu) / density).sqrt();
    Volume {
        gradient: dilatation.gradient.to_vec(),
        volume: dilatation.volume,
        impedance: density * speed * length,
        square: density * length * length,
    }
}

impl Part {
    /// Bounds of what damps an element with its mass scaled [1/time]: Rayleigh damping and linear bulk viscosity.
    pub fn damping_rate(&self, model: &Model, linear: f64, scale: f64) -> f64 {
        let rayleigh = material(model, self.element).map(|m| m.damping).unwrap_or_default();
        let bulk = self.volume.as_ref().map_or(0.0, |v| {
            let participation: f64 =
                v.gradient.iter().zip(&self.masses).map(|(g, m)| g.iter().map(|x| x * x).sum::<f64>() / m).sum();
            linear * v.impedance * v.volume * participation / scale.sqrt()
        });
        rayleigh.alpha + rayleigh.beta * self.frequency_squared / scale + bulk
    }

    /// Stable increment of the element by itself with its mass scaled \[time\].
    pub fn increment(&self, model: &Model, linear: f64, scale: f64) -> f64 {
        stable::increment(self.frequency_squared / scale, self.damping_rate(model, linear, scale))
    }
}

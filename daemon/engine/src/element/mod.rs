//! Elements: stiffness, stresses, faces. Pure functions of coordinates; nothing of the model is known here
//! but the kind of an element.

pub mod basis;
pub mod brick;
pub mod connector;
pub mod connector_mass;
#[cfg(test)]
mod convergence_tests;
pub mod dilatation;
#[cfg(test)]
mod dilatation_tests;
mod elasticity;
pub mod face;
mod hexahedron;
mod incompatible;
mod isoparametric;
pub mod mass;
#[cfg(test)]
mod mass_tests;
mod matrix;
pub mod quad;
pub mod stable;
#[cfg(test)]
mod stable_tests;
mod table;
#[cfg(test)]
mod tests;
mod tetrahedron;
mod uniform_strain;
mod wedge;

pub use elasticity::Elasticity;
pub use matrix::{Coordinates, Stiffness};

use crate::model::ElementKind;
use brick::{Corners, Volumetric};

/// Corners of an eight-node kind.
fn corners(coordinates: &[[f64; 3]]) -> &Corners {
    coordinates.try_into().expect("the element table gives an element as many nodes as its kind has")
}

/// Stiffness of an element, into `out`; zero for solids of a rigid body, whose material has none.
pub fn stiffness(kind: ElementKind, coordinates: &[[f64; 3]], elasticity: Elasticity, out: &mut Stiffness) {
    if elasticity.is_zero() {
        out.clear(kind.node_count());
        return;
    }
    let brick = |volumetric| brick::stiffness(volumetric, corners(coordinates), elasticity);
    match kind {
        ElementKind::C3D8 => out.set(8, &brick(Volumetric::Mean)),
        ElementKind::C3D8Full => out.set(8, &brick(Volumetric::Local)),
        ElementKind::C3D8I => incompatible::stiffness(corners(coordinates), elasticity, out),
        ElementKind::C3D8R => {
            let resistance = uniform_strain::HOURGLASS * elasticity.mu;
            uniform_strain::stiffness(corners(coordinates), elasticity, resistance, out);
        }
        ElementKind::C3D8RCalculix => {
            let resistance = uniform_strain::HOURGLASS_CALCULIX * elasticity.youngs_modulus();
            uniform_strain::stiffness(corners(coordinates), elasticity, resistance, out);
        }
        _ => isoparametric::stiffness(table::of(kind), coordinates, elasticity, out),
    }
}

/// Stress (11, 22, 33, 12, 13, 23) at the integration points under nodal displacements [pressure].
pub fn stress(kind: ElementKind, coordinates: &[[f64; 3]], elasticity: Elasticity, u: &[[f64; 3]]) -> Vec<[f64; 6]> {
    if let (ElementKind::C3D8I, true) = (kind, elasticity.is_zero()) {
        // The modes follow from equilibrium, which needs a stiffness.
        return vec![[0.0; 6]; 8];
    }
    let brick = |volumetric| brick::stress(volumetric, corners(coordinates), elasticity, corners(u));
    match kind {
        ElementKind::C3D8 => brick(Volumetric::Mean).to_vec(),
        ElementKind::C3D8Full => brick(Volumetric::Local).to_vec(),
        ElementKind::C3D8I => incompatible::stress(corners(coordinates), elasticity, u).to_vec(),
        ElementKind::C3D8R | ElementKind::C3D8RCalculix => {
            vec![uniform_strain::stress(corners(coordinates), elasticity, u)]
        }
        _ => isoparametric::stress(table::of(kind), coordinates, elasticity, u),
    }
}

/// Values at the integration points carried out to the nodes: exactly for trilinear fields through 2 x 2 x 2 points, else by
/// the least-squares polynomial that the kind can represent.
pub fn extrapolate(kind: ElementKind, values: &[[f64; 6]]) -> Vec<[f64; 6]> {
    let brick = matches!(kind, ElementKind::C3D8 | ElementKind::C3D8Full | ElementKind::C3D8I);
    if let (true, Ok(values)) = (brick, values.try_into()) {
        return brick::extrapolate(values).to_vec();
    }
    let at = |row: &Vec<f64>| std::array::from_fn(|c| row.iter().zip(values).map(|(e, v)| e * v[c]).sum());
    table::of(kind).extrapolation.iter().map(at).collect()
}

/// Volume that each node stands for: ∫ N_a dV [length³]. Negative at the corners of quadratic tetrahedra and bricks.
pub fn nodal_volumes(kind: ElementKind, coordinates: &[[f64; 3]]) -> Vec<f64> {
    match kind {
        ElementKind::C3D8
        | ElementKind::C3D8Full
        | ElementKind::C3D8I
        | ElementKind::C3D8R
        | ElementKind::C3D8RCalculix => brick::nodal_volumes(corners(coordinates)).to_vec(),
        _ => isoparametric::nodal_volumes(table::of(kind), coordinates),
    }
}

/// Smallest det J over the integration points [length³]. Positive for a usable element.
pub fn jacobian_min(kind: ElementKind, coordinates: &[[f64; 3]]) -> f64 {
    match kind {
        ElementKind::C3D8 | ElementKind::C3D8Full | ElementKind::C3D8R | ElementKind::C3D8RCalculix => {
            brick::jacobian_min(corners(coordinates))
        }
        // The incompatible modes use the Jacobian of the centre too.
        ElementKind::C3D8I => {
            let corners = corners(coordinates);
            brick::jacobian_min(corners).min(brick::point(corners, [0.0; 3]).volume)
        }
        _ => isoparametric::jacobian_min(table::of(kind), coordinates),
    }
}

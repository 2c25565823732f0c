//! Mass and damping of whole models.

use super::assembly::{elasticities, element_stiffness};
use super::inertia::{element_damping, element_mass, lumps};
use crate::element::Stiffness;
use crate::model::{
    Connector, ElementId, ElementKind, MassMatrix, Material, MaterialId, Mesh, Model, NodeId, Rayleigh,
};
use crate::test_mesh::TestMesh;

/// A distorted element of a kind, its material with density and damping.
fn solid(kind: ElementKind) -> Model {
    let place = |x: [f64; 3]| [x[0] + 0.1 * x[1] * x[2], x[1] - 0.1 * x[0], x[2] + 0.05 * x[0] * x[1]];
    let part = TestMesh::new(kind.shape(), [1, 1, 1], place);
    let mut mesh = Mesh { nodes: part.nodes, ..Mesh::default() };
    for nodes in &part.elements {
        mesh.elements.push(kind, &nodes.iter().map(|&n| NodeId(n as u32)).collect::<Vec<_>>());
        mesh.element_materials.push(MaterialId(0));
    }
    let material = Material {
        name: "M".into(),
        youngs_modulus: 210.0,
        poissons_ratio: 0.3,
        density: Some(2.0),
        damping: Rayleigh { alpha: 0.25, beta: 0.5 },
    };
    Model { mesh, materials: vec![material], ..Model::default() }
}

/// A connector between two nodes, or at one.
fn connector(kind: ElementKind, section: Connector) -> Model {
    let mut model = solid(ElementKind::C3D8);
    let nodes = [NodeId(0), NodeId(7)];
    let id = ElementId(model.mesh.elements.len() as u32);
    model.mesh.elements.push(kind, &nodes[..kind.node_count()]);
    let bar = matches!(section, Connector::Bar { .. });
    model.mesh.element_materials.push(if bar { MaterialId(0) } else { MaterialId::NONE });
    model.mesh.connectors.insert(id, section);
    model
}

fn total(m: &Stiffness) -> f64 {
    m.force(&vec![[1.0, 0.0, 0.0]; m.count()]).iter().map(|f| f[0]).sum()
}

#[test]
fn every_form_has_the_mass_of_the_element_and_lumped_ones_couple_no_nodes() {
    for kind in ElementKind::SOLIDS {
        let model = solid(kind);
        let mut m = Stiffness::default();
        for e in 0..model.mesh.elements.len() as u32 {
            let all = [MassMatrix::ByOrder, MassMatrix::Lumped, MassMatrix::Consistent].map(|matrix| {
                element_mass(&model, e, matrix, &mut m);
                let coupled = (1..m.count()).any(|b| m.block(0, b)[0] != 0.0);
                assert_eq!(coupled, !lumps(kind, matrix), "{kind:?} {matrix:?}");
                total(&m)
            });
            assert!(all[0] > 0.0 && all.iter().all(|x| (x - all[0]).abs() < 1e-13), "{kind:?}: {all:?}");
        }
        assert_eq!(lumps(kind, MassMatrix::ByOrder), kind.node_count() <= 8, "{kind:?}");
    }
}

#[test]
fn damping_is_alpha_times_mass_and_beta_times_stiffness() {
    let bar = connector(ElementKind::T3D2, Connector::Bar { area: 0.5 });
    for (model, e) in [(solid(ElementKind::C3D10), 3), (solid(ElementKind::C3D8), 0), (bar, 1)] {
        let constants = elasticities(&model);
        for matrix in [MassMatrix::Lumped, MassMatrix::Consistent] {
            let [mut k, mut m, mut c] = [Stiffness::default(), Stiffness::default(), Stiffness::default()];
            element_stiffness(&model, &constants, e, &mut k);
            element_mass(&model, e, matrix, &mut m);
            element_damping(&model, &constants, e, matrix, &mut c);
            for a in 0..k.count() {
                for b in a..k.count() {
                    for i in 0..9 {
                        let wanted = 0.25 * m.block(a, b)[i] + 0.5 * k.block(a, b)[i];
                        assert!((c.block(a, b)[i] - wanted).abs() < 1e-12);
                    }
                }
            }
        }
    }
}

#[test]
fn what_has_no_mass_or_no_damping_gives_zeros() {
    let mut without = solid(ElementKind::C3D8);
    without.materials[0].density = None;
    without.materials[0].damping = Rayleigh::default();
    let spring = connector(ElementKind::SpringA, Connector::Spring { stiffness: 3.0, directions: [0, 0] });
    let dashpot = connector(ElementKind::Dashpot2, Connector::Dashpot { coefficient: 3.0, directions: [1, 1] });
    let inert = connector(ElementKind::GapUni, Connector::Inert);
    let point = connector(ElementKind::Mass, Connector::Mass { mass: 4.0, alpha: 0.5 });
    let cases = [
        (&without, 0, 0.0, 0.0),
        (&spring, 1, 0.0, 0.0),
        (&dashpot, 1, 0.0, 3.0),
        (&inert, 1, 0.0, 0.0),
        (&point, 1, 4.0, 2.0),
    ];
    for (model, e, mass, damping) in cases {
        let mut out = Stiffness::default();
        element_mass(model, e, MassMatrix::ByOrder, &mut out);
        assert_eq!(out.block(0, 0)[4], mass);
        element_damping(model, &elasticities(model), e, MassMatrix::ByOrder, &mut out);
        assert_eq!(out.block(0, 0)[4], damping);
    }
}

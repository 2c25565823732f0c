//! Patches of every kind through the solver: a uniform strain prescribed around a distorted mesh is found inside it.

use std::sync::Arc;

use crate::diagnostic::Place;
use crate::element::Elasticity;
use crate::model::*;
use crate::simulation::*;
use crate::test_mesh::TestMesh;

const GRADIENT: [[f64; 3]; 3] = [[1e-3, 2e-4, 0.0], [1e-4, -5e-4, 3e-4], [0.0, -2e-4, 7e-4]];

fn displacement(x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|j| GRADIENT[i][j] * x[j]).sum())
}

/// The unit cube of 2 x 2 x 2 cells with its inner corner moved and its boundary uneven.
fn patch(kind: ElementKind) -> Model {
    let place = |[x, y, z]: [f64; 3]| {
        let (a, b) = ((7.0 * x + 3.0 * y + 5.0 * z).sin(), (2.0 * x - 5.0 * y + 3.0 * z).cos());
        [x + 0.08 * a * y, y + 0.08 * b * z, z + 0.08 * a * b * x]
    };
    let shape = TestMesh::new(kind.shape(), [2; 3], place);
    let flat = TestMesh::new(kind.shape(), [2; 3], |x| x);
    let mut mesh = Mesh { nodes: shape.nodes.clone(), ..Mesh::default() };
    mesh.node_labels = (1..=mesh.nodes.len() as u32).collect();
    for nodes in &shape.elements {
        mesh.elements.push(kind, &nodes.iter().map(|&n| NodeId(n as u32)).collect::<Vec<_>>());
    }
    mesh.element_labels = (1..=mesh.elements.len() as u32).collect();
    mesh.element_materials = vec![MaterialId(0); mesh.elements.len()];
    let mut boundaries = Vec::new();
    for (n, x) in flat.nodes.iter().enumerate() {
        if x.iter().all(|&c| c > 1e-9 && c < 1.0 - 1e-9) {
            continue;
        }
        for (direction, magnitude) in displacement(shape.nodes[n]).into_iter().enumerate() {
            boundaries.push(Boundary {
                kind: Default::default(),
                region: Region::Label(n as u32 + 1),
                region_name: (n + 1).to_string(),
                nodes: vec![NodeId(n as u32)],
                direction: direction as u8,
                magnitude,
                amplitude: None,
                place: Place::nowhere(),
            });
        }
    }
    Model {
        mesh,
        materials: vec![Material {
            name: "M".into(),
            youngs_modulus: 210.0,
            poissons_ratio: 0.3,
            density: None,
            damping: Default::default(),
        }],
        steps: vec![Step {
            name: "Step-1".into(),
            increments_max: 1,
            default_amplitude: Default::default(),
            procedure: Procedure::Static(StaticControl {
                increment_initial: 1.0,
                period: 1.0,
                increment_min: 1e-5,
                increment_max: 1.0,
                direct: true,
            }),
            boundaries,
            loads: vec![],
            loads_removed: LoadsRemoved::default(),
            contact: StepContact::default(),
            output: OutputRequests::default(),
            place: Place::nowhere(),
        }],
        ..Model::default()
    }
}

#[test]
fn a_distorted_patch_finds_the_uniform_stress() {
    let expected = Elasticity::new(210.0, 0.3).stress(&GRADIENT);
    for kind in ElementKind::SOLIDS {
        let model = patch(kind);
        let nodes = model.mesh.nodes.clone();
        let prepared = match PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {}) {
            Ok(prepared) => prepared,
            Err(errors) => panic!("{kind:?}: {}", errors[0]),
        };
        let mut s = Simulation::new(Arc::new(prepared));
        assert_eq!(s.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
        let solution = s.recover();
        for (u, x) in solution.displacement.iter().zip(nodes) {
            for (found, wanted) in u.iter().zip(displacement(x)) {
                assert!((found - wanted).abs() < 1e-14, "{kind:?}: {found} {wanted}");
            }
        }
        for stress in s.nodal_stress(&solution) {
            for (found, wanted) in stress.iter().zip(expected) {
                assert!((found - wanted).abs() < 1e-10, "{kind:?}: {found} {wanted}");
            }
        }
        let total: [f64; 3] = std::array::from_fn(|d| solution.reaction.iter().map(|r| r[d]).sum());
        assert!(total.iter().all(|f| f.abs() < 1e-12), "{kind:?}: {total:?}");
        assert_eq!(s.audit(), Vec::<String>::new());
    }
}

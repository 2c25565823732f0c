//! A column on a rigid wall, built in code: the engine against closed forms, and the promises about bits.

use std::sync::Arc;

use crate::diagnostic::Place;
use crate::law::{Exponential, Linear, NormalBehavior, PressureOverclosure, Tabular};
use crate::model::*;
use crate::simulation::*;

/// Column of length 1, area 2 and EA/L = 1000 over a wall whose every direction is prescribed; its top goes down by
/// `travel` over a step of 20 fixed increments.
fn column(normal: NormalBehavior, travel: f64) -> Model {
    let mut mesh = Mesh::default();
    for (z, side) in [(-1.0, 3.0), (0.0, 3.0), (0.0, 1.0), (1.0, 1.0)] {
        let (x, y) = (2.0 * side, side);
        let shift = 0.5 * (3.0 - side);
        for [a, b] in [[0.0, 0.0], [x, 0.0], [x, y], [0.0, y]] {
            mesh.nodes.push([a + shift, b + shift, z]);
        }
    }
    mesh.node_labels = (1..=16).collect();
    for first in [0u32, 8] {
        let nodes: [NodeId; 8] = std::array::from_fn(|i| NodeId(first + i as u32));
        mesh.elements.push(ElementKind::C3D8, &nodes);
    }
    mesh.element_labels = vec![1, 2];
    mesh.element_materials = vec![MaterialId(0); 2];
    mesh.node_sets = vec![NodeSet { name: "TOP".into(), nodes: (12..16).map(NodeId).collect() }];
    mesh.element_sets = vec![ElementSet { name: "COLUMN".into(), elements: vec![ElementId(1)] }];
    let face = |element, face| Surface {
        name: format!("S{face}"),
        kind: SurfaceKind::Faces(vec![ElementFace { element: ElementId(element), face }]),
    };
    mesh.surfaces = vec![face(1, 0), face(0, 1)];
    let boundary = |nodes: std::ops::Range<u32>, direction, magnitude| Boundary {
        kind: Default::default(),
        region: Region::Set(SetId(0)),
        region_name: "TOP".into(),
        nodes: nodes.map(NodeId).collect(),
        direction,
        magnitude,
        amplitude: None,
        place: Place::nowhere(),
    };
    let mut initial: Vec<Boundary> = (0..3).map(|d| boundary(0..8, d, 0.0)).collect();
    initial.extend((0..2).map(|d| boundary(12..16, d, 0.0)));
    Model {
        mesh,
        materials: vec![Material {
            name: "M".into(),
            youngs_modulus: 500.0,
            poissons_ratio: 0.0,
            density: None,
            damping: Default::default(),
        }],
        interactions: vec![SurfaceInteraction::new("I", normal)],
        pairs: vec![ContactPair {
            explicit: Default::default(),
            name: "S_P".into(),
            members: PairMembers::Surfaces(SurfacePair {
                secondary: SurfaceId(0),
                primary: SurfaceId(1),
                extension_zone: 0.1,
                hcrit: None,
                adjust: None,
                clearances: Vec::new(),
            }),
            interaction: InteractionId(0),
            place: Place::nowhere(),
        }],
        initial_boundaries: initial,
        steps: vec![Step {
            name: "Step-1".into(),
            increments_max: 100,
            default_amplitude: Default::default(),
            procedure: Procedure::Static(StaticControl {
                increment_initial: 0.05,
                period: 1.0,
                increment_min: 1e-5,
                increment_max: 1.0,
                direct: true,
            }),
            boundaries: vec![boundary(12..16, 2, -travel)],
            loads: vec![],
            loads_removed: LoadsRemoved::default(),
            contact: StepContact::default(),
            output: OutputRequests {
                nodes: vec![NodeRequest {
                    target: OutputTarget::Print,
                    set: Some(SetId(0)),
                    variables: vec!["RF".into()],
                    frequency: OutputFrequency::EVERY,
                    totals: Totals::Only,
                    summary: true,
                }],
                ..OutputRequests::default()
            },
            place: Place::nowhere(),
        }],
        ..Model::default()
    }
}

fn simulation(normal: NormalBehavior, travel: f64) -> Simulation {
    let prepared = PreparedModel::prepare(column(normal, travel), &PrepareOptions::default(), &mut |_| {});
    Simulation::new(Arc::new(prepared.expect("a held model")))
}

fn exponential() -> NormalBehavior {
    NormalBehavior::Softened(PressureOverclosure::Exponential(Exponential::new(0.01, 5.0).expect("valid")))
}

fn output(simulation: &Simulation, name: &str) -> f64 {
    let ports = simulation.prepared().ports();
    let mut values = vec![0.0; ports.outputs.len()];
    simulation.observe(&mut values);
    values[ports.output(name).expect("a port of this deck")]
}

/// B02: K (u − h) = A p(h), roots to 40 digits.
#[test]
fn a_column_pressed_on_a_wall_meets_the_closed_form_of_each_law() {
    let linear = NormalBehavior::Softened(PressureOverclosure::Linear(Linear::new(250.0).expect("valid")));
    let table = Tabular::new(&[(0.0, 0.0), (2.0, 0.01), (10.0, 0.02), (40.0, 0.03)]).expect("valid");
    let tabular = NormalBehavior::Softened(PressureOverclosure::Tabular(table));
    let cases = [
        (NormalBehavior::Hard, 0.0, 80.0),
        (linear, 0.053_333_333_333_333_33, 26.666_666_666_666_668),
        (tabular, 0.025_714_285_714_285_714, 54.285_714_285_714_285),
        (exponential(), 0.009_665_076_488_349_727, 70.334_923_511_650_27),
    ];
    for (normal, overclosure, force) in cases {
        let mut s = simulation(normal.clone(), 0.08);
        assert_eq!(s.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
        for point in s.contact_results() {
            assert!((point.clearance + overclosure).abs() <= 1e-10 * overclosure, "{normal:?}: {point:?}");
            assert!((point.pressure - force / 2.0).abs() <= 1e-10 * force, "{normal:?}: {point:?}");
        }
        assert!((output(&s, "contact.S_P.CFN3") - force).abs() < 1e-10 * force);
        assert!((output(&s, "node.TOP.RF3") + force).abs() < 1e-10 * force);
        assert!((output(&s, "node.TOP.U3") + 0.08).abs() < 1e-15);
        assert_eq!(s.audit(), Vec::<String>::new());
        let counts = &s.step_reports()[0].counts;
        assert_eq!((counts.increments, counts.cutbacks, counts.factorizations), (20, 0, 1), "{normal:?}");
    }
}

#[test]
fn recovered_fields_agree_with_the_condensed_results() {
    let mut s = simulation(exponential(), 0.08);
    assert_eq!(s.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
    let fields = s.recover();
    let total: f64 = (12..16).map(|n| fields.reaction[n][2]).sum();
    assert!((total - output(&s, "node.TOP.RF3")).abs() < 1e-11);
    let all: f64 = fields.reaction.iter().map(|r| r[2]).sum();
    assert!(all.abs() < 1e-11, "reactions balance: {all}");
    let overclosure = 0.009_665_076_488_349_727;
    for n in 8..12 {
        assert!((fields.displacement[n][2] + overclosure).abs() < 1e-12);
    }
    for stress in s.nodal_stress(&fields).iter().skip(8) {
        assert!((stress[2] + 70.334_923_511_650_27 / 2.0).abs() < 1e-9);
    }
    let e = s.history().energies;
    assert!((e.strain - 0.5 * 1000.0 * (0.08 - overclosure).powi(2)).abs() < 1e-10);
}

#[test]
fn energy_is_balanced_to_the_order_of_the_trapezoidal_rule() {
    let drift = |increments: f64| {
        // Starts beyond the reach of the law: with pressure at the start there would be no path from rest.
        let mut model = column(exponential(), 0.1);
        for node in &mut model.mesh.nodes[8..] {
            node[2] += 0.02;
        }
        let Procedure::Static(control) = &mut model.steps[0].procedure else { panic!("a static step") };
        control.increment_initial = 1.0 / increments;
        model.steps[0].increments_max = 10_000;
        let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {}).expect("held");
        let mut s = Simulation::new(Arc::new(prepared));
        assert_eq!(s.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
        s.history().energies.total.abs()
    };
    let (coarse, fine) = (drift(50.0), drift(100.0));
    assert!((coarse / fine - 4.0).abs() < 0.4, "{coarse} {fine}");
}

#[test]
fn a_restored_run_continues_with_the_same_bits() {
    let mut whole = simulation(exponential(), 0.08);
    assert_eq!(whole.advance(0.4, &mut ()), Ok(AdvanceOutcome::Reached));
    let bytes = whole.checkpoint();
    assert_eq!(whole.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
    let mut restored = Simulation::new(whole.prepared().clone());
    restored.restore(&bytes).expect("own checkpoint");
    assert_eq!(restored.time(), 0.4);
    assert_eq!(restored.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
    assert_eq!(whole.checkpoint(), restored.checkpoint());
    assert_eq!(whole.contact_results(), restored.contact_results());
}

#[test]
fn a_driven_input_with_the_values_of_the_deck_gives_the_bits_of_the_deck() {
    let mut by_deck = simulation(exponential(), 0.08);
    let mut driven = simulation(exponential(), 0.08);
    for k in 1..=20 {
        let time = f64::from(k) * 0.05;
        assert_eq!(by_deck.advance(time, &mut ()), Ok(AdvanceOutcome::Reached));
        driven.set(0, by_deck.input(0).expect("one input")).expect("finite");
        assert_eq!(driven.advance(time, &mut ()), Ok(AdvanceOutcome::Reached));
        assert_eq!(by_deck.contact_results(), driven.contact_results());
    }
    assert_eq!(by_deck.history(), driven.history());
}

/// Times are asked for as sums, as FMI masters do, or all at once; the increments must not notice.
#[test]
fn increments_have_the_same_bits_whoever_asks_for_them() {
    for direct in [true, false] {
        let build = || {
            let mut model = column(exponential(), 0.08);
            let Procedure::Static(control) = &mut model.steps[0].procedure else { panic!("a static step") };
            *control = StaticControl { increment_max: 0.05, direct, ..*control };
            let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {}).expect("held");
            Simulation::new(Arc::new(prepared))
        };
        let (mut at_once, mut by_sums) = (build(), build());
        let mut time = 0.0;
        for k in 1..=20 {
            time += 0.05;
            assert_eq!(by_sums.advance(time, &mut ()), Ok(AdvanceOutcome::Reached));
            assert_eq!(by_sums.step_reports()[0].counts.increments, k, "direct {direct}");
        }
        assert_eq!(at_once.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
        assert_eq!(at_once.checkpoint(), by_sums.checkpoint(), "direct {direct}");
    }
}

#[test]
fn automatic_increments_grow_up_to_the_largest() {
    let mut model = column(exponential(), 0.08);
    let Procedure::Static(control) = &mut model.steps[0].procedure else { panic!("a static step") };
    *control = StaticControl { increment_initial: 0.01, increment_max: 0.2, direct: false, ..*control };
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {}).expect("held");
    let mut s = Simulation::new(Arc::new(prepared));
    assert_eq!(s.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
    let increments = s.step_reports()[0].counts.increments;
    assert!((8..=30).contains(&increments), "{increments}");
    assert_eq!(s.time(), 1.0);
}

#[test]
fn a_replaced_magnitude_keeps_the_ramp() {
    let mut s = simulation(NormalBehavior::Hard, 0.08);
    s.set_magnitude(0, -0.04).expect("finite");
    assert_eq!(s.advance(0.5, &mut ()), Ok(AdvanceOutcome::Reached));
    assert!((output(&s, "contact.S_P.CFN3") - 20.0).abs() < 1e-9);
}

/// Pressed and lifted off again: what is left of the reactions is rounding, and no finding.
#[test]
fn an_open_unloaded_column_passes_the_audit() {
    let mut model = column(exponential(), 0.08);
    let mut lift = model.steps[0].clone();
    lift.boundaries[0].magnitude = 0.05;
    model.steps.push(lift);
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {}).expect("held");
    let mut s = Simulation::new(Arc::new(prepared));
    assert_eq!(s.advance(2.0, &mut ()), Ok(AdvanceOutcome::Reached));
    assert!(s.contact_results().iter().all(|p| p.status == ContactStatus::Open && p.pressure == 0.0));
    assert_eq!(s.audit(), Vec::<String>::new());
    assert_eq!(s.step_reports().len(), 2);
}

#[test]
fn before_the_first_increment_an_overlap_carries_nothing() {
    let mut model = column(exponential(), 0.0);
    for node in &mut model.mesh.nodes[8..] {
        node[2] -= 0.005;
    }
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {}).expect("held");
    let mut s = Simulation::new(Arc::new(prepared));
    assert_eq!(s.history().energies, Energies::default());
    assert!(s.contact_results().iter().all(|p| p.pressure == 0.0 && (p.clearance + 0.005).abs() < 1e-15));
    assert_eq!(s.advance(0.05, &mut ()), Ok(AdvanceOutcome::Reached));
    assert!(s.contact_results().iter().all(|p| p.status == ContactStatus::Closed && p.pressure > 0.0));
    assert!(s.history().energies.contact > 0.0);
}

#[test]
fn an_input_beyond_all_measure_stops_and_leaves_the_state_usable() {
    let mut s = simulation(exponential(), 0.08);
    for huge in [1e160, -1e200, 1e300] {
        s.set(0, huge).expect("finite");
        let stopped = s.advance(0.05, &mut ()).expect("a legal target");
        assert!(matches!(&stopped, AdvanceOutcome::Stopped { .. }), "{huge:e}: {stopped:?}");
        let before = s.history().energies;
        assert!(before.total.is_finite() && before.external_work.is_finite());
    }
    s.set(0, -0.01).expect("finite");
    assert_eq!(s.advance(0.05, &mut ()), Ok(AdvanceOutcome::Reached));
    assert!(s.history().energies.total.is_finite());
}

#[test]
fn nonsense_from_outside_is_refused() {
    let mut s = simulation(NormalBehavior::Hard, 0.08);
    assert!(matches!(s.set(0, f64::NAN), Err(SetError::NotFinite { .. })));
    assert_eq!(s.set(3, 1.0), Err(SetError::UnknownInput { index: 3, count: 1 }));
    assert!(matches!(s.advance(f64::INFINITY, &mut ()), Err(AdvanceError::NotFinite { .. })));
    assert_eq!(s.advance(0.5, &mut ()), Ok(AdvanceOutcome::Reached));
    assert_eq!(s.advance(0.4, &mut ()), Err(AdvanceError::Past { now: 0.5, target: 0.4 }));
    assert!(s.field("XYZ").is_err());
}

/// The column without its support in direction 3, its top loaded by forces instead.
fn loose_column(normal: NormalBehavior, force: f64) -> Model {
    let mut model = column(normal, 0.0);
    model.steps[0].boundaries.clear();
    model.steps[0].loads = vec![Load {
        region: Region::Set(SetId(0)),
        region_name: "TOP".into(),
        kind: LoadKind::Concentrated { nodes: (12..16).map(NodeId).collect(), direction: 2 },
        magnitude: force / 4.0,
        amplitude: None,
        place: Place::nowhere(),
    }];
    model
}

/// B01: p = F / A inverted on each law; A = 2.
#[test]
fn a_column_that_only_contact_holds_meets_the_closed_form_of_each_law() {
    let linear = NormalBehavior::Softened(PressureOverclosure::Linear(Linear::new(250.0).expect("valid")));
    let table = Tabular::new(&[(0.0, 0.0), (2.0, 0.01), (10.0, 0.02), (40.0, 0.03)]).expect("valid");
    let tabular = NormalBehavior::Softened(PressureOverclosure::Tabular(table));
    let cases = [
        (NormalBehavior::Hard, 0.0),
        (linear, 0.06),
        (tabular, 0.021_666_666_666_666_667),
        (exponential(), 0.004_933_325_857_292_93),
    ];
    for (normal, overclosure) in cases {
        let model = loose_column(normal.clone(), -30.0);
        let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {}).expect("pressed");
        let mut s = Simulation::new(Arc::new(prepared));
        assert_eq!(s.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
        for point in s.contact_results() {
            assert!((point.pressure - 15.0).abs() <= 1e-10 * 15.0, "{normal:?}: {point:?}");
            assert!((point.clearance + overclosure).abs() <= 1e-12, "{normal:?}: {point:?}");
        }
        // The top has gone down by the overclosure and F L / (E A).
        let down = -(overclosure + 30.0 / 1000.0);
        assert!((output(&s, "node.TOP.U3") - down).abs() <= 1e-12, "{normal:?}");
        assert!((s.recover().displacement[12][2] - down).abs() <= 1e-12, "{normal:?}");
        assert_eq!(s.audit(), Vec::<String>::new());
    }
}

#[test]
fn a_body_pulled_off_its_contact_is_stopped_by_name_and_motion() {
    let prepared = PreparedModel::prepare(loose_column(exponential(), 5.0), &PrepareOptions::default(), &mut |_| {})
        .expect("loose");
    let mut s = Simulation::new(Arc::new(prepared));
    let Ok(AdvanceOutcome::Stopped { reason }) = s.advance(1.0, &mut ()) else { panic!("accepted") };
    assert!(reason.contains("COLUMN") && reason.contains("translation along 3"), "{reason}");
}

#[test]
fn a_loaded_body_that_nothing_touches_is_refused_and_an_unloaded_one_warned_of() {
    let mut model = loose_column(NormalBehavior::Hard, -5.0);
    model.pairs.clear();
    let Err(errors) = PreparedModel::prepare(model.clone(), &PrepareOptions::default(), &mut |_| {}) else {
        panic!("accepted")
    };
    let text = errors[0].to_string();
    assert!(text.contains("COLUMN") && text.contains("translation along 3"), "{text}");
    model.steps[0].loads.clear();
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {}).expect("unloaded");
    let text = prepared.warnings()[0].to_string();
    assert!(text.contains("COLUMN") && text.contains("stays where it is"), "{text}");
}

#[test]
fn threads_do_not_change_the_bits() {
    let run = |threads| {
        let options = PrepareOptions { threads, ..PrepareOptions::default() };
        let prepared = PreparedModel::prepare(column(exponential(), 0.08), &options, &mut |_| {}).expect("held");
        let mut s = Simulation::new(Arc::new(prepared));
        assert_eq!(s.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
        s.checkpoint()
    };
    assert_eq!(run(1), run(2));
}

/// A cantilevered start far outside the law's range must come back by the line search alone.
#[test]
fn a_deep_first_increment_on_a_steep_law_converges() {
    let steep = Exponential::new(1e-6, 1e-3).expect("valid");
    let mut s = simulation(NormalBehavior::Softened(PressureOverclosure::Exponential(steep)), 0.08);
    assert_eq!(s.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached));
    let point = s.contact_results()[0];
    assert!((2.0 * point.pressure - 1000.0 * (0.08 + point.clearance)).abs() < 1e-8);
    assert!(s.step_reports()[0].counts.cutbacks == 0);
}

/// The same equations solved in two ways: held and loose columns, every law, increments that close and stay closed.
#[test]
fn both_paths_agree() {
    let laws = [
        NormalBehavior::Hard,
        NormalBehavior::Softened(PressureOverclosure::Linear(Linear::new(250.0).expect("valid"))),
        exponential(),
    ];
    for normal in laws {
        for model in [column(normal.clone(), 0.08), loose_column(normal.clone(), -30.0)] {
            let run = |path| {
                let options = PrepareOptions { path, ..PrepareOptions::default() };
                let prepared = PreparedModel::prepare(model.clone(), &options, &mut |_| {}).expect("solvable");
                let mut s = Simulation::new(Arc::new(prepared));
                assert_eq!(s.advance(1.0, &mut ()), Ok(AdvanceOutcome::Reached), "{path:?} {normal:?}");
                let mut values = vec![0.0; s.prepared().ports().outputs.len()];
                s.observe(&mut values);
                (values, s.recover().displacement.into_flattened())
            };
            let (dense, sparse) = (run(PathChoice::Dense), run(PathChoice::Sparse));
            let close = |a: f64, b: f64| (a - b).abs() <= 1e-10 * a.abs().max(1.0);
            for (i, (a, b)) in dense.0.iter().zip(&sparse.0).enumerate() {
                let work_count = a.fract() == 0.0 && b.fract() == 0.0;
                assert!(close(*a, *b) || work_count, "{normal:?} output {i}: {a} {b}");
            }
            for (a, b) in dense.1.iter().zip(&sparse.1) {
                assert!((a - b).abs() <= 1e-12, "{normal:?}: {a} {b}");
            }
        }
    }
}

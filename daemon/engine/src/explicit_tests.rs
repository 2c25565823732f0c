//! Explicit steps, from decks: against increments worked out by hand, and balances that hold to rounding.

use std::fmt::Write;
use std::sync::Arc;

use crate::deck::read_text;
use crate::model::Dialect;
use crate::simulation::*;

const UNDAMPED: &str = "*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT\n0.\n";

/// A block of bricks, `x` along every edge of its face, that lies on `z`; labels from `first` on. Returns nodes and elements.
fn block(first: usize, cells: [usize; 3], corner: [f64; 3], edge: f64, set: &str) -> String {
    let [p, q, r] = cells;
    let label = |i: usize, j: usize, k: usize| first + (k * (q + 1) + j) * (p + 1) + i;
    let mut out = format!("*NODE, NSET=N{set}\n");
    for (k, j, i) in (0..=r).flat_map(|k| (0..=q).flat_map(move |j| (0..=p).map(move |i| (k, j, i)))) {
        let [x, y, z] = [i, j, k].map(|n| edge * n as f64);
        let _ = writeln!(out, "{}, {}, {}, {}", label(i, j, k), corner[0] + x, corner[1] + y, corner[2] + z);
    }
    let _ = writeln!(out, "*ELEMENT, TYPE=C3D8, ELSET={set}");
    let mut element = first;
    for (k, j, i) in (0..r).flat_map(|k| (0..q).flat_map(move |j| (0..p).map(move |i| (k, j, i)))) {
        let ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
        let nodes: Vec<String> =
            [k, k + 1].iter().flat_map(|&k| ring.map(|(i, j)| label(i, j, k).to_string())).collect();
        let _ = writeln!(out, "{element}, {}", nodes.join(", "));
        element += 1;
    }
    let _ = writeln!(out, "*ELSET, ELSET={set}LOW, GENERATE\n{first}, {}, 1", first + p * q - 1);
    let _ = writeln!(out, "*ELSET, ELSET={set}HIGH, GENERATE\n{}, {}, 1", element - p * q, element - 1);
    let _ = writeln!(out, "*SURFACE, NAME={set}BASE\n{set}LOW, S1\n*SURFACE, NAME={set}TOP\n{set}HIGH, S2");
    out
}

const MATERIAL: &str = "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1e-3\n";

fn prepare(deck: &str) -> Result<Simulation, String> {
    let reading = read_text(deck, Dialect::Abaqus);
    let model = reading.model.ok_or_else(|| format!("{:?}", reading.diagnostics))?;
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {});
    Ok(Simulation::new(Arc::new(prepared.map_err(|e| format!("{e:?}"))?)))
}

/// What every increment leaves.
#[derive(Default)]
struct Log {
    energies: Vec<Energies>,
    sizes: Vec<f64>,
    solutions: Vec<NodalSolution>,
    forces: Vec<Vec<f64>>,
    keeps_fields: bool,
}

impl Watch for Log {
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport) {
        self.energies.push(simulation.history().energies);
        self.sizes.push(report.increment_size);
        if self.keeps_fields {
            self.solutions.push(simulation.recover());
            let points = simulation.prepared().contact_points().iter().zip(simulation.contact_results());
            self.forces.push(points.map(|(info, r)| info.area * r.pressure).collect());
        }
    }
}

fn run(deck: &str, keeps_fields: bool) -> (Simulation, Log) {
    let mut simulation = prepare(deck).unwrap_or_else(|e| panic!("{e}"));
    let mut log = Log { keeps_fields, ..Log::default() };
    let outcome = simulation.advance(simulation.time_end(), &mut log);
    assert!(matches!(outcome, Ok(AdvanceOutcome::Reached)), "{outcome:?}");
    (simulation, log)
}

fn index(simulation: &Simulation, label: u32) -> usize {
    simulation.prepared().model().mesh.node_of_label[&label].index()
}

/// Point masses in front of a plate of four masses (or a wall, where there are none): (place, mass, velocity along z).
fn masses(
    points: &[([f64; 3], f64, f64)],
    plate: Option<[f64; 4]>,
    behavior: &str,
    constraint: &str,
    step: &str,
) -> String {
    let mut out = String::from(
        "*NODE\n1, -1., -1., -1.\n2, 1., -1., -1.\n3, 1., 1., -1.\n4, -1., 1., -1.\n5, -1., -1., 0.\n6, 1., -1., 0.\n7, 1., 1., 0.\n8, -1., 1., 0.\n",
    );
    out += "*ELEMENT, TYPE=C3D8, ELSET=WALL\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*SURFACE, NAME=TOP\n1, S2\n";
    out += "*MATERIAL, NAME=M\n*ELASTIC\n1e-12, 0.\n*DENSITY\n1e-12\n*SOLID SECTION, ELSET=WALL, MATERIAL=M\n";
    let mut held = String::from("1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3\n");
    for (corner, mass) in (5..9).zip(plate.unwrap_or_default()) {
        let last = if plate.is_some() { 2 } else { 3 };
        let _ = writeln!(held, "{corner}, 1, {last}");
        if plate.is_some() {
            let _ = writeln!(
                out,
                "*ELEMENT, TYPE=MASS, ELSET=C{corner}\n{corner}0, {corner}\n*MASS, ELSET=C{corner}\n{mass}"
            );
        }
    }
    let (mut nodes, mut velocities) = (String::new(), String::new());
    for (label, (at, mass, velocity)) in (11..).zip(points) {
        let _ = writeln!(out, "*NODE\n{label}, {}, {}, {}", at[0], at[1], at[2]);
        let _ = writeln!(out, "*ELEMENT, TYPE=MASS, ELSET=M{label}\n{label}, {label}\n*MASS, ELSET=M{label}\n{mass}");
        let _ = writeln!(held, "{label}, 1, 2");
        let _ = writeln!(nodes, "{label}");
        let _ = writeln!(velocities, "{label}, 3, {velocity}");
    }
    let _ = write!(out, "*SURFACE, NAME=POINTS, TYPE=NODE\n{nodes}*SURFACE INTERACTION, NAME=I\n1.\n{behavior}");
    let _ = write!(out, "*BOUNDARY\n{held}*INITIAL CONDITIONS, TYPE=VELOCITY\n{velocities}");
    let small = if constraint == "KINEMATIC" { ", SMALL SLIDING" } else { "" };
    let _ = write!(
        out,
        "*STEP\n*DYNAMIC, EXPLICIT{step}\n*BULK VISCOSITY\n0., 0.\n*CONTACT PAIR, INTERACTION=I, MECHANICAL CONSTRAINT={constraint}{small}\nPOINTS, TOP\n*END STEP\n"
    );
    out
}

#[test]
fn a_mass_on_a_penalty_goes_as_by_hand() {
    // D21.
    let behavior = format!("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e4\n{UNDAMPED}");
    let step = ", DIRECT USER CONTROL\n0.004, 0.024";
    let (simulation, log) = run(&masses(&[([0.0; 3], 1.0, -1.0)], None, &behavior, "PENALTY", step), true);
    let rows = [
        (0.004, 1.0),
        (0.00736, 0.84),
        (0.0095424, 0.5456),
        (0.010198016, 0.163904),
        (0.00922194944, -0.24401664),
        (0.0067703709696, -0.6128946176),
    ];
    let node = index(&simulation, 11);
    for ((h, v), solution) in rows.into_iter().zip(&log.solutions) {
        assert!((solution.displacement[node][2] + h).abs() < 1e-15);
        assert!((solution.velocity[node][2] + v).abs() < 1e-13);
    }
}

#[test]
fn the_corrector_shares_a_blow_as_the_manual_says() {
    // D23 with the primary mass on four corners.
    let step = ", DIRECT USER CONTROL\n0.01, 0.01";
    let point = [([0.0, 0.0, 0.0], 2.0, -3e-4 / 0.01)];
    let deck = masses(&point, Some([1.5; 4]), "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n", "KINEMATIC", step);
    let (simulation, log) = run(&deck, true);
    let at = |label| log.solutions[0].acceleration[index(&simulation, label)][2];
    assert!((at(11) - 2.25).abs() < 1e-10 && (log.forces[0][0] - 4.5).abs() < 1e-10);
    for corner in 5..9 {
        assert!((at(corner) + 0.75).abs() < 1e-10);
    }
}

#[test]
fn softened_kinematic_contact_obeys_its_law_on_both_sides_and_keeps_momentum() {
    let law = crate::law::Exponential::new(0.01, 30.0).unwrap();
    let behavior = format!("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL\n0.01, 30.\n{UNDAMPED}");
    let points = [([0.4, -0.3, 0.02], 1.0, -1.0), ([-0.7, 0.1, 0.02], 4.0, -0.6), ([0.2, 0.9, 0.02], 0.3, -2.0)];
    let corners = [1.0, 2.0, 0.5, 3.0];
    let step = ", DIRECT USER CONTROL\n0.01, 0.4";
    let (simulation, log) = run(&masses(&points, Some(corners), &behavior, "KINEMATIC", step), true);
    let all: Vec<(usize, f64)> = (11..14).zip(points).map(|(l, p)| (l, p.1)).chain((5..9).zip(corners)).collect();
    let begin: f64 = points.iter().map(|p| p.1 * p.2).sum();
    let mut pressed = 0;
    for (solution, forces) in log.solutions.iter().zip(&log.forces) {
        let now: f64 = all.iter().map(|&(l, m)| m * solution.velocity[index(&simulation, l as u32)][2]).sum();
        assert!((now - begin).abs() < 1e-12 * begin.abs(), "{now} {begin}");
        for (i, (at, ..)) in points.iter().enumerate() {
            let z = |label: u32| solution.displacement[index(&simulation, label)][2];
            let (a, b) = (at[0], at[1]);
            let shape = [(1.0 - a) * (1.0 - b), (1.0 + a) * (1.0 - b), (1.0 + a) * (1.0 + b), (1.0 - a) * (1.0 + b)];
            let plate: f64 = shape.iter().zip(5..9).map(|(n, l)| 0.25 * n * z(l)).sum();
            let h = plate - at[2] - z(11 + i as u32);
            let expected = crate::law::PressureLaw::evaluate(&law, h).pressure;
            assert!((forces[i] - expected).abs() < 1e-9 * expected.max(1.0), "{} {expected}", forces[i]);
            pressed += u32::from(expected > 1.0);
        }
    }
    assert!(pressed > 3);
}

/// A block that falls onto another one, held at its foot; `pair` are the words of the pair.
fn bouncing(behavior: &str, pair: &str, scale: f64, end: f64) -> String {
    let mut deck = block(1, [2, 2, 1], [0.0, 0.0, 0.0], 1.0, "LOWER");
    deck += &block(101, [2, 2, 2], [0.0, 0.0, 1.02], 1.0, "UPPER");
    deck += MATERIAL;
    deck += "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n";
    deck += "*BOUNDARY\n1, 1, 3\n2, 1, 3\n3, 1, 3\n4, 1, 3\n5, 1, 3\n6, 1, 3\n7, 1, 3\n8, 1, 3\n9, 1, 3\n";
    let _ =
        write!(deck, "*SURFACE INTERACTION, NAME=I\n{behavior}*INITIAL CONDITIONS, TYPE=VELOCITY\nNUPPER, 3, -5.\n");
    let _ = write!(
        deck,
        "*STEP\n*DYNAMIC, EXPLICIT, SCALE FACTOR={scale}\n, {end}\n*CONTACT PAIR, INTERACTION=I, {pair}\nUPPERBASE, LOWERTOP\n*DLOAD\nUPPER, GRAV, 5000., 0., 0., -1.\n*END STEP\n"
    );
    deck
}

#[test]
fn energy_balances_whatever_the_law_and_its_enforcement() {
    let laws = [
        ("hard", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n"),
        ("linear", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n500.\n"),
        ("tabular", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR\n0., 0.\n5., 0.01\n40., 0.05\n"),
        ("exponential", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL\n0.01, 1.\n"),
    ];
    for (name, behavior) in laws {
        for constraint in ["KINEMATIC", "PENALTY"] {
            for weight in ["0.", "0.5"] {
                let pair = format!("MECHANICAL CONSTRAINT={constraint}, WEIGHT={weight}");
                let (simulation, log) = run(&bouncing(behavior, &pair, 1.0, 0.5), false);
                let largest =
                    log.energies.iter().map(|e| e.strain.max(e.kinetic).max(e.external_work.abs())).fold(0.0, f64::max);
                let start = log.energies[0].total;
                let drift = log.energies.iter().map(|e| (e.total - start).abs()).fold(0.0, f64::max) / largest;
                assert!(drift < 1e-3, "{name} {constraint} {weight}: drift {drift:e} over {}", log.energies.len());
                let lost = log.energies.last().unwrap().impact_loss / largest;
                match constraint {
                    "PENALTY" => assert!(lost.abs() < 0.02, "{name}: {lost}"),
                    _ if name == "hard" => assert!(lost > 0.01, "{lost}"),
                    _ => assert!(lost > -1e-12, "{name}: {lost}"),
                }
                assert!(simulation.audit().is_empty(), "{name} {constraint} {weight}: {:?}", simulation.audit());
            }
        }
    }
}

#[test]
fn a_checkpoint_goes_on_with_the_same_bits() {
    for constraint in ["KINEMATIC", "PENALTY"] {
        let pair = format!("MECHANICAL CONSTRAINT={constraint}, WEIGHT=0.5");
        let deck = bouncing("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n", &pair, 1.0, 0.05);
        let mut simulation = prepare(&deck).unwrap();
        for k in 1..=10 {
            let before = simulation.checkpoint();
            simulation.advance(0.005 * f64::from(k), &mut ()).unwrap();
            let after = simulation.checkpoint();
            simulation.restore(&before).unwrap();
            simulation.advance(0.005 * f64::from(k), &mut ()).unwrap();
            assert!(after == simulation.checkpoint(), "{constraint} {k}");
        }
    }
}

#[test]
fn increments_beyond_the_stable_one_stop_before_the_first() {
    let behavior = format!("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e6\n{UNDAMPED}");
    let limit = 2.0 * (2.0f64 / 1e6).sqrt();
    for (part, stops) in [(1.0, false), (1.01, true)] {
        let step = format!(", DIRECT USER CONTROL\n{}, 0.03", part * limit);
        let mut simulation = prepare(&masses(&[([0.0; 3], 2.0, -1.0)], None, &behavior, "PENALTY", &step)).unwrap();
        let outcome = simulation.advance(0.03, &mut ()).unwrap();
        match outcome {
            AdvanceOutcome::Stopped { reason } => {
                assert!(stops && reason.contains("node 11") && reason.contains("total time 0:"), "{reason}");
            }
            other => assert!(!stops, "{other:?}"),
        }
    }
}

#[test]
fn automatic_increments_follow_a_curved_law() {
    // D31: 2 sqrt(m / (A p')) at the deepest place of D02.
    let behavior = format!("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL\n1e-4, 1e3, 1e12\n{UNDAMPED}");
    let deck =
        masses(&[([0.0, 0.0, 1e-3], 1.0, -0.5)], None, &behavior, "PENALTY", ", SCALE FACTOR=0.05\n, 0.006, , 1e-4");
    let (_, log) = run(&deck, false);
    let smallest = log.sizes.iter().copied().fold(f64::MAX, f64::min);
    // Sizes stay while they are within a fifth of the limit.
    assert!(smallest <= 0.05 * 2.5831828575421e-4 * 1.01 && smallest > 0.04 * 2.5831828575421e-4, "{smallest:e}");
    assert!(log.sizes[0] > 1.5 * smallest);
}

#[test]
fn nodes_without_inertia_and_rigid_secondaries_are_refused() {
    let behavior = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n";
    let step = ", DIRECT USER CONTROL\n0.01, 0.01";
    let deck = masses(&[([0.0; 3], 1.0, -1.0)], None, behavior, "KINEMATIC", step)
        .replace("*MASS, ELSET=M11\n1\n", "*MASS, ELSET=M11\n0.\n");
    let error = prepare(&deck).err().expect("no inertia");
    assert!(error.contains("without inertia: node 11") && error.contains("degree of freedom 3"), "{error}");
}

//! Implicit dynamics of point masses, springs and gaps against closed forms.

use std::sync::Arc;

use crate::deck::read_text;
use crate::model::{Dialect, DynamicControl, HalfIncrement, InitialVelocity, MassMatrix, Model, NodeId, Procedure};
use crate::simulation::{AdvanceOutcome, IncrementReport, PrepareOptions, PreparedModel, Simulation, Watch};

/// Nodes on the 3-axis; node 1 is fixed, the others move along 3.
fn model(body: &str, period: f64, size: f64, velocities: &[(u32, f64)]) -> Model {
    let deck = format!("{body}\n*STEP, INC=100000\n*STATIC\n1., 1.\n*END STEP\n");
    let reading = read_text(&deck, Dialect::Abaqus);
    let mut model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    model.steps[0].procedure = Procedure::Dynamic(DynamicControl {
        increment_initial: size,
        period,
        increment_min: 1e-9 * period,
        increment_max: period,
        direct: true,
        alpha: -0.05,
        half_increment: HalfIncrement::Unchecked,
        initial_accelerations: true,
        mass: MassMatrix::ByOrder,
    });
    for &(node, value) in velocities {
        model.initial_velocities.push(InitialVelocity { node: NodeId(node - 1), direction: 2, value });
    }
    model
}

fn simulation(model: Model) -> Simulation {
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| {});
    Simulation::new(Arc::new(prepared.unwrap_or_else(|errors| panic!("{errors:?}"))))
}

/// Time, increment size, displacement and velocity of a node along 3, contact force, energies lost and total.
struct Trace(u32, Vec<[f64; 7]>);

impl Watch for Trace {
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport) {
        let motion = simulation.state.motion.as_ref().unwrap();
        let node = self.0 as usize - 1;
        self.1.push([
            report.time,
            report.increment_size,
            motion.displacement[node][2],
            motion.velocity[node][2],
            simulation.state.forces[0],
            motion.energies.impact_loss,
            motion.energies.total,
        ]);
    }
}

fn run(simulation: &mut Simulation, node: u32, until: f64) -> Vec<[f64; 7]> {
    let mut trace = Trace(node, Vec::new());
    let outcome = simulation.advance(until, &mut trace).unwrap();
    assert!(matches!(outcome, AdvanceOutcome::Reached), "{outcome:?}");
    trace.1
}

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} is not {expected} within {tolerance}");
}

const WALL: &str =
    "*NODE\n1, 0., 0., 0.\n2, 0., 0., 1.\n*ELEMENT, TYPE=MASS, ELSET=M2\n2, 2\n*ELEMENT, TYPE=GAPUNI, ELSET=G\n1, 1, 2
*BOUNDARY\n1, 1, 3\n2, 1, 2\n";

#[test]
fn a_mass_stops_at_a_wall_when_it_gets_there() {
    let body = format!("{WALL}*MASS, ELSET=M2\n2.\n*GAP, ELSET=G\n0.01\n");
    let mut simulation = simulation(model(&body, 0.02, 0.004, &[(2, -1.0)]));
    let rows = run(&mut simulation, 2, 0.02);
    let impact = rows.iter().position(|row| row[5] > 0.0).unwrap();
    assert_eq!(impact, 2);
    close(rows[impact][0], 0.01, 1e-12);
    close(rows[impact][3], 0.0, 1e-14);
    close(rows[impact][5], 1.0, 1e-12);
    close(rows.last().unwrap()[2], -0.01, 1e-13);
    close(rows.last().unwrap()[6], 1.0, 1e-12);
    // 0.004, the way to the impact, and from there to the next multiple.
    assert_eq!(simulation.step_reports()[0].counts.factorizations, 3);
}

#[test]
fn two_masses_take_one_velocity_and_lose_what_plastic_impact_takes() {
    let body = "*NODE\n1, 0., 0., 0.\n2, 0., 0., 1.\n3, 0., 0., 2.\n*ELEMENT, TYPE=MASS, ELSET=M2\n2, 2\n*ELEMENT, TYPE=MASS, ELSET=M3\n3, 3
*ELEMENT, TYPE=GAPUNI, ELSET=G\n1, 2, 3\n*MASS, ELSET=M2\n2.\n*MASS, ELSET=M3\n3.\n*GAP, ELSET=G\n0.013\n*BOUNDARY\n1, 1, 3\n2, 1, 2\n3, 1, 2";
    let mut simulation = simulation(model(body, 0.01, 0.001, &[(2, 4.0), (3, -1.0)]));
    let rows = run(&mut simulation, 2, 0.01);
    close(rows.last().unwrap()[3], 1.0, 1e-12);
    close(rows.last().unwrap()[5], 15.0, 1e-11);
    assert!(rows.iter().any(|row| (row[0] - 0.0026).abs() < 1e-12));
}

#[test]
fn behind_an_impact_the_rear_mass_swings_and_takes_the_front_one_along() {
    // Front 1, rear 4, spring 900, both at 2 towards the wall.
    let body = "*NODE\n1, 0., 0., 0.\n2, 0., 0., 1.\n3, 0., 0., 2.\n*ELEMENT, TYPE=MASS, ELSET=M2\n2, 2\n*ELEMENT, TYPE=MASS, ELSET=M3\n3, 3
*ELEMENT, TYPE=SPRINGA, ELSET=S\n4, 2, 3\n*SPRING, ELSET=S\n\n900.\n*ELEMENT, TYPE=GAPUNI, ELSET=G\n1, 1, 2\n*MASS, ELSET=M2\n1.\n*MASS, ELSET=M3\n4.
*GAP, ELSET=G\n0.0105\n*BOUNDARY\n1, 1, 3\n2, 1, 2\n3, 1, 2";
    let mut simulation = simulation(model(body, 0.3, 0.001, &[(2, -2.0), (3, -2.0)]));
    let rows = run(&mut simulation, 3, 0.3);
    let impact = rows.iter().find(|row| row[5] > 0.0).unwrap();
    close(impact[0], 0.00525, 1e-12);
    close(impact[5], 2.0, 1e-11);
    let force = rows.iter().map(|row| row[4]).fold(0.0, f64::max);
    close(force, 120.0, 0.5);
    let release = rows.iter().rfind(|row| row[4] > 0.0).unwrap();
    close(release[0] - impact[0], 0.20943951023931956, 2e-3);
    let motion = simulation.state.motion.as_ref().unwrap();
    close((motion.velocity[1][2] + 4.0 * motion.velocity[2][2]) / 5.0, 1.6, 0.016);
}

#[test]
fn a_mass_bounces_on_a_linear_law() {
    let body = format!(
        "{WALL}*MASS, ELSET=M2\n1.\n*GAP, ELSET=G\n0.0005, , , , 0.001\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1E9\n"
    );
    let period = std::f64::consts::PI / 1e3;
    let mut simulation = simulation(model(&body, 1.5 * period, period / 100.0, &[(2, -0.5)]));
    let rows = run(&mut simulation, 2, 1.5 * period);
    let deepest = rows.iter().map(|row| -row[2] - 0.0005).fold(0.0, f64::max);
    close(deepest, 0.0005, 0.005 * 0.0005);
    let touching = rows.iter().filter(|row| row[4] > 0.0).count() as f64 * period / 100.0;
    close(touching, period, 0.02 * period);
    close(rows.last().unwrap()[3], 0.5, 0.005);
}

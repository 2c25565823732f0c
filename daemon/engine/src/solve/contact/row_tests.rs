//! Rows beyond plain laws: the rate of Newton's method, two-sided walls, dashpots, augmentation.

use super::tests::{Case, Numbers, Solution, compliance, softened, system};
use super::*;
use crate::law::{Damping, NormalBehavior, Penalty};

/// Overclosures of the iterations of a solve from nothing, the last one the solution.
fn iterates(case: &Case, free: &[f64]) -> Vec<Vec<f64>> {
    let mut solver = ContactSolver::new(case);
    let mut solution = Solution::new(case);
    solution.solve(&mut solver, case, free, &[]).expect("convex");
    solver.iterates.clone()
}

#[test]
fn newton_squares_its_error_on_curved_laws() {
    let mut numbers = Numbers(23);
    let mut seen = 0;
    for case in 0..40 {
        let n = 1 + case % 6;
        // The exponential law of softened(): curved wherever it acts.
        let mut case = system(compliance(&mut numbers, n, n + 2), softened(), |_| 3);
        if seen % 2 == 1 {
            let curve = Curve::Penalty(Penalty::nonlinear(1.0, 100.0, 0.01, 10.0, 0.0));
            case.rows.iter_mut().for_each(|row| row.curve = curve);
        }
        let free: Vec<f64> = (0..n).map(|_| 0.05 + 0.1 * numbers.next().abs()).collect();
        let all = iterates(&case, &free);
        let last = all.last().expect("one iteration at least").clone();
        let error = |h: &Vec<f64>| h.iter().zip(&last).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        let errors: Vec<f64> = all.iter().map(error).collect();
        // From where the model is good until rounding: e' ≤ C e² with one constant, some p''/p' of these laws.
        for pair in errors.windows(2).filter(|pair| pair[0] < 5e-4 && pair[0] > 1e-7) {
            assert!(pair[1] <= 2000.0 * pair[0] * pair[0] + 1e-12, "{errors:?}");
            seen += 1;
        }
    }
    assert!(seen > 20, "too few iterations near the solution: {seen}");
}

#[test]
fn a_two_sided_wall_holds_its_point_both_ways() {
    let mut numbers = Numbers(29);
    for case in 0..60 {
        let n = 2 + case % 7;
        let mut case = system(compliance(&mut numbers, n, n + 2), vec![NormalBehavior::Hard], |_| 0);
        for (i, row) in case.rows.iter_mut().enumerate().filter(|(i, _)| i % 2 == 0) {
            row.wall = Wall::TwoSided;
            row.position = 0.01 * i as f64;
        }
        let free: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
        let mut solution = Solution::new(&case);
        solution.solve(&mut ContactSolver::new(&case), &case, &free, &[]).expect("convex");
        let scale = solution.forces.iter().fold(1.0f64, |m, f| m.max(f.abs()));
        for (i, row) in case.rows.iter().enumerate() {
            let missed = solution.overclosures[i] - row.position;
            if row.wall == Wall::TwoSided {
                assert!(missed.abs() < 1e-10 && solution.closed[i]);
            } else {
                assert!(missed < 1e-10 && solution.forces[i] >= -1e-10 * scale);
                assert!((missed * solution.forces[i]).abs() < 1e-9 * scale);
            }
        }
    }
}

#[test]
fn a_dashpot_acts_below_a_wall_and_on_it() {
    let damping = [Damping { coefficient: 2.0, clearance: 0.5, fraction: 0.2 }; 2];
    let mut numbers = Numbers(31);
    for round in 0..200 {
        let n = 1 + round % 6;
        let behaviors = vec![NormalBehavior::Hard];
        let mut case = system(compliance(&mut numbers, n, n + 2), behaviors, |_| 0);
        for row in &mut case.rows {
            let start = -0.3 * numbers.next().abs();
            row.dashpot = Some(Dashpot { viscosity: Viscosity::Ramps(damping), start, rate: 1.0 });
            if round % 3 == 0 {
                row.wall = Wall::None;
            }
        }
        let free: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
        let mut solution = Solution::new(&case);
        let mut solver = ContactSolver::new(&case);
        let result = solution.solve(&mut solver, &case, &free, &[]);
        result.unwrap_or_else(|failure| panic!("round {round}: {failure:?}"));
        for (i, row) in case.rows.iter().enumerate() {
            let (h, force) = (solution.overclosures[i], solution.forces[i]);
            let own = row.evaluate(&case.behaviors, h).force;
            if row.wall != Wall::None && solution.closed[i] {
                assert!(h.abs() < 1e-10 && force >= own - 1e-9, "round {round} point {i}: {h} {force} {own}");
            } else {
                assert!((force - own).abs() < 1e-9, "round {round} point {i}: {force} {own}");
                assert!(row.wall == Wall::None || h < 1e-10);
            }
        }
    }
}

#[test]
fn augmentation_contracts_at_its_rate_with_one_factor() {
    let (stiffness, penalty, force) = (1000.0, 3000.0, 12.0);
    let mut w = crate::solve::linear::Dense::zeros(1, 1);
    w.values[0] = 1.0 / stiffness;
    let mut case = system(w, vec![NormalBehavior::Hard], |_| 0);
    let free = [force / stiffness];
    let mut solver = ContactSolver::new(&case);
    let mut solution = Solution::new(&case);
    let mut multiplier = 0.0;
    for n in 0..8 {
        let curve = Penalty::linear(penalty, multiplier / penalty);
        case.rows[0] = Row { area: 1.0, curve: Curve::Penalty(curve), ..Row::default() };
        solution.solve(&mut solver, &case, &free, &[]).expect("convex");
        let expected = force / (stiffness + penalty) * 0.25f64.powi(n);
        assert!((solution.overclosures[0] / expected - 1.0).abs() < 1e-9, "{n}: {:?}", solution.overclosures);
        multiplier = solution.forces[0];
    }
    assert_eq!(solver.factors(), 1);
}

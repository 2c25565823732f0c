//! The contact solve against enumeration of all active sets and against the conditions themselves.

use super::*;
use crate::law::{Exponential, Linear, PressureOverclosure, Tabular};

/// Seeded numbers in (-1, 1): a multiplicative congruential generator is enough for test problems.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// `W = V Vᵀ` with `rank` columns: singular when the rank is below n.
fn compliance(numbers: &mut Numbers, n: usize, rank: usize) -> Dense {
    let v: Vec<Vec<f64>> = (0..n).map(|_| (0..rank).map(|_| numbers.next()).collect()).collect();
    let mut w = Dense::zeros(n, n);
    for j in 0..n {
        for i in 0..n {
            w.values[j * n + i] = v[i].iter().zip(&v[j]).map(|(a, b)| a * b).sum();
        }
    }
    w
}

fn system(compliance: Dense, behaviors: Vec<NormalBehavior>, pick: impl Fn(usize) -> usize) -> ContactSystem {
    let points =
        (0..compliance.rows).map(|i| PointBehavior { area: 0.5 + 0.1 * i as f64, behavior: pick(i) }).collect();
    ContactSystem { compliance, points, behaviors }
}

fn softened() -> Vec<NormalBehavior> {
    let table = Tabular::new(&[(0.0, -0.1), (0.2, 0.05), (3.0, 0.4)]).expect("valid");
    [
        PressureOverclosure::Linear(Linear::new(3.0).expect("valid")),
        PressureOverclosure::Linear(Linear::new(3e6).expect("valid")),
        PressureOverclosure::Tabular(table),
        PressureOverclosure::Exponential(Exponential::new(0.01, 5.0).expect("valid")),
        PressureOverclosure::Exponential(Exponential::new(1e-6, 5.0).expect("valid")),
    ]
    .map(NormalBehavior::Softened)
    .into()
}

fn solve(system: &ContactSystem, free: &[f64]) -> (Vec<f64>, Vec<f64>, Result<SolveCounts, SolveFailure>) {
    let n = free.len();
    let (mut forces, mut relief, mut closed, mut overclosures) =
        (vec![0.0; n], vec![0.0; n], vec![false; n], vec![0.0; n]);
    let result =
        ContactSolver::new(system).solve(system, free, &mut forces, &mut relief, &mut closed, &mut overclosures);
    if result.is_ok() {
        let mut recomputed = vec![0.0; n];
        system.relief(&forces, &mut recomputed);
        assert_eq!(relief, recomputed, "a restored state has the same bits");
    }
    (forces, overclosures, result)
}

/// Solution by trying all sets of closed points, with plain Gaussian elimination.
fn enumerate(w: &Dense, free: &[f64]) -> Vec<f64> {
    let n = free.len();
    for set in 0..1u32 << n {
        let active: Vec<usize> = (0..n).filter(|i| set >> i & 1 == 1).collect();
        let m = active.len();
        let mut a: Vec<Vec<f64>> =
            active.iter().map(|&i| active.iter().map(|&j| w.values[j * n + i]).chain([free[i]]).collect()).collect();
        for k in 0..m {
            let pivot = a[k].clone();
            for (r, row) in a.iter_mut().enumerate() {
                if r != k {
                    let f = row[k] / pivot[k];
                    row.iter_mut().zip(&pivot).for_each(|(x, p)| *x -= f * p);
                }
            }
        }
        let mut forces = vec![0.0; n];
        for k in 0..m {
            forces[active[k]] = a[k][m] / a[k][k];
        }
        let overclosure = |i: usize| free[i] - (0..n).map(|j| w.values[j * n + i] * forces[j]).sum::<f64>();
        if forces.iter().all(|&f| f >= -1e-9) && (0..n).all(|i| overclosure(i) < 1e-9) {
            return forces;
        }
    }
    panic!("a positive definite problem has a solution");
}

#[test]
fn hard_points_agree_with_enumeration_of_all_sets() {
    let mut numbers = Numbers(1);
    for case in 0..300 {
        let n = 1 + case % 9;
        let w = compliance(&mut numbers, n, n + 3);
        let free: Vec<f64> = (0..n).map(|_| numbers.next()).collect();
        let expected = enumerate(&w, &free);
        let (forces, overclosures, result) = solve(&system(w, vec![NormalBehavior::Hard], |_| 0), &free);
        result.expect("solvable");
        let scale = expected.iter().fold(1.0f64, |m, f| m.max(f.abs()));
        for i in 0..n {
            assert!((forces[i] - expected[i]).abs() < 1e-9 * scale, "case {case}: {forces:?} {expected:?}");
            assert!(overclosures[i] < 1e-9, "case {case}");
        }
    }
}

#[test]
fn every_law_and_mixture_converges_and_satisfies_its_law() {
    let mut numbers = Numbers(7);
    let mut behaviors = softened();
    behaviors.push(NormalBehavior::Hard);
    for case in 0..600 {
        let n = 1 + case % 14;
        // One law for all points in the first half, a mixture in the second.
        let pick = |i: usize| if case < 300 { case % 6 } else { (i * 7 + case) % 6 };
        let w = compliance(&mut numbers, n, n + 2);
        let depth = [1e-3, 0.05, 1.0][case % 3];
        let free: Vec<f64> = (0..n).map(|_| depth * (numbers.next() + 0.3)).collect();
        let problem = system(w, behaviors.clone(), pick);
        let (forces, overclosures, result) = solve(&problem, &free);
        let counts = result.unwrap_or_else(|e| panic!("case {case}: {e:?}"));
        assert!(
            counts.equilibrium_iterations + counts.severe_discontinuity_iterations < 120,
            "case {case}: {counts:?}"
        );
        let scale = forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        for i in 0..n {
            // Rounding of the sum W F, which cancels when W is ill-conditioned.
            let terms: f64 = problem.compliance.column(i).iter().zip(&forces).map(|(w, f)| (w * f).abs()).sum();
            let rounding = 64.0 * f64::EPSILON * (free[i].abs() + terms);
            let residual = match &behaviors[pick(i)] {
                NormalBehavior::Hard => {
                    assert!(overclosures[i] < 1e-12 * depth + rounding, "case {case}: {:e}", overclosures[i]);
                    assert!(forces[i] >= -1e-10 * scale, "case {case}: {:e} of {scale:e}", forces[i]);
                    if overclosures[i].abs() <= rounding { 0.0 } else { forces[i].abs() }
                }
                NormalBehavior::Softened(law) => {
                    let at = law.evaluate(overclosures[i]);
                    (forces[i] - problem.points[i].area * at.pressure).abs() - rounding * at.stiffness
                }
            };
            assert!(residual < 1e-10 * scale.max(1e-3), "case {case} point {i}: {residual:e} of {scale:e}");
        }
    }
}

#[test]
fn dependent_hard_points_are_satisfied_and_contradictions_named() {
    let mut numbers = Numbers(3);
    let n = 6;
    // Rank 3: any three points hold the others.
    let w = compliance(&mut numbers, n, 3);
    let push: Vec<f64> = (0..n).map(|_| numbers.next().abs()).collect();
    let mut free = vec![0.0; n];
    w.multiply_add(&push, &mut free);
    let problem = system(w, vec![NormalBehavior::Hard], |_| 0);
    let (forces, overclosures, result) = solve(&problem, &free);
    result.expect("consistent");
    assert!(
        overclosures.iter().all(|h| *h < 1e-9) && forces.iter().all(|f| *f >= -1e-9),
        "{forces:?} {overclosures:?}"
    );
    // No compliance at all: nothing can give way.
    let rigid = system(Dense::zeros(2, 2), vec![NormalBehavior::Hard], |_| 0);
    let (.., refused) = solve(&rigid, &[-0.1, 0.2]);
    assert_eq!(refused, Err(SolveFailure::Infeasible { points: vec![(1, 0.2)] }));
}

#[test]
fn a_second_solve_from_the_solution_needs_one_iteration_and_no_new_factor() {
    let mut numbers = Numbers(5);
    let problem = system(compliance(&mut numbers, 8, 10), softened(), |_| 0);
    let free: Vec<f64> = (0..8).map(|_| numbers.next()).collect();
    let (mut forces, mut relief, mut closed, mut overclosures) =
        (vec![0.0; 8], vec![0.0; 8], vec![false; 8], vec![0.0; 8]);
    let mut solver = ContactSolver::new(&problem);
    solver.solve(&problem, &free, &mut forces, &mut relief, &mut closed, &mut overclosures).expect("solvable");
    let factor = solver.factor.clone();
    let counts =
        solver.solve(&problem, &free, &mut forces, &mut relief, &mut closed, &mut overclosures).expect("solvable");
    assert_eq!(counts, SolveCounts { equilibrium_iterations: 1, severe_discontinuity_iterations: 0 });
    assert_eq!(factor, solver.factor);
}

#[test]
fn a_solve_that_starts_at_or_beside_the_solution_stays_there() {
    let mut numbers = Numbers(11);
    for case in 0..300 {
        let n = 2 + case % 9;
        let system = system(compliance(&mut numbers, n, n + 2), softened(), |i| (i + case) % 5);
        let free: Vec<f64> = (0..n).map(|_| 0.1 * numbers.next()).collect();
        let (mut forces, _, first) = solve(&system, &free);
        first.expect("convex");
        for _ in 0..20 {
            let nearby: Vec<f64> = free.iter().map(|h| h * (1.0 + 1e-15 * numbers.next())).collect();
            let (mut relief, mut overclosures) = (vec![0.0; n], vec![0.0; n]);
            system.relief(&forces, &mut relief);
            let mut closed: Vec<bool> = forces.iter().map(|&force| force > 0.0).collect();
            let again = ContactSolver::new(&system).solve(
                &system,
                &nearby,
                &mut forces,
                &mut relief,
                &mut closed,
                &mut overclosures,
            );
            let counts = again.unwrap_or_else(|failure| panic!("case {case}: {failure:?}"));
            assert!(counts.equilibrium_iterations <= 8, "case {case}: {counts:?}");
        }
    }
}

#[test]
fn a_stiff_law_is_nearly_hard_and_a_negligible_one_nothing() {
    let mut numbers = Numbers(13);
    for case in 0..60 {
        let n = 1 + case % 7;
        let w = compliance(&mut numbers, n, n + 3);
        let free: Vec<f64> = (0..n).map(|_| 0.01 * numbers.next()).collect();
        let hard = solve(&system(w.clone(), vec![NormalBehavior::Hard], |_| 0), &free).0;
        for slope in [1e10, 1e-40, 1e-300] {
            let law = PressureOverclosure::Linear(Linear::new(slope).expect("valid"));
            let (forces, _, result) = solve(&system(w.clone(), vec![NormalBehavior::Softened(law)], |_| 0), &free);
            result.unwrap_or_else(|e| panic!("case {case}, slope {slope:e}: {e:?}"));
            let scale = hard.iter().fold(0.0f64, |m, f| m.max(f.abs()));
            for (force, limit) in forces.iter().zip(&hard) {
                let expected = if slope > 1.0 { *limit } else { 0.0 };
                assert!((force - expected).abs() <= 1e-6 * scale, "case {case}, slope {slope:e}: {force} {expected}");
            }
        }
    }
}

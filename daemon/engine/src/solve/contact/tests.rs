//! The contact solve against enumeration of all active sets and against the conditions themselves.

use super::*;
use crate::law::{Exponential, Linear, NormalBehavior, PressureLaw, PressureOverclosure, Tabular};
use crate::solve::linear::Dense;

/// Seeded numbers in (-1, 1): a multiplicative congruential generator is enough for test problems.
pub(super) struct Numbers(pub u64);

impl Numbers {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// `W = V Vᵀ` with `rank` columns: singular when the rank is below n.
pub(super) fn compliance(numbers: &mut Numbers, n: usize, rank: usize) -> Dense {
    let v: Vec<Vec<f64>> = (0..n).map(|_| (0..rank).map(|_| numbers.next()).collect()).collect();
    let mut w = Dense::zeros(n, n);
    for j in 0..n {
        for i in 0..n {
            w.values[j * n + i] = v[i].iter().zip(&v[j]).map(|(a, b)| a * b).sum();
        }
    }
    w
}

/// A system with its rows.
pub(super) struct Case {
    pub system: ContactSystem,
    pub rows: Vec<Row>,
}

impl std::ops::Deref for Case {
    type Target = ContactSystem;

    fn deref(&self) -> &ContactSystem {
        &self.system
    }
}

pub(super) fn system(compliance: Dense, behaviors: Vec<NormalBehavior>, pick: impl Fn(usize) -> usize) -> Case {
    let count = compliance.rows;
    let row = |i: usize| {
        let area = 0.5 + 0.1 * i as f64;
        match behaviors[pick(i)] {
            NormalBehavior::Hard => Row { area, wall: Wall::OneSided, ..Row::default() },
            NormalBehavior::Softened(_) => Row { area, curve: Curve::Law(pick(i) as u32), ..Row::default() },
        }
    };
    let rows = (0..count).map(row).collect();
    let system = ContactSystem {
        structure: Structure::Dense(compliance),
        count,
        behaviors,
        gap_motions: Dense::zeros(count, 0),
        resisted: vec![],
        springs: vec![],
        loose: Dense::default(),
        extent: 0.0,
    };
    Case { system, rows }
}

/// The same with motions.
fn floating(mut case: Case, gap_motions: Dense) -> Case {
    let system = &mut case.system;
    system.springs = initial_springs(&system.structure, &gap_motions);
    system.resisted = vec![true; gap_motions.columns];
    system.gap_motions = gap_motions;
    case
}

/// Unknowns of a system, from nothing.
#[derive(Clone)]
pub(super) struct Solution {
    pub forces: Vec<f64>,
    pub relief: Vec<f64>,
    pub closed: Vec<bool>,
    pub overclosures: Vec<f64>,
    pub motions: Vec<f64>,
    pub springs: Vec<f64>,
}

impl Solution {
    pub fn new(system: &ContactSystem) -> Self {
        let n = system.count;
        Self {
            forces: vec![0.0; n],
            relief: vec![0.0; n],
            closed: vec![false; n],
            overclosures: vec![0.0; n],
            motions: vec![0.0; system.springs.len()],
            springs: system.springs.clone(),
        }
    }

    pub fn solve(
        &mut self,
        solver: &mut ContactSolver,
        case: &Case,
        free: &[f64],
        load: &[f64],
    ) -> Result<SolveCounts, SolveFailure> {
        let load_scale: Vec<f64> = load.iter().map(|l| l.abs()).collect();
        let mut unknowns = Unknowns {
            forces: &mut self.forces,
            relief: &mut self.relief,
            closed: &mut self.closed,
            overclosures: &mut self.overclosures,
            motions: &mut self.motions,
            springs: &mut self.springs,
        };
        solver.solve(case, Problem { rows: &case.rows, free, load, load_scale: &load_scale }, &mut unknowns)
    }
}

pub(super) fn softened() -> Vec<NormalBehavior> {
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

fn solve(system: &Case, free: &[f64]) -> (Vec<f64>, Vec<f64>, Result<SolveCounts, SolveFailure>) {
    let mut solution = Solution::new(system);
    let result = solution.solve(&mut ContactSolver::new(system), system, free, &[]);
    if result.is_ok() {
        let mut recomputed = vec![0.0; free.len()];
        system.relief(&solution.forces, &mut recomputed);
        assert_eq!(solution.relief, recomputed, "a restored state has the same bits");
    }
    (solution.forces, solution.overclosures, result)
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
        let problem = system(w.clone(), behaviors.clone(), pick);
        let (forces, overclosures, result) = solve(&problem, &free);
        let counts = result.unwrap_or_else(|e| panic!("case {case}: {e:?}"));
        assert!(
            counts.equilibrium_iterations + counts.severe_discontinuity_iterations < 120,
            "case {case}: {counts:?}"
        );
        let scale = forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        for i in 0..n {
            // Rounding of the sum W F, which cancels when W is ill-conditioned.
            let terms: f64 = w.column(i).iter().zip(&forces).map(|(w, f)| (w * f).abs()).sum();
            let rounding = 64.0 * f64::EPSILON * (free[i].abs() + terms);
            let residual = match &behaviors[pick(i)] {
                NormalBehavior::Hard => {
                    assert!(overclosures[i] < 1e-12 * depth + rounding, "case {case}: {:e}", overclosures[i]);
                    assert!(forces[i] >= -1e-10 * scale, "case {case}: {:e} of {scale:e}", forces[i]);
                    if overclosures[i].abs() <= rounding { 0.0 } else { forces[i].abs() }
                }
                NormalBehavior::Softened(law) => {
                    let at = law.evaluate(overclosures[i]);
                    (forces[i] - problem.rows[i].area * at.pressure).abs() - rounding * at.stiffness
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
    let mut solver = ContactSolver::new(&problem);
    let mut solution = Solution::new(&problem);
    solution.solve(&mut solver, &problem, &free, &[]).expect("solvable");
    let factors = solver.factors();
    let counts = solution.solve(&mut solver, &problem, &free, &[]).expect("solvable");
    assert_eq!(
        counts,
        SolveCounts { equilibrium_iterations: 1, severe_discontinuity_iterations: 0, factorizations: 0 }
    );
    assert_eq!(factors, solver.factors());
}

#[test]
fn a_solve_that_starts_at_or_beside_the_solution_stays_there() {
    let mut numbers = Numbers(11);
    for case in 0..300 {
        let n = 2 + case % 9;
        let system = system(compliance(&mut numbers, n, n + 2), softened(), |i| (i + case) % 5);
        let free: Vec<f64> = (0..n).map(|_| 0.1 * numbers.next()).collect();
        let mut solution = Solution::new(&system);
        solution.solve(&mut ContactSolver::new(&system), &system, &free, &[]).expect("convex");
        for _ in 0..20 {
            let nearby: Vec<f64> = free.iter().map(|h| h * (1.0 + 1e-15 * numbers.next())).collect();
            let again = solution.solve(&mut ContactSolver::new(&system), &system, &nearby, &[]);
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

/// `n` points over a plane resist three motions of one body and, with other arms, three of another.
fn arms(numbers: &mut Numbers, n: usize, motions: usize) -> Dense {
    let mut d = Dense::zeros(n, motions);
    d.values.iter_mut().for_each(|x| *x = numbers.next());
    d.column_mut(0).fill(-1.0);
    d
}

#[test]
fn bodies_that_only_contact_holds_come_to_balance_under_every_law() {
    let mut numbers = Numbers(17);
    let mut behaviors = softened();
    behaviors.push(NormalBehavior::Hard);
    for case in 0..600 {
        let k = 1 + case % 4;
        let n = k + 2 + case % 9;
        let pick = |i: usize| if case < 300 { case % 6 } else { (i * 7 + case) % 6 };
        let d = arms(&mut numbers, n, k);
        let system = floating(system(compliance(&mut numbers, n, n + 2), behaviors.clone(), pick), d.clone());
        // Loads that forces of pressed points can balance, so that a solution exists.
        let push: Vec<f64> = (0..n).map(|_| 0.5 * (1.0 + numbers.next())).collect();
        let load: Vec<f64> = (0..k).map(|m| d.column(m).iter().zip(&push).map(|(d, f)| d * f).sum()).collect();
        let gap = [1e-3, 1.0, 1e4][case % 3];
        let free: Vec<f64> = (0..n).map(|_| gap * (numbers.next() - 1.0)).collect();
        let mut solution = Solution::new(&system);
        let result = solution.solve(&mut ContactSolver::new(&system), &system, &free, &load);
        let counts = result.unwrap_or_else(|e| panic!("case {case}: {e:?}"));
        assert!(counts.equilibrium_iterations < 400, "case {case}: {counts:?}");
        let scale = solution.forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        for m in 0..k {
            let carried: f64 = d.column(m).iter().zip(&solution.forces).map(|(d, f)| d * f).sum();
            assert!((carried - load[m]).abs() < 1e-11 * scale, "case {case}: {carried} {}", load[m]);
        }
        for i in 0..n {
            let residual = match &behaviors[pick(i)] {
                NormalBehavior::Hard => {
                    assert!(solution.overclosures[i] < 1e-9 * scale, "case {case}: {:e}", solution.overclosures[i]);
                    if solution.overclosures[i].abs() < 1e-9 * scale { 0.0 } else { solution.forces[i].abs() }
                }
                NormalBehavior::Softened(law) => {
                    let at = law.evaluate(solution.overclosures[i]);
                    let rounding = 1e-11 * scale.max(gap) * at.stiffness;
                    (solution.forces[i] - system.rows[i].area * at.pressure).abs() - rounding
                }
            };
            assert!(
                residual < 1e-9 * scale,
                "case {case} point {i}: {residual:e} of {scale:e} {:?} {:?} {:?} {counts:?}",
                solution.forces,
                solution.overclosures,
                solution.motions
            );
        }
    }
}

#[test]
fn a_body_pulled_away_is_reported_with_its_motion_and_an_unloaded_one_stays() {
    let mut numbers = Numbers(19);
    let n = 5;
    let mut d = Dense::zeros(n, 2);
    d.column_mut(0).fill(-1.0);
    d.column_mut(1).copy_from_slice(&[-1.0, -0.5, 0.0, 0.5, 1.0]);
    for behavior in softened().into_iter().chain([NormalBehavior::Hard]) {
        let system = floating(system(compliance(&mut numbers, n, n + 2), vec![behavior], |_| 0), d.clone());
        let free = vec![-0.2; n];
        let mut solver = ContactSolver::new(&system);
        let mut solution = Solution::new(&system);
        solution.solve(&mut solver, &system, &free, &[0.0, 0.0]).expect("nothing acts");
        assert_eq!(solution.motions, [0.0, 0.0]);
        match solution.clone().solve(&mut solver, &system, &free, &[3.0, 0.0]) {
            Err(SolveFailure::Unheld { motions }) => assert!(motions[0] > 100.0 * motions[1].abs(), "{motions:?}"),
            other => panic!("{other:?}"),
        }
        let before = solution.clone();
        solution.solve(&mut solver, &system, &free, &[-3.0, 0.5]).expect("pressed");
        assert!((solution.forces.iter().sum::<f64>() - 3.0).abs() < 1e-11);
        // A second time from there: the same place.
        let first = solution.clone();
        solution.solve(&mut solver, &system, &free, &[-3.0, 0.5]).expect("pressed");
        for (a, b) in solution.motions.iter().zip(&first.motions) {
            assert!((a - b).abs() <= 1e-11 * a.abs().max(1.0), "{a} {b}");
        }
        assert_eq!(before.forces, vec![0.0; n]);
    }
}

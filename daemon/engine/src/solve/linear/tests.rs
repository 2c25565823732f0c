use super::*;
use crate::solve::assembly::LowerMatrix;

/// A matrix twice: its lower triangle by columns, and in full.
struct Sample {
    lower: LowerMatrix,
    full: Vec<Vec<f64>>,
}

impl Sample {
    /// Keeps the entries of the lower triangle that are not zero.
    fn new(full: Vec<Vec<f64>>) -> Self {
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..full.len() {
            for i in (j..full.len()).filter(|&i| full[i][j] != 0.0) {
                rows.push(i);
                values.push(full[i][j]);
            }
            starts.push(rows.len());
        }
        Self { lower: LowerMatrix { starts, rows, values }, full }
    }

    /// Tridiagonal (-1, 4.5, -1) with a dense last row.
    fn arrow(n: usize) -> Self {
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 4.5,
            1 => -1.0,
            _ if i == n - 1 || j == n - 1 => 0.01,
            _ => 0.0,
        };
        Self::new((0..n).map(|i| (0..n).map(|j| entry(i, j)).collect()).collect())
    }

    /// Springs of random stiffness between random unknowns, on a weak foundation of one.
    fn springs(n: usize, count: usize, random: &mut Random) -> Self {
        let mut full = vec![vec![0.0; n]; n];
        for (i, row) in full.iter_mut().enumerate() {
            row[i] = 1.0;
        }
        for _ in 0..count {
            let (i, j, k) = (random.below(n), random.below(n), 1.0 + random.unit());
            if i != j {
                full[i][i] += k;
                full[j][j] += k;
                full[i][j] -= k;
                full[j][i] -= k;
            }
        }
        Self::new(full)
    }

    fn factor(&self) -> Factor {
        Factor::new(&self.lower, Symbolic::analyse(&self.lower)).expect("positive definite")
    }

    fn len(&self) -> usize {
        self.full.len()
    }

    fn times(&self, x: &[f64]) -> Vec<f64> {
        self.full.iter().map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum()).collect()
    }
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn matrix(&mut self, rows: usize, columns: usize) -> Dense {
        Dense { rows, columns, values: (0..rows * columns).map(|_| self.unit() - 0.5).collect() }
    }
}

fn samples() -> Vec<Sample> {
    let mut random = Random(1);
    let mut samples = vec![Sample::arrow(30)];
    for (n, count) in [(1, 0), (2, 1), (3, 2), (10, 0), (17, 40), (40, 60), (60, 900), (150, 320), (300, 900)] {
        samples.push(Sample::springs(n, count, &mut random));
    }
    samples
}

fn assert_close(actual: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    let scale = expected.iter().fold(1.0f64, |m, v| m.max(v.abs()));
    for (i, (a, e)) in actual.iter().zip(expected).enumerate() {
        assert!((a - e).abs() <= tolerance * scale, "{what}: entry {i} is {a}, not {e}");
    }
}

#[test]
fn solve_inverts_the_matrix_for_one_and_for_many_right_hand_sides() {
    let mut random = Random(2);
    for sample in samples() {
        let factor = sample.factor();
        for columns in [1, 2, 3, 7] {
            let rhs = random.matrix(sample.len(), columns);
            let mut x = rhs.clone();
            factor.solve(&mut x);
            for c in 0..columns {
                assert_close(&sample.times(x.column(c)), rhs.column(c), 1e-12, &format!("n {}", sample.len()));
            }
        }
    }
}

#[test]
fn the_backward_half_is_that_of_the_dense_factor() {
    let mut random = Random(3);
    for sample in samples() {
        let n = sample.len();
        let factor = sample.factor();
        let mut dense = Dense::zeros(n, n);
        for (j, row) in sample.full.iter().enumerate() {
            dense.column_mut(j).copy_from_slice(row);
        }
        assert!(cholesky_in_place(&mut dense.values, n, &mut DenseScratch::default()));
        for columns in [1, 4] {
            let rhs = random.matrix(n, columns);
            let (mut sparse, mut expected) = (rhs.clone(), rhs);
            factor.solve_transposed(&mut sparse);
            expected.solve_lower_transposed(&dense);
            assert_close(&sparse.values, &expected.values, 1e-12, "backward");
        }
    }
}

#[test]
fn a_right_hand_side_with_one_entry_gives_a_column_of_the_inverse() {
    for sample in samples() {
        let factor = sample.factor();
        let n = sample.len();
        for unknown in [0, n / 2, n - 1] {
            let mut x = Dense::zeros(n, 1);
            x.values[unknown] = 1.0;
            let unit = x.values.clone();
            factor.solve(&mut x);
            assert_close(&sample.times(&x.values), &unit, 1e-12, "unit vector");
        }
    }
}

#[test]
fn the_same_solve_gives_the_same_bits() {
    for sample in samples() {
        let rhs = Random(4).matrix(sample.len(), 3);
        let (mut a, mut b) = (rhs.clone(), rhs);
        sample.factor().solve(&mut a);
        sample.factor().solve(&mut b);
        assert_eq!(a, b);
    }
}

#[test]
fn the_trailing_block_is_the_factor_of_the_schur_complement() {
    for sample in samples().into_iter().filter(|s| s.len() <= 60) {
        let n = sample.len();
        let factor = sample.factor();
        for begin in [0, n / 4, n - n / 6 - 1, n - 1, n] {
            let l = factor.trailing(begin);
            // Schur complement by plain elimination.
            let mut s = sample.full.clone();
            for k in 0..begin {
                let pivot = s[k].clone();
                for row in s.iter_mut().skip(k + 1) {
                    let f = row[k] / pivot[k];
                    for (entry, p) in row.iter_mut().zip(&pivot) {
                        *entry -= f * p;
                    }
                }
            }
            for i in begin..n {
                for j in begin..n {
                    let llt: f64 = (0..n - begin).map(|k| l.column(k)[i - begin] * l.column(k)[j - begin]).sum();
                    assert!((llt - s[i][j]).abs() < 1e-12 * sample.full[i][i].max(1.0), "n {n}, begin {begin}");
                }
            }
        }
    }
}

#[test]
fn a_singular_matrix_is_refused_with_its_unknown() {
    // Free-free chain: stiffness without support.
    let chain = vec![vec![1.0, -1.0, 0.0], vec![-1.0, 2.0, -1.0], vec![0.0, -1.0, 1.0]];
    let matrix = Sample::new(chain).lower;
    let refused = Factor::new(&matrix, Symbolic::analyse(&matrix)).err();
    assert_eq!(refused, Some(SingularPivot { unknown: 2 }));
}

#[test]
fn a_negative_pivot_in_a_larger_matrix_is_refused_with_its_unknown() {
    let mut full = Sample::springs(60, 200, &mut Random(5)).full;
    full[41][41] = -1.0;
    let matrix = Sample::new(full).lower;
    let refused = Factor::new(&matrix, Symbolic::analyse(&matrix)).err();
    assert_eq!(refused, Some(SingularPivot { unknown: 41 }));
}

#[test]
fn sizes_agree_before_and_after_factoring() {
    for sample in samples() {
        let before = Symbolic::analyse(&sample.lower).size();
        assert_eq!(before, sample.factor().size());
        assert!(before.values >= sample.lower.values.len());
    }
}

#[test]
fn supernodes_in_parts_give_the_same_factor() {
    let mut random = Random(6);
    // Dense enough for supernodes of many columns, with a sparse part before them.
    let sample = Sample::springs(300, 2500, &mut random);
    let n = sample.len();
    let whole = Symbolic::analyse(&sample.lower).blocks;
    let rhs = random.matrix(n, 2);
    let mut expected = rhs.clone();
    sample.factor().solve(&mut expected);
    for width_max in [1, 2, 3, 7, 30, 64, 200] {
        let blocks = whole.cut(width_max);
        assert!((0..blocks.len()).all(|s| blocks.width(s) <= width_max));
        assert!(blocks.is_consistent(blocks.values()) && blocks.unknowns() == n);
        assert!(width_max >= 30 || blocks.values() < whole.values());
        let mut values = vec![0.0; blocks.values()];
        numeric::factor(&sample.lower, &blocks, &mut values).expect("positive definite");
        let factor = Factor::from_parts(blocks, values).expect("consistent");
        let mut x = rhs.clone();
        factor.solve(&mut x);
        assert_close(&x.values, &expected.values, 1e-12, &format!("width {width_max}"));
        assert_close(
            &factor.trailing(n / 2).gram().values,
            &sample.factor().trailing(n / 2).gram().values,
            1e-12,
            "trailing",
        );
    }
}

#[test]
fn parts_that_do_not_fit_are_no_factor() {
    let sample = Sample::arrow(30);
    let (blocks, values) = {
        let f = sample.factor();
        (f.blocks.clone(), f.values)
    };
    let refuses = |change: &dyn Fn(&mut Blocks, &mut Vec<f64>)| {
        let (mut blocks, mut values) = (blocks.clone(), values.clone());
        change(&mut blocks, &mut values);
        Factor::from_parts(blocks, values).is_none()
    };
    assert!(!refuses(&|_, _| {}));
    assert!(refuses(&|_, v| v.truncate(v.len() - 1)));
    assert!(refuses(&|b, _| b.starts.clear()));
    assert!(refuses(&|b, _| *b.starts.last_mut().expect("not empty") += 1));
    assert!(refuses(&|b, _| b.pattern[0] = 30));
    assert!(refuses(&|b, _| b.pattern[0] = 0));
    assert!(refuses(&|b, _| b.pattern.truncate(b.pattern.len() - 1)));
    assert!(refuses(&|b, _| b.value_starts[1] += 1));
    assert!(refuses(&|b, _| b.pattern_starts[1] = 1000));
}

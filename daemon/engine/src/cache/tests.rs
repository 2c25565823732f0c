use std::fs;
use std::path::Path;

use super::*;
use crate::solve::assembly::LowerMatrix;
use crate::solve::linear::{Dense, Factor, Symbolic};

type Kept = (Vec<f64>, String);

fn kept() -> Kept {
    (vec![1.5, -0.0, f64::MIN_POSITIVE], "a body".into())
}

/// A chain of springs with a support at its first end.
fn factor(n: usize) -> Factor {
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for j in 0..n {
        rows.extend([j].into_iter().chain(Some(j + 1).filter(|&i| i < n)));
        values.push(2.0 + 0.125 * j as f64);
        values.extend(Some(-1.0).filter(|_| j + 1 < n));
        starts.push(rows.len());
    }
    let matrix = LowerMatrix { starts, rows, values };
    Factor::new(&matrix, Symbolic::analyse(&matrix)).expect("a chain that is held is regular")
}

fn solved(factor: &Factor) -> Vec<f64> {
    let n = factor.blocks().unknowns();
    let mut x = Dense { rows: n, columns: 1, values: (0..n).map(|i| (i as f64).cos()).collect() };
    factor.solve(&mut x);
    x.values
}

fn not_to_be_rebuilt() -> Factor {
    panic!("the file gives the factor")
}

/// What a damaged file gives: whether it is refused when opened or when its factors are read.
fn is_refused(path: &Path) -> bool {
    match open::<Kept>(path, 7) {
        Err(_) => true,
        Ok((_, _, factors)) => {
            let mut rebuilt = false;
            for (lazy, unknowns) in factors.iter().zip([4, 2]) {
                lazy.get(unknowns, || {
                    rebuilt = true;
                    factor(3)
                });
            }
            rebuilt
        }
    }
}

#[test]
fn everything_comes_back_bit_for_bit() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = file_in(&directory.path().join("new"), 7);
    let factors = [factor(5), factor(1), factor(80)];
    write(&path, 7, &kept(), &factors.each_ref()).expect("the directory can be written");
    let (_, bodies, stored) = open::<Kept>(&path, 7).expect("own file");
    assert_eq!(bodies.0.map_bits(), kept().0.map_bits());
    assert_eq!(bodies.1, kept().1);
    assert_eq!(stored.len(), 3);
    // In any order, and more than once.
    for i in [2, 0, 1, 2] {
        assert!(!stored[i].was_computed());
        let read = stored[i].get(factors[i].blocks().unknowns(), not_to_be_rebuilt);
        assert_eq!((read.blocks(), read.values()), (factors[i].blocks(), factors[i].values()));
        assert_eq!(solved(read), solved(&factors[i]));
    }
    let left: Vec<_> = fs::read_dir(directory.path().join("new")).expect("it was made").collect();
    assert_eq!(left.len(), 1, "nothing but the file is left behind");
}

trait Bits {
    fn map_bits(&self) -> Vec<u64>;
}

impl Bits for Vec<f64> {
    fn map_bits(&self) -> Vec<u64> {
        self.iter().map(|x| x.to_bits()).collect()
    }
}

#[test]
fn every_damaged_byte_and_every_cut_is_noticed() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = file_in(directory.path(), 7);
    write(&path, 7, &kept(), &[&factor(4), &factor(2)]).expect("the directory can be written");
    assert!(!is_refused(&path));
    let bytes = fs::read(&path).expect("just written");
    for at in 0..bytes.len() {
        let mut bad = bytes.clone();
        bad[at] ^= 0x41;
        fs::write(&path, &bad).expect("the directory can be written");
        assert!(is_refused(&path), "byte {at}");
        fs::write(&path, &bytes[..at]).expect("the directory can be written");
        assert!(is_refused(&path), "cut at {at}");
    }
    fs::write(&path, [bytes.as_slice(), b"x"].concat()).expect("the directory can be written");
    assert!(is_refused(&path), "one byte too many");
}

#[test]
fn a_file_of_something_else_is_told_from_a_damaged_one() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = file_in(directory.path(), 7);
    assert!(matches!(open::<Kept>(&path, 7), Err(Refused::Absent)));
    write(&path, 7, &kept(), &[]).expect("the directory can be written");
    assert!(matches!(open::<Kept>(&path, 8), Err(Refused::Other("another model"))));
    let bytes = fs::read(&path).expect("just written");
    let mut other = bytes.clone();
    other[4] += 1;
    fs::write(&path, &other).expect("the directory can be written");
    assert!(matches!(open::<Kept>(&path, 7), Err(Refused::Other("another version of the file format"))));
    // Another build writes a header that is in order.
    let mut other = bytes;
    other[8] ^= 1;
    let end = HEADER + 8;
    let crc = crc32fast::hash(&other[..end]);
    other[end..end + 4].copy_from_slice(&crc.to_le_bytes());
    fs::write(&path, &other).expect("the directory can be written");
    assert!(matches!(open::<Kept>(&path, 7), Err(Refused::Other("another build of the engine"))));
}

#[test]
fn a_file_that_vanishes_or_changes_after_opening_does_no_harm() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = file_in(directory.path(), 7);
    let mine = factor(6);
    write(&path, 7, &kept(), &[&mine]).expect("the directory can be written");
    let (_, _, stored) = open::<Kept>(&path, 7).expect("own file");
    // Another process replaces the file: this one still reads what it has opened.
    write(&path, 7, &kept(), &[&factor(9)]).expect("the directory can be written");
    assert_eq!(solved(stored[0].get(6, not_to_be_rebuilt)), solved(&mine));
    let (_, _, stored) = open::<Kept>(&path, 7).expect("own file");
    // Cut where it lies: the factor is computed again.
    fs::OpenOptions::new().write(true).open(&path).and_then(|f| f.set_len(100)).expect("the file can be cut");
    assert_eq!(solved(stored[0].get(9, || factor(9))), solved(&factor(9)));
}

#[test]
fn writers_at_the_same_time_leave_one_whole_file() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = file_in(directory.path(), 7);
    std::thread::scope(|scope| {
        for n in 1..9 {
            let path = &path;
            scope.spawn(move || {
                for _ in 0..5 {
                    let bodies: Kept = (vec![10.0 * n as f64], String::new());
                    write(path, 7, &bodies, &[&factor(10 * n)]).expect("the directory can be written");
                    let (_, bodies, stored) = open::<Kept>(path, 7).expect("there is always a whole file");
                    // Whichever writer was the last: its own factor, and whole.
                    let unknowns: Vec<usize> = bodies.0.iter().map(|n| *n as usize).collect();
                    stored[0].get(unknowns[0], not_to_be_rebuilt);
                }
            });
        }
    });
    assert_eq!(fs::read_dir(directory.path()).expect("it is there").count(), 1);
}

#[test]
fn a_directory_that_cannot_be_made_is_an_error() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let blocker = directory.path().join("file");
    fs::write(&blocker, "").expect("the directory can be written");
    assert!(write(&file_in(&blocker, 7), 7, &kept(), &[]).is_err());
}

//! Prepared models on disk: a second start computes nothing and gives the same bits; whatever happens to the file, the
//! results are right.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use overclosure::deck;
use overclosure::model::Dialect;
use overclosure::simulation::{AdvanceOutcome, Cache, Phase, PrepareOptions, PreparedModel, Simulation};

/// A block of bricks: its nodes, elements and the sets of its lowest and highest nodes and elements.
fn block(text: &mut String, name: &str, first: usize, bricks: [usize; 3], low: [f64; 3], size: [f64; 3]) {
    let [nx, ny, nz] = bricks;
    let node = |i: usize, j: usize, k: usize| first + (k * (ny + 1) + j) * (nx + 1) + i;
    let _ = writeln!(text, "*NODE");
    for k in 0..=nz {
        for j in 0..=ny {
            for i in 0..=nx {
                let x: Vec<f64> = (0..3).map(|d| low[d] + size[d] * [i, j, k][d] as f64 / bricks[d] as f64).collect();
                let _ = writeln!(text, "{}, {}, {}, {}", node(i, j, k), x[0], x[1], x[2]);
            }
        }
    }
    let _ = writeln!(text, "*ELEMENT, TYPE=C3D8, ELSET={name}");
    for k in 0..nz {
        for j in 0..ny {
            for i in 0..nx {
                let lower = [node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k)];
                let upper = lower.map(|n| n + (nx + 1) * (ny + 1));
                let all: Vec<String> = lower.iter().chain(&upper).map(usize::to_string).collect();
                let _ = writeln!(text, "{}, {}", first + (k * ny + j) * nx + i, all.join(", "));
            }
        }
    }
    for (set, k) in [("BOTTOM", 0), ("TOP", nz)] {
        let _ = writeln!(text, "*NSET, NSET={name}_{set}, GENERATE\n{}, {}", node(0, 0, k), node(nx, ny, k));
    }
    for (set, k) in [("LOW", 0), ("HIGH", nz - 1)] {
        let begin = first + k * nx * ny;
        let _ = writeln!(text, "*ELSET, ELSET={name}_{set}, GENERATE\n{begin}, {}", begin + nx * ny - 1);
    }
}

/// A block that only contact holds from below, pressed onto one that is fixed, in two steps.
fn text(load: f64) -> String {
    let mut text = String::from("*HEADING\na block on a block\n");
    block(&mut text, "LOWER", 1, [5, 5, 3], [0.0; 3], [3.0, 3.0, 1.5]);
    block(&mut text, "UPPER", 1001, [3, 3, 2], [1.0, 1.0, 1.5], [1.0, 1.0, 1.0]);
    let _ = write!(
        text,
        "*SURFACE, NAME=SECONDARY, TYPE=ELEMENT\nUPPER_LOW, S1\n*SURFACE, NAME=PRIMARY, TYPE=ELEMENT\nLOWER_HIGH, S2\n\
         *MATERIAL, NAME=STEEL\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=LOWER, MATERIAL=STEEL\n\
         *SOLID SECTION, ELSET=UPPER, MATERIAL=STEEL\n*SURFACE INTERACTION, NAME=HARD\n\
         *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n\
         *CONTACT PAIR, INTERACTION=HARD, TYPE=NODE TO SURFACE, SMALL SLIDING\nSECONDARY, PRIMARY\n\
         *BOUNDARY\nLOWER_BOTTOM, 1, 3\nUPPER_TOP, 1, 2\n\
         *STEP\n*STATIC\n0.5, 1.\n*CLOAD\nUPPER_TOP, 3, {load}\n*NODE PRINT, NSET=LOWER_BOTTOM, TOTALS=ONLY\nRF\n*END STEP\n\
         *STEP\n*STATIC\n0.25, 1.\n*CLOAD\nUPPER_TOP, 3, {}\n*NODE PRINT, NSET=LOWER_BOTTOM, TOTALS=ONLY\nRF\n*END STEP\n",
        3.0 * load
    );
    text
}

/// Everything that a run gives, to the bit, and how often the preparation factored.
#[derive(Debug, PartialEq)]
struct Results {
    displacement: Vec<u64>,
    reaction: Vec<u64>,
    stress: Vec<u64>,
    contact: String,
    history: String,
}

/// A run of the deck, and the phases of its preparation.
struct Run {
    results: Results,
    phases: Vec<Phase>,
    factorizations: u32,
}

fn bits(values: Vec<f64>) -> Vec<u64> {
    values.into_iter().map(f64::to_bits).collect()
}

fn run(load: f64, cache: Option<Cache>, threads: usize) -> Run {
    let reading = deck::read_text(&text(load), Dialect::Abaqus);
    let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let options = PrepareOptions { cache, threads, ..PrepareOptions::default() };
    let mut phases = Vec::new();
    let prepared = PreparedModel::prepare(model, &options, &mut |phase| phases.push(phase));
    let mut simulation = Simulation::new(Arc::new(prepared.unwrap_or_else(|e| panic!("{e:?}"))));
    let end = simulation.time_end();
    assert_eq!(simulation.advance(end, &mut ()), Ok(AdvanceOutcome::Reached));
    let solution = simulation.recover();
    let results = Results {
        stress: bits(simulation.nodal_stress(&solution).into_flattened()),
        displacement: bits(solution.displacement.into_flattened()),
        reaction: bits(solution.reaction.into_flattened()),
        contact: format!("{:?}", simulation.contact_results()),
        history: format!("{:?}", simulation.history()),
    };
    let factorizations = simulation.step_reports().iter().map(|step| step.counts.factorizations).sum();
    Run { results, phases, factorizations }
}

fn only_file(directory: &Path) -> PathBuf {
    let mut files: Vec<PathBuf> =
        fs::read_dir(directory).expect("it was made").map(|entry| entry.expect("an entry").path()).collect();
    assert_eq!(files.len(), 1, "{files:?}");
    files.remove(0)
}

#[test]
fn a_second_start_factors_nothing_and_gives_the_same_bits() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let cache = Some(Cache::Directory(directory.path().join("models")));
    let without = run(-0.2, None, 1);
    let first = run(-0.2, cache.clone(), 1);
    assert_eq!((without.factorizations, first.factorizations), (2, 2));
    assert_eq!(first.results, without.results);
    assert!(first.results.contact.contains("Closed"), "{}", first.results.contact);
    assert!(!without.phases.contains(&Phase::Cache));
    for threads in [1, 2] {
        let second = run(-0.2, cache.clone(), threads);
        assert_eq!(second.factorizations, 0);
        assert_eq!(second.phases, [Phase::Search, Phase::Cache, Phase::Condense]);
        assert_eq!(second.results, without.results);
    }
}

#[test]
fn each_model_has_its_own_file_and_the_file_of_another_is_not_taken() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let cache = Some(Cache::Directory(directory.path().to_owned()));
    run(-0.2, cache.clone(), 1);
    let first = only_file(directory.path());
    let bytes = fs::read(&first).expect("just written");
    fs::remove_file(&first).expect("it is there");
    run(-0.3, cache.clone(), 1);
    let other = only_file(directory.path());
    assert_ne!(first, other);
    // The file of the first model under the name of the other.
    fs::write(&other, bytes).expect("the directory can be written");
    let again = run(-0.3, cache.clone(), 1);
    assert_eq!((again.factorizations, again.results), (2, run(-0.3, None, 1).results));
    assert_eq!(run(-0.3, cache, 1).factorizations, 0, "it was written anew");
}

#[test]
fn a_damaged_file_gives_the_right_results_and_is_written_anew_if_it_cannot_be_opened() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let cache = Some(Cache::Directory(directory.path().to_owned()));
    let expected = run(-0.2, cache.clone(), 1).results;
    let path = only_file(directory.path());
    let bytes = fs::read(&path).expect("just written");
    let mut noticed = [0, 0];
    for at in (0..40).map(|i| i * (bytes.len() - 1) / 39) {
        for cut in [false, true] {
            let mut bad = bytes.clone();
            if cut {
                bad.truncate(at);
            } else {
                bad[at] ^= 0x10;
            }
            fs::write(&path, &bad).expect("the directory can be written");
            let damaged = run(-0.2, cache.clone(), 1);
            assert!(damaged.results == expected, "byte {at}, cut {cut}");
            // Damage in a factor is found when the factor is read; the rest when the file is opened.
            let at_opening = damaged.factorizations == 2;
            noticed[usize::from(at_opening)] += 1;
            assert_eq!(fs::read(&path).expect("it is there") == bytes, at_opening, "byte {at}, cut {cut}");
            assert!(at_opening || !cut);
        }
    }
    assert!(noticed[0] > 5 && noticed[1] > 5, "{noticed:?}");
}

#[test]
fn a_file_that_is_only_read_is_never_written() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let path = directory.path().join("prepared.ovpm");
    let expected = run(-0.2, Some(Cache::File(path.clone())), 1);
    assert_eq!(expected.factorizations, 2);
    assert!(!path.exists());
    let models = directory.path().join("models");
    run(-0.2, Some(Cache::Directory(models.clone())), 1);
    fs::rename(only_file(&models), &path).expect("both are in one directory");
    let read = run(-0.2, Some(Cache::File(path.clone())), 1);
    assert_eq!((read.factorizations, read.results), (0, expected.results));
    fs::write(&path, "not a prepared model").expect("the directory can be written");
    assert_eq!(run(-0.2, Some(Cache::File(path.clone())), 1).factorizations, 2);
    assert_eq!(fs::read(&path).expect("it is there"), b"not a prepared model");
}

#[test]
fn a_memory_limit_holds_for_a_model_from_disk_too() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let cache = Some(Cache::Directory(directory.path().to_owned()));
    run(-0.2, cache.clone(), 1);
    let model = deck::read_text(&text(-0.2), Dialect::Abaqus).model.expect("it was read before");
    let options = PrepareOptions { cache, memory_limit: Some(100_000), ..PrepareOptions::default() };
    let errors = PreparedModel::prepare(model, &options, &mut |_| {}).err().expect("it has more than 100 kB");
    assert!(errors.iter().any(|e| e.message.contains("the prepared model needs about")), "{errors:?}");
}

#[test]
fn starts_at_the_same_time_share_a_directory() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let expected = run(-0.2, None, 1).results;
    std::thread::scope(|scope| {
        for _ in 0..6 {
            scope.spawn(|| {
                for _ in 0..3 {
                    let cache = Some(Cache::Directory(directory.path().to_owned()));
                    assert!(run(-0.2, cache, 1).results == expected);
                }
            });
        }
    });
    only_file(directory.path());
    assert_eq!(run(-0.2, Some(Cache::Directory(directory.path().to_owned())), 1).factorizations, 0);
}

#[test]
fn a_directory_that_cannot_be_written_is_no_reason_to_fail() {
    let directory = tempfile::tempdir().expect("a temporary directory");
    let blocker = directory.path().join("file");
    fs::write(&blocker, "").expect("the directory can be written");
    assert_eq!(run(-0.2, Some(Cache::Directory(blocker)), 1).results, run(-0.2, None, 1).results);
}

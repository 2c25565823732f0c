//! The writer shall follow the output requests of a deck while the deck is solved, and keep what there is when a run stops.

use std::fs;

use super::*;
use crate::deck;
use crate::model::Dialect;
use crate::simulation::{AdvanceOutcome, PrepareOptions};

/// Two cubes of side 1, the upper pressed down by 0.01 in four increments.
const DECK: &str = "\
*HEADING
two cubes
*NODE
1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1
11,0,0,1\n12,1,0,1\n13,1,1,1\n14,0,1,1\n15,0,0,2\n16,1,0,2\n17,1,1,2\n18,0,1,2
*ELEMENT, TYPE=C3D8, ELSET=LOWER
1,1,2,3,4,5,6,7,8
*ELEMENT, TYPE=C3D8, ELSET=UPPER
2,11,12,13,14,15,16,17,18
*NSET, NSET=BOTTOM
1,2,3,4
*NSET, NSET=TOP
15,16,17,18
*NSET, NSET=ALL
1,2,3,4,5,6,7,8,11,12,13,14,15,16,17,18
*MATERIAL, NAME=M
*ELASTIC
1000.,0.
*SOLID SECTION, ELSET=LOWER, MATERIAL=M
*SOLID SECTION, ELSET=UPPER, MATERIAL=M
*SURFACE, NAME=SEC
UPPER,S1
*SURFACE, NAME=PRI
LOWER,S2
*SURFACE INTERACTION, NAME=I
*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR
1000.
*CONTACT PAIR, INTERACTION=I, TYPE=NODE TO SURFACE, SMALL SLIDING
SEC,PRI
*BOUNDARY
ALL,1,2
BOTTOM,3,3
*STEP
*STATIC, DIRECT
0.25,1.
*BOUNDARY
TOP,3,3,-0.03
*NODE PRINT, NSET=TOP, TOTALS=YES, FREQUENCY=2
U,RF
*CONTACT PRINT, FREQUENCY=3
CSTRESS,CDISP
*NODE FILE, FREQUENCY=3
U
*END STEP
";

/// Passes increments on and asks to stop after some.
struct StopAfter<'a> {
    writer: &'a mut ResultWriter,
    left: u32,
}

impl Watch for StopAfter<'_> {
    fn increment(&mut self, simulation: &Simulation, report: &IncrementReport) {
        self.writer.increment(simulation, report);
        self.left -= 1;
    }

    fn cancelled(&self) -> bool {
        self.left == 0
    }
}

/// Runs some of the four increments; returns the folder.
fn solved(increments: u32) -> tempfile::TempDir {
    solved_deck(DECK, increments)
}

/// The same for a variant of the deck.
fn solved_deck(text: &str, increments: u32) -> tempfile::TempDir {
    let directory = solved_to(text, increments, 1.0);
    let rows = numbers(&directory, "job_history.csv", "time");
    assert_eq!(rows.len() as u32, increments, "{rows:?}");
    directory
}

/// The same for one that ends at another time.
fn solved_to(text: &str, increments: u32, end: f64) -> tempfile::TempDir {
    let directory = tempfile::tempdir().unwrap();
    let reading = deck::read_text(text, Dialect::Abaqus);
    let model = reading.model.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| ());
    let prepared = Arc::new(prepared.unwrap_or_else(|e| panic!("{e:?}")));
    let mut writer =
        ResultWriter::create(directory.path(), "job", Arc::clone(&prepared), WriteOptions::default()).unwrap();
    let mut simulation = Simulation::new(prepared);
    let mut watch = StopAfter { writer: &mut writer, left: increments };
    let outcome = simulation.advance(end, &mut watch).unwrap();
    let ended = (simulation.time() - end).abs() < 1e-9 * end;
    assert_eq!(outcome, if ended { AdvanceOutcome::Reached } else { AdvanceOutcome::Cancelled });
    writer.finish(&simulation).unwrap();
    directory
}

/// The lines of a table as columns by name.
fn column(directory: &tempfile::TempDir, file: &str, name: &str) -> Vec<String> {
    let text = fs::read_to_string(directory.path().join(file)).unwrap();
    let mut lines = text.lines();
    let position = lines.next().unwrap().split(',').position(|c| c == name).unwrap_or_else(|| panic!("no {name}"));
    lines.map(|line| line.split(',').nth(position).unwrap().to_owned()).collect()
}

fn numbers(directory: &tempfile::TempDir, file: &str, name: &str) -> Vec<f64> {
    column(directory, file, name).iter().map(|v| v.parse().unwrap()).collect()
}

fn frames(directory: &tempfile::TempDir) -> usize {
    let list = fs::read_to_string(directory.path().join("job.pvd")).unwrap();
    let names: Vec<&str> = list.split("file=\"").skip(1).map(|s| s.split('"').next().unwrap()).collect();
    assert!(names.iter().all(|name| directory.path().join(name).is_file()));
    names.len()
}

#[test]
fn requests_decide_what_is_written() {
    let directory = solved(4);
    assert_eq!(numbers(&directory, "job_history.csv", "time"), [0.25, 0.5, 0.75, 1.0]);
    // Three springs of 1000 in a row over area 1.
    for (rf, share) in numbers(&directory, "job_history.csv", "RF3[TOP]").iter().zip([0.25, 0.5, 0.75, 1.0]) {
        assert!((rf + 10.0 * share).abs() < 1e-9, "{rf}");
    }
    assert_eq!(numbers(&directory, "job_nodes.csv", "increment"), [2.0, 2.0, 2.0, 2.0, 4.0, 4.0, 4.0, 4.0]);
    assert_eq!(column(&directory, "job_nodes.csv", "node")[..4], ["15", "16", "17", "18"]);
    assert!(numbers(&directory, "job_nodes.csv", "U3")[4..].iter().all(|u| *u == -0.03));
    assert_eq!(numbers(&directory, "job_contact.csv", "increment"), [3.0, 3.0, 3.0, 3.0, 4.0, 4.0, 4.0, 4.0]);
    assert!(column(&directory, "job_contact.csv", "status").iter().all(|s| s == "CL"));
    assert!(numbers(&directory, "job_contact.csv", "CPRESS")[4..].iter().all(|p| (p - 10.0).abs() < 1e-9));
    assert_eq!(frames(&directory), 2);
    let printed = fs::read_to_string(directory.path().join("job.dat")).unwrap();
    for part in ["two cubes", "NODES OF NODE SET TOP", "CONTACT PAIR (SEC,PRI)", "1.000000E+01", "TOTAL FORCE"] {
        assert!(printed.contains(part), "{part} is missing in\n{printed}");
    }
    assert_eq!(printed.matches("SUMMARY").count(), 4, "increments 2, 3 and 4, and 1 for its contact log");
    let log: Vec<&str> = printed.lines().filter(|line| line.ends_with("OP     CL   SEC_PRI")).collect();
    assert_eq!(log.len(), 4, "{printed}");
    assert!(printed.find(log[3]) < printed.find("INCREMENT     2"), "{printed}");
}

/// Tables of the last increment, by the words behind `PRINTED FOR`.
fn tables(directory: &tempfile::TempDir) -> Vec<String> {
    let printed = fs::read_to_string(directory.path().join("job.dat")).unwrap();
    let last = printed.rsplit("SUMMARY").next().unwrap();
    last.split("THE FOLLOWING TABLE IS PRINTED FOR ").skip(1).map(str::to_owned).collect()
}

#[test]
fn contact_tables_have_the_columns_and_the_points_of_their_request() {
    let requests = "*CONTACT PRINT, SLAVE=SEC, MASTER=PRI, NSET=CORNER, TOTALS=YES, SUMMARY=NO\nCPRESS,CSLIP2\n\
        *CONTACT PRINT\nCFT,CMN,XN,CSTATUS\n*CONTACT PRINT, SLAVE=SEC\nCDSTRESS\n";
    let text = DECK.replacen("*CONTACT PRINT, FREQUENCY=3\nCSTRESS,CDISP\n", requests, 1);
    let text = text.replacen("*MATERIAL", "*NSET, NSET=CORNER\n11,12\n*MATERIAL", 1);
    let directory = solved_deck(&text, 4);
    let tables = tables(&directory);
    let [corner, statuses, viscous, ..] = &tables[..] else { panic!("{tables:?}") };
    assert!(corner.starts_with("NODES OF NODE SET CORNER IN CONTACT PAIR (SEC,PRI)"), "{corner}");
    let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let lines: Vec<Vec<String>> = corner.lines().map(words).filter(|words| !words.is_empty()).collect();
    assert_eq!(lines[1], ["NODE", "STATUS", "CPRESS", "CSLIP2"]);
    assert_eq!(lines[2], ["11", "CL", "1.000000E+01", "0.000000E+00"]);
    assert_eq!(lines[3][..3], ["12", "CL", "1.000000E+01"]);
    assert_eq!(lines[4], ["TOTAL", "2.000000E+01", "0.000000E+00"], "{corner}");
    assert!(!corner.contains("MAXIMUM"), "{corner}");
    assert_eq!(words(statuses.lines().nth(4).unwrap()), ["11", "CL"]);
    // 10 over the unit square between the cubes, whose corner is the origin: moment (5, -5, 0), centre (½, ½, 1).
    for part in [
        "CFT1           CFT2           CFT3           CFTM\n      TOTAL    0.000000E+00   0.000000E+00   1.000000E+01",
        "CMN1           CMN2           CMN3           CMNM",
        "XN1            XN2            XN3\n      TOTAL    5.000000E-01   5.000000E-01   1.000000E+00",
    ] {
        assert!(statuses.contains(part), "{part} is missing in\n{statuses}");
    }
    assert_eq!(words(viscous.lines().nth(2).unwrap()), ["NODE", "STATUS", "CDPRESS", "CDSHEAR1", "CDSHEAR2"]);
    assert!(viscous.contains("MAXIMUM"), "{viscous}");
}

#[test]
fn history_has_the_totals_that_are_asked_for() {
    let directory = solved_deck(&DECK.replacen("CSTRESS,CDISP", "CSTRESS,CFTM,XT1", 1), 4);
    for (name, expected) in [("CFS3", 0.0), ("XN1", 0.5), ("XN3", 1.0), ("CFT3", 10.0), ("CFTM", 10.0), ("XT2", 0.5)] {
        let last = *numbers(&directory, "job_history.csv", &format!("{name}[SEC_PRI]")).last().unwrap();
        assert!((last - expected).abs() < 1e-9, "{name} is {last}");
    }
    let header = fs::read_to_string(directory.path().join("job_history.csv")).unwrap();
    let header = header.lines().next().unwrap();
    assert!(!header.contains("CMN") && !header.contains("XS"), "{header}");
}

#[test]
fn the_results_file_is_there_when_it_is_asked_for_and_replaces_an_old_one() {
    let directory = solved(4);
    let text = fs::read_to_string(directory.path().join("job.fil")).unwrap();
    let stream: String = text.lines().collect();
    assert!(text.lines().all(|line| line.len() == 80));
    // *NODE FILE, FREQUENCY=3: increments 3 and 4, no contact.
    for (part, count) in [("I 42000", 2), ("I 3101", 32), ("I 41503", 0), ("I 3101I 215", 2)] {
        assert_eq!(stream.matches(part).count(), count, "{part}");
    }
    let silent = DECK.replacen("*NODE FILE, FREQUENCY=3\nU\n", "", 1);
    let directory = tempfile::tempdir().unwrap();
    fs::write(directory.path().join("job.fil"), "old").unwrap();
    let model = deck::read_text(&silent, Dialect::Abaqus).model.unwrap();
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| ());
    let prepared = Arc::new(prepared.unwrap_or_else(|e| panic!("{e:?}")));
    ResultWriter::create(directory.path(), "job", prepared, WriteOptions::default()).unwrap();
    assert!(!directory.path().join("job.fil").exists());
}

#[test]
fn requests_that_cannot_be_met_are_refused_with_line_reason_and_remedy() {
    use crate::diagnostic::Severity;
    let line = 1 + DECK.lines().position(|line| line == "CSTRESS,CDISP").unwrap() as u32;
    for (word, severity, message, remedy) in [
        ("CPRES", Severity::Error, "there is no output variable CPRES", "did you mean CPRESS?"),
        ("CTRQ", Severity::Error, "CTRQ is not offered: axisymmetric models offer it", "CMN, CMS and CMT"),
        ("HFL", Severity::Error, "heat transfer", "leave it out"),
        ("FSLIP", Severity::Error, "Abaqus/Explicit offers it", "CSLIP1"),
        ("CFORCE", Severity::Warning, "CFORCE is not written", "variables are CSTRESS"),
    ] {
        let reading = deck::read_text(&DECK.replacen("CSTRESS,CDISP", &format!("CSTRESS,{word}"), 1), Dialect::Abaqus);
        let found = reading.diagnostics.iter().find(|d| d.message.contains(word));
        let found = found.unwrap_or_else(|| panic!("{:?}", reading.diagnostics));
        assert_eq!((found.severity, found.place.line, found.keyword.as_str()), (severity, line, "*CONTACT PRINT"));
        assert!(found.message.contains(message) && found.remedy.contains(remedy), "{found:?}");
        assert_eq!(reading.model.is_some(), severity == Severity::Warning);
    }
    for (from, to, message) in [
        ("*CONTACT PRINT", "*CONTACT PRINT, SLAVE=SECC", "there is no surface SECC"),
        ("*CONTACT PRINT", "*CONTACT PRINT, SLAVE=PRI", "no contact pair has these surfaces"),
        ("*CONTACT PRINT", "*CONTACT PRINT, NSET=NOWHERE", "there is no node set NOWHERE"),
        ("U,RF", "U,RG", "there is no output variable RG"),
    ] {
        let reading = deck::read_text(&DECK.replacen(from, to, 1), Dialect::Abaqus);
        assert!(
            reading.diagnostics.iter().any(|d| d.message.contains(message)),
            "{message}: {:?}",
            reading.diagnostics
        );
        assert!(reading.model.is_none(), "{message}");
    }
}

#[test]
fn bars_and_springs_are_printed_with_one_value_each() {
    // From the bottom to the top, which comes down by 0.03 of the 2 between them.
    let elements = "*ELEMENT, TYPE=T3D2, ELSET=BARS\n21,1,15\n*ELEMENT, TYPE=SPRINGA, ELSET=SPRINGS\n22,16,2\n\
        *ELEMENT, TYPE=MASS, ELSET=MASSES\n23,16\n*MASS, ELSET=MASSES\n1.\n\
        *SOLID SECTION, ELSET=BARS, MATERIAL=M\n0.5\n*SPRING, ELSET=SPRINGS\n\n10.\n*MATERIAL";
    let requests = "*EL PRINT, ELSET=BARS\nS\n*EL PRINT, ELSET=MASSES\nS\n*EL PRINT\nS\n*END STEP";
    let text = DECK.replacen("*MATERIAL", elements, 1).replacen("*END STEP", requests, 1);
    let directory = solved_deck(&text, 4);
    let printed = fs::read_to_string(directory.path().join("job.dat")).unwrap();
    let last = printed.rsplit("SUMMARY").next().unwrap();
    let tables: Vec<&str> = last.split("THE FOLLOWING TABLE IS PRINTED FOR THE ").collect();
    let of = |what: &str| -> Vec<f64> {
        let table = tables.iter().find(|table| table.starts_with(what)).unwrap_or_else(|| panic!("no {what}: {last}"));
        let row = table.lines().nth(4).unwrap();
        row.split_whitespace().map(|item| item.parse().unwrap()).collect()
    };
    for bars in ["BARS OF ELEMENT SET BARS (S11: STRESS", "BARS OF ALL ELEMENTS"] {
        let [element, point, stress] = of(bars)[..] else { panic!("{last}") };
        assert_eq!((element, point), (21.0, 1.0));
        assert!((stress + 1000.0 * 0.03 / 2.0).abs() < 1e-9, "{stress}");
    }
    let [element, _, force] = of("SPRINGS OF ALL ELEMENTS (S11: FORCE")[..] else { panic!("{last}") };
    assert!(element == 22.0 && (force + 10.0 * 0.03).abs() < 1e-9, "{last}");
    let count = |what: &str| tables.iter().filter(|table| table.starts_with(what)).count();
    let counts = [count("BARS"), count("SPRINGS"), count("NODES OF ALL"), count("NODES OF ELEMENT SET")];
    assert_eq!(counts, [2, 1, 1, 0], "{last}");
    assert!(last.contains("AT ELEMENT"));
}

/// The deck as an explicit one: the upper cube is thrown down, in a hundred increments.
fn explicit_deck(requests: &str) -> String {
    let from = DECK.find("*STEP").unwrap();
    let step = format!(
        "*INITIAL CONDITIONS, TYPE=VELOCITY\nUP,3,-0.01\n*STEP\n*DYNAMIC, EXPLICIT, DIRECT USER CONTROL\n0.001,0.1\n{requests}*END STEP\n"
    );
    let model = DECK[..from].replacen("0.\n*SOLID SECTION", "0.\n*DENSITY\n1.\n*SOLID SECTION", 1);
    model.replacen("*MATERIAL", "*NSET, NSET=UP\n11,12,13,14,15,16,17,18\n*MATERIAL", 1) + &step
}

#[test]
fn explicit_steps_write_fields_at_intervals_and_motions_with_them() {
    let directory = explicit_run("*NODE FILE\nU,V,A\n*NODE PRINT, NSET=TOP, FREQUENCY=50\nV,A\n*RESTART, WRITE\n");
    assert_eq!(numbers(&directory, "job_history.csv", "increment").len(), 100);
    assert_eq!(numbers(&directory, "job_ports.csv", "increment").len(), 100);
    assert_eq!(frames(&directory), 20);
    let fil: String = fs::read_to_string(directory.path().join("job.fil")).unwrap().lines().collect();
    for (part, count) in [("I 42000", 20), ("I 3101", 320), ("I 3102", 320), ("I 3103", 320), ("I 3104", 0)] {
        assert_eq!(fil.matches(part).count(), count, "{part}");
    }
    assert_eq!(column(&directory, "job_nodes.csv", "increment"), ["50", "50", "50", "50", "100", "100", "100", "100"]);
    let (v, a) = (numbers(&directory, "job_nodes.csv", "V3"), numbers(&directory, "job_nodes.csv", "A3"));
    assert!(v.iter().chain(&a).all(|x| *x != 0.0), "{v:?} {a:?}");
    let last = numbers(&directory, "job_ports.csv", "node.TOP.V3")[99];
    assert!((v[4..].iter().sum::<f64>() / 4.0 - last).abs() < 1e-15, "{v:?} {last}");
    let printed = fs::read_to_string(directory.path().join("job.dat")).unwrap();
    for part in ["E X P L I C I T", "FIXED TIME INCREMENT", "             V1             V2", "             A1"] {
        assert!(printed.contains(part), "{part} is missing in\n{printed}");
    }
    assert_eq!(printed.matches("SUMMARY").count(), 2, "contact that opens and closes is told with the tables");
    let frame = fs::read(directory.path().join("job_00020.vtu")).unwrap();
    let head = String::from_utf8_lossy(&frame[..4000]).into_owned();
    assert!(head.contains("Name=\"V\"") && head.contains("Name=\"A\""), "{head}");
    let snapshots = fs::read_dir(directory.path()).unwrap().filter_map(|e| e.unwrap().file_name().into_string().ok());
    assert_eq!(snapshots.filter(|name| name.ends_with(".ovck")).collect::<Vec<_>>(), ["job_restart_1_100.ovck"]);
}

#[test]
fn the_history_of_an_explicit_step_is_as_dense_as_it_asks_for() {
    let history = |requests: &str| numbers(&explicit_run(requests), "job_history.csv", "increment");
    assert_eq!(history("*OUTPUT, HISTORY, TIME INTERVAL=0.025\n"), [25.0, 50.0, 75.0, 100.0]);
    assert_eq!(history("*OUTPUT, HISTORY, FREQUENCY=40\n"), [40.0, 80.0, 100.0]);
    assert_eq!(history("*OUTPUT, HISTORY\n").len(), 100);
    let directory = explicit_run("*OUTPUT, FIELD, NUMBER INTERVAL=4\n*NODE OUTPUT\nU\n");
    assert_eq!((frames(&directory), numbers(&directory, "job_history.csv", "time").len()), (4, 100));
    let directory = explicit_run("*FILE OUTPUT, NUMBER INTERVAL=5\n*NODE FILE\nU\n");
    assert_eq!(frames(&directory), 5);
}

fn explicit_run(requests: &str) -> tempfile::TempDir {
    solved_to(&explicit_deck(requests), 100, 0.1)
}

#[test]
fn a_stopped_run_gets_what_its_last_increment_lacked() {
    let directory = solved(2);
    assert_eq!(numbers(&directory, "job_history.csv", "time"), [0.25, 0.5]);
    assert_eq!(numbers(&directory, "job_nodes.csv", "increment"), [2.0; 4], "written once, by its request");
    assert_eq!(numbers(&directory, "job_contact.csv", "increment"), [2.0; 4], "written because the run ends");
    assert_eq!(frames(&directory), 1);
    let printed = fs::read_to_string(directory.path().join("job.dat")).unwrap();
    assert_eq!(printed.matches("SUMMARY").count(), 2, "the contact log of increment 1, and the end:\n{printed}");
    assert!(printed.contains("CONTACT PAIR (SEC,PRI)"));
}

#[test]
fn a_file_that_cannot_be_written_ends_the_writing_and_is_named() {
    let directory = tempfile::tempdir().unwrap();
    fs::create_dir(directory.path().join("job_contact.csv")).unwrap();
    let model = deck::read_text(DECK, Dialect::Abaqus).model.unwrap();
    let prepared = PreparedModel::prepare(model, &PrepareOptions::default(), &mut |_| ());
    let prepared = Arc::new(prepared.unwrap_or_else(|e| panic!("{e:?}")));
    let error =
        ResultWriter::create(directory.path(), "job", prepared, WriteOptions::default()).map(|_| ()).unwrap_err();
    assert!(error.to_string().contains("job_contact.csv"), "{error}");
}

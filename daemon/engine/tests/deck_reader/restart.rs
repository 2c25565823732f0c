//! `*RESTART`: when snapshots are wanted.

use overclosure::model::{Dialect, RestartFrequency, RestartRequest};

use crate::base::*;

/// Requests of the steps of a deck whose second and third step repeat the first, with a card in the first and in the last one.
fn requests(first: &str, last: &str, dialect: Dialect) -> Vec<Option<RestartRequest>> {
    let (head, step) = BASE.split_at(BASE.find("*STEP").expect("a step"));
    let with = |card: &str| step.replace("*END STEP", &format!("{card}*END STEP"));
    let (model, found) = accepted(&[head, &with(first), step, &with(last)].concat(), dialect);
    assert!(found.is_empty(), "{}", listing(&found));
    model.steps.iter().map(|step| step.output.restart).collect()
}

fn every(increments: u32) -> Option<RestartRequest> {
    Some(RestartRequest { frequency: RestartFrequency::Increments(increments), overlay: false })
}

#[test]
fn snapshots_are_wanted_from_the_step_that_asks_until_one_that_asks_anew() {
    let abaqus = |first, last| requests(first, last, Dialect::Abaqus);
    assert_eq!(abaqus("", ""), [None, None, None]);
    assert_eq!(abaqus("", "*RESTART, WRITE\n"), [None, None, every(1)]);
    assert_eq!(abaqus("*RESTART, WRITE, FREQUENCY=3\n", ""), [every(3); 3]);
    let overlay = Some(RestartRequest { frequency: RestartFrequency::Increments(2), overlay: true });
    assert_eq!(
        abaqus("*RESTART, WRITE, FREQ=2, OVERLAY\n", "*RESTART, WRITE, FREQUENCY=0\n"),
        [overlay, overlay, None]
    );
}

#[test]
fn a_request_of_the_model_part_holds_from_the_first_step_on() {
    let text = with("*STEP", "*RESTART, WRITE, FREQUENCY=4\n*STEP");
    assert_eq!(model(&text).steps[0].output.restart, every(4));
    refuses(&with("*END STEP\n", "*END STEP\n*RESTART, WRITE\n"), "*RESTART", "behind a step");
}

#[test]
fn calculix_counts_steps() {
    let end = Some(RestartRequest { frequency: RestartFrequency::StepEnd, overlay: false });
    let calculix = |first| requests(first, "", Dialect::Calculix);
    assert_eq!(calculix("*RESTART, WRITE\n"), [end; 3]);
    assert_eq!(calculix("*RESTART, WRITE, FREQUENCY=2\n"), [None, end, None]);
    assert_eq!(calculix("*RESTART, WRITE, FREQUENCY=3\n"), [None, None, end]);
}

#[test]
fn parts_of_the_step_are_counted_in_both_dialects() {
    let thirds = Some(RestartRequest { frequency: RestartFrequency::Intervals(3), overlay: false });
    for dialect in [Dialect::Abaqus, Dialect::Calculix] {
        assert_eq!(requests("*RESTART, WRITE, NUMBER INTERVAL=3\n", "", dialect), [thirds; 3]);
    }
}

#[test]
fn what_is_no_request_for_snapshots_is_refused() {
    let in_step = |card: &str| with("*END STEP", &format!("{card}*END STEP"));
    refuses(&in_step("*RESTART\n"), "*RESTART", "WRITE is missing");
    refuses(&in_step("*RESTART, WRITE, FREQUENCY=often\n"), "*RESTART", "not a whole number");
    refuses(&in_step("*RESTART, WRITE\n5\n"), "*RESTART", "takes no data lines");
    warns(&in_step("*RESTART, WRITE, NUMBER INTERVAL=3, TIME MARKS=YES\n"), "*RESTART", "TIME MARKS=YES is ignored");
    refuses(&in_step("*RESTART, WRITE, NUMBER INTERVAL=0\n"), "*RESTART", "not a whole number above 0");
    refuses(&in_step("*RESTART, WRITE, NUMBER INTERVAL=2, FREQUENCY=2\n"), "*RESTART", "exclude each other");
    let reading = format!("*RESTART, READ, STEP=2, INC=5\n{BASE}");
    refuses(&reading, "*RESTART", "READ is not supported");
    let found = read(&reading).diagnostics;
    assert!(found.len() == 1 && found[0].remedy.contains("--restart FILE"), "{}", listing(&found));
}

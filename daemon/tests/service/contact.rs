//! Laws and contact states through the Rust client and a stock tool.

use overclosure_client::{LawReply, LawRequest, OpenRequest, Parameter, StepRequest};

use crate::support::Daemon;

/// Deck of the laws document: a point of area 2 on a spring of stiffness 100 whose end goes down to 0.03 at time 11.
const HARD: &str = include_str!("../../../docs/laws/decks/hard.inp");
const BEHAVIOR: &str = "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n";

fn with(behavior: &str) -> String {
    assert!(HARD.contains(BEHAVIOR));
    HARD.replace(BEHAVIOR, behavior)
}

fn law(daemon: &Daemon, kind: &str, parameters: &[(&str, &str)], overclosure: &[f64]) -> LawReply {
    let parameters =
        parameters.iter().map(|&(name, value)| Parameter { name: name.into(), value: value.into() }).collect();
    daemon.client().law(&LawRequest { kind: kind.into(), parameters, overclosure: overclosure.to_vec() }).unwrap()
}

#[test]
fn penalties_and_damping_are_evaluated_for_every_client() {
    let daemon = Daemon::start();
    let kinds = daemon.client().info().law_kinds.clone();
    for kind in ["penalty", "nonlinear-penalty", "augmented-lagrange", "damping"] {
        assert!(kinds.iter().any(|k| k == kind), "{kind} is missing in {kinds:?}");
    }
    let penalty = law(&daemon, "penalty", &[("stiffness", "4"), ("c0", "0.5")], &[-1.0, 0.5]);
    assert_eq!((penalty.pressure, penalty.energy), (vec![0.0, 4.0], vec![0.0, 2.0]));
    let nonlinear = law(&daemon, "nonlinear-penalty", &[("ki", "1"), ("kf", "3"), ("d", "1"), ("e", "2")], &[1.5, 4.0]);
    assert_eq!((nonlinear.pressure, nonlinear.stiffness), (vec![1.75, 9.0], vec![2.0, 3.0]));
    let augmented = law(&daemon, "augmented-lagrange", &[("k", "4"), ("lambda", "2")], &[-0.25, 0.5]);
    assert_eq!(augmented.pressure, [1.0, 4.0]);
    assert!(augmented.coefficient.is_empty());

    let damping = law(&daemon, "damping", &[("mu0", "8"), ("c0", "0.5"), ("eta", "0.5")], &[0.1, -0.375, -1.0]);
    assert_eq!(
        (&damping.coefficient[..], &damping.coefficient_slope[..]),
        (&[8.0, 4.0, 0.0][..], &[0.0, 32.0, 0.0][..])
    );
    assert!(damping.pressure.is_empty());
    let json = daemon.raw().json("overclosure/v1/*/law?kind=damping;mu0=8;c0=0.5;eta=0.5;at=0.1,-0.375,-1");
    assert_eq!(json["coefficient"], serde_json::json!([8.0, 4.0, 0.0]));
    assert_eq!(json["pressure"], serde_json::json!([]));
}

#[test]
fn a_step_tells_its_augmentations_and_a_field_the_statuses() {
    let daemon = Daemon::start();
    let client = daemon.client();
    let open = |deck: String| client.open(OpenRequest { deck, ..OpenRequest::default() }).unwrap();
    let control = "*CONTACT CONTROLS, ABSOLUTE PENETRATION TOLERANCE=1e-4\n*BOUNDARY, AMPLITUDE";
    let augmented = with("*SURFACE BEHAVIOR, AUGMENTED LAGRANGE\n150.,\n").replace("*BOUNDARY, AMPLITUDE", control);
    let mut session = open(augmented);
    let mut sum = 0;
    for time in 1..=11 {
        sum += session.step(StepRequest { time: time.into(), ..StepRequest::default() }).unwrap().counts.augmentations;
        assert!(-session.field("COPEN").unwrap().values[0] <= 1e-4, "at {time}");
    }
    assert!(sum > 0);
    assert_eq!(session.report().unwrap().steps[0].counts.augmentations, sum);
    assert_eq!(session.field("CSTATUS").unwrap().values, [1.0]);

    let mut damped = open(with(&format!("{BEHAVIOR}*CONTACT DAMPING\n8., 0.1, 0.4\n")));
    damped.step(StepRequest { time: 2.0, ..StepRequest::default() }).unwrap();
    assert_eq!(damped.field("CSTATUS").unwrap().values, [4.0], "open, with a viscous pressure");
    // The spring, 100, against the dashpot, 16, over two increments of 1; its end goes to -0.02, then to -0.015.
    let first = 100.0 * -0.02 / 116.0;
    let second = (100.0 * -0.015 + 16.0 * first) / 116.0;
    let pressure = damped.field("CPRESS").unwrap().values[0];
    assert!((pressure - 8.0 * (second - first)).abs() < 1e-12, "{pressure}");
}

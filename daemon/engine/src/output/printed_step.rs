//! Headings of steps in `JOB.dat`: the procedure and its data, and the summary of each increment.

use std::fmt::Write;

use super::number::printed;
use crate::model::{
    DynamicControl, ExplicitControl, ExplicitIncrements, HalfIncrement, MassMatrix, MassScalingKind, Procedure, Step,
};
use crate::simulation::IncrementReport;

/// Appends the heading of a step.
pub(super) fn step_heading(text: &mut String, step: &Step, increment: &IncrementReport) {
    let procedure = match step.procedure {
        Procedure::Static(_) => "STATIC ANALYSIS",
        Procedure::Dynamic(_) => "DYNAMIC ANALYSIS",
        Procedure::Explicit(_) => "EXPLICIT DYNAMIC ANALYSIS",
    };
    let spaced: String = procedure.chars().flat_map(|c| [c, ' ']).collect();
    // Writing to a string does not fail, here and below.
    let _ = writeln!(text, "\n\n                    S T E P   {:>5}     {spaced}\n\n   {}", increment.step, step.name);
    let facts = match &step.procedure {
        Procedure::Static(_) => return,
        Procedure::Dynamic(control) => implicit(control),
        Procedure::Explicit(control) => explicit(control),
    };
    text.push('\n');
    for (what, value) in facts {
        let _ = writeln!(text, "   {what:<50}{value}");
    }
}

type Fact = (&'static str, String);

fn implicit(control: &DynamicControl) -> Vec<Fact> {
    let mut facts: Vec<Fact> = vec![
        (
            if control.direct { "FIXED TIME INCREMENT" } else { "INITIAL TIME INCREMENT" },
            printed(control.increment_initial),
        ),
        ("TIME PERIOD", printed(control.period)),
    ];
    if !control.direct {
        facts.push(("SMALLEST TIME INCREMENT", printed(control.increment_min)));
        facts.push(("LARGEST TIME INCREMENT", printed(control.increment_max)));
        facts.push(match control.half_increment {
            HalfIncrement::Unchecked => ("HALF-INCREMENT RESIDUAL", format!("{:>15}", "NOT CHECKED")),
            HalfIncrement::Force(force) => ("LARGEST HALF-INCREMENT RESIDUAL (FORCE)", printed(force)),
            HalfIncrement::Relative(factor) => ("HALF-INCREMENT RESIDUAL OVER LARGEST FORCE", printed(factor)),
        });
    }
    let mass = match control.mass {
        MassMatrix::ByOrder => "BY ORDER",
        MassMatrix::Lumped => "LUMPED",
        MassMatrix::Consistent => "CONSISTENT",
    };
    facts.push(("HHT OPERATOR, ALPHA", printed(control.alpha)));
    facts.push(("MASS MATRIX", format!("{mass:>15}")));
    facts
}

fn explicit(control: &ExplicitControl) -> Vec<Fact> {
    let mut facts: Vec<Fact> = vec![match control.increments {
        ExplicitIncrements::Automatic { scale } => ("STABLE TIME INCREMENTS TIMES", printed(scale)),
        ExplicitIncrements::Direct(size) => ("FIXED TIME INCREMENT", printed(size)),
    }];
    facts.push(("TIME PERIOD", printed(control.period)));
    facts.extend(control.increment_max.map(|size| ("LARGEST TIME INCREMENT", printed(size))));
    let [linear, quadratic] = control.bulk_viscosity;
    facts.push(("LINEAR BULK VISCOSITY", printed(linear)));
    facts.push(("QUADRATIC BULK VISCOSITY", printed(quadratic)));
    facts.extend(control.mass_scaling.iter().map(|scaling| match scaling.kind {
        MassScalingKind::Factor(factor) => ("FIXED MASS SCALING BY THE FACTOR", printed(factor)),
        MassScalingKind::Uniform(size) => ("FIXED MASS SCALING, UNIFORM, TO THE INCREMENT", printed(size)),
        MassScalingKind::BelowMin(size) => ("FIXED MASS SCALING BELOW THE INCREMENT", printed(size)),
        MassScalingKind::SetEqual(size) => ("FIXED MASS SCALING OF EACH ELEMENT TO THE INCREMENT", printed(size)),
    }));
    facts
}

/// Appends the summary of an increment.
pub(super) fn summary(text: &mut String, step: &Step, increment: &IncrementReport) {
    let _ = writeln!(text, "\n\n                              INCREMENT {:>5} SUMMARY\n", increment.increment);
    let pair = |text: &mut String, a: &str, x: f64, b: &str, y: f64| {
        let _ = writeln!(text, " {a:<26}{},  {b:<28}{}", printed(x), printed(y));
    };
    let fraction = increment.step_time / step.procedure.period();
    pair(text, "TIME INCREMENT COMPLETED", increment.increment_size, "FRACTION OF STEP COMPLETED", fraction);
    pair(text, "STEP TIME COMPLETED", increment.step_time, "TOTAL TIME COMPLETED", increment.time);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostic::Place;
    use crate::model::{MassScaling, OutputRequests};

    fn heading(procedure: Procedure) -> Vec<String> {
        let step = Step {
            name: "Blow".into(),
            increments_max: 100,
            procedure,
            default_amplitude: Default::default(),
            boundaries: Vec::new(),
            loads: Vec::new(),
            loads_removed: Default::default(),
            contact: Default::default(),
            output: OutputRequests::default(),
            place: Place::nowhere(),
        };
        let mut text = String::new();
        step_heading(&mut text, &step, &IncrementReport { step: 2, ..Default::default() });
        text.lines()
            .map(|line| line.split_whitespace().collect::<Vec<_>>().join(" "))
            .filter(|l| !l.is_empty())
            .collect()
    }

    #[test]
    fn a_heading_says_what_the_step_does() {
        let control = DynamicControl {
            increment_initial: 0.25,
            period: 2.0,
            increment_min: 1e-5,
            increment_max: 0.5,
            direct: false,
            alpha: -0.05,
            half_increment: HalfIncrement::Force(20.0),
            initial_accelerations: true,
            mass: MassMatrix::Lumped,
        };
        let lines = heading(Procedure::Dynamic(control));
        assert_eq!(lines[0], "S T E P 2 D Y N A M I C A N A L Y S I S");
        for line in ["INITIAL TIME INCREMENT 2.500000E-01", "HHT OPERATOR, ALPHA -5.000000E-02", "MASS MATRIX LUMPED"] {
            assert!(lines.iter().any(|l| l == line), "{line} is missing in {lines:?}");
        }
        let fixed = heading(Procedure::Dynamic(DynamicControl { direct: true, ..control }));
        assert!(
            fixed.contains(&"FIXED TIME INCREMENT 2.500000E-01".into()) && fixed.len() == lines.len() - 3,
            "{fixed:?}"
        );
        let scaling = MassScaling { element_set: None, kind: MassScalingKind::Factor(4.0) };
        let lines = heading(Procedure::Explicit(ExplicitControl {
            period: 1.0,
            increments: ExplicitIncrements::Automatic { scale: 0.5 },
            increment_max: None,
            bulk_viscosity: [0.06, 1.2],
            mass_scaling: vec![scaling],
        }));
        for line in ["STABLE TIME INCREMENTS TIMES 5.000000E-01", "FIXED MASS SCALING BY THE FACTOR 4.000000E+00"] {
            assert!(lines.iter().any(|l| l == line), "{line} is missing in {lines:?}");
        }
    }
}

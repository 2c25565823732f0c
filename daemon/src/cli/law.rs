//! `overclosure law`: a pressure-overclosure relationship, or contact damping, as a table.

use std::io::Write;

use clap::Args;
use overclosure::law::{self, Damping, PressureLaw, Relationship};

use super::{Exit, closed, complain};

/// Rows that one call may ask for; beyond it a mistyped step is likelier than a wish.
const ROWS_MAX: f64 = 1e8;

/// Arguments of `overclosure law`.
#[derive(Args)]
#[command(after_help = "\
Kinds and parameters, with their short names; [optional]:
  linear                stiffness (k)
  tabular               table=p1:h1,p2:h2,...   pressure:overclosure, both increasing, the first pressure 0
  exponential           clearance_at_zero_pressure (c0), pressure_at_zero_clearance (p0), [stiffness_max (kmax)]
  calculix-exponential  clearance (c0), pressure (p0)
  penalty               stiffness (k), [clearance_at_zero_pressure (c0)]
  nonlinear-penalty     stiffness_initial (ki), stiffness_final (kf), lower (d), upper (e), [clearance_at_zero_pressure (c0)]
  augmented-lagrange    stiffness (k), multiplier (lambda), [clearance_at_zero_pressure (c0)]
  damping               coefficient (mu0), clearance (c0), [fraction (eta)]
and for all but damping: separation=allowed|prevented, procedure=standard|explicit.

Overclosure is positive when the bodies overlap. Columns: overclosure, pressure, stiffness (its slope), energy (its integral);
for damping: overclosure, coefficient (viscous pressure per closing speed), slope (of the coefficient over the overclosure).")]
pub struct LawArgs {
    /// linear, tabular, exponential, calculix-exponential, penalty, nonlinear-penalty, augmented-lagrange or damping.
    kind: String,
    /// Parameters of the law.
    #[arg(long = "param", short = 'p', value_name = "NAME=VALUE", num_args = 1..)]
    parameters: Vec<String>,
    /// Overclosures: FROM:TO:STEP (TO included) or h1,h2,...
    #[arg(long, value_name = "OVERCLOSURES", allow_hyphen_values = true, required_unless_present = "at_pressure")]
    at: Option<String>,
    /// Instead of overclosures, pressures: each row is where the law transmits that pressure (its inverse).
    #[arg(long, value_name = "PRESSURES", allow_hyphen_values = true, conflicts_with = "at")]
    at_pressure: Option<String>,
}

/// Runs the verb.
pub fn run(arguments: LawArgs) -> Exit {
    let mut complaints = Vec::new();
    let mut pairs = Vec::new();
    for parameter in &arguments.parameters {
        match parameter.split_once('=') {
            Some(pair) => pairs.push(pair),
            None => complaints.push(format!("--param {parameter}: not of the form NAME=VALUE")),
        }
    }
    let relationship = law::read(&arguments.kind, &pairs);
    if let Err(errors) = &relationship {
        complaints.extend(errors.0.iter().map(ToString::to_string));
    }
    let (option, text) = match (&arguments.at, &arguments.at_pressure) {
        (Some(at), _) => ("--at", at.as_str()),
        (None, Some(at)) => ("--at-pressure", at.as_str()),
        (None, None) => ("--at", ""),
    };
    let places = Places::parse(text);
    if let Err(complaint) = &places {
        complaints.push(format!("{option} {text}: {complaint}"));
    }
    let inverse = arguments.at.is_none();
    if inverse && matches!(relationship, Ok(Relationship::Damping(_))) {
        complaints.push("--at-pressure: contact damping has no pressure of its own; give --at".to_owned());
    }
    let (Ok(relationship), Ok(places), true) = (relationship, places, complaints.is_empty()) else {
        for complaint in complaints {
            complain(&format!("error: {complaint}"));
        }
        return Exit::InputWrong;
    };
    let written = match relationship {
        Relationship::Pressure(spec) => spec.resolve().map(|law| write_law(&law, &places, inverse)),
        Relationship::Damping(spec) => spec.resolve().map(|damping| write_damping(damping, &places)),
    };
    match written {
        Ok(Ok(())) => Exit::Done,
        Ok(Err(error)) => closed(&error),
        Err(errors) => {
            complain(&format!("error: {errors}"));
            Exit::InputWrong
        }
    }
}

fn write_law(law: &dyn PressureLaw, places: &Places, inverse: bool) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    writeln!(out, "overclosure,pressure,stiffness,energy")?;
    for i in 0..places.count() {
        let h = if inverse { law.overclosure_at(places.at(i)) } else { places.at(i) };
        let point = law.evaluate(h);
        writeln!(out, "{h:.16e},{:.16e},{:.16e},{:.16e}", point.pressure, point.stiffness, point.energy)?;
    }
    out.flush()
}

fn write_damping(damping: Damping, places: &Places) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    writeln!(out, "overclosure,coefficient,slope")?;
    for i in 0..places.count() {
        let h = places.at(i);
        let (coefficient, slope) = damping.at(h);
        writeln!(out, "{h:.16e},{coefficient:.16e},{slope:.16e}")?;
    }
    out.flush()
}

/// What `--at` or `--at-pressure` asks for.
#[derive(Debug, PartialEq)]
enum Places {
    Range { from: f64, step: f64, count: usize },
    List(Vec<f64>),
}

impl Places {
    fn parse(text: &str) -> Result<Self, String> {
        if !text.contains(':') {
            let list = text.split(',').map(number).collect::<Result<_, _>>()?;
            return Ok(Self::List(list));
        }
        let parts = text.split(':').map(number).collect::<Result<Vec<f64>, _>>()?;
        let [from, to, step] = parts[..] else {
            return Err(format!("a range is FROM:TO:STEP, this one has {} parts", parts.len()));
        };
        let steps = (to - from) / step;
        if step == 0.0 || steps < 0.0 {
            return Err(format!("a step of {step} does not lead from {from} to {to}"));
        }
        // TO counts as reached when it is missed by rounding alone.
        let rows = (steps * (1.0 + 1e-12) + 1e-9).floor() + 1.0;
        if rows.is_nan() || rows > ROWS_MAX {
            return Err(format!("that is {rows:e} rows; at most {ROWS_MAX:e} are written"));
        }
        Ok(Self::Range { from, step, count: rows as usize })
    }

    fn count(&self) -> usize {
        match self {
            Self::Range { count, .. } => *count,
            Self::List(list) => list.len(),
        }
    }

    fn at(&self, i: usize) -> f64 {
        match self {
            Self::Range { from, step, .. } => from + i as f64 * step,
            Self::List(list) => list[i],
        }
    }
}

fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) | Err(_) => Err(format!("{:?} is not a finite number", text.trim())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_includes_its_end_within_rounding() {
        for (text, count) in [("0:1:0.1", 11), ("-0.01:0.03:0.01", 5), ("0:1:0.3", 4), ("1:0:-0.5", 3), ("2:2:1", 1)] {
            assert_eq!(Places::parse(text).unwrap().count(), count, "{text}");
        }
        let range = Places::parse("-1:1:0.1").unwrap();
        assert_eq!(range.at(7), -1.0 + 7.0 * 0.1);
    }

    #[test]
    fn a_list_keeps_its_numbers() {
        assert_eq!(Places::parse("-0.005,0, 1e300").unwrap(), Places::List(vec![-0.005, 0.0, 1e300]));
    }

    #[test]
    fn nonsense_is_refused() {
        for text in ["", "a", "0:1", "0:1:0", "0:1:-1", "0:1:1e-12", "nan", "0:inf:1", "1,,2", "0:1:1:1"] {
            assert!(Places::parse(text).is_err(), "{text}");
        }
    }
}

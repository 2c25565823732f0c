//! `overclosure law`: a pressure-overclosure relationship as a table.

use std::io::Write;

use clap::Args;
use overclosure::law::{LawSpec, PressureLaw};

use super::{Exit, closed, complain};

/// Rows that one call may ask for; beyond it a mistyped step is likelier than a wish.
const ROWS_MAX: f64 = 1e8;

/// Arguments of `overclosure law`.
#[derive(Args)]
#[command(after_help = "\
Kinds and parameters, with their short names:
  linear                stiffness (k)
  tabular               table=p1:h1,p2:h2,...   pressure:overclosure, both increasing, the first pressure 0
  exponential           clearance_at_zero_pressure (c0), pressure_at_zero_clearance (p0), [stiffness_max (kmax)]
  calculix-exponential  clearance (c0), pressure (p0)
and for all: separation=allowed|prevented, procedure=standard|explicit.

Overclosure is positive when the bodies overlap. Columns: overclosure, pressure, stiffness (its slope), energy (its integral).")]
pub struct LawArgs {
    /// linear, tabular, exponential or calculix-exponential.
    kind: String,
    /// Parameters of the law.
    #[arg(long = "param", short = 'p', value_name = "NAME=VALUE", num_args = 1..)]
    parameters: Vec<String>,
    /// Overclosures: FROM:TO:STEP (TO included) or h1,h2,...
    #[arg(long, value_name = "OVERCLOSURES", allow_hyphen_values = true)]
    at: String,
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
    let law = LawSpec::read(&arguments.kind, &pairs);
    if let Err(errors) = &law {
        complaints.extend(errors.0.iter().map(ToString::to_string));
    }
    let overclosures = Overclosures::parse(&arguments.at);
    if let Err(complaint) = &overclosures {
        complaints.push(format!("--at {}: {complaint}", arguments.at));
    }
    match (law, overclosures) {
        (Ok(law), Ok(overclosures)) if complaints.is_empty() => match write(&law, &overclosures) {
            Ok(()) => Exit::Done,
            Err(error) => closed(&error),
        },
        _ => {
            for complaint in complaints {
                complain(&format!("error: {complaint}"));
            }
            Exit::InputWrong
        }
    }
}

fn write(law: &dyn PressureLaw, overclosures: &Overclosures) -> std::io::Result<()> {
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    writeln!(out, "overclosure,pressure,stiffness,energy")?;
    for i in 0..overclosures.count() {
        let h = overclosures.at(i);
        let point = law.evaluate(h);
        writeln!(out, "{h:.16e},{:.16e},{:.16e},{:.16e}", point.pressure, point.stiffness, point.energy)?;
    }
    out.flush()
}

/// What `--at` asks for.
#[derive(Debug, PartialEq)]
enum Overclosures {
    Range { from: f64, step: f64, count: usize },
    List(Vec<f64>),
}

impl Overclosures {
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
            assert_eq!(Overclosures::parse(text).unwrap().count(), count, "{text}");
        }
        let range = Overclosures::parse("-1:1:0.1").unwrap();
        assert_eq!(range.at(7), -1.0 + 7.0 * 0.1);
    }

    #[test]
    fn a_list_keeps_its_numbers() {
        assert_eq!(Overclosures::parse("-0.005,0, 1e300").unwrap(), Overclosures::List(vec![-0.005, 0.0, 1e300]));
    }

    #[test]
    fn nonsense_is_refused() {
        for text in ["", "a", "0:1", "0:1:0", "0:1:-1", "0:1:1e-12", "nan", "0:inf:1", "1,,2", "0:1:1:1"] {
            assert!(Overclosures::parse(text).is_err(), "{text}");
        }
    }
}

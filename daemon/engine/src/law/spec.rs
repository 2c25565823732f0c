//! A law in words: a kind and `name=value` pairs, as on the command line, in a request or in a parameter file.
//!
//! Names are those of the documentation; the manual's short names stand beside them. Case, `-`, `_` and blanks in kinds,
//! names and choices make no difference. Every fault is found at once.

use super::resolved::refusal;
use super::{LawError, LawParameters, LawProcedure, PressureOverclosure, ResolvedLaw, Separation};

/// A law with its options, not yet checked against each other.
#[derive(Clone, Debug, PartialEq)]
pub struct LawSpec {
    /// Kind and numbers.
    pub parameters: LawParameters,
    /// Default: allowed.
    pub separation: Separation,
    /// Default: standard, unless `stiffness_max` is given, which only Abaqus/Explicit has.
    pub procedure: LawProcedure,
}

/// One thing wrong with a law in words.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LawSpecError {
    /// No such law.
    #[error("unknown law kind {kind:?}; kinds are linear, tabular, exponential and calculix-exponential")]
    UnknownKind {
        /// As given.
        kind: String,
    },
    /// Hard contact is a constraint.
    #[error(
        "hard contact has no pressure-overclosure curve: it allows no overclosure and transmits any pressure; \
         it is a constraint that only a deck can solve"
    )]
    HardHasNoCurve,
    /// A name that the law does not have.
    #[error("the {kind} law has no parameter {name:?}; it takes {known}")]
    UnknownParameter {
        /// Kind of law.
        kind: &'static str,
        /// As given.
        name: String,
        /// What there is.
        known: String,
    },
    /// A parameter that the law needs.
    #[error("the {kind} law needs {name}")]
    MissingParameter {
        /// Kind of law.
        kind: &'static str,
        /// Name, with its short name.
        name: String,
    },
    /// The same parameter twice.
    #[error("{name} is given more than once")]
    Repeated {
        /// Name.
        name: &'static str,
    },
    /// Text where a number should be.
    #[error("{name}: {text:?} is not a number")]
    NotANumber {
        /// Name.
        name: &'static str,
        /// As given.
        text: String,
    },
    /// A table that cannot be read.
    #[error("table point {row}: {text:?} is not of the form pressure:overclosure")]
    TablePoint {
        /// Number of the point, from 1.
        row: usize,
        /// As given.
        text: String,
    },
    /// A word that is not among the choices.
    #[error("{name}: {text:?} is neither {choices}")]
    UnknownChoice {
        /// Name.
        name: &'static str,
        /// As given.
        text: String,
        /// What there is.
        choices: &'static str,
    },
    /// A parameter out of its domain.
    #[error(transparent)]
    Law(#[from] LawError),
    /// No separation in Standard.
    #[error(
        "separation=prevented cannot be combined with a softened law in Abaqus/Standard, where it is for hard contact only; \
         procedure=explicit has it for the linear and the tabular law"
    )]
    SeparationPreventedStandard,
    /// No separation with the exponential law.
    #[error(
        "separation=prevented cannot be combined with an exponential law: its curve has no continuation into tension"
    )]
    SeparationPreventedExponential,
    /// A stiffness limit in Standard.
    #[error(
        "stiffness_max belongs to procedure=explicit; Abaqus/Standard limits the slope beyond an overclosure of 6 c0 instead"
    )]
    StiffnessMaxNeedsExplicit,
}

/// Everything that is wrong with a law in words; never empty. Displayed one per line.
#[derive(Clone, Debug, PartialEq)]
pub struct LawSpecErrors(pub Vec<LawSpecError>);

impl std::fmt::Display for LawSpecErrors {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (i, error) in self.0.iter().enumerate() {
            let separator = if i == 0 { "" } else { "\n" };
            write!(f, "{separator}{error}")?;
        }
        Ok(())
    }
}

impl std::error::Error for LawSpecErrors {}

impl LawSpec {
    /// Reads a kind and pairs (name, value).
    pub fn parse<N: AsRef<str>, V: AsRef<str>>(kind: &str, pairs: &[(N, V)]) -> Result<Self, LawSpecErrors> {
        let kind = Kind::parse(kind).map_err(|error| LawSpecErrors(vec![error]))?;
        let mut reader = Reader { kind, values: Vec::new(), errors: Vec::new() };
        for (name, value) in pairs {
            reader.take(name.as_ref(), value.as_ref());
        }
        reader.finish()
    }

    /// Checks numbers and combination; every finding at once.
    pub fn resolve(&self) -> Result<ResolvedLaw, LawSpecErrors> {
        let violations = self.parameters.violations();
        if !violations.is_empty() {
            return Err(LawSpecErrors(violations.into_iter().map(LawSpecError::Law).collect()));
        }
        PressureOverclosure::try_from(self.parameters.clone())
            .map_err(LawSpecError::Law)
            .and_then(|law| ResolvedLaw::new(law, self.separation, self.procedure))
            .map_err(|error| LawSpecErrors(vec![error]))
    }

    /// [`LawSpec::parse`], then [`LawSpec::resolve`].
    pub fn read<N: AsRef<str>, V: AsRef<str>>(kind: &str, pairs: &[(N, V)]) -> Result<ResolvedLaw, LawSpecErrors> {
        Self::parse(kind, pairs)?.resolve()
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Linear,
    Tabular,
    Exponential,
    CalculixExponential,
}

/// A parameter: its name and the manual's short name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Name {
    long: &'static str,
    short: &'static str,
    required: bool,
}

const fn required(long: &'static str, short: &'static str) -> Name {
    Name { long, short, required: true }
}

const fn optional(long: &'static str, short: &'static str) -> Name {
    Name { long, short, required: false }
}

const SEPARATION: Name = optional("separation", "separation");
const PROCEDURE: Name = optional("procedure", "procedure");
const STIFFNESS: Name = required("stiffness", "k");
const TABLE: Name = required("table", "table");
const CLEARANCE: Name = required("clearance_at_zero_pressure", "c0");
const PRESSURE: Name = required("pressure_at_zero_clearance", "p0");
const STIFFNESS_MAX: Name = optional("stiffness_max", "kmax");
const CALCULIX_CLEARANCE: Name = required("clearance", "c0");
const CALCULIX_PRESSURE: Name = required("pressure", "p0");

impl Kind {
    fn parse(text: &str) -> Result<Self, LawSpecError> {
        match plain(text).as_str() {
            "linear" => Ok(Self::Linear),
            "tabular" => Ok(Self::Tabular),
            "exponential" => Ok(Self::Exponential),
            "calculixexponential" => Ok(Self::CalculixExponential),
            "hard" => Err(LawSpecError::HardHasNoCurve),
            _ => Err(LawSpecError::UnknownKind { kind: text.to_owned() }),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Tabular => "tabular",
            Self::Exponential => "exponential",
            Self::CalculixExponential => "calculix-exponential",
        }
    }

    fn parameters(self) -> &'static [Name] {
        match self {
            Self::Linear => &[STIFFNESS, SEPARATION, PROCEDURE],
            Self::Tabular => &[TABLE, SEPARATION, PROCEDURE],
            Self::Exponential => &[CLEARANCE, PRESSURE, STIFFNESS_MAX, SEPARATION, PROCEDURE],
            Self::CalculixExponential => &[CALCULIX_CLEARANCE, CALCULIX_PRESSURE, SEPARATION, PROCEDURE],
        }
    }
}

/// Collects values by name, then makes the specification of them.
struct Reader {
    kind: Kind,
    values: Vec<(Name, String)>,
    errors: Vec<LawSpecError>,
}

impl Reader {
    fn take(&mut self, name: &str, value: &str) {
        let key = plain(name);
        let known = self.kind.parameters();
        match known.iter().find(|n| key == plain(n.long) || key == n.short) {
            None => self.errors.push(LawSpecError::UnknownParameter {
                kind: self.kind.name(),
                name: name.to_owned(),
                known: known.iter().map(|n| described(*n)).collect::<Vec<_>>().join(", "),
            }),
            Some(&found) if self.values.iter().any(|(n, _)| *n == found) => {
                self.errors.push(LawSpecError::Repeated { name: found.long });
            }
            Some(&found) => self.values.push((found, value.trim().to_owned())),
        }
    }

    fn finish(mut self) -> Result<LawSpec, LawSpecErrors> {
        for name in self.kind.parameters().iter().filter(|n| n.required) {
            if self.text(*name).is_none() {
                self.errors.push(LawSpecError::MissingParameter { kind: self.kind.name(), name: described(*name) });
            }
        }
        let parameters = self.parameters();
        let separation = self.choice(
            SEPARATION,
            &[("allowed", Separation::Allowed), ("prevented", Separation::Prevented)],
            "allowed nor prevented",
        );
        let procedure = self.choice(
            PROCEDURE,
            &[("standard", LawProcedure::Standard), ("explicit", LawProcedure::Explicit)],
            "standard nor explicit",
        );
        if !self.errors.is_empty() {
            // What can be said about the numbers that were read is said too.
            if let Some(parameters) = &parameters {
                self.errors.extend(parameters.violations().into_iter().map(LawSpecError::Law));
            }
            return Err(LawSpecErrors(self.errors));
        }
        let Some(parameters) = parameters else {
            return Err(LawSpecErrors(self.errors));
        };
        let limited = matches!(parameters, LawParameters::Exponential { stiffness_max: Some(_), .. });
        let unnamed = if limited { LawProcedure::Explicit } else { LawProcedure::Standard };
        let spec =
            LawSpec { parameters, separation: separation.unwrap_or_default(), procedure: procedure.unwrap_or(unnamed) };
        let mut findings: Vec<LawSpecError> = spec.parameters.violations().into_iter().map(LawSpecError::Law).collect();
        if let Ok(law) = PressureOverclosure::try_from(spec.parameters.clone()) {
            findings.extend(refusal(&law, spec.separation, spec.procedure));
        }
        if findings.is_empty() { Ok(spec) } else { Err(LawSpecErrors(findings)) }
    }

    fn parameters(&mut self) -> Option<LawParameters> {
        Some(match self.kind {
            Kind::Linear => LawParameters::Linear { stiffness: self.number(STIFFNESS)? },
            Kind::Tabular => LawParameters::Tabular { points: self.table()? },
            Kind::Exponential => {
                let (c0, p0) = (self.number(CLEARANCE), self.number(PRESSURE));
                let limited = self.text(STIFFNESS_MAX).is_some();
                let limit = self.number(STIFFNESS_MAX);
                if limited && limit.is_none() {
                    return None;
                }
                LawParameters::Exponential {
                    clearance_at_zero_pressure: c0?,
                    pressure_at_zero_clearance: p0?,
                    stiffness_max: limit,
                }
            }
            Kind::CalculixExponential => {
                let (c0, p0) = (self.number(CALCULIX_CLEARANCE), self.number(CALCULIX_PRESSURE));
                LawParameters::CalculixExponential { clearance: c0?, pressure: p0? }
            }
        })
    }

    fn text(&self, name: Name) -> Option<&str> {
        self.values.iter().find(|(n, _)| *n == name).map(|(_, text)| text.as_str())
    }

    fn number(&mut self, name: Name) -> Option<f64> {
        let text = self.text(name)?.to_owned();
        let number = text.parse().ok();
        if number.is_none() {
            self.errors.push(LawSpecError::NotANumber { name: name.long, text });
        }
        number
    }

    /// `p1:h1,p2:h2,...`
    fn table(&mut self) -> Option<Vec<(f64, f64)>> {
        let text = self.text(TABLE)?.to_owned();
        let before = self.errors.len();
        let mut points = Vec::new();
        for (row, pair) in (1..).zip(text.split(',').map(str::trim).filter(|pair| !pair.is_empty())) {
            let point = pair.split_once(':').and_then(|(p, h)| Some((p.trim().parse().ok()?, h.trim().parse().ok()?)));
            match point {
                Some(point) => points.push(point),
                None => self.errors.push(LawSpecError::TablePoint { row, text: pair.to_owned() }),
            }
        }
        (self.errors.len() == before).then_some(points)
    }

    fn choice<T: Copy>(&mut self, name: Name, choices: &[(&str, T)], words: &'static str) -> Option<T> {
        let text = self.text(name)?.to_owned();
        let found = choices.iter().find(|(word, _)| plain(&text) == *word).map(|(_, choice)| *choice);
        if found.is_none() {
            self.errors.push(LawSpecError::UnknownChoice { name: name.long, text, choices: words });
        }
        found
    }
}

/// `clearance_at_zero_pressure (c0)`, optional ones in brackets.
fn described(name: Name) -> String {
    let both = if name.long == name.short { name.long.to_owned() } else { format!("{} ({})", name.long, name.short) };
    if name.required { both } else { format!("[{both}]") }
}

/// Lower case without `-`, `_` and blanks.
fn plain(text: &str) -> String {
    text.chars().filter(|c| !matches!(c, '-' | '_' | ' ')).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::PressureLaw;

    fn errors(kind: &str, pairs: &[(&str, &str)]) -> String {
        LawSpec::read(kind, pairs).expect_err("this specification is wrong").to_string()
    }

    #[test]
    fn long_and_short_names_mean_the_same() {
        let long = [("clearance_at_zero_pressure", "0.01"), ("Pressure-At-Zero-Clearance", " 5 ")];
        let short = [("c0", "1e-2"), ("P0", "5.")];
        let law = LawSpec::read("Exponential", &long).unwrap();
        assert_eq!(law, LawSpec::read("EXPONENTIAL", &short).unwrap());
        assert_eq!(law.evaluate(0.0).pressure, 5.0);
        let calculix = LawSpec::read("calculix_exponential", &short).unwrap();
        assert_eq!(calculix.evaluate(0.0).pressure, 5.0);
        assert_eq!(LawSpec::read("linear", &[("k", "250")]).unwrap().evaluate(2.0).pressure, 500.0);
    }

    #[test]
    fn a_table_is_read_in_the_order_pressure_overclosure() {
        let law = LawSpec::read("tabular", &[("table", "0:-0.02, 3:0, 12:0.03")]).unwrap();
        assert_eq!(law.evaluate(0.0).pressure, 3.0);
    }

    #[test]
    fn a_stiffness_limit_means_explicit_unless_standard_is_asked_for() {
        let pairs = [("c0", "0.01"), ("p0", "5"), ("kmax", "2e4")];
        assert_eq!(LawSpec::parse("exponential", &pairs).unwrap().procedure, LawProcedure::Explicit);
        let mut standard = pairs.to_vec();
        standard.push(("procedure", "standard"));
        assert!(errors("exponential", &standard).contains("stiffness_max belongs to procedure=explicit"));
    }

    #[test]
    fn separation_follows_the_manual() {
        let explicit = [("k", "250"), ("separation", "PREVENTED"), ("procedure", "explicit")];
        assert_eq!(LawSpec::read("linear", &explicit).unwrap().evaluate(-0.02).pressure, -5.0);
        assert!(errors("linear", &explicit[..2]).contains("hard contact only"));
        let exponential = [("c0", "1"), ("p0", "1"), ("separation", "prevented"), ("procedure", "explicit")];
        assert!(errors("exponential", &exponential).contains("cannot be combined with an exponential law"));
    }

    #[test]
    fn every_fault_is_reported_at_once() {
        let text = errors("exponential", &[("c0", "abc"), ("q", "1"), ("separation", "maybe"), ("c0", "2")]);
        for part in [
            "\"abc\" is not a number",
            "no parameter \"q\"",
            "more than once",
            "needs pressure_at_zero_clearance (p0)",
            "neither allowed nor prevented",
        ] {
            assert!(text.contains(part), "{part} is missing in:\n{text}");
        }
        assert_eq!(text.lines().count(), 5, "{text}");
        let text = errors("exponential", &[("c0", "-1"), ("p0", "0")]);
        assert_eq!(text.lines().count(), 2, "{text}");
        let text = errors("tabular", &[("table", "0:0,1,x:2")]);
        assert!(text.contains("table point 2") && text.contains("table point 3"), "{text}");
        assert!(errors("tabular", &[("table", "")]).contains("has 0"));
    }

    #[test]
    fn kinds_that_have_no_curve_are_refused() {
        assert!(errors("hard", &[]).contains("constraint"));
        assert!(errors("rubber", &[]).contains("linear, tabular, exponential"));
        assert!(errors("linear", &[("stiffness", "nan")]).contains("not NaN"));
    }
}

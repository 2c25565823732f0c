//! A law in words: a kind and `name=value` pairs, as on the command line, in a request or in a parameter file.
//!
//! Names are those of the documentation; the manual's short names stand beside them. Case, `-`, `_` and blanks in kinds,
//! names and choices make no difference. Every fault is found at once.

mod error;
mod kind;
mod reader;

pub use error::{LawSpecError, LawSpecErrors};
pub use kind::KINDS;

use kind::Kind;
use reader::Reader;

use super::error::{require, require_positive};
use super::{CurveParameters, Damping, LawError, LawProcedure, ResolvedLaw, Separation};

/// A law with its options, not yet checked against each other.
#[derive(Clone, Debug, PartialEq)]
pub struct LawSpec {
    /// Kind and numbers.
    pub parameters: CurveParameters,
    /// Default: allowed.
    pub separation: Separation,
    /// Default: standard, unless `stiffness_max` is given, which only Abaqus/Explicit has.
    pub procedure: LawProcedure,
}

/// Contact damping, not yet validated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DampingSpec {
    /// `mu0` \[pressure·time/length\], not negative.
    pub coefficient: f64,
    /// `c0` \[length\], positive.
    pub clearance: f64,
    /// `η`, from 0 to below 1; 0 unless given.
    pub fraction: f64,
}

/// What a kind and its parameters describe.
#[derive(Clone, Debug, PartialEq)]
pub enum Relationship {
    /// Pressure over overclosure.
    Pressure(LawSpec),
    /// Damping coefficient over clearance.
    Damping(DampingSpec),
}

/// Reads a kind of [`KINDS`] and pairs (name, value).
pub fn read<N: AsRef<str>, V: AsRef<str>>(kind: &str, pairs: &[(N, V)]) -> Result<Relationship, LawSpecErrors> {
    let kind = Kind::parse(kind).map_err(|error| LawSpecErrors(vec![error]))?;
    let mut reader = Reader::new(kind);
    for (name, value) in pairs {
        reader.take(name.as_ref(), value.as_ref());
    }
    reader.finish()
}

impl LawSpec {
    /// [`read`] where a pressure is wanted.
    pub fn parse<N: AsRef<str>, V: AsRef<str>>(kind: &str, pairs: &[(N, V)]) -> Result<Self, LawSpecErrors> {
        match read(kind, pairs)? {
            Relationship::Pressure(spec) => Ok(spec),
            Relationship::Damping(_) => Err(LawSpecErrors(vec![LawSpecError::DampingHasNoPressure])),
        }
    }

    /// Checks numbers and combination; every finding at once.
    pub fn resolve(&self) -> Result<ResolvedLaw, LawSpecErrors> {
        ResolvedLaw::new(&self.parameters, self.separation, self.procedure)
    }

    /// [`LawSpec::parse`], then [`LawSpec::resolve`].
    pub fn read<N: AsRef<str>, V: AsRef<str>>(kind: &str, pairs: &[(N, V)]) -> Result<ResolvedLaw, LawSpecErrors> {
        Self::parse(kind, pairs)?.resolve()
    }
}

impl DampingSpec {
    /// Everything that is wrong with the numbers.
    pub fn violations(&self) -> Vec<LawError> {
        let mut findings = Vec::new();
        let Self { coefficient, clearance, fraction } = *self;
        let bounds = "a finite number, zero or positive";
        require(&mut findings, "coefficient (mu0)", bounds, coefficient, coefficient >= 0.0);
        require_positive(&mut findings, "clearance (c0)", clearance);
        require(&mut findings, "fraction (eta)", "from 0 to below 1", fraction, (0.0..1.0).contains(&fraction));
        if findings.is_empty() {
            // The slope of the ramp is a number too.
            let slope = coefficient / (clearance * (1.0 - fraction));
            require(&mut findings, "clearance (c0)", "large enough for the coefficient", clearance, slope.is_finite());
        }
        findings
    }

    /// The damping, or everything that is wrong.
    pub fn resolve(&self) -> Result<Damping, LawSpecErrors> {
        let violations = self.violations();
        if !violations.is_empty() {
            return Err(LawSpecErrors(violations.into_iter().map(LawSpecError::Law).collect()));
        }
        let Self { coefficient, clearance, fraction } = *self;
        Ok(Damping { coefficient, clearance, fraction })
    }
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
        assert!(errors("modified-hard", &[]).contains("status before"));
        assert!(errors("No Separation", &[]).contains("separation=prevented"));
        assert!(errors("rubber", &[]).contains("linear, tabular, exponential"));
        assert!(errors("linear", &[("stiffness", "nan")]).contains("not NaN"));
    }

    #[test]
    fn penalties_have_their_parameters() {
        let law = LawSpec::read("penalty", &[("k", "3000"), ("clearance", "0.002")]).unwrap();
        assert_eq!(law.evaluate(0.001).pressure, 9.0);
        let pairs = [("ki", "100"), ("final_stiffness", "1e4"), ("d", "0.01"), ("upper", "0.03")];
        let law = LawSpec::read("nonlinear penalty", &pairs).unwrap();
        crate::law::check::assert_close(law.evaluate(0.02).stiffness, 5050.0, 1e-14, 0.0);
        let law = LawSpec::read("augmented_lagrange", &[("stiffness", "100"), ("lambda", "5")]).unwrap();
        crate::law::check::assert_close(law.evaluate(0.01).pressure, 6.0, 1e-15, 0.0);
        assert_eq!(law.evaluate(-0.06), Default::default());
        let text = errors("nonlinear-penalty", &[("ki", "x"), ("kf", "-1"), ("d", "y")]);
        assert_eq!(text.lines().count(), 3, "{text}");
        assert!(text.contains("needs upper (e)"), "{text}");
        let text = errors("nonlinear-penalty", &[("ki", "1"), ("kf", "2"), ("d", "2"), ("e", "1")]);
        assert!(text.contains("upper (e) must be a finite number beyond lower (d), not 1"), "{text}");
        assert!(errors("augmented-lagrange", &[("k", "1"), ("lambda", "-1")]).contains("separation=prevented"));
        let explicit = [("k", "1"), ("lambda", "1"), ("procedure", "explicit")];
        assert!(errors("augmented-lagrange", &explicit).contains("Abaqus/Standard"));
    }

    #[test]
    fn damping_is_no_pressure_but_a_relationship() {
        let pairs = [("mu0", "8"), ("c0", "0.1"), ("eta", "0.4")];
        let Relationship::Damping(spec) = read("damping", &pairs).unwrap() else { panic!("not damping") };
        crate::law::check::assert_close(spec.resolve().unwrap().at(-0.07).0, 4.0, 1e-14, 0.0);
        assert!(errors("damping", &pairs).contains("coefficient over the clearance"));
        let wrong = read("damping", &[("mu0", "-8"), ("c0", "0"), ("eta", "1")]).unwrap_err().to_string();
        assert_eq!(wrong.lines().count(), 3, "{wrong}");
        assert!(read("damping", &[("mu0", "8")]).unwrap_err().to_string().contains("needs clearance (c0)"));
        let Relationship::Pressure(_) = read("linear", &[("k", "1")]).unwrap() else { panic!("not a pressure") };
    }
}

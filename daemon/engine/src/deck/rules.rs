//! Combinations of contact options that the manual forbids, or that have no effect. The deck reader refuses by this table, and
//! `docs/availability.md` shows it.

use crate::diagnostic::Severity;

use super::availability::{Blame, Citation, Confidence, Family, text};
use super::facts::{Facts, Law};

/// A combination that is not allowed.
pub struct Rule {
    /// Families in which it is not.
    pub families: &'static [Family],
    /// What is wrong, as a message; `{law}` stands for the softened law.
    pub combination: &'static str,
    /// Why.
    pub reason: &'static str,
    /// What to do.
    pub remedy: &'static str,
    /// Error, or a warning when the answer stands.
    pub severity: Severity,
    /// Card that is blamed.
    pub blame: Blame,
    /// Where the manual says so.
    pub source: Citation,
    /// Whether it is broken; none for rules that the reader of the card looks at.
    pub(super) is_broken: Option<fn(&Facts) -> bool>,
}

impl Rule {
    /// The message for a law.
    pub fn message(&self, law: &str) -> String {
        format!("{}: {}", self.combination.replace("{law}", law), self.reason)
    }
}

const STANDARD: &[Family] = &[Family::StandardSurfaces, Family::StandardElements];
const SLIDING: &[Family] = &[Family::StandardSurfaces, Family::ExplicitPairs];
const EXPLICIT: &[Family] = &[Family::ExplicitPairs, Family::ExplicitGeneral];
const PAIRS: &[Family] = &[Family::ExplicitPairs];
const GENERAL: &[Family] = &[Family::ExplicitGeneral];
const EVERYWHERE: &[Family] = &Family::ALL;

const fn rule(
    families: &'static [Family],
    blame: Blame,
    combination: &'static str,
    reason: &'static str,
    remedy: &'static str,
    source: Citation,
) -> Rule {
    Rule { families, combination, reason, remedy, severity: Severity::Error, blame, source, is_broken: None }
}

/// NO SEPARATION with the exponential law.
const EXPONENTIAL_NO_SEPARATION: Rule = Rule {
    is_broken: Some(|facts| facts.no_separation && facts.law == Some(Law::Exponential)),
    ..rule(
        EVERYWHERE,
        Blame::Behavior,
        "the exponential law cannot be combined with NO SEPARATION in any analysis",
        "its pressure begins without a slope, so there is none to continue into tension",
        "leave NO SEPARATION out, or choose PRESSURE-OVERCLOSURE=HARD",
        text("22.1.2"),
    )
};

/// NO SEPARATION with any softened law in Standard.
const SOFTENED_NO_SEPARATION: Rule = Rule {
    is_broken: Some(|facts| facts.no_separation && facts.law.is_some()),
    ..rule(
        STANDARD,
        Blame::Behavior,
        "the {law} law cannot be combined with NO SEPARATION",
        "in implicit and static analyses NO SEPARATION belongs to hard contact",
        "leave NO SEPARATION out, or choose PRESSURE-OVERCLOSURE=HARD",
        text("22.1.2; *SURFACE BEHAVIOR"),
    )
};

/// AUGMENTED LAGRANGE with a softened law.
const SOFTENED_AUGMENTED: Rule = Rule {
    is_broken: Some(|facts| facts.augmented && facts.law.is_some()),
    ..rule(
        EVERYWHERE,
        Blame::Behavior,
        "the {law} law cannot be combined with AUGMENTED LAGRANGE",
        "it enforces hard contact; softened laws are enforced as they are",
        "leave AUGMENTED LAGRANGE or PRESSURE-OVERCLOSURE out",
        text("*SURFACE BEHAVIOR"),
    )
};

/// PENALTY with a softened law.
const SOFTENED_PENALTY: Rule = Rule {
    is_broken: Some(|facts| facts.penalty && facts.law.is_some()),
    ..rule(
        STANDARD,
        Blame::Behavior,
        "the {law} law cannot be combined with PENALTY",
        "it enforces hard contact; softened laws are enforced as they are",
        "leave PENALTY or PRESSURE-OVERCLOSURE out",
        Citation { section: "*SURFACE BEHAVIOR of later releases", confidence: Confidence::SecondHand },
    )
};

/// AUGMENTED LAGRANGE on surfaces that debond.
const DEBONDING_AUGMENTED: Rule = Rule {
    is_broken: Some(|facts| facts.augmented && facts.debonding),
    ..rule(
        STANDARD,
        Blame::Behavior,
        "AUGMENTED LAGRANGE cannot be combined with *DEBOND",
        "the forces of bonds that break are multipliers without a penalty",
        "leave AUGMENTED LAGRANGE out for surfaces that debond",
        text("22.1.2"),
    )
};

/// A table that does not begin at the origin in general contact.
const GENERAL_TABLE: Rule = Rule {
    is_broken: Some(|facts| facts.law == Some(Law::Tabular) && facts.table_start.is_some_and(|(_, h)| h != 0.0)),
    ..rule(
        GENERAL,
        Blame::Behavior,
        "the table does not begin at zero overclosure, as general contact needs it",
        "general contact has no pressure at a clearance and none missing at an overclosure",
        "begin the table with 0, 0, or describe the contact by *CONTACT PAIR",
        text("22.1.2"),
    )
};

/// NO SEPARATION with balanced weighting.
const BALANCED_NO_SEPARATION: Rule = Rule {
    is_broken: Some(|facts| facts.no_separation && facts.balanced),
    ..rule(
        PAIRS,
        Blame::Behavior,
        "NO SEPARATION cannot be combined with balanced weighting",
        "a pair of two deformable surfaces is balanced unless WEIGHT says otherwise, and NO SEPARATION needs a primary and a secondary one",
        "give *CONTACT PAIR, WEIGHT=0 or WEIGHT=1",
        text("22.1.2; 21.4.4"),
    )
};

/// NO SEPARATION with an adaptive mesh.
const ADAPTIVE_NO_SEPARATION: Rule = Rule {
    is_broken: Some(|facts| facts.no_separation && facts.adaptive_mesh),
    ..rule(
        EXPLICIT,
        Blame::Behavior,
        "NO SEPARATION cannot be combined with *ADAPTIVE MESH",
        "nodes that move over the surface would take their bond with them",
        "remove *ADAPTIVE MESH or NO SEPARATION",
        text("22.1.2"),
    )
};

/// NO SEPARATION with a table that has no point of zero pressure.
const TABLE_NO_SEPARATION: Rule = Rule {
    is_broken: Some(|facts| facts.no_separation && facts.table_start.is_some_and(|(pressure, _)| pressure != 0.0)),
    ..rule(
        PAIRS,
        Blame::Behavior,
        "NO SEPARATION cannot be combined with a table without a point of zero pressure",
        "the slope between its first two points goes on into tension from there",
        "begin the table with a point of zero pressure",
        text("22.1.2"),
    )
};

/// Damping of hard kinematic contact.
const KINEMATIC_DAMPING: Rule = Rule {
    is_broken: Some(|facts| facts.damping.is_some() && facts.is_hard() && facts.kinematic),
    severity: Severity::Warning,
    ..rule(
        PAIRS,
        Blame::Damping,
        "*CONTACT DAMPING is ignored for hard kinematic contact",
        "the constraint removes the relative velocity itself",
        "remove it, or choose MECHANICAL CONSTRAINT=PENALTY",
        text("22.1.3"),
    )
};

/// Rigid secondary surface with kinematic contact.
const RIGID_KINEMATIC: Rule = Rule {
    is_broken: Some(|facts| facts.rigid_secondary && facts.kinematic),
    ..rule(
        PAIRS,
        Blame::Pair,
        "a rigid surface cannot be the secondary one of kinematic contact",
        "its nodes do not move on their own, so nothing can be corrected",
        "exchange the surfaces (WEIGHT=0 and no WEIGHT: the first is secondary), or choose MECHANICAL CONSTRAINT=PENALTY",
        text("21.4.4"),
    )
};

/// Both tolerances of augmented Lagrange.
pub const TWO_TOLERANCES: Rule = rule(
    STANDARD,
    Blame::Controls,
    "ABSOLUTE and RELATIVE PENETRATION TOLERANCE exclude each other",
    "there is one penetration that augmented Lagrange accepts",
    "keep one of them",
    text("*CONTACT CONTROLS"),
);

/// AUTOMATIC TOLERANCES beside modified hard contact.
pub const AUTOMATIC_AND_MODIFIED: Rule = rule(
    STANDARD,
    Blame::Controls,
    "AUTOMATIC TOLERANCES cannot be combined with MAXCHP, PERRMX and UERRMX",
    "these are the tolerances that it would choose",
    "keep one of them",
    text("*CONTACT CONTROLS"),
);

/// Tolerances of modified hard contact without a number of points.
pub const MODIFIED_WITHOUT_COUNT: Rule = rule(
    STANDARD,
    Blame::Controls,
    "UERRMX and PERRMX need MAXCHP",
    "without it no point may violate the hard conditions, so that they would have no effect",
    "give MAXCHP, the number of points that may violate the hard conditions",
    text("*CONTACT CONTROLS"),
);

/// Modified hard contact for a pair that has none of it.
pub const MODIFIED_NOT_HARD: Rule = rule(
    STANDARD,
    Blame::Controls,
    "MAXCHP, PERRMX and UERRMX name a pair that is not hard contact enforced by multipliers",
    "they modify the conditions of hard contact, which softened laws, penalties and augmented Lagrange do not have",
    "leave them out for this pair, or write PRESSURE-OVERCLOSURE=HARD alone",
    text("22.1.2"),
);

/// SHRINK behind the first step.
pub const SHRINK_LATER: Rule = rule(
    STANDARD,
    Blame::Controls,
    "SHRINK stands outside the first step",
    "it takes the overclosures that the bodies have before anything is computed",
    "move it into the first step, or give the overclosure that is allowed in place of SHRINK",
    text("*CONTACT INTERFERENCE"),
);

/// A softened law in an impact.
const SOFTENED_IMPACT: Rule = Rule {
    is_broken: Some(|facts| facts.implicit_dynamics && facts.law.is_some()),
    severity: Severity::Warning,
    ..rule(
        STANDARD,
        Blame::Behavior,
        "the {law} law makes impacts elastic in an implicit dynamic step",
        "no velocity is lost when points meet, as hard contact has it: nodes bounce and may chatter",
        "damp the contact by *CONTACT DAMPING, choose PRESSURE-OVERCLOSURE=HARD for impacts that lose energy, or disregard this where \
         bodies stay in contact",
        text("22.1.2"),
    )
};

/// TAUMAX=0 in Explicit.
pub const TAUMAX_ZERO: Rule = rule(
    EXPLICIT,
    Blame::Friction,
    "TAUMAX=0 is not allowed",
    "no shear stress at all would be transmitted",
    "leave TAUMAX out: there is no limit then",
    text("22.1.4; *FRICTION"),
);

/// CLEARANCE behind the first step.
pub const CLEARANCE_LATER: Rule = rule(
    PAIRS,
    Blame::Pair,
    "*CLEARANCE stands outside the first step",
    "it says where the bodies are before anything is computed",
    "move it into the first step",
    text("*CLEARANCE"),
);

/// CLEARANCE of a pair that slides far.
pub const CLEARANCE_SLIDING: Rule = rule(
    SLIDING,
    Blame::Pair,
    "*CLEARANCE needs a pair with SMALL SLIDING",
    "the clearance belongs to the place on the primary surface that a node keeps",
    "add SMALL SLIDING to *CONTACT PAIR",
    text("*CLEARANCE"),
);

/// Every rule.
pub const RULES: &[&Rule] = &[
    &EXPONENTIAL_NO_SEPARATION,
    &SOFTENED_NO_SEPARATION,
    &SOFTENED_AUGMENTED,
    &SOFTENED_PENALTY,
    &DEBONDING_AUGMENTED,
    &GENERAL_TABLE,
    &BALANCED_NO_SEPARATION,
    &ADAPTIVE_NO_SEPARATION,
    &TABLE_NO_SEPARATION,
    &KINEMATIC_DAMPING,
    &RIGID_KINEMATIC,
    &TWO_TOLERANCES,
    &AUTOMATIC_AND_MODIFIED,
    &MODIFIED_WITHOUT_COUNT,
    &MODIFIED_NOT_HARD,
    &SHRINK_LATER,
    &SOFTENED_IMPACT,
    &TAUMAX_ZERO,
    &CLEARANCE_LATER,
    &CLEARANCE_SLIDING,
];

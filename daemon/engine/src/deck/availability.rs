//! What the manual offers where: features of contact by family of procedure and of contact. The deck reader refuses by this
//! table, and `docs/availability.md` shows it.

use super::facts::{DampingKind, Facts, Law};

/// Where contact is described, and what for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Family {
    /// Contact pairs in Abaqus/Standard: statics and implicit dynamics.
    StandardSurfaces,
    /// Contact elements in Abaqus/Standard.
    StandardElements,
    /// Contact pairs in Abaqus/Explicit.
    ExplicitPairs,
    /// General contact in Abaqus/Explicit.
    ExplicitGeneral,
}

impl Family {
    /// Every family, in the order of [`Feature::offers`].
    pub const ALL: [Family; 4] =
        [Self::StandardSurfaces, Self::StandardElements, Self::ExplicitPairs, Self::ExplicitGeneral];

    /// The family in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Self::StandardSurfaces => "contact pairs of implicit and static analyses (Abaqus/Standard)",
            Self::StandardElements => "contact elements (Abaqus/Standard)",
            Self::ExplicitPairs => "contact pairs of explicit analyses (Abaqus/Explicit)",
            Self::ExplicitGeneral => "general contact (Abaqus/Explicit)",
        }
    }

    /// The family at the head of a column.
    pub fn title(self) -> &'static str {
        match self {
            Self::StandardSurfaces => "Standard, pairs",
            Self::StandardElements => "Standard, elements",
            Self::ExplicitPairs => "Explicit, pairs",
            Self::ExplicitGeneral => "Explicit, general contact",
        }
    }

    /// Whether the procedure is an explicit one.
    pub fn is_explicit(self) -> bool {
        matches!(self, Self::ExplicitPairs | Self::ExplicitGeneral)
    }
}

/// Whether a family has a feature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Offer {
    /// It has, perhaps with a condition or a remark.
    Yes(&'static str),
    /// It has not: the reason, as the end of a sentence.
    No(&'static str),
}

/// How sure it is that the manual says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Confidence {
    /// Read in the public text of the manual.
    Text,
    /// The manual shows it as a picture; restored.
    Figure,
    /// From notes that quote the manual.
    SecondHand,
    /// From memory of the manual, not read again.
    Memory,
    /// The manual is silent: our choice.
    Choice,
}

impl Confidence {
    /// The confidence in the documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::Text => "text of the manual",
            Self::Figure => "restored from a figure of the manual",
            Self::SecondHand => "notes that quote the manual",
            Self::Memory => "from memory of the manual",
            Self::Choice => "our choice: the manual is silent",
        }
    }
}

/// Where something is written, and how sure that is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Citation {
    /// Section or keyword of the Abaqus manuals v6.5, or of later releases where it says so.
    pub section: &'static str,
    /// How sure.
    pub confidence: Confidence,
}

pub(super) const fn text(section: &'static str) -> Citation {
    Citation { section, confidence: Confidence::Text }
}

/// Card that a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// `*SURFACE BEHAVIOR`.
    Behavior,
    /// `*CONTACT DAMPING`.
    Damping,
    /// `*CONTACT CONTROLS`.
    Controls,
    /// `*PRESSURE PENETRATION`.
    Penetration,
    /// `*CONTACT PAIR`.
    Pair,
    /// `*FRICTION`.
    Friction,
}

/// A feature of contact.
pub struct Feature {
    /// The feature, as the beginning of a sentence.
    pub name: &'static str,
    /// How a deck asks for it.
    pub keyword: &'static str,
    /// Whether each of [`Family::ALL`] has it.
    pub offers: [Offer; 4],
    /// What to do where it is not offered.
    pub remedy: &'static str,
    /// Card that asks for it.
    pub blame: Blame,
    /// Where the manual says so.
    pub source: Citation,
    pub(super) is_asked: fn(&Facts) -> bool,
}

impl Feature {
    /// Whether a family has the feature.
    pub fn offer(&self, family: Family) -> Offer {
        let position = Family::ALL.iter().position(|&other| other == family);
        self.offers[position.expect("every family is in the list")]
    }
}

use Offer::{No, Yes};

/// Every feature that a rule of availability is about.
pub const FEATURES: &[Feature] = &[
    Feature {
        name: "hard contact",
        keyword: "PRESSURE-OVERCLOSURE=HARD, or nothing",
        offers: [Yes("by Lagrange multipliers"), Yes(""), Yes("kinematic, or penalty on request"), Yes("by penalty")],
        remedy: "",
        blame: Blame::Behavior,
        source: text("22.1.2; 21.4.4; *CONTACT PAIR"),
        is_asked: |facts| facts.is_hard() && !facts.augmented && !facts.penalty,
    },
    Feature {
        name: "augmented Lagrange",
        keyword: "AUGMENTED LAGRANGE",
        offers: [
            Yes("hard contact only"),
            Yes("hard contact only"),
            No("constraints are enforced kinematically or by penalty there"),
            No("constraints are enforced by penalty there"),
        ],
        remedy: "leave AUGMENTED LAGRANGE out, or solve a static step",
        blame: Blame::Behavior,
        source: text("22.1.2; *SURFACE BEHAVIOR"),
        is_asked: |facts| facts.augmented,
    },
    Feature {
        name: "penalty enforcement by *SURFACE BEHAVIOR",
        keyword: "PENALTY, PENALTY=LINEAR, PENALTY=NONLINEAR",
        offers: [
            Yes("later releases; hard contact only"),
            Yes("later releases; hard contact only"),
            No("it is chosen by MECHANICAL CONSTRAINT of *CONTACT PAIR there"),
            No("it is the only enforcement there"),
        ],
        remedy: "leave PENALTY out",
        blame: Blame::Behavior,
        source: Citation { section: "*SURFACE BEHAVIOR of later releases", confidence: Confidence::SecondHand },
        is_asked: |facts| facts.penalty,
    },
    Feature {
        name: "modified hard contact",
        keyword: "*CONTACT CONTROLS, MAXCHP, PERRMX, UERRMX",
        offers: [
            Yes("hard contact by Lagrange multipliers"),
            Yes("hard contact by Lagrange multipliers"),
            No("MAXCHP, PERRMX and UERRMX belong to implicit and static analyses"),
            No("MAXCHP, PERRMX and UERRMX belong to implicit and static analyses"),
        ],
        remedy: "remove MAXCHP, PERRMX and UERRMX, or solve a static step",
        blame: Blame::Controls,
        source: text("22.1.2; *CONTACT CONTROLS"),
        is_asked: |facts| facts.modified_hard,
    },
    Feature {
        name: "the linear law",
        keyword: "PRESSURE-OVERCLOSURE=LINEAR",
        offers: [Yes(""), Yes(""), Yes(""), Yes("")],
        remedy: "",
        blame: Blame::Behavior,
        source: text("22.1.2"),
        is_asked: |facts| facts.law == Some(Law::Linear),
    },
    Feature {
        name: "the tabular law",
        keyword: "PRESSURE-OVERCLOSURE=TABULAR",
        offers: [Yes(""), Yes(""), Yes(""), Yes("zero pressure at zero overclosure")],
        remedy: "",
        blame: Blame::Behavior,
        source: text("22.1.2"),
        is_asked: |facts| facts.law == Some(Law::Tabular),
    },
    Feature {
        name: "the exponential law",
        keyword: "PRESSURE-OVERCLOSURE=EXPONENTIAL",
        offers: [
            Yes("straight at high overclosure, beyond 6 c0 (the factor is from memory)"),
            Yes("straight at high overclosure, beyond 6 c0 (the factor is from memory)"),
            Yes("with a largest stiffness, if one is given"),
            No("it belongs to contact pairs"),
        ],
        remedy: "choose LINEAR or TABULAR, or describe the contact by *CONTACT PAIR",
        blame: Blame::Behavior,
        source: text("22.1.2"),
        is_asked: |facts| facts.law == Some(Law::Exponential),
    },
    Feature {
        name: "NO SEPARATION",
        keyword: "NO SEPARATION",
        offers: [
            Yes("hard contact only"),
            Yes("hard contact only"),
            Yes("pure primary-secondary weighting, no adaptive mesh; hard, linear, or a table with zero pressure"),
            No("it belongs to contact pairs with pure primary-secondary weighting"),
        ],
        remedy: "leave NO SEPARATION out, or describe the contact by *CONTACT PAIR",
        blame: Blame::Behavior,
        source: text("22.1.2; *SURFACE BEHAVIOR"),
        is_asked: |facts| facts.no_separation,
    },
    Feature {
        name: "contact damping by a coefficient",
        keyword: "*CONTACT DAMPING, DEFINITION=DAMPING COEFFICIENT",
        offers: [
            Yes("with the clearance of zero damping"),
            Yes("with the clearance of zero damping"),
            Yes("ignored for hard kinematic contact"),
            Yes(""),
        ],
        remedy: "",
        blame: Blame::Damping,
        source: text("22.1.3; *CONTACT DAMPING"),
        is_asked: |facts| facts.damping == Some(DampingKind::Coefficient),
    },
    Feature {
        name: "the critical damping fraction",
        keyword: "*CONTACT DAMPING, DEFINITION=CRITICAL DAMPING FRACTION",
        offers: [
            No(
                "it is a fraction of the critical damping of a nodal mass on its contact stiffness in explicit analyses",
            ),
            No(
                "it is a fraction of the critical damping of a nodal mass on its contact stiffness in explicit analyses",
            ),
            Yes("0.03 unless given"),
            Yes("0.03 unless given"),
        ],
        remedy: "give a coefficient and a clearance with DEFINITION=DAMPING COEFFICIENT",
        blame: Blame::Damping,
        source: text("22.1.3; *CONTACT DAMPING"),
        is_asked: |facts| facts.damping == Some(DampingKind::CriticalFraction),
    },
    Feature {
        name: "pressure penetration",
        keyword: "*PRESSURE PENETRATION",
        offers: [
            Yes(""),
            No("it follows the surfaces of contact pairs"),
            No("it belongs to implicit and static analyses"),
            No("it belongs to implicit and static analyses"),
        ],
        remedy: "apply the pressure to the wetted faces by *DSLOAD",
        blame: Blame::Penetration,
        source: text("22.1.6; *PRESSURE PENETRATION"),
        is_asked: |facts| facts.penetration,
    },
];

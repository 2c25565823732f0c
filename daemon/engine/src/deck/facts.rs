//! What a deck asks of one interaction or one card, as the rules look at it.

use super::availability::Family;

/// Laws by their keyword.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Law {
    /// `LINEAR`.
    Linear,
    /// `TABULAR`.
    Tabular,
    /// `EXPONENTIAL`.
    Exponential,
}

impl Law {
    /// The law in a sentence.
    pub fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Tabular => "tabular",
            Self::Exponential => "exponential",
        }
    }
}

/// `DEFINITION` of `*CONTACT DAMPING`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DampingKind {
    /// `DAMPING COEFFICIENT`.
    Coefficient,
    /// `CRITICAL DAMPING FRACTION`.
    CriticalFraction,
}

/// What is asked for, sound or not. What a card does not say is `false` or `None`.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// Where it is asked for.
    pub family: Family,
    /// Softened law; `None` is hard contact, where there is an interaction at all.
    pub law: Option<Law>,
    /// Whether the facts are those of an interaction, not of controls or loads.
    pub is_interaction: bool,
    /// `AUGMENTED LAGRANGE`.
    pub augmented: bool,
    /// `PENALTY`.
    pub penalty: bool,
    /// `NO SEPARATION`.
    pub no_separation: bool,
    /// First point of a table: pressure, overclosure.
    pub table_start: Option<(f64, f64)>,
    /// `*CONTACT DAMPING`.
    pub damping: Option<DampingKind>,
    /// An explicit pair is enforced kinematically.
    pub kinematic: bool,
    /// An explicit pair has balanced weighting.
    pub balanced: bool,
    /// The secondary surface of the pair is rigid.
    pub rigid_secondary: bool,
    /// The deck has `*ADAPTIVE MESH`.
    pub adaptive_mesh: bool,
    /// The surfaces debond.
    pub debonding: bool,
    /// `MAXCHP`, `PERRMX` or `UERRMX`.
    pub modified_hard: bool,
    /// `*PRESSURE PENETRATION`.
    pub penetration: bool,
    /// The deck has implicit dynamic steps.
    pub implicit_dynamics: bool,
}

impl Facts {
    /// Nothing asked for yet.
    pub fn of(family: Family) -> Self {
        Self {
            family,
            law: None,
            is_interaction: false,
            augmented: false,
            penalty: false,
            no_separation: false,
            table_start: None,
            damping: None,
            kinematic: false,
            balanced: false,
            rigid_secondary: false,
            adaptive_mesh: false,
            debonding: false,
            modified_hard: false,
            penetration: false,
            implicit_dynamics: false,
        }
    }

    /// Hard contact.
    pub fn is_hard(&self) -> bool {
        self.is_interaction && self.law.is_none()
    }

    /// Name of the law in a sentence.
    pub fn law_name(&self) -> &'static str {
        self.law.map_or("hard", Law::name)
    }
}

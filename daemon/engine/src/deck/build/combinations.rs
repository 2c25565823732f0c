//! Combinations of contact options against the tables of availability and rules, for every procedure that the deck asks for.

use crate::diagnostic::Severity;
use crate::model::{InteractionId, MechanicalConstraint, SurfaceId};

use super::super::availability::{Blame, FEATURES, Family, Feature, Offer};
use super::super::card::Card;
use super::super::facts::Facts;
use super::super::lex::{key, unquoted};
use super::super::report::At;
use super::super::rules::{RULES, Rule};
use super::Builder;
use super::explicit_pairs::{constraint_of, weight_of};
use super::layout::{Layout, StepCards};

/// What the deck as a whole says about its procedures.
struct Procedures {
    standard: bool,
    explicit: bool,
    general_contact: bool,
    adaptive_mesh: bool,
    implicit_dynamics: bool,
}

impl Procedures {
    fn of(layout: &Layout<'_>) -> Self {
        let has = |names: &[&str]| layout.all.iter().any(|card| names.contains(&card.keyword.name));
        let explicit = layout.steps.iter().any(StepCards::is_explicit);
        Self {
            standard: !explicit || layout.steps.iter().any(|step| !step.is_explicit()),
            explicit,
            implicit_dynamics: layout.has_dynamics() && !explicit,
            general_contact: has(&["*CONTACT"]),
            adaptive_mesh: has(&["*ADAPTIVE MESH"]),
        }
    }
}

/// Lines that a finding may be about.
struct Lines<'l> {
    behavior: At,
    damping: At,
    other: Option<&'l Card>,
}

impl Builder<'_> {
    /// Reports every combination that the tables forbid.
    pub(super) fn check_combinations(&mut self, layout: &Layout<'_>) {
        let procedures = Procedures::of(layout);
        let pair_cards: Vec<&Card> = layout.contact_pairs().collect();
        let mut reported = Vec::new();
        for index in 0..self.interaction_lines.len() {
            let id = InteractionId(index as u32);
            let of_surfaces = !matches!(self.interaction_lines[index].keyword, "*GAP" | "*INTERFACE");
            let pairs: Vec<&Card> =
                (pair_cards.iter().copied()).filter(|card| of_surfaces && self.is_about(card, id)).collect();
            let in_general = self.general_interactions.contains(&id);
            for family in families(&procedures, of_surfaces, !pairs.is_empty(), in_general) {
                let facts = self.interaction_facts(id, family, &procedures);
                let lines = &self.interaction_lines[index];
                let lines = Lines {
                    behavior: lines.behavior.unwrap_or(lines.at),
                    damping: lines.damping.unwrap_or(lines.at),
                    other: None,
                };
                if pairs.is_empty() || family == Family::ExplicitGeneral {
                    let debonding = !of_surfaces && layout.debonds().next().is_some();
                    self.judge(&Facts { debonding, ..facts }, &lines, &mut reported);
                }
                for pair in pairs.iter().filter(|_| family != Family::ExplicitGeneral) {
                    for facts in self.pair_facts(facts, pair, layout) {
                        self.judge(&facts, &Lines { other: Some(pair), ..lines }, &mut reported);
                    }
                }
            }
        }
        for step in &layout.steps {
            let family = if step.is_explicit() { Family::ExplicitPairs } else { Family::StandardSurfaces };
            for card in &step.cards {
                let modified_hard = card.keyword.name == "*CONTACT CONTROLS"
                    && ["MAXCHP", "PERRMX", "UERRMX"].iter().any(|name| card.parameters.has(name));
                let penetration = card.keyword.name == "*PRESSURE PENETRATION";
                let facts = Facts { modified_hard, penetration, ..Facts::of(family) };
                let lines = Lines { behavior: card.at, damping: card.at, other: Some(card) };
                self.judge(&facts, &lines, &mut reported);
            }
        }
    }

    fn interaction_facts(&self, id: InteractionId, family: Family, procedures: &Procedures) -> Facts {
        let lines = &self.interaction_lines[id.index()];
        Facts {
            law: lines.asked.softened,
            is_interaction: true,
            augmented: lines.asked.augmented,
            penalty: lines.asked.penalty,
            no_separation: lines.asked.no_separation,
            table_start: lines.asked.table_start,
            damping: lines.damping_kind,
            kinematic: family == Family::ExplicitPairs,
            adaptive_mesh: procedures.adaptive_mesh,
            implicit_dynamics: procedures.implicit_dynamics,
            ..Facts::of(family)
        }
    }

    /// Facts of an interaction for each pair of a `*CONTACT PAIR` card.
    fn pair_facts(&self, facts: Facts, card: &Card, layout: &Layout<'_>) -> Vec<Facts> {
        let constraint = constraint_of(card);
        let rows = card.lines().iter().map(|line| line.row(card.keyword.name));
        rows.map(|row| {
            let [first, second] = [0, 1].map(|item| unquoted(row.text(item)));
            let found = [first, second].map(|name| self.surfaces.find(name).map(SurfaceId));
            let roles = match found {
                [Some(first), Some(second)] if facts.family == Family::ExplicitPairs => {
                    Some(self.roles(first, second, constraint, weight_of(card)))
                }
                _ => None,
            };
            let rigid = |surface| self.is_rigid_surface(surface);
            // The line names the secondary surface first, unless WEIGHT says otherwise. Where only one order is possible, any is taken.
            let named_first = match found {
                [Some(first), Some(second)] => {
                    roles.is_some()
                        && weight_of(card).is_none()
                        && !self.is_analytical(first)
                        && rigid(first)
                        && !rigid(second)
                }
                _ => false,
            };
            Facts {
                kinematic: facts.kinematic && constraint == MechanicalConstraint::Kinematic,
                balanced: roles.is_some_and(|roles| roles.weight != 1.0),
                rigid_secondary: named_first
                    || roles
                        .is_some_and(|roles| rigid(roles.secondary) || (roles.weight != 1.0 && rigid(roles.primary))),
                debonding: layout.debonds().any(|debond| {
                    let named = |parameter: &str, surface: &str| {
                        debond.parameters.value(parameter).is_none_or(|name| key(name) == key(surface))
                    };
                    named("SLAVE", first) && named("MASTER", second)
                }),
                ..facts
            }
        })
        .collect()
    }

    fn judge(&mut self, facts: &Facts, lines: &Lines<'_>, reported: &mut Vec<(At, &'static str, Family)>) {
        for feature in FEATURES.iter().filter(|feature| (feature.is_asked)(facts)) {
            if let Offer::No(reason) = feature.offer(facts.family)
                && let Some((at, keyword)) = lines.blamed(feature.blame)
                && is_new(reported, (at, feature.name, facts.family))
            {
                self.not_offered(feature, facts.family, reason, at, keyword);
            }
        }
        for rule in RULES.iter().filter(|rule| rule.families.contains(&facts.family)) {
            if rule.is_broken.is_some_and(|is_broken| is_broken(facts))
                && let Some((at, keyword)) = lines.blamed(rule.blame)
                && is_new(reported, (at, rule.reason, rule.families[0]))
            {
                self.break_rule(rule, at, keyword, facts.law_name());
            }
        }
    }

    fn not_offered(&mut self, feature: &Feature, family: Family, reason: &str, at: At, keyword: &str) {
        let message = format!("{} is not available for {}: {reason}", feature.name, family.name());
        self.report.error(at, keyword, message, feature.remedy);
    }

    /// Reports a broken rule; `law` is the softened law that it is about, if any.
    pub(super) fn break_rule(&mut self, rule: &Rule, at: At, keyword: &str, law: &str) {
        let message = rule.message(law);
        match rule.severity {
            Severity::Error => self.report.error(at, keyword, message, rule.remedy),
            Severity::Warning => self.report.warning(at, keyword, message, rule.remedy),
        }
    }
}

/// Adds a finding to those that have been reported; whether it is new.
fn is_new<T: PartialEq>(reported: &mut Vec<T>, finding: T) -> bool {
    let is_new = !reported.contains(&finding);
    if is_new {
        reported.push(finding);
    }
    is_new
}

/// Families for which an interaction is meant.
fn families(procedures: &Procedures, of_surfaces: bool, has_pairs: bool, in_general: bool) -> Vec<Family> {
    if !of_surfaces {
        return vec![Family::StandardElements];
    }
    let mut found = Vec::new();
    if procedures.standard {
        found.push(Family::StandardSurfaces);
    }
    if procedures.explicit && (in_general || (procedures.general_contact && !has_pairs)) {
        found.push(Family::ExplicitGeneral);
    }
    if procedures.explicit && (has_pairs || !procedures.general_contact) {
        found.push(Family::ExplicitPairs);
    }
    found
}

impl Lines<'_> {
    fn blamed(&self, blame: Blame) -> Option<(At, &'static str)> {
        match blame {
            Blame::Behavior => Some((self.behavior, "*SURFACE BEHAVIOR")),
            Blame::Damping => Some((self.damping, "*CONTACT DAMPING")),
            Blame::Controls | Blame::Penetration | Blame::Pair | Blame::Friction => {
                self.other.map(|card| (card.at, card.keyword.name))
            }
        }
    }
}

//! `*CONTACT DAMPING`.

use crate::model::{ContactDamping, DampingDefinition, Dialect, ExplicitDamping, InteractionId};

use super::super::card::Card;
use super::super::facts::DampingKind;
use super::super::lex::real;
use super::super::report::excerpt;
use super::Builder;

const DAMPING: &str = "*CONTACT DAMPING";
/// Clearance below which surfaces count as touching where the CalculiX dialect gives the coefficient alone \[length\]: none.
const TOUCHING: f64 = f64::MIN_POSITIVE;

impl Builder<'_> {
    /// Gives an interaction its damping; whether the card is sound.
    pub(super) fn contact_damping(&mut self, card: &Card, interaction: InteractionId) -> bool {
        if self.is_explicit {
            return self.explicit_damping(card, interaction);
        }
        let tangent_fraction = self.tangent_fraction(card, DAMPING, 0.0);
        if card.parameters.word("DEFINITION") == "CRITICALDAMPINGFRACTION" {
            self.interaction_lines[interaction.index()].damping_kind = Some(DampingKind::CriticalFraction);
            return false; // Whether it is offered is reported with the combinations.
        }
        self.interaction_lines[interaction.index()].damping_kind = Some(DampingKind::Coefficient);
        let what =
            "damping coefficient, clearance from which on nothing is damped, part of it with the full coefficient";
        let Some(row) = card.single_row(what, self.report) else { return false };
        row.at_most(3, self.report);
        let coefficient = row.real(0, "damping coefficient", None, self.report);
        let default = (self.model.dialect == Dialect::Calculix).then_some(TOUCHING);
        let clearance = row.real(1, "clearance c0 without damping", default, self.report);
        let fraction = row.real(2, "part of c0 with the full coefficient", Some(0.0), self.report);
        let (Some(coefficient), Some(clearance), Some(fraction), Some(tangent_fraction)) =
            (coefficient, clearance, fraction, tangent_fraction)
        else {
            return false;
        };
        let mut wrong = Vec::new();
        if coefficient <= 0.0 {
            wrong.push(format!("the damping coefficient {coefficient} is not positive"));
        }
        if clearance <= 0.0 {
            wrong.push(format!("the clearance {clearance} from which on nothing is damped is not positive"));
        }
        if !(0.0..1.0).contains(&fraction) {
            wrong.push(format!("the part {fraction} of the clearance is not from 0 up to, but without, 1"));
        }
        for message in &wrong {
            self.report.error(row.at, DAMPING, message.clone(), format!("correct the data line: {what}"));
        }
        self.model.interactions[interaction.index()].damping =
            Some(ContactDamping { coefficient, clearance, fraction, tangent_fraction });
        wrong.is_empty() && !card.faulty
    }

    /// Damping of explicit analyses: one item, which acts while surfaces touch.
    fn explicit_damping(&mut self, card: &Card, interaction: InteractionId) -> bool {
        let tangent_fraction = self.tangent_fraction(card, DAMPING, 1.0);
        let critical = card.parameters.word("DEFINITION") == "CRITICALDAMPINGFRACTION";
        let (kind, what) = if critical {
            (DampingKind::CriticalFraction, "critical damping fraction")
        } else {
            (DampingKind::Coefficient, "damping coefficient")
        };
        self.interaction_lines[interaction.index()].damping_kind = Some(kind);
        let Some(row) = card.single_row(what, self.report) else { return false };
        row.at_most(3, self.report);
        if row.fields.iter().skip(1).any(|field| !field.is_empty()) {
            let message = "clearance and part of it behind the coefficient are ignored: in explicit analyses contact is damped while surfaces touch";
            self.report.warning(row.at, DAMPING, message, "leave them out");
        }
        let value = row.real(0, what, None, self.report);
        let (Some(value), Some(tangent_fraction)) = (value, tangent_fraction) else { return false };
        if value < 0.0 {
            let message = format!("the {what} {value} is negative");
            self.report.error(row.at, DAMPING, message, "give 0 for no damping, or a positive number");
            return false;
        }
        let definition =
            if critical { DampingDefinition::CriticalFraction(value) } else { DampingDefinition::Coefficient(value) };
        self.model.interactions[interaction.index()].explicit_damping =
            ExplicitDamping { definition, tangent_fraction };
        !card.faulty
    }

    /// `TANGENT FRACTION`, not negative; `None` when it is not, which is reported.
    pub(super) fn tangent_fraction(&mut self, card: &Card, keyword: &'static str, default: f64) -> Option<f64> {
        let Some(text) = card.parameters.value("TANGENT FRACTION") else { return Some(default) };
        match real(text.trim().as_bytes()) {
            Ok(fraction) if fraction >= 0.0 => Some(fraction),
            _ => {
                let message = format!("TANGENT FRACTION={} is no number from 0 on", excerpt(text.as_bytes()));
                let remedy = "give the tangential coefficient as a part of the normal one";
                self.report.error(card.at, keyword, message, remedy);
                None
            }
        }
    }
}
